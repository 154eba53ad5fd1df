"""Pictures of what was measured beside theory, with what is left below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._residuals import data_and_residuals, mark_none
from visviva._style import BLUE, COLORS, VERMILION, legend_beside, legend_within

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.datasets.toutatis import ToutatisComparison

__all__ = ["COUNT_ERROR", "plot_counts", "plot_toutatis"]

#: What the relative error of a published count is taken as: they were normalized, and are no raw counts.
COUNT_ERROR = 0.05
_LOOKS = {"silver": ("s", BLUE), "gold": ("o", VERMILION)}
# Degrees between which the law is drawn.
_DEGREES = (12.0, 170.0)


def plot_counts(
    ax: Axes | None,
    residuals: Axes | None,
    metal: str,
    angle: NDArray[np.float64],
    counted: NDArray[np.float64],
    law: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    *,
    simulated: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None,
    note: str = "",
) -> Axes:
    """Draw counts of a metal at angles in degrees, the law that they are held against, and both over it below.

    `simulated` are the numbers of a simulation and their errors, in counts; `note` follows the name of the counts.
    """
    axes, lower = data_and_residuals(ax, residuals, (6.5, 6.0))
    marker, color = _LOOKS[metal]
    fine = np.linspace(*_DEGREES, 400)
    axes.plot(fine, law(fine), linewidth=0.9, linestyle="-", color=color, label=f"{metal}: Rutherford's law")
    look: dict[str, Any] = {"fmt": marker, "markerfacecolor": "none", "color": color}
    numbers = [(counted, COUNT_ERROR * counted, look, f"{metal}: counted in 1913{note}")]
    if simulated is not None:
        numbers.append((*simulated, {"fmt": "+", "color": "black", "markersize": 9}, f"{metal}: simulated"))
    for values, error, how, label in numbers:
        axes.errorbar(angle, values, error, label=label, **how)
        if lower is not None:
            lower.errorbar(angle, values / law(angle), error / law(angle), **how)
    axes.set(ylabel="scintillations", yscale="log", title="Geiger and Marsden, 1913, table II")
    (axes if lower is None else lower).set_xlabel("angle from the beam φ [degrees]")
    legend_within(axes)
    if lower is not None:
        if not lower.patches:
            mark_none(lower, 1.0, COUNT_ERROR)
        lower.set_ylabel("over the law")
    return axes


def plot_toutatis(found: ToutatisComparison, ax: Axes | None, residuals: Axes | None) -> Axes:
    """A picture of a tumbling asteroid; see `ToutatisComparison.plot`."""
    axes, lower = data_and_residuals(ax, residuals, (7.0, 6.0))
    data = found.spin_state
    t = data.radar.t
    fine = np.linspace(t[0] - 0.5, t[-1] + 0.5, 400)
    computed, seen = (np.degrees(each.angular_velocity) for each in (data.motion(fine), data.radar))
    for at, letter in enumerate("xyz"):
        axes.plot(
            fine, computed[:, at], linewidth=0.9, linestyle="-", color=COLORS[at], label=f"ω{letter}: free rotation"
        )
        axes.plot(t, seen[:, at], "o", markerfacecolor="none", color=COLORS[at], label=f"ω{letter}: radar")
    axes.set(ylabel="ω in the body [degrees per day]", title="4179 Toutatis, December 1992")
    (axes if lower is None else lower).set_xlabel(f"days since {data.epoch} UTC")
    legend_beside(axes)
    if lower is not None:
        angles = {"attitude": found.attitude, "long axis": found.long_axis, "direction of ω": found.spin_direction}
        for (name, values), marker, color in zip(angles.items(), "o^s", COLORS[3:], strict=False):
            lower.plot(t, values, marker, markersize=4, color=color, label=name)
        lower.set(ylabel="apart [degrees]", ylim=(0.0, None))
        legend_beside(lower)
    return axes


def __dir__() -> list[str]:
    return list(__all__)
