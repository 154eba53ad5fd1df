"""Equilibria of Hamiltonian systems: states at which neither coordinates nor momenta change.

The one idea: Newton's method runs from many states at once, with the derivatives of the rates that the variational
equations have; what it comes to is kept where a step no longer leads elsewhere, and eigenvalues of those derivatives
tell of small motions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput
from visviva.generalized._equilibria import SAME, Equilibrium, starts_of_a_search

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._hamiltonian import Hamiltonian

__all__ = ["fixed_points"]

#: Newton's steps: enough for the linear way to a zero of the twelfth order, by a twelfth each time, to `SAME`.
_STEPS = 240
#: Singular values below this part of the largest are none.
_SINGULAR = 1e-13
#: A step is as long as the largest coordinate of a turn at most.
_LONGEST = np.pi
#: Rates that are this part of what they are made of are round-off.
_BALANCED = 1e-10
#: Eigenvalues whose real parts are below this part of the largest are imaginary; such equal ones need as many vectors.
_IMAGINARY = 1e-7


def fixed_points(system: Hamiltonian, near: ArrayLike | None) -> list[Equilibrium]:
    """Equilibria of a Hamiltonian, from starts (S, 2n) or from a search over a turn and momenta as large."""
    n = len(system.coordinates)
    if not system.autonomous:
        raise InvalidInput(
            "H",
            "expected equations that do not depend on the time, which have equilibria; see flow_jacobian over a period",
        )
    if near is None:
        states = starts_of_a_search(2 * n)
        # Momenta are zero in most equilibria.
        states = np.concatenate([states, np.where(np.arange(2 * n) < n, states, 0.0)])
    else:
        states = np.atleast_2d(float_array("near", near, None))
        if states.shape[1] != 2 * n:
            raise InvalidInput(
                "near", f"expected states of {n} coordinates and momenta, got an array of shape {states.shape}"
            )
    looked_at = np.abs(states).max(axis=0)
    states = _reached(system, states)
    distinguishing = np.ones(2 * n, dtype=bool)
    distinguishing[system._structure["cyclic"]] = False
    if near is None:
        # All places along a cyclic coordinate are alike, and those beyond a turn are the same or far away.
        states[:, ~distinguishing] = 0.0
        states = states[np.abs(states[:, :n]).max(axis=1, initial=0.0) <= np.pi + 1e-6]
    size = np.maximum(looked_at, np.abs(states).max(axis=0, initial=0.0))
    size[size == 0.0] = 1.0
    states = np.where(np.abs(states) < 1e-14 * size, 0.0, states)
    places: list[NDArray[np.float64]] = []
    while len(states):
        places.append(states[0])
        states = states[((np.abs(states - states[0]) > SAME * size) & distinguishing).any(axis=1)]
    return [_equilibrium(system, place) for place in sorted(places, key=tuple)]


def _reached(system: Hamiltonian, states: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where Newton's method ends from each state, if it comes to an equilibrium."""
    step = np.full(states.shape, np.inf)
    for _ in range(_STEPS):
        rates, slopes = _rates_and_slopes(system, states)
        finite = np.isfinite(rates).all(axis=1) & np.isfinite(slopes).all(axis=(1, 2))
        states, step, rates, slopes = states[finite], step[finite], rates[finite], slopes[finite]
        if not len(states):
            return states
        # Rates that change little, as beside a zero of higher order, count as others do.
        most = np.abs(slopes).max(axis=2, keepdims=True)
        most[most == 0.0] = 1.0
        step = -np.einsum("sij,sj->si", np.linalg.pinv(slopes / most, rcond=_SINGULAR), rates / most[..., 0])
        length = np.abs(step).max(axis=1, keepdims=True)
        states = states + step * (_LONGEST / np.maximum(length, _LONGEST))
        if (length <= 1e-15 * (1.0 + np.abs(states).max(axis=1, keepdims=True))).all():
            break
    rates, slopes = _rates_and_slopes(system, states)
    made_of = np.einsum("sij,sj->si", np.abs(slopes), np.abs(states) + np.abs(step))
    settled = (np.abs(step) <= SAME * (1.0 + np.abs(states))).all(axis=1)
    least = np.finfo(float).eps * np.abs(slopes).max(axis=(1, 2), initial=0.0)[:, None]
    kept: NDArray[np.bool_] = settled & (np.abs(rates) <= _BALANCED * made_of + least).all(axis=1)
    return states[kept]


def _rates_and_slopes(
    system: Hamiltonian, states: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rates (S, 2n) at states, and their derivatives (S, 2n, 2n)."""
    count, n = states.shape
    model = system._model.variational()
    unit = np.broadcast_to(np.eye(n).ravel(), (count, n * n))
    t, values = np.full(count, system.t0), np.broadcast_to(system._values, (count, len(system._values)))
    with np.errstate(all="ignore"):
        found = model.rates(t, np.concatenate([states, unit], axis=1), np.ascontiguousarray(values))
    return found[:, :n], found[:, n:].reshape(count, n, n)


def _equilibrium(system: Hamiltonian, state: NDArray[np.float64]) -> Equilibrium:
    n = len(system.coordinates)
    _, slopes = _rates_and_slopes(system, state[None])
    values, vectors = np.linalg.eig(slopes[0])
    largest = np.abs(values).max(initial=0.0)
    imaginary = np.abs(values.real) <= _IMAGINARY * largest
    # A coordinate that runs away by itself has an eigenvalue 0 without a vector of its own.
    own = largest > 0.0 and np.linalg.svd(vectors, compute_uv=False)[-1] > _IMAGINARY
    frequencies = np.sort(np.abs(values.imag[values.imag > 0.0]))
    return Equilibrium(state[:n], bool(imaginary.all() and own), frequencies, state[n:])
