"""Panels of what data leave beside theory: below the data, on the same scale across.

The one idea: who gives axes gets the data in them, and what is left where `residuals` says; without axes both are in a
figure that is made here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva._style import FRAME, style_axes
from visviva.errors import InvalidInput
from visviva.plot import given_axes, new_figure

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["data_and_residuals", "mark_none", "new_panels"]

# Panels beside each other; more begin a new row.
_ROW = 3
# Heights of data and of what they leave.
_HEIGHTS = (3.0, 1.0)


def new_panels(
    below: Sequence[bool], size: tuple[float, float], solid: Collection[int] = ()
) -> tuple[Figure, list[tuple[Axes, Axes | None]]]:
    """A figure of panels, some with a lower panel that shares their x.

    Parameters
    ----------
    below : sequence of bool
        For each panel, whether there is another below it.
    size : tuple of float
        Of one panel, in inches.
    solid : collection of int, optional
        Panels that show three dimensions.

    Raises
    ------
    visviva.InvalidInput
        If matplotlib is not installed.
    """
    across = max(min(len(below), _ROW), 1)
    rows = max(-(-len(below) // across), 1)
    figure, _ = new_figure(0, (size[0] * across, size[1] * rows))
    grid = figure.add_gridspec(2 * rows, across, height_ratios=_HEIGHTS * rows)
    panels: list[tuple[Axes, Axes | None]] = []
    for at, two in enumerate(below):
        row, column = 2 * (at // across), at % across
        place = grid[row if two else slice(row, row + 2), column]
        upper = figure.add_subplot(place, projection="3d" if at in solid else "rectilinear")
        style_axes(upper)
        lower = None
        if two:
            lower = figure.add_subplot(grid[row + 1, column], sharex=upper)
            style_axes(lower)
            upper.tick_params(labelbottom=False)
        panels.append((upper, lower))
    return figure, panels


def data_and_residuals(
    ax: Any, residuals: Any, size: tuple[float, float], *, known: bool = True
) -> tuple[Axes, Axes | None]:
    """The axes of data and those of what they leave, if there are any: those that were given, or new ones.

    Parameters
    ----------
    ax, residuals : matplotlib.axes.Axes or None
        As the caller gave them.
    size : tuple of float
        Of the new figure, in inches.
    known : bool, optional
        Whether something is left to draw: whether there is a theory.

    Raises
    ------
    visviva.InvalidInput
        If matplotlib is not installed; for what are no axes, and for `residuals` without `ax` or without a theory.
    """
    if residuals is None:
        return new_panels([known], size)[1][0] if ax is None else (given_axes(ax), None)
    if not hasattr(residuals, "plot"):
        raise InvalidInput("residuals", f"expected axes of matplotlib, as of plt.subplots(2), got {residuals!r}")
    if ax is None:
        raise InvalidInput("residuals", "expected ax= with it, where the data go; without both there is a new figure")
    if not known:
        raise InvalidInput(
            "residuals", "expected a theory that leaves some, and nothing is expected here: leave it out"
        )
    return given_axes(ax), residuals


def mark_none(axes: Axes, value: float, half: float) -> None:
    """Mark where nothing is left, and the band of what is left by chance."""
    axes.axhspan(value - half, value + half, color="0.93", linewidth=0.0, zorder=-1)
    axes.axhline(value, color=FRAME, linewidth=0.8, linestyle="-", zorder=0)


def __dir__() -> list[str]:
    return list(__all__)
