"""Minima that are level along a curve: what stays level along its valley is a drift, as the Lagrangian has it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def by_momenta(potential: Callable[[Any], Any], count: int) -> vv.Hamiltonian:
    """H = p²/2 + V(q)."""
    names = [f"q{i}" for i in range(count)]
    return vv.Hamiltonian(lambda q, p, t: sum(each**2 for each in p) / 2 + potential(q), names)


def molecule(q: Any) -> Any:
    """Three atoms on springs in a plane, free to go and to turn."""
    pairs = ((0, 1), (1, 2), (0, 2))
    lengths = (((q[2 * i] - q[2 * j]) ** 2 + (q[2 * i + 1] - q[2 * j + 1]) ** 2) ** 0.5 for i, j in pairs)
    return sum((length - 1) ** 2 for length in lengths) / 2


def ring(q: Any) -> Any:
    return (q[0] ** 2 + q[1] ** 2 - 1) ** 2 / 4


def hyperbola(q: Any) -> Any:
    return (q[0] * q[1] - 1) ** 2 / 2


@pytest.mark.parametrize("angle", np.linspace(0.4, 6.0, 8))
@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
def test_a_ring_is_stable_all_around(angle: float, size: float) -> None:
    """It was so at one place in four, by the luck of rounding."""
    system = by_momenta(lambda q: ring([each / size for each in q]), 2)
    place = size * np.array([np.cos(angle), np.sin(angle)])
    (found,) = system.equilibria(near=[[*place, 0.0, 0.0]])
    assert found.stable
    assert found.frequencies[-1] == pytest.approx(np.sqrt(2.0) / size, rel=1e-7, abs=0)
    (by_velocities,) = system.lagrangian().equilibria(near=[place])
    assert by_velocities.stable


def test_a_free_molecule_is_stable() -> None:
    place = [0.0, 0.0, 1.0, 0.0, 0.5, np.sqrt(0.75)]
    (found,) = by_momenta(molecule, 6).equilibria(near=[[*place, *6 * [0.0]]])
    assert found.stable
    # Of three equal atoms: √(3/2) twice, and √3 of the breathing.
    np.testing.assert_allclose(found.frequencies[-3:], np.sqrt([1.5, 1.5, 3.0]), rtol=1e-9, atol=0)


@pytest.mark.parametrize("potential", [ring, hyperbola])
def test_of_a_whole_search_all_but_the_hill_are_stable(potential: Callable[[Any], Any]) -> None:
    system = by_momenta(potential, 2)
    for form in (system, system.lagrangian()):
        found = form.equilibria()
        assert len(found) == (13 if potential is ring else 25)  # a dozen of each curve, and the hill
        assert [each.position.tolist() for each in found if not each.stable] == [[0.0, 0.0]]


@pytest.mark.parametrize("scale", [1e-8, 1.0, 1e4, 1e6])
def test_peanos_surface_has_one_equilibrium(scale: float) -> None:
    """Least along every straight line through the origin, and falling between two parabolas, however steep aside."""
    system = by_momenta(lambda q: scale * (q[1] - q[0] ** 2) * (q[1] - 3 * q[0] ** 2), 2)
    for form in (system, system.lagrangian()):
        (found,) = form.equilibria()
        np.testing.assert_allclose(found.position, 0.0, rtol=0, atol=1e-9)
        assert not found.stable
    assert [each.stable for each in system.equilibria(near=[[0.0, 0.0, 0.0, 0.0]])] == [False]
