"""Answers that depend on no unit: symmetries, equilibria, periods and starts of systems of any size.

Bounds: relative to the size of the system, some ten roundings, 1e-14; of a small motion of a pendulum the square of
the angle over 16, 1e-13.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv


def trap(width: float, ratio: float, *, position: Any = None) -> vv.Lagrangian:
    """A Gaussian trap of a width, wider in one direction."""

    def L(q: Any, v: Any, t: Any, s: Any) -> Any:
        return (v[0] ** 2 + v[1] ** 2) / 2 + np.exp(-(q[0] ** 2 + ratio * q[1] ** 2) / (2 * s * s))

    place = [width, 0.0] if position is None else position
    return vv.Lagrangian(L, ["x", "y"], parameters={"s": width}, position=place, velocity=[0.0, 0.1])


def turn(q: Any, v: Any, t: Any, **parameters: Any) -> list[Any]:
    return [-q[1], q[0]]


@pytest.mark.parametrize("width", [1e-12, 1e-3, 1.0, 1e6, 1e11])
def test_a_broken_symmetry_is_broken_in_all_units(width: float) -> None:
    """Angular momentum of an anisotropic trap changes, whatever its width; of an isotropic one it does not."""
    assert not trap(width, 1.5).noether(turn).holds
    assert not trap(width, 1.0 + 1e-6).noether(turn).holds
    assert trap(width, 1.0).noether(turn).holds
    # The start need not be in the trap: parameters are lengths too.
    assert not trap(width, 1.5, position=[0.0, 0.0]).noether(turn).holds


def test_the_oblate_earth_turns_about_one_axis_only() -> None:
    """J₂ in SI units, from 7000 km: a thousandth of the attraction, which is 1e-6 of what random meters would see."""
    GM, radius = 3.986e14, 6.378e6
    J = 1.08e-3 * GM * radius**2

    def L(q: Any, v: Any, t: Any) -> Any:
        r2 = q[0] ** 2 + q[1] ** 2 + q[2] ** 2
        attraction = GM / np.sqrt(r2) + J / 2 * (r2 - 3 * q[2] ** 2) / r2**2.5
        return (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 + attraction

    earth = vv.Lagrangian(L, ["x", "y", "z"], position=[7e6, 0, 0], velocity=[0, 5e3, 5e3])
    assert earth.noether(lambda q, v, t: [-q[1], q[0], 0.0]).holds
    about_x = earth.noether(lambda q, v, t: [0.0, -q[2], q[1]])
    assert not about_x.holds
    assert np.ptp(about_x.conserved(earth.run(np.linspace(0.0, 6e3, 4)))) > 1e8


def test_a_small_term_that_breaks_a_symmetry_is_not_drowned() -> None:
    """A pull of 1e-14 beside an attraction of 1: seen where it is as large as what it adds to."""

    def pulled(pull: float) -> vv.Lagrangian:
        return vv.Lagrangian(
            lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - (q[0] ** 2 + q[1] ** 2) - pull * q[0],
            ["x", "y"],
            position=[1.0, 0.2],
            velocity=[0.3, 0.8],
        )

    assert not pulled(1e-14).noether(turn).holds
    assert pulled(0.0).noether(turn).holds


def test_what_cannot_be_seen_is_not_called_a_symmetry() -> None:
    """A trap of a width that nothing tells: no state of a size at hand sees its slope."""
    hidden = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + np.exp(-((q[0] - 0.5) ** 2) / 1e-40),
        ["x", "y"],
        position=[1.0, 0.2],
        velocity=[0.3, 0.8],
    )
    with pytest.raises(vv.InvalidInput, match="not decided"):
        hidden.noether(turn)
    H = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"], position=[1.0])
    with pytest.raises(vv.InvalidInput, match="not decided"):
        H.is_canonical(lambda q, p, t: [q[0] + 1e-20 * np.exp(-((q[0] - 0.5) ** 2) / 1e-40), p[0]])


@pytest.mark.parametrize("width", [1e-9, 1.0, 1e9])
def test_a_transformation_is_judged_at_its_own_size(width: float) -> None:
    """Q = x (1 + exp(−x²/a²)): dQ/dx is 1 far away only, and at x = a it is 1 − 1/e."""
    H = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"], position=[width], momentum=[0.0])
    assert not H.is_canonical(lambda q, p, t: [q[0] * (1 + np.exp(-((q[0] / width) ** 2))), p[0]])
    assert H.is_canonical(lambda q, p, t: [q[0] * 3.0 * width, p[0] / (3.0 * width)])


SIZES = [1e-15, 1e-9, 1.0, 1e9]


def well(a: float, *, position: float = 1.5) -> vv.Lagrangian:
    """V = (x² − a²)²/4a²: at rest at ±a, where ω = √2, and at 0."""
    return vv.Lagrangian(
        lambda q, v, t, a: v[0] ** 2 / 2 - (q[0] ** 2 - a * a) ** 2 / (4 * a * a),
        ["x"],
        parameters={"a": a},
        position=[position * a],
    )


@pytest.mark.parametrize("a", SIZES)
def test_equilibria_of_a_well_of_any_size(a: float) -> None:
    found = well(a).equilibria(near=[[-1.1 * a], [0.1 * a], [1.2 * a], [1.3 * a]])
    assert np.array([one.position[0] / a for one in found]) == pytest.approx([-1.0, 0.0, 1.0], abs=1e-14)
    assert [one.stable for one in found] == [True, False, True]
    assert found[2].frequencies == pytest.approx([np.sqrt(2.0)], rel=1e-14, abs=0)
    for place in (1.5, 1.001, 1e-3):
        with pytest.raises(vv.InvalidInput, match="expected an equilibrium"):
            well(a, position=place).linearize()


def test_forces_that_balance_but_for_rounding_are_an_equilibrium() -> None:
    """At x = 0 of springs that pull by 0.1 + 0.2 and 0.3; a place that is not known better than to its last digit."""
    L = vv.Lagrangian(
        lambda q, v, t, a, b, c: v[0] ** 2 / 2 - q[0] ** 2 / 2 + a * q[0] + b * q[0] - c * q[0],
        ["x"],
        parameters={"a": 0.1, "b": 0.2, "c": 0.3},
    )
    assert L.linearize(at=[0.0]).frequencies == pytest.approx([1.0])
    assert not vv.systems.pendulum().linearize(at=[np.pi]).stable


@pytest.mark.parametrize("size", SIZES)
def test_a_start_off_its_constraint_is_refused_in_all_units(size: float) -> None:
    def ring(x: float, y: float, *, velocity: Any = (0.0, 0.0)) -> vv.Lagrangian:
        return vv.Lagrangian(
            lambda q, v, t, l: (v[0] ** 2 + v[1] ** 2) / 2 - l * q[1],
            ["x", "y"],
            parameters={"l": size},
            position=[x * size, y * size],
            velocity=np.array(velocity) * size,
            constraints=[lambda q, v, t, l: q[0] ** 2 + q[1] ** 2 - l * l],
        )

    for off in (1.3, 1.0 + 1e-8):
        with pytest.raises(vv.InvalidInput, match=r"constraint 0 is .* at the start and not 0") as caught:
            ring(off, 0.0).run(1.0)
        assert caught.value.argument == "position"
    with pytest.raises(vv.InvalidInput, match=r"the rate of constraint 0 is .* at the start") as caught:
        ring(1.0, 0.0, velocity=(1e-6, 1.0)).run(1.0)
    assert caught.value.argument == "velocity"
    # What rounding leaves is none: of sines and cosines, and of what should be 0.
    for angle in (0.3, np.pi / 2, np.pi):
        start = ring(np.cos(angle), np.sin(angle), velocity=(-np.sin(angle), np.cos(angle)))
        out = start.run(1.0)
        assert np.hypot(out["x"], out["y"])[-1] == pytest.approx(size, rel=1e-14, abs=0)


@pytest.mark.parametrize("goal", [1e-300, 1e-13, 1e-6])
def test_a_boundary_value_has_all_its_digits(goal: float) -> None:
    """Of a pendulum next to rest: θ' = goal / sin t, to the square of the angle."""
    found = vv.systems.pendulum(g=1.0, position=[0.0]).boundary_value(1.0, [goal])
    assert found.velocity[0] == pytest.approx(goal / np.sin(1.0), rel=1e-12, abs=0)


