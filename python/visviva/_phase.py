"""Pictures in phase space: of bodies a component of their places against that of their velocities.

The one idea: along a run it is a line for each body, and at the events of a run points, a Poincaré section of it; in
generalized coordinates these are of a coordinate and its momentum.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._exported import AXES
from visviva._keywords import one_of
from visviva._names import body_index
from visviva._style import legend_beside
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.plot import LEGEND, POINTS, axes_or_new, chosen_bodies

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva._event_table import EventTable, Lines
    from visviva.generalized._events import GeneralizedEventTable
    from visviva.trajectory import Trajectory

__all__ = ["plot_generalized_section", "plot_phase", "plot_section"]


def plot_phase(run: Trajectory, component: object, bodies: object, ax: Axes | None) -> Axes:
    """As `Trajectory.plot_phase`."""
    chosen, names = chosen_bodies("plot_phase", run, bodies), run.scene.particles.names
    places, rates = run.position[:, chosen], run.velocity[:, chosen]
    at = _component(component, places)
    axes = axes_or_new(ax)
    stride = max(1, len(run) // POINTS)
    for index, body in enumerate(chosen):
        x, v = places[:, index, at], rates[:, index, at]
        (line,) = axes.plot(x[::stride], v[::stride], linewidth=0.8, label=names[body] if names else None)
        axes.plot(x[-1:], v[-1:], "o", markersize=4, color=line.get_color())
    _label(axes, at)
    if names and len(chosen) <= LEGEND:
        legend_beside(axes)
    return axes


def plot_section(table: EventTable, component: object, body: object, ax: Axes | None) -> Axes:
    """As `EventTable.plot`."""
    bodies = table.position.shape[1]
    if body is None and bodies != 1:
        raise InvalidInput("body", f"say of which of {count(bodies, 'body', 'bodies')}, as body=0")
    one = 0 if body is None else body_index("body", body, table.names, bodies)
    at = _component(component, table.position[:, [one]])
    axes = _points(table, table.position[:, one, at], table.velocity[:, one, at], ax)
    _label(axes, at)
    return axes


def plot_generalized_section(table: GeneralizedEventTable, name: object, ax: Axes | None) -> Axes:
    """As `GeneralizedEventTable.plot`."""
    names = list(table.coordinates)
    chosen = names[-1] if name is None else one_of("name", name, names)
    at = names.index(chosen)
    axes = _points(table, table.position[:, at], table.momentum[:, at], ax)
    axes.set(xlabel=chosen, ylabel=f"momentum of {chosen}")
    return axes


def _points(table: Lines[Any], x: NDArray[np.float64], v: NDArray[np.float64], ax: Axes | None) -> Axes:
    """A point for each event, of a color for each copy, or of a single run for each event that was looked for."""
    if not len(table):
        raise InvalidInput("plot", "expected at least one event, got none: run longer, or look for another event")
    axes = axes_or_new(ax)
    copies = len(np.unique(table.member)) > 1
    of: NDArray[np.int64] = table.member if copies else table.which
    kinds = [event.kind for event in table.definitions]
    each = np.unique(of)
    for one in each:
        # Of files of before definitions were kept there are none.
        label = f"{one} {kinds[one]}" if not copies and one < len(kinds) else None
        axes.plot(x[of == one], v[of == one], ".", markersize=3, label=label)
    if not copies and kinds and 1 < len(each) <= LEGEND:
        legend_beside(axes)
    return axes


def _component(component: object, places: NDArray[np.float64]) -> int:
    """The number of a component: the one that was asked for, or that in which the places extend most."""
    letters = [str(each) for each in AXES["component"]]
    if component is not None:
        return letters.index(one_of("component", component, letters))
    if not len(places):
        return 0
    low, high = np.fmin.reduce(places, axis=(0, 1)), np.fmax.reduce(places, axis=(0, 1))
    return int(np.argmax(np.nan_to_num(high - low)))


def _label(axes: Any, at: int) -> None:
    letter = AXES["component"][at]
    axes.set(xlabel=f"position, {letter}", ylabel=f"velocity, {letter}")


def __dir__() -> list[str]:
    return list(__all__)
