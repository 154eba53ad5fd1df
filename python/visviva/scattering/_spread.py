"""Ranges of events for other processes and machines: out with the ranges, home with the counts."""

from __future__ import annotations

from contextlib import closing, suppress
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from visviva import _core
from visviva._executors import checked_executor, results_in_order
from visviva.errors import InternalError

if TYPE_CHECKING:
    from visviva.typing import Report

# Ranges in all, and events at least that are worth a journey.
_MOST, _LEAST = 64, 1 << 20


def count_range(request: dict[str, Any], first: int, count: int) -> Any:
    """Count a range of events: what a worker does."""
    threads = request["threads"] or 1
    return _core.monte_carlo(**{**request, "threads": threads}, n_events=count, first_event=first, progress=None)


def spread(executor: Any, request: dict[str, Any], first: int, count: int, report: Report | None) -> list[Any]:
    """What ranges of events gave, in order and without a gap; after Ctrl-C as many as came home."""
    checked_executor(executor)
    # One event here: whatever is refused is refused before anything is sent.
    table = count_range(request, first, 1)[3]
    parts = max(1, min(_MOST, count // _LEAST))
    bounds = [first + count * part // parts for part in range(parts + 1)]
    ranges = [(request, start, end - start) for start, end in pairwise(bounds)]
    home: list[Any] = []
    with suppress(KeyboardInterrupt), closing(results_in_order(executor, count_range, ranges)) as coming:
        for came, (_, start, events) in zip(coming, ranges, strict=True):
            if came[3] != table:
                raise InternalError(f"a worker built another table: {came[3]} instead of {table}")
            home.append(came)
            if report is not None:
                report(start + events - first, count)
    return home
