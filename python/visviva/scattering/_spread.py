"""Ranges of events, counted here or by other processes and machines: out with the ranges, home with the counts.

The one idea: event i depends on the seed and i alone, so that what ranges give adds up to the whole, bit for bit.
"""

from __future__ import annotations

from contextlib import closing, suppress
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeVar

from visviva import _core
from visviva._arrays import whole_number
from visviva._executors import checked_executor, results_in_order
from visviva._progress import callback
from visviva.errors import InternalError, Interrupted

if TYPE_CHECKING:
    from collections.abc import Callable

    from visviva.typing import Progress, Report

__all__ = ["count_range", "counted", "event_range"]

# Ranges in all, and events at least that are worth a journey: an ion takes many collisions where the others take one.
_MOST, _LEAST = 64, {"monte_carlo": 1 << 20, "foil_run": 1 << 14}

_Result = TypeVar("_Result", bound=Any)


def event_range(first_event: object, n_events: object, seed: object, most: int = 2**63) -> tuple[int, int, int]:
    """Which events: the first, how many, and the seed."""
    first = whole_number("first_event", first_event, 0, 2**63 - 1)
    count = whole_number("n_events", n_events, 1, min(most, 2**63 - first))
    return first, count, whole_number("seed", seed, 0, 2**64 - 1)


def counted(
    work: str,
    request: dict[str, Any],
    events: tuple[int, int, int],
    threads: object,
    progress: Progress,
    executor: Any,
    made: Callable[[tuple[Any, ...], tuple[tuple[int, int, int], ...]], _Result],
    noun: str = "events",
) -> _Result:
    """The result of some events, counted by a function of the core.

    Parameters
    ----------
    work : str
        Which function. What it gives begins with how many events it counted and whether it was stopped; its fourth
        item tells its tables, which are the same wherever they are built.
    request : dict
        What it takes beside the events.
    events : tuple
        As `event_range` gives them.
    threads, progress, executor
        As of `monte_carlo`.
    made : callable
        The result of what it gives and its (seed, first, end); results add up.
    noun : str
        What progress counts.

    Raises
    ------
    visviva.Interrupted
        With what was counted until then.
    """
    first, count, seed = events
    several = None if threads is None else whole_number("threads", threads, 1, 1024)
    request = {**request, "seed": seed, "threads": several}
    with callback(progress, noun) as report:
        if executor is not None:
            home = _spread(executor, work, request, first, count, report)
        else:
            home = [getattr(_core, work)(**request, n_events=count, first_event=first, progress=report)]
    results, at = [], first
    for came in home:
        if not came[0]:
            break  # stopped before the first
        results.append(made(came, ((seed, at, at + came[0]),)))
        at += came[0]
    result: _Result | None = sum(results[1:], start=results[0]) if results else None
    if result is None or at - first < count or home[-1][1]:
        raise Interrupted(f"interrupted after {at - first} of {count} events", result=result)
    return result


def count_range(work: str, request: dict[str, Any], first: int, count: int) -> Any:
    """Count a range of events: what a worker does."""
    threads = request["threads"] or 1
    return getattr(_core, work)(**{**request, "threads": threads}, n_events=count, first_event=first, progress=None)


def _spread(
    executor: Any, work: str, request: dict[str, Any], first: int, count: int, report: Report | None
) -> list[Any]:
    """What ranges of events gave, in order and without a gap; after Ctrl-C as many as came home."""
    checked_executor(executor)
    # One event here: whatever is refused is refused before anything is sent.
    table = count_range(work, request, first, 1)[3]
    parts = max(1, min(_MOST, count // _LEAST[work]))
    bounds = [first + count * part // parts for part in range(parts + 1)]
    ranges = [(work, request, start, end - start) for start, end in pairwise(bounds)]
    home: list[Any] = []
    with suppress(KeyboardInterrupt), closing(results_in_order(executor, count_range, ranges)) as coming:
        for came, (*_, start, events) in zip(coming, ranges, strict=True):
            if came[3] != table:
                raise InternalError(f"a worker built another table: {came[3]} instead of {table}")
            home.append(came)
            if report is not None:
                report(start + events - first, count)
    return home
