"""Pictures of one run against time: a panel for each number of a column, a line for each body."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._column_axes import COLUMN_AXES, components_of
from visviva._exported import AXES
from visviva._keywords import one_of
from visviva._names import body_indices
from visviva._style import legend_beside
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.plot import LEGEND, POINTS, chosen_bodies, given_axes, new_figure, plot_energy

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.recorded import Recorded
    from visviva.trajectory import Trajectory

__all__ = ["draw_column", "draw_turning", "hold_level", "plot_column", "size_of_column"]

# Changes below this part of the size of a number are none.
_CONSTANT = 1e-10


def plot_column(run: Trajectory, column: object, bodies: object, component: object, ax: Axes | None) -> Figure:
    """As `Trajectory.plot` with a column."""
    name = one_of("column", column, tuple(COLUMN_AXES))
    if not len(run):
        raise InvalidInput("plot", "expected a trajectory with times, got 0 times")
    chosen, names = _chosen(run, name, bodies)
    letters, shown = components_of(name, component)
    panels = max(1, len(shown))
    if ax is not None:
        if panels != 1:
            choices = ", ".join(repr(letter) for letter in letters)
            raise InvalidInput(
                "ax", f"one pair of axes takes one panel, and there are {panels}: say component={choices}"
            )
        axes, figure = [given_axes(ax)], cast("Figure", ax.figure)
    else:
        figure, axes = new_figure(panels, (1.5 + 4.0 * panels, 3.6))
    if name == "energy":
        plot_energy(axes[0], run)
        return figure
    for panel, at in zip(axes, shown or (None,), strict=True):
        draw_column(panel, run, name, chosen, at)
    if names and len(chosen) <= LEGEND:
        legend_beside(axes[-1])
    return figure


def draw_column(axes: Any, run: Trajectory, name: str, bodies: Sequence[int], at: int | None) -> None:
    """One number of a column, of each of these bodies, against time."""
    over = COLUMN_AXES[name]
    stride = max(1, len(run) // POINTS)
    values: NDArray[np.float64] = getattr(run, name)[::stride]
    values = values if at is None else values[..., at]
    names = _names(run, over[0]) if bodies else ()
    lines = values[:, list(bodies)].T if bodies else [values]
    for index, line in enumerate(lines):
        axes.plot(run.t[::stride], line, linewidth=0.8, label=names[bodies[index]] if names else None)
    written = name.replace("_", " ")
    axes.set(xlabel="t", ylabel=written if at is None else f"{written}, {AXES[over[-1]][at]}")
    hold_level(axes, values[:, list(bodies)] if bodies else values, size_of_column(run, name, run.scene.particles.mass))
    axes.margins(x=0.01)
    # Ends of the scale, of so few digits that they do not lie on each other.
    axes.locator_params(axis="x", nbins=6)


def draw_turning(axes: Any, run: Trajectory) -> None:
    """All components of the angular velocities of rigid bodies, along their own axes, against time."""
    stride = max(1, len(run) // POINTS)
    values, names = run.angular_velocity[::stride], _names(run, "rigid_body")
    for body in range(values.shape[1]):
        before = f"{names[body]}, " if names else f"{body}, " if values.shape[1] > 1 else ""
        for at, letter in enumerate(AXES["component"]):
            axes.plot(run.t[::stride], values[:, body, at], linewidth=0.8, label=f"{before}ω{letter}")
    axes.set(xlabel="t", ylabel="ω in the body", title="angular velocity")
    axes.margins(x=0.01)
    if len(axes.lines) <= LEGEND:
        legend_beside(axes)


def hold_level(axes: Axes, values: NDArray[np.float64], size: float) -> None:
    """Draw numbers that stay but for rounding as what stays: rounding would fill the panel, and look like a signal.

    `size` is that of what they are the sum of, which rounds to parts of itself; at least that of the numbers is taken.
    """
    known = values[np.isfinite(values)]
    if known.size:
        middle, scale = float(known.mean()), max(float(np.abs(known).max()), size)
        if np.ptp(known) < _CONSTANT * scale:
            axes.set_ylim(middle - 0.01 * scale, middle + 0.01 * scale)


def size_of_column(run: Recorded, name: str, mass: NDArray[np.float64]) -> float:
    """How large the numbers are that a column is, or is the sum of, with masses of shape (N,), or (B, 1, N)."""
    sizes = [getattr(run, name)]
    far, fast = (
        np.linalg.norm(getattr(run, each), axis=-1) if each in run.recorded else None
        for each in ("position", "velocity")
    )
    if name == "momentum" and fast is not None:
        sizes.append((mass * fast).sum(axis=-1))
    elif name == "angular_momentum" and far is not None and fast is not None:
        sizes.append((mass * far * fast).sum(axis=-1))
    elif name == "center_of_mass" and far is not None:
        sizes.append(far)
    return max(float(np.abs(each[np.isfinite(each)]).max(initial=0.0)) for each in sizes)


def _names(run: Trajectory, over: str) -> tuple[str, ...]:
    things = run.scene.particles if over == "body" else run.scene.rigid_bodies
    return tuple(getattr(things, "names", None) or ())


def _chosen(run: Trajectory, name: str, bodies: object) -> tuple[list[int], tuple[str, ...]]:
    """Which bodies a column is drawn of, none if it is of the whole scene, and the names of all."""
    over = COLUMN_AXES[name][:1]
    if over == ("body",):
        return chosen_bodies("plot", run, bodies), _names(run, "body")
    if over != ("rigid_body",):
        if bodies is not None:
            raise InvalidInput("bodies", f"{name} is that of the whole scene, got bodies={bodies!r}")
        return [], ()
    rigid = run.scene.rigid_bodies
    if rigid is None:
        raise InvalidInput("column", f"{name} is that of rigid bodies, and there is none")
    names, number = _names(run, "rigid_body"), len(rigid)
    chosen = list(range(number)) if bodies is None else body_indices("bodies", bodies, names, number)
    if not chosen:
        raise InvalidInput(
            "bodies", f"expected at least one of {count(number, 'rigid body', 'rigid bodies')}, got none"
        )
    return chosen, names


def __dir__() -> list[str]:
    return list(__all__)
