"""Small motions of any Hamiltonian about an equilibrium, also where no Lagrangian is known as an expression.

The one idea: of ξ̇ = A ξ + B η and η̇ = C ξ + D η the second is put into the first, with M = B⁻¹:
M ξ̈ − (M A + D M) ξ̇ + (D M A − C) ξ = 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput
from visviva.generalized._analysis import eigenmodes, of_matrices
from visviva.generalized._constrained_motions import BALANCED
from visviva.generalized._fixed_points import fixed_points
from visviva.generalized._newton import rates_and_slopes
from visviva.generalized._stability_by_momenta import FOUND, matrices_of_rates, rounding_of_slopes, slopes_at

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._analysis import Linearization
    from visviva.generalized._hamiltonian import Hamiltonian

__all__ = ["linearization_by_momenta", "normal_modes_by_momenta"]

#: Newton's steps to the momenta at rest.
_STEPS = 60


def linearization_by_momenta(
    system: Hamiltonian, at: ArrayLike | None, momentum: NDArray[np.float64] | None = None
) -> Linearization:
    """Small motions of a Hamiltonian about a place, at which its momenta are found."""
    n = len(system.coordinates)
    if not system.autonomous:
        raise InvalidInput("H", "small motions are those of equations that do not depend on the time")
    place = system._start()[:n] if at is None else float_array("at", at, (n,))
    state = _at_rest(system, np.concatenate([place, system._second if momentum is None else momentum]))
    slopes = slopes_at(system, state)
    if not np.isfinite(slopes).all():
        raise InvalidInput(
            "at", "expected a place where rates have derivatives, and they have none there: it is a kink"
        )
    rates = rates_and_slopes(system, state[None])[0][0]
    size = np.fmax(
        np.abs(state), np.repeat([np.abs(state[:n]).max(initial=0.0), np.abs(state[n:]).max(initial=0.0)], n)
    )
    made_of = np.abs(slopes) @ size
    off = ~(np.abs(rates) <= BALANCED * made_of)
    if off.any():
        worst = int(np.argmax(np.where(off, np.abs(rates), 0.0)))
        what = "velocity" if worst < n else "force"
        raise InvalidInput(
            "at",
            f"expected an equilibrium, but there is a {what} of {rates[worst]:.3g} of "
            f"{system.coordinates[worst % n]!r} there; see equilibria()",
        )
    unsure = rounding_of_slopes(system, state, FOUND * size, slopes)
    try:
        found, of_stiffness = matrices_of_rates(rates, slopes, unsure)
    except np.linalg.LinAlgError:
        raise InvalidInput("H", "expected ∂²H/∂p² that is not singular, and at this place it is") from None
    return of_matrices(place, (found, of_stiffness, None), eigenmodes(found, None), system.coordinates)


def normal_modes_by_momenta(system: Hamiltonian, near: ArrayLike) -> Linearization:
    """Small motions about the equilibrium that Newton's method comes to from a place and the momenta of the start."""
    place = float_array("near", near, (len(system.coordinates),))
    found = fixed_points(system, np.concatenate([place, system._second])[None])
    if not found:
        raise InvalidInput("near", "Newton's method finds no equilibrium from there; start it elsewhere")
    return linearization_by_momenta(system, found[0].position, found[0].momentum)


def _at_rest(system: Hamiltonian, state: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the state at the same place with momenta of which velocities vanish."""
    n = len(state) // 2
    for _ in range(_STEPS):
        rates, slopes = (part[0] for part in rates_and_slopes(system, state[None]))
        if not (np.isfinite(rates).all() and np.isfinite(slopes).all()) or not rates[:n].any():
            break
        moved = -np.linalg.lstsq(slopes[:n, n:], rates[:n], rcond=None)[0]
        state = state + np.concatenate([np.zeros(n), moved])
        if (np.abs(moved) <= np.finfo(float).eps * np.abs(state[n:])).all():
            break
    return state


def __dir__() -> list[str]:
    return list(__all__)
