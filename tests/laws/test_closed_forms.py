"""Closed forms against 60 digits, against integration, at the ends of the range, and member by member.

The bound of a component is half a unit in the last place of what is given, and 1e-27 of the largest term of its sum
(`closed_forms/mod.rs`); 60 digits, and as many more as an angle or an exponent has, decide.
"""

import math
import signal
import sys
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

import visviva as vv
from visviva.forces import Force

Array = NDArray[np.float64]
Number = Any


def wide(random: np.random.Generator, shape: tuple[int, ...], decades: float) -> Array:
    """Numbers of either sign, even in the logarithm."""
    sign = np.where(random.random(shape) < 0.5, -1.0, 1.0)
    return np.asarray(sign * 10.0 ** random.uniform(-decades, decades, shape))


def check(given: Array, exact: list[Number], largest: list[Number], share: float) -> None:
    for value, reference, size in zip(given.ravel(), exact, largest, strict=True):
        bound = mpmath.mpf(math.ulp(value)) / 2 * (1 + mpmath.mpf(10) ** -12) + size * share
        assert abs(mpmath.mpf(float(value)) - reference) <= bound, (value, reference)


def drag_reference(x: float, v: float, g: float, tau: float, t: float) -> tuple[list[Number], list[Number]]:
    """Position and velocity, and the largest terms of each."""
    x, v, g, tau, t = (mpmath.mpf(float(number)) for number in (x, v, g, tau, t))
    u = t / tau
    factor = mpmath.exp(-u) if u < 1e5 else mpmath.mpf(0)
    if abs(u) < 1e-12:
        first, second = 1 - u / 2 + u**2 / 6 - u**3 / 24, mpmath.mpf(1) / 2 - u / 6 + u**2 / 24
    else:
        first = (1 - factor) / u
        second = (1 - first) / u
    position, velocity = [x, v * t * first, g * t * t * second], [v * factor, g * t * first]
    if abs(u) > 1:
        # The form about the terminal velocity is summed.
        terms = [x, g * tau * t, (v - g * tau) * t * first]
        speeds = [g * tau, (v - g * tau) * factor]
    else:
        terms, speeds = position, velocity
    size = [max(abs(term) for term in terms), max(abs(term) for term in speeds)]
    return [mpmath.fsum(position), mpmath.fsum(velocity)], size


@pytest.mark.parametrize("field", [False, True])
@pytest.mark.parametrize("decades", [1.5, 30.0, 290.0])
def test_drag_to_half_a_unit(field: bool, decades: float) -> None:
    """τ from 1e-290 to 1e290 times the time, forward and backward."""
    random = np.random.default_rng(round(decades))
    mpmath.mp.prec = 2200 if decades > 100 else 400
    done = 0
    for _ in range(60):
        t = float(wide(random, (), 3.0))
        tau = abs(t) * float(10.0 ** random.uniform(-decades, decades))
        if t < 0.0 and abs(t) / tau > 650.0:
            t = -t
        position, velocity = (wide(random, (2, 3), 4.0) for _ in range(2))
        g = wide(random, (3,), 4.0) if field else np.zeros(3)
        forces = [vv.LinearDrag(tau), vv.UniformField(g)][: 1 + field]
        out = vv.Scene(vv.Particles([0.0, 1.0], position, velocity), *forces).run(t=t)
        assert out.plan.solution == "closed form: exponential decay"
        for body in range(2):
            for c in range(3):
                exact, size = drag_reference(position[body, c], velocity[body, c], g[c], tau, t)
                check(np.array([out.position[-1, body, c], out.velocity[-1, body, c]]), exact, size, 1e-26)
                done += 1
    assert done == 360


def test_drags_add_and_a_terminal_velocity_stays() -> None:
    bodies = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[0.0, 0.0, -3.0]])
    two = vv.Scene(bodies, vv.LinearDrag(3.0), vv.LinearDrag(1.5)).run(t=2.0)
    one = vv.Scene(bodies, vv.LinearDrag(1.0)).run(t=2.0)
    np.testing.assert_allclose(two.position, one.position, rtol=4e-16)
    # v = g τ exactly: nothing changes, not even backward, where what differs from it grows as e^u.
    for t in (1e-3, 40.0, -600.0, 1e300):
        falling = vv.Scene(bodies, vv.LinearDrag(1.5), vv.UniformField([0.0, 0.0, -2.0])).run(t=t)
        assert falling.velocity[-1, 0, 2] == -3.0
        assert falling.position[-1, 0, 2] == pytest.approx(-3.0 * t, rel=3e-16, abs=0)


Triple = list[Number]


