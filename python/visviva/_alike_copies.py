"""Copies of an ensemble whose rigid bodies differ in their symmetry, run apart.

The one idea: how bodies turn (in closed form or in steps, by which method, in which of the formulas) hangs on whether
two of their moments agree, or all, or one is 0. A copy has the bits that it has alone, so only those share a run that
are alike in this.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._continuation import continuation_of_copies
from visviva._joined_copies import in_order, joined_copies
from visviva._some_copies import of_copies
from visviva.errors import Interrupted
from visviva.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.typing import Report

__all__ = ["run_copies"]


def run_copies(asked: _core._Request, *, threads: int | None, progress: Report | None) -> dict[str, Any]:
    """What the core gives for all copies, those together whose bodies are alike.

    Raises
    ------
    visviva.InvalidInput
        What the core refuses.
    visviva.Interrupted
        After Ctrl-C, where some copies ran apart.
    """
    kinds = _kinds(asked)
    if len(kinds) == 1:
        return _core.run(asked, threads=threads, progress=progress, ensemble=True)
    plan = _core.plan(asked)  # refuses by the number of a copy what a part would count anew
    total, parts, bounds = len(asked["mass"]), [], [0]
    for copies in kinds:

        def told(done: int, of: int, first: int = bounds[-1], number: int = len(copies)) -> None:
            if progress is not None:
                progress(first + number * done // max(of, 1), total)

        some: Any = of_copies(asked, copies) | {"continuation": continuation_of_copies(asked["continuation"], copies)}
        part = _core.run(some, threads=threads, progress=None if progress is None else told, ensemble=True)
        if part["error"] is not None or (part["status"] == Status.INTERRUPTED).any():
            raise Interrupted(f"the ensemble was interrupted after {bounds[-1]} of {total} copies")
        parts.append(part)
        bounds.append(bounds[-1] + len(copies))
    return in_order(joined_copies(parts, bounds, plan), np.concatenate(kinds))


def _kinds(asked: _core._Request) -> list[NDArray[np.intp]]:
    """The copies of each kind, those of the least symmetric bodies first; one kind where there are no bodies."""
    all_copies = np.arange(len(asked["mass"]))
    rigid = asked["rigid"]
    if rigid is None or not (rigid["moments"] != rigid["moments"][0]).any():
        return [all_copies]
    a, b, c = np.moveaxis(rigid["moments"], -1, 0)
    # How many pairs of moments agree: none, one, or all three; and of rods, which have a moment of 0.
    agree = (a == b).astype(int) + (b == c) + (c == a) + 4 * (rigid["moments"] == 0.0).any(axis=-1)
    _, kind = np.unique(agree, axis=0, return_inverse=True)
    return [np.flatnonzero(kind == each) for each in range(kind.max() + 1)]


def __dir__() -> list[str]:
    return list(__all__)
