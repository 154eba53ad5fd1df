"""Pictures of runs, as matplotlib figures that belong to the caller (pyplot's state is never touched)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._keywords import did_you_mean
from visviva._names import body_indices
from visviva._packages import needed
from visviva._style import FRAME, legend_beside, set_box, style_axes
from visviva._text import count
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.trajectory import Trajectory

__all__ = [
    "LEGEND",
    "PLANES",
    "POINTS",
    "axes_or_new",
    "chosen_bodies",
    "directions",
    "given_axes",
    "is_noise",
    "mark_round_off",
    "new_figure",
    "plot_energy",
    "plot_trajectory",
    "set_ends",
    "sizes_of_terms",
]

PLANES = ("xy", "xz", "yz", "xyz")
"""What a picture of places shows."""
POINTS = 4000
"""More points than this cannot be told apart in a figure and make the file large."""
LEGEND = 24
"""A legend of more names would hide the picture."""
# So few outputs are places, and no path.
_A_PATH = 10
# Extents below this part of the places are rounding.
_LINE = 1e-13
# What turns at more than this part of its points is no line.
_TURNING = 0.25
# A relative change of the energy below this is the rounding of its terms, and no drift.
_ROUND_OFF = 16.0 * float(np.finfo(float).eps)


def new_figure(panels: int, size: tuple[float, float], solid: Collection[int] = ()) -> tuple[Figure, list[Axes]]:
    """A figure with a row of panels, of which some show three dimensions.

    Raises
    ------
    visviva.InvalidInput
        If matplotlib is not installed.
    """
    figure: Figure = needed("matplotlib.figure", "plot", "plot").Figure(figsize=size, layout="constrained")
    axes = []
    for panel in range(panels):
        kind = "3d" if panel in solid else "rectilinear"
        axes.append(figure.add_subplot(1, panels, panel + 1, projection=kind))
        style_axes(axes[-1])
    return figure, axes


def axes_or_new(axes: Axes | None) -> Axes:
    """The axes that were given, or those of a new figure.

    Raises
    ------
    visviva.InvalidInput
        If there are none and matplotlib is not installed; for what are no axes.
    """
    if axes is None:
        return new_figure(1, (5.5, 4.0))[1][0]
    return given_axes(axes)


def given_axes(axes: Any) -> Axes:
    """The axes that were given.

    Raises
    ------
    visviva.InvalidInput
        For what are none.
    """
    if not hasattr(axes, "plot"):
        raise InvalidInput("ax", f"expected axes of matplotlib, as of plt.subplots(), or None, got {axes!r}")
    given: Axes = axes
    return given


def plot_trajectory(trajectory: Trajectory, bodies: object, plane: str | None, ax: Axes | None) -> Figure:
    """Orbits and, in a figure of its own and if it is known, the relative change of the energy.

    Of motions along one line, which is no picture, places against time instead; where bodies turn and none goes
    anywhere, which is a dot, their angular velocities.
    """
    chosen, shown = chosen_bodies("plot", trajectory, bodies), directions(trajectory.position, plane)
    with_energy = "energy" in trajectory.recorded or {"position", "velocity"} <= set(trajectory.recorded)
    solid = len(shown) == 3
    if ax is not None:
        if not hasattr(ax, "plot") or solid is not hasattr(ax, "get_zlim"):
            wanted = "three" if solid else "two"
            raise InvalidInput("ax", f"expected axes of {wanted} dimensions for plane={plane!r}, got {ax!r}")
        _orbits(ax, trajectory, chosen, shown)
        return cast("Figure", ax.figure)
    line = _line(trajectory, chosen) if plane is None else None
    figure, axes = new_figure(2 if with_energy else 1, (11.0 if with_energy else 5.5, 5.0), solid=(0,) if solid else ())
    from visviva._plot_columns import draw_column, draw_turning

    if bodies is None and plane is None and _turns_only(trajectory):
        draw_turning(axes[0], trajectory)
    elif line is None:
        _orbits(axes[0], trajectory, chosen, shown)
    else:
        draw_column(axes[0], trajectory, "position", chosen, line)
        if trajectory.scene.particles.names and len(chosen) <= LEGEND:
            legend_beside(axes[0])
    if with_energy:
        plot_energy(axes[1], trajectory)
    return figure


def _line(trajectory: Trajectory, bodies: list[int]) -> int | None:
    """The direction of the one line along an axis that all stay on; None of few times, which are places."""
    if len(trajectory) < _A_PATH:
        return None
    places = trajectory.position[:, bodies].reshape(-1, 3)
    extent = np.ptp(places, axis=0)
    # Rounding of the places, and of what moves along.
    across = extent <= _LINE * np.maximum(np.abs(places).max(axis=0), extent.max())
    along = np.flatnonzero(~across)
    return int(along[0]) if len(along) == 1 else None


def _turns_only(trajectory: Trajectory) -> bool:
    """Whether there are bodies that turn, and no body goes anywhere, but for rounding."""
    if len(trajectory) < _A_PATH or "angular_velocity" not in trajectory.recorded:
        return False
    still = np.ptp(trajectory.position, axis=0) <= _LINE * np.abs(trajectory.position).max(initial=0.0)
    return bool(still.all() and trajectory.angular_velocity.any())


def chosen_bodies(what: str, trajectory: Trajectory, bodies: object) -> list[int]:
    """The bodies of a picture: all of them, or those that were asked for.

    Raises
    ------
    visviva.InvalidInput
        If there is nothing to draw, or a body is not there.
    """
    particles = trajectory.scene.particles
    if not particles or not len(trajectory):
        raise InvalidInput(
            what,
            "expected a trajectory with bodies and times, got "
            f"{count(len(particles), 'body', 'bodies')} and {count(len(trajectory), 'time')}",
        )
    if bodies is None:
        return list(range(len(particles)))
    chosen = body_indices("bodies", bodies, particles.names, len(particles))
    if not chosen:
        raise InvalidInput("bodies", "expected at least one body, got none")
    return chosen


def directions(position: NDArray[np.float64], plane: object) -> Sequence[int]:
    """The directions of space that are drawn: those of a plane, or the two of largest extent.

    Raises
    ------
    visviva.InvalidInput
        For a plane that there is not.
    """
    if plane is None:
        extent = np.ptp(position.reshape(-1, 3), axis=0)
        return sorted(np.argsort(-extent, kind="stable")[:2].tolist())
    if not isinstance(plane, str) or plane not in PLANES:
        near = did_you_mean(plane, PLANES) if isinstance(plane, str) else ""
        raise InvalidInput("plane", f"expected one of {', '.join(PLANES)}, or None, got {plane!r}{near}")
    return ["xyz".index(letter) for letter in str(plane)]


def _orbits(axes: Any, trajectory: Trajectory, bodies: list[int], shown: Sequence[int]) -> None:
    names = trajectory.scene.particles.names
    stride = max(1, len(trajectory) // POINTS)
    position: NDArray[np.float64] = trajectory.position[::stride][..., shown]
    for body in bodies:
        label = names[body] if names else None
        # Of a few places nobody knows the way between: a line would draw chords as an orbit.
        look = {"marker": ".", "linestyle": "none"} if len(trajectory) < _A_PATH else {}
        (line,) = axes.plot(*position[:, body].T, linewidth=0.8, label=label, **look)
        axes.plot(*trajectory.position[-1:, body, shown].T, "o", markersize=4, color=line.get_color())
    if len(shown) == 3:
        # All that is drawn: by themselves, axes give what is flat a height of 0.1, however small the rest is.
        drawn = np.array([axes.xy_dataLim.intervalx, axes.xy_dataLim.intervaly, axes.zz_dataLim.intervalx])
        set_ends(axes, drawn.min(axis=1), drawn.max(axis=1))
    label_places(axes, shown)
    axes.set_title("orbits")
    if names and len(bodies) <= LEGEND:
        # Orbits may be anywhere within.
        legend_beside(axes)


def set_ends(axes: Any, low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
    """Show what is between two corners, with room about what moves, and some where nothing does."""
    size = max(float(np.abs(low).max()), float(np.abs(high).max()))
    room = 0.05 * max(float((high - low).max()), 1e-12 * size, float(np.finfo(float).tiny))
    for axis, least, greatest in zip("xyz", low, high, strict=False):
        getattr(axes, f"set_{axis}lim")(least - room, greatest + room)


def label_places(axes: Any, shown: Sequence[int]) -> None:
    """Name the axes of places, whose scales are one."""
    axes.set(**{f"{axis}label": "xyz"[direction] for axis, direction in zip("xyz", shown, strict=False)})
    if len(shown) == 3:
        # Something flat is given a height in which its numbers can be read.
        ends = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
        middle, half = ends.mean(axis=1), np.ptp(ends, axis=1) / 2.0
        half = np.maximum(half, 0.4 * half.max())
        axes.set(**{f"{axis}lim": (at - off, at + off) for axis, at, off in zip("xyz", middle, half, strict=True)})
        set_box(axes, half)
    else:
        axes.set_aspect("equal", adjustable="datalim")


def mark_round_off(axes: Axes, change: NDArray[np.float64], terms: float | NDArray[np.float64] = 1.0) -> bool:
    """Whether relative changes of an energy are no more than rounding; axes then say so. NaN is no change.

    `terms` is how many times as large as the energy the kinetic and potential energies are that it is the sum of, of
    each copy where there are several.
    """
    rounding = np.atleast_1d(_ROUND_OFF * terms)
    if not np.nanmax(np.abs(change) / rounding[:, None]) <= 1.0:
        return False
    widest = float(rounding.max())
    axes.set_ylim(-2.0 * widest, 2.0 * widest)
    axes.axhspan(-widest, widest, color="0.95", zorder=-1)
    # At the foot of the band, where no legend comes.
    axes.annotate("round-off", (0.02, -widest), xycoords=("axes fraction", "data"), va="bottom", color="0.4")
    return True


def sizes_of_terms(kinetic: NDArray[np.float64], energy: NDArray[np.float64]) -> NDArray[np.float64]:
    """How many times as large as an energy, (…, T), kinetic and potential energies are that it is the sum of, (…)."""
    with np.errstate(all="ignore"):
        terms = np.fmax.reduce(kinetic + np.abs(energy - kinetic), axis=-1) / np.abs(energy[..., 0])
    return np.where(np.isfinite(terms), np.maximum(terms, 1.0), 1.0)


def is_noise(change: NDArray[np.float64]) -> bool:
    """Whether numbers along the last axis turn so often that lines through them would be bands."""
    steps = np.diff(change)
    return steps.shape[-1] > 2 and bool(np.mean(steps[..., 1:] * steps[..., :-1] < 0.0) > _TURNING)


def plot_energy(axes: Axes, trajectory: Trajectory) -> None:
    """The relative change of the energy against time; where it is rounding, as points in a band."""
    energy = trajectory.energy
    scale = abs(energy[0]) if energy[0] != 0.0 else 1.0
    stride = max(1, len(trajectory) // POINTS)
    t, change = trajectory.t[::stride], ((energy - energy[0]) / scale)[::stride]
    axes.set(xlabel="t", ylabel="(E − E₀) / |E₀|" if energy[0] != 0.0 else "E − E₀", title="energy")
    terms = 1.0
    if "velocity" in trajectory.recorded and trajectory.scene.particles:
        squares = (trajectory.velocity**2).sum(axis=-1)
        terms = float(sizes_of_terms(0.5 * squares @ trajectory.scene.particles.mass, energy))
    rounded = energy[0] != 0.0 and mark_round_off(axes, (energy - energy[0]) / scale, terms)
    if rounded or is_noise(change):
        # Points, since a line would draw noise as a signal.
        axes.plot(t, change, ".", markersize=2)
    else:
        axes.plot(t, change, linewidth=0.8)
    axes.axhline(0.0, color=FRAME, linewidth=0.6, zorder=0)
    axes.margins(x=0.01)
    axes.ticklabel_format(axis="y", style="sci", scilimits=(0, 0))
    if np.ptp(energy) == 0.0 and energy[0] == 0.0:
        axes.set_ylim(-1e-16, 1e-16)


def __dir__() -> list[str]:
    return list(__all__)
