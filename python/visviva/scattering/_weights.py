"""Counts of strata, weighted when they are read: events are counted as whole numbers, stratum by stratum."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._packages import needed

if TYPE_CHECKING:
    from boost_histogram.storage import Storage
    from hist import Hist
    from numpy.typing import NDArray

    from visviva.scattering._joint_tally import JointTally
    from visviva.scattering._tally import Tally

__all__ = ["added_strata", "read_only", "same", "to_hist", "variances", "weighted_columns", "weighted_counts"]


def weighted_counts(
    tally: Tally | JointTally, power: int, counts: NDArray[np.uint64], part: tuple[slice, ...] = (slice(0, -1),)
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


def weighted_columns(tally: Tally | JointTally) -> dict[str, NDArray[np.float64]]:
    """What is shown beside counts where they are weighted."""
    return {} if tally.by_stratum is None else {"values": tally.values(), "variances": tally.variances()}


def to_hist(
    tally: Tally | JointTally,
    names: tuple[str, ...],
    edges: tuple[NDArray[np.float64], ...],
    flow: NDArray[np.uint64],
) -> Hist[Storage]:
    """As a ``hist.Hist``: of integers, or of weights and their squares."""
    hist = needed("hist", "to_hist")
    axes = [hist.axis.Variable(values, name=name) for name, values in zip(names, edges, strict=True)]
    storage = hist.storage.Int64() if tally.by_stratum is None else hist.storage.Weight()
    filled: Hist[Storage] = hist.Hist(*axes, storage=storage)
    view: Any = filled.view(flow=True)
    if tally.by_stratum is None:
        view[...] = flow
    else:
        view.value, view.variance = weighted_counts(tally, 1, flow), weighted_counts(tally, 2, flow)
    return filled


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
