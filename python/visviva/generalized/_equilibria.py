"""Equilibria: where a system stays, found from many starts, each told once.

The one idea: Newton's method runs from places all over a turn. What it reaches is kept where forces are balanced, and
two places are one where they differ by round-off, or along a coordinate that nothing depends on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._analysis import free_matrices, linearization, linearization_of
from visviva.generalized._constrained_motions import Constrained
from visviva.generalized._continua import Ground, GroundOnConstraints, some_of_each
from visviva.generalized._higher_orders import curvatures
from visviva.generalized._level_directions import stays
from visviva.generalized._matrices import LAST_DIGITS, Sizes, matrices, matrices_along
from visviva.generalized._multiple_zeros import at_rest, open_about, round_off, settled, units
from visviva.generalized._other_sizes import AtRest, with_other_sizes
from visviva.generalized._searches import (
    SAME,
    angles,
    by_sizes,
    distinguishing_coordinates,
    is_free,
    place_at_start,
    starts_of_a_search,
    turned,
    where_something_acts,
    within,
)
from visviva.generalized._valleys import ends_of_valleys

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["MADE_OF_THEM", "Equilibrium", "asked_at_rest", "equilibria", "equilibrium_at"]

#: Places that differ by less than this many times what forces leave open are one.
_ONE = 4.0
#: On constraints equilibria are looked for as far as starts reach, which come near the ends of a circle.
_BEYOND_STARTS = 1.1
#: What part of a mass matrix, or of what momenta do, the last digits of a place make where it has none.
MADE_OF_THEM = 0.1


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Equilibrium(Record):
    """A place where the system stays.

    Units: those of the system.

    Attributes
    ----------
    position : ndarray, shape (n,)
    stable : bool or None
        Whether small motions about it stay small, as the linear equations tell, and the energy where these leave a
        direction level: at a minimum of any order they do, where it falls they do not. A drift along places that are
        all equilibria, as of what may be moved as a whole, does not count. None where rounding hides it: of a
        Hamiltonian that no Lagrangian tells of, in fields so strong that what momenta add leaves no digits of the
        rest. Write it in differences as p − A(q), not multiplied out, and these are told.
    frequencies : ndarray, shape (at most n,)
        Angular frequencies of small oscillations, ascending, in radians per time.
    momentum : ndarray, shape (n,)
        The momenta there, which need not be zero.
    continuum : int
        In how many directions other equilibria go on from there: 0 of one by itself, 1 on a curve of them, 2 on a
        surface, and 1 where curves cross, or surfaces. What may be moved along coordinates that nothing depends on is
        not counted. On constraints only a search without `near` tells it.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 6.1–6.3.

    Examples
    --------
    >>> import visviva as vv
    >>> [(round(float(e.position[0]), 6), e.stable) for e in vv.systems.pendulum().equilibria()]
    [(-3.141593, False), (0.0, True), (3.141593, False)]
    """

    position: NDArray[np.float64]
    stable: bool | None
    frequencies: NDArray[np.float64]
    momentum: NDArray[np.float64]
    continuum: int = 0


def equilibria(system: Lagrangian, near: ArrayLike | None) -> list[Equilibrium]:
    """Equilibria of a Lagrangian, from starts or from a grid of them over a turn."""
    n = len(system.coordinates)
    if near is not None:
        starts = np.atleast_2d(float_array("near", near, None))
        if starts.shape[1] != n:
            raise InvalidInput("near", f"expected places of {n} coordinates, got an array of shape {starts.shape}")
        sizes = np.abs(starts).max(axis=1, initial=0.0)
        if system._constraints():
            return by_sizes(system, starts, sizes, lambda group: _of_constrained(system, group, everywhere=False))
        return by_sizes(system, starts, sizes, lambda group: _found(system, group, None))
    starts, first = starts_of_a_search(n), place_at_start(system)
    if system.position is not None:
        starts = np.concatenate([starts, first[None, :]])
    if system._constraints():
        return _of_constrained(system, starts, everywhere=True)
    is_angle = angles(*matrices_along(system, turned(first)))
    found = _found(system, starts, within(first, is_angle))
    found = with_other_sizes(system, asked_at_rest(system), is_angle, found)
    found = some_of_each(_ground(system), found)
    return sorted(found, key=lambda each: tuple(each.position))


def asked_at_rest(system: Lagrangian) -> AtRest:
    """Give what a search among lengths of all sizes asks of a Lagrangian without constraints."""
    energy = at_rest(system, Sizes(system))

    def balanced(places: NDArray[np.float64]) -> NDArray[np.bool_]:
        small = round_off(energy, places, np.abs(places).max(axis=1, keepdims=True))
        rounding = np.zeros(len(places), dtype=bool)
        rounding[:] = small.all(axis=1)
        return rounding

    def left_open(each: Equilibrium) -> NDArray[np.float64]:
        size = np.full(len(each.position), np.abs(each.position).max())
        return open_about(energy, each.position, size, units(system, each.position), len(size))

    return AtRest(
        lambda places: matrices_along(system, places), balanced, left_open, lambda places: equilibria(system, places)
    )


def _ground(system: Lagrangian) -> Ground:
    asked = asked_at_rest(system)
    return Ground(asked.forces, asked.balanced, distinguishing_coordinates(system))


def _found(system: Lagrangian, starts: NDArray[np.float64], most: NDArray[np.float64] | None) -> list[Equilibrium]:
    """Equilibria from starts (S, n) of about one size, or of those with coordinates up to most (n)."""
    n, sizes = len(system.coordinates), Sizes(system)
    reached = _reached(system, starts, sizes, most)
    distinguishing = distinguishing_coordinates(system)
    if most is not None:
        if distinguishing.any() and not is_free(matrices_along(system, starts)):
            reached = reached[where_something_acts(lambda at: matrices_along(system, at), reached, n)]
        # All places along a cyclic coordinate are alike.
        reached[:, ~distinguishing] = 0.0
        reached = reached[(np.abs(reached) <= most).all(axis=1)]
    results: list[Equilibrium] = []
    size = _sizes(np.concatenate([starts, reached]))
    without_mass, without_slopes = [], []
    ground, places = _ground(system), np.array(_once(reached, starts, distinguishing)).reshape(-1, n)
    if most is not None:
        places = places[ground.some(places, size)]
    places, directions = ground.judged(places, size)
    for place, goes_on in zip(places, directions.tolist(), strict=True):
        if _mass_is_singular(system, place):
            without_mass.append(place)
            continue
        try:
            results.append(replace(equilibrium_at(system, sizes, place, size), continuum=goes_on))
        except InvalidInput as refusal:
            if not all(np.isfinite(part).all() for part in matrices(system, place)):
                without_slopes.append(refusal)
            # Else Newton's method has stopped where forces are left.
    if without_slopes and not results:
        raise without_slopes[0]
    if without_mass and not results:
        raise InvalidInput(
            "L",
            f"the forces vanish at {without_mass[0].round(6).tolist()}, where the mass matrix is singular, as at the "
            "pole of spherical coordinates: these cannot describe small motions there; use others, such as x and y",
        )
    return results


def equilibrium_at(
    system: Lagrangian, sizes: Sizes, place: NDArray[np.float64], size: NDArray[np.float64]
) -> Equilibrium:
    """Give the equilibrium at a place (n) among others of a size (n), or refuse what is none."""
    small = linearization(system, place, sizes)
    momentum = system.at(position=place, velocity=np.zeros(len(place))).momentum
    stable = stays(free_matrices(small), at_rest(system, sizes), place, size)
    return Equilibrium(place, stable, small.frequencies, momentum)


def _once(
    reached: NDArray[np.float64], starts: NDArray[np.float64], distinguishing: NDArray[np.bool_]
) -> list[NDArray[np.float64]]:
    """Each place (R, n) once, in order, by the coordinates that tell them apart."""
    # Sizes of coordinates: those of the places that are looked at and found.
    size = _sizes(np.concatenate([starts, reached]))
    # What is 0 but for round-off is shown as such.
    reached = np.where(np.abs(reached) < 1e-14 * size, 0.0, reached)
    places: list[NDArray[np.float64]] = []
    while len(reached):
        places.append(reached[0])
        reached = reached[((np.abs(reached - reached[0]) > SAME * size) & distinguishing).any(axis=1)]
    return sorted(places, key=tuple)


def _sizes(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sizes of coordinates (n) by places (S, n)."""
    size: NDArray[np.float64] = np.abs(places).max(axis=0, initial=0.0)
    size[size == 0.0] = size.max() if size.max() > 0.0 else 1.0
    return size


