"""Derivatives of the flow of a scene: closed forms, Lagrangians with exact derivatives, and what forces conserve.

Bounds: most forces tell their derivatives by formulas, and what is off is what steps leave; those of others are
differences of evaluations, right to 1e-11. Motions amplify both by what they do to neighbors.
"""

import warnings
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, z, vx, vy, vz = sp.symbols("x y z vx vy vz", real=True)

ONE = vv.Particles([2.0], [[1.0, 0.25, -0.5]], [[0.5, -1.0, 0.125]])
TIMES = [0.0, 0.75, 2.0, 5.0]


def symplectic(flow: Any, masses: Any) -> float:
    """How far MᵀJM is from J, of places and momenta, beside the largest number of M."""
    n = len(flow) // 2
    scale = np.repeat(np.r_[np.ones(n // 3), masses], 3)
    flow = flow * scale[:, None] / scale
    form = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    return float(np.abs(flow.T @ form @ flow - form).max() / max(1.0, np.abs(flow).max() ** 2))


def test_a_free_body_goes_on() -> None:
    flow = vv.Scene(ONE).flow_jacobian(TIMES)
    assert flow.shape == (4, 6, 6)
    for t, matrix in zip(TIMES, flow, strict=True):
        expected = np.block([[np.eye(3), t * np.eye(3)], [np.zeros((3, 3)), np.eye(3)]])
        # One step or a few, rounded.
        np.testing.assert_allclose(matrix, expected, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("end", [3.0, -3.0, 40.0])
def test_an_oscillator_turns(end: float) -> None:
    flow = vv.Scene(ONE, vv.Harmonic(k=8.0)).flow_jacobian(end)
    c, s = np.cos(2.0 * end), np.sin(2.0 * end)
    expected = np.kron([[c, s / 2.0], [-2.0 * s, c]], np.eye(3))
    # The tolerance of a step and of a derivative, 1e-11, of at most a hundred radians.
    np.testing.assert_allclose(flow, expected, rtol=0.0, atol=1e-9)


def test_drag_takes_volume_away() -> None:
    flow = vv.Scene(ONE, [vv.LinearDrag(tau=4.0), vv.UniformField((0.0, 0.0, -9.81))]).flow_jacobian(3.0)
    rate = 0.25
    fall = np.exp(-3.0 * rate)
    expected = np.kron([[1.0, (1.0 - fall) / rate], [0.0, fall]], np.eye(3))
    np.testing.assert_allclose(flow, expected, rtol=0.0, atol=1e-10)
    # Liouville: the divergence of the flow is −3 rate.
    assert np.linalg.det(flow) == pytest.approx(np.exp(-9.0 * rate), rel=1e-10, abs=0.0)


def kepler_lagrangian(masses: Any, position: Any, velocity: Any) -> vv.Lagrangian:
    count = len(masses)
    places = [sp.symbols(f"x{i} y{i} z{i}", real=True) for i in range(count)]
    rates = [sp.symbols(f"u{i} v{i} w{i}", real=True) for i in range(count)]
    kinetic = sum(m * sum(u**2 for u in r) / 2 for m, r in zip(masses, rates, strict=True))
    potential = sum(
        -masses[i] * masses[j] / sp.sqrt(sum((a - b) ** 2 for a, b in zip(places[i], places[j], strict=True)))
        for i in range(count)
        for j in range(i)
    )
    return vv.Lagrangian(
        kinetic - potential,
        [q for each in places for q in each],
        velocities=[u for each in rates for u in each],
        position=np.ravel(position),
        velocity=np.ravel(velocity),
    )


MASSES = [1.0, 0.5, 0.25]
PLACES = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.25], [0.0, -3.0, 0.5]]
VELOCITIES = [[0.0, -0.25, 0.0], [0.0, 0.75, 0.125], [0.5, 0.0, 0.0]]
THREE = vv.Scene(vv.Particles(MASSES, PLACES, VELOCITIES), vv.Gravity(G=1.0))


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "tsitouras54"])
def test_three_bodies_as_by_exact_derivatives(method: str) -> None:
    expected = kepler_lagrangian(MASSES, PLACES, VELOCITIES).flow_jacobian(6.0)
    flow = THREE.flow_jacobian(6.0, method=method, rtol=1e-12)
    assert np.abs(flow - expected).max() < 2e-9 * np.abs(expected).max()
    assert symplectic(flow, MASSES) < 1e-9