def test_equilibria_of_many_coordinates_take_a_bounded_time() -> None:
    """A grid would have 2³⁰ starts of independent pendulums; there are 256, and equal places are one."""
    n = 30
    many = vv.Lagrangian(
        lambda q, v, t: sum(v[i] ** 2 / 2 + (1 + i) * np.cos(q[i]) for i in range(n)), [f"q{i}" for i in range(n)]
    )
    found = many.equilibria()
    places = np.array([one.position for one in found])
    assert 1 < len(found) <= 256
    assert np.abs(np.sin(places)).max() <= 1e-14
    assert len({tuple(np.rint(place / np.pi)) for place in places}) == len(found)


CO2 = vv.Lagrangian(
    lambda q, v, t: (
        16 * (v[0] ** 2 + v[2] ** 2) / 2 + 12 * v[1] ** 2 / 2 - ((q[1] - q[0] - 1) ** 2 + (q[2] - q[1] - 1) ** 2) / 2
    ),
    ["x1", "x2", "x3"],
    position=[0.0, 1.0, 2.0],
)


@pytest.mark.parametrize("near", [None, [0.1, 1.0, 1.7], [5.0, 5.5, 8.0]])
def test_normal_modes_of_what_may_be_moved_as_a_whole(near: Any) -> None:
    """A linear molecule: 0, √(k/m), √(k/m (1 + 2 m/M)). Goldstein, section 6.4. Its center of mass stays."""
    found = CO2.normal_modes(near)
    assert found.squares == pytest.approx([0.0, 1 / 16, (1 + 32 / 12) / 16], abs=1e-15)
    start = np.array([0.0, 1.0, 2.0] if near is None else near)
    masses = np.array([16.0, 12.0, 16.0])
    assert found.position @ masses == pytest.approx(start @ masses, rel=1e-14, abs=0)
    assert np.diff(found.position) == pytest.approx([1.0, 1.0], rel=1e-14, abs=0)
    linear = CO2.linearize()
    assert found.frequencies[-2:] == pytest.approx(linear.frequencies[-2:], rel=1e-14, abs=0)


