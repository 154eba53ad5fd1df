"""Pictures of ensembles: every copy as a thin line, or how many of them are where, against time.

The one idea: a picture is of one number of each copy at each time, (B, T); what the number is, is looked up before.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._column_axes import COLUMN_AXES, components_of
from visviva._keywords import one_of
from visviva._plot_columns import hold_level, size_of_column
from visviva._style import BLUE, legend_beside
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.plot import POINTS, given_axes, is_noise, mark_round_off, new_figure, sizes_of_terms

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.ensemble_trajectory import EnsembleTrajectory
    from visviva.generalized._ensemble_trajectory import GeneralizedEnsembleTrajectory

__all__ = ["plot_ensemble", "plot_generalized"]

#: More lines than this cannot be told apart.
_MOST_LINES = 60
#: Parts of the copies between the ends of each band, and how it is called.
_BANDS = ((5.0, 95.0, 0.18, "9 of 10 copies"), (25.0, 75.0, 0.35, "half of the copies"))


def plot_ensemble(
    run: EnsembleTrajectory, column: object, body: object, component: object, kind: object, ax: Axes | None
) -> Figure:
    """As `EnsembleTrajectory.plot`."""
    name = one_of("column", column, tuple(COLUMN_AXES))
    over = COLUMN_AXES[name]
    if over[:1] == ("rigid_body",) and run.ensemble.scene.rigid_bodies is None:
        raise InvalidInput("column", f"{name} is that of a rigid body, and there is none")
    values = _of_body(run, name, body) if over and over[0] in ("body", "rigid_body") else _of_scene(run, name, body)
    letters, shown = components_of(name, component)
    panels = values[..., list(shown)] if letters else values[..., None]
    labels = [f"{name}, {letters[at]}" for at in shown] or [name.replace("_", " ")]
    terms = None
    if name == "energy":
        terms = np.ones(len(values))
        if "velocity" in run.recorded and run.velocity.shape[2]:
            kinetic = 0.5 * np.einsum("btik,btik,bi->bt", run.velocity, run.velocity, run.ensemble.mass)
            terms = sizes_of_terms(kinetic, values)
    size = size_of_column(run, name, run.ensemble.mass[:, None, :])
    return _panels(run.t, panels, [label.replace("_", " ") for label in labels], kind, ax, terms=terms, size=size)


def plot_generalized(
    run: GeneralizedEnsembleTrajectory, column: object, coordinate: object, kind: object, ax: Axes | None
) -> Figure:
    """As `GeneralizedEnsembleTrajectory.plot`."""
    name = one_of("column", column, ("position", "velocity", "momentum", "energy"))
    names = list(run.ensemble.system.coordinates)
    if name == "energy":
        if coordinate is not None:
            raise InvalidInput("coordinate", f"energy is one number and has no coordinates, got {coordinate!r}")
        # Of a kinetic energy that is a square of the velocities half of this.
        kinetic = 0.5 * (run.momentum * run.velocity).sum(axis=-1)
        terms = sizes_of_terms(np.abs(kinetic), run.energy)
        return _panels(run.t, run.energy[..., None], [name], kind, ax, terms=terms)
    chosen = names if coordinate is None else [one_of("coordinate", coordinate, names)]
    values = getattr(run, name)[..., [names.index(each) for each in chosen]]
    before = "" if name == "position" else f"{name} of "
    return _panels(run.t, values, [before + each for each in chosen], kind, ax)


def _of_scene(run: EnsembleTrajectory, name: str, body: object) -> NDArray[np.float64]:
    if body is not None:
        raise InvalidInput("body", f"{name} is that of the whole scene, got body={body!r}")
    values: NDArray[np.float64] = getattr(run, name)
    return values


def _of_body(run: EnsembleTrajectory, name: str, body: object) -> NDArray[np.float64]:
    if body is None:
        bodies = run.ensemble.mass.shape[1]
        if bodies != 1:
            raise InvalidInput("body", f"say of which of {bodies} bodies, as body=0")
        body = 0
    values: NDArray[np.float64] = getattr(run.body(cast("int", body)), name)
    return values


def _panels(
    t: NDArray[np.float64],
    values: NDArray[np.float64],
    labels: list[str],
    kind: object,
    ax: Axes | None,
    *,
    terms: NDArray[np.float64] | None = None,
    size: float = 0.0,
) -> Figure:
    """One panel for each number of the last axis of (B, T, K); with `terms`, of energies, of their changes.

    `size` is that of what numbers are the sum of, of which changes of 1e-16 are rounding.
    """
    copies = len(values)
    drawn = None if kind is None else one_of("kind", kind, _KINDS)
    if not len(t):
        raise InvalidInput("plot", "expected a run with times, got 0 times")
    if ax is not None:
        if len(labels) != 1:
            raise InvalidInput("ax", f"one pair of axes takes one panel, and there are {len(labels)}: {labels}")
        axes, figure = [given_axes(ax)], cast("Figure", ax.figure)
    else:
        figure, axes = new_figure(len(labels), (1.5 + 4.0 * len(labels), 3.6))
    stride = max(1, len(t) // POINTS)
    for at, (panel, label) in enumerate(zip(axes, labels, strict=True)):
        numbers, named = values[:, ::stride, at], label
        floor = noise = False
        if terms is not None:
            numbers, relative = _changes(numbers)
            named = "(E − E₀) / |E₀|" if relative else "E − E₀"
            floor = relative and mark_round_off(panel, numbers, terms)
            noise = floor or is_noise(numbers)
        if drawn is None:
            # Of what is noise a band would look like a signal.
            drawn = "lines" if noise or copies <= _MOST_LINES else "bands"
        _KINDS[drawn](panel, t[::stride], numbers, noise)
        panel.set(xlabel="t", ylabel=named)
        if terms is None:
            hold_level(panel, numbers, size)
        panel.margins(x=0.01)
        # Ends of the scale, of so few digits that they do not lie on each other.
        panel.locator_params(axis="x", nbins=6)
        if terms is not None and not floor:
            panel.ticklabel_format(axis="y", style="sci", scilimits=(-3, 3))
    if drawn == "bands":
        legend_beside(axes[-1])
    ended = int(np.isnan(values[:, -1]).any(axis=-1).sum())
    ended_by = f", of which {ended} ended before" if ended else ""
    axes[0].set_title(f"{count(copies, 'copy', 'copies')}{ended_by}", loc="left", fontsize="medium")
    return figure


def _changes(energy: NDArray[np.float64]) -> tuple[NDArray[np.float64], bool]:
    """Changes of each copy's own energy since its start, and whether relative to it: not if one of them is 0."""
    first = energy[:, :1]
    relative = not (first == 0.0).any()
    return (energy - first) / (np.abs(first) if relative else 1.0), relative


def _lines(axes: Any, t: NDArray[np.float64], values: NDArray[np.float64], noise: bool) -> None:
    alpha = float(np.clip(12.0 / len(values), 0.1, 0.8))
    # Points, where a line would draw noise as a signal.
    look = {"marker": ".", "markersize": 2, "linestyle": "none"} if noise else {"linewidth": 0.8, "linestyle": "-"}
    axes.plot(t, values.T, color=BLUE, alpha=alpha, **look)


def _bands(axes: Any, t: NDArray[np.float64], values: NDArray[np.float64], _noise: bool) -> None:
    # Of those that are there; where none is, nothing is drawn.
    there = ~np.isnan(values).all(axis=0)
    t, values = t[there], values[:, there]
    for low, high, alpha, label in _BANDS:
        ends = np.nanpercentile(values, [low, high], axis=0)
        axes.fill_between(t, *ends, color=BLUE, alpha=alpha, linewidth=0.0, label=label)
    axes.plot(t, np.nanmedian(values, axis=0), color=BLUE, linewidth=1.2, linestyle="-", label="median")


_KINDS: dict[str, Any] = {"bands": _bands, "lines": _lines}


def __dir__() -> list[str]:
    return list(__all__)
