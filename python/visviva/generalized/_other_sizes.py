"""Equilibria of coordinates that are lengths: those farther off than a turn, and those much closer together.

The one idea: nobody knows the unit of a length, so that Newton's method runs from a few starts of each power of ten,
each judged by itself. Where some come to a place that has forces all around, more starts are worth their while.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._newton import steps_to_zeros
from visviva.generalized._searches import distinguishing_coordinates, starts_of_a_search
from visviva.generalized._valleys import SMALL_STEPS

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.generalized._equilibria import Equilibrium
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["AtRest", "with_other_sizes"]

#: Sizes of lengths that are looked at: beside 1, smaller or larger ones leave no digit of either in a sum. What is
#: within √10 of a power of ten is of that size, so that every length is of one.
_SIZES = 10.0 ** np.arange(-15.0, 16.0)
_HALF_WAY = 10.0**0.5
#: Starts at each, until something is found there: at all sizes together as many as a search over a turn has, some 3000.
_FEW = 96
#: Equilibria of more sizes than this, or more of one, are those of what goes on and on: cos(x) has some at each of the
#: 16 sizes from 1 on, and of what is built of a few lengths each is of its own.
_MOST_SIZES = 4
_MOST = 100
#: Of a curve of them so many are told at most, as one looks at a circle every 15°. On it this part of the largest
#: stiffness is none: places that Newton's steps come to are off by far less, and what is softer has no sharp zero.
_MOST_OF_A_CURVE = 24
_LEVEL = 1e-6
#: Newton's steps from starts of the right size, and what part of that the last one may be. They halve the distance from
#: a double zero, so that it takes some 33 of them; from a simple one that step has squared it to less than rounding,
#: 1e-20.
_STEPS = 40
_ARRIVED = 1e-10
#: Forces are looked at this part of the size aside, where they are not those of a zero by rounding: a force of sixth
#: order is seen there, 1e-12 of what it is at the whole size.
_ASIDE = 1e-2
#: Places are one that differ by less than this part of their sizes: a double zero is where its force is round-off,
#: 1e-16, within the root of that, 1e-8; that a hundred times.
_ONE = 1e-6
#: What is nearer to a place than this part of its size may be that one, within so much of what forces leave open: each
#: of the two may be off by that, and it by a factor of 2. Forces leave 1/128 open at most, which so often is less than
#: this.
_BESIDE = 0.1
_LEFT_OPEN = 4.0
#: Coordinates that are this part of others may be what rounding has left of 0: 45 units in the last place, of sums of
#: as many numbers.
_ROUNDED = 1e-14


class AtRest(NamedTuple):
    """What is asked of a system at rest.

    Forces (S, n) and minus their derivatives (S, n, n) at places (S, n); at which places (S) all forces are round-off,
    not where they are no numbers; how far each coordinate (n) may be from an equilibrium until forces are seen; and the
    equilibria that are reached from places.
    """

    forces: Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
    balanced: Callable[[NDArray[np.float64]], NDArray[np.bool_]]
    left_open: Callable[[Equilibrium], NDArray[np.float64]]
    near: Callable[[NDArray[np.float64]], list[Equilibrium]]


def with_other_sizes(
    system: Lagrangian | Hamiltonian, at_rest: AtRest, is_angle: NDArray[np.bool_], known: list[Equilibrium]
) -> list[Equilibrium]:
    """Equilibria that are known, and those at lengths of any other size."""
    distinguishing = distinguishing_coordinates(system)
    lengths = distinguishing & ~is_angle
    if not lengths.any():
        return known
    which = (lengths, distinguishing)
    over_a_turn = starts_of_a_search(len(lengths))
    some = over_a_turn[:: max(1, len(over_a_turn) // _FEW)]

    def found_from(starts: NDArray[np.float64], sizes: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        """Places (R, n) where forces vanish, of each size, from starts that are scaled to it."""
        every, tiled = np.repeat(sizes, len(starts)), np.tile(starts, (len(sizes), 1))
        scaled = np.where(lengths, tiled * (every * _HALF_WAY / np.pi)[:, None], tiled)
        # All places along a coordinate that nothing depends on are alike.
        scaled[:, ~distinguishing] = 0.0
        places, every = _arrived(at_rest, scaled, every, which)
        return [_different(places[every == size]) for size in sizes.tolist()]

    # A search among larger places may have told some less exactly than forces there do.
    balanced = at_rest.balanced(_places_of(known, len(lengths)))
    exactly = [each for each, is_balanced in zip(known, balanced.tolist(), strict=True) if is_balanced]
    hits, crowded = [], 0
    curves: list[NDArray[np.float64]] = []
    sizes: list[float] = []
    for size, places in zip(_SIZES.tolist(), found_from(some, _SIZES), strict=True):
        # Zero is of all sizes; it counts beside another.
        away = places[:, lengths].any(axis=1)
        new = places[away & ~_are_among(places, exactly, _ONE)]
        if len(new) > _FEW // 2:
            # Every start comes to a place of its own, on a curve, of which some are told, or next to each other.
            crowded += 1
            if _are_level(new, size, at_rest, which):
                curves += [new[:: 1 + len(new) // _MOST_OF_A_CURVE], places[~away]]
                sizes.append(size)
        elif len(_told_apart(new, exactly, at_rest)):
            hits.append(size)
            sizes.append(size)
    if not sizes or len(hits) + crowded > _MOST_SIZES:
        return known
    places = np.concatenate([*found_from(over_a_turn, np.array(hits)), *curves])
    # What is zero for a search among large places may be known better.
    for each in known:
        if np.abs(each.position[lengths]).max() <= _ARRIVED * max(sizes):
            turned = np.abs(places - each.position)[:, distinguishing & is_angle].max(axis=1, initial=0.0)
            places = places[places[:, lengths].any(axis=1) | (turned > _ONE)]
    if len(places) > _MOST:
        return known
    try:
        found = at_rest.near(places)
    except InvalidInput:
        # What is told of places is told of none of these.
        return known
    # What goes on to zero from there, slowly as to a zero of higher order, is that.
    far = [float(np.abs(each.position[lengths]).max()) for each in found]
    stays = [size == 0.0 or any(0.1 * hit <= size <= 10.0 * hit for hit in sizes) for size in far]
    found = [each for each, at_its_size in zip(found, stays, strict=True) if at_its_size]
    again = _are_among(_places_of(known, len(lengths)), found, _ONE)
    return found + [each for each, told in zip(known, again.tolist(), strict=True) if not told]


def _arrived(
    at_rest: AtRest,
    places: NDArray[np.float64],
    sizes: NDArray[np.float64],
    which: tuple[NDArray[np.bool_], NDArray[np.bool_]],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where Newton's method comes to from places (S, n) of sizes (S), if it stays at that size, and the sizes.

    What comes to zero is of any size, as the hill between two small wells is. `which` has the lengths among the
    coordinates, and those on which anything depends.
    """
    lengths, moving = which
    arrived, of_sizes = [], []
    small = np.zeros(len(places), dtype=int)
    for _ in range(_STEPS):
        with np.errstate(all="ignore"):
            forces, stiffness = at_rest.forces(places)
            step = np.zeros(places.shape)
            step[:, moving] = steps_to_zeros(forces[:, moving], stiffness[:, moving][:, :, moving])
            known = np.isfinite(step).all(axis=1)
            places, sizes, step, small = places[known], sizes[known], step[known], small[known]
            if not len(places):
                break
            units = np.where(lengths, sizes[:, None], 1.0)
            length = np.abs(step / units).max(axis=1)
            places = places + step / np.fmax(length, 1.0)[:, None]
            far = np.abs(places[:, lengths]).max(axis=1)
        small = np.where(length <= _ARRIVED, small + 1, 0)
        there = (small >= SMALL_STEPS) | (length == 0.0)
        arrived.append(places[there])
        of_sizes.append(sizes[there])
        going = ~there & (far <= 10.0 * sizes)
        places, sizes, small = places[going], sizes[going], small[going]
    places, sizes = np.concatenate([*arrived, places[:0]]), np.concatenate([*of_sizes, sizes[:0]])
    far = np.abs(places[:, lengths]).max(axis=1, initial=0.0)
    zero = far <= _ARRIVED * sizes
    places[(zero[:, None] | (np.abs(places) <= _ROUNDED * sizes[:, None])) & lengths] = 0.0
    own = zero | ((far * _HALF_WAY > sizes) & (far <= sizes * _HALF_WAY))
    own[own] &= at_rest.balanced(places[own])
    places, sizes = places[own], sizes[own]
    for axis in np.flatnonzero(lengths):
        aside = np.zeros(places.shape)
        aside[:, axis] = _ASIDE * sizes
        rounding = at_rest.balanced(places + aside) | at_rest.balanced(places - aside)
        places, sizes = places[~rounding], sizes[~rounding]
    return places, sizes


