"""Equilibria of Hamiltonian systems: states at which neither coordinates nor momenta change.

The one idea: where Newton's method leads the Lagrangian tells of small motions. Of what has none eigenvalues of the
derivatives of the rates do; where they leave H level to second order, a minimum or a maximum of any order is stable.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._equilibria import Equilibrium, equilibrium_at
from visviva.generalized._hamiltonian_at_rest import at_zeros_of_forces, forces_at_rest, states_at_rest
from visviva.generalized._higher_orders import Energy, curvatures, rises
from visviva.generalized._kinks import with_limits
from visviva.generalized._level_directions import falls_farther_off
from visviva.generalized._matrices import LAST_DIGITS, Sizes, balanced_units, nudges
from visviva.generalized._multiple_zeros import is_simple, left_open, round_off, told_apart
from visviva.generalized._newton import Scales, rates_and_slopes, reached, scales_of
from visviva.generalized._other_sizes import AtRest, with_other_sizes
from visviva.generalized._probe import terms_of
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

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._higher_orders import Curvatures
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["FOUND", "fixed_points", "rounding_of_slopes", "slopes_at"]

#: Eigenvalues whose real parts are below this part of the largest are imaginary; such equal ones need as many vectors.
_ON_THE_AXIS = 1e-7
#: What part of what momenta do the last digits of a state make at a pole.
_MADE_OF_THEM = 0.1
#: States are found to this part of their sizes.
FOUND = SAME


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

    energy = _energy(system)

    def balanced(places: NDArray[np.float64]) -> NDArray[np.bool_]:
        states, known = states_at_rest(system, places)
        rounding = np.zeros(len(places), dtype=bool)
        small = round_off(energy, states, np.abs(states).max(axis=1, keepdims=True))
        rounding[known] = small.all(axis=1)
        return rounding

    asked = AtRest(
        lambda places: forces_at_rest(system, places),
        balanced,
        lambda places: fixed_points(system, states_at_rest(system, places)[0]),
    )
    found = with_other_sizes(system, asked, is_angle, found)
    return sorted(found, key=lambda each: (*each.position, *each.momentum))


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
    energy = _energy(system)
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
    told = [_of_lagrangian(of, place, size[:n]) for place in places]
    return [
        _equilibrium(system, energy, place, scales) if each is None else each
        for each, place in zip(told, places, strict=True)
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
        return not bool((np.abs(there - here) <= _MADE_OF_THEM * np.abs(here).max(axis=1, keepdims=True)).all())


def _forces(system: Hamiltonian, states: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rates of momenta (S, n) at states, and their derivatives by coordinates (S, n, n)."""
    n = states.shape[1] // 2
    rates, slopes = rates_and_slopes(system, states)
    return rates[:, n:], slopes[:, n:, :n]


def _equilibrium(system: Hamiltonian, energy: Energy, state: NDArray[np.float64], scales: Scales) -> Equilibrium:
    n = len(system.coordinates)
    slopes, (units, size, _) = slopes_at(system, state), scales
    others = np.abs(slopes) * (1.0 - np.eye(len(state)))
    if np.isfinite(slopes).all() and others.any(axis=0).all() and others.any(axis=1).all():
        # Slopes where the search began may be of quite another size.
        units = balanced_units(slopes[None])[0]
    if not np.isfinite(slopes).all():
        raise InvalidInput(
            "H",
            f"expected rates that have derivatives at the equilibrium {state.round(6).tolist()}, and they have none: "
            "there is a kink, as that of |q|; round it off, as by sqrt(q² + width²), or look elsewhere by near",
        )
    # Of rates with forces that no function has, nothing but the linear equations tells.
    second, found_to = _second(slopes[None])[0], FOUND * size
    left = left_open(energy, state, size, units)
    if left is None:
        found_to = np.fmin(found_to, _left_by_rounding(energy, state, second))
    elif is_simple(energy, np.stack([state, state + left, state - left]), units):
        left, found_to = None, LAST_DIGITS * size
    off = np.abs(_second(rounding_of_slopes(system, state, found_to, slopes)[None])[0])
    if left is not None:
        beside = energy.slopes(np.stack([state + left, state - left]))[1]
        off = np.fmax(off, np.abs(beside - second).max(axis=0))
    about = curvatures(np.where(np.abs(second) > off, second, 0.0), off)
    level = about is not None and bool((about.values == 0.0).any())
    if about is not None and level:
        scaled = about.vectors * about.sizes[:, None]
        slopes = _rates_of((scaled * about.values) @ scaled.T * about.sizes * about.sizes[:, None])
    values, vectors = np.linalg.eig(slopes * units / units[:, None])
    largest = np.abs(values).max(initial=0.0)
    # A pair of zeros that are level is told by half of the digits.
    least = _ON_THE_AXIS * largest if level else 0.0
    frequencies = np.sort(np.abs(values.imag[values.imag > least]))
    stable = bool((values.real <= _ON_THE_AXIS * largest).all())
    if stable and not (values.real < -_ON_THE_AXIS * largest).all():
        by_energy = _by_energy(energy, state, about, off, size) if about is not None and level else None
        # A coordinate that runs away by itself has an eigenvalue 0 without a vector of its own.
        own = bool(largest > 0.0) and bool(np.linalg.svd(vectors, compute_uv=False)[-1] > _ON_THE_AXIS)
        stable = own if by_energy is None else by_energy
    return Equilibrium(state[:n], stable, frequencies, state[n:])


