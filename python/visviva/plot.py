"""Pictures of runs, as matplotlib figures that belong to the caller (pyplot's state is never touched)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._text import count
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Collection

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from visviva.trajectory import Trajectory

__all__ = ["axes_or_new", "new_figure", "plot_trajectory"]

# More points than this cannot be told apart in a figure and make the file large.
_POINTS = 4000
# A legend of more bodies would hide the picture.
_LEGEND = 24


def new_figure(panels: int, size: tuple[float, float], solid: Collection[int] = ()) -> tuple[Figure, list[Axes]]:
    """A figure with a row of panels, of which some show three dimensions.

    Raises
    ------
    visviva.InvalidInput
        If matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise InvalidInput("plot", "matplotlib is not installed; pip install 'visviva[plot]'") from error
    figure = Figure(figsize=size, layout="constrained")
    kinds = ["3d" if panel in solid else "rectilinear" for panel in range(panels)]
    return figure, [figure.add_subplot(1, panels, at, projection=kind) for at, kind in enumerate(kinds, start=1)]


def axes_or_new(axes: Axes | None) -> Axes:
    """The axes that were given, or those of a new figure.

    Raises
    ------
    visviva.InvalidInput
        If there are none and matplotlib is not installed.
    """
    return new_figure(1, (5.5, 4.0))[1][0] if axes is None else axes


def plot_trajectory(trajectory: Trajectory) -> Figure:
    """Orbits in the plane of their largest extent and, if it is known, the relative change of the energy."""
    if not trajectory.scene.particles or not len(trajectory):
        raise InvalidInput(
            "plot",
            "expected a trajectory with bodies and times, got "
            f"{count(len(trajectory.scene.particles), 'body', 'bodies')} and {count(len(trajectory), 'time')}",
        )
    with_energy = "energy" in trajectory.recorded or {"position", "velocity"} <= set(trajectory.recorded)
    figure, axes = new_figure(2 if with_energy else 1, (11.0 if with_energy else 5.5, 5.0))
    _orbits(axes[0], trajectory)
    if with_energy:
        _energy(axes[1], trajectory)
    return figure


def _orbits(axes: Axes, trajectory: Trajectory) -> None:
    names = trajectory.scene.particles.names
    stride = max(1, len(trajectory) // _POINTS)
    position = trajectory.position[::stride]
    # The two largest extents; of equal ones the earlier axis.
    extent = np.ptp(trajectory.position.reshape(-1, 3), axis=0)
    across, up = sorted(np.argsort(-extent, kind="stable")[:2].tolist())
    for body in range(position.shape[1]):
        label = names[body] if names else None
        (line,) = axes.plot(position[:, body, across], position[:, body, up], linewidth=0.8, label=label)
        axes.plot(*trajectory.position[-1, body, [across, up]], "o", markersize=4, color=line.get_color())
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="xyz"[across], ylabel="xyz"[up], title="orbits")
    if 0 < len(names) <= _LEGEND:
        axes.legend(fontsize="small", loc="upper right")


def _energy(axes: Axes, trajectory: Trajectory) -> None:
    energy = trajectory.energy
    scale = abs(energy[0]) if energy[0] != 0.0 else 1.0
    stride = max(1, len(trajectory) // _POINTS)
    axes.plot(trajectory.t[::stride], ((energy - energy[0]) / scale)[::stride], linewidth=0.8)
    axes.axhline(0.0, color="0.7", linewidth=0.6, zorder=0)
    axes.set(xlabel="t", ylabel="(E − E₀) / |E₀|" if energy[0] != 0.0 else "E − E₀", title="energy")
    axes.margins(x=0.01)
    axes.ticklabel_format(axis="y", style="sci", scilimits=(0, 0))
    if np.ptp(energy) == 0.0:
        axes.set_ylim(-1e-16, 1e-16)


def __dir__() -> list[str]:
    return list(__all__)
