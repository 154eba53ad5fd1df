"""How all pictures look: colors that color-blind readers tell apart, and lines that a print without colors does.

The one idea: the style belongs to the axes that are made here, so that neither the settings of the caller nor axes that
were given are touched.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["BLUE", "COLORS", "FRAME", "LINES", "VERMILION", "dress"]

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
    if not solid:
        axes.spines[["top", "right"]].set_visible(False)


def __dir__() -> list[str]:
    return list(__all__)
