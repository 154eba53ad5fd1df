"""Where the points of ready-made systems are: for `GeneralizedTrajectory.animate`, with y upwards, or z in space.

Each function takes coordinates, the time and the parameters, and gives points in the order in which lines join them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = [
    "atwood",
    "bead_on_hoop",
    "bead_on_rod",
    "cart",
    "cartesian",
    "hanging",
    "line",
    "moving_pivot",
    "polar",
    "spherical",
    "spring",
    "swinging_atwood",
]

#: Points of two numbers, or of three.
Points = list[tuple[Any, ...]]


def hanging(q: Any, _t: Any, *, l: float = 1.0, l1: float | None = None, l2: float = 1.0, **_others: float) -> Points:
    """One pendulum or more, each hung from the one before: lengths l, or l1 and l2."""
    lengths = [l] * len(q) if l1 is None else [l1, l2]
    points: Points = [(0.0, 0.0)]
    for angle, length in zip(q, lengths, strict=True):
        x, y = points[-1]
        points.append((x + length * np.sin(angle), y - length * np.cos(angle)))
    return points


def spring(q: Any, _t: Any, **_others: float) -> Points:
    """A mass at q[0] from the origin, at the angle q[1] from the downward vertical."""
    return [(0.0, 0.0), (q[0] * np.sin(q[1]), -q[0] * np.cos(q[1]))]


def spherical(q: Any, _t: Any, *, l: float, **_others: float) -> Points:
    """A mass on a sphere, its angle from the downward vertical and its azimuth."""
    across = l * np.sin(q[0])
    return [(0.0, 0.0, 0.0), (across * np.cos(q[1]), across * np.sin(q[1]), -l * np.cos(q[0]))]


def cart(q: Any, _t: Any, *, l: float, **_others: float) -> Points:
    """A cart and what hangs from it."""
    return [(q[0], 0.0), (q[0] + l * np.sin(q[1]), -l * np.cos(q[1]))]


def moving_pivot(
    q: Any, t: Any, *, l: float, Omega: float, X: float = 0.0, Y: float = 0.0, a: float | None = None, **_others: float
) -> Points:
    """A pivot that goes round an ellipse, or (Kapitza's) along the vertical as a cos Ωt, and what hangs from it."""
    x, y = (X * np.cos(Omega * t), Y * np.sin(Omega * t)) if a is None else (0.0 * t, a * np.cos(Omega * t))
    return [(x, y), (x + l * np.sin(q[0]), y - l * np.cos(q[0]))]


def bead_on_rod(q: Any, t: Any, *, Omega: float, **_others: float) -> Points:
    """The axis and the bead, seen from above."""
    return [(0.0, 0.0), (q[0] * np.cos(Omega * t), q[0] * np.sin(Omega * t))]


def bead_on_hoop(q: Any, t: Any, *, R: float, Omega: float, **_others: float) -> Points:
    """The center of the hoop and the bead."""
    across = R * np.sin(q[0])
    return [(0.0, 0.0, 0.0), (across * np.cos(Omega * t), across * np.sin(Omega * t), -R * np.cos(q[0]))]


def atwood(q: Any, _t: Any, *, length: float, **_others: float) -> Points:
    """Two masses below the ends of a pulley, which is drawn an eighth of the string wide."""
    half = length / 16
    return [(-half, -q[0]), (-half, 0.0), (half, 0.0), (half, -q[1])]


def swinging_atwood(q: Any, _t: Any, **_others: float) -> Points:
    """The counterweight, two pulleys and the mass that swings, on a string of 3/2 of the longest swing."""
    longest = float(np.max(q[0]))
    # Pulleys so far apart that nothing swings into the other string; the Lagrangian knows neither.
    aside = -2.0 * longest
    return [(aside, q[0] - 1.5 * longest), (aside, 0.0), (0.0, 0.0), (q[0] * np.sin(q[1]), -q[0] * np.cos(q[1]))]


def polar(q: Any, _t: Any, **_others: float) -> Points:
    """The center and a place at r and φ."""
    return [(0.0, 0.0), (q[0] * np.cos(q[1]), q[0] * np.sin(q[1]))]


def cartesian(q: Any, _t: Any, **_others: float) -> Points:
    """One point whose coordinates are x and y, and z."""
    return [tuple(q)]


def line(q: Any, _t: Any, **_others: float) -> Points:
    """Each coordinate a displacement along x; one beside the other's place at rest by three of the largest."""
    apart = 3.0 * float(np.max(np.abs(q))) if len(q) > 1 else 0.0
    return [(at * apart + each, 0.0) for at, each in enumerate(q)]
