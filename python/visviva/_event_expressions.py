"""Expressions among the events of scenes: functions that are called once, with expressions in the place of numbers.

The one idea: what is kept of one is a table of nodes and the coordinates of bodies that it looks at, so it is compiled,
pickled and written to files as numbers are, and can be looked for again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number, whole_number
from visviva._event_functions import check_event_function, name_of, sees_turning
from visviva._expression_table import table
from visviva._names import body_index
from visviva.errors import InvalidInput
from visviva.generalized._nodes import (
    Expression,
    Nodes,
    call_with_expressions,
    expression_array,
    not_compiled,
    recorded,
)

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["from_numbers", "traced"]

_CURE = "a plain function f(t, position, velocity) in events= is asked in Python instead"


class _Rows(np.ndarray[Any, Any]):
    """Positions or velocities of all bodies, whose rows go by the names of the bodies, too."""

    _names: tuple[str, ...] = ()

    def __array_finalize__(self, made_from: Any) -> None:
        self._names = getattr(made_from, "_names", ())

    def __getitem__(self, at: Any) -> Any:
        if isinstance(at, str):
            at = body_index("position", at, self._names)
        elif isinstance(at, tuple) and at and isinstance(at[0], str):
            at = (body_index("position", at[0], self._names), *at[1:])
        return super().__getitem__(at)


def traced(index: int, description: dict[str, Any], names: tuple[str, ...], particles: int) -> dict[str, Any]:
    """What the core is told of an expression, in a scene of so many bodies with these names.

    Raises
    ------
    visviva.InvalidInput
        Naming ``events``, for what is no function of a scene, or does what expressions cannot.
    """
    if "nodes" in description:
        return description
    told = dict(description)
    function = told.pop("expression")
    if hasattr(function, "free_symbols"):
        raise InvalidInput(
            "events",
            f"events[{index}]: expected a function f(t, position, velocity), which scenes have in an expression, got "
            f"the expression {function} of SymPy, which knows no bodies",
        )
    try:
        if sees_turning(function):
            raise InvalidInput(
                "events",
                "expected a function f(t, position, velocity), got one that takes orientations; given to events= as it "
                "is it is asked in Python",
            )
        check_event_function(function)
        told |= _numbers(function, names, particles)
    except InvalidInput as error:
        raise InvalidInput("events", f"events[{index}]: {error.message}") from None
    return told


def from_numbers(description: dict[str, Any]) -> dict[str, Any]:
    """The parameters of an expression's event that `traced` wrote, checked anew: it may come from a file."""
    coordinates = [[whole_number("coordinates", each, low=0) for each in pair] for pair in description["coordinates"]]
    return {
        "name": str(description["name"]),
        "nodes": tuple(number("nodes", each) for each in description["nodes"]),
        "coordinates": tuple((body, axis) for body, axis in coordinates),
    }


def _numbers(function: Callable[..., Any], names: tuple[str, ...], particles: int) -> dict[str, Any]:
    """The name of a function, the coordinates of bodies that it looks at, and its nodes as functions of those."""
    nodes = Nodes("question")
    root = _root(nodes, not_compiled(function), names, particles)
    found, (root,) = nodes.part([root])
    # Of a variable its number: six for each body, places before velocities.
    looked_at = sorted({divmod(int(value), 6) for operation, _, value in found if operation == "variable"})
    coordinates = sorted({(body, at % 3) for body, at in looked_at})
    places = {pair: place for place, pair in enumerate(coordinates)}
    kept = Nodes("question")

    def renumbered(variable: float) -> float:
        body, at = divmod(int(variable), 6)
        return float(places[body, at % 3] + len(places) * (at // 3))

    for operation, arguments, value in found:
        kept.all.append((operation, arguments, renumbered(value) if operation == "variable" else value))
    numbers = tuple(map(float, table(kept, [root], ())))
    return {"name": name_of(function), "nodes": numbers, "coordinates": tuple(coordinates)}


def _root(nodes: Nodes, function: Callable[..., Any], names: tuple[str, ...], particles: int) -> int:
    def rows(first: int) -> _Rows:
        variables = (6 * body + first + c for body in range(particles) for c in range(3))
        listed = expression_array(Expression(nodes, nodes.add("variable", (), float(at))) for at in variables)
        made = listed.reshape(particles, 3).view(_Rows)
        made._names = names
        return made

    def ordered(position: Any, velocity: Any, t: Any) -> Any:
        return function(t, position, velocity)

    # What errors in it are told to come from.
    ordered.__qualname__ = name_of(function)
    state = (rows(0), rows(3), Expression(nodes, nodes.add("time")))
    try:
        result = call_with_expressions(nodes, "events", ordered, state, {})
        return recorded(nodes, result.view(np.ndarray) if isinstance(result, _Rows) else result, "events")
    except IndexError as error:
        shape = f"positions and velocities are of shape ({particles}, 3)"
        raise InvalidInput("events", f"{name_of(function)}: {error}; {shape}") from None
    except InvalidInput as error:
        # Names of bodies that are not there are refused as such.
        cure = f"; {_CURE}" if error.argument == "events" else ""
        raise InvalidInput("events", f"{error.message}{cure}") from None
