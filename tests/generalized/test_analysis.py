"""Closed forms: periods, actions, modes, equilibria; other descriptions of a system; its flow and its sections.

Bounds: quadratures and eigenvalues to some roundings (EPSILON times what conditions them: the distance of the top,
the ratio of eigenvalues); runs of two forms of a system, which round apart, to ten times what they part by in their
time, 1e-13 to 1e-12 of their size.
"""

import json
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from by_symbols import chain, coordinates

import visviva as vv

EPSILON = 2.0**-52
KEPT = json.loads((Path(__file__).parent / "reference.json").read_text(encoding="utf-8"))["closed_forms"]
PENDULUM = vv.systems.pendulum(g=1.0)


# Near the top a period knows θ₀ by its distance from π.
@pytest.mark.parametrize("angle", KEPT["pendulum_periods"])
def test_periods_of_a_pendulum(angle: str) -> None:
    found = PENDULUM.at(position=[float(angle)]).period()
    conditioning = 1.0 + float(angle) / (np.pi - float(angle))
    assert found == pytest.approx(float(KEPT["pendulum_periods"][angle]), rel=32 * EPSILON * conditioning, abs=0)
    # From the other side, and from the middle of the motion.
    assert PENDULUM.at(position=[-float(angle)]).period() == pytest.approx(found, rel=1e-14 * conditioning, abs=0)
    if float(angle) < 3.0:
        speed = 2 * np.sin(float(angle) / 2)
        middle = PENDULUM.at(position=[0.0], velocity=[speed])
        assert middle.period() == pytest.approx(found, rel=1e-13 * conditioning, abs=0)


