"""Derivatives of the flow of a scene: closed forms, Lagrangians with exact derivatives, and what forces conserve.

Bounds: derivatives of forces are differences of evaluations, right to 1e-11; motions amplify that by what they do to
neighbors.
"""

import warnings
from typing import Any

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


@pytest.mark.parametrize("eccentricity", [0.97, 0.99, 0.999, 0.9999])
def test_what_a_narrow_pericenter_takes_is_told(eccentricity: float) -> None:
    # Neighbors become a million times as large there as at the end, so rounding of derivatives (1e-11) is not.
    far, slow = 1.0 + eccentricity, np.sqrt((1.0 - eccentricity) / (1.0 + eccentricity))
    scene = vv.Scene(
        vv.Particles([1.0, 0.0], [[0.0, 0.0, 0.0], [far, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, slow, 0.0]]),
        vv.Gravity(G=1.0),
    )
    line = vv.Lagrangian(
        (vx**2 + vy**2) / 2 + 1 / sp.sqrt(x**2 + y**2),
        [x, y],
        velocities=[vx, vy],
        position=[far, 0.0],
        velocity=[0.0, slow],
    )
    end = 1.8 * np.pi
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        if eccentricity > 0.995:
            with pytest.raises(vv.ConvergenceError, match="derivatives of the motion are off by"):
                scene.flow_jacobian(end)
            return
        flow = scene.flow_jacobian(end)[np.ix_([3, 4, 9, 10], [3, 4, 9, 10])]
    expected = line.flow_jacobian(end, rtol=1e-13)
    off = np.abs(flow - expected).max() / np.abs(expected).max()
    # What is told is of the size of what is off, and nothing is said of a part in a million.
    assert off < (1e-3 if told else 1e-5), off


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
    slow = [np.sqrt(0.5 / 1.5), np.sqrt(1e-4 / 1.9999)]
    scene = vv.Scene(vv.Particles([1.0, 0.0], [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0]], np.zeros((2, 3))), vv.Gravity(G=1.0))
    copies = scene.ensemble(
        position=[[[0.0, 0.0, 0.0], [far, 0.0, 0.0]] for far in (1.5, 1.9999)],
        velocity=[[[0.0, 0.0, 0.0], [0.0, speed, 0.0]] for speed in slow],
    )
    with pytest.warns(vv.AccuracyWarning, match="in copy 1, derivatives of the motion are off by"):
        flow = copies.flow_jacobian(1.8 * np.pi)
    assert np.isnan(flow[1]).all()
    assert np.array_equal(flow[0], copies[0].flow_jacobian(1.8 * np.pi))
