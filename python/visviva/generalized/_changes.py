"""Other descriptions of a system: Hamiltonians of Lagrangians and back, Routh's function."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._source import Source, _label
from visviva.generalized._symbolic import free_name, sympy, time

if TYPE_CHECKING:
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["legendre", "routhian"]


def legendre(system: GeneralizedSystem) -> GeneralizedSystem:
    """Give the Hamiltonian of a Lagrangian, or the Lagrangian of a Hamiltonian, at the same state."""
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

    source = system._source
    to_hamiltonian = source.kind == "lagrangian"
    try:
        nodes, roots = system._model.legendre()
    except InvalidInput as error:
        if "quadratic" not in error.message:
            raise
        raise InvalidInput(error.argument, f"{error.message}; legendre_transform() evaluates it by numbers") from None
    symbols = source.symbols
    if symbols is not None:
        sp, taken = sympy(), {*source.names, *source.parameters}
        if to_hamiltonian:
            second = tuple(sp.Symbol(free_name(f"p_{name}", taken)) for name in source.names)
        elif any(isinstance(each, sp.Symbol) for each in symbols[0]):
            second = tuple(sp.Symbol(free_name(f"v_{name}", taken)) for name in source.names)
        else:
            second = tuple(each.diff(time._sympy_()) for each in symbols[0])
        symbols = (symbols[0], second, symbols[2])
    description = source.description | {
        "kind": "hamiltonian" if to_hamiltonian else "lagrangian",
        "nodes": nodes,
        "function": roots[0],
        "forces": roots[1:],
    }
    made = Source(description["kind"], source.names, symbols, source.parameters, description)
    other: GeneralizedSystem = object.__new__(Hamiltonian if to_hamiltonian else Lagrangian)
    second_half = None
    if system.position is not None:
        columns = system._model.columns(np.array([system.t0]), system._start()[None, :], system._values[None, :])
        second_half = columns[0, : len(source.names)]
    other._prepare(made, list(system.parameters.values()), (system.position, second_half, system.t0))
    return other


def routhian(system: GeneralizedSystem, momenta: Mapping[Any, float | None] | None) -> GeneralizedSystem:
    """Give Routh's function without cyclic coordinates, their momenta as parameters ``p_<name>``."""
    from visviva.generalized._lagrangian import Lagrangian

    source, n = system._source, len(system.coordinates)
    if source.description["forces"] or source.description["dissipation"] is not None or system._constraints():
        raise InvalidInput("L", "Routh's function is that of a Lagrangian without further forces and constraints")
    if momenta is not None and not isinstance(momenta, Mapping):
        raise InvalidInput("momenta", f"expected values by name, {{coordinate: momentum}}, got {momenta!r}")
    given = dict.fromkeys(system.cyclic) if momenta is None else {_label(k): v for k, v in momenta.items()}
    for name in given:
        if name not in system.coordinates:
            raise InvalidInput("momenta", f"there is no coordinate {name!r}; there are {list(system.coordinates)}")
        if name not in system.cyclic:
            raise InvalidInput("momenta", f"{name!r} is not cyclic; cyclic are {system.cyclic or 'none'}")
    if not given:
        raise InvalidInput("momenta", "no coordinate is cyclic, and there is nothing to reduce")
    places = [system.coordinates.index(name) for name in given]
    kept = [index for index in range(n) if index not in places]
    if not kept:
        raise InvalidInput("momenta", "all coordinates are cyclic: nothing would be left to run")
    nodes, roots = system._model.routhian(places)
    at_start = None
    if any(value is None for value in given.values()):
        columns = system._model.columns(np.array([system.t0]), system._start()[None, :], system._values[None, :])
        at_start = columns[0]
    values = [
        at_start[place] if value is None and at_start is not None else value
        for place, value in zip(places, given.values(), strict=True)
    ]
    names = tuple(system.coordinates[index] for index in kept)
    further = tuple(f"p_{name}" for name in given)
    symbols = source.symbols
    if symbols is not None:
        sp = sympy()
        first, second, parameters = symbols
        symbols = (
            tuple(first[i] for i in kept),
            tuple(second[i] for i in kept),
            (*parameters, *(sp.Symbol(name) for name in further)),
        )
    description = source.description | {
        "coordinates": len(kept),
        "parameters": len(source.parameters) + len(further),
        "nodes": nodes,
        "function": roots[0],
    }
    made = Source("lagrangian", names, symbols, (*source.parameters, *further), description)
    other: Lagrangian = object.__new__(Lagrangian)
    position = None if system.position is None else system.position[kept]
    other._prepare(made, [*system.parameters.values(), *values], (position, system._second[kept], system.t0))
    return other