def test_two_legs_make_one_flow() -> None:
    half = THREE.run(3.0, rtol=1e-13)
    first, whole = THREE.flow_jacobian([3.0, 6.0], rtol=1e-13)
    second = half.final.flow_jacobian(6.0, rtol=1e-13)
    assert np.abs(second @ first - whole).max() < 1e-9 * np.abs(whole).max()


@pytest.mark.parametrize("method", ["leapfrog", "yoshida4", "blanes_moan_rkn6_14", "rk4"])
def test_equal_steps_have_derivatives_of_their_own(method: str) -> None:
    # What the method does, of which leapfrog errs by 1e-4: its derivative is that of neighboring runs.
    flow = THREE.flow_jacobian([1.0, 2.5], method=method, dt=0.01)
    apart = 1e-4
    p = THREE.particles
    states = np.concatenate([p.position.ravel(), p.velocity.ravel()])
    numbers = len(states)
    starts = states + apart * np.concatenate([np.eye(numbers), -np.eye(numbers)])
    halves = starts.reshape(2 * numbers, 2, 3, 3)
    out = THREE.ensemble(position=halves[:, 0], velocity=halves[:, 1]).run([1.0, 2.5], method=method, dt=0.01)
    for row in (0, 1):
        ends = np.concatenate([out.position[:, row].reshape(-1, 9), out.velocity[:, row].reshape(-1, 9)], axis=1)
        expected = (ends[:numbers] - ends[numbers:]).T / (2.0 * apart)
        # The third derivatives of the flow, some hundreds, times 1e-8.
        np.testing.assert_allclose(flow[row], expected, rtol=0.0, atol=1e-5)
        if method != "rk4":
            assert symplectic(flow[row], MASSES) < 1e-10


@pytest.mark.parametrize("width", [1.0, 1e-2, 1e-3])
def test_forces_that_change_over_a_short_way(width: float) -> None:
    scene = vv.Scene(
        vv.Particles([1.0], [[-1.0, 0.0, 0.0]], [[1.5, 0.0, 0.0]]),
        vv.ExpressionForce(potential=lambda r, v, t: np.tanh(r[0] / width)),
    )
    flow = scene.flow_jacobian(1.75, method="verner98", rtol=1e-13)
    line = vv.Lagrangian(
        vx**2 / 2 - sp.tanh(x / sp.Float(width)), [x], velocities=[vx], position=[-1.0], velocity=[1.5]
    )
    expected = line.flow_jacobian(1.75)
    assert np.abs(flow[np.ix_([0, 3], [0, 3])] - expected).max() < 1e-8 * np.abs(expected).max()


def test_copies_have_the_flows_that_they_have_alone() -> None:
    turned = THREE.particles.velocity * np.array([1.0, 1.01, 0.97])[:, None, None]
    copies = THREE.ensemble(velocity=turned)
    flow = copies.flow_jacobian([1.0, 4.0])
    assert flow.shape == (3, 2, 18, 18)
    assert np.array_equal(flow, copies.flow_jacobian([1.0, 4.0], threads=1))
    for copy, scene in zip(flow, copies, strict=True):
        assert np.array_equal(copy, scene.flow_jacobian([1.0, 4.0]))


def test_many_bodies_and_massless_ones() -> None:
    generator = np.random.default_rng(5)
    mass = np.r_[1.0, np.full(9, 1e-4), np.zeros(2)]
    angle = np.linspace(0.0, 5.0, 12)
    radius = np.r_[0.0, np.linspace(1.0, 3.0, 11)]
    place = radius[:, None] * np.c_[np.cos(angle), np.sin(angle), 0.1 * generator.normal(size=12)]
    speed = np.r_[0.0, radius[1:] ** -0.5][:, None] * np.c_[-np.sin(angle), np.cos(angle), 0.0 * angle]
    scene = vv.Scene(vv.Particles(mass, place, speed), vv.Gravity(G=1.0))
    flow = scene.flow_jacobian(2.0, rtol=1e-12)
    # A massless body moves nobody else.
    others = np.r_[np.arange(30), 36 + np.arange(30)]
    for body in (10, 11):
        own = np.r_[3 * body + np.arange(3), 36 + 3 * body + np.arange(3)]
        # But for rounding of the differences of evaluations.
        assert np.abs(flow[np.ix_(others, own)]).max() < 1e-11
    assert symplectic(flow[np.ix_(others, others)], mass[:10]) < 1e-9
    # All are shifted alike, and with them what they become.
    shift = np.tile(np.eye(3), (12, 1))
    moved = flow[:, :36] @ shift
    np.testing.assert_allclose(moved, np.vstack([shift, np.zeros((36, 3))]), rtol=0.0, atol=1e-9)


