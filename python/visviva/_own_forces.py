"""Forces whose parameters differ from copy to copy of an ensemble.

The one idea: a copy's forces are forces like any, made from the scene's with one value put in the place of another. So
whatever a force checks of its parameters it checks of each: of arrays at once where that is the same, and copy by copy
for what is refused, so that it is named.
"""

from __future__ import annotations

from itertools import repeat
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from visviva._declared import as_comparable
from visviva._keywords import did_you_mean
from visviva._own_loads import load_of_copies, place_of_load, refuse_shared
from visviva._own_potentials import names_of_potential, potential_of, potentials_of_copies
from visviva._parameter import NOT_NONE, VECTORS
from visviva.errors import InvalidInput
from visviva.forces import ExpressedForce, Force

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from typing import TypeAlias, TypeVar

    from numpy.typing import NDArray

    from visviva import _core
    from visviva._body_force import BodyForce
    from visviva._parameter import Parameter
    from visviva.scene import Scene

    _Acts = TypeVar("_Acts", Force, BodyForce)
    _Values: TypeAlias = NDArray[np.float64] | Sequence[Any]

__all__ = ["Acting", "described", "forces_of_copies"]


class Acting(NamedTuple):
    """What acts in each copy: forces on points, and those on rigid bodies."""

    forces: tuple[tuple[Force, ...], ...]
    loads: tuple[tuple[BodyForce, ...], ...]


def forces_of_copies(scene: Scene, parameters: Mapping[Force | BodyForce | int | str, Mapping[str, Any]]) -> Acting:
    """The forces of each copy: those of the scene with the values that the copies have of their own."""
    if not hasattr(parameters, "items") or not parameters:
        raise InvalidInput("parameters", f"expected a dictionary {{force: {{name: values}}}}, got {parameters!r}")
    values: dict[int, dict[str, _Values]] = {}
    of_loads: dict[int, dict[str, _Values]] = {}
    for which, named in parameters.items():
        of_load = place_of_load(scene, which)
        place = _place(scene, which) if of_load is None else of_load
        if not hasattr(named, "items") or not named:
            raise InvalidInput("parameters", f"expected a dictionary {{name: values}} for {which!r}, got {named!r}")
        if of_load is not None:
            refuse_shared(scene.body_forces[place], named)
            own = {name: _values_by_copy(name, given) for name, given in named.items()}
            of_loads.setdefault(place, {}).update(own)
            continue
        kinds = {parameter.name: parameter.kind for parameter in scene.forces[place]._parameters}
        for name, given in _own_values(scene.forces[place], named, kinds).items():
            by_copy = _bodies_by_copy if kinds[name] == "indices" else _values_by_copy
            values.setdefault(place, {})[name] = by_copy(name, given)
    count = _count([pair for named in (*values.values(), *of_loads.values()) for pair in named.items()])
    columns = (_of_copies(scene, force, values.get(place), count) for place, force in enumerate(scene.forces))
    loads = (load_of_copies(load, of_loads.get(place), count) for place, load in enumerate(scene.body_forces))
    return Acting(_by_copy(columns, count), _by_copy(loads, count))


def _by_copy(columns: Iterable[Iterable[_Acts]], count: int) -> tuple[tuple[_Acts, ...], ...]:
    """What acts in each copy, of what each of it is in all of them."""
    return tuple(zip(*columns, strict=True)) or ((),) * count


def _count(values: Sequence[tuple[str, _Values]]) -> int:
    """How many copies there are values for: as many of each."""
    first, given = values[0]
    for name, other in values:
        if len(other) != len(given):
            raise InvalidInput(
                "parameters", f"expected values of {name!r} for {len(given)} copies like {first}, got {len(other)}"
            )
    return len(given)


def _own_values(force: Force, named: Mapping[Any, Any], kinds: Mapping[str, str]) -> Mapping[Any, Any]:
    """The given values, those of expressions and of potentials as the parameters of the force that hold them."""
    if isinstance(force, ExpressedForce):
        named = _with_expressions(force, named)
    elif potential_of(force) is not None:
        named = _with_potentials(force, named, kinds)
    for name in named:
        if name not in kinds:
            hint = did_you_mean(str(name), tuple(kinds))
            known = f"{type(force).__name__} ({', '.join(kinds)})"
            raise InvalidInput("parameters", f"expected parameters of {known}, got {name!r}{hint}")
    return named


