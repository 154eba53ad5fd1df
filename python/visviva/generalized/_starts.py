"""Why a motion cannot start where it is to."""

from __future__ import annotations

from math import isfinite, isnan
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._switches import SWITCH, WIDTH

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._states import States

__all__ = ["is_beyond_domain", "refuse_a_start", "refuse_beyond_domain"]

#: A state beside the start: by this part of each number, or by this where it is 0.
_BESIDE = 1e-3
#: The squares of such numbers are beyond the range.
_OVERFLOWS = 1e150


def refuse_a_start(system: Lagrangian | Hamiltonian, state: NDArray[np.float64], what: str) -> NoReturn:
    """Refuse a start where rates are no numbers, with the reason.

    Raises
    ------
    visviva.InvalidInput
        In any case.
    """
    n = len(system.coordinates)
    places, second = state[:n], state[n:]
    moving = np.concatenate([places, np.where(second == 0.0, 1.0, second)])
    beside = np.concatenate([np.where(state == 0.0, _BESIDE, state * (1.0 + _BESIDE))])
    if system._source.kind == "lagrangian" and _has_rates(system, moving):
        if _is_massless(system, state):
            raise InvalidInput(
                "velocity",
                f"{what} at a velocity of 0: the mass matrix, the second derivatives of L by velocities, is "
                "singular there, and no force has an acceleration; start with a velocity",
            )
        raise InvalidInput(
            "velocity",
            f"{what} at a velocity of 0: a force along v/|v| (dry friction) has no direction there; start with a "
            f"velocity, or write np.tanh(v/width) for v/|v|, {WIDTH}, or give the force of one direction and "
            f"{SWITCH}",
        )
    if _overflows(system, state) and _overflows(system, beside):
        raise InvalidInput(
            "position",
            f"{what} at the start: what it is made of is beyond 1.8e308, there and around it; start where it is "
            "less, or take other units",
        )
    if system._source.kind == "hamiltonian":
        raise InvalidInput("position", f"{what} at the start: a singularity of H; start away from it")
    raise InvalidInput(
        "position",
        f"{what} at the start: a singularity of these coordinates, or a mass matrix that is singular there; start away "
        "from it or take other coordinates",
    )


def is_beyond_domain(system: States, columns: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell states, by the columns of the core, in which the energy is no number or a momentum none or infinite.

    An energy alone may be infinite: of numbers whose squares are beyond the range.
    """
    n = len(system.coordinates)
    has_momenta = system._source.kind == "lagrangian"
    if len(columns) == 1:  # arithmetic of numbers, a tenth of that of arrays of one
        row = columns[0].tolist()
        return np.array([isnan(row[n]) or (has_momenta and not all(map(isfinite, row[:n])))])
    beyond: NDArray[np.bool_] = np.isnan(columns[:, n])
    if has_momenta:
        beyond |= ~np.isfinite(columns[:, :n]).all(axis=1)
    return beyond


def refuse_beyond_domain(system: Lagrangian | Hamiltonian) -> NoReturn:
    """Refuse a start where rates are numbers, but the energy or a momentum is none.

    Raises
    ------
    visviva.InvalidInput
        In any case.
    """
    n = len(system.coordinates)
    state = system._start()
    function, names = "H", []
    values = _momenta_and_energy(system, state)
    if system._source.kind == "lagrangian":
        function, names = "L", [f"the momentum of {name!r}" for name in system.coordinates]
    undefined = [name for name, value in zip([*names, "the energy"], values, strict=True) if not np.isfinite(value)]
    which = " and ".join(undefined)
    at_rest = _momenta_and_energy(system, np.concatenate([state[:n], np.zeros(n)]))
    argument = system._second_name if np.isfinite(at_rest).all() else "position"
    if np.isnan(values).any() and np.abs(state).max() < _OVERFLOWS:
        are = "is no number" if len(undefined) == 1 else "are no numbers"
        raise InvalidInput(argument, f"{which} {are} at the start: {function} is not defined there; start where it is")
    are = "is" if len(undefined) == 1 else "are"
    raise InvalidInput(
        argument,
        f"{which} {are} no number or infinite at the start: {function} is not defined there, or what it is made of is "
        "beyond 1.8e308; start elsewhere, or take other units",
    )


def _momenta_and_energy(system: Lagrangian | Hamiltonian, state: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the momenta of a Lagrangian at a state, and the energy; of a Hamiltonian the energy."""
    columns: NDArray[np.float64] = system._model.columns(
        np.array([system.t0]), state[None, :], system._values[None, :]
    )[0]
    n = len(system.coordinates)
    return columns[: n + 1] if system._source.kind == "lagrangian" else columns[n : n + 1]


def _rates(system: Lagrangian | Hamiltonian, state: NDArray[np.float64]) -> NDArray[np.float64]:
    found: NDArray[np.float64] = system._model.rates(np.array([system.t0]), state[None, :], system._values[None, :])[0]
    return found


def _has_rates(system: Lagrangian | Hamiltonian, state: NDArray[np.float64]) -> bool:
    return bool(np.isfinite(_rates(system, state)).all())


def _values(system: Lagrangian | Hamiltonian, name: str, state: NDArray[np.float64]) -> NDArray[np.float64]:
    nodes, roots = system._model.expressions(name)
    found: NDArray[np.float64] = system._model.evaluate(
        nodes, roots, np.array([system.t0]), state[None, :], system._values[None, :]
    )[0]
    return found


def _is_massless(system: Lagrangian | Hamiltonian, state: NDArray[np.float64]) -> bool:
    """Whether the mass matrix of a Lagrangian is singular at a state."""
    n = len(system.coordinates)
    mass = _values(system, "mass_matrix", state).reshape(n, n)
    return bool(np.isfinite(mass).all() and np.linalg.matrix_rank(mass) < n)


def _overflows(system: Lagrangian | Hamiltonian, state: NDArray[np.float64]) -> bool:
    """Whether the function or its slopes are infinite at a state."""
    return bool(np.isinf(np.concatenate([_values(system, name, state) for name in ("function", "slopes")])).any())
