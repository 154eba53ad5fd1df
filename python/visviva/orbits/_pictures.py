"""Pictures of orbits, as matplotlib figures that belong to the caller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import did_you_mean
from visviva._style import BLUE, FRAME, VERMILION
from visviva.errors import InvalidInput
from visviva.orbits._central import effective_potential
from visviva.plot import given_axes, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from visviva.orbits._central_orbit import CentralOrbit

__all__ = ["plot_orbit"]

_POINTS = 2000
# Radial periods of a bound orbit, enough to see its pericenter move on.
_PERIODS = 6.0
# How far an orbit that is not bound is drawn, in distances of its start or of its pericenter, the larger of both.
_FAR = 8.0


def plot_orbit(orbit: CentralOrbit, kind: str, ax: Any) -> Figure:
    """A picture of an orbit; see `CentralOrbit.plot`."""
    pictures = {"orbit": _path, "effective_potential": _well}
    if not isinstance(kind, str) or kind not in pictures:
        hint = did_you_mean(str(kind), tuple(pictures))
        expected = ", ".join(repr(name) for name in pictures)
        raise InvalidInput("kind", f"expected one of {expected}, got {kind!r}{hint}")
    if ax is None:
        _, (ax,) = new_figure(1, (5.5, 5.0))
    pictures[kind](given_axes(ax), orbit)
    figure: Figure = ax.get_figure()
    return figure


def _path(axes: Any, orbit: CentralOrbit) -> None:
    """The orbit in its plane, its circles of turning and the center."""
    low, high = orbit.turning_points
    if np.isfinite(high):
        angles = np.linspace(0.0, 2.0 * _PERIODS * orbit.apsidal_angle, _POINTS)
    else:
        reach = orbit.apsidal_angle * (1.0 - 1e-3)
        angles = np.linspace(-reach, reach, _POINTS) - orbit.angle_since_pericenter
    r, start = orbit.radius(angles), float(np.linalg.norm(orbit._state[1]))
    # Of what comes from far and goes there, the turn would be a point.
    r[r > _FAR * max(low, start)] = np.nan
    axes.plot(r * np.cos(angles), r * np.sin(angles), linewidth=0.8)
    axes.plot(start, 0.0, "o", markersize=4, color=BLUE)
    axes.plot(0.0, 0.0, "+", color="0.4")
    around = np.linspace(0.0, 2.0 * np.pi, 361)
    for radius in (low, high):
        if 0.0 < radius < np.inf:
            axes.plot(radius * np.cos(around), radius * np.sin(around), linewidth=0.6, color=FRAME)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="x", ylabel="y", title="orbit")


def _well(axes: Any, orbit: CentralOrbit) -> None:
    """The effective potential about the range of motion, the energy, and where the motion turns."""
    low, high = orbit.turning_points
    ends = [r for r in (low, high, float(np.linalg.norm(orbit._state[1]))) if 0.0 < r < np.inf]
    r = np.geomspace(0.5 * min(ends), 2.5 * max(ends), _POINTS)
    domains = [domain for domain in (_domain(term) for term in orbit.potentials) if domain is not None]
    for first, last in domains:
        r = r[(r >= first) & (r <= last)]
    v = effective_potential(orbit.potentials, r, angular_momentum=orbit.angular_momentum, mass=orbit.mass)
    axes.plot(r, v, linewidth=1.2)
    axes.axhline(orbit.energy, linewidth=0.8, color=VERMILION)
    turns = [x for x in (low, high) if 0.0 < x < np.inf]
    axes.plot(turns, [orbit.energy] * len(turns), "o", markersize=4, color=VERMILION)
    inside = v[(r >= low) & (r <= high)]
    if inside.size:
        deep = max(orbit.energy - float(inside.min()), 1e-9 * abs(orbit.energy))
        axes.set_ylim(orbit.energy - 1.5 * deep, orbit.energy + 2.0 * deep)
    axes.set(xlabel="r", ylabel="V + l²/2mr²", title="effective potential")


def _domain(term: Any) -> tuple[float, float] | None:
    from visviva import _core

    return _core.check_potential(term._to_core())[0]
