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
    with pytest.warns(vv.AccuracyWarning, match=r"too far apart .* % of the work done on body 0") as told:
        work = vv.audit.work_along(scene.run(t=np.linspace(0.0, 12.0, times)), DRAG)[-1, 0]
    share = float(str(told[0].message).split("about ")[1].split(" %")[0]) / 100.0
    # An estimate, of the whole without regard to sign: the work of a drag has one.
    assert abs(work / exact - 1.0) / 6.0 < share < 6.0 * abs(work / exact - 1.0) + 0.5


def test_times_that_tell_the_motion_are_not_warned_of() -> None:
    """Ten to a period: warnings are errors in these tests. One span is enough for a parabola, however long."""
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


def test_refusals_count_the_bodies_of_the_run() -> None:
    out = vv.Scene(BODIES).run(t=np.linspace(0.0, 1.0, 5))
    with pytest.raises(vv.InvalidInput, match=r"velocity\[0\]"):
        vv.audit.work_along(out, vv.Drag(density=1e7, viscosity=1.0, radius=1.0))
    with pytest.raises(vv.InvalidInput, match="each of 2 bodies, got 3"):
        vv.audit.work_along(out, vv.QuadraticDrag([1.0, 2.0, 3.0]))
