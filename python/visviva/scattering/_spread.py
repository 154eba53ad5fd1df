"""Ranges of events for other processes and machines: out with the ranges, home with the counts."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from visviva import _core
from visviva.errors import InternalError, InvalidInput

if TYPE_CHECKING:
    from visviva._progress import Report

# Ranges in all, and events at least that are worth a journey.
_MOST, _LEAST = 64, 1 << 20


def count_range(request: dict[str, Any], first: int, count: int) -> Any:
    """Count a range of events: what a worker does."""
    threads = request["threads"] or 1
    return _core.monte_carlo(**{**request, "threads": threads}, n_events=count, first_event=first, progress=None)


def spread(executor: Any, request: dict[str, Any], first: int, count: int, report: Report | None) -> list[Any]:
    """What ranges of events gave, in order and without a gap; after Ctrl-C as many as came home."""
    if not callable(getattr(executor, "submit", None)):
        raise InvalidInput(
            "executor", f"expected a concurrent.futures.Executor or a dask.distributed.Client, got {executor!r}"
        )
    # One event here: whatever is refused is refused before anything is sent.
    table = count_range(request, first, 1)[3]
    parts = max(1, min(_MOST, count // _LEAST))
    bounds = [first + count * part // parts for part in range(parts + 1)]
    ranges = [(start, end - start) for start, end in pairwise(bounds)]
    # A Dask client takes equal calls for one and the same; these depend on their arguments alone, so it may.
    futures = [executor.submit(count_range, request, *each) for each in ranges]
    home: list[Any] = []
    try:
        for future, each in zip(futures, ranges, strict=True):
            try:
                came = future.result()
            except BrokenExecutor:
                # Its workers are gone, and will not come back: their ranges are counted here.
                came = count_range(request, *each)
            if came[3] != table:
                raise InternalError(f"a worker built another table: {came[3]} instead of {table}")
            home.append(came)
            if report is not None:
                report(each[0] + each[1] - first, count)
    except KeyboardInterrupt:
        for future in futures:
            future.cancel()
    return home
