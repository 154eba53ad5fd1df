"""How all pictures look: colors that color-blind readers tell apart, and lines that a print without colors does.

The one idea: the style belongs to the axes that are made here, so that neither the settings of the caller nor axes that
were given are touched.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

__all__ = ["BLUE", "COLORS", "FRAME", "LINES", "VERMILION", "dress", "legend_beside", "set_box"]

# M. Okabe & K. Ito, *Color Universal Design* (2008), without the yellow, which is not seen on white.
BLUE, VERMILION = "#0072B2", "#D55E00"
COLORS = (BLUE, VERMILION, "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "#000000")
# What only helps the eye: circles, zero lines, frames.
FRAME = "0.7"
# After the colors are used up, the next round differs in its lines.
LINES = ("-", "--", "-.", ":")


def dress(axes: Axes, solid: bool) -> None:
    """Give new axes the colors and the frame of all pictures."""
    from cycler import cycler

    axes.set_prop_cycle(cycler(linestyle=LINES) * cycler(color=COLORS))
    if solid:
        # Numbers along three axes that are seen aslant lie on each other sooner.
        axes.locator_params(nbins=4)
        axes.tick_params(labelsize="small")
    else:
        axes.spines[["top", "right"]].set_visible(False)


def set_box(axes: Any, sides: Sequence[float] | NDArray[np.float64]) -> None:
    """Give a box of three dimensions its sides, and room for the names of its axes, which no layout knows of."""
    axes.set_box_aspect(sides, zoom=0.85)


def legend_beside(axes: Any) -> None:
    """Name what is drawn, beside it; within axes that were given, whose figure need not have the room."""
    if axes.figure.get_layout_engine() is None:
        axes.legend(fontsize="small")
    elif hasattr(axes, "get_zlim"):
        # The numbers of the third axis are on the right.
        axes.legend(fontsize="small", loc="upper right", bbox_to_anchor=(0.0, 1.0))
    else:
        axes.legend(fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))


def __dir__() -> list[str]:
    return list(__all__)
