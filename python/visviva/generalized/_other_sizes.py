"""Equilibria of coordinates that are lengths: those farther off than a turn, and those much closer together.

The one idea: nobody knows the unit of a length, so that a few starts of each power of ten tell where a search like that
over a turn is worth its while.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._searches import distinguishing_coordinates, starts_of_a_search

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.generalized._equilibria import Equilibrium
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["at_other_sizes"]

#: Sizes of lengths that are looked at, and what is of one.
_SIZES = 10.0 ** np.arange(-15.0, 16.0)
_HALF_WAY = 10.0**0.5
#: Starts at each, until something is found there.
_FEW = 96
#: Equilibria of more sizes than this, or more of one, are those of what goes on and on, as cos(x) does.
_MOST_SIZES = 4
_MOST = 100
#: Places are one that differ by less than this part of their sizes, and the same if by less than that.
_ONE = 1e-6
_SAME = 1e-12


def _different(places: NDArray[np.float64]) -> int:
    """How many of these (R, n) there are."""
    count = 0
    while len(places):
        apart = np.abs(places - places[0]).max(axis=1)
        places = places[apart > _ONE * np.abs(places[0]).max()]
        count += 1
    return count


def _are_among(places: NDArray[np.float64], others: list[Equilibrium], within: float) -> NDArray[np.bool_]:
    """Which places (R, n) are those of others, within this part of their sizes."""
    found = np.zeros(len(places), dtype=bool)
    sizes = np.abs(places).max(axis=1, initial=0.0)
    for each in others:
        found |= np.abs(places - each.position).max(axis=1, initial=0.0) <= within * sizes
    return found


def at_other_sizes(
    system: Lagrangian | Hamiltonian,
    is_angle: NDArray[np.bool_],
    known: list[Equilibrium],
    ends: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    search: Callable[[NDArray[np.float64], NDArray[np.float64]], list[Equilibrium]],
) -> list[Equilibrium]:
    """Equilibria that are known, and those at lengths of any other size.

    `ends` gives the places (R, n) where Newton's method ends from others (S, n); `search` the equilibria from these,
    with coordinates up to most (n).
    """
    lengths = distinguishing_coordinates(system) & ~is_angle
    if not lengths.any():
        return known
    over_a_turn = starts_of_a_search(len(lengths))
    some = over_a_turn[:: max(1, len(over_a_turn) // _FEW)]

    def of_size(places: NDArray[np.float64], size: float) -> NDArray[np.bool_]:
        """Those that are new, and as far off as starts of this size tell."""
        far = np.abs(places[:, lengths]).max(axis=1, initial=0.0)
        own: NDArray[np.bool_] = (
            (far * _HALF_WAY > size) & (far <= size * _HALF_WAY) & ~_are_among(places, known, _SAME)
        )
        return own

    def scaled(starts: NDArray[np.float64], size: float) -> NDArray[np.float64]:
        return np.where(lengths, starts * (size * _HALF_WAY / np.pi), starts)

    hits, crowded = [], 0
    for size in _SIZES.tolist():
        with np.errstate(all="ignore"):
            places = ends(scaled(some, size))
        places = places[of_size(places, size)]
        count = _different(places)
        if count > _FEW // 2:
            # Every start comes to a place of its own, on a curve or next to each other everywhere.
            crowded += 1
        elif count:
            hits.append(size)
    if len(hits) + crowded > _MOST_SIZES:
        return known
    found = known
    for size in hits:
        try:
            reached = search(scaled(over_a_turn, size), scaled(np.full(len(lengths), np.pi + 1e-6), size))
        except InvalidInput:
            # Singular there, as lengths of nothing are.
            continue
        at = _places(reached, len(lengths))
        # Between two wells this small a hill is nothing but zero for a search over a turn.
        own = of_size(at, size) | ((at == 0.0).all(axis=1) & ~_are_among(at, found, _ONE))
        if own.sum() > _MOST:
            return known
        new = [each for each, is_own in zip(reached, own.tolist(), strict=True) if is_own]
        # A search among larger places has told them less exactly.
        again = _are_among(_places(found, len(lengths)), new, _ONE)
        found = [each for each, told in zip(found, again.tolist(), strict=True) if not told] + new
    return found


def _places(equilibria: list[Equilibrium], coordinates: int) -> NDArray[np.float64]:
    return np.array([each.position for each in equilibria]).reshape(-1, coordinates)
