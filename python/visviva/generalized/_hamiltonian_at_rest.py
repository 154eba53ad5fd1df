"""Hamiltonian systems at rest: the momenta of rest, the forces there, and where these vanish.

The one idea: at rest nothing is left but n forces of n coordinates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._newton import rates_and_slopes
from visviva.generalized._searches import SAME
from visviva.generalized._valleys import ends_of_valleys

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian

__all__ = ["at_zeros_of_forces", "forces_at_rest", "forces_without_velocity", "states_at_rest"]

#: Newton's steps to momenta at which coordinates rest: one, unless H is more than quadratic in them.
_STEPS_TO_REST = 4
#: And so many times that until the velocity there is zero but for no rounding at all.
_STEPS_TO_EXACT_REST = 3
#: Momenta that differ by more than this part of what is looked at are others.
_OTHER_MOMENTA = 1e-3


def states_at_rest(
    system: Hamiltonian, places: NDArray[np.float64], near: NDArray[np.float64] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Give states (S, 2n) at places (S, n) with the momenta of rest, zero unless coordinates rotate or the like.

    And at which of the places: those where rates are numbers. Where there are several, those that Newton's method comes
    to from momenta (S, n) that are given, or zero.
    """
    n = places.shape[1]
    momenta = np.zeros_like(places) if near is None else near
    states, index = np.concatenate([places, momenta], axis=1), np.arange(len(places))
    for _ in range(_STEPS_TO_REST):
        rates, slopes = rates_and_slopes(system, states)
        known = np.isfinite(rates).all(axis=1) & np.isfinite(slopes).all(axis=(1, 2))
        states, rates, slopes, index = states[known], rates[known], slopes[known], index[known]
        if not rates[:, :n].any():
            break
        inverse = np.linalg.pinv(slopes[:, :n, n:], rcond=SAME)
        states[:, n:] -= np.einsum("sij,sj->si", inverse, rates[:, :n])
        if not (np.abs(rates[:, :n]) > SAME * np.abs(slopes[:, :n, n:]).max(initial=0.0)).any():
            break
    return states, index


def forces_at_rest(
    system: Hamiltonian, places: NDArray[np.float64], near: NDArray[np.float64] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forces (S, n) at places at rest, and minus their derivatives (S, n, n) where momenta stay those of rest.

    Those momenta are `near` some (S, n), or zero.
    """
    n = places.shape[1]
    states, known = states_at_rest(system, places, near)
    forces, stiffness = np.full(places.shape, np.nan), np.full((*places.shape, n), np.nan)
    rates, slopes = rates_and_slopes(system, states)
    finite = np.isfinite(slopes).all(axis=(1, 2))
    known, rates, slopes = known[finite], rates[finite], slopes[finite]
    softer = -slopes[:, n:, :n]
    if slopes[:, :n, :n].any():
        softer += slopes[:, n:, n:] @ np.linalg.pinv(slopes[:, :n, n:], rcond=SAME) @ slopes[:, :n, :n]
    forces[known], stiffness[known] = rates[:, n:], softer
    return forces, stiffness


def forces_without_velocity(
    system: Hamiltonian, places: NDArray[np.float64], near: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Forces (S, n) at places where velocities come to zero without any rounding; elsewhere they are not numbers."""
    n = places.shape[1]
    forces = np.full(places.shape, np.nan)
    momenta = near
    for _ in range(_STEPS_TO_EXACT_REST):
        states, index = states_at_rest(system, places, momenta)
        rates, _ = rates_and_slopes(system, states)
        still = ~rates[:, :n].any(axis=1)
        forces[index[still]] = rates[still, n:]
        if still.all():
            break
        momenta = momenta.copy()
        momenta[index] = states[:, n:]
    return forces


def at_zeros_of_forces(
    system: Hamiltonian, states: NDArray[np.float64], looked_at: NDArray[np.float64]
) -> NDArray[np.float64]:
    """States (S, 2n) at which forces at rest lead no further, by what is known there and nowhere else."""
    n = states.shape[1] // 2
    # What stays with other momenta than those that are come to from zero is judged by the rates alone.
    resting = np.full(states.shape, np.nan)
    rest, known = states_at_rest(system, states[:, :n])
    resting[known] = rest
    own = ~(np.abs(states - resting) <= _OTHER_MOMENTA * looked_at).all(axis=1)
    places = ends_of_valleys(lambda at: forces_at_rest(system, at), states[~own, :n], looked_at[:n])
    return np.concatenate([states[own], states_at_rest(system, places)[0]])


def __dir__() -> list[str]:
    return list(__all__)
