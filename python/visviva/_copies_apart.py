"""An ensemble that other processes and machines run: parts of its copies go out, their results are joined.

The one idea: a copy has the bits that it has alone, so that parts only have to be laid one after the other. What is not
of one copy (the plan, what was looked for) is made here, of the whole.
"""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, cast

from visviva import _core
from visviva._arrays import whole_number
from visviva._event_descriptions import from_description
from visviva._executors import checked_executor, results_in_order
from visviva._joined_copies import joined_copies
from visviva._progress import callback
from visviva.errors import Interrupted, InvalidInput
from visviva.request import execute, finished

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from visviva.ensemble import EnsembleScene
    from visviva.ensemble_trajectory import EnsembleTrajectory
    from visviva.request import RunRequest
    from visviva.typing import ColumnName, Progress

__all__ = ["bounds_of", "gathered", "run_apart", "run_part", "sendable"]

# Parts in all, and copies that go side by side through the lanes.
_MOST, _LANES = 64, 8


def bounds_of(number: int) -> list[int]:
    """Where the parts of so many copies begin and end: lanes are full but for the last."""
    parts = max(1, min(_MOST, number // _LANES))
    return [number * part // parts // _LANES * _LANES for part in range(parts)] + [number]


def gathered(
    executor: Any, work: Callable[..., Any], calls: list[tuple[Any, ...]], bounds: list[int], progress: Progress
) -> tuple[list[dict[str, Any]], str]:
    """What parts of the copies gave, in order and without a gap; and after Ctrl-C, what is to be said of that.

    Raises
    ------
    visviva.InvalidInput
        Whatever a worker refuses, by the number of a copy in its part.
    """
    home: list[dict[str, Any]] = []
    with callback(progress, "copies") as report:
        try:
            with closing(results_in_order(executor, work, calls)) as coming:
                for came, end in zip(coming, bounds[1:], strict=True):
                    home.append(came)
                    if report is not None:
                        report(end, bounds[-1])
        except KeyboardInterrupt:
            return home, f"interrupted after {bounds[len(home)]} of {bounds[-1]} copies"
    return home, ""


def sendable(events: Sequence[dict[str, Any]], of_python: Callable[[dict[str, Any]], bool]) -> None:
    """Refuse events that no other process has.

    Raises
    ------
    visviva.InvalidInput
        For functions of one's own.
    """
    if any(map(of_python, events)):
        raise InvalidInput(
            "executor", "events that are functions of your own cannot be sent; use those of visviva.events, or run here"
        )


def run_part(copies: EnsembleScene, request: RunRequest) -> dict[str, Any]:
    """Run some of the copies: what a worker does."""
    asked = request.to_core(copies._keywords, copies._names)
    result = _core.run(asked, threads=request.threads or 1, progress=None, ensemble=True)
    # The plan is told of the whole.
    return {name: value for name, value in result.items() if name != "plan"}


def run_apart(ensemble: EnsembleScene, request: RunRequest) -> EnsembleTrajectory:
    """Run an ensemble by ``request.executor``.

    Raises
    ------
    visviva.InvalidInput
        As a run without one, before anything is sent; and for events that are functions.
    visviva.Interrupted
        After Ctrl-C; its ``.trajectory`` has the copies before the first that is not home, or is None.
    """
    executor = checked_executor(request.executor)
    alone = replace(request, executor=None, progress=False)
    if request.threads is not None:
        whole_number("threads", request.threads, 1, 1024)
    asked = alone.to_core(ensemble._keywords, ensemble._names)
    sendable(asked["events"], lambda event: event["kind"] == "function")
    # Expressions go as what was made of them: their functions may be of this process alone.
    events = [from_description(event) for event in asked["events"]]
    # Which columns are recorded if nothing is said is known by identity, which no journey keeps.
    alone = replace(alone, record=cast("list[ColumnName]", asked["record"]), events=events)
    plan = _core.plan(asked)
    bounds = bounds_of(len(ensemble))
    calls = [(ensemble[start:end], alone) for start, end in pairwise(bounds)]
    try:
        home, message = gathered(executor, run_part, calls, bounds, request.progress)
    except InvalidInput:
        # A worker counts the copies of its part. Refused here, before anything runs, by the number of the copy.
        return execute(ensemble._keywords, alone, names=ensemble._names, ensemble=True, make=ensemble._finished)
    if message:
        reached = ensemble[: bounds[len(home)]] if home else None
        raise Interrupted(message, None if reached is None else reached._finished(joined_copies(home, bounds, plan)))
    return finished(joined_copies(home, bounds, plan), asked, request.threads, ensemble=True, make=ensemble._finished)
