"""Equilibria that second derivatives say too little of: kinks, and zeros of higher order.

Bounds: frequencies to some ten roundings, 1e-14; zeros of higher order to those of that derivative which tells them.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
vx, vy = x.diff(vv.time), y.diff(vv.time)
q, p = sp.symbols("q p")
TENTHS = sp.Rational(3, 10)


def on_a_line(potential: sp.Expr, **given: object) -> vv.Lagrangian:
    return vv.Lagrangian(vx**2 / 2 - potential, [x], **given)


def in_a_plane(potential: sp.Expr, **given: object) -> vv.Lagrangian:
    return vv.Lagrangian((vx**2 + vy**2) / 2 - potential, [x, y], **given)


@pytest.mark.parametrize("speed", [sp.Abs(vx), sp.sqrt(vx**2 + vy**2)])
def test_drag_by_the_square_of_the_speed_is_none_at_rest(speed: sp.Expr) -> None:
    """−v |v| has the slope 2 |v|: small motions are undamped, whether the speed is of one coordinate or of both."""
    system = in_a_plane(x**2 / 2 + 2 * y**2, forces={x: -vx * speed}, position=[1.0, 0.0])
    for small in (system.linearize(at=[0.0, 0.0]), system.normal_modes()):
        np.testing.assert_array_equal(small.damping, np.zeros((2, 2)))
        np.testing.assert_allclose(small.frequencies, [1.0, 2.0], rtol=1e-14, atol=0)
        assert small.stable
    (rest,) = system.equilibria(near=[[0.5, 0.2]])
    np.testing.assert_allclose(rest.position, 0.0, rtol=0, atol=1e-14)
    assert rest.stable


def test_a_pendulum_in_air_swings_as_in_none() -> None:
    """ω = √(g/l) at the bottom, and growth at the top."""
    pendulum = on_a_line(-9.81 * sp.cos(x), forces={x: -vx * sp.Abs(vx) / 10}, position=[0.5])
    bottom, top = pendulum.equilibria(near=[[0.1], [3.0]])
    np.testing.assert_allclose(bottom.frequencies, [np.sqrt(9.81)], rtol=1e-14, atol=0)
    assert bottom.stable
    assert not top.stable


def test_what_is_pushed_along_while_slow_leaves_its_equilibrium() -> None:
    """F = v (1 − |v|): λ² − λ + 1 = 0, both roots with the real part 1/2."""
    system = on_a_line(x**2 / 2, forces={x: vx * (1 - sp.Abs(vx))}, position=[1.0])
    small = system.linearize(at=[0.0])
    np.testing.assert_allclose(small.eigenvalues.real, [0.5, 0.5], rtol=1e-14, atol=0)
    np.testing.assert_allclose(np.sort(small.eigenvalues.imag), np.sqrt(0.75) * np.array([-1, 1]), rtol=1e-14, atol=0)
    assert not small.stable
    assert not any(each.stable for each in system.equilibria())


@pytest.mark.parametrize("place", [0.0, 1.0, 1e6])
def test_an_odd_power_of_a_distance_bends_no_spring(place: float) -> None:
    """V = u²/2 + |u|³ has V″ = 1 at 0, and |u|³ alone V″ = 0."""
    u = x - sp.Float(place)
    np.testing.assert_allclose(
        on_a_line(u**2 / 2 + sp.Abs(u) ** 3).linearize(at=[place]).frequencies, [1.0], rtol=1e-14, atol=0
    )
    assert on_a_line(sp.Abs(u) ** 3).linearize(at=[place]).frequencies.size == 0
    if place == 0.0:
        (rest,) = on_a_line(x**2 / 2 + sp.Abs(x) ** 3).equilibria()
        assert rest.position[0] == 0.0
        np.testing.assert_allclose(rest.frequencies, [1.0], rtol=1e-14, atol=0)
        (rest,) = vv.Hamiltonian(p**2 / 2 + q**2 / 2 + sp.Abs(q) ** 3, [q], [p]).equilibria()
        np.testing.assert_allclose(rest.frequencies, [1.0], rtol=1e-14, atol=0)
        assert rest.stable


@pytest.mark.parametrize(
    ("system", "at"),
    [
        (on_a_line(sp.Abs(x)), [0.0]),
        (on_a_line(x**2 / 2 + sp.Abs(x) / 10**9), [0.0]),
        (on_a_line(sp.Abs(x) ** sp.Rational(3, 2)), [0.0]),
        (on_a_line((x - 1) ** 2 / 2 + sp.Abs(x - 1) / 1000), [1.0]),
        (on_a_line(x**2 / 2, forces={x: -vx / sp.Abs(vx)}), [0.0]),
        (in_a_plane(sp.sqrt(x**2 + y**2)), [0.0, 0.0]),
        # Its slopes go to zero, their slopes to other numbers from other sides.
        (in_a_plane(x**3 / sp.sqrt(x**2 + y**2)), [0.0, 0.0]),
    ],
    ids=["edge", "small edge", "power 3/2", "edge beside", "dry friction", "cone", "folded"],
)
def test_a_kink_is_told_by_name(system: vv.Lagrangian, at: list[float]) -> None:
    for ask in (system.linearize, system.equilibria):
        with pytest.raises(vv.InvalidInput, match=r"expected forces that have derivatives at this place.*kink"):
            ask(at)


@pytest.mark.parametrize(
    ("potential", "stable"),
    [
        (x**4, True),
        (-(x**4), False),
        (x**3, False),
        (x**12, True),
        (x**4 - 10 * x**5, True),
        (sp.Abs(x) ** 3, True),
        (-(sp.Abs(x) ** 3), False),
        (sp.cos(x) + x**2 / 2, True),  # 1 + x⁴/24
    ],
)
def test_forms_of_a_system_agree_on_minima_of_higher_order(potential: sp.Expr, stable: bool) -> None:
    """An energy that is least at a place keeps what is near it there, of whatever order it is (Lagrange, Dirichlet)."""
    # To the digits of sin x − x, of which none are left at 1e-5.
    told = [each for each in on_a_line(potential).equilibria() if abs(each.position[0]) < 2e-5]
    assert [each.stable for each in told] == [stable]
    assert told[0].frequencies.size == 0
    states = vv.Hamiltonian(p**2 / 2 + potential.subs(x, q), [q], [p]).equilibria()
    assert [each.stable for each in states if abs(each.position[0]) < 2e-5] == [stable]


@pytest.mark.parametrize(
    ("H", "stable"),
    [
        (p**4 / 4 + q**2 / 2, True),
        (p**4 + q**4, True),
        (-(p**2) / 2 - q**4, True),  # A maximum.
        (p**4 - q**4, False),
        (p**2 / 2 - q**4, False),
        (p**2 / 2 + p * q**2, False),  # (p + q²)²/2 − q⁴/2
        (p**2 / 2 + p * q**2 + q**4, True),  # (p + q²)²/2 + q⁴/2
        (q * p**2 + q**3, False),
    ],
)
def test_hamiltonians_are_stable_at_minima_and_maxima(H: sp.Expr, stable: bool) -> None:
    (rest,) = vv.Hamiltonian(H, [q], [p]).equilibria()
    np.testing.assert_allclose([*rest.position, *rest.momentum], 0.0, rtol=0, atol=1e-12)
    assert rest.stable is stable
    assert rest.frequencies.size == 0


def test_a_damped_motion_is_as_stable_in_momenta() -> None:
    damped = on_a_line(x**2 / 2, forces={x: -vx / 5})
    assert [each.stable for each in damped.equilibria()] == [True]
    assert [each.stable for each in damped.hamiltonian().equilibria()] == [True]


@pytest.mark.parametrize(
    ("potential", "stable"),
    [
        (y**2 / 2 + x**2 * y + x**4, True),  # (y + x²)²/2 + x⁴/2
        (y**2 / 2 + x**2 * y + x**4 / 4, False),  # (y + x²)²/2 − x⁴/4
        (x**4 + y**4 - x**2 * y**2, True),
        (x**4 + y**4 - 3 * x**2 * y**2, False),
        (y**2 / 2 - x**6, False),
    ],
)
def test_along_a_level_direction_others_go_where_no_force_is(potential: sp.Expr, stable: bool) -> None:
    found = in_a_plane(potential).equilibria(near=[[0.0, 0.0]])
    assert [each.stable for each in found] == [stable]


def test_a_hoop_at_its_critical_rate_stays_at_the_bottom() -> None:
    """Ω² = g/R: there V = R² (Ω²/8) θ⁴, of which forces tell θ to a third of their digits."""
    hoop = vv.systems.hoop(Omega=np.sqrt(9.81), R=1.0, g=9.81)
    for found in (hoop.equilibria(), hoop.hamiltonian().equilibria()):
        np.testing.assert_allclose([each.position[0] for each in found], [-np.pi, 0.0, np.pi], rtol=1e-14, atol=1e-14)
        assert [each.stable for each in found] == [False, True, False]
        assert found[1].frequencies.size == 0


@pytest.mark.parametrize("power", [4, 6])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_power_is_the_same_multiplied_out(power: int, sign: int) -> None:
    """(x − 3/10)ⁿ: one place, without a frequency, told alike in both forms."""
    factored = sign * (x - TENTHS) ** power
    for potential in (factored, sp.expand(factored)):
        for near in (None, [0.5]):
            (rest,) = on_a_line(potential).equilibria(near)
            np.testing.assert_allclose(rest.position, [0.3], rtol=1e-14, atol=0)
            assert rest.stable is (sign > 0)
            assert rest.frequencies.size == 0


def test_two_coordinates_have_one_place_where_forces_tell_no_more() -> None:
    """Multiplied out, forces are round-off within (1e-16/4)^(1/3) of 3/10."""
    system = in_a_plane(y**2 + sp.expand((x - TENTHS) ** 4) + x * y**2)
    (rest,) = system.equilibria(near=[[0.1, 0.2], [0.02, -0.3], [0.5, 0.5]])
    np.testing.assert_allclose(rest.position, [0.3, 0.0], rtol=0, atol=3e-5)
    # ∂²V/∂y² = 2 + 2x.
    np.testing.assert_allclose(rest.frequencies, [np.sqrt(2.6)], rtol=3e-5, atol=0)
    assert rest.stable


def test_two_places_near_each_other_are_two() -> None:
    """V = x⁴/4 − 1e-8 x²/2 has minima at ±1e-4 with ω² = 2e-8, and a top between them."""
    found = on_a_line(x**4 / 4 - sp.Rational(1, 10**8) * x**2 / 2).equilibria(near=[[-2e-4], [1e-6], [2e-4]])
    np.testing.assert_allclose([each.position[0] for each in found], [-1e-4, 0.0, 1e-4], rtol=1e-12, atol=1e-18)
    assert [each.stable for each in found] == [True, False, True]
    np.testing.assert_allclose(found[0].frequencies, [np.sqrt(2e-8)], rtol=1e-12, atol=0)


def test_a_force_that_nearly_vanishes_does_not() -> None:
    """F = −3 (x − 1)² − 1e-9, multiplied out: no zero, though each of its terms is 1e9 times what is left."""
    assert on_a_line(sp.expand((x - 1) ** 3 + x / 10**9)).equilibria() == []


@pytest.mark.parametrize("angle", [0.3, np.pi / 4, 2.0])
def test_a_level_direction_has_no_frequency(angle: float) -> None:
    """Of V = (x² + y² − 1)² the brim is level: one frequency, √8, and one motion that goes on."""
    small = in_a_plane((x**2 + y**2 - 1) ** 2).linearize(at=[np.cos(angle), np.sin(angle)])
    np.testing.assert_allclose(small.frequencies, [np.sqrt(8.0)], rtol=1e-14, atol=0)
    assert small.squares[0] == 0.0
    assert small.stable
