"""Pictures of deflection functions: the angle against the impact parameter, and the cross section that it makes.

The one idea: a line is drawn where there is one motion next to another. It breaks where the function does: at an orbit,
toward which the angle grows without bound, and over what is captured; a cross section breaks at its rainbows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._keywords import did_you_mean
from visviva._style import COLORS, FRAME, LINES, legend_beside
from visviva.errors import InvalidInput
from visviva.plot import given_axes, new_figure
from visviva.scattering._cross_sections import cross_section
from visviva.scattering._structure import glories, orbiting, rainbows

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.potentials import Potential
    from visviva.scattering._deflection import Deflection

__all__ = ["plot_deflection"]

# Lines that a reader can tell apart.
_ENERGIES = len(COLORS) * len(LINES)
# Toward an orbit the angle grows without bound: what is drawn ends after so many degrees, if nothing else goes farther.
_WHIRL = -450.0
# Degrees of a cross section that are drawn: at 0 it is infinite as a rule, at 180 with a glory; and how near a rainbow,
# at which it is infinite, too.
_FIRST, _LAST, _POINTS, _NEAR = 1.0, 179.5, 358, 0.02

# Of the color of a line, over what is captured.
_TINT = 0.1


def plot_deflection(found: Deflection, kind: object, ax: Any) -> Figure:
    """A picture of a deflection function; see `Deflection.plot`."""
    pictures = {"angle": _angle, "closest_approach": _closest_approach, "cross_section": _cross_section}
    if not isinstance(kind, str) or kind not in pictures:
        hint = did_you_mean(str(kind), tuple(pictures))
        expected = ", ".join(repr(name) for name in pictures)
        raise InvalidInput("kind", f"expected one of {expected}, got {kind!r}{hint}")
    if np.size(found.energy) == 0:
        raise InvalidInput("plot", "expected at least one energy and impact parameter, got none")
    energies = np.unique(found.energy)
    if energies.size > _ENERGIES:
        raise InvalidInput("plot", f"expected at most {_ENERGIES} energies in one picture, got {energies.size}")
    axes = new_figure(1, (6.5, 4.0))[1][0] if ax is None else given_axes(ax)
    pictures[kind](axes, found, energies)
    _, labels = axes.get_legend_handles_labels()
    if labels:
        # Beside the lines, which may be anywhere within.
        legend_beside(axes)
    return cast("Figure", axes.figure)


def _lines(energies: NDArray[np.float64]) -> Iterator[tuple[float, dict[str, Any]]]:
    """Each energy and the look of its line."""
    for at, energy in enumerate(energies.tolist()):
        look = {"color": COLORS[at % len(COLORS)], "linestyle": LINES[at // len(COLORS)], "linewidth": 1.2}
        yield energy, {"label": f"E = {energy:.4g}", **look}


def _of_energy(
    found: Deflection, column: NDArray[np.float64], energy: float, breaks: list[float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A column against the impact parameters of one energy, NaN where the line breaks."""
    mine = np.ravel(found.energy == energy)
    b, values = np.ravel(found.impact_parameter)[mine], np.ravel(column)[mine]
    b, values = np.append(b, breaks), np.append(values, np.full(len(breaks), np.nan))
    order = np.argsort(b, kind="stable")
    return b[order], values[order]


def _draw(axes: Any, b: NDArray[np.float64], values: NDArray[np.float64], look: dict[str, Any]) -> None:
    # What was asked for at a few places only is shown as those.
    few = {"marker": "o", "markersize": 3} if b.size <= 40 else {}
    axes.plot(b, values, **look, **few)


def _angle(axes: Any, found: Deflection, energies: NDArray[np.float64]) -> None:
    """ψ(b), with its rainbows, glories and orbits, as far as impact parameters were asked for."""
    first, last = float(np.min(found.impact_parameter)), float(np.max(found.impact_parameter))
    low, high, whirls, captures = 0.0, 0.0, False, False
    marks: dict[str, list[tuple[float, float, str]]] = {"rainbow": [], "glory": []}
    for energy, look in _lines(energies):
        color = look["color"]
        orbits = _within(orbiting(found.potential, energy=energy), first, last)
        b, psi = _of_energy(found, np.degrees(found.angle), energy, [each.impact_parameter for each in orbits])
        _draw(axes, b, psi, look)
        for orbit in orbits:
            axes.axvline(orbit.impact_parameter, color=color, linewidth=0.8, linestyle=":", zorder=1)
            if orbit.captures:
                axes.axvspan(first, orbit.impact_parameter, color=color, alpha=_TINT, linewidth=0.0, zorder=0)
                captures = True
        bows = _within(rainbows(found.potential, energy=energy), first, last)
        marks["rainbow"] += [(bow.impact_parameter, np.degrees(bow.angle), color) for bow in bows]
        ways = _within(glories(found.potential, energy=energy), first, last)
        marks["glory"] += [(way.impact_parameter, np.degrees(way.angle), color) for way in ways]
        whirls = whirls or bool(orbits)
        rest = [np.degrees(bow.angle) for bow in bows] or [0.0]
        known = psi[np.isfinite(psi)]
        low = min([low, *rest, *([] if orbits else known)])
        high = max([high, *rest, *known])
    if whirls:
        low = min(low, _WHIRL)
    for (name, places), shape in zip(marks.items(), ("o", "s"), strict=True):
        shown = [place for place in places if low <= place[1] <= high]
        for at, (b_marked, psi_marked, color) in enumerate(shown):
            filled = color if name == "rainbow" else "white"
            label = name if at == 0 else None
            look = {"markersize": 5, "markeredgecolor": color, "markerfacecolor": filled, "zorder": 3}
            axes.plot([b_marked], [psi_marked], shape, color=color, label=label, **look)
    if whirls:
        axes.plot([], [], color="0.4", linewidth=0.8, linestyle=":", label="orbiting")
    if captures:
        axes.fill([], [], color="0.4", alpha=_TINT, linewidth=0.0, label="captured")
    axes.axhline(0.0, color=FRAME, linewidth=0.6, zorder=0)
    room = 0.05 * (high - low) or 1.0
    axes.set(xlabel="impact parameter", ylabel="deflection ψ [degrees]", ylim=(low - room, high + room))
    _as_far_as_asked(axes, first, last)


