"""Turn the ``progress`` argument into what the core calls.

The core calls ``f(done, total)`` about every 50 ms and once at the end, on the caller's thread. ``progress=True`` is a
tqdm bar, notebook-aware, if tqdm is installed, and else one plain line on standard error.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from visviva.errors import InvalidInput

__all__ = ["Progress", "Report", "callback"]

Report: TypeAlias = Callable[[int, int], object]
Progress: TypeAlias = bool | Report


@contextmanager
def callback(progress: Progress) -> Iterator[Report | None]:
    """Give the callable for the core, and close what it shows when the run ends.

    Parameters
    ----------
    progress : bool or callable
        True for a bar, False for nothing, or a callable ``f(done, total)``.

    Yields
    ------
    callable or None
        What to hand to the core.

    Raises
    ------
    InvalidInput
        For anything else.

    Examples
    --------
    >>> from visviva._progress import callback
    >>> with callback(print) as report:
    ...     report(3, 10)
    3 10
    """
    if progress is False:
        yield None
    elif progress is True:
        with _bar() as report:
            yield report
    elif callable(progress) and not isinstance(progress, type):
        yield progress
    else:
        # Calling a class, tqdm for one, would make something new at every report.
        came = f"the class {progress.__name__}" if isinstance(progress, type) else repr(progress)
        raise InvalidInput(
            "progress", f"expected True, False or a callable f(done, total), got {came}; True shows a tqdm bar"
        )


@contextmanager
def _bar() -> Iterator[Report]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        with _line() as report:
            yield report
        return
    # Made with the first report, so that a run that is refused shows nothing.
    bar = None

    def show(done: int, total: int) -> None:
        nonlocal bar
        if bar is None:
            bar = tqdm(total=total)
        bar.total = total
        bar.update(done - bar.n)

    try:
        yield show
    finally:
        if bar is not None:
            bar.close()


@contextmanager
def _line() -> Iterator[Report]:
    begun = False

    def report(done: int, total: int) -> None:
        nonlocal begun
        begun = True
        share = f"{100 * done // total} %" if total else f"{done}"
        print(f"\rvisviva: {share}", end="", file=sys.stderr, flush=True)

    try:
        yield report
    finally:
        if begun:
            print(file=sys.stderr)
