"""Stability of Hamiltonians that are not quadratic in the momenta: the rule of Lagrangians, at the energy of rest.

Beside an equilibrium momenta follow from velocities, so that there is a Lagrangian, though no formula tells it. Charges
near the speed of light in a uniform field: H = √(1 + (p − A)²) + V.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from test_stability_in_magnetic_fields import FALLING, FIELDS, MINIMA

import visviva as vv

if TYPE_CHECKING:
    from test_stability_in_magnetic_fields import Potential


def is_stable(potential: Potential, b: float, place: Any = (0.0, 0.0)) -> bool:
    def function(q: Any, p: Any, t: Any) -> Any:
        return np.sqrt(1 + (p[0] + b / 2 * q[1]) ** 2 + (p[1] - b / 2 * q[0]) ** 2) + potential(q)

    x, y = place
    (found,) = vv.Hamiltonian(function, ["x", "y"]).equilibria(near=[[x, y, -b / 2 * y, b / 2 * x]])
    return found.stable


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize("name", MINIMA)
def test_minima_of_the_energy_at_rest_are_stable_in_any_field(name: str, b: float) -> None:
    assert is_stable(MINIMA[name], b)


#: A fall of 1e-12 x² beside momenta that add b²/4 = 2.5e11 x², of which digits tell 1e-5 x², is not seen.
SEEN = [(name, b) for name in FALLING for b in FIELDS if (name, b) != ("valley that falls little", 1e6)]


@pytest.mark.parametrize(("name", "b"), SEEN)
def test_where_the_energy_at_rest_falls_is_not_taken_to_be_held(name: str, b: float) -> None:
    """Hills of fourth order in a field of 1e-6, and Peano's surface in one of 1e6, were told as stable."""
    assert not is_stable(FALLING[name], b)


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize(("part", "stable"), [(0.25, True), (1 - 1e-6, True), (1.0, False), (1 + 1e-3, False)])
def test_a_hill_is_held_as_long_as_its_frequencies_are_real(b: float, part: float, stable: bool) -> None:
    """At rest m = 1: λ² + i b λ − k has real frequencies for b² > 4 k; equal ones grow as t."""
    k = part * b * b / 4
    assert is_stable(lambda q: -k * (q[0] ** 2 + q[1] ** 2) / 2, b) is stable


@pytest.mark.parametrize("b", [0.1, 1.0, 10.0])
@pytest.mark.parametrize("name", ["curved valley", "Peano's surface", "fourth order", "hill of fourth order"])
def test_away_from_zero(name: str, b: float) -> None:
    potential = {**MINIMA, **FALLING}[name]
    assert is_stable(lambda q: potential([q[0] - 1, q[1] + 1]), b, (1.0, -1.0)) == (name in MINIMA)


def test_momenta_of_rest_are_those_beside_the_equilibrium() -> None:
    """p⁴/4 − p²/2 rests at p = ±1, where small motions have a mass of 1/2, and at 0, where it is −1."""
    for sign, expected in [(1.0, True), (-1.0, False)]:
        system = vv.Hamiltonian(lambda q, p, t, sign=sign: p[0] ** 4 / 4 - p[0] ** 2 / 2 + sign * q[0] ** 4, ["x"])
        found = system.equilibria(near=[[0.01, -1.01], [0.01, 1.01], [0.01, 0.01]])
        assert [each.momentum[0] for each in found] == pytest.approx([-1.0, 0.0, 1.0], rel=1e-12, abs=1e-12)
        assert [each.stable for each in found] == [expected, not expected, expected]