def cross(a: Triple, b: Triple) -> Triple:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def helix_reference(x: Array, v: Array, b: Triple, g: Array, t: float) -> tuple[Triple, Triple, Number, Number, Number]:
    """By the matrix series of Rodrigues, with as many digits as the angle needs."""
    time = mpmath.mpf(t)
    size = mpmath.sqrt(sum(c * c for c in b))
    theta = size * time
    vectors = []
    for vector in (v, g):
        first = [mpmath.mpf(float(c)) for c in vector]
        second = cross(first, b)
        vectors.append((first, second, cross(second, b)))
    if size == 0:
        g1, g2, g3, g4, cosine = time, time**2 / 2, time**3 / 6, time**4 / 24, mpmath.mpf(1)
    else:
        cosine = mpmath.cos(theta)
        g1, g2 = mpmath.sin(theta) / size, (1 - cosine) / size**2
        g3, g4 = (theta - mpmath.sin(theta)) / size**3, (theta**2 / 2 - 1 + cosine) / size**4
    position, velocity = [], []
    for c in range(3):
        (v0, v1, v2), (g_0, g_1, g_2) = ([part[c] for part in vector] for vector in vectors)
        position.append(
            mpmath.mpf(float(x[c])) + v0 * time + v1 * g2 + v2 * g3 + g_0 * time**2 / 2 + g_1 * g3 + g_2 * g4
        )
        velocity.append(v0 + v1 * g1 + v2 * g2 + g_0 * time + g_1 * g2 + g_2 * g3)
    speed, pull = (mpmath.sqrt(sum(mpmath.mpf(float(c)) ** 2 for c in vector)) for vector in (v, g))
    far = max([abs(mpmath.mpf(float(c))) for c in x] + [speed * abs(time), pull * time**2 / 2])
    return position, velocity, far, speed + pull * abs(time), abs(theta)


@pytest.mark.parametrize("field", [False, True])
@pytest.mark.parametrize("decades", [1.0, 14.0, 140.0])
def test_gyration_to_half_a_unit(field: bool, decades: float) -> None:
    """Angles from 1e-140 to 1e14, charges of both signs, both directions of time."""
    random = np.random.default_rng(round(decades))
    mpmath.mp.prec = 2600 if decades > 100 else 500
    for _ in range(60):
        t = float(wide(random, (), 3.0))
        angle = float(10.0 ** random.uniform(-decades, min(decades, 14.0)))
        magnetic = wide(random, (3,), 2.0)
        magnetic *= angle / abs(t) / np.abs(magnetic).max()
        charge, mass = wide(random, (2,), 1.0), 10.0 ** random.uniform(-1, 1, 2)
        position, velocity = (wide(random, (2, 3), 3.0) for _ in range(2))
        g = wide(random, (3,), 3.0) if field else np.zeros(3)
        forces = [vv.UniformMagneticField(magnetic, charge=charge), vv.UniformField(g)][: 1 + field]
        out = vv.Scene(vv.Particles(mass, position, velocity), *forces).run(t=t)
        assert out.plan.solution == "closed form: gyration and drift"
        for body in range(2):
            ratio = mpmath.mpf(float(charge[body])) / mpmath.mpf(float(mass[body]))
            b = [ratio * mpmath.mpf(float(c)) for c in magnetic]
            x, v, far, fast, theta = helix_reference(position[body], velocity[body], b, g, t)
            share = float(1e-27 * (1 + theta))
            check(out.position[-1, body], x, [far] * 3, share)
            check(out.velocity[-1, body], v, [fast] * 3, share)


