"""Copies of a system in generalized coordinates that other processes and machines run, as `visviva._copies_apart` does.

The one idea: the equations go out as the core has them, with starts and parameters of some copies; each copy has the
bits that it has alone.
"""

from __future__ import annotations

from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import whole_number
from visviva._copies_apart import bounds_of, gathered, sendable
from visviva._executors import checked_executor
from visviva.errors import Interrupted, InvalidInput
from visviva.generalized._ensemble_trajectory import GeneralizedEnsembleTrajectory

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._ensemble import GeneralizedEnsemble
    from visviva.typing import Progress

__all__ = ["run_apart", "run_part"]


def run_part(
    description: dict[str, Any],
    asked: dict[str, Any],
    states: NDArray[np.float64],
    parameters: NDArray[np.float64],
    threads: int,
) -> dict[str, Any]:
    """Run some of the copies: what a worker does."""
    return _core.GeneralizedModel(description).run(asked, states, parameters, threads, None)


def run_apart(
    ensemble: GeneralizedEnsemble, asked: dict[str, Any], executor: Any, threads: int | None, progress: Progress
) -> dict[str, Any] | None:
    """What the core gives of all copies, run by an executor; None if a worker refuses some, which the run here names.

    Raises
    ------
    visviva.InvalidInput
        For what is no executor, and for events that are functions, before anything is sent.
    visviva.Interrupted
        After Ctrl-C; its ``.trajectory`` has the copies before the first that is not home, or is None.
    """
    checked_executor(executor)
    own = 1 if threads is None else whole_number("threads", threads, 1, 1024)
    sendable(asked["events"], lambda event: event["function"] is not None)
    # What was looked for is told of the whole, and may be of SymPy, which a worker need not have.
    sent = {name: value for name, value in asked.items() if name != "looked_for"}
    description, bounds = ensemble.system._source.description, bounds_of(len(ensemble))
    calls = [
        (description, sent, ensemble._states[start:end], ensemble._parameters[start:end], own)
        for start, end in pairwise(bounds)
    ]
    try:
        home, message = gathered(executor, run_part, calls, bounds, progress)
    except InvalidInput:
        return None
    if message:
        reached = ensemble[: bounds[len(home)]] if home else None
        done = None if reached is None else GeneralizedEnsembleTrajectory(reached, _joined(home), asked)
        raise Interrupted(message, done)
    return _joined(home)


def _joined(parts: list[dict[str, Any]]) -> dict[str, Any]:
    """The result of all copies: whatever it has is of one copy after the other."""
    result: dict[str, Any] = {"interrupted": False}
    for name in parts[0]:
        if name in result:
            continue
        each = [part[name] for part in parts]
        result[name] = np.concatenate(each) if isinstance(each[0], np.ndarray) else list(chain.from_iterable(each))
    return result
