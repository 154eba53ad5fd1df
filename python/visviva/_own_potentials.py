"""Potentials whose parameters differ from copy to copy of an ensemble, named as if they were those of the force.

The one idea: a copy's potential is one like any, made of the scene's with one number put in the place of another, and
copies with equal numbers have the very same one. Parameters of a formula are known by their names in it.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number
from visviva._declared import as_comparable
from visviva._expression_table import parameter_values
from visviva.errors import InvalidInput
from visviva.potentials import Expressed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from visviva.forces import Force
    from visviva.potentials import Potential

__all__ = ["names_of_potential", "potential_of", "potentials_of_copies"]


def potential_of(force: Force) -> tuple[str, Potential] | None:
    """The name of the parameter of a force that is a potential, and this; None of a force that has none."""
    found = (parameter.name for parameter in force._parameters if parameter.kind == "potential")
    return next(((name, getattr(force, name)) for name in found), None)


def names_of_potential(potential: Potential) -> tuple[str, ...]:
    """By what its parameters are called."""
    if isinstance(potential, Expressed):
        return tuple(parameter_values(potential.nodes, potential.values.tolist()))
    return tuple(potential._values())


def potentials_of_copies(
    force: Force, potential: Potential, own: Mapping[str, NDArray[np.float64] | Sequence[Any]]
) -> list[Potential]:
    """The potential of each copy: that of the force with these values, as many of each as there are copies.

    Raises
    ------
    visviva.InvalidInput
        For what the potential refuses, by the copy.
    """
    made: dict[tuple[Any, ...], Potential] = {}
    found = []
    checks, changed = _checks(potential), _changes(potential)
    columns = (given.tolist() if isinstance(given, np.ndarray) and given.ndim == 1 else given for given in own.values())
    for copy, row in enumerate(zip(*columns, strict=True)):
        try:
            values = {name: checks[name](value) for name, value in zip(own, row, strict=True)}
            key = tuple(map(as_comparable, values.values()))
            if key not in made:
                made[key] = changed(values)
        except InvalidInput as error:
            raise InvalidInput("parameters", f"{type(force).__name__} of copy {copy}: {error}") from error
        found.append(made[key])
    return found


def _checks(potential: Potential) -> dict[str, Callable[[Any], Any]]:
    """What makes of a value of each parameter one that is kept, or refuses it."""
    if isinstance(potential, Expressed):
        return {name: partial(number, name) for name in names_of_potential(potential)}
    return {parameter.name: parameter.check for parameter in potential._parameters}


def _changes(potential: Potential) -> Callable[[dict[str, Any]], Potential]:
    """What makes one with other values of some parameters."""
    kind, own = type(potential), potential._values()
    if not isinstance(potential, Expressed):
        return lambda values: kind(**(own | values))
    numbers: dict[str, Any] = parameter_values(potential.nodes, potential.values.tolist())
    return lambda values: kind(**(own | {"values": list((numbers | values).values())}))