def _with_potentials(force: Force, named: Mapping[Any, Any], kinds: Mapping[str, str]) -> Mapping[Any, Any]:
    """Values of the potential's parameters as a potential for each copy."""
    held = potential_of(force)
    given = {str(name): values for name, values in named.items() if str(name) not in kinds}
    if held is None or not given:
        return named
    place, potential = held
    names = names_of_potential(potential)
    unknown = next((name for name in given if name not in names), None)
    if unknown is not None:
        hint = did_you_mean(unknown, (*kinds, *names))
        known = f"{type(force).__name__} ({', '.join(kinds)}) or of its potential ({', '.join(names)})"
        raise InvalidInput("parameters", f"expected parameters of {known}, got {unknown!r}{hint}")
    if place in named:
        raise InvalidInput(
            "parameters", f"expected a {place} for each copy or values of its parameters, got both: {place} and {given}"
        )
    own = {name: _values_by_copy(name, values) for name, values in given.items()}
    _count([*own.items()])
    rest = {name: values for name, values in named.items() if str(name) not in own}
    return {place: potentials_of_copies(force, potential, own), **rest}


def _with_expressions(force: ExpressedForce, named: Mapping[Any, Any]) -> Mapping[Any, Any]:
    """Values of the parameters of expressions as rows of the parameter that holds them."""
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
    rows = np.tile(np.asarray(force.values, dtype=float), (_count([*own.items()]), 1))
    for name, given in own.items():
        if not isinstance(given, np.ndarray) or given.ndim != 1:
            raise InvalidInput("parameters", f"expected one number {name!r} for each copy, got {given!r}")
        rows[:, names.index(name)] = given
    return {**{name: given for name, given in named.items() if str(name) not in names}, "values": rows}


def _of_copies(scene: Scene, force: Force, values: Mapping[str, _Values] | None, count: int) -> Iterable[Force]:
    """One force of the scene as each copy has it."""
    if values is None:
        return repeat(force, count)
    kinds = {parameter.name: parameter for parameter in force._parameters}
    checked = {
        name: None if name in force._checked_together else _checked(kinds[name], given)
        for name, given in values.items()
    }
    right = {name: column for name, column in checked.items() if column is not None}
    if len(right) == len(values):
        return force._each_with(right, count)
    # One after the other, as the copies are asked for: the first that is refused is named.
    rows = {
        name: given.tolist() if isinstance(given, np.ndarray) and given.ndim == 1 else given
        for name, given in values.items()
    }
    return (
        _with_values(scene, force, {name: given[copy] for name, given in rows.items()}, copy) for copy in range(count)
    )


def _checked(parameter: Parameter, given: _Values) -> Sequence[Any] | None:
    """What `Parameter.check` makes of the value of each copy, at once; None where that is for each by itself to say."""
    kind, sign = parameter.kind, parameter.sign
    if not isinstance(given, np.ndarray):
        from visviva.potentials import Potential

        return given if kind == "potential" and all(isinstance(each, Potential) for each in given) else None
    numbers = kind in ("number", "numbers")
    in_range = np.isfinite(given)
    if numbers and sign != "any":
        in_range &= given > 0.0 if sign == "positive" else given >= 0.0
    if not in_range.all():
        return None
    if given.ndim == 1:
        return given.tolist() if numbers else None
    if kind in VECTORS and given.shape[1:] == (3,) and (kind != "direction" or given.any(axis=1).all()):
        return list(map(tuple, given.tolist()))
    if kind in ("numbers", "table") and given.ndim == 2:
        kept = np.array(given, order="C")
        kept.flags.writeable = False
        return list(kept)
    return None


def _with_values(scene: Scene, force: Force, own: dict[str, Any], copy: int) -> Force:
    try:
        changed = type(force)(**{**force._values(), **own})
        return changed._resolved(scene.particles.names, len(scene.particles))
    except InvalidInput as error:
        raise InvalidInput("parameters", f"{type(force).__name__} of copy {copy}: {error}") from error