def _as_far_as_asked(axes: Any, first: float, last: float) -> None:
    """All impact parameters, also those of which nothing is drawn."""
    room = 0.01 * (last - first) or 0.5 * max(last, 1.0)
    axes.set_xlim(first - room, last + room)


def _within(marks: Any, first: float, last: float) -> list[Any]:
    return [mark for mark in marks if first <= mark.impact_parameter <= last]


def _closest_approach(axes: Any, found: Deflection, energies: NDArray[np.float64]) -> None:
    """The outermost turning point, beside that of a straight line."""
    first, last = float(np.min(found.impact_parameter)), float(np.max(found.impact_parameter))
    for energy, look in _lines(energies):
        orbits = _within(orbiting(found.potential, energy=energy), first, last)
        there = np.where(np.isnan(found.angle), np.nan, found.closest_approach)
        b, nearest = _of_energy(found, there, energy, [each.impact_parameter for each in orbits])
        _draw(axes, b, nearest, look)
    axes.plot([first, last], [first, last], color=FRAME, linewidth=0.8, linestyle="-", zorder=0, label="straight on")
    axes.set(xlabel="impact parameter", ylabel="closest approach", ylim=(0.0, None))
    _as_far_as_asked(axes, first, last)


def _cross_section(axes: Any, found: Deflection, energies: NDArray[np.float64]) -> None:
    """dσ/dΩ of all impact parameters, on whatever few the deflection was found."""
    everything: list[NDArray[np.float64]] = []
    bows = False
    for energy, look in _lines(energies):
        edges = _rainbow_degrees(found.potential, energy)
        around = (
            np.add.outer(edges, np.geomspace(_NEAR, 5.0, 24)),
            np.subtract.outer(edges, np.geomspace(_NEAR, 5.0, 24)),
        )
        angles = np.concatenate([np.linspace(_FIRST, _LAST, _POINTS), *(np.ravel(each) for each in around)])
        # Nearer to a rainbow than that the picture would be of how near it is.
        near = (np.abs(angles[:, None] - edges[None, :]) < 0.999 * _NEAR).any(axis=1)
        angles = np.unique(angles[(angles >= _FIRST) & (angles <= _LAST) & ~near])
        sigma = cross_section(found.potential, energy=energy, angle=np.radians(angles))
        sigma = np.where((sigma > 0.0) & np.isfinite(sigma), sigma, np.nan)
        everything.append(sigma[np.isfinite(sigma)])
        angles, sigma = np.append(angles, edges), np.append(sigma, np.full(edges.size, np.nan))
        order = np.argsort(angles)
        axes.plot(angles[order], sigma[order], **look)
        for edge in edges:
            axes.axvline(edge, color=look["color"], linewidth=0.8, linestyle=":", zorder=1)
        bows = bows or bool(edges.size)
    if bows:
        axes.plot([], [], color="0.4", linewidth=0.8, linestyle=":", label="rainbow")
    drawn = np.concatenate(everything)
    if drawn.size and drawn.max() > 30.0 * drawn.min():
        axes.set_yscale("log")
    elif drawn.size:
        axes.set_ylim(0.0, 1.2 * drawn.max())
    axes.set(xlabel="angle in the center-of-mass frame [degrees]", ylabel="dσ/dΩ [area per steradian]")
    # Numbers at every 30 degrees lie on each other where there is little room.
    wide = axes.get_position().width * axes.figure.get_size_inches()[0] > 3.0
    axes.set(xlim=(0.0, 180.0), xticks=range(0, 181, 30 if wide else 60))


def _rainbow_degrees(potential: Potential, energy: float) -> NDArray[np.float64]:
    """The angles from the beam at which rainbows stand, whole turns and either side put together."""
    folded = [abs(np.remainder(bow.angle + np.pi, 2.0 * np.pi) - np.pi) for bow in rainbows(potential, energy=energy)]
    degrees = np.degrees(np.array(folded, dtype=np.float64))
    return degrees[(degrees > _FIRST) & (degrees < _LAST)]
