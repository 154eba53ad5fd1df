"""Bodies relative to centers of mass: that of those before each (Jacobi coordinates), or that of all others.

The one idea: a step of a sum is one operation for all bodies and rows. The sums themselves go over those that attract
one by one in their order, for one body as for all, so each has the bits that it has alone.
Source: Murray & Dermott, *Solar System Dynamics* (1999) §9.7 (Jacobi coordinates).
"""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from typing import TypeAlias

    from numpy.typing import NDArray

    _Array: TypeAlias = NDArray[np.float64]

__all__ = ["relative_to_center"]

_AT_ONCE = 1 << 17  # numbers that are held at once: 1 MiB stays near the processor


def relative_to_center(
    position: _Array, velocity: _Array, mass: _Array, chosen: NDArray[np.intp], *, before: bool
) -> tuple[_Array, _Array, _Array]:
    """Places and velocities (…, K, 3) from the center of mass of others, and the mass of these, (…, K) or (K,).

    Of states (…, N, 3) and masses (N,), or any that broadcast to (…, N). The others are those `before` each, or all.
    """
    rows, count = position.shape[:-2], position.shape[-2]
    if mass.ndim > 1:
        mass = np.broadcast_to(mass, (*rows, count))
    by_row = mass.reshape(-1, count)
    states = np.concatenate((position, velocity), axis=-1).reshape(prod(rows), count, 6)
    found, inside = (_before if before else _others)(states, by_row, chosen)
    apart = found.transpose(2, 0, 1).reshape(*rows, len(chosen), 6)
    return apart[..., :3], apart[..., 3:], inside.reshape(*mass.shape[:-1], len(chosen))


def _before(states: _Array, mass: _Array, chosen: NDArray[np.intp]) -> tuple[_Array, _Array]:
    """(K, 6, rows) from the center of mass of those before, which moves by the share of each that is added."""
    count = int(chosen.max(initial=0)) + 1
    masses = mass[:, :count]
    totals = np.cumsum(masses, axis=1)
    shares = np.divide(masses, totals, out=np.zeros_like(totals), where=totals > 0.0).T[:, None, :]
    of_body = np.ascontiguousarray(states[:, :count].transpose(1, 2, 0))
    apart = np.empty_like(of_body)
    center, shift = of_body[0].copy(), np.empty_like(of_body[0])
    for own, offset, share in zip(of_body[1:], apart[1:], shares[1:], strict=True):
        np.subtract(own, center, out=offset)
        np.multiply(share, offset, out=shift)
        np.add(center, shift, out=center)
    return apart[chosen], totals[:, chosen - 1]


def _others(states: _Array, mass: _Array, chosen: NDArray[np.intp]) -> tuple[_Array, _Array]:
    """(K, 6, rows) from the center of all others: the mean of the distances, so that none is lost in a great sum."""
    totals = _mass_of_others(mass, chosen)
    own = np.ascontiguousarray(states[:, chosen].transpose(2, 1, 0))
    apart = np.zeros_like(own)
    attracting = np.flatnonzero(mass.any(axis=0))
    step = max(1, _AT_ONCE // max(1, own.size))
    for first in range(0, len(attracting), step):
        some = attracting[first : first + step]
        others = (some[:, None] != chosen)[:, :, None]
        weights = mass.T[some, None]
        shares = np.divide(
            weights, totals.T, out=np.zeros((len(some), *totals.T.shape)), where=others & (totals.T > 0.0)
        )
        shifts = own - states[:, some].transpose(1, 2, 0)[:, :, None]
        shifts *= shares[:, None]
        shifts[0] += apart  # so that the sum goes on body by body
        np.add.reduce(shifts, axis=0, out=apart)
    return apart.swapaxes(0, 1), totals


def _mass_of_others(mass: _Array, chosen: NDArray[np.intp]) -> _Array:
    """(rows, K): added up as an array of the others is, some bodies at a time."""
    places = np.arange(mass.shape[1] - 1)
    totals = np.empty((len(mass), len(chosen)))
    step = max(1, _AT_ONCE // max(1, mass.size))
    for first in range(0, len(chosen), step):
        some = slice(first, first + step)
        others = places + (places >= chosen[some, None])
        np.add.reduce(mass.take(others, axis=1), axis=-1, out=totals[:, some])
    return totals
