"""Counts of strata, weighted when they are read: events are counted as whole numbers, stratum by stratum."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.scattering._exported import OfStrata

__all__ = ["added_strata", "read_only", "same", "variances", "weighted_counts"]


def weighted_counts(
    tally: OfStrata, power: int, counts: NDArray[np.uint64], part: tuple[slice, ...] = (slice(0, -1),)
) -> NDArray[np.float64]:
    """Σ w n over the strata, or Σ w² n of power 2, of a part of their slots; without strata the counts."""
    strata = tally.beam.importance
    if strata is None or tally.by_stratum is None:
        return counts.astype(np.float64)
    total = np.zeros(counts.shape)
    # In the order of the strata, number by number: no library chooses the order in which is added.
    for weight, row in zip(strata.weights, tally.by_stratum, strict=True):
        factor = weight if power == 1 else weight * weight
        total += factor * row[part].astype(np.float64).reshape(counts.shape)
    return total


def variances(values: NDArray[np.float64], squares: NDArray[np.float64], n_events: int) -> NDArray[np.float64]:
    """Σ w² n − (Σ w n)²/N, which is nowhere below 0 but for rounding: N events of weights w or 0."""
    found: NDArray[np.float64] = np.maximum(squares - values * (values / n_events), 0.0)
    return found


def added_strata(mine: NDArray[np.uint64] | None, other: NDArray[np.uint64] | None) -> NDArray[np.uint64] | None:
    """The counts of the strata of both."""
    return None if mine is None or other is None else mine + other


def same(mine: NDArray[Any] | None, other: NDArray[Any] | None) -> bool:
    """Whether both are the same numbers, or neither is any."""
    return mine is other if mine is None or other is None else np.array_equal(mine, other)


def read_only(*arrays: NDArray[Any] | None) -> None:
    """Let nobody write to them."""
    for array in arrays:
        if array is not None:
            array.setflags(write=False)
