"""Equilibria of Hamiltonians, whether quadratic in the momenta or not, and the portraits that show them.

Bounds: simple zeros are met to some ten roundings of numbers of size 1 or π, 1e-14, and so are the frequencies there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

q, p, a = sp.symbols("q p a")


def hamiltonian(H: sp.Expr, **given: object) -> vv.Hamiltonian:
    return vv.Hamiltonian(H, q=[q], p=[p], **given)


def test_a_relativistic_particle_in_two_wells() -> None:
    """H = √(1 + p²) + (q² − 1)²/4: at rest the frequency is √V″ = √2."""
    left, top, right = hamiltonian(sp.sqrt(1 + p**2) + (q**2 - 1) ** 2 / 4).equilibria()
    for place, where in ((left, -1.0), (top, 0.0), (right, 1.0)):
        assert place.position[0] == pytest.approx(where, abs=1e-14)
        assert place.momentum[0] == 0.0
    assert (left.stable, top.stable, right.stable) == (True, False, True)
    np.testing.assert_allclose([left.frequencies[0], right.frequencies[0]], np.sqrt(2.0), rtol=1e-14)
    assert top.frequencies.size == 0


def test_momenta_that_are_not_zero_at_rest() -> None:
    """H = cos p − cos q (Harper): centers where both cosines have different signs, saddles where they have the same."""
    found = hamiltonian(sp.cos(p) - sp.cos(q)).equilibria()
    assert len(found) == 9
    for place in found:
        turns = np.rint(np.concatenate([place.position, place.momentum]) / np.pi)
        np.testing.assert_allclose(np.concatenate([place.position, place.momentum]), np.pi * turns, rtol=0, atol=1e-14)
        assert place.stable == bool(turns.sum() % 2)


def test_a_zero_of_higher_order_is_found_once() -> None:
    """H = p⁴/4 − q²/2 + q⁴/4 has minima at ±1, of which the linear equations do not tell, and a saddle between them."""
    found = hamiltonian(p**4 / 4 - q**2 / 2 + q**4 / 4).equilibria()
    np.testing.assert_allclose([place.position[0] for place in found], [-1.0, 0.0, 1.0], rtol=0, atol=1e-14)
    np.testing.assert_allclose([place.momentum[0] for place in found], 0.0, rtol=0, atol=1e-14)
    assert [place.stable for place in found] == [True, False, True]


def test_they_are_those_of_the_lagrangian() -> None:
    """The double pendulum's, by both forms, with the same frequencies; momenta at rest are zero."""
    pendulum = vv.systems.double_pendulum()
    ours, others = pendulum.hamiltonian().equilibria(), pendulum.equilibria()
    near = [place for place in ours if place.stable]
    assert len(near) == 1
    np.testing.assert_allclose(near[0].position, 0.0, rtol=0, atol=1e-14)
    (rest,) = [place for place in others if place.stable]
    np.testing.assert_allclose(near[0].frequencies, rest.frequencies, rtol=2e-14)
    np.testing.assert_array_equal(rest.momentum, [0.0, 0.0])
    for place in others:
        assert min(np.abs(place.position - other.position).max() for other in ours) < 1e-14


@pytest.mark.parametrize("system", [vv.systems.cart_pendulum, vv.systems.coupled_oscillators, vv.systems.pendulum])
def test_both_formulations_find_the_same_stable(system: Callable[[], vv.Lagrangian]) -> None:
    """A cart with a pendulum hanging from it was stable as a Lagrangian and unstable as a Hamiltonian."""
    by_velocities, by_momenta = (
        [(e.position.round(9).tolist(), e.stable) for e in form.equilibria()]
        for form in (system(), system().hamiltonian())
    )
    assert by_velocities == by_momenta
    assert {stable for _, stable in by_velocities} >= {True}


def test_what_falls_along_a_level_direction_is_unstable() -> None:
    """H falls like −q³ or −q⁴ where it is level to second order; it stays level along x."""
    for power in (3, 4):
        falls = vv.Hamiltonian(lambda q, p, t, power=power: (p[0] ** 2 + p[1] ** 2) / 2 - q[1] ** power, ["x", "y"])
        (found,) = falls.equilibria(near=[[0.0, 0.1, 0.0, 0.0]])
        assert not found.stable


def test_along_a_cyclic_coordinate_one_is_told() -> None:
    x, y, px, py = sp.symbols("x y px py")
    (rest,) = vv.Hamiltonian((px**2 + py**2) / 2 + y**2 / 2, q=[x, y], p=[px, py]).equilibria()
    np.testing.assert_allclose(rest.position, 0.0, rtol=0, atol=1e-14)
    assert rest.stable  # but for a drift along x, as of the Lagrangian