def slopes_at(
    system: Hamiltonian, state: NDArray[np.float64], parameters: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """Derivatives of the rates (2n, 2n) at a state, and what they come to where their formulas have none."""
    width = len(state)

    def evaluate(states: NDArray[np.float64]) -> NDArray[np.float64]:
        rates, slopes = rates_and_slopes(system, states, parameters)
        return np.concatenate([rates, slopes.reshape(len(states), -1)], axis=1)

    return with_limits(evaluate, state, width)[width:].reshape(width, width)


def _left_by_rounding(energy: Energy, state: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far (2n) a state may be from where all rates vanish, as far as they tell; without end where H is level."""
    try:
        inverse = np.linalg.inv(second)
    except np.linalg.LinAlgError:
        return np.full(len(state), np.inf)
    made_of = np.abs(second) @ np.abs(state) + energy.sizes(state[None])[0]
    left: NDArray[np.float64] = np.abs(inverse) @ (np.abs(energy.slopes(state[None])[0][0]) + LAST_DIGITS * made_of)
    return left


def _second(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give ∂²H (S, 2n, 2n) of the derivatives of rates J ∂H."""
    n = slopes.shape[-1] // 2
    return np.concatenate([-slopes[:, n:], slopes[:, :n]], axis=1)


def _rates_of(second: NDArray[np.float64]) -> NDArray[np.float64]:
    n = len(second) // 2
    return np.concatenate([second[n:], -second[:n]])


def rounding_of_slopes(
    system: Hamiltonian, state: NDArray[np.float64], found_to: NDArray[np.float64], slopes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give what a state (2n) found to so much and the last digits of parameters make of derivatives of rates."""
    off = LAST_DIGITS * np.abs(slopes)
    n = len(state)
    for signs in nudges(n + len(system._values)):
        other = slopes_at(system, state + found_to * signs[:n], system._values * (1.0 + LAST_DIGITS * signs[n:]))
        off = np.fmax(off, np.abs(other - slopes))
    return off


def _energy(system: Hamiltonian) -> Energy:
    n = len(system.coordinates)
    c = Calculus(system)
    (row,) = c.with_derivatives(c.of_system("function"))
    sums = [terms_of(c, [each]) for each in row[1 : 1 + 2 * n]]

    def slopes(states: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rates, derivatives = rates_and_slopes(system, states)
        return np.concatenate([-rates[:, n:], rates[:, :n]], axis=1), _second(derivatives)

    def sizes(states: NDArray[np.float64]) -> NDArray[np.float64]:
        times = np.full(len(states), system.t0)
        found = [
            np.abs(c.values(each, times, states, system._values)).sum(axis=1) if each else np.zeros(len(states))
            for each in sums
        ]
        return np.stack(found, axis=1)

    return Energy(slopes, sizes)


def _by_energy(
    energy: Energy, state: NDArray[np.float64], about: Curvatures, off: NDArray[np.float64], size: NDArray[np.float64]
) -> bool | None:
    """Whether H has a minimum or a maximum where it is level to second order; nothing if that is not known.

    Where it stays level are equilibria, too: that a motion drifts along them does not count, as along a coordinate that
    nothing depends on.
    """
    known = set(np.sign(about.values[about.values != 0.0]))
    if len(known) > 1:
        return None
    beside = set(rises(energy, state, about, off))
    if {-1.0, 1.0} <= known | beside:
        return False
    # Nothing that is seen is not yet nothing that is there.
    falls = 0.0 in beside and falls_farther_off(energy, state, about, size, -1.0 if -1.0 in known | beside else 1.0)
    return None if falls else True
