"""Derivatives of the flow of scenes: what small differences of the start become.

The one idea: each number of the start has a copy of the scene, beside which a difference of that number goes by the
linear equations of the motion; copies go side by side, in lanes and threads.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva import _core
from visviva._arrays import whole_number
from visviva._mergers import hosts
from visviva._sizes_of_motions import looked_at, sizes_of_motions
from visviva.errors import ConvergenceError, InvalidInput
from visviva.request import RunRequest
from visviva.status import Status

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.ensemble import EnsembleScene
    from visviva.request import FlowRequest
    from visviva.scene import Scene

__all__ = ["flow_jacobian_of"]

#: Instants at which the motion is looked at, if one end is asked for.
_INSTANTS = 65


def flow_jacobian_of(
    scene: Scene | EnsembleScene, request: FlowRequest, numbers: NDArray[np.intp] | None = None
) -> NDArray[np.float64]:
    """Follow differences of each number of the start, or of some, of a scene or of each copy."""
    from visviva.ensemble import EnsembleScene

    if isinstance(scene, EnsembleScene):
        return _followed(scene, request, scene.run, numbers)[0]
    if hosts(scene.particles) is not None:
        message = "expected bodies by themselves: what has merged has no motion of its own; leave it out"
        raise InvalidInput("scene", message)
    copy = scene.ensemble(position=scene.particles.position[None])
    found, status = _followed(copy, request, scene.run, numbers)
    if status[0] != Status.OK:
        raise ConvergenceError("the step of a neighbor fell to zero, or it left the range of numbers")
    matrices: NDArray[np.float64] = found[0]
    return matrices


def _followed(
    copies: EnsembleScene,
    request: FlowRequest,
    run: Callable[..., Any],
    numbers: NDArray[np.intp] | None,
) -> tuple[NDArray[np.float64], NDArray[np.int8]]:
    """Matrices of copies, or of one scene that is run by itself, and how each ended."""
    begin, bodies = copies.scene.t0, len(copies.scene.particles)
    several = 6 * bodies
    columns = several if numbers is None else len(numbers)
    threads = None if request.threads is None else whole_number("threads", request.threads)
    how: dict[str, Any] = {"method": request.method, "dt": request.dt, "rtol": request.rtol, "threads": threads}
    each = copies[np.repeat(np.arange(len(copies)), columns)]
    asked = RunRequest(t=request.t, **how).to_core(each._keywords, each._names)
    times: NDArray[np.float64] = asked["times"]
    _core.plan(asked)  # refuses times in another order
    sizes, status = np.zeros((len(copies), 2)), np.full(len(copies), Status.OK, np.int8)
    if times.size and times[-1] != begin:
        instants = times if times.size > 1 else np.linspace(begin, times[-1], _INSTANTS)
        motion = looked_at(run, begin, instants[instants != begin], **how)
        sizes, status = sizes_of_motions(copies, motion), np.atleast_1d(motion.status)
    units = np.eye(several) if numbers is None else np.eye(several)[numbers]
    toward = units.reshape(columns, 2, bodies, 3).swapaxes(1, 2)
    toward = np.broadcast_to(toward, (len(copies), *toward.shape)).reshape(-1, bodies, 2, 3)
    followed = cast("_core._Request", {**asked, "end_only": False, "times": times})
    found, ended = _core.differences(followed, toward, np.repeat(sizes, columns, axis=0), threads=threads)
    # Of each copy a matrix at each time, whose columns are the numbers of the start, places of all bodies first.
    matrices = found.swapaxes(2, 3).reshape(len(copies), columns, len(times), several).transpose(0, 2, 3, 1)
    worst = ended.reshape(len(copies), columns).max(axis=1)
    if asked["end_only"]:
        matrices = matrices[:, -1]
    return np.ascontiguousarray(matrices), np.where(status == Status.OK, worst, status)


def __dir__() -> list[str]:
    return list(__all__)
