"""Derivatives of the flow of scenes: what small differences of the start become.

The one idea: each number of the start has a copy of the scene, beside which a difference of that number goes by the
linear equations of the motion; copies go side by side, in lanes and threads.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva import _core
from visviva._accuracy import callers_inside
from visviva._arrays import whole_number
from visviva._expression_table import has_corners
from visviva._mergers import hosts
from visviva._sizes_of_motions import looked_at, sizes_of_motions
from visviva.errors import AccuracyWarning, ConvergenceError, InvalidInput
from visviva.forces import ExpressedForce
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
#: One more difference, of all numbers together, is to become what the others become together, to this part of what
#: they add up to; by more than that derivatives are not known.
_TOLD, _UNKNOWN = 1e-6, 1e-2
#: By less than this part of its size nothing is felt.
_HARDLY = 1e-5
#: Along it each number changes by another part of its size.
_GOLDEN = 0.6180339887498949


def flow_jacobian_of(
    scene: Scene | EnsembleScene, request: FlowRequest, numbers: NDArray[np.intp] | None = None
) -> NDArray[np.float64]:
    """Follow differences of each number of the start, or of some, of a scene or of each copy."""
    from visviva.ensemble import EnsembleScene

    scenes = scene if isinstance(scene, EnsembleScene) else [scene]
    if any(hosts(each.particles) is not None for each in scenes):
        message = "expected bodies by themselves: what has merged has no motion of its own; leave it out"
        raise InvalidInput("scene", message)
    if isinstance(scene, EnsembleScene):
        found, _, off = _followed(scene, request, scene.run, numbers)
        worst = int(np.argmax(off))
        _tell(float(off[worst]), f"in copy {worst}, ")
        return np.where((off > _UNKNOWN).reshape(-1, *[1] * (found.ndim - 1)), np.nan, found)
    copy = scene.ensemble(position=scene.particles.position[None])
    found, status, off = _followed(copy, request, scene.run, numbers)
    if status[0] != Status.OK:
        raise ConvergenceError("the step of a neighbor fell to zero, or it left the range of numbers")
    if off[0] > _UNKNOWN:
        message = f"{_LOST.format(off[0])}: {_CURE}"
        raise ConvergenceError(message)
    _tell(float(off[0]), "")
    matrices: NDArray[np.float64] = found[0]
    return matrices


_LOST = "derivatives of the motion are off by {:.1g} of what they add up to, as one of all numbers together tells"
_CURE = (
    "what neighbors become in between, as in a close encounter, hides them, or, under forces whose derivatives are "
    "differences, rounding far from the origin; take a smaller tolerance, shorter spans, or another origin"
)


def _tell(off: float, whose: str) -> None:
    if off > _TOLD:
        warnings.warn(f"{whose}{_LOST.format(off)}: {_CURE}", AccuracyWarning, stacklevel=callers_inside())


def _followed(
    copies: EnsembleScene,
    request: FlowRequest,
    run: Callable[..., Any],
    numbers: NDArray[np.intp] | None,
) -> tuple[NDArray[np.float64], NDArray[np.int8], NDArray[np.float64]]:
    """Matrices of copies, or of one scene that is run by itself, how each ended, and by how much it is off."""
    begin, bodies = copies.scene.t0, len(copies.scene.particles)
    for force in copies.scene.forces:
        if isinstance(force, ExpressedForce) and has_corners(force.nodes):
            raise InvalidInput(
                "forces",
                "expected formulas without absolute values: where one turns the derivatives of a motion jump, which "
                "linear equations do not tell; compare runs from neighboring starts",
            )
    several = 6 * bodies
    columns = several if numbers is None else len(numbers)
    threads = None if request.threads is None else whole_number("threads", request.threads)
    how: dict[str, Any] = {"method": request.method, "dt": request.dt, "rtol": request.rtol, "threads": threads}
    each = copies[np.repeat(np.arange(len(copies)), columns + 1)]
    asked = RunRequest(t=request.t, **how).to_core(each._keywords, each._names)
    times: NDArray[np.float64] = asked["times"]
    _core.plan(asked)  # refuses times in another order
    sizes, status = np.zeros((len(copies), 2)), np.full(len(copies), Status.OK, np.int8)
    if times.size and times[-1] != begin:
        instants = times if times.size > 1 else np.linspace(begin, times[-1], _INSTANTS)
        motion = looked_at(run, begin, instants[instants != begin], **how)
        sizes, status = sizes_of_motions(copies, motion), np.atleast_1d(motion.status)
    scales = _scales(copies, times[-1] - begin if times.size else 0.0)
    units = np.eye(several) if numbers is None else np.eye(several)[numbers]
    parts = (scales @ units.T) * (0.5 + np.arange(columns) * _GOLDEN % 1.0)
    begun = np.broadcast_to(units, (len(copies), columns, several))
    toward = np.concatenate([begun, (parts @ units)[:, None]], axis=1)
    toward = toward.reshape(-1, 2, bodies, 3).swapaxes(1, 2)
    followed = cast("_core._Request", {**asked, "end_only": False, "times": times})
    found, ended = _core.differences(followed, toward, np.repeat(sizes, columns + 1, axis=0), threads=threads)
    # Of each copy a matrix at each time, whose columns are the numbers of the start, places of all bodies first.
    found = found.swapaxes(2, 3).reshape(len(copies), columns + 1, len(times), several).transpose(0, 2, 3, 1)
    worst = ended.reshape(len(copies), columns + 1).max(axis=1)
    matrices, together = found[..., :-1], found[..., -1]
    # The place of each body, and its velocity, by itself; what hardly feels any of the numbers is no worse for that.
    missed = np.abs(np.einsum("btij,bj->bti", matrices, parts) - together)
    whole = np.maximum(np.einsum("btij,bj->bti", np.abs(matrices), parts), _HARDLY * scales[:, None])
    vectors = [each.reshape(*each.shape[:-1], -1, 3).max(axis=-1) for each in (missed, whole)]
    off = np.nan_to_num(vectors[0] / vectors[1]).max(axis=(1, 2), initial=0.0)
    if asked["end_only"]:
        matrices = matrices[:, -1]
    return np.ascontiguousarray(matrices), np.where(status == Status.OK, worst, status), off


def _scales(copies: EnsembleScene, span: float) -> NDArray[np.float64]:
    """How large each number of a state is, of each copy: how far bodies are from each other, or go, and how fast."""
    place, velocity = copies.position, copies.velocity
    fast = np.abs(velocity).max(axis=(1, 2), initial=0.0)
    far = np.maximum(np.ptp(place, axis=1).max(axis=1), fast * abs(span))
    far = np.where(far > 0.0, far, np.abs(place).max(axis=(1, 2), initial=0.0))
    far = np.where(far > 0.0, far, 1.0)
    fast = np.where(fast > 0.0, fast, far / (abs(span) or 1.0))
    return np.repeat(np.stack([far, fast], axis=1), 3 * len(copies.scene.particles), axis=1)


def __dir__() -> list[str]:
    return list(__all__)
