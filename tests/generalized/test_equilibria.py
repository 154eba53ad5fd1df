"""What equilibria and small motions are told of: equations without time, zeros of any order, proper coordinates.

Bounds: simple zeros and frequencies to some ten roundings, 1e-14.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
vx, vy = x.diff(vv.time), y.diff(vv.time)


def in_a_potential(potential: sp.Expr) -> vv.Lagrangian:
    return vv.Lagrangian(vx**2 / 2 - potential, [x])


def driven() -> list[vv.Lagrangian]:
    """Systems whose matrices or forces are others at each time."""
    return [
        vv.systems.kapitza(a=0.01),
        vv.systems.moving_pivot(),
        in_a_potential(x**2 / 2 - sp.sin(vv.time) * x / 2),
        in_a_potential((1 + sp.cos(vv.time) / 10) * x**2 / 2),
        vv.Lagrangian((2 + sp.sin(vv.time)) * vx**2 / 2 - x**2 / 2, [x]),
        vv.Lagrangian(vx**2 / 2, [x], forces={x: -x * vv.time}),
    ]


@pytest.mark.parametrize("which", range(6))
def test_what_depends_on_the_time_has_no_equilibria(which: int) -> None:
    """At one moment the bottom of Kapitza's pendulum is unstable and its top stable: nothing of the motion."""
    system = driven()[which]
    for ask in (system.equilibria, system.normal_modes, lambda: system.linearize(at=[0.0])):
        with pytest.raises(vv.InvalidInput, match="do not depend on the time"):
            ask()


def test_a_time_that_leaves_the_equations_does_no_harm() -> None:
    """A pendulum whose pivot is accelerated evenly hangs askew: tan θ = −a/g, ω² = √(g² + a²)/l."""
    theta, a, g = vv.coordinate("theta"), 3.0, 4.0
    omega = theta.diff(vv.time)
    pivot = a * vv.time
    kinetic = ((pivot + omega * sp.cos(theta)) ** 2 + (omega * sp.sin(theta)) ** 2) / 2
    pendulum = vv.Lagrangian(kinetic + g * sp.cos(theta), [theta])
    assert not pendulum.autonomous
    small = pendulum.normal_modes(near=[-0.5])
    np.testing.assert_allclose(small.position, [-np.arctan2(a, g)], rtol=1e-14)
    np.testing.assert_allclose(small.frequencies, [np.sqrt(5.0)], rtol=1e-14)


@pytest.mark.parametrize("power", [3, 4, 5, 6, 9, 12])
def test_zeros_of_higher_order_are_found(power: int) -> None:
    """Newton's method comes nearer to them by one factor each time; beside the simple ones of a sine."""
    for place in (0.0, 1.5):
        found = in_a_potential((x - place) ** power).equilibria()
        # (x − a)ⁿ⁻² is what the stiffness is: below 1e-300 there is nothing to find.
        np.testing.assert_allclose([each.position[0] for each in found], [place], rtol=0, atol=1e-14)
    found = in_a_potential(sp.cos(x) + x**2 / 2).equilibria()
    # sin x − x has three digits less than its terms where x is 1e-2, and none below 1e-5.
    np.testing.assert_allclose([each.position[0] for each in found], [0.0], rtol=0, atol=2e-5)
    assert in_a_potential(x**power).normal_modes(near=[0.1]).position == pytest.approx([0.0], abs=1e-14)


def test_a_force_that_only_dies_away_has_no_equilibrium() -> None:
    """exp(−x) and 1/x: Newton's steps do not shrink, however small the force."""
    assert in_a_potential(sp.exp(-x)).equilibria() == []
    assert in_a_potential(1 / x).equilibria(near=[[1.0], [10.0]]) == []


def test_places_along_a_cyclic_coordinate_are_one() -> None:
    """In polar coordinates r has its place, and the angle any."""
    r, phi = vv.coordinate("r"), vv.coordinate("phi")
    kinetic = (r.diff(vv.time) ** 2 + r**2 * phi.diff(vv.time) ** 2) / 2
    well = vv.Lagrangian(kinetic - (r - 2) ** 2, [r, phi])
    assert [each.position.tolist() for each in well.equilibria()] == [[2.0, 0.0]]
    assert [each.position.tolist() for each in well.equilibria(near=[[1.9, 0.7], [2.1, -1.0]])] == [[2.0, 0.7]]