def test_parameters_starts_and_refusals() -> None:
    well = hamiltonian(p**2 / 2 + (q - a) ** 2, parameters={a: 7.0})
    (found,) = well.equilibria()
    assert found.position[0] == pytest.approx(7.0, rel=1e-14, abs=0)
    (rest,) = well.equilibria(near=[5.0, 0.0])
    assert rest.position[0] == pytest.approx(7.0, abs=1e-14)
    with pytest.raises(vv.InvalidInput, match="near: expected states of 1 coordinates and momenta"):
        well.equilibria(near=[1.0, 2.0, 3.0])
    with pytest.raises(vv.InvalidInput, match="H: expected equations that do not depend on the time"):
        hamiltonian(p**2 / 2 + q**2 * sp.cos(vv.time)).equilibria()


@pytest.mark.parametrize("width", [3.0, 4.0])
def test_a_portrait_needs_no_square_of_the_momentum(width: float) -> None:
    """The separatrix of Harper's map is drawn also where its saddles lie at and beyond the edges."""
    pytest.importorskip("matplotlib")
    portrait = hamiltonian(sp.cos(p) + sp.cos(q) + q / 100)
    axes = portrait.phase_portrait((-width, width), (-width, width), points=80)
    dots = [line for line in axes.get_lines() if line.get_marker() == "o"]
    lines = [lines for lines in axes.collections if set(lines.get_linewidths()) == {1.4}]
    assert dots
    assert lines


def test_a_separatrix_comes_by_whose_saddle_is_outside() -> None:
    pytest.importorskip("matplotlib")
    axes = hamiltonian(p**2 / 2 - sp.cos(q)).phase_portrait((-3.0, 3.0), (-2.5, 2.5), points=80)
    strong = [lines for lines in axes.collections if set(lines.get_linewidths()) == {1.4}]
    assert strong
    path = strong[0].get_paths()[0].vertices
    np.testing.assert_allclose(path[:, 1] ** 2 / 2 - np.cos(path[:, 0]), 1.0, rtol=0, atol=5e-3)  # a grid of 80 points


def test_lines_of_a_portrait_have_as_many_points_between_them_and_separatrices_the_energy_of_their_saddle() -> None:
    pytest.importorskip("matplotlib")
    axes = vv.systems.pendulum(g=9.81, l=1.0).phase_portrait((-4.0, 4.5), (-5.0, 6.0), points=60)
    theta, momentum = np.meshgrid(np.linspace(-4.0, 4.5, 60), np.linspace(-5.0, 6.0, 60))
    energy = momentum**2 / 2 - 9.81 * np.cos(theta)
    many, *strong = axes.collections
    # The energy is one product and two sums.
    np.testing.assert_allclose(many.levels, np.quantile(energy, np.linspace(0.0, 1.0, 24)), rtol=1e-14)
    assert set(many.get_linewidths()) == {0.7}
    assert len(strong) == 2
    for lines in strong:
        np.testing.assert_allclose(lines.levels, [9.81], rtol=1e-14)
    for path in (many.get_paths()[5], many.get_paths()[15]):
        q, p = path.vertices.T
        level = p**2 / 2 - 9.81 * np.cos(q)
        np.testing.assert_allclose(level, level[0], rtol=0, atol=0.1)  # between the places of a grid of 60


@pytest.mark.parametrize(
    ("position", "momentum", "centers"),
    [
        ((0.5, 8.0), (-8.0, 8.0), [[2 * np.pi, 0.0]]),
        ((-0.5, 6.0), (-8.0, 8.0), [[0.0, 0.0]]),
        ((-0.5, 8.0), (0.5, 8.0), []),
        ((-0.5, 8.0), (-8.0, -0.5), []),
        ((0.0, 2 * np.pi), (0.0, 8.0), [[0.0, 0.0], [2 * np.pi, 0.0]]),
        ((-1.0, 1.0), (-8.0, 0.0), [[0.0, 0.0]]),
    ],
)
def test_centers_are_shown_where_the_portrait_reaches(
    position: tuple[float, float], momentum: tuple[float, float], centers: list[list[float]]
) -> None:
    pytest.importorskip("matplotlib")
    axes = vv.systems.pendulum(g=9.81, l=1.0).phase_portrait(position, momentum, points=40)
    assert sorted(line.get_xydata()[0].tolist() for line in axes.lines) == centers


def test_a_portrait_of_no_width_or_of_a_driven_system_is_refused() -> None:
    swing = vv.systems.pendulum()
    for ranges, name in (([(1.0, 1.0), (-1.0, 1.0)], "position"), ([(-1.0, 1.0), (2.0, 2.0)], "momentum")):
        with pytest.raises(vv.InvalidInput, match=f"^{name}: expected the smaller end first"):
            swing.phase_portrait(*ranges)
    driven = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + q[0] * np.cos(t), ["x"])
    with pytest.raises(vv.InvalidInput, match=r"^position: a portrait needs energy to be conserved"):
        driven.phase_portrait((-1.0, 1.0), (-1.0, 1.0))


