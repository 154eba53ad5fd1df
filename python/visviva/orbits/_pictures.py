"""Pictures of orbits, as matplotlib figures that belong to the caller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import did_you_mean
from visviva._plot_columns import hold_level
from visviva._style import BLUE, FRAME, VERMILION, legend_beside
from visviva.errors import InvalidInput
from visviva.orbits._central import effective_potential
from visviva.orbits._rows import ANGLES, FURTHER
from visviva.plot import LEGEND, POINTS, given_axes, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.orbits._central_orbit import CentralOrbit
    from visviva.orbits._elements import Elements

__all__ = ["plot_elements", "plot_orbit"]

_POINTS = 2000
_ELEMENTS = ("semi_major_axis", "eccentricity", "inclination")
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


def plot_elements(found: Elements, element: object, ax: Any) -> Figure:
    """A picture of osculating elements; see `Elements.plot`."""
    along = getattr(found, "_axes", {})
    if "time" not in along or "copy" in along:
        kind = f"those of {len(along['copy'])} copies" if "copy" in along else "those of single orbits"
        raise InvalidInput("plot", f"expected elements of one run over time, as of out.elements(…), got {kind}")
    if element is None:
        names: tuple[str, ...] = _ELEMENTS
        if ax is not None:
            raise InvalidInput(
                "ax", f"one pair of axes takes one panel, and there are {len(names)}: {', '.join(names)}"
            )
    else:
        # What has a number for each orbit, and no vector.
        known = [name for name in (*type(found).__slots__, *FURTHER) if getattr(found, name).ndim == found.mu.ndim]
        if not isinstance(element, str) or element not in known:
            hint = did_you_mean(str(element), tuple(known))
            raise InvalidInput("element", f"expected one of {', '.join(known)}, got {element!r}{hint}")
        names = (element,)
    if ax is None:
        figure, panels = new_figure(len(names), (1.5 + 4.0 * len(names), 3.6))
    else:
        panels = [given_axes(ax)]
        figure = ax.get_figure()
    bodies = [str(name) for name in along["body"]] if "body" in along else []
    # Those of parabolas and hyperbolas are none.
    ellipses = bool((found.eccentricity < 1.0).all())
    for axes, name in zip(panels, names, strict=True):
        angle = name in ANGLES or (ellipses and name.endswith(("anomaly", "longitude")))
        values = getattr(found, name).reshape(len(along["time"]), -1)
        # Numbers that have a size of their own round to parts of that.
        least = 1.0 if angle or name == "eccentricity" else 0.0
        _element(axes, along["time"], np.degrees(values) if angle else values, bodies, angle=angle, least=least)
        written = name.replace("semi_", "semi-").replace("_", " ")
        axes.set(xlabel="t", ylabel=f"{written} [degrees]" if angle else written)
    if 1 < len(bodies) <= LEGEND:
        legend_beside(panels[-1])
    return figure


def _element(
    axes: Any, t: NDArray[np.float64], values: NDArray[np.float64], bodies: list[str], *, angle: bool, least: float
) -> None:
    stride = max(1, len(t) // POINTS)
    for at, column in enumerate(values.T):
        shown = column[::stride].copy()
        if angle:
            # Once round, it begins anew.
            shown[1:][np.abs(np.diff(shown)) > 180.0] = np.nan
        axes.plot(t[::stride], shown, linewidth=0.8, label=bodies[at] if bodies else None)
    hold_level(axes, values, least)
    axes.margins(x=0.01)
    axes.locator_params(axis="x", nbins=4)


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
