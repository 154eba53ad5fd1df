"""Pictures of rigid motions, as matplotlib figures that belong to the caller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import did_you_mean
from visviva._style import VERMILION, legend_beside, legend_within, set_box
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.plot import new_figure
from visviva.rigid._orientation import matrix, rotate

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.body_turning import BodyTurning
    from visviva.rigid._free import FreeRotation
    from visviva.rigid._polhode import Polhode
    from visviva.rigid._top_motion import TopMotion

__all__ = ["plot_free_rotation", "plot_polhode", "plot_top", "polhode", "traces"]

_LETTERS = "xyz"
# More points than this cannot be told apart in a figure and make the file large.
_POINTS = 4000
# Of a separatrix, which takes forever, the part in units of its rate: the ends are within 1e-5 of where it goes.
_FOREVER = 12.0


def plot_free_rotation(motion: FreeRotation | BodyTurning, kind: str, ax: Axes | None) -> Figure:
    """A picture of a free rotation; see `FreeRotation.plot`."""
    known: dict[str, Callable[[Any, Any], None]]
    known = {"polhode": polhode, "herpolhode": herpolhode, "axes": traces, "components": spin}
    return _plotted(motion, kind, known, ax)


def plot_top(motion: TopMotion, kind: str, ax: Axes | None) -> Figure:
    """A picture of the motion of a heavy top; see `TopMotion.plot`."""
    return _plotted(motion, kind, {"nutation": nutation, "theta": theta, "effective_potential": potential}, ax)


def plot_polhode(path: Polhode, ax: Axes | None) -> Figure:
    """A picture of a polhode as a whole; see `Polhode.plot`."""
    from visviva.rigid._free import free_rotation

    if np.isfinite(path.period):
        t = np.linspace(0.0, path.period, 721)
    else:
        t = np.linspace(-_FOREVER, _FOREVER, 721) / (path.rate if path.kind == "separatrix" else 1.0)
    whole = free_rotation(path.moments, path.angular_velocity, t)
    figure = _plotted(whole, "polhode", {"polhode": polhode}, ax)
    axes: Any = figure.axes[-1] if ax is None else ax
    for line in _separatrices(path.moments):
        axes.plot(*line, linewidth=0.8, linestyle="-", color="0.4", zorder=1)
    return figure


_SOLID = ("polhode", "axes", "nutation")


def _plotted(motion: Any, kind: str, pictures: dict[str, Callable[[Any, Any], None]], ax: Any) -> Figure:
    if not isinstance(kind, str) or kind not in pictures:
        hint = did_you_mean(str(kind), tuple(pictures))
        expected = ", ".join(repr(name) for name in pictures)
        raise InvalidInput("kind", f"expected one of {expected}, got {kind!r}{hint}")
    if motion.t.ndim != 1 or len(motion.t) < 2:
        raise InvalidInput("plot", f"expected a path along several times, got {count(motion.t.size, 'time')}")
    solid = kind in _SOLID
    if ax is None:
        _, (ax,) = new_figure(1, (5.5, 5.0), solid=(0,) if solid else ())
    elif not hasattr(ax, "plot") or solid is not hasattr(ax, "get_zlim"):
        wanted = "three" if solid else "two"
        raise InvalidInput("ax", f"expected axes of {wanted} dimensions for kind={kind!r}, got {ax!r}")
    pictures[kind](ax, motion)
    figure: Figure = ax.figure
    return figure


def _thinned(motion: Any) -> NDArray[np.intp]:
    """Some of the times, in order."""
    return np.argsort(motion.t, kind="stable")[:: max(1, len(motion.t) // _POINTS)]


def polhode(axes: Any, motion: FreeRotation | BodyTurning) -> None:
    """The path of the angular velocity on the inertia ellipsoid Σ I x² = 1, as the body has it."""
    if not np.all(motion.moments > 0.0):
        raise InvalidInput("plot", "expected three moments above 0: the inertia ellipsoid of a rod has no end")
    direction = _directions(motion.angular_velocity[_thinned(motion)])
    path = direction / np.sqrt((motion.moments * direction**2).sum(axis=-1))[:, None]
    half = 1.0 / np.sqrt(motion.moments)
    _ellipsoid(axes, half)
    axes.plot(*path.T, linewidth=1.4, color=VERMILION)
    axes.plot(*path[:1].T, "o", markersize=4, color=VERMILION)
    set_box(axes, half)
    axes.set(**{f"{letter}label": f"ω{letter} / √2T" for letter in _LETTERS}, title="polhode")


def _separatrices(moments: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """The two ellipses Σ I x² = 1, Σ I² x² = I₂ that go through the middle axis; none of a symmetric body."""
    order = np.argsort(moments)
    low, middle, high = moments[order]
    if not 0.0 < low < middle < high:
        return []
    slope = np.sqrt(low * (middle - low) / (high * (high - middle)))
    along, around = 1.0 / np.sqrt(low + high * slope**2), np.linspace(0.0, 2.0 * np.pi, 361)
    found = []
    for side in (slope, -slope):
        line = np.empty((3, around.size))
        line[order] = along * np.cos(around), np.sin(around) / np.sqrt(middle), side * along * np.cos(around)
        found.append(line)
    return found


def herpolhode(axes: Any, motion: FreeRotation | BodyTurning) -> None:
    """The path of the angular velocity on the plane across the angular momentum, which stays where it is in space."""
    momentum = motion.angular_momentum[0]
    _directions(momentum[None])
    first, second = _across(momentum)
    velocity = rotate(motion.orientation, motion.angular_velocity)[_thinned(motion)]
    axes.plot(velocity @ first, velocity @ second, linewidth=0.8, color=VERMILION)
    axes.plot(velocity[0] @ first, velocity[0] @ second, "o", markersize=4, color=VERMILION)
    axes.plot(0.0, 0.0, "+", color="0.4")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel="ω across L", ylabel="ω across L", title="herpolhode")


def traces(axes: Any, motion: FreeRotation | BodyTurning) -> None:
    """Where the body's three axes point in space, on the unit sphere, and the angular momentum."""
    columns = matrix(motion.orientation)[_thinned(motion)]
    _ellipsoid(axes, np.ones(3))
    for at, letter in enumerate(_LETTERS):
        axes.plot(*columns[:, :, at].T, linewidth=0.8, label=letter)
    along = 1.2 * _directions(motion.angular_momentum[:1])[0]
    axes.plot(*np.array([np.zeros(3), along]).T, color="0.2", label="L")
    set_box(axes, np.ones(3))
    axes.set(xlabel="x", ylabel="y", zlabel="z", title="the body's axes in space")
    legend_beside(axes)