def test_starts_far_away_change_nothing_of_others() -> None:
    """Steps were as long as the farthest start, or the largest momentum, of all."""
    well = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2 + np.exp(q[0]) - q[0], ["x"])
    for near in ([[-8.0, 0.0]], [[-8.0, 0.0], [1e3, 0.0]], [[-8.0, 0.0], [500.0, 0.0]]):
        (found,) = well.equilibria(near=near)
        np.testing.assert_allclose(found.position, [0.0], rtol=0.0, atol=1e-15)
    (hanging,) = vv.systems.pendulum().hamiltonian().equilibria(near=[[1.5, 300.0]])
    np.testing.assert_allclose(hanging.position, [0.0], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("far", [1e4, 1e7, 1e9])
def test_starts_far_away_take_nothing_from_others(far: float) -> None:
    """Their sizes were those of all: equilibria that others reached vanished, or were told unstable."""
    wells = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + q[0] ** 2 / 2 - q[0] ** 4 / 4, ["x"])
    starts = np.array([[-0.9], [0.1], [1.2], [far]])
    for form, near in ((wells, starts), (wells.hamiltonian(), np.hstack([starts, 0 * starts]))):
        found = form.equilibria(near=near)
        np.testing.assert_allclose([e.position[0] for e in found], [-1.0, 0.0, 1.0], rtol=1e-14, atol=1e-14)
        assert [e.stable for e in found] == [True, False, True]


@pytest.mark.parametrize("start", [1e-4, 0.9, 1e4])
def test_stability_is_judged_at_the_place(start: float) -> None:
    """In units of forces where the search began a circular orbit was unstable, and so was √(1 + x²) at its minimum."""
    radial = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2 + 1 / (2 * q[0] ** 2) - 1 / q[0], ["r"])
    valley = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2 + np.sqrt(1 + q[0] ** 2), ["x"])
    for system, place in ((radial, 1.0), (valley, 0.0)):
        found = [e for e in system.equilibria(near=[[0.9, 0.0], [start, 0.0]]) if abs(e.position[0] - place) < 1e-9]
        assert [e.stable for e in found] == [True]
        np.testing.assert_allclose(found[0].frequencies, [1.0], rtol=1e-9, atol=0)


@pytest.mark.parametrize(
    "potential",
    [
        lambda x, y: x**2 * y,
        lambda x, y: -(x**2) * y**2,
        lambda x, y: x**4 + y**4 - 6 * x**2 * y**2,
        lambda x, y: y**2 / 2 + x**2 * y,
    ],
)
def test_what_is_level_to_second_order_and_falls_aslant_is_unstable(potential: Callable[[Any, Any], Any]) -> None:
    """Only where all is in balance far along a level direction is a motion along it a drift."""
    system = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + p[1] ** 2) / 2 + potential(q[0], q[1]), ["x", "y"])
    for form, near in ((system, [[0.1, 0.07, 0.0, 0.0]]), (system.lagrangian(), [[0.1, 0.07]])):
        assert [e.stable for e in form.equilibria(near=near)] == [False]


def test_where_a_potential_underflows_are_no_equilibria() -> None:
    """Starts of the search were told as they are, a dozen of them as stable."""
    steep = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + np.exp(-300 * q[0] ** 2), ["x"])
    for form in (steep, steep.hamiltonian()):
        assert [(e.position[0], e.stable) for e in form.equilibria()] == [(0.0, True)]
    bond = vv.Lagrangian(
        lambda q, v, t: 1.6e-27 * v[0] ** 2 / 2 - 7.4e-19 * (1 - np.exp(-1.81e10 * (q[0] - 1.275e-10))) ** 2,
        ["r"],
        position=[1.3e-10],
    )
    np.testing.assert_allclose([e.position[0] for e in bond.equilibria()], [1.275e-10], rtol=1e-12, atol=0)


def test_a_turn_that_grows_is_unstable() -> None:
    """H = x p_y − y p_x + (x² + y²)/2 turns, and what turns with it falls: equal imaginary eigenvalues, one vector."""
    turning = vv.Hamiltonian(lambda q, p, t: q[0] * p[1] - q[1] * p[0] + (q[0] ** 2 + q[1] ** 2) / 2, ["x", "y"])
    (found,) = turning.equilibria(near=[[0.1, 0.2, 0.0, 0.1]])
    assert not found.stable
    # Of both signs, and stable: two oscillators of which one counts backward.
    backward = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2 - 2 * p[1] ** 2 - q[1] ** 2) / 2, ["x", "y"])
    (found,) = backward.equilibria(near=[[0.1, 0.2, 0.0, 0.1]])
    assert found.stable