def test_gyration_conserves_energy_and_is_reversible() -> None:
    random = np.random.default_rng(5)
    bodies = vv.Particles([1.0, 2.0], *random.uniform(-1, 1, (2, 2, 3)))
    scene = vv.Scene(
        bodies, vv.UniformMagneticField([0.3, -1.0, 2.0], charge=[1.0, -3.0]), vv.UniformField([0.1, 0.2, 0.3])
    )
    out = scene.run(t=np.linspace(0.0, 50.0, 41), record=("position", "velocity", "energy"))
    # Positions of up to 400 rounded at half a unit, times the field: 1e-14 of energies.
    np.testing.assert_allclose(out.energy, out.energy[0], rtol=0, atol=4e-14)
    kinetic = vv.Scene(bodies, vv.UniformMagneticField([0.3, -1.0, 2.0])).run(t=1e6)
    speed = np.linalg.norm(kinetic.velocity, axis=-1)
    np.testing.assert_allclose(speed[-1], np.linalg.norm(bodies.velocity, axis=-1), rtol=4e-16)
    back = out.final.run(t=0.0)
    np.testing.assert_allclose(back.position[-1], bodies.position, rtol=0, atol=4e-13)
    np.testing.assert_allclose(back.velocity[-1], bodies.velocity, rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    "forces",
    [
        (vv.LinearDrag(0.7),),
        (vv.LinearDrag(3.0), vv.UniformField([0.3, 0.0, -1.0])),
        (vv.UniformMagneticField([0.5, -1.0, 2.0]),),
        (vv.UniformField([0.3, 1.0, -1.0]), vv.UniformMagneticField([0.5, -1.0, 2.0], charge=[1.0, -2.0, 0.0])),
        (vv.UniformMagneticField([0.5, -1.0, 2.0]), vv.UniformMagneticField([0.5, 3.0, 0.0], charge=-1.0)),
    ],
)
@pytest.mark.parametrize("t", [3.0, -2.0])
def test_closed_forms_and_integration(forces: tuple[Force, ...], t: float) -> None:
    random = np.random.default_rng(2)
    bodies = vv.Particles([1.0, 2.0, 0.5], *random.uniform(-1, 1, (2, 3, 3)))
    scene = vv.Scene(bodies, *forces)
    closed = scene.run(t=[t / 3, t])
    assert closed.plan.closed_form
    assert closed.stats.evaluations == 0
    integrated = scene.run(t=[t / 3, t], method="dop853", rtol=1e-13)
    assert not integrated.plan.closed_form
    # The tolerance, times what drag multiplies differences by on the way back (e³).
    np.testing.assert_allclose(closed.position, integrated.position, rtol=0, atol=2e-11)
    np.testing.assert_allclose(closed.velocity, integrated.velocity, rtol=0, atol=2e-11)


def test_weak_forces_are_nearly_none() -> None:
    """Continuous as the drag or the field vanishes, to the last bit."""
    bodies = vv.Particles([1.0], [[1.0, 2.0, 3.0]], [[0.1, 0.7, -0.3]])
    for field in ((), (vv.UniformField([0.3, 0.1, -0.7]),)):
        without = vv.Scene(bodies, *field).run(t=[0.3, 1.7, 1e3])
        for weak in (vv.LinearDrag(1e300), vv.UniformMagneticField([1e-30, 2e-30, -1e-30])):
            out = vv.Scene(bodies, weak, *field).run(t=[0.3, 1.7, 1e3])
            assert out.plan.closed_form
            assert np.array_equal(out.position, without.position)
            assert np.array_equal(out.velocity, without.velocity)


FORCES: dict[str, tuple[Force, ...]] = {
    "free": (),
    "uniform": (vv.UniformField([0.0, 1.0, -2.0]),),
    "drag": (vv.LinearDrag(2.0), vv.UniformField([0.0, 1.0, -2.0])),
    "magnetic": (vv.UniformMagneticField([0.0, 1.0, 0.5]), vv.UniformField([0.0, 1.0, -2.0])),
    "gravity": (vv.Gravity(1.0),),
    "center": (vv.CentralField(vv.potentials.Coulomb(k=-1.0)),),
}


@pytest.mark.parametrize("name", FORCES)
def test_members_and_threads_have_the_bits_of_one_alone(name: str) -> None:
    random = np.random.default_rng(3)
    mass = np.array([1.0, 0.0, 0.0]) if name == "gravity" else np.ones(3)
    bodies = vv.Particles(mass, *random.uniform(-1, 1, (2, 3, 3)))
    scene = vv.Scene(bodies, *FORCES[name])
    times = np.linspace(0.0, 3.0, 301)
    position = bodies.position + random.uniform(-0.1, 0.1, (11, 3, 3))
    record = ("position", "velocity", "momentum")
    runs = [scene.ensemble(position=position).run(t=times, threads=n, record=record) for n in (1, 2, 3)]
    assert runs[1].plan.closed_form
    assert runs[1].plan.threads == 2
    for member in range(11):
        alone = scene.with_state(position[member], bodies.velocity).run(t=times, threads=1, record=record)
        # The state at the start is the one that was given.
        assert np.array_equal(alone.position[0], position[member])
        assert np.array_equal(alone.velocity[0], bodies.velocity)
        for out in runs:
            assert np.array_equal(out.position[member], alone.position)
            assert np.array_equal(out.velocity[member], alone.velocity)
            assert np.array_equal(out.momentum[member], alone.momentum)
            assert np.array_equal(out[member].final.particles.position, alone.position[-1])


