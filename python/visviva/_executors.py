"""Parts of a piece of work for other processes and machines: out with what to do, home with what came of it.

The one idea: a part is a function of its arguments alone, with the same bits wherever it is done. So parts come home in
their order, and one whose worker is lost is done again.
"""

from __future__ import annotations

from concurrent.futures import BrokenExecutor
from typing import TYPE_CHECKING, Any

from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

__all__ = ["checked_executor", "results_in_order"]


def checked_executor(executor: Any) -> Any:
    """The executor, if it is one.

    Raises
    ------
    visviva.InvalidInput
        If it takes no work.
    """
    if not callable(getattr(executor, "submit", None)) or isinstance(executor, type):
        raise InvalidInput(
            "executor", f"expected a concurrent.futures.Executor or a dask.distributed.Client, got {executor!r}"
        )
    return executor


def results_in_order(
    executor: Any, work: Callable[..., Any], parts: Sequence[tuple[Any, ...]]
) -> Generator[Any, None, None]:
    """What ``work(*part)`` gives for each part, in their order; what is not asked for any more is called off.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from visviva._executors import results_in_order
    >>> with ThreadPoolExecutor() as executor:
    ...     list(results_in_order(executor, pow, [(2, 3), (3, 2)]))
    [8, 9]
    """
    # A Dask client takes equal calls for one and the same; these depend on their arguments alone, so it may.
    futures = [_submitted(executor, work, part) for part in parts]
    home = 0
    try:
        for future, part in zip(futures, parts, strict=True):
            try:
                came = work(*part) if future is None else future.result()
            except BrokenExecutor:
                # Its workers are gone, and will not come back: what they had is done here.
                came = work(*part)
            home += 1
            yield came
    finally:
        for future in futures[home:]:
            if future is not None:
                future.cancel()


def _submitted(executor: Any, work: Callable[..., Any], part: tuple[Any, ...]) -> Any:
    """The future of a part; None if a worker was lost already, and the pool with it."""
    try:
        return executor.submit(work, *part)
    except BrokenExecutor:
        return None