def _is_one(apart: NDArray[np.float64], left: NDArray[np.float64], distinguishing: NDArray[np.bool_]) -> bool:
    """Whether two places (n) so far apart are one, as far as forces tell and coordinates distinguish them."""
    return not np.any((np.abs(apart) > left) & distinguishing)


def _of_constrained(system: Lagrangian, starts: NDArray[np.float64], *, everywhere: bool) -> list[Equilibrium]:
    """Equilibria on constraints, from starts, or of those within what starts all over a turn reach on them."""
    constrained = Constrained(system)
    rolling = constrained.all > constrained.holonomic
    if everywhere and rolling:
        # Where something rolls, equilibria fill whole surfaces: one is told, next to the start.
        starts = system._start()[None, : len(system.coordinates)]
    reached, far = constrained.reached(starts)
    if everywhere:
        reached = reached[(np.abs(reached) <= np.fmax(np.pi + 1e-6, _BEYOND_STARTS * far)).all(axis=1)]
    n = len(system.coordinates)
    distinguishing = np.ones(n, dtype=bool)
    cyclic = [index for index in system._structure["cyclic"] if constrained.without_any[index]]
    distinguishing[cyclic] = False
    if everywhere:
        reached[:, cyclic] = 0.0
    results, refused = [], []
    apart: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []
    looked_at = np.abs(np.concatenate([starts, reached])).max(axis=0, initial=0.0)
    places = np.array(_once(reached, starts, distinguishing)).reshape(-1, n)
    on_curves = np.zeros(len(places), dtype=bool)
    if everywhere and not rolling:
        told, on_curves = GroundOnConstraints(lambda at: constrained.reached(at)[0]).some_on(places, _sizes(places))
        places, on_curves = places[told], on_curves[told]
    for found, on_curve in zip(places, on_curves.tolist(), strict=True):
        if any(_is_one(found - other, left, distinguishing) for other, left in apart):
            continue
        try:
            place, balance = found, constrained.balance(found, looked_at)
            # Zeros where they may be.
            snapped = np.where(np.abs(place) <= _ONE * balance.left_open, 0.0, place)
            if (snapped != place).any() and constrained.off_balance(snapped) is None:
                place, balance = snapped, constrained.balance(snapped, looked_at)
            small = linearization_of(constrained, place, balance)
        except InvalidInput as refusal:
            refused.append(refusal)
            continue
        apart.append((place, SAME * np.abs(place).max(initial=0.0) + _ONE * balance.left_open))
        free = free_matrices(small)
        if small.tangent is not None and not rolling:
            along = _sizes((np.abs(np.linalg.pinv(small.tangent)) @ looked_at)[None])
            stable = stays(free, constrained.along(place, small.tangent), np.zeros_like(along), along)
        else:
            stable = small.stable and not balance.drifts
        momentum = constrained.free.at(position=place, velocity=np.zeros(n)).momentum
        results.append(Equilibrium(place, stable, small.frequencies, momentum, _level(free) if on_curve else 0))
    if refused and not results:
        raise refused[0]
    return results