def kepler(eccentricity: float, mass: float = 0.0) -> vv.Scene:
    """From the far end of an orbit with a semi-major axis of 1 under a total mass of 1 + mass."""
    far, slow = 1.0 + eccentricity, np.sqrt((1.0 + mass) * (1.0 - eccentricity) / (1.0 + eccentricity))
    return vv.Scene(
        vv.Particles([1.0, mass], [[0.0, 0.0, 0.0], [far, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, slow, 0.0]]),
        vv.Gravity(G=1.0),
    )


def kepler_flow(scene: vv.Scene, t: float) -> Any:
    """Derivatives of the closed form (f and g functions) of the motion of a massless body, with 50 digits."""
    with mp.workdps(50):
        start = [mp.mpf(float(x)) for x in np.concatenate([scene.particles.position[1], scene.particles.velocity[1]])]

        def state(y: Any) -> Any:
            place, velocity = y[:3], y[3:]
            r, rate = mp.sqrt(mp.fdot(place, place)), mp.fdot(place, velocity)
            a = 1 / (2 / r - mp.fdot(velocity, velocity))
            n, from_r, from_rate = a ** mp.mpf(-1.5), 1 - r / a, rate / mp.sqrt(a)

            def kepler_equation(x: Any) -> Any:
                return x - from_r * mp.sin(x) + from_rate * (1 - mp.cos(x)) - n * t

            # It grows with x, and lies within 2 of the mean anomaly.
            low, high = n * t - 2, n * t + 2
            for _ in range(20):
                middle = (low + high) / 2
                low, high = (low, middle) if kepler_equation(middle) > 0 else (middle, high)
            x = (low + high) / 2
            for _ in range(9):
                x -= kepler_equation(x) / (1 - from_r * mp.cos(x) + from_rate * mp.sin(x))
            f, g = 1 - a / r * (1 - mp.cos(x)), t - (x - mp.sin(x)) / n
            there = [f * p + g * v for p, v in zip(place, velocity, strict=True)]
            s = mp.sqrt(mp.fdot(there, there))
            fdot, gdot = -mp.sqrt(a) / (r * s) * mp.sin(x), 1 - a / s * (1 - mp.cos(x))
            return there + [fdot * p + gdot * v for p, v in zip(place, velocity, strict=True)]

        flow, apart = np.zeros((6, 6)), mp.mpf(10) ** -18
        for number in range(6):
            above, below = list(start), list(start)
            above[number] += apart
            below[number] -= apart
            ends = zip(state(above), state(below), strict=True)
            flow[:, number] = [float((p - q) / (2 * apart)) for p, q in ends]
        return flow


# In between neighbors become larger than at the end by about (1 − e)⁻³ᐟ², and what steps leave with them: measured at a
# tolerance of 1e-13 2e-12, 2e-9, 4e-7 and 1e-4.
@pytest.mark.parametrize(("eccentricity", "off"), [(0.9, 1e-11), (0.99, 1e-8), (0.999, 2e-6), (0.9999, 5e-4)])
def test_a_narrow_pericenter(eccentricity: float, off: float) -> None:
    scene, end = kepler(eccentricity), 1.8 * np.pi
    expected = kepler_flow(scene, end)
    own = np.r_[3:6, 9:12]
    with warnings.catch_warnings():
        if eccentricity > 0.9995:
            warnings.simplefilter("ignore", vv.AccuracyWarning)
        flow = scene.flow_jacobian(end, rtol=1e-13)[np.ix_(own, own)]
    assert np.abs(flow - expected).max() < off * np.abs(expected).max()


