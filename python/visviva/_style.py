"""How all pictures look: colors that color-blind readers tell apart, and lines that a print without colors does.

The one idea: the style belongs to the axes that are made here, so that neither the settings of the caller nor axes that
were given are touched. Who wants it in figures of their own asks for it: `plot_style`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import known_keywords
from visviva._packages import needed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

__all__ = [
    "BLUE",
    "COLORS",
    "FRAME",
    "LINES",
    "VERMILION",
    "legend_beside",
    "legend_within",
    "plot_style",
    "set_box",
    "style_axes",
]

# M. Okabe & K. Ito, *Color Universal Design* (2008), without the yellow, which is not seen on white.
BLUE, VERMILION = "#0072B2", "#D55E00"
COLORS = (BLUE, VERMILION, "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "#000000")
# What only helps the eye: circles, zero lines, frames.
FRAME = "0.7"
# After the colors are used up, the next round differs in its lines.
LINES = ("-", "--", "-.", ":")


# Numbers along the longest side of a box of three dimensions, and along the shortest.
_NUMBERS = (4, 2)
# Inches of axes below which there are fewer and smaller ones.
_SMALL, _FEWER = 3.0, (3, 1)
# Points of width of a digit of them.
_DIGIT = 5.0
# A legend that would take more than this part of the height of axes that were given is left to the caller.
_ROOM = 0.45
# And one beside axes that is more than this part of their width goes within.
_WIDE = 0.5


@known_keywords
def plot_style() -> dict[str, object]:
    """Give the matplotlib settings that make your own figures look like those of the package.

    Its colors are Okabe and Ito's, which color-blind readers tell apart; after them lines differ by their dashes.

    Returns
    -------
    dict
        For ``plt.style.context(…)``, around where axes are made, or for ``plt.style.use(…)``.

    Raises
    ------
    visviva.InvalidInput
        If matplotlib is not installed.

    References
    ----------
    M. Okabe, K. Ito, *Color Universal Design*, jfly.uni-koeln.de/color (2008).

    Examples
    --------
    >>> import matplotlib.pyplot as plt, visviva as vv
    >>> with plt.style.context(vv.plot_style()):
    ...     figure, ax = plt.subplots()
    >>> ax.plot([0.0, 1.0])[0].get_color()
    '#0072B2'
    >>> plt.close(figure)
    """
    return {"axes.prop_cycle": _cycle(), "axes.spines.top": False, "axes.spines.right": False}


def _cycle() -> Any:
    cycler = needed("cycler", "plot", "plot").cycler
    return cycler(linestyle=LINES) * cycler(color=COLORS)


def style_axes(axes: Axes) -> None:
    """Give new axes the colors and the frame of all pictures."""
    axes.set_prop_cycle(_cycle())
    if not hasattr(axes, "get_zlim"):
        axes.spines[["top", "right"]].set_visible(False)


def set_box(axes: Any, sides: Sequence[float] | NDArray[np.float64]) -> None:
    """Give a box of three dimensions its sides, and room for the names of its axes, which no layout knows of.

    Numbers along axes that are seen aslant lie on each other sooner: the shorter a side, the fewer it has. Names do not
    shrink with the axes, so that the box does the more.
    """
    place = axes.get_position()
    inches = float(min(np.array([place.width, place.height]) * axes.figure.get_size_inches()))
    longest = max(sides)
    # A box that is long in one direction is drawn longer than a cube.
    cube = (np.linalg.norm(sides) / (longest * np.sqrt(3.0))) ** 0.5
    # A tuple: an array would be scaled in place.
    axes.set_box_aspect(tuple(sides), zoom=float(cube * max(0.5, 0.92 - 0.45 / inches)))
    most, least = _NUMBERS if inches > _SMALL else _FEWER
    for letter, side in zip("xyz", sides, strict=True):
        axes.locator_params(axis=letter, nbins=max(least, round(most * side / longest)))
        axis = getattr(axes, f"{letter}axis")
        numbers = axis.get_major_formatter().format_ticks(axis.get_majorticklocs())
        wide = _DIGIT * max(0, max(map(len, numbers), default=0) - 2)
        # Those of the third axis are beside its line, not below, and placed by their middle.
        pad, further = (4.0 + 0.5 * wide, wide) if letter == "z" else (0.0, 0.3 * wide)
        axes.tick_params(axis=letter, labelsize="small" if inches > _SMALL else "x-small", pad=pad)
        # A name is the further from its line the wider its numbers are.
        axis.labelpad = (9.0 + further) / cube


def legend_beside(axes: Any, *, columns: int = 1, fontsize: str = "small") -> None:
    """Name what is drawn, beside it; in axes that were given, which need not have the room, within them."""
    solid = hasattr(axes, "get_zlim")
    if axes.figure.get_layout_engine() is not None:
        # The numbers of the third axis are on the right.
        place = ("upper right", (0.0, 1.0)) if solid else ("upper left", (1.0, 1.0))
        legend = axes.legend(fontsize=fontsize, loc=place[0], bbox_to_anchor=place[1], ncols=columns)
        if legend.get_window_extent().width <= _WIDE * axes.get_window_extent().width:
            return
    legend_within(axes, fontsize=fontsize)


def legend_within(axes: Any, *, fontsize: str = "small") -> None:
    """Name what is drawn where nothing is, or above it, which makes room; of three dimensions, below the box.

    Where there is no room there is no legend. What is drawn keeps its names: the caller may place them.
    """
    if hasattr(axes, "get_zlim"):
        names = len(axes.get_legend_handles_labels()[1])
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.03)}
        legend = axes.legend(fontsize="x-small", ncols=min(names, 4), **place)
        if legend.get_window_extent().y0 < axes.figure.bbox.y0:
            legend.remove()
        return
    # What is drawn lies where its limits say, and these are found no sooner than they are asked for.
    axes.get_xlim(), axes.get_ylim()
    axes.apply_aspect()
    if not _covers(axes, axes.legend(fontsize=fontsize).get_window_extent()):
        return
    box = axes.get_window_extent()
    for size, columns in ((fontsize, 3), (fontsize, 2), (fontsize, 1), ("x-small", 3), ("x-small", 2), ("x-small", 1)):
        legend = axes.legend(fontsize=size, loc="upper center", ncols=columns, borderaxespad=0.3)
        taken = legend.get_window_extent()
        part = 1.1 * taken.height / box.height
        if taken.width <= box.width and part <= _ROOM:
            break
    else:
        legend.remove()
        return
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    top = float(scale.inverted().transform([low + (high - low) / (1.0 - part)])[0])
    if axes.get_autoscaley_on():
        # As one more place to show, so that what is drawn later is shown, too.
        axes.update_datalim([(0.0, top)], updatex=False)
        axes.autoscale_view(scalex=False)
    else:
        axes.set_ylim(top=top)


def _covers(axes: Any, box: Any) -> bool:
    """Whether a line or an area lies within a box of the screen."""
    drawn = [(line.get_path(), line) for line in axes.lines]
    drawn += [(path, each) for each in axes.collections for path in each.get_paths()]
    return any(path.transformed(of.get_transform()).intersects_bbox(box, filled=False) for path, of in drawn)


def __dir__() -> list[str]:
    return list(__all__)