def _values_by_copy(name: str, given: Any) -> _Values:
    """One value for each copy, along the first axis: numbers as an array."""
    if isinstance(given, list | tuple) and given and not isinstance(given[0], int | float | list | tuple | np.ndarray):
        return given
    try:
        array = np.asarray(given, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = np.zeros(())
    if array.ndim == 0 or len(array) == 0:
        raise _without_axis(name, given)
    return array


def _bodies_by_copy(name: str, given: Any) -> Sequence[Any]:
    """The bodies of each copy, by their indices or their names."""
    bodies = given.tolist() if isinstance(given, np.ndarray) else given
    if not isinstance(bodies, list | tuple | range) or not bodies:
        raise _without_axis(name, given)
    for copy, own in enumerate(bodies):
        if np.size(own) == 0:
            raise InvalidInput("parameters", f"{name} of copy {copy}: {NOT_NONE}")
    return bodies


def _without_axis(name: str, given: Any) -> InvalidInput:
    return InvalidInput("parameters", f"expected values of {name!r} with a leading axis over the copies, got {given!r}")


def _hint(which: Any, forces: Sequence[Force | BodyForce]) -> str:
    """What to write for a name that is none of a force: the nearest, or the force that has a parameter of that name."""
    owner = next((each for each in forces if which in each._values()), None)
    if owner is not None:
        return f"it is a parameter: {{{type(owner).__name__!r}: {{{which!r}: values}}}}"
    near = did_you_mean(which, [name for each in forces for name in _names(each)]) if isinstance(which, str) else ""
    return f"it has none like that{near}"


def _place(scene: Scene, which: Any) -> int:
    """The place of a force on points that is given itself, by its place, or by the name of its class."""
    forces = scene.forces
    shown = ", ".join(map(repr, (*forces, *scene.body_forces))) or "none"
    if isinstance(which, bool) or not isinstance(which, int | str | Force):
        raise InvalidInput("parameters", f"expected forces of the scene ({shown}), got {which!r}")
    if isinstance(which, int):
        if not 0 <= which < len(forces):
            others = "; give a force on rigid bodies itself, or the name of its class" if scene.body_forces else ""
            raise InvalidInput("parameters", f"expected the place of a force, below {len(forces)}, got {which}{others}")
        return which
    if isinstance(which, Force):
        # The scene keeps indices where bodies were named.
        which = which._resolved(scene.particles.names, len(scene.particles))
    found = [i for i, force in enumerate(forces) if which in (force, *_names(force))]
    if len(found) != 1:
        why = (
            _hint(which, (*forces, *scene.body_forces))
            if not found
            else "it has several like that: give the place of one"
        )
        raise InvalidInput("parameters", f"expected a force of the scene ({shown}), got {which!r}; {why}")
    return found[0]


def _names(force: object) -> tuple[str, ...]:
    """By what a force is called: its class, and what makes one of it where that is not the class."""
    made_by = ("ExpressionForce",) if isinstance(force, ExpressedForce) else ()
    return (type(force).__name__, *made_by)


def described(copies: tuple[tuple[Force, ...], ...]) -> tuple[list[dict[str, Any]], _core._OwnForces | None]:
    """What the core and a file are told: the forces of the first copy, and what each has if they differ.

    That is each set of forces once, and which of them each copy has.
    """
    told = [_told(column) for column in zip(*copies, strict=True)]
    if not told:
        return [], None
    numbers: dict[tuple[int, ...], int] = {}
    of_copy = [numbers.setdefault(which, len(numbers)) for which in zip(*(each for _, each in told), strict=True)]
    chosen = ([each[one] for one in which] for (each, _), which in zip(told, zip(*numbers, strict=True), strict=True))
    sets = list(map(list, zip(*chosen, strict=True)))
    return sets[of_copy[0]], (sets, of_copy) if len(sets) > 1 else None


def _told(column: tuple[Force, ...]) -> tuple[list[dict[str, Any]], list[int]]:
    """One force as the copies have it: its descriptions, and which of them is that of each copy.

    What is equal has one description: to the core forces are the same if they are one object.
    """
    objects = {id(force): force for force in column}
    first = column[0]
    by_parameter = ((p, [getattr(force, p.name) for force in objects.values()]) for p in first._parameters)
    # Only in these they may differ.
    own = [(p, values) for p, values in by_parameter if len(set(map(id, values))) > 1]
    if not own:
        return [first._to_core()], [0] * len(column)
    keys = (values if p.kind == "number" else map(as_comparable, values) for p, values in own)
    numbers: dict[tuple[Any, ...], int] = {}
    places: list[int] = []
    of_object = {}
    for place, (which, key) in enumerate(zip(objects, zip(*keys, strict=True), strict=True)):
        number = of_object[which] = numbers.setdefault(key, len(places))
        if number == len(places):
            places.append(place)
    rest = first._to_core()
    descriptions = [rest.copy() for _ in places]
    for p, values in own:
        for description, place in zip(descriptions, places, strict=True):
            description[p.name] = p.to_core(values[place])
    return descriptions, [of_object[id(force)] for force in column]
