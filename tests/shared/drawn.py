"""What pictures show, read from their axes."""

from io import BytesIO
from typing import Any

import numpy as np


def columns(line: Any) -> tuple[np.ndarray, np.ndarray]:
    """The numbers of a line."""
    return np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)


def named(axes: Any) -> dict[str, Any]:
    """What the legend tells, by its label."""
    return dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))


def nothing_is_clipped(figure: Any) -> None:
    """All axes with their labels lie in the figure."""
    figure.savefig(BytesIO())  # which lays it out
    whole = figure.bbox.padded(1)
    for axes in figure.axes:
        box = axes.get_tightbbox()
        assert box is not None
        assert whole.containsx(box.x0)
        assert whole.containsx(box.x1)
        assert whole.containsy(box.y0)
        assert whole.containsy(box.y1)
