"""The stiffness of a Hamiltonian at rest where momenta add much to it and take that away again, as in strong fields.

The one idea: second derivatives of H(q, p) are known to the rounding of what momenta add. The forces where velocities
are zero without any rounding are not: all of that is zero in them, and their differences have the digits that are left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["by_differences", "is_hidden"]

#: Distances of differences, as parts of the sizes of places: the first is far above the rounding of what is near them.
_FIRST = -26
_FARTHER = range(-25, -3)
_NEARER = range(-28, -140, -2)
#: Each of them with other digits, lest rounding be the same in all: what it makes of them is how far they differ.
_DIGITS = np.array([1.0, 1.1180339887, 1.3247179572, 1.4656712319, 1.6180339887, 1.8392867552])
#: How many times that it may be more.
_UNSEEN = 2.0
_EPSILON = float(np.finfo(float).eps)
#: Roundings of a difference, and of a stiffness that are no more than its own.
_ROUNDINGS = 8.0
_OWN = 1e4

_Known = tuple["NDArray[np.float64]", "NDArray[np.float64]"]


def by_differences(
    forces: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    place: NDArray[np.float64],
    size: NDArray[np.float64],
    known: _Known,
) -> _Known:
    """Give K (n, n) and what it may be off, better than it is known, if forces at rest (S, n) at places tell it.

    These are not numbers where velocities are not exactly zero. What they tell agrees with what is known, and at one
    distance with that at others.
    """
    stiffness, off = known
    first = _at_distance(forces, place, size, _FIRST)
    if first is None:
        return known
    best = _better((stiffness, off), first)
    for levels in (_FARTHER, _NEARER):
        going_on = np.ones(off.shape, dtype=bool)
        for level in levels:
            other = _at_distance(forces, place, size, level)
            if other is None:
                break
            going_on &= np.abs(other[0] - best[0]) <= other[1] + best[1]
            better = _better(best, other)
            best = np.where(going_on, better[0], best[0]), np.where(going_on, better[1], best[1])
            if not going_on.any():
                break
    found, left = best
    # It changes over what the place itself may be off.
    step = np.abs(np.linalg.pinv(found) @ np.nan_to_num(forces(place[None])[0]))
    if (step > 0.0).any():
        ends = [_at_distance(forces, place + sign * step, size, _FIRST) for sign in (1.0, -1.0)]
        for end in ends:
            if end is None:
                return known
            left = left + np.where(np.abs(end[0] - found) > end[1], np.abs(end[0] - found), 0.0)
    taken = (left < off) & (left < off).T
    # A force at rest has a potential, unless something else acts: then it is not symmetric, by more than rounding.
    alike = np.abs(found - found.T) <= left + left.T
    found, left = np.where(alike, (found + found.T) / 2.0, found), np.where(alike, np.fmax(left, left.T), left)
    return np.where(taken, found, stiffness), np.where(taken, left, off)


def is_hidden(mass: NDArray[np.float64], known: _Known, rounding: NDArray[np.float64]) -> bool:
    """Whether a rounding of K is more than that of K itself: then level directions may not be level.

    `known` is K (n, n) and what it is at places (S, n, n) some way off, lest it be none.
    """
    stiffness, farther_off = known
    roots = np.sqrt(np.abs(np.diag(mass)))
    units = np.where(roots > 0.0, roots, 1.0)
    every = np.abs(np.concatenate([stiffness[None], farther_off]))
    most = (np.where(every > rounding, every, 0.0).max(axis=0) / units / units[:, None]).max(initial=0.0)
    return bool((rounding / units / units[:, None] > _OWN * _EPSILON * most).any())


def _better(known: _Known, other: _Known) -> _Known:
    """Give the better known of two, where they agree."""
    better = (other[1] < known[1]) & (np.abs(other[0] - known[0]) <= other[1] + known[1])
    return np.where(better, other[0], known[0]), np.where(better, other[1], known[1])


def _at_distance(
    forces: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    place: NDArray[np.float64],
    size: NDArray[np.float64],
    level: int,
) -> _Known | None:
    """K by central differences, and how far they differ; nothing where a force is not a number."""
    n = len(place)
    steps = (2.0**level * _DIGITS)[:, None, None] * np.diag(size)
    ahead, behind = place + steps, place - steps
    apart = np.einsum("djj->dj", ahead - behind)
    if not apart.all():
        return None
    both = forces(np.concatenate([ahead, behind]).reshape(-1, n))
    if not np.isfinite(both).all():
        return None
    beyond, before = both.reshape(2, len(_DIGITS), n, n)
    # Of each digit and coordinate j the forces i.
    found = ((before - beyond) / apart[:, :, None]).transpose(0, 2, 1)
    middle = found.mean(axis=0)
    parts = np.abs(place) / apart.min(axis=0) + 1.0
    return middle, _UNSEEN * np.ptp(found, axis=0) + _ROUNDINGS * _EPSILON * np.abs(middle) * parts


def __dir__() -> list[str]:
    return list(__all__)