@pytest.mark.parametrize("softening", [0.0, 0.1])
@pytest.mark.parametrize("eccentricity", [0.5, 0.9])
def test_a_flow_is_symplectic_to_the_tolerance(eccentricity: float, softening: float) -> None:
    scene = kepler(eccentricity, mass=0.25)
    scene = vv.Scene(scene.particles, vv.Gravity(G=1.0, softening=softening))
    # Beside the square of the largest number of M: measured 7e-14 at most, of some dozen steps at 1e-13.
    assert symplectic(scene.flow_jacobian(9.0, rtol=1e-13), [1.0, 0.25]) < 1e-12


def test_charges_as_masses_with_another_sign() -> None:
    # Charges of q₁q₂ k = −G m₁m₂ attract each other as masses do.
    masses = [1.0, 0.5, 0.25]
    alike = vv.Coulomb([1.0, 0.5, 0.25], k=-1.0)
    bodies = vv.Particles(masses, PLACES, VELOCITIES)
    flow = vv.Scene(bodies, alike).flow_jacobian(6.0, rtol=1e-13)
    wanted = THREE.flow_jacobian(6.0, rtol=1e-13)
    np.testing.assert_allclose(flow, wanted, rtol=0.0, atol=1e-11 * np.abs(wanted).max())


@pytest.mark.parametrize("kind", ["potential", "formula"])
def test_a_fixed_center_by_other_means(kind: str) -> None:
    scene, end = kepler(0.99), 1.8 * np.pi
    center = {
        "potential": vv.CentralField(vv.potentials.PowerLaw(k=-1.0, n=1.0)),
        "formula": vv.ExpressionForce(potential=lambda r, v, t: -1.0 / np.sqrt(r[0] ** 2 + r[1] ** 2 + r[2] ** 2)),
    }[kind]
    p = scene.particles
    alone = vv.Scene(vv.Particles([1.0], p.position[1:], p.velocity[1:]), center)
    expected = kepler_flow(scene, end)
    flow = alone.flow_jacobian(end, rtol=1e-13)
    # As the same orbit under gravity.
    assert np.abs(flow - expected).max() < 1e-8 * np.abs(expected).max()


def test_pairs_by_a_potential_as_by_gravity() -> None:
    bodies = vv.Particles([1.0, 1.0, 1.0], PLACES, VELOCITIES)
    flow = vv.Scene(bodies, vv.PairPotential(vv.potentials.PowerLaw(k=-1.0, n=1.0))).flow_jacobian(4.0, rtol=1e-13)
    wanted = vv.Scene(bodies, vv.Gravity(G=1.0)).flow_jacobian(4.0, rtol=1e-13)
    np.testing.assert_allclose(flow, wanted, rtol=0.0, atol=1e-11 * np.abs(wanted).max())


def test_drag_of_a_formula_from_rest() -> None:
    # The slope of a root is none where it vanishes: such a formula is compared with itself, and is a number there.
    drag = vv.ExpressionForce(
        force=lambda r, v, t: tuple(-v[c] * np.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2) for c in range(3))
    )
    bodies = vv.Particles([1.0], [[1.0, 0.5, 0.0]])
    pull = vv.UniformField((0.0, 0.0, -1.0))
    flow = vv.Scene(bodies, [drag, pull]).flow_jacobian(1.0, rtol=1e-12)
    wanted = vv.Scene(bodies, [vv.QuadraticDrag(1.0), pull]).flow_jacobian(1.0, rtol=1e-12)
    np.testing.assert_allclose(flow, wanted, rtol=0.0, atol=1e-9)
    # v = −tanh t falls, and by its change at the start as 1/cosh².
    assert wanted[5, 5] == pytest.approx(1.0 / np.cosh(1.0) ** 2, rel=1e-11, abs=0.0)


def test_forces_with_and_without_formulas_add_up() -> None:
    # Half of a spring by its formula, half compared with itself at neighboring states, beside gravity.
    bodies = vv.Particles(MASSES, PLACES, VELOCITIES)
    both = vv.Scene(bodies, [vv.Gravity(G=0.5), angled(0.5), vv.Harmonic(k=0.5)])
    exact = vv.Scene(bodies, [vv.Gravity(G=0.5), vv.Harmonic(k=1.0)])
    flow, wanted = both.flow_jacobian(4.0, rtol=1e-12), exact.flow_jacobian(4.0, rtol=1e-12)
    # Differences of forces are right to 1e-11 and what they add up to is amplified by less than a hundred.
    np.testing.assert_allclose(flow, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())


