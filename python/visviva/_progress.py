"""Turn the ``progress`` argument into what the core calls.

The core calls ``f(done, total)`` about every 50 ms and once at the end, on the caller's thread. ``progress=True`` is a
tqdm bar, notebook-aware, if tqdm is installed, and else one plain line on standard error. What the core counts where it
means something to people (events, steps, output times) is shown as it comes. Else only its share of the whole is known,
and is shown as that of what people know the whole of: copies, or the time that the run covers.
"""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeAlias

from visviva._keywords import check_call
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator

    from visviva.typing import Progress, Report

__all__ = ["TIME", "Span", "callback"]

_SHARE = "{percentage:3.0f} %|{bar}| {elapsed}, {remaining} left"
_TIME = "{percentage:3.0f} %|{bar}| {desc}{elapsed}, {remaining} left"

Span: TypeAlias = tuple[float, float]
TIME = "time"
"""The unit of what is covered from one time to another."""


@contextmanager
def callback(progress: Progress, unit: str = "", of: Span | None = None) -> Iterator[Report | None]:
    """Give the callable for the core, and close what it shows when the run ends.

    Parameters
    ----------
    progress : bool or callable
        True for a bar, False for nothing, or a callable ``f(done, total)``.
    unit : str
        What is counted, if that says something to people: "events".
    of : tuple of float, optional
        Where only the share is counted: from which number of the unit to which it goes, as (0, copies). Of the unit
        `TIME`, the times of the scene from and to which it runs.

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
        with _bar(unit, of) as report:
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


def _measured(of: Span | None, done: int, total: int) -> tuple[float, float]:
    """What is done of how much, in the unit that is shown."""
    if of is None:
        return done, total
    span = abs(of[1] - of[0])
    return span * done / max(total, 1), span


def _at(of: Span, done: float) -> str:
    """The time of the scene that is reached."""
    return f"t = {of[0] + (done if of[1] > of[0] else -done):.4g} of {of[1]:.4g}"


@contextmanager
def _bar(unit: str, of: Span | None) -> Iterator[Report]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        with _line(unit, of) as report:
            yield report
        return
    # Made with the first report, so that a run that is refused shows nothing.
    bar = None
    start = time.perf_counter()

    def show(count: int, total: int) -> None:
        nonlocal bar
        done, whole = _measured(of, count, total)
        if bar is None:
            how = {"unit": f" {unit}", "unit_scale": True} if unit else {"bar_format": _SHARE}
            bar = tqdm(total=whole, **({"bar_format": _TIME} if unit == TIME else how))
        bar.total = whole
        if unit == TIME and of is not None:
            rate = done / max(time.perf_counter() - start, 1e-9)
            bar.set_description_str(f"{_at(of, done)}, {rate:.3g} a second, ", refresh=False)
        bar.update(done - bar.n)

    try:
        yield show
    finally:
        if bar is not None:
            bar.close()


@contextmanager
def _line(unit: str, of: Span | None) -> Iterator[Report]:
    begun, start = False, time.perf_counter()

    def report(count: int, total: int) -> None:
        nonlocal begun
        begun = True
        passed = max(time.perf_counter() - start, 1e-9)
        done, whole = _measured(of, count, total)
        rate = done / passed
        share = f"{100 * count // total} %" if total else f"{count}"
        speed = f", {_scaled(rate)} {unit}/s" if unit else ""
        if of is not None:
            shown = f"{_at(of, done)}, {rate:.3g} a second" if unit == TIME else f"{done:.3g} of {whole:g}{speed}"
            speed = f", {shown.removeprefix(', ')}"
        left = f", {(whole - done) / rate:.0f} s left" if rate > 0.0 and count < total else ""
        # What was longer before is written over.
        print(f"\r{f'visviva: {share}{speed}{left}':<70}", end="", file=sys.stderr, flush=True)

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