def _different(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each of these (R, n) once."""
    found, sizes = [], _sizes_of(np.abs(places).max(axis=0, initial=0.0))
    while len(places):
        found.append(places[0])
        places = places[(np.abs(places - places[0]) > _ONE * sizes).any(axis=1)]
    return np.array(found).reshape(-1, len(sizes))


def _are_among(places: NDArray[np.float64], others: list[Equilibrium], within: float) -> NDArray[np.bool_]:
    """Which places (R, n) are those of others, within this part of the size of each coordinate."""
    found = np.zeros(len(places), dtype=bool)
    for each in others:
        sizes = _sizes_of(np.fmax(np.abs(places), np.abs(each.position)))
        found |= (np.abs(places - each.position) <= within * sizes).all(axis=1)
    return found


def _places_of(found: list[Equilibrium], n: int) -> NDArray[np.float64]:
    return np.array([each.position for each in found]).reshape(-1, n)


def _told_apart(places: NDArray[np.float64], known: list[Equilibrium], at_rest: AtRest) -> NDArray[np.float64]:
    """Places (R, n) that forces tell from those that are known."""
    for each in known:
        apart = np.abs(places - each.position)
        if (apart.max(axis=1) <= _BESIDE * np.abs(each.position).max(initial=0.0)).any():
            places = places[(apart > _LEFT_OPEN * at_rest.left_open(each)).any(axis=1)]
    return places


def _are_level(
    places: NDArray[np.float64], size: float, at_rest: AtRest, which: tuple[NDArray[np.bool_], NDArray[np.bool_]]
) -> bool:
    """Whether at all places (R, n) of a size there is a direction without a force: together they are a curve."""
    lengths, moving = which
    units = np.where(lengths, size, 1.0)[moving]
    stiffness = at_rest.forces(places)[1][:, moving][:, :, moving] * units * units[:, None]
    values = np.linalg.svd(stiffness, compute_uv=False)
    return bool((values[:, -1] <= _LEVEL * values[:, 0]).all())


def _sizes_of(largest: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sizes of coordinates by their largest values (…, n): what is but rounding beside another has none of its own."""
    sizes: NDArray[np.float64] = np.fmax(largest, _ROUNDED * largest.max(axis=-1, initial=0.0, keepdims=True))
    return sizes
