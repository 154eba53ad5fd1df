"""Values of functions and of their slopes where a formula has none, as 2 |v| of the drag −v |v| at rest.

The one idea: a slope is there if functions are continuous and their slopes come to one number from all sides. Both are
looked at, at three distances in many directions: |x|³ has a second derivative at 0, and |x| has not even a first one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["with_limits"]

#: How far states are moved: this part of the largest of their half, or this where all are zero.
_PART = 2.0**-20
_FROM_ZERO = 2.0**-100
#: From one distance to the next.
_NEARER = 2.0**-10
#: What shrinks by less than this from one distance to the next comes to no end, as a logarithm.
_SHRINKS = 0.9
#: Differences below this part of a value are round-off, and limits that differ by less than this part are one.
_ROUNDING = 1e-12
_ONE = 1e-6
#: Directions, beside one for each number.
_DIRECTIONS = 8


def with_limits(
    evaluate: Callable[[NDArray[np.float64]], NDArray[np.float64]], state: NDArray[np.float64], functions: int
) -> NDArray[np.float64]:
    """Values (k) at a state (2n): functions first, so many, then slopes; with limits in place of what is no number.

    What has no limit stays what it is. Units: those of the values.
    """
    at: NDArray[np.float64] = evaluate(state[None])[0]
    missing = ~np.isfinite(at)
    if not missing.any():
        return at
    n = len(state) // 2
    sizes = np.empty(2 * n)
    for half in (slice(None, n), slice(n, None)):
        largest = np.abs(state[half]).max(initial=0.0)
        sizes[half] = _PART * 2.0 ** np.floor(np.log2(largest)) if largest > 0.0 else _FROM_ZERO
    # The half that is to blame is moved alone, if one of them is: rest is left, or the place.
    for moved in (np.arange(2 * n) >= n, np.arange(2 * n) < n, np.ones(2 * n, dtype=bool)):
        found = _limits(evaluate, state, np.where(moved, sizes, 0.0))
        if found is None:
            continue
        limits, tolerance = found
        jumps = np.isfinite(at) & (np.abs(limits - at) > tolerance)
        if np.isnan(limits[:functions]).any() or jumps[:functions].any():
            return at
        filled: NDArray[np.float64] = np.where(missing, limits, at)
        return filled
    return at


def _limits(
    evaluate: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    state: NDArray[np.float64],
    sizes: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Limits (k), NaN where there is none, and what they are known to; nothing if values beside are no numbers."""
    rng = np.random.default_rng(20261127)
    shape = (_DIRECTIONS + len(state), len(state))
    # Few binary digits, so that places are moved by just as much.
    directions = rng.integers(32, 128, shape) / 128.0 * rng.choice([-1.0, 1.0], shape) * sizes
    directions = np.concatenate([directions, -directions])
    with np.errstate(all="ignore"):
        far, near, nearest = (evaluate(state + part * directions) for part in (1.0, _NEARER, _NEARER**2))
        if not (np.isfinite(far).all() and np.isfinite(near).all() and np.isfinite(nearest).all()):
            return None
        first, second = near - far, nearest - near
        still = np.abs(second) <= _ROUNDING * np.abs(nearest)
        shrinks = np.abs(second) <= _SHRINKS * np.abs(first)
        # What is left of a power of the distance, whichever (A. C. Aitken).
        ends = np.where(still, nearest, nearest - second**2 / (second - first))
    ends = np.where(still | shrinks, ends, np.nan)
    tolerance = _ONE * np.abs(far).max(axis=0)
    limits = ends.mean(axis=0)
    limits = np.where(np.abs(limits) <= tolerance, 0.0, limits)
    return np.where(np.ptp(ends, axis=0) <= tolerance, limits, np.nan), tolerance


def __dir__() -> list[str]:
    return list(__all__)
