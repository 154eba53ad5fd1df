"""The work of a force along a run: every registered force, of all times together and of each by itself.

Bounds: sums of thirteen terms in another order, 1e-14 of the largest.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import _core

WAVE = vv.ExpressionForce(force=lambda r, v, t: (-r[0] * np.cos(t), 0 * r[1], -r[2] * v[1]))
STILL = vv.ExpressionForce(force=lambda r, v, t: (-r[0] * v[1], 0 * r[1], -r[2]))
RIPPLE = vv.ExpressionForce(potential=lambda r, v, t: r[0] ** 2 * np.sin(t))
AT_ALL_TIMES = [
    vv.UniformField((0.0, 0.0, -10.0)),
    vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=2.0)),
    vv.Harmonic(k=2.0),
    vv.LinearDrag(tau=2.0),
    vv.QuadraticDrag([0.5, 0.2]),
    vv.Drag(density=1.0, viscosity=1.0, radius=[0.1, 0.2]),
    vv.drag.custom(lambda R: 20.0 / R + 1.0, 0.5, 64.0, density=1.5, viscosity=0.25, radius=[0.5, 0.25]),
    vv.UniformElectricField((1.0, 0.0, 0.0), charge=[1.0, 2.0]),
    vv.UniformMagneticField((0.0, 0.0, 1.0), charge=[1.0, 2.0]),
    vv.RotatingFrame((0.0, 0.5, 1.0)),
    STILL,
]
WITH_THE_TIME = [vv.DrivenForce((1.0, 0.0, 0.5), 2.0), WAVE, RIPPLE]
BETWEEN = {"Gravity", "Coulomb", "Oblate", "PostNewtonian", "Spring", "Damper", "PairPotential"}
BODIES = vv.Particles([1.0, 3.0], [[1.0, 0.2, 0.3], [-0.5, 1.0, 0.1]], [[0.1, 0.4, -0.2], [0.3, 0.0, 0.2]])


def test_every_force_is_here() -> None:
    """One that is new and looks at the time would else have the work of its first moment."""
    here = {type(force).__name__ for force in (*AT_ALL_TIMES, *WITH_THE_TIME)}
    assert here | BETWEEN == {entry["class_name"] for entry in _core.forces()}


@pytest.mark.parametrize("force", [*AT_ALL_TIMES, *WITH_THE_TIME], ids=lambda force: type(force).__name__)
def test_the_work_is_that_of_a_scene_at_each_time(force: vv.forces.Force) -> None:
    out = vv.Scene(BODIES, force, t0=0.5).run(t=np.linspace(0.5, 2.0, 13))
    t, x, v, m = out.t, out.position, out.velocity, BODIES.mass

    def power(now: float, place: Any, velocity: Any) -> Any:
        bodies = vv.Particles(m, place, velocity)
        return m * (vv.Scene(bodies, force, t0=now).acceleration() * velocity).sum(axis=1)

    expected = np.zeros((13, 2))
    for row in range(12):
        h = t[row + 1] - t[row]
        ends = [power(float(t[k]), x[k], v[k]) for k in (row, row + 1)]
        place = 0.5 * (x[row] + x[row + 1]) + 0.125 * h * (v[row] - v[row + 1])
        velocity = 1.5 * (x[row + 1] - x[row]) / h - 0.25 * (v[row] + v[row + 1])
        middle = power(float(0.5 * (t[row] + t[row + 1])), place, velocity)
        expected[row + 1] = expected[row] + h / 6.0 * (ends[0] + 4.0 * middle + ends[1])
    size = np.abs(expected).max()
    np.testing.assert_allclose(vv.audit.work_along(out, force), expected, rtol=0.0, atol=1e-14 * size + 1e-16)


ONE_NUMBER = [vv.QuadraticDrag(0.5), vv.UniformElectricField((1.0, 0.0, 0.0), charge=2.0)]
ON_SOME = [vv.ExpressionForce(force=lambda r, v, t: (-r[0] * v[1], 0 * r[1], -r[2]), bodies=[1])]


@pytest.mark.parametrize("force", [*AT_ALL_TIMES, *ONE_NUMBER, *ON_SOME], ids=lambda force: type(force).__name__)
def test_times_are_taken_together(force: vv.forces.Force, monkeypatch: pytest.MonkeyPatch) -> None:
    """The ends of the steps, their middles, and what moves the bodies: three calls for any number of times."""
    out = vv.Scene(BODIES, force).run(t=np.linspace(0.0, 1.0, 101))
    calls: list[int] = []
    once = _core.acceleration
    monkeypatch.setattr(_core, "acceleration", lambda **given: [calls.append(1), once(**given)][1])
    vv.audit.work_along(out, force)
    assert len(calls) == 3


def swinging(**more: Any) -> vv.Scene:
    """A damped oscillator of period 4, turning around its center."""
    bodies = vv.Particles([2.0], [[1.0, 0, 0]], [[0, 1.5, 0]])
    return vv.Scene(bodies, vv.Harmonic(k=0.5 * np.pi**2), DRAG, **more)


DRAG = vv.LinearDrag(0.3)


@pytest.mark.parametrize("times", [2, 3, 5, 8, 12])
def test_times_that_do_not_tell_the_motion_are_told(times: int) -> None:
    """With two of a whole motion its work was given as 7 times what it is, without a word; told is the size of it."""
    scene = swinging()
    exact = vv.audit.work_along(scene.run(t=np.linspace(0.0, 12.0, 2001)), DRAG)[-1, 0]
    with pytest.warns(vv.AccuracyWarning, match=r"too far apart .* of the work done on body 0") as told:
        work = vv.audit.work_along(scene.run(t=np.linspace(0.0, 12.0, times)), DRAG)[-1, 0]
    said, off = str(told[0].message), abs(work / exact - 1.0)
    # An estimate, of the whole without regard to sign: the work of a drag has one.
    if "more than all" in said:
        assert off > 0.25
    else:
        share = float(said.split("about ")[1].split(" %", maxsplit=1)[0]) / 100.0
        assert off / 6.0 < share < 6.0 * off + 0.1


def test_times_that_tell_the_motion_are_not_warned_of() -> None:
    """Thirteen to a period: warnings are errors in these tests. One span is enough for a parabola, however long."""
    scene = swinging()
    vv.audit.work_along(scene.run(t=np.linspace(0.0, 12.0, 41)), DRAG)
    field = vv.UniformField((0.0, 0.0, -10.0))
    thrown = vv.Scene(vv.Particles([2.0], [[0.0, 0, 0]], [[1.0, 0, 5.0]]), field)
    for end in (1.0, 1e3):
        (start, fallen) = vv.audit.work_along(thrown.run(t=[0.0, end]), field)[:, 0]
        depth = 5.0 * end - 5.0 * end**2
        # A dozen roundings of the largest term.
        assert start == 0.0
        assert fallen == pytest.approx(-20.0 * depth, rel=1e-14, abs=1e-13 * end**2)


@pytest.mark.parametrize("times", [201, 2501])
@pytest.mark.parametrize(
    "pulls",
    [
        [vv.Gravity(0.1)],
        [vv.Gravity(1.0, softening=0.5)],
        [vv.Coulomb([3.0, 1.0], k=1.0)],
        [vv.PairPotential(vv.potentials.Yukawa(k=-2.0, length=5.0))],
        [vv.Spring(0, 1, k=1.0, length=0.5), vv.Damper(0, 1, c=0.1)],
    ],
    ids=lambda pulls: type(pulls[0]).__name__,
)
def test_forces_between_bodies_are_those_of_one_time(pulls: list[vv.forces.Force], times: int) -> None:
    """What moves the bodies is asked at many times, at none of which they attract those of another."""
    scene = vv.Scene(BODIES, *pulls, DRAG)
    work = vv.audit.work_along(scene.run(t=np.linspace(0.0, 2.0, times)), DRAG)
    assert (work[-1] < 0.0).all()


@pytest.mark.parametrize("times", [11, 1001])
@pytest.mark.parametrize("pull", [(0.0, 0.0, -9.81), (3.0, 1.0, 0.0)])
def test_what_rests_in_balance_is_not_warned_of(pull: tuple[float, float, float], times: int) -> None:
    """Nothing but rounding moves, and by nothing but rounding: it was told that 64 % of its work is not known."""
    field, k = vv.UniformField(pull), 10.0
    weight = vv.Scene(vv.Particles([0.7], [0.7 * np.array(pull) / k]), vv.Harmonic(k=k), field)
    work = vv.audit.work_along(weight.run(t=np.linspace(0.0, 1.0, times)), field)
    # Some roundings of the place, times the force.
    assert np.abs(work).max() < 1e-14


def test_times_close_together_far_from_the_origin_are_not_too_far_apart() -> None:
    """At 1e9 a thousand times in a thousandth of a period tell velocities by places to some per cent only."""
    bodies = vv.Particles([2.0], [[1e9 + 1.0, 0, 0]], [[0, 1.5, 0]])
    out = vv.Scene(bodies, vv.Harmonic(k=2.0, center=(1e9, 0, 0)), DRAG).run(t=np.linspace(0.0, 1e-3, 1001))
    assert np.isfinite(vv.audit.work_along(out, DRAG)).all()


def test_refusals_count_the_bodies_of_the_run() -> None:
    out = vv.Scene(BODIES).run(t=np.linspace(0.0, 1.0, 5))
    with pytest.raises(vv.InvalidInput, match=r"velocity\[0\]"):
        vv.audit.work_along(out, vv.Drag(density=1e7, viscosity=1.0, radius=1.0))
    with pytest.raises(vv.InvalidInput, match="each of 2 bodies, got 3"):
        vv.audit.work_along(out, vv.QuadraticDrag([1.0, 2.0, 3.0]))