def test_the_pole_of_spherical_coordinates_is_named() -> None:
    """There the angle about the axis has no mass, be it sin² 0 or sin² of the number next to π."""
    with pytest.raises(vv.InvalidInput, match=r"mass matrix is singular, as at the pole"):
        vv.systems.spherical_pendulum().equilibria()
    with pytest.raises(vv.InvalidInput, match=r"mass matrix is singular, as at the pole"):
        vv.systems.spherical_pendulum().equilibria(near=[[3.1, 0.2]])


def test_a_turn_after_which_the_energy_does_not_repeat_is_no_period() -> None:
    """A constant force, or half a turn of a pendulum, has none; free motion has that of any turn."""
    with pytest.raises(vv.InvalidInput, match="energy does not repeat"):
        vv.Lagrangian(vx**2 / 2 + x, [x], position=[0.0], velocity=[1.0]).period(turn=1.0)
    over = vv.systems.pendulum(position=[0.3], velocity=[9.0])
    for turn in (1.0, np.pi, 6.2831, -2.0):
        with pytest.raises(vv.InvalidInput, match="energy does not repeat"):
            over.period(turn=turn)
        with pytest.raises(vv.InvalidInput, match="energy does not repeat"):
            over.action_variable(turn=turn)
    once, thrice = over.period(turn=2 * np.pi), over.period(turn=6 * np.pi)
    assert thrice == pytest.approx(3 * once, rel=1e-14, abs=0)
    assert vv.Lagrangian(vx**2 / 2, [x], position=[1.0], velocity=[2.0]).period(turn=3.0) == 1.5
    # A mass that grows along the way is told too, where the potential does not.
    heavier = vv.Lagrangian((1 + x**2) * vx**2 / 2, [x], position=[0.0], velocity=[1.0])
    with pytest.raises(vv.InvalidInput, match="energy does not repeat"):
        heavier.period(turn=1.0)


def test_boundary_values_refuse_by_name() -> None:
    """What cannot be run at all is no matter of the velocity that is tried."""
    pendulum = vv.systems.pendulum(position=[0.0], velocity=[1.0])
    with pytest.raises(vv.InvalidInput, match="rtol"):
        pendulum.boundary_value(0.5, [0.4], rtol=-1.0)
    bound = vv.Lagrangian(
        (vx**2 + vy**2) / 2 - y, [x, y], constraints=[x**2 + y**2 - 1], position=[0.0, -1.0], velocity=[1.0, 0.0]
    )
    with pytest.raises(vv.InvalidInput, match="without constraints"):
        bound.boundary_value(0.5, [0.4, -0.9])


def test_neighbors_that_leave_the_range_of_numbers_are_told_in_shorter_parts() -> None:
    """L = v²/2 + 25 q²: neighbors grow as exp(7.07 t), past the range within an interval of 100."""
    growing = vv.Lagrangian(vx**2 / 2 + 25 * x**2, [x], position=[0.0], velocity=[0.0])
    exponents = growing.lyapunov_exponents(100.0, interval=100.0)
    # The frame turns to the growing direction once: some ln ω over the time, alike for all intervals.
    np.testing.assert_allclose(exponents, growing.lyapunov_exponents(100.0), rtol=1e-10)
    np.testing.assert_allclose(exponents, [np.sqrt(50.0), -np.sqrt(50.0)], rtol=0, atol=0.02)
    # Each of some hundreds of e-foldings is known to rtol.
    assert abs(exponents.sum()) < 1e-9


@pytest.mark.parametrize("n", [2, 7, 8, 10, 14])
def test_a_chain_of_any_length_hangs_stably(n: int) -> None:
    """Of all equilibria of n links one is stable: all of them hang straight down."""
    (hanging,) = (each for each in vv.systems.chain(n).equilibria() if each.stable)
    assert abs(hanging.position).max() < 1e-12  # where slopes of n g have the last digit of 1 left over


def test_the_place_where_a_system_is_may_be_an_equilibrium() -> None:
    """Nine coordinates, each in a narrow well that is hit by nothing else than the start."""
    at = 2.0 + 0.1 * np.arange(9)

    def wells(q: Any, v: Any, _: Any) -> Any:
        return sum(v[k] ** 2 / 2 + np.exp(-400.0 * (q[k] - float(at[k])) ** 2) for k in range(9))

    system = vv.Lagrangian(wells, [f"q{k}" for k in range(9)], position=at)
    assert any(each.stable and np.array_equal(each.position, at) for each in system.equilibria())