def _level(free: tuple[NDArray[np.float64], ...]) -> int:
    """Give how many directions are level, one at least, of what is on a curve, by M, C, K and the rounding of K."""
    _, _, stiffness, rounding = free
    about = curvatures(np.where(np.abs(stiffness) > rounding, stiffness, 0.0), rounding)
    return 1 if about is None else max(1, int(np.count_nonzero(about.values == 0.0)))


def _reached(
    system: Lagrangian, starts: NDArray[np.float64], sizes: Sizes, most: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """Where Newton's method ends (S, n): what its steps tell, and what is nearly told where forces are round-off.

    With coordinates up to most (n); if that is not given, forces may shrink from step to step, from where it comes to
    nothing otherwise.
    """
    n = len(system.coordinates)

    def ends(starts: NDArray[np.float64], *, descending: bool) -> list[tuple[list[float], bool] | None]:
        return system._model.equilibria(system.t0, np.ascontiguousarray(starts), system._values, descending)

    every = ends(starts, descending=False)
    without = [index for index, each in enumerate(every) if not (each and each[1])]
    if most is None and without:
        for index, each in zip(without, ends(starts[without], descending=True), strict=True):
            every[index] = each if each and each[1] else every[index]
    found = [each for each in every if each]
    told = np.array([place for place, by_steps in found if by_steps]).reshape(-1, n)
    nearly = np.array([place for place, by_steps in found if not by_steps]).reshape(-1, n)
    if most is not None:
        # Thousands of starts may have run away from each other to where nothing acts.
        distinguishing = distinguishing_coordinates(system)
        near = [(np.abs(each) <= most)[:, distinguishing] for each in (told, nearly)]
        told, nearly = told[near[0].all(axis=1)], nearly[near[1].all(axis=1)]
        if n > 1:
            looked_at = np.abs(starts).max(axis=0)
            looked_at[looked_at == 0.0] = 1.0
            walked = [
                ends_of_valleys(lambda at: matrices_along(system, at), each, looked_at) for each in (told, nearly)
            ]
            told, nearly = (each[(np.abs(each) <= most)[:, distinguishing].all(axis=1)] for each in walked)
    told = settled(system, told, nearly, np.abs(starts).max(axis=0), sizes)
    if not len(told) and not np.isfinite(matrices_along(system, starts)[0]).all(axis=1).any():
        # Forces that have no value at rest, as those of dry friction, are told by name.
        linearization(system, starts[0], sizes)
    return told


def _mass_is_singular(system: Lagrangian, place: NDArray[np.float64]) -> bool:
    """Tell whether a coordinate has no mass at a place, but for what the last digits of the place make of it."""
    masses = [matrices(system, where).mass for where in (place, place * (1.0 + LAST_DIGITS))]
    try:
        for mass in masses:
            np.linalg.inv(mass)
    except np.linalg.LinAlgError:
        return True
    mass, nudged = (np.abs(each).max(axis=1) for each in masses)
    return bool((np.abs(nudged - mass) > MADE_OF_THEM * mass).any())
