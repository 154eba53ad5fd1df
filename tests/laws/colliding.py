"""Spheres for the laws of collisions, and the methods that are asked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

# An adaptive method, one that splits, one with stages, one that looks back; steps that end on no contact.
METHODS: dict[str, dict[str, Any]] = {
    "auto": {},
    "leapfrog": {"dt": 0.03},
    "rk4": {"dt": 0.3},
    "stormer13": {"dt": 0.007},
}
each_method = pytest.mark.parametrize("method", METHODS)


def how(method: str) -> dict[str, Any]:
    return {"method": method, **METHODS[method]}


def spheres(mass: ArrayLike, x: ArrayLike, v: ArrayLike, radius: ArrayLike, *forces: Any) -> vv.Scene:
    return vv.Scene(vv.Particles(mass, x, v, radius=radius), *forces)


def head_on(m1: float, m2: float) -> vv.Scene:
    """They touch at t = 13/8 with their centers at x = -3/8 and 3/8."""
    return spheres([m1, m2], [[-2, 0, 0], [2, 0, 0]], [[1, 0, 0], [-1, 0, 0]], [0.5, 0.25])


def crowd(n: int, seed: int, radius: float = 0.35, rule: str = "bounce") -> vv.Scene:
    """Balls in a harmonic trap, which keeps them together; those that merge pull each other, as their masses are."""
    random = np.random.default_rng(seed)
    together = vv.Gravity(1.0, softening=1.0) if rule == "merge" else vv.Harmonic(1.0)
    x = np.array([[i % 3, (i // 3) % 3, i // 9] for i in range(n)], dtype=float) - 1.0
    return spheres(random.uniform(0.5, 2.0, n), x, random.normal(size=(n, 3)), radius, together)
