"""Looks at arrays that may be nearly as long as memory: no copies of them, and a name for what does not fit.

The one idea: such an array is looked at in blocks, so that what is said of it does not hang on room for a second one.
"""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

__all__ = ["all_finite", "as_float64", "first_turned_back", "room_for"]

#: Numbers of a block: 8 MB, of which fewer cost more calls and more no fewer.
_BLOCK = 2**20


def all_finite(array: NDArray[np.float64]) -> bool:
    """Whether all numbers of a C-contiguous array, of any shape, are finite: of an empty one they are."""
    if array.size <= _BLOCK:
        # Counting takes half the time of `all` on the few numbers of most calls.
        return bool(np.count_nonzero(np.isfinite(array)) == array.size)
    flat = array.reshape(-1)
    return all(np.isfinite(flat[at : at + _BLOCK]).all() for at in range(0, len(flat), _BLOCK))


def first_turned_back(start: float, times: NDArray[np.float64]) -> int | None:
    """Give the index of the first of times (T,) that leads back, or None where none does.

    Which way is back the first time tells that is another than `start`; equal times lead nowhere.
    """
    # The last time of a block is that before the next.
    direction, before = 0.0, start
    for at in range(0, len(times), _BLOCK):
        with np.errstate(over="ignore"):  # between times at both ends of float64: infinite, of the right sign
            steps = np.diff(times[at : at + _BLOCK], prepend=before)
        before = times[min(at + _BLOCK, len(times)) - 1]
        moving = steps != 0.0
        if direction == 0.0 and moving.any():
            direction = np.sign(steps[np.argmax(moving)])
        back = steps * direction < 0.0
        if back.any():
            return at + int(np.argmax(back))
    return None


def as_float64(name: str, array: NDArray[Any]) -> NDArray[np.float64]:
    """Give real numbers as aligned, C-contiguous float64, for which there is room or `name` is refused."""
    with room_for(name, array.shape):
        return np.require(array, np.float64, ["C_CONTIGUOUS", "ALIGNED"])


@contextmanager
def room_for(name: str, shape: tuple[int, ...]) -> Iterator[None]:
    """Where another array of an argument's shape is made: there is room for it, or the argument is refused.

    Raises
    ------
    InvalidInput
        In the words of the core, which has the same refusal.
    """
    try:
        yield
    except MemoryError:
        needed = f"a copy of it would take {8 * math.prod(shape)} bytes, which are not available"
        raise InvalidInput(name, f"{needed}; ask for fewer at a time") from None


def __dir__() -> list[str]:
    return list(__all__)