def test_straight_lines_and_parabolas_at_the_ends_of_the_range() -> None:
    def run(velocity: float, t: float, *forces: Force) -> vv.Trajectory:
        return vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[velocity, 0.0, 0.0]]), *forces).run(t=t)

    # Splitting factors above 2^996 overflowed: NaN with status OK.
    far = run(1e-5, 1e302)
    assert far.position[-1, 0, 0] == 1e-5 * 1e302
    assert far.velocity[-1, 0, 0] == 1e-5
    assert run(1e-300, 1e308).position[-1, 0, 0] == pytest.approx(1e8, rel=2e-16)
    tall = run(0.0, 1e302, vv.UniformField([2e-300, 0.0, 0.0]))
    assert tall.velocity[-1, 0, 0] == 2e-300 * 1e302
    assert tall.position[-1, 0, 0] == pytest.approx(1e304, rel=4e-16)
    with pytest.raises(vv.InvalidInput, match=r"^t: expected times within the range"):
        vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]]), t0=-1.5e308).run(t=1.5e308)
    for forces in ((), (vv.LinearDrag(1e308),), (vv.UniformMagneticField([1e-308, 0.0, 0.0]),)):
        with pytest.raises(vv.ConvergenceError, match="infinite"):
            run(1e300, 1e10, *forces)


def test_one_member_beyond_the_range_spoils_no_other() -> None:
    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]))
    velocity = np.array([[[1.0, 0.0, 0.0]], [[1e300, 0.0, 0.0]], [[2.0, 0.0, 0.0]]])
    out = scene.ensemble(velocity=velocity).run(t=[1.0, 1e8, 1e9])
    assert [int(status) != 0 for status in out.status] == [False, True, False]
    assert np.isnan(out.position[1, 2]).all()
    assert out.position[1, 1, 0, 0] == 1e308
    assert out.position[2, 2, 0, 0] == 2e9
    assert out[1].final.t0 == 1e8


def three(masses: list[float]) -> vv.Particles:
    position = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.1]]
    return vv.Particles(masses, position, [[0.0, 0.0, 0.1], [0.0, 1.0, 0.0], [0.7, 0.0, 0.0]])


def test_members_that_differ_run_what_the_plan_says() -> None:
    """Closed forms ran while plan and stats said dop853, and progress ended at 400 %."""
    scene = vv.Scene(three([1.0, 0.0, 0.0]), vv.Gravity(1.0))
    masses = np.array([[1.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.0]])
    seen: list[tuple[int, int]] = []
    mixed = scene.ensemble(mass=masses).run(t=[1.0, 2.0], progress=lambda done, total: seen.append((done, total)))
    assert mixed.plan.solution == "integration (1), closed form: Kepler orbits (2), straight lines (1)"
    assert not mixed.plan.closed_form
    assert mixed.plan.method == "taylor"
    assert seen[-1][0] == seen[-1][1]
    for member, mass in enumerate(masses):
        alone = vv.Scene(three(list(mass)), vv.Gravity(1.0)).run(t=[1.0, 2.0])
        assert alone.plan.closed_form == (member != 1)
        assert np.array_equal(mixed.position[member], alone.position)
        assert np.array_equal(mixed.velocity[member], alone.velocity)
    closed = scene.ensemble(mass=masses[[0, 2, 3]]).run(t=1.0)
    assert closed.plan.solution == "closed form: Kepler orbits (2), straight lines (1)"
    assert closed.stats.evaluations == 0


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
@pytest.mark.parametrize("threads", [1, 2])
def test_an_interrupted_closed_form_keeps_its_rows(threads: int) -> None:
    """It lost all that was computed."""
    random = np.random.default_rng(1)
    scene = vv.Scene(vv.Particles(np.eye(1, 100)[0], *random.uniform(-1, 1, (2, 100, 3))), vv.Gravity(1.0))
    times = np.linspace(0.0, 10.0, 60_001)

    def handler(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(vv.Interrupted) as caught:
            scene.run(t=times, threads=threads, record=("position", "kinetic_energy"))
    finally:
        signal.signal(signal.SIGALRM, before)
    part = caught.value.trajectory
    rows = len(part.t)
    assert 0 < rows < len(times)
    again = scene.run(t=times[:rows], record=("position", "kinetic_energy"))
    assert np.array_equal(part.position, again.position)
    assert np.array_equal(part.kinetic_energy, again.kinetic_energy)
    assert part.final.t0 == times[rows - 1]
    assert np.array_equal(part.final.particles.position, again.position[-1])


def test_a_center_too_weak_for_a_number_still_pulls() -> None:
    # k/m = 1e-350 is no number; in units of 2^-332 and 2^83 the orbit is one of size and period about 1.
    center = vv.CentralField(vv.potentials.Coulomb(-1e-200))
    scene = vv.Scene(vv.Particles([1e150], [[1e-100, 0.0, 0.0]], [[0.0, 1.2e-125, 0.0]]), center)
    out = scene.run(2e25, rtol=1e-13)
    assert not out.plan.closed_form
    near_one = scene.rescaled(length=2.0**332, mass=2.0**-498, time=2.0**-83)
    closed = near_one.run(2e25 * 2.0**-83)
    assert closed.plan.closed_form
    assert out.position[-1] * 2.0**332 == pytest.approx(closed.position[-1], rel=1e-11, abs=0)
