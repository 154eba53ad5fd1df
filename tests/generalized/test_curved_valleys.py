"""Curved valleys whose ground is nearly level: their equilibria are told once, and as they are farther off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def forms(potential: Callable[[Any], Any], b: float = 0.0) -> list[Any]:
    """H = p²/2 + V(q) with a magnetic field b, and its Lagrangian."""

    def function(q: Any, p: Any, t: Any) -> Any:
        return ((p[0] + b / 2 * q[1]) ** 2 + (p[1] - b / 2 * q[0]) ** 2) / 2 + potential(q)

    system = vv.Hamiltonian(function, ["x", "y"])
    return [system, system.lagrangian()]


@pytest.mark.parametrize(("sign", "stable"), [(-1.0, False), (1.0, True)])
def test_a_curved_valley_has_one_equilibrium(sign: float, stable: bool) -> None:
    """Along y = x² the energy is ±x⁶: Newton's method comes to where that is round-off, 1e-4 off, from every start."""
    for form in forms(lambda q: (q[1] - q[0] ** 2) ** 2 + sign * q[0] ** 6):
        (found,) = form.equilibria()
        # The sixth power of 3e-4 is some roundings of slopes across at distances of π.
        np.testing.assert_allclose(found.position, 0.0, rtol=0, atol=3e-4)
        assert found.stable is stable
        np.testing.assert_allclose(found.frequencies[-1], np.sqrt(2.0), rtol=1e-6, atol=0)


def test_a_steep_curved_valley_has_no_equilibrium_far_off() -> None:
    """At (1006, 1e6) its slope of 2e3 along the ground is round-off only beside what lengths of 1e6 make of it."""
    for form in forms(lambda q: (q[0] - 0.5) ** 2 + 1e4 * (q[1] - q[0] ** 2) ** 2):
        (found,) = form.equilibria()
        # Stiffnesses of 2e4 and 2 leave twelve digits of the place.
        np.testing.assert_allclose(found.position, [0.5, 0.25], rtol=0, atol=1e-11)
        assert found.stable


@pytest.mark.parametrize("scale", [1e8, 1e12])
def test_peanos_surface_is_unstable_however_steep(scale: float) -> None:
    for form in forms(lambda q: scale * (q[1] - q[0] ** 2) * (q[1] - 3 * q[0] ** 2)):
        (found,) = form.equilibria()
        assert not found.stable
        np.testing.assert_allclose(found.frequencies, [np.sqrt(2.0 * scale)], rtol=1e-9, atol=0)


def test_all_places_of_a_small_ring_have_a_frequency() -> None:
    size = 1e-6
    found = forms(lambda q: size**2 * ((q[0] / size) ** 2 + (q[1] / size) ** 2 - 1) ** 2 / 4)[0].equilibria()
    around = [each for each in found if each.stable]
    assert len(around) == len(found) - 1 > 0
    for each in around:
        np.testing.assert_allclose(each.frequencies, [np.sqrt(2.0)], rtol=1e-6, atol=0)


@pytest.mark.parametrize("b", [1e3, 1e6])
def test_a_curved_valley_in_a_strong_field(b: float) -> None:
    """What the field adds to the Hamiltonian is 1e12 of what falls."""
    for form, start in zip(forms(lambda q: (q[1] - q[0] ** 2) ** 2 - q[0] ** 6, b), (4, 2), strict=True):
        (found,) = form.equilibria(near=np.zeros((1, start)))
        assert not found.stable
