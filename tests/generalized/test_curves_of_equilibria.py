"""Equilibria that fill curves and surfaces: a few places of each, which say that others go on from there.

There were as many as starts of the search: 1262 of a Mexican hat.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv
from visviva.generalized._ground import LevelGround

if TYPE_CHECKING:
    from collections.abc import Callable


def both_forms(potential: Callable[[Any], Any], count: int = 2) -> tuple[Any, Any]:
    """H = p²/2 + V(q), and its Lagrangian."""
    names = [f"q{i}" for i in range(count)]
    system = vv.Hamiltonian(lambda q, p, t: sum(each**2 for each in p) / 2 + potential(q), names)
    return system, system.lagrangian()


@pytest.mark.parametrize("size", [1e-3, 0.05, 1.0, 1e3])
def test_the_ring_of_a_mexican_hat_is_a_dozen_places_all_around(size: float) -> None:
    for form in both_forms(lambda q: ((q[0] / size) ** 2 + (q[1] / size) ** 2 - 1) ** 2):
        found = form.equilibria()
        hill = [each for each in found if each.continuum == 0]
        assert [(each.position.tolist(), each.stable) for each in hill] == [([0.0, 0.0], False)]
        ring = [each for each in found if each.continuum == 1]
        assert len(ring) == 12
        for each in ring:
            # Places are told to 1e-8 of their size; V″ = (12 q²/size² − 4)/size² is 8/size² there and changes by three
            # times that, its root by half of it.
            assert np.hypot(*each.position) == pytest.approx(size, rel=1e-8, abs=0)
            assert each.frequencies == pytest.approx([np.sqrt(8.0) / size], rel=1e-7, abs=0)
            assert each.stable
        turns = np.sort([np.arctan2(*each.position) for each in ring])
        # Evenly twelve would be π/6 apart; nowhere is a gap of a quarter turn.
        assert np.diff(np.append(turns, turns[0] + 2.0 * np.pi)).max() < 0.5 * np.pi


@pytest.mark.parametrize("radius", [1e-3, 0.05, 1.0])
def test_a_ring_goes_on_whatever_the_size_of_what_is_beside_it(radius: float) -> None:
    """V = (q²/r² − 1)² among places of size 1: steps of a fiftieth of that lead over a small ring, not along it."""

    def forces(q: Any) -> tuple[Any, Any]:
        over = (q @ q.T).diagonal() / radius**2 - 1.0
        along = np.einsum("si,sj->sij", q, q) / radius**2
        return -4.0 * over[:, None] * q / radius**2, (4.0 * over[:, None, None] * np.eye(2) + 8.0 * along) / radius**2

    def balanced(q: Any) -> Any:
        return np.abs(forces(q)[0]).max(axis=1) < 1e-12 / radius  # of 1/r: rounding

    ground = LevelGround(forces, balanced, np.ones(2, dtype=bool))
    turns = np.linspace(0.1, 6.2, 7)
    ring = radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    assert ground.goes_on(np.concatenate([ring, np.zeros((1, 2))]), np.ones(2)).tolist() == [1] * 7 + [0]


def test_rings_beside_each_other_are_told_apart() -> None:
    def potential(q: Any) -> Any:
        square = q[0] ** 2 + q[1] ** 2
        return (square - 1) ** 2 * (square - 4) ** 2

    for form in both_forms(potential):
        found = form.equilibria()
        rings = Counter((round(float(each.position @ each.position), 6), each.stable, each.continuum) for each in found)
        assert rings == {(0.0, False, 0): 1, (1.0, True, 1): 12, (2.5, False, 1): 12, (4.0, True, 1): 12}


def test_a_sphere_of_equilibria_goes_on_in_two_directions() -> None:
    for form in both_forms(lambda q: (q[0] ** 2 + q[1] ** 2 + q[2] ** 2 - 1) ** 2, 3):
        found = form.equilibria()
        assert Counter((each.continuum, each.stable) for each in found) == {(0, False): 1, (2, True): 12}


@pytest.mark.parametrize(
    "potential",
    [
        lambda q: q[0] ** 4 + q[1] ** 2,
        lambda q: q[0] ** 12 + q[1] ** 2,
        lambda q: (q[1] - q[0] ** 2) ** 2 + q[0] ** 6,
        lambda q: (q[0] ** 2 + q[1] ** 2 - 1) ** 2 + 1e-6 * q[0],
    ],
)
def test_a_level_place_is_no_curve(potential: Callable[[Any], Any]) -> None:
    for form in both_forms(potential):
        found = form.equilibria()
        assert 1 <= len(found) <= 3
        assert [each.continuum for each in found] == [0] * len(found)


def test_where_lines_cross_is_a_place_on_curves_and_no_surface() -> None:
    """x²y² was told as a surface; away from the origin as no curve, and by the Lagrangian not at all."""
    for corner in ((0.0, 0.0), (1.0, -0.5)):
        for form in both_forms(lambda q, at=corner: (q[0] - at[0]) ** 2 * (q[1] - at[1]) ** 2):
            (found,) = form.equilibria()
            # A zero of third order of the forces: known to the third root of rounding.
            assert found.position == pytest.approx(corner, rel=0.0, abs=1e-5)
            assert (found.stable, found.continuum) == (True, 1)


def test_the_crossing_of_a_lemniscate_is_on_it() -> None:
    """Its lines cross at ±45°, between the axes; in the middles of the two loops, at x = ±1, are hills."""
    for form in both_forms(lambda q: ((q[0] ** 2 + q[1] ** 2) ** 2 - 2 * (q[0] ** 2 - q[1] ** 2)) ** 2):
        found = form.equilibria()
        hills = [each for each in found if each.continuum == 0]
        assert [each.stable for each in hills] == [False, False]
        # Simple zeros are told to 1e-8.
        assert [float(each.position[0]) for each in hills] == pytest.approx([-1.0, 1.0], rel=1e-8, abs=0.0)
        on = np.array([each.position for each in found if each.continuum == 1])
        square = (on**2).sum(axis=1)
        # g = 0, of which forces tell g·g′ to rounding: near the crossing, where g′ vanishes, to 1e-8 of the size.
        np.testing.assert_allclose(square**2, 2.0 * (on[:, 0] ** 2 - on[:, 1] ** 2), rtol=1e-8, atol=1e-8)
        assert (square == 0.0).sum() == 1


def test_along_a_valley_that_falls_slowly_there_is_one_place() -> None:
    """V = (y − x²)² + 1e-6 x²: forces of 1e-3 at (1006, 1013211) were taken for round-off. ω² are 2e-6 and 2."""
    for form in both_forms(lambda q: (q[1] - q[0] ** 2) ** 2 + 1e-6 * q[0] ** 2):
        (found,) = form.equilibria()
        assert (found.position.tolist(), found.stable, found.continuum) == ([0.0, 0.0], True, 0)
        # The place is exact and V″ diagonal there, 2e-6 and 2: some roundings of each by itself, and none by the other.
        assert found.frequencies == pytest.approx(np.sqrt([2e-6, 2.0]), rel=1e-12, abs=0.0)


def test_two_rings_are_two_dozen_places() -> None:
    """Of which 35 were told; between the rings and in their middles nothing is level."""

    def potential(q: Any) -> Any:
        return ((q[0] - 2) ** 2 + q[1] ** 2 - 1) ** 2 * ((q[0] + 2) ** 2 + q[1] ** 2 - 1) ** 2

    for form in both_forms(potential):
        found = form.equilibria()
        rings = Counter((each.continuum, each.stable, bool(each.position[0] > 0.0)) for each in found if each.continuum)
        assert rings == {(1, True, True): 12, (1, True, False): 12}
        assert [each.stable for each in found if not each.continuum] == [False] * 3


def test_a_thin_ellipse_is_a_dozen_places_and_stable_everywhere() -> None:
    """Of a thousandth of its length 24 places were told, one of which was unstable by 1e-13 of its curvature."""
    for form in both_forms(lambda q: (q[0] ** 2 + (q[1] / 1e-3) ** 2 - 1) ** 2):
        found = form.equilibria()
        assert Counter((each.continuum, each.stable) for each in found) == {(0, False): 1, (1, True): 12}


def test_a_circle_on_a_sphere_is_a_dozen_places() -> None:
    """V = (z − ½)² on the unit sphere: 925 of the circle z = ½ were told. ω² = 2 (1 − z²) = 3/2; poles are hills."""
    system = vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - (q[2] - 0.5) ** 2,
        ["x", "y", "z"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 + q[2] ** 2 - 1],
        position=[1.0, 0.0, 0.0],
        velocity=[0.0, 0.0, 0.0],
    )
    found = system.equilibria()
    assert Counter((each.continuum, each.stable) for each in found) == {(0, False): 2, (1, True): 12}
    for each in found:
        # Places are told to 1e-8 of their size; 2 (1 − z²) changes by 4/3 of that at z = ½, its root by half of it.
        assert each.position[2] == pytest.approx(0.5 if each.stable else np.sign(each.position[2]), rel=1e-8, abs=0)
        if each.stable:
            assert each.frequencies == pytest.approx([np.sqrt(1.5)], rel=1e-7, abs=0)


def test_what_a_user_asks_near_is_told_place_by_place() -> None:
    system = both_forms(lambda q: (q[0] ** 2 + q[1] ** 2 - 1) ** 2)[1]
    turns = np.linspace(0.0, 6.0, 30)
    found = system.equilibria(near=np.stack([np.cos(turns), np.sin(turns)], axis=1))
    assert [each.continuum for each in found] == [1] * 30


def test_a_level_direction_of_momenta_is_judged_by_the_energy() -> None:
    """H = p⁴/4 + V: at rest nothing is quadratic in p; a minimum of H is stable, a saddle is not."""
    for potential, stable in ((lambda q: q**2, True), (lambda q: -(q**2), False), (lambda q: q**4, True)):
        system = vv.Hamiltonian(lambda q, p, t, of=potential: p[0] ** 4 / 4 + of(q[0]) / 2, ["q"])
        (found,) = system.equilibria()
        assert (found.position.tolist(), found.stable, found.continuum) == ([0.0], stable, 0)
