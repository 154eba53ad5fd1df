"""Equilibria on a sphere in its angles, of which the poles are none, whatever is in balance in these coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

POTENTIALS: dict[str, Callable[[Any, Any], Any]] = {
    "along x": lambda a, b: np.sin(a) * np.cos(b),
    "squared along z": lambda a, b: np.cos(a) ** 2,
    "aslant": lambda a, b: np.cos(a) + 0.7 * np.sin(a) * np.cos(b),
}


@pytest.mark.parametrize("name", POTENTIALS)
def test_both_formulations_find_the_same(name: str) -> None:
    potential = POTENTIALS[name]
    by_velocities = vv.Lagrangian(
        lambda q, v, t: 0.5 * (v[0] ** 2 + (v[1] * np.sin(q[0])) ** 2) - potential(q[0], q[1]),
        ["a", "b"],
        position=[1.0, 0.3],
    )
    by_momenta = vv.Hamiltonian(
        lambda q, p, t: 0.5 * (p[0] ** 2 + (p[1] / np.sin(q[0])) ** 2) + potential(q[0], q[1]),
        ["a", "b"],
        position=[1.0, 0.3],
        momentum=[0.1, 0.1],
    )
    expected, found = by_velocities.equilibria(), by_momenta.equilibria()
    assert len(found) == len(expected) > 1
    for one, other in zip(found, expected, strict=True):
        # Newton's method ends where forces are round-off.
        np.testing.assert_allclose(one.position, other.position, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(one.momentum, 0.0)
        assert one.stable == other.stable


def test_where_only_poles_are_left_they_are_told() -> None:
    pendulum = vv.systems.spherical_pendulum()
    for system, name in ((pendulum, "L"), (pendulum.hamiltonian(), "H")):
        with pytest.raises(vv.InvalidInput, match="pole of spherical coordinates") as refused:
            system.equilibria()
        assert refused.value.argument == name
