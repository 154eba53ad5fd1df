"""The orbit on which events are looked for, and how each method runs it."""

from __future__ import annotations

from typing import Any

import numpy as np

import visviva as vv

FIXED = {"dt": 2.0 * np.pi / 2000}
BY_NAME = {method.name: method for method in vv.methods()}
METHODS = list(BY_NAME)


def options(method: str) -> dict[str, Any]:
    return {"rtol": 1e-11} if BY_NAME[method].adaptive else FIXED


def kepler(e: float = 0.3) -> vv.Scene:
    """Two bodies of masses 1 and 0.5 at the pericenter, with the period 2π and the semi-major axis 1."""
    mass = np.array([1.0, 0.5])
    mu = mass.sum()
    speed = np.sqrt(mu * (1.0 + e) / (1.0 - e))
    x, v = np.array([1.0 - e, 0.0, 0.0]), np.array([0.0, speed, 0.0])
    share = np.array([-mass[1], mass[0]]) / mu
    return vv.Scene(vv.Particles(mass, share[:, None] * x, share[:, None] * v), vv.Gravity(G=1.0))


PERIOD = 2.0 * np.pi / np.sqrt(1.5)