@pytest.mark.parametrize("swing", [1e-8, 1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_periods_of_small_swings_have_every_digit(swing: float, offset: float) -> None:
    """Energies of small swings differ in their last digits; the period knows nothing of that, nor of V = 0."""
    with mpmath.workdps(50):  # of which the difference in the action takes 17
        k2 = mpmath.sin(mpmath.mpf(swing) / 2) ** 2
        period = 4 * mpmath.ellipk(k2)
        action = 8 / mpmath.pi * (mpmath.ellipe(k2) - (1 - k2) * mpmath.ellipk(k2))
    pendulum = vv.Lagrangian(lambda q, v, _: v[0] ** 2 / 2 + np.cos(q[0]) + offset, ["theta"], position=[swing])
    assert pendulum.period() == pytest.approx(float(period), rel=4 * EPSILON, abs=0)
    assert pendulum.action_variable() == pytest.approx(float(action), rel=16 * EPSILON, abs=0.0)


def test_a_wide_swing_far_above_zero() -> None:
    pendulum = vv.Lagrangian(lambda q, v, _: v[0] ** 2 / 2 + np.cos(q[0]) - 1e9, ["theta"], position=[3.0])
    assert pendulum.period() == pytest.approx(float(KEPT["pendulum_periods"]["3"]), rel=1e-14, abs=0)


@pytest.mark.parametrize("angle", KEPT["pendulum_action"])
def test_actions_of_a_pendulum(angle: str) -> None:
    found = PENDULUM.at(position=[float(angle)]).action_variable()
    assert found == pytest.approx(float(KEPT["pendulum_action"][angle]), rel=32 * EPSILON, abs=0)


def test_the_period_is_the_slope_of_the_action() -> None:
    """T = 2π dJ/dE, by differences."""
    for angle in (0.5, 1.5, 2.8):
        near = [PENDULUM.at(position=[angle + step]) for step in 1e-3 * np.array([-2, -1, 1, 2])]
        weights = np.array([1, -8, 8, -1])
        slope = weights @ [one.action_variable() for one in near] / (weights @ [one.energy for one in near])
        # Differences of fourth order with steps of 1e-3 leave 1e-12, a little more next to the top (measured 1.9e-12).
        assert 2 * np.pi * slope == pytest.approx(PENDULUM.at(position=[angle]).period(), rel=1e-11, abs=0)


@pytest.mark.parametrize("speed", [2.1, 3.0, 10.0])
def test_a_pendulum_that_goes_over_the_top(speed: float) -> None:
    """2 k K(k) and (4/πk) E(k) with k = 2/θ̇₀ at the bottom; forward or backward."""
    with mpmath.workdps(30):
        k = 2 / mpmath.mpf(speed)
        period, action = 2 * k * mpmath.ellipk(k**2), 4 / (mpmath.pi * k) * mpmath.ellipe(k**2)
    for sign in (1.0, -1.0):
        over = PENDULUM.at(position=[0.0], velocity=[sign * speed])
        assert over.period(turn=2 * np.pi) == pytest.approx(float(period), rel=1e-14, abs=0)
        assert abs(over.action_variable(turn=2 * np.pi)) == pytest.approx(float(action), rel=1e-14, abs=0)
    with pytest.raises(vv.InvalidInput):
        over.period()
    with pytest.raises(vv.InvalidInput):
        PENDULUM.period(turn=2 * np.pi)
    out = over.run(float(period))
    assert out.position[-1, 0] == pytest.approx(-2 * np.pi, rel=1e-14, abs=0)


@pytest.mark.parametrize("exponent", range(2, 16))
@pytest.mark.parametrize("moving", [False, True])
def test_periods_beside_a_separatrix_are_right_or_refused(exponent: int, moving: bool) -> None:
    """4 K(sin²(θ₀/2)) at θ₀ = π − 10⁻ⁿ as a float has it: what rounding of the energy does grows as 10²ⁿ."""
    start = np.pi - 10.0**-exponent
    with mpmath.workdps(50):
        half = mpmath.mpf(start) / 2
        period = 4 * mpmath.ellipk(mpmath.sin(half) ** 2)
        speed = float(2 * mpmath.sin(half))
    system = PENDULUM.at(position=[0.0], velocity=[speed]) if moving else PENDULUM.at(position=[start])
    if exponent <= 5 and not moving:
        # The energy is rounded by 2e-16, and 1/2 of the square of the distance is left to the top.
        assert system.period() == pytest.approx(float(period), rel=1e-14 + 4e-16 * 10.0 ** (2 * exponent) / 10, abs=0.0)
        return
    try:
        found = system.period()
    except vv.InvalidInput:
        with pytest.raises(vv.InvalidInput, match="standing still"):
            system.period()
        return
    # Of a motion that is known by its speed, what the rounding of that makes, too.
    known = 1e-16 * 10.0 ** (2 * exponent) if moving else 0.0
    assert found == pytest.approx(float(period), rel=2e-6 + known, abs=0.0)


@pytest.mark.parametrize("kept", ["plane_pendulum_k0.999", "plane_pendulum_k0.999_float"])
def test_a_pendulum_near_the_top(kept: str) -> None:
    """θ = 2 asin(k cd(t | k²)) at k = 0.999, up to t = 1000; of a decimal k with what its rounding does."""
    start = float(KEPT[kept]["theta0"])
    system = PENDULUM.at(position=[start])
    assert system.period() == pytest.approx(float(KEPT[kept]["period"]), rel=64 * EPSILON / (np.pi - start), abs=0)
    conditionings = [float(row["conditioning_theta0"]) for row in KEPT["plane_pendulum_k0.999"]["rows"]]
    for row, conditioning in zip(KEPT[kept]["rows"], conditionings, strict=True):
        # 56 periods, and the rounding of 3000 steps.
        assert abs(system.run(float(row["t"])).position[-1, 0] - float(row["theta"])) <= 64 * EPSILON * conditioning


def test_modes_of_chains() -> None:
    kept = KEPT["double_pendulum_normal_modes"]
    for double in (vv.systems.double_pendulum(), chain(2, position=[0.0, 0.0])):
        modes = double.normal_modes([0.0, 0.0])
        assert modes.frequencies == pytest.approx([float(w) for w in kept["omega"]], rel=4 * EPSILON, abs=0)
        ratios = modes.modes[:, 1] / modes.modes[:, 0]
        assert ratios == pytest.approx([float(ratio) for ratio in kept["ratio_theta2_theta1"]], rel=8 * EPSILON, abs=0)
        assert modes.modes @ modes.mass @ modes.modes.T == pytest.approx(np.eye(2), abs=8 * EPSILON)
    ten = vv.systems.chain(10).normal_modes(np.zeros(10))
    # The smallest of eigenvalues between 1 and 300.
    kept = [float(w) for w in KEPT["chain_10_normal_modes"]["omega"]]
    assert ten.frequencies == pytest.approx(kept, rel=300 * EPSILON, abs=0)
    # Small motions at any time are those of the system, to the square of the angles.
    small = 1e-5 * np.linspace(1.0, 2.0, 10)
    out = vv.systems.chain(10, position=small).run([1.0, 10.0])
    assert np.abs(ten.at([1.0, 10.0], small, np.zeros(10)) - out.position).max() <= 1e-3 * 1e-5**2 * 100


def test_equilibria_of_the_hoop_and_of_pendulums() -> None:
    kept = KEPT["bead_on_hoop_Omega4"]
    found = vv.systems.hoop().equilibria()
    assert [round(float(one.position[0]), 3) for one in found] == [-3.142, -0.911, 0.0, 0.911, 3.142]
    assert [one.stable for one in found] == [False, True, False, True, False]
    assert found[3].position[0] == pytest.approx(float(kept["theta_eq"]), rel=4 * EPSILON, abs=0)
    assert found[3].frequencies == pytest.approx([float(kept["small_frequency"])], rel=4 * EPSILON, abs=0)
    critical = float(kept["critical_Omega"])
    assert len(vv.systems.hoop(Omega=critical * 0.999).equilibria()) == 3
    assert len(vv.systems.hoop(Omega=critical * 1.001).equilibria()) == 5
    four = vv.systems.double_pendulum().equilibria()
    down = [one for one in four if one.stable]
    assert len(down) == 1
    assert down[0].position == pytest.approx([0.0, 0.0], abs=1e-14)
    kinds = {tuple(np.round(np.abs(one.position) / np.pi, 6)) for one in four}
    assert kinds == {(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)}
    spring = vv.systems.spring_pendulum(g=9.81, k=40.0).equilibria(near=[[1.2, 0.1]])
    assert spring[0].position == pytest.approx([1.0 + 9.81 / 40.0, 0.0], abs=1e-13)
    assert spring[0].frequencies == pytest.approx(
        sorted([np.sqrt(40.0), np.sqrt(9.81 / (1 + 9.81 / 40))]), rel=1e-14, abs=0
    )


def test_a_gyroscope_may_be_stable_where_no_potential_is() -> None:
    """A charge on a hill, in a magnetic field: stable for B² > 4 k, and its frequencies have the sum B."""
    (x, y), (vx, vy) = coordinates("x y")
    B = sp.Symbol("B")
    hill = vv.Lagrangian(
        (vx**2 + vy**2) / 2 + (x**2 + y**2) / 2 + B * (x * vy - y * vx) / 2, [x, y], parameters={B: 3.0}
    )
    small = hill.linearize(at=[0.0, 0.0])
    assert small.stable
    assert small.frequencies.sum() == pytest.approx(3.0, rel=1e-14, abs=0)
    assert small.frequencies.prod() == pytest.approx(1.0, rel=1e-14, abs=0)
    assert not hill.at(parameters={B: 1.9}).linearize(at=[0.0, 0.0]).stable
    with pytest.raises(vv.InvalidInput, match=r"a force of .* acts on 'x' there; see equilibria"):
        hill.linearize(at=[0.1, 0.0])


@pytest.mark.parametrize(
    "name",
    ["pendulum", "double_pendulum", "spherical_pendulum", "charged_particle", "cart_pendulum", "hoop", "kapitza"],
)
def test_legendre_there_and_back(name: str) -> None:
    lagrangian: Any = getattr(vv.systems, name)()
    if name == "kapitza":
        lagrangian = lagrangian.at(parameters={"Omega": 5.0})
    hamiltonian = lagrangian.hamiltonian()
    again = hamiltonian.lagrangian()
    assert hamiltonian.energy == pytest.approx(lagrangian.energy, rel=1e-14, abs=0)
    assert hamiltonian.momentum == pytest.approx(lagrangian.momentum, rel=1e-14, abs=0)
    assert again.velocity == pytest.approx(lagrangian.velocity, rel=1e-13, abs=1e-14)
    times = np.linspace(0.0, 3.0, 7)
    out, other, third = (system.run(times, rtol=1e-15) for system in (lagrangian, hamiltonian, again))
    size = np.abs(out.position).max()
    assert np.abs(other.position - out.position).max() <= 1e-12 * size
    assert np.abs(third.position - out.position).max() <= 1e-12 * size
    assert np.abs(other.momentum - out.momentum).max() <= 5e-13 * np.abs(out.momentum).max()
    # ∂H/∂p is the velocity.
    assert np.abs(other.velocity - out.velocity).max() <= 1e-11 * np.abs(out.velocity).max()
    assert hamiltonian.cyclic == lagrangian.cyclic


def test_rouths_function_moves_the_rest() -> None:
    spherical = vv.systems.spherical_pendulum(velocity=[0.3, 1.5])
    reduced = spherical.routhian()
    assert reduced.coordinates == ("theta",)
    assert reduced.parameters["p_phi"] == spherical.momentum[1]
    times = np.linspace(0.0, 20.0, 41)
    assert np.abs(reduced.run(times)["theta"] - spherical.run(times)["theta"]).max() <= 1e-12
    # One degree of freedom is left, whose period comes by quadrature.
    period = reduced.period()
    assert reduced.run(period).position[-1] == pytest.approx(spherical.position[:1], rel=1e-12, abs=0)
    with pytest.raises(vv.InvalidInput, match="'theta' is not cyclic; cyclic are"):
        spherical.routhian({"theta": 1.0})


@pytest.mark.parametrize("name", ["henon_heiles", "pendulum", "double_pendulum"])
def test_the_flow_is_symplectic_and_its_derivative_is_one(name: str) -> None:
    system: Any = getattr(vv.systems, name)()
    hamiltonian = (
        system if name == "henon_heiles" else system.at(position=np.full(len(system.coordinates), 0.7)).hamiltonian()
    )
    n = len(hamiltonian.coordinates)
    jacobian = hamiltonian.flow_jacobian(5.0)
    J = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    size = np.abs(jacobian).max()
    assert np.abs(jacobian.T @ J @ jacobian - J).max() <= 1e-14 * size**2
    assert np.linalg.det(jacobian) == pytest.approx(1.0, abs=1e-14 * size**2)
    start = np.concatenate([hamiltonian.position, hamiltonian.momentum])
    for index in range(2 * n):
        ends = []
        for step in (1e-5, -1e-5):
            moved = start.copy()
            moved[index] += step
            out = hamiltonian.at(position=moved[:n], momentum=moved[n:]).run(5.0)
            ends.append(np.concatenate([out.position[-1], out.momentum[-1]]))
        # Differences with steps of 1e-5 leave h²/6 of the third derivative; measured 3.5e-8 of the largest.
        assert np.abs((ends[0] - ends[1]) / 2e-5 - jacobian[:, index]).max() <= 1e-7 * size**2


def test_a_section_is_met_to_the_last_digits() -> None:
    section = vv.systems.henon_heiles().poincare("x", t=200.0)
    assert len(section) > 20
    assert np.abs(section.position[:, 0]).max() <= 1e-14
    times = section.t
    assert np.all(np.diff(times) > 0)
    out = vv.systems.henon_heiles().run(times)
    assert np.abs(out.position - section.position).max() <= 1e-13
    energy = (section.momentum**2).sum(axis=1) / 2 + section.position[:, 1] ** 2 / 2 - section.position[:, 1] ** 3 / 3
    assert np.ptp(energy) <= 1e-14


def test_a_throw_to_a_place() -> None:
    (x, y), (vx, vy) = coordinates("x y")
    ball = vv.Lagrangian((vx**2 + vy**2) / 2 - 9.81 * y, [x, y], position=[0.0, 0.0], velocity=[1.0, 1.0])
    thrown = ball.boundary_value(2.0, [6.0, 1.0])
    assert thrown.velocity == pytest.approx([3.0, 0.5 + 9.81], rel=1e-14, abs=0)
    far = vv.systems.double_pendulum(position=[0.1, 0.2], velocity=[0.0, 0.0]).boundary_value(0.7, [0.5, -0.4])
    assert far.run(0.7).position[-1] == pytest.approx([0.5, -0.4], abs=5e-15)


def test_a_portrait_shows_separatrix_and_centers() -> None:
    pendulum = vv.systems.pendulum(g=9.81, l=1.0)
    ax = pendulum.phase_portrait((-4.0, 4.0), (-8.0, 8.0), points=120)
    dots = [line for line in ax.lines if line.get_marker() == "o"]
    # The center; the two tops are crossings of separatrices.
    assert len(dots) == 1
    assert dots[0].get_xydata().tolist() == [[0.0, 0.0]]
    assert ax.get_xlabel() == "theta"
    assert ax.get_ylabel() == "momentum of theta"
    hamiltonian = pendulum.hamiltonian().phase_portrait((-4.0, 4.0), (-8.0, 8.0), points=60)
    assert hamiltonian.get_xlabel() == "theta"


@pytest.mark.parametrize(
    ("system", "position", "names"),
    [
        (vv.systems.double_pendulum(), (-1.0, 1.0), "one coordinate"),
        (vv.systems.pendulum(), (1.0, -1.0), "the smaller end first"),
        (vv.systems.moving_pivot(), (-1.0, 1.0), "one coordinate|conserved"),
    ],
)
def test_portraits_that_cannot_be(system: Any, position: tuple[float, float], names: str) -> None:
    with pytest.raises(vv.InvalidInput, match=names):
        system.phase_portrait(position, (-1.0, 1.0))


@pytest.mark.parametrize("direction", [1, -1, 0])
@pytest.mark.parametrize("kind", ["lagrangian", "hamiltonian"])
def test_a_section_that_is_passed_and_left_within_a_step_is_seen(kind: str, direction: int) -> None:
    """An oscillator with steps of half a unit passes cos 0.05 within 0.05 of where it turns."""
    if kind == "lagrangian":
        system: Any = vv.Lagrangian(
            lambda q, v, _: v[0] ** 2 / 2 - q[0] ** 2 / 2, ["q"], position=[np.cos(1.0)], velocity=[np.sin(1.0)]
        )
    else:
        system = vv.Hamiltonian(
            lambda q, p, _: p[0] ** 2 / 2 + q[0] ** 2 / 2, ["q"], position=[np.cos(1.0)], momentum=[np.sin(1.0)]
        )
    turns = 1.0 + 2 * np.pi * np.arange(5)
    for expression, middle, half in (
        (lambda q, _p, _t: q[0] - np.cos(0.05), turns, 0.05),
        (lambda _q, p, _t: p[0] + np.cos(0.01), turns + np.pi / 2, 0.01),
    ):
        sides = [middle - half, middle + half]
        falls = expression(np.ones(1), -np.ones(1), 0.0) < 0.0
        up, down = (sides[1], sides[0]) if falls else (sides[0], sides[1])
        wanted = np.sort({1: up, -1: down, 0: np.concatenate(sides)}[direction])
        found = system.poincare(expression, t=30.0, direction=direction, method="gauss16", dt=0.5)
        assert found.t == pytest.approx(wanted, abs=1e-13 / half)


def test_a_section_that_is_almost_reached_is_not_passed() -> None:
    system = vv.Lagrangian(lambda q, v, _: v[0] ** 2 / 2 - q[0] ** 2 / 2, ["q"], position=[0.6], velocity=[0.8])
    assert len(system.poincare(lambda q, _v, _t: q[0] - 1.0 - 1e-12, t=50.0, direction=0, dt=0.5).t) == 0
    assert len(system.poincare(lambda q, _v, _t: q[0] - 1.0 + 1e-12, t=50.0, direction=0, dt=0.5).t) == 16
