"""Derivatives of a field by differences of its values, and what they are rounded by.

The one idea: over what length a field bends is not known, so steps of several lengths are tried, and that one believed
of which a shorter says the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

__all__ = ["ROUNDING", "derivatives"]

_NEAR = 2.0**-10
"""The step of differences, of the size of what is looked at: fourth order errs by 1e-12 there, rounding by as much."""
_STEPS = 6
"""Steps that are tried, each an eighth of the one before: to 3e-8 of the size."""
_DECADES = 30
"""Where places have no size, steps from ten to the power of minus this up to this are tried."""
_AGREES, _WORSE = 1e-3, 10.0
"""Until after steps whose derivatives agree to the first of these come some that agree so many times less."""
ROUNDING = 1e-8
"""What such differences err by at most, of fields that bend over a thousandth of the size or more."""


def derivatives(
    at: Callable[[NDArray[np.float64]], ArrayLike], x: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of each component along each axis at each place, by the step of which a shorter one says the same; its rounding.

    Over what length a field bends is not known: its center may be near a place that is far from the origin.
    """
    sizes = np.abs(x).max(axis=1)
    if not sizes.any():
        return _at_the_origin(at, x)
    sizes = np.where(sizes > 0.0, sizes, float(sizes.max()))[:, None, None]
    best, least, before = np.zeros((len(x), 3, 3)), np.full(len(x), np.inf), None
    rounded, rounded_before = np.zeros(len(x)), np.zeros(len(x))
    for shorter in range(_STEPS):
        now, rounding = _by_differences(at, x, _NEAR * 8.0**-shorter * sizes)
        if before is not None:
            change = np.abs(now - before).max(axis=(1, 2))
            better = (change < least) | ~np.isfinite(least)
            # The longer of both has less rounding.
            best[better], least[better], rounded[better] = before[better], change[better], rounded_before[better]
        before, rounded_before = now, rounding
    return best, rounded


def _by_differences(
    at: Callable[[NDArray[np.float64]], ArrayLike], x: NDArray[np.float64], h: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Derivatives by differences over these steps, and their rounding."""
    now, largest = np.zeros((len(x), 3, 3)), np.zeros(len(x))
    for axis in range(3):
        moved = [x + k * h[:, 0] * np.eye(3)[axis] for k in (-2, -1, 1, 2)]
        f = [float_array("force", at(place), x.shape) for place in moved]
        now[:, :, axis] = (f[0] - 8.0 * f[1] + 8.0 * f[2] - f[3]) / (12.0 * h[:, 0])
        largest = np.maximum(largest, np.abs(f).max(axis=(0, 2)))
    # Two derivatives make a component of the curl, each of four values with a rounding or two of their own.
    return now, 4.0 * np.finfo(float).eps * largest / h[:, 0, 0]


def _at_the_origin(
    at: Callable[[NDArray[np.float64]], ArrayLike], x: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same where places have no size: over which length a field bends only it knows, be it 1e-30 or 1e30."""
    best, least, before = np.zeros((len(x), 3, 3)), 1.0, None
    rounded, rounded_before = np.zeros(len(x)), np.zeros(len(x))
    for decade in range(-_DECADES, _DECADES + 1):
        try:
            with np.errstate(all="ignore"):
                now, rounding = _by_differences(at, x, np.full((len(x), 1, 1), 10.0**decade))
        except InvalidInput:  # so far away it is nowhere, or no number
            break
        if before is not None:
            unsure = float(np.maximum(rounding, rounded_before).max())
            size = max(float(np.abs(now).max()), float(np.abs(before).max())) + unsure
            change = (float(np.abs(now - before).max()) + unsure) / size if size > 0.0 else 1.0
            if change > _WORSE * least and least < _AGREES:
                break  # from here on it bends within a step, and farther off it may be another field
            if change < least:
                best, least, rounded = now, change, rounding
        before, rounded_before = now, rounding
    return best, rounded