def test_normal_modes_of_a_cart_with_a_pendulum() -> None:
    cart = vv.systems.cart_pendulum(position=[0.3, 0.1]).normal_modes()
    assert cart.position[1] == pytest.approx(0.0, abs=1e-15)
    assert cart.squares is not None
    assert cart.squares[0] == pytest.approx(0.0, abs=1e-14)
    assert cart.squares[1] > 0.1
    # What falls freely is nowhere at rest, and neither is a cart on a slope.
    falling = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - 9.81 * q[0], ["z"], position=[1.0])
    slope = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - q[0] ** 2 - q[1] * 1e-6, ["x", "y"], position=[1.0, 0.0]
    )
    for system in (falling, slope):
        with pytest.raises(vv.InvalidInput, match="finds no equilibrium"):
            system.normal_modes()


def test_a_turn_of_nothing_has_no_period() -> None:
    with pytest.raises(vv.InvalidInput, match="expected how far the coordinate goes"):
        vv.systems.pendulum(position=[0.0], velocity=[10.0]).period(turn=0.0)


@pytest.mark.parametrize("interval", [1.0, 20.0, 100.0, 400.0])
def test_lyapunov_exponents_know_no_interval(interval: float) -> None:
    """On a hill x'' = x: ±1 but for (ln 2)/2t, of the first frame, and equal and opposite."""
    hill = vv.Lagrangian(lambda q, v, t: (v[0] ** 2 + q[0] ** 2) / 2, ["x"], position=[0.0])
    found = hill.lyapunov_exponents(400.0, interval=interval)
    # The sum is the divergence of the flow, 0 but for rounding over the time; the first is short by (ln 2)/2t = 8.7e-4.
    assert found.sum() == pytest.approx(0.0, abs=1e-12)
    assert found[0] == pytest.approx(1.0 - np.log(2.0) / 800.0, abs=1e-10)


