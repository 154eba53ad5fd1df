"""The states of copies that were run together, as an array of all times: a copy that fails has fewer of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["rows_of_copies"]


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


def __dir__() -> list[str]:
    return list(__all__)
