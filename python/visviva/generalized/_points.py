"""Where the points of a system are: what its moving pictures show.

The one idea: coordinates go as arrays over time through one function, so nothing is derived, and points are as exact as
coordinates.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from visviva._animation import Places, animate_places
from visviva.errors import InvalidInput
from visviva.generalized._system import GeneralizedSystem
from visviva.plot import directions

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from numpy.typing import NDArray

    from visviva.generalized._trajectory import GeneralizedTrajectory

__all__ = ["animate", "with_points"]

_System = TypeVar("_System", bound=GeneralizedSystem)


def with_points(system: _System, points: Callable[..., Any]) -> _System:
    """A system that was just made, and now knows its points; a function of a module, so that it can be pickled."""
    object.__setattr__(system, "_source", replace(system._source, points=points))
    return system


def animate(
    trajectory: GeneralizedTrajectory, path: Any, points: Any, plane: str | None, how: dict[str, Any]
) -> FuncAnimation:
    """As `GeneralizedTrajectory.animate`."""
    system = trajectory.system
    if points is None:
        points = system._source.points
        if points is None:
            raise InvalidInput(
                "points",
                f"the points of the coordinates {list(system.coordinates)} are not known; give "
                "points=lambda q, t, **parameters: [(x, y), …]",
            )
    if not callable(points):
        raise InvalidInput("points", f"expected a function of (q, t, **parameters), got {type(points).__name__}")
    if not len(trajectory):
        raise InvalidInput("animate", "expected a trajectory with times, got 0 times")
    position, solid = _positions(trajectory, points)
    shown = directions(position, ("xyz" if solid else "xy") if plane is None else plane)
    return animate_places(Places(trajectory.t, position, lines=position), path, shown=shown, **how)


def _positions(trajectory: GeneralizedTrajectory, points: Callable[..., Any]) -> tuple[NDArray[np.float64], bool]:
    """Points over time, shape (T, P, 3), and whether they have a third number."""
    t = trajectory.t
    try:
        given = points(trajectory.position.T, t, **trajectory.system.parameters)
    except TypeError as error:
        raise InvalidInput("points", f"the call points(q, t, **parameters) failed: {error}") from error
    listed = [list(each) for each in given if isinstance(each, Iterable)] if isinstance(given, Iterable) else []
    sizes = {len(each) for each in listed}
    if len(sizes) != 1 or not sizes <= {2, 3} or len(listed) != len(given):
        raise InvalidInput("points", f"expected points of two numbers each, or of three, got {given!r:.200}")
    position = np.zeros((len(t), len(listed), 3))
    for at, each in enumerate(listed):
        for direction, values in enumerate(each):
            try:
                position[:, at, direction] = values
            except (TypeError, ValueError):
                raise InvalidInput(
                    "points", f"expected numbers, or arrays of {len(t)} times, in point {at}, got {values!r:.200}"
                ) from None
    if not np.isfinite(position).all():
        at = int(np.argmin(np.isfinite(position).all(axis=(0, 2))))
        raise InvalidInput("points", f"point {at} is not finite at all times")
    return position, sizes == {3}