def spin(axes: Any, motion: FreeRotation | BodyTurning) -> None:
    """The angular velocity along the body's axes against time."""
    chosen = _thinned(motion)
    for at, letter in enumerate(_LETTERS):
        axes.plot(motion.t[chosen], motion.angular_velocity[chosen, at], linewidth=0.8, label=f"ω{letter}")
    axes.set(xlabel="t", ylabel="ω in the body", title="angular velocity")
    axes.margins(x=0.01)
    legend_beside(axes)


def nutation(axes: Any, motion: TopMotion) -> None:
    """Where the top's axis points, on the unit sphere, between the circles that it nods between."""
    low, high = _nods_between(motion)
    _ellipsoid(axes, np.ones(3))
    around = np.linspace(0.0, 2.0 * np.pi, 200)
    for angle in (low, high):
        height = np.full_like(around, np.cos(angle))
        axes.plot(np.sin(angle) * np.cos(around), np.sin(angle) * np.sin(around), height, linewidth=0.6, color="0.4")
    path = motion.axis[_thinned(motion)]
    axes.plot(*path.T, linewidth=1.2, color=VERMILION)
    axes.plot(*path[:1].T, "o", markersize=4, color=VERMILION)
    set_box(axes, np.ones(3))
    axes.set(xlabel="x", ylabel="y", zlabel="z", title="nutation")


def theta(axes: Any, motion: TopMotion) -> None:
    """The angle of the axis from the vertical against time."""
    chosen = _thinned(motion)
    axes.plot(motion.t[chosen], motion.theta[chosen], linewidth=0.8)
    axes.set(xlabel="t", ylabel="θ", title="angle from the vertical")
    axes.margins(x=0.01)


def potential(axes: Any, motion: TopMotion) -> None:
    """The effective potential about the angles that the axis nods between, and the energy."""
    low, high = _nods_between(motion)
    first = np.argmin(np.abs(motion.theta - 0.5 * np.pi))  # where both momenta keep their digits best
    p_phi, p_psi = motion.top.momenta(
        float(motion.theta[first]), psi_dot=float(motion.psi_dot[first]), phi_dot=float(motion.phi_dot[first])
    )
    margin = 0.3 * max(high - low, 0.05)
    angles = np.linspace(max(low - margin, 1e-3), min(high + margin, np.pi - 1e-3), 400)
    values = motion.top.effective_potential(angles, p_phi=p_phi, p_psi=p_psi)
    own = motion.top.effective_potential(motion.theta[first], p_phi=p_phi, p_psi=p_psi)
    energy = float(0.5 * motion.top.A * motion.theta_dot[first] ** 2 + own)
    least = float(values.min())
    height = max(energy - least, 1e-3 * abs(energy), np.finfo(float).tiny)
    # Its walls go no higher than is shown, so that there is room for names above.
    values[values > energy + 1.5 * height] = np.nan
    axes.plot(angles, values, linewidth=1.0, label="effective potential")
    axes.plot([low, high], [energy, energy], linewidth=1.2, color=VERMILION, label="energy less that of the spin")
    axes.set_ylim(least - 0.3 * height, energy + 1.5 * height)
    axes.set(xlabel="θ", ylabel="V", title="effective potential")
    axes.margins(x=0.01)
    legend_within(axes)


def _nods_between(motion: TopMotion) -> tuple[float, float]:
    return motion.top.nutation_range(
        float(motion.theta[0]),
        psi_dot=float(motion.psi_dot[0]),
        theta_dot=float(motion.theta_dot[0]),
        phi_dot=float(motion.phi_dot[0]),
    )


def _directions(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit vectors of vectors of any size."""
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    if not np.all(largest > 0.0):
        raise InvalidInput("plot", "expected a body that turns, got one at rest")
    scaled = vectors / largest
    unit: NDArray[np.float64] = scaled / np.linalg.norm(scaled, axis=-1, keepdims=True)
    return unit


def _across(along: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two unit vectors that stand at right angles on a third, and on each other."""
    unit = _directions(along[None])[0]
    other = np.eye(3)[np.argmin(np.abs(unit))]
    first = _directions(np.cross(other, unit)[None])[0]
    return first, np.cross(unit, first)


def _ellipsoid(axes: Any, half: NDArray[np.float64]) -> None:
    """A transparent ellipsoid."""
    around, down = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 49), np.linspace(0.0, np.pi, 25))
    x, y, z = np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)
    axes.plot_surface(half[0] * x, half[1] * y, half[2] * z, color="0.8", alpha=0.25, linewidth=0.0)
