"""A word of warning where times are too coarse for what a force of one's own makes of them.

The one idea: far from zero the numbers that times are lie apart, and a fast drive changes from one to the next. Forces
of the package count from the start of the run; of an expression nobody knows what it does with its time.
"""

from __future__ import annotations

import warnings
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._accuracy import callers_inside
from visviva._expression_table import looks_at_time
from visviva.errors import AccuracyWarning, InvalidInput
from visviva.forces import ExpressedForce

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.scene import Scene

__all__ = ["warn_if_coarse", "warn_of_coarse_times"]

_TRIED = 17
"""Times of the run at which forces are asked."""
_BESIDE = (1, -1, 2, 3)
"""Numbers beside them: phases at neighbors may round to the same number."""


def warn_of_coarse_times(scene: Scene, asked: _core._Request) -> None:
    """Warn of a force that changes by more than the tolerance from one time to the next number."""
    span = float(asked["t0"]), float(asked["times"][-1])
    for index, force in enumerate(scene.forces):
        if not isinstance(force, ExpressedForce) or not looks_at_time(force.nodes):
            continue
        with suppress(InvalidInput):  # where it is not known the run itself has said so
            warn_if_coarse(partial(_told, scene, index), span, asked["rtol"], f"forces[{index}] changes")


def warn_if_coarse(
    told: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    span: tuple[float, float],
    rtol: float,
    what: str,
    *,
    alike: bool = True,
) -> None:
    """Warn where what is told of times (T,), in rows, changes by more than the tolerance from one to the next number.

    What is not alike, in units of its own each, is measured by itself.
    """
    times = np.linspace(*span, _TRIED)
    apart = float(np.spacing(np.abs(times).max()))
    here, *beside = (told(times + off * apart) for off in (0, *_BESIDE))
    with np.errstate(all="ignore"):
        sizes = np.abs(here).max(axis=None if alike else 0)
        shares = [np.abs(there - here) / (abs(off) * sizes) for off, there in zip(_BESIDE, beside, strict=True)]
    change = float(np.nanmax(np.where(sizes > 0.0, shares, 0.0)))
    if change > rtol:
        message = (
            f"times near {times[-1]:g} are numbers {apart:.2g} apart, and from one to the next {what} "
            f"by {change:.2g} of itself: no method errs by less; count time from the start of the run, "
            "with t0 = 0, and put what has gone before into a phase"
        )
        warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def _told(scene: Scene, index: int, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the accelerations of one force at the state of the scene and at several times."""
    bodies, force = scene.particles, scene._keywords["forces"][index]
    state: dict[str, Any] = {"mass": bodies.mass, "position": bodies.position, "velocity": bodies.velocity}
    return np.array([_core.acceleration(forces=[force], t0=float(time), **state) for time in times])


def __dir__() -> list[str]:
    return list(__all__)
