"""A word of warning where times are too coarse for what a force of one's own makes of them.

The one idea: far from zero the numbers that times are lie apart, and a fast drive changes from one to the next. Forces
of the package count from the start of the run; of an expression nobody knows what it does with its time.
"""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._accuracy import warn_if_coarse
from visviva._expression_table import looks_at_time
from visviva.errors import InvalidInput
from visviva.forces import ExpressedForce

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.scene import Scene

__all__ = ["warn_of_coarse_times"]


def warn_of_coarse_times(scene: Scene, asked: _core._Request) -> None:
    """Warn of a force that changes by more than the tolerance from one time to the next number."""
    span = float(asked["t0"]), float(asked["times"][-1])
    for index, force in enumerate(scene.forces):
        if not isinstance(force, ExpressedForce) or not looks_at_time(force.nodes):
            continue
        with suppress(InvalidInput):  # where it is not known the run itself has said so
            warn_if_coarse(partial(_told, scene, index), span, asked["rtol"], f"forces[{index}] changes")


def _told(scene: Scene, index: int, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the accelerations of one force at the state of the scene and at several times."""
    bodies, force = scene.particles, scene._keywords["forces"][index]
    state: dict[str, Any] = {"mass": bodies.mass, "position": bodies.position, "velocity": bodies.velocity}
    return np.array([_core.acceleration(forces=[force], t0=float(time), **state) for time in times])


def __dir__() -> list[str]:
    return list(__all__)