def angled(k: float) -> vv.ExpressionForce:
    """A harmonic force, and next to nothing of an angle: formulas with angles are compared with themselves."""
    return vv.ExpressionForce(
        force=lambda r, v, t: (-k * r[0] + 1e-30 * np.arctan2(r[1] - 7.0, r[0] - 7.0), -k * r[1], -k * r[2])
    )


@pytest.mark.parametrize("length", [2.0**-300, 2.0**200])
def test_units_are_no_matter(length: float) -> None:
    p = THREE.particles
    speed = length**-0.5
    other = vv.Scene(vv.Particles(p.mass, p.position * length, p.velocity * speed), vv.Gravity(G=1.0))
    flow, wanted = other.flow_jacobian(2.0 * length / speed), THREE.flow_jacobian(2.0)
    unit = np.repeat([length, speed], 9)
    np.testing.assert_allclose(flow * unit / unit[:, None], wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())


def test_what_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="taylor follows no neighbors"):
        THREE.flow_jacobian(1.0, method="taylor")
    with pytest.raises(vv.InvalidInput, match="neighbors of rigid bodies"):
        vv.Scene(vv.RigidBody(mass=1.0, moments=[1.0, 2.0, 2.5], angular_velocity=[0.1, 0.2, 0.3])).flow_jacobian(1.0)
    with pytest.raises(vv.InvalidInput, match="t"):
        THREE.flow_jacobian([1.0, 0.5])
    fall = vv.Scene(vv.Particles([1.0, 1.0], [[-1.0, 0, 0], [1.0, 0, 0]], np.zeros((2, 3))), vv.Gravity(G=1.0))
    with pytest.raises(vv.Error):
        fall.flow_jacobian(100.0)
    valley = vv.ExpressionForce(potential=lambda r, v, t: abs(r[0]))
    with pytest.raises(vv.InvalidInput, match="absolute values"):
        vv.Scene(ONE, valley).flow_jacobian(1.0)


def test_a_narrow_bump_that_a_run_sees_is_seen() -> None:
    # A pulse of the stiffness, one in all: x is thrown back by as much as it is off, whatever its width.
    for width in (1e-2, 1e-4):
        pulse = vv.ExpressionForce(
            force=lambda r, v, t, w=width: (-r[0] + r[0] * np.exp(-(((t - 1.0) / w) ** 2)) / w, 0 * r[0], 0 * r[0])
        )
        scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]), pulse)
        # The motion is linear in where it begins.
        expected = scene.run(2.0, rtol=1e-12).position[-1, 0, 0]
        assert scene.flow_jacobian(2.0)[0, 0] == pytest.approx(expected, rel=1e-6, abs=0.0)


def test_a_copy_that_loses_its_derivatives_is_told_and_spoils_no_other() -> None:
    def pull(r: Any, v: Any, t: Any) -> Any:
        # Of an angle the slope is not known everywhere: forces are compared at neighboring places.
        weight = (r[0] ** 2 + r[1] ** 2) ** -1.5
        return -r[0] * weight + 1e-30 * np.arctan2(r[1], r[0]), -r[1] * weight, 0 * r[2]

    slow = [np.sqrt(0.5 / 1.5), np.sqrt(1e-4 / 1.9999)]
    scene = vv.Scene(vv.Particles([1.0], [[1.5, 0.0, 0.0]]), vv.ExpressionForce(acceleration=pull))
    copies = scene.ensemble(
        position=[[[far, 0.0, 0.0]] for far in (1.5, 1.9999)],
        velocity=[[[0.0, speed, 0.0]] for speed in slow],
    )
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, derivatives of the motion are off by"):
        flow = copies.flow_jacobian(1.8 * np.pi)
    assert np.isnan(flow[1]).all()
    assert np.array_equal(flow[0], copies[0].flow_jacobian(1.8 * np.pi))
    with pytest.raises(vv.ConvergenceError, match="derivatives of the motion are off by"):
        copies[1].flow_jacobian(1.8 * np.pi)
