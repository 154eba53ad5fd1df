"""Stability of equilibria of Hamiltonians that no Lagrangian tells of, as those that are not quadratic in the momenta.

The one idea: where momenta follow from velocities beside an equilibrium, there is a Lagrangian beside it, though no
formula of it is known, and the rule of Lagrangians holds. Elsewhere eigenvalues of the derivatives of the rates tell;
where they leave H level to second order, a minimum or a maximum of any order is stable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._equilibria import Equilibrium
from visviva.generalized._hamiltonian_at_rest import forces_at_rest, forces_without_velocity, states_at_rest
from visviva.generalized._higher_orders import Energy, curvatures, rises
from visviva.generalized._kinks import with_limits
from visviva.generalized._level_directions import falls_farther_off, stays
from visviva.generalized._matrices import LAST_DIGITS, Matrices, balanced_units, nudges
from visviva.generalized._multiple_zeros import is_simple, left_open
from visviva.generalized._newton import Scales, rates_and_slopes
from visviva.generalized._probe import terms_of
from visviva.generalized._searches import SAME
from visviva.generalized._stiffness_at_rest import by_differences, is_hidden

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._higher_orders import Curvatures

__all__ = ["FOUND", "energy_of", "equilibrium_by_momenta", "matrices_of_rates", "rounding_of_slopes", "slopes_at"]

#: Eigenvalues whose real parts are below this part of the largest are imaginary; such equal ones need as many vectors.
_ON_THE_AXIS = 1e-7
#: States are found to this part of their sizes.
FOUND = SAME
#: Roundings of what momenta add to a stiffness and take away again, and where, in sizes, others are looked at.
_ROUNDINGS = 16.0 * float(np.finfo(float).eps)
_SOME_WAY = 0.1


def equilibrium_by_momenta(
    system: Hamiltonian, energy: Energy, state: NDArray[np.float64], scales: Scales
) -> Equilibrium:
    """Give the equilibrium at a state (2n) of H, given as its derivatives."""
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
    by_rest = _by_energy_of_rest(system, energy, state, (second, off), size)
    if by_rest is not None:
        return Equilibrium(state[:n], by_rest[0], frequencies, state[n:])
    stable = bool((values.real <= _ON_THE_AXIS * largest).all())
    if stable and not (values.real < -_ON_THE_AXIS * largest).all():
        by_energy = _by_energy(energy, state, about, off, size) if about is not None and level else None
        # A coordinate that runs away by itself has an eigenvalue 0 without a vector of its own.
        own = bool(largest > 0.0) and bool(np.linalg.svd(vectors, compute_uv=False)[-1] > _ON_THE_AXIS)
        stable = own if by_energy is None else by_energy
    return Equilibrium(state[:n], stable, frequencies, state[n:])


def matrices_of_rates(
    rates: NDArray[np.float64], slopes: NDArray[np.float64], unsure: NDArray[np.float64]
) -> tuple[Matrices, NDArray[np.float64]]:
    """Give F, M, C and K of small motions by rates (2n), derivatives of them (2n, 2n) and what these are off, and of K.

    `numpy.linalg.LinAlgError` where ∂²H/∂p² is singular.
    """
    n = len(rates) // 2
    a, b, c, d = slopes[:n, :n], slopes[:n, n:], slopes[n:, :n], slopes[n:, n:]
    mass = np.linalg.inv(b).astype(np.float64)
    by = d @ mass
    of_by = np.abs(by) @ unsure[:n, n:] @ np.abs(mass) + unsure[n:, n:] @ np.abs(mass)
    of_stiffness = unsure[n:, :n] + np.abs(by) @ unsure[:n, :n] + of_by @ np.abs(a)
    return Matrices(rates[n:], mass, -(mass @ a + by), by @ a - c), of_stiffness


def _by_energy_of_rest(
    system: Hamiltonian,
    energy: Energy,
    state: NDArray[np.float64],
    known: tuple[NDArray[np.float64], NDArray[np.float64]],
    size: NDArray[np.float64],
) -> tuple[bool | None] | None:
    """Whether motions stay, by ∂²H and what it may be off (2n, 2n), and the energy where velocities vanish.

    None of it where rounding hides it, and nothing at all where these momenta are not known: where ∂²H/∂p² is singular,
    as far as it is known.
    """
    (second, off), n = known, len(state) // 2
    of_momenta = curvatures(second[n:, n:], off[n:, n:])
    if of_momenta is None or not of_momenta.values.all():
        return None
    about, of_stiffness = matrices_of_rates(np.zeros(2 * n), _rates_of(second), np.abs(_rates_of(off)))

    # So much are momenta of rest others at other places.
    by_places = -about.mass @ second[n:, :n]

    def momenta(places: NDArray[np.float64]) -> NDArray[np.float64]:
        return state[n:] + (places - state[:n]) @ by_places.T

    def exact(places: NDArray[np.float64]) -> NDArray[np.float64]:
        return forces_without_velocity(system, places, momenta(places))

    known_by_momenta = about.stiffness, of_stiffness
    stiffness, rounding = by_differences(exact, state[:n], size[:n], known_by_momenta)
    # All that momenta add is told without them, so that it is zero in forces at rest.
    nothing_added = bool((rounding < of_stiffness)[of_stiffness > 0.0].all())

    def slopes(places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        forces, found = forces_at_rest(system, places, momenta(places))
        found[(places == state[:n]).all(axis=1)] = stiffness
        return -forces, found

    def sizes(places: NDArray[np.float64]) -> NDArray[np.float64]:
        states, index = states_at_rest(system, places, momenta(places))
        made_of = np.full(places.shape, np.nan)
        if nothing_added:
            made_of[index] = np.abs(rates_and_slopes(system, states)[0][:, n:])
            return made_of
        by_momenta = np.abs(energy.slopes(states)[1][:, :n, n:])
        made_of[index] = energy.sizes(states)[:, :n] + np.einsum("sij,sj->si", by_momenta, np.abs(states[:, n:]))
        return made_of

    at_rest = Energy(slopes, sizes)
    # What differences cannot tell momenta may hide, though no more of it than the rounding of what they add.
    farther_off = np.abs(slopes(np.concatenate([state[:n] + _SOME_WAY * np.diag(size[:n]), state[None, :n]]))[1])
    added = _ROUNDINGS * np.abs(second[:n, n:]) @ np.abs(about.mass) @ np.abs(second[n:, :n])
    hidden = not nothing_added and is_hidden(about.mass, (stiffness, farther_off), np.fmin(rounding, added))
    matrices = (about.mass, about.damping, stiffness, rounding)
    return (stays(matrices, at_rest, state[:n], size[:n], hidden=hidden),)


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


def energy_of(system: Hamiltonian) -> Energy:
    """Give H of states (S, 2n) as its derivatives."""
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


def __dir__() -> list[str]:
    return list(__all__)
