"""Forces whose parameters differ from copy to copy of an ensemble.

The one idea: a copy's forces are forces like any, made from the scene's with one value put in the place of another. So
whatever a force checks of its parameters it checks of each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import did_you_mean
from visviva.errors import InvalidInput
from visviva.forces import ExpressedForce, Force

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from visviva import _core
    from visviva.scene import Scene

__all__ = ["described", "forces_of_copies"]


def forces_of_copies(
    scene: Scene, parameters: Mapping[Force | int | str, Mapping[str, Any]]
) -> tuple[tuple[Force, ...], ...]:
    """The forces of each copy: those of the scene with the values that the copies have of their own."""
    if not hasattr(parameters, "items") or not parameters:
        raise InvalidInput("parameters", f"expected a dictionary {{force: {{name: values}}}}, got {parameters!r}")
    values: dict[int, dict[str, Sequence[Any]]] = {}
    for which, named in parameters.items():
        place = _place(scene, which)
        if not hasattr(named, "items") or not named:
            raise InvalidInput("parameters", f"expected a dictionary {{name: values}} for {which!r}, got {named!r}")
        kinds = {parameter.name: parameter.kind for parameter in scene.forces[place]._parameters}
        for name, given in _own_values(scene.forces[place], named).items():
            if name not in kinds:
                hint = did_you_mean(str(name), tuple(kinds))
                known = f"{type(scene.forces[place]).__name__} ({', '.join(kinds)})"
                raise InvalidInput("parameters", f"expected parameters of {known}, got {name!r}{hint}")
            by_copy = _bodies_by_copy if kinds[name] == "indices" else _values_by_copy
            values.setdefault(place, {})[name] = by_copy(name, given)
    count = _count({name: given for named in values.values() for name, given in named.items()})
    return tuple(
        tuple(_with_values(scene, force, values.get(place), copy) for place, force in enumerate(scene.forces))
        for copy in range(count)
    )


def _count(values: Mapping[str, Sequence[Any]]) -> int:
    """How many copies there are values for: as many of each."""
    first, given = next(iter(values.items()))
    for name, other in values.items():
        if len(other) != len(given):
            raise InvalidInput(
                "parameters", f"expected values of {name!r} for {len(given)} copies like {first}, got {len(other)}"
            )
    return len(given)


def _own_values(force: Force, named: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """The given values, those of the parameters of expressions as rows of the parameter that holds them."""
    if not isinstance(force, ExpressedForce):
        return named
    from visviva.expression_force import parameter_names

    names = parameter_names(force)
    own = {str(name): _values_by_copy(str(name), given) for name, given in named.items() if str(name) in names}
    if not own:
        unknown = next(iter(set(map(str, named)) - set(force._values())), None)
        if unknown is not None:
            hint = did_you_mean(unknown, names)
            raise InvalidInput(
                "parameters", f"expected parameters of the expressions {list(names)}, got {unknown!r}{hint}"
            )
        return named
    rows = np.tile(np.asarray(force.values, dtype=float), (_count(own), 1))
    for name, given in own.items():
        if np.ndim(given) != 1:
            raise InvalidInput("parameters", f"expected one number {name!r} for each copy, got {given!r}")
        rows[:, names.index(name)] = given
    return {**{name: given for name, given in named.items() if str(name) not in names}, "values": rows}


def _with_values(scene: Scene, force: Force, values: dict[str, Sequence[Any]] | None, copy: int) -> Force:
    if values is None:
        return force
    own = {name: given[copy] for name, given in values.items()}
    try:
        changed = type(force)(**{**force._values(), **own})
        return changed._resolved(scene.particles.names, len(scene.particles))
    except InvalidInput as error:
        raise InvalidInput("parameters", f"{type(force).__name__} of copy {copy}: {error}") from error


def _values_by_copy(name: str, given: Any) -> Sequence[Any]:
    """One value for each copy, along the first axis."""
    if isinstance(given, list | tuple) and given and not isinstance(given[0], int | float | list | tuple | np.ndarray):
        return given
    try:
        array = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        array = np.zeros(())
    if array.ndim == 0 or len(array) == 0:
        raise _without_axis(name, given)
    values: list[Any] = array.tolist() if array.ndim == 1 else list(array)
    return values


def _bodies_by_copy(name: str, given: Any) -> Sequence[Any]:
    """The bodies of each copy, by their indices or their names."""
    bodies = given.tolist() if isinstance(given, np.ndarray) else given
    if not isinstance(bodies, list | tuple | range) or not bodies:
        raise _without_axis(name, given)
    return bodies


def _without_axis(name: str, given: Any) -> InvalidInput:
    return InvalidInput("parameters", f"expected values of {name!r} with a leading axis over the copies, got {given!r}")


def _place(scene: Scene, which: Any) -> int:
    """The place of a force that is given itself, by its place, or by the name of its class."""
    forces = scene.forces
    shown = ", ".join(map(repr, forces)) or "none"
    if any(which in (force, *_names(force)) for force in scene.body_forces):
        raise InvalidInput(
            "parameters",
            f"expected a force on points ({shown}), got {which!r}: what acts on rigid bodies is the same in all "
            "copies; run a scene for each of its values",
        )
    if isinstance(which, bool) or not isinstance(which, int | str | Force):
        raise InvalidInput("parameters", f"expected forces of the scene ({shown}), got {which!r}")
    if isinstance(which, int):
        if not 0 <= which < len(forces):
            raise InvalidInput("parameters", f"expected the place of a force, below {len(forces)}, got {which}")
        return which
    if isinstance(which, Force):
        # The scene keeps indices where bodies were named.
        which = which._resolved(scene.particles.names, len(scene.particles))
    found = [i for i, force in enumerate(forces) if which in (force, *_names(force))]
    if len(found) != 1:
        why = "it has none like that" if not found else "it has several like that: give the place of one"
        raise InvalidInput("parameters", f"expected a force of the scene ({shown}), got {which!r}; {why}")
    return found[0]


def _names(force: object) -> tuple[str, ...]:
    """By what a force is called: its class, and what makes one of it where that is not the class."""
    made_by = ("ExpressionForce",) if isinstance(force, ExpressedForce) else ()
    return (type(force).__name__, *made_by)


def described(copies: tuple[tuple[Force, ...], ...]) -> _core._OwnForces:
    """What the core and a file are told: each set of forces once, and which of them each copy has."""
    sets: dict[tuple[Force, ...], int] = {}
    of_copy = [sets.setdefault(forces, len(sets)) for forces in copies]
    # One description of each: to the core forces are the same if they are one object.
    each = {force: force._to_core() for forces in sets for force in forces}
    return [[each[force] for force in forces] for forces in sets], of_copy
