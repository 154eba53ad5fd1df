"""Turn the ``progress`` argument into what the core calls.

The core calls ``f(done, total)`` about every 50 ms and once at the end, on the caller's thread. ``progress=True`` is a
tqdm bar, notebook-aware, if tqdm is installed, and else one plain line on standard error. Events are counted by what
they are, with their rate; of other runs, whose parts are steps of some kind, only the share and the time are shown.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from visviva._keywords import check_call
from visviva.errors import InvalidInput

__all__ = ["Progress", "Report", "callback"]

_SHARE = "{percentage:3.0f} %|{bar}| {elapsed}, {remaining} left"

Report: TypeAlias = Callable[[int, int], object]
Progress: TypeAlias = bool | Report


@contextmanager
def callback(progress: Progress, unit: str = "") -> Iterator[Report | None]:
    """Give the callable for the core, and close what it shows when the run ends.

    Parameters
    ----------
    progress : bool or callable
        True for a bar, False for nothing, or a callable ``f(done, total)``.
    unit : str
        What is counted, if that says something to people: "events".

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
        with _bar(unit) as report:
            yield report
    elif callable(progress) and not isinstance(progress, type):
        check_call("progress", progress, ("done", "total"))
        yield progress
    else:
        # Calling a class, tqdm for one, would make something new at every report.
        came = f"the class {progress.__name__}" if isinstance(progress, type) else repr(progress)
        raise InvalidInput(
            "progress", f"expected True, False or a callable f(done, total), got {came}; True shows a tqdm bar"
        )


@contextmanager
def _bar(unit: str) -> Iterator[Report]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        with _line(unit) as report:
            yield report
        return
    # Made with the first report, so that a run that is refused shows nothing.
    bar = None
    how = {"unit": f" {unit}", "unit_scale": True} if unit else {"bar_format": _SHARE}

    def show(done: int, total: int) -> None:
        nonlocal bar
        if bar is None:
            bar = tqdm(total=total, **how)
        bar.total = total
        bar.update(done - bar.n)

    try:
        yield show
    finally:
        if bar is not None:
            bar.close()


@contextmanager
def _line(unit: str) -> Iterator[Report]:
    begun, start = False, time.perf_counter()

    def report(done: int, total: int) -> None:
        nonlocal begun
        begun = True
        share = f"{100 * done // total} %" if total else f"{done}"
        rate = done / max(time.perf_counter() - start, 1e-9)
        speed = f", {_scaled(rate)} {unit}/s" if unit else ""
        left = f", {(total - done) / rate:.0f} s left" if rate > 0.0 and done < total else ""
        # What was longer before is written over.
        print(f"\r{f'visviva: {share}{speed}{left}':<60}", end="", file=sys.stderr, flush=True)

    try:
        yield report
    finally:
        if begun:
            print(file=sys.stderr)


def _scaled(rate: float) -> str:
    """A number with three digits and the prefix of its thousands."""
    for prefix in ("", "k", "M", "G"):
        if rate < 999.5 or prefix == "G":
            break
        rate /= 1000.0
    return f"{rate:.3g} {prefix}".rstrip()
