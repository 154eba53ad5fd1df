"""Rows of copies that were run together, which a result has of one copy after another.

The one idea: a copy that fails has fewer rows than others, so where those of each begin is counted from their numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._some_copies import each_of, lines_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["result_of_copies", "rows_of_copies"]


def rows_of_copies(result: dict[str, Any], times: int) -> NDArray[np.float64]:
    """States (copies, times, 2n), NaN beyond the last, of a result that has those of one copy after another."""
    lengths, y = result["lengths"], result["y"]
    if all(length == times for length in lengths):
        states: NDArray[np.float64] = y.reshape(len(lengths), times, y.shape[1])
        return states
    states = np.full((len(lengths), times, y.shape[1]), np.nan)
    ends = np.cumsum([0, *lengths])
    for copy, length in enumerate(lengths):
        states[copy, :length] = y[ends[copy] : ends[copy + 1]]
    return states


def result_of_copies(result: dict[str, Any], copies: NDArray[np.intp]) -> dict[str, Any]:
    """The result of some of the copies, as a run of these alone would give it."""
    rows, found = (lines_of(np.array(result[name], dtype=np.intp), copies) for name in ("lengths", "found"))
    lines = {"t": rows, "y": rows, "found_which": found, "found_t": found, "found_y": found}
    part: dict[str, Any] = {}
    for name, values in result.items():
        chosen = lines.get(name, copies)
        if name == "interrupted":  # of all at once
            part[name] = values
        else:
            part[name] = values[chosen] if isinstance(values, np.ndarray) else list(each_of(values, chosen))
    return part


def __dir__() -> list[str]:
    return list(__all__)
