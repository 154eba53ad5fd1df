"""Equilibria of Hamiltonian systems: states at which neither coordinates nor momenta change.

The one idea: where Newton's method leads the Lagrangian tells of small motions; of what has none, its own rates do.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput
from visviva.generalized._continua import Ground, some_of_each
from visviva.generalized._equilibria import MADE_OF_THEM, Equilibrium, asked_at_rest, equilibrium_at
from visviva.generalized._hamiltonian_at_rest import at_zeros_of_forces, forces_at_rest, states_at_rest
from visviva.generalized._matrices import LAST_DIGITS, Sizes
from visviva.generalized._multiple_zeros import open_about, round_off, told_apart
from visviva.generalized._newton import rates_and_slopes, reached, scales_of
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
from visviva.generalized._stability_by_momenta import energy_of, equilibrium_by_momenta

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["fixed_points"]


def fixed_points(system: Hamiltonian, near: ArrayLike | None) -> list[Equilibrium]:
    """Equilibria of a Hamiltonian, from starts (S, 2n) or from a search over a turn and momenta as large."""
    n = len(system.coordinates)
    if not system.autonomous:
        raise InvalidInput(
            "H",
            "expected equations that do not depend on the time, which have equilibria; see flow_jacobian over a period",
        )
    if near is not None:
        states = np.atleast_2d(float_array("near", near, None))
        if states.shape[1] != 2 * n:
            raise InvalidInput(
                "near", f"expected states of {n} coordinates and momenta, got an array of shape {states.shape}"
            )
        sizes = np.abs(states[:, :n]).max(axis=1, initial=0.0)
        return by_sizes(system, states, sizes, lambda group: _found(system, group, None))
    first = place_at_start(system)
    at_rest, _ = states_at_rest(system, np.concatenate([starts_of_a_search(n), first[None]]))
    moved = np.concatenate([turned(first), np.zeros((3 * n, n))], axis=1)
    is_angle = angles(*_forces(system, moved))
    found = _found(system, np.concatenate([starts_of_a_search(2 * n), at_rest]), within(first, is_angle))

    asked = _asked(system, _by_velocities(system))
    found = with_other_sizes(system, asked, is_angle, found)
    found = some_of_each(Ground(asked.forces, asked.balanced, distinguishing_coordinates(system)), found)
    return sorted(found, key=lambda each: (*each.position, *each.momentum))


def _asked(system: Hamiltonian, of: tuple[Lagrangian, Sizes] | None) -> AtRest:
    """Give what is asked at rest: of the Lagrangian, whose forces are without what momenta add and take away again."""
    return _asked_by_momenta(system) if of is None else asked_at_rest(of[0])


def _asked_by_momenta(system: Hamiltonian) -> AtRest:
    """Give what a search among lengths of all sizes asks of a Hamiltonian that no Lagrangian tells of."""
    energy = energy_of(system)

    def balanced(places: NDArray[np.float64]) -> NDArray[np.bool_]:
        states, known = states_at_rest(system, places)
        rounding = np.zeros(len(places), dtype=bool)
        small = round_off(energy, states, np.abs(states).max(axis=1, keepdims=True))
        rounding[known] = small.all(axis=1)
        return rounding

    def left_open(each: Equilibrium) -> NDArray[np.float64]:
        state = np.concatenate([each.position, each.momentum])
        scales = scales_of(system, state[None])
        return open_about(energy, state, scales.sizes, scales.units, len(each.position))

    return AtRest(
        lambda places: forces_at_rest(system, places),
        balanced,
        left_open,
        lambda places: fixed_points(system, states_at_rest(system, places)[0]),
    )


def _found(system: Hamiltonian, states: NDArray[np.float64], most: NDArray[np.float64] | None) -> list[Equilibrium]:
    """Equilibria from starts (S, 2n) of about one size, or of those with coordinates up to most (n)."""
    n = len(system.coordinates)
    looked_at = np.abs(states).max(axis=0)
    scales = scales_of(system, states)
    starts = states
    states, begun = reached(system, starts, scales)
    without = np.setdiff1d(np.arange(len(starts)), begun)
    if most is None and len(without):
        states = np.concatenate([states, reached(system, starts[without], scales, descending=True)[0]])
    distinguishing = np.concatenate([distinguishing_coordinates(system), np.ones(n, dtype=bool)])
    if most is not None:
        states = at_zeros_of_forces(system, states, np.where(looked_at > 0.0, looked_at, 1.0))
        if distinguishing[:n].any() and not is_free(_forces(system, starts)):
            states = states[where_something_acts(lambda at: _forces(system, at), states, n)]
        # All places along a cyclic coordinate are alike, and angles beyond a turn are the same.
        states[:, ~distinguishing] = 0.0
        states = states[(np.abs(states[:, :n]) <= most).all(axis=1)]
    size = np.maximum(looked_at, np.abs(states).max(axis=0, initial=0.0))
    size[size == 0.0] = 1.0
    states = np.where(np.abs(states) < 1e-14 * size, 0.0, states)
    places: list[NDArray[np.float64]] = []
    while len(states):
        places.append(states[0])
        states = states[((np.abs(states - states[0]) > SAME * size) & distinguishing).any(axis=1)]
    energy = energy_of(system)
    places = sorted(told_apart(energy, places, size, lambda _: scales.units), key=tuple)
    if most is not None:
        # At a pole of the coordinates H is singular, and what has no momentum there may go anywhere.
        regular = [place for place in places if not _is_pole(system, place)]
        if places and not regular:
            raise InvalidInput(
                "H",
                f"the rates vanish at {places[0][:n].round(6).tolist()}, where H is singular, as at the pole of "
                "spherical coordinates: these cannot describe small motions there; use others, such as x and y",
            )
        places = regular
    of = _by_velocities(system)
    asked = _asked(system, of)
    ground, every = Ground(asked.forces, asked.balanced, distinguishing[:n]), np.array(places).reshape(-1, 2 * n)
    if most is not None:
        every = every[ground.some(every[:, :n], size[:n])]
    every, directions = ground.judged(every, size[:n])
    told = [_of_lagrangian(of, place, size[:n]) for place in every]
    return [
        replace(equilibrium_by_momenta(system, energy, place, scales) if each is None else each, continuum=goes_on)
        for each, place, goes_on in zip(told, every, directions.tolist(), strict=True)
    ]


def _by_velocities(system: Hamiltonian) -> tuple[Lagrangian, Sizes] | None:
    """Give the Lagrangian, whose energy at rest is known without what momenta of rest add to it and take away again."""
    try:
        of = system.lagrangian()
    except InvalidInput:
        return None
    return of, Sizes(of)


def _of_lagrangian(
    of: tuple[Lagrangian, Sizes] | None, state: NDArray[np.float64], size: NDArray[np.float64]
) -> Equilibrium | None:
    """Give the equilibrium at a state (2n) as the Lagrangian has it; nothing where that has none."""
    if of is None:
        return None
    n = len(size)
    try:
        found = equilibrium_at(*of, state[:n], size)
    except InvalidInput:
        return None
    return replace(found, momentum=state[n:])


def _is_pole(system: Hamiltonian, state: NDArray[np.float64]) -> bool:
    """Tell whether a momentum moves its coordinate beyond all bounds there, but for what the last digits make of it."""
    n = len(system.coordinates)
    beside = np.stack([state, state * (1.0 + LAST_DIGITS)])
    with np.errstate(invalid="ignore"):
        here, there = rates_and_slopes(system, beside)[1][:, :n, n:]
        return not bool((np.abs(there - here) <= MADE_OF_THEM * np.abs(here).max(axis=1, keepdims=True)).all())


def _forces(system: Hamiltonian, states: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rates of momenta (S, n) at states, and their derivatives by coordinates (S, n, n)."""
    n = states.shape[1] // 2
    rates, slopes = rates_and_slopes(system, states)
    return rates[:, n:], slopes[:, n:, :n]


def __dir__() -> list[str]:
    return list(__all__)