@pytest.mark.parametrize("length", [1e-20, 1e-10, 1.0, 1e10])
def test_equilibria_of_a_hamiltonian_in_any_unit_of_length(length: float) -> None:
    """Newton's steps ended when they were short in the unit of length, and were no longer than a turn of it."""
    well = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2 + (q[0] ** 2 - length**2) ** 2, ["x"])
    found = well.equilibria(near=[[0.9 * length, 0.0], [-0.9 * length, 0.0], [0.1 * length, 0.0]])
    np.testing.assert_allclose([e.position[0] / length for e in found], [-1.0, 0.0, 1.0], rtol=1e-14, atol=0)
    assert [e.stable for e in found] == [True, False, True]
    np.testing.assert_allclose(found[0].frequencies, [np.sqrt(8.0) * length], rtol=1e-12, atol=0)
    ring = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2 + length**4 / (2 * q[0] ** 2) + q[0] ** 2 / 2, ["r"])
    (circle,) = ring.equilibria(near=[[0.9 * length, 0.0]])
    np.testing.assert_allclose(circle.position / length, [1.0], rtol=1e-14, atol=0)
    np.testing.assert_allclose(circle.frequencies, [2.0], rtol=1e-12, atol=0)


@pytest.mark.parametrize("start", [0.0, 0.9])
@pytest.mark.parametrize("momentum", [1e-10, 1.0, 1e3, 1e10])
def test_equilibria_at_large_momenta(momentum: float, start: float) -> None:
    moved = vv.Hamiltonian(lambda q, p, t: (p[0] - momentum) ** 2 / 2 + q[0] ** 2 / 2, ["x"])
    (found,) = moved.equilibria(near=[[0.0, start * momentum]])
    np.testing.assert_allclose(found.momentum, [momentum], rtol=1e-14, atol=0)
    np.testing.assert_allclose(found.frequencies, [1.0], rtol=1e-12, atol=0)


@pytest.mark.parametrize("rate", [1e-12, 1e9, 1e14])
def test_lyapunov_exponents_in_any_unit_of_time(rate: float) -> None:
    """Lengths of places and velocities in the units given were told apart by nothing but these."""

    def swinging(rate: float) -> np.ndarray:
        pendulum = vv.Lagrangian(
            lambda q, v, t: v[0] ** 2 / 2 + rate**2 * np.cos(q[0]), ["a"], position=[1.0], velocity=[0.0]
        )
        return pendulum.lyapunov_exponents(30.0 / rate, interval=1.0 / rate) / rate

    # Units are powers of 2²⁰: lengths of neighbors differ by less than 2¹⁰ at both ends, in a time of 30.
    np.testing.assert_allclose(swinging(rate), swinging(1.0), rtol=0, atol=2 * np.log(2.0**10) / 30)


@pytest.mark.parametrize("mass", [1e-15, 1e10, 1e20])
def test_lyapunov_exponents_of_any_mass(mass: float) -> None:
    def swinging(mass: float) -> np.ndarray:
        pendulum = vv.Hamiltonian(
            lambda q, p, t: p[0] ** 2 / (2 * mass) - mass * np.cos(q[0]), ["a"], position=[1.0], momentum=[0.0]
        )
        return pendulum.lyapunov_exponents(30.0)

    np.testing.assert_allclose(swinging(mass), swinging(1.0), rtol=0, atol=2 * np.log(2.0**10) / 30)


@pytest.mark.parametrize("start", [1.2, 1.35, 1.4, 0.3])
def test_a_step_that_would_lead_over_a_singularity_is_shortened(start: float) -> None:
    """Of a planet's radius: beside the turn of its potential Newton's method stepped to the other side of the Sun."""
    radial = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - 1 / (2 * q[0] ** 2) + 1 / q[0], ["r"])
    for found in (radial.equilibria(near=[[start]]), radial.hamiltonian().equilibria(near=[[start, 0.0]])):
        assert [e.stable for e in found] == [True]
        np.testing.assert_allclose(found[0].position, [1.0], rtol=1e-13, atol=0)
        np.testing.assert_allclose(found[0].frequencies, [1.0], rtol=1e-12, atol=0)
