"""Events of runs in generalized coordinates: what the core is told of ``events=``, and the table of what was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number
from visviva._event import direction_of
from visviva._event_functions import name_of, told
from visviva._event_table import Lines
from visviva._exported import Columns, chosen_columns
from visviva._keywords import check_call, did_you_mean, known_keywords
from visviva.errors import InvalidInput
from visviva.events import Event, coordinate, expression
from visviva.generalized._nodes import Nodes
from visviva.generalized._source import calls
from visviva.generalized._switches import tells_of_switches
from visviva.generalized._symbolic import Symbols, sympy, time

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.generalized._nodes import Node
    from visviva.generalized._states import States
    from visviva.typing import GeneralizedEventColumnName

__all__ = ["GeneralizedEventTable", "described", "events_of", "events_to_core", "found_events"]

_OF_BODIES = ("apsis", "distance", "plane")


def events_of(given: Any) -> tuple[Event, ...]:
    """Give ``events=`` as events: a name is of a coordinate, a function or an expression passes zero."""
    if isinstance(given, (Event, str)) or callable(given) or hasattr(given, "free_symbols"):
        given = [given]
    if not isinstance(given, (list, tuple)):
        raise InvalidInput("events", f"expected a list of events, got {type(given).__name__}")
    return tuple(_event(index, each) for index, each in enumerate(given))


def _event(index: int, given: Any) -> Event:
    if isinstance(given, Event):
        if given.kind in _OF_BODIES:
            raise InvalidInput(
                "events",
                f"events[{index}]: {given.kind} is of bodies in a scene; in generalized coordinates there are "
                "coordinate, expression, energy and function",
            )
        return given
    if isinstance(given, str):
        return coordinate(given)
    if callable(given) or hasattr(given, "free_symbols"):
        direction = direction_of(number("direction", getattr(given, "direction", 0)))
        return expression(given, direction=direction, terminal=getattr(given, "terminal", 0))
    raise InvalidInput(
        "events",
        "expected one of visviva.events, the name of a coordinate, an expression of SymPy or a function f(q, v, t), "
        f"got events[{index}] = {given!r}",
    )


def events_to_core(system: States, events: Sequence[Event]) -> list[dict[str, Any]]:
    """What the core is told of events of a system."""
    return [_event_to_core(system, index, event) for index, event in enumerate(events)]


def described(events: Sequence[Event]) -> tuple[Event, ...]:
    """Give what a result keeps of events: of a function its name, as results go where functions do not."""

    def kept(event: Event) -> Event:
        own = [value for _, value in event.parameters if callable(value) and not hasattr(value, "free_symbols")]
        if not own:
            return event
        return Event(event.kind, (("name", name_of(own[0])),), event.direction, event.terminal)

    return tuple(map(kept, events))


def _event_to_core(system: States, index: int, event: Event) -> dict[str, Any]:
    parameters: dict[str, Any] = dict(event.parameters)
    if "name" in parameters:
        raise InvalidInput(
            "events", f"of the function {parameters['name']!r} a run keeps its name alone; give it again"
        )
    nodes: list[Node] = []
    to_send: dict[str, Any] = {"nodes": nodes, "root": None, "energy": None, "function": None}
    to_send |= {"direction": float(event.direction), "last": event.terminal or None}
    match event.kind:
        case "coordinate":
            name = parameters["coordinate"]
            if name not in system.coordinates:
                hint = did_you_mean(name, list(system.coordinates))
                raise InvalidInput(
                    "events",
                    f"events[{index}]: there is no coordinate {name!r}; there are {list(system.coordinates)}{hint}",
                )
            place = float(system.coordinates.index(name))
            nodes += [("variable", [], place), ("constant", [], -parameters["value"]), ("sum", [0, 1], 0.0)]
            to_send["root"] = 2
        case "expression":
            to_send["nodes"], to_send["root"] = _nodes(system, index, parameters["expression"])
        case "energy":
            to_send["energy"] = parameters["value"]
        case _ if "function" in parameters:
            check_call("events", parameters["function"], ("t", "position", system._second_name))
            to_send["function"] = told(index, parameters["function"])
        case kind:
            raise InvalidInput("events", f"events[{index}]: expected an event of visviva.events, got the kind {kind!r}")
    return to_send


def _nodes(system: States, index: int, given: Any) -> tuple[list[Node], int]:
    """Give an expression as nodes, also where the system itself was given in another way."""
    source = system._source
    nodes = Nodes("question")
    try:
        if callable(given) and not hasattr(given, "free_symbols"):
            root = calls(nodes, source.names, source.parameters, system._second_name)("events", given)
        else:
            root = _symbols(system, nodes).node("events", given)
    except InvalidInput as error:
        hint = ""
        if tells_of_switches(error.message) or "functions, as np.sin" in error.message:
            hint = "; vv.events.function takes a function that is called with numbers"
        raise InvalidInput("events", f"events[{index}]: {error.message}{hint}") from None
    return nodes.all, root


def _symbols(system: States, nodes: Nodes) -> Symbols:
    if system._source.groups is not None:
        return Symbols(nodes, *system._source.groups)
    # Of a function of Python the names tell what is meant.
    sp = sympy()
    first = [sp.Function(name)(time._sympy_()) for name in system.coordinates]
    if system._second_name == "velocity":
        second = [each.diff(time._sympy_()) for each in first]
    else:
        second = [sp.Symbol(f"p_{name}") for name in system.coordinates]
    return Symbols(nodes, first, second, [sp.Symbol(name) for name in system.parameters])


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class GeneralizedEventTable(Lines["GeneralizedEventColumnName"]):
    """The events of a run in generalized coordinates, in the order of the motion; of an ensemble, copy after copy.

    Units: those of the system, which are those of its parameters; angles in radians.

    Attributes
    ----------
    which : ndarray of int64, shape (K,)
        Index in the ``events`` that were asked for.
    t : ndarray, shape (K,)
    position, velocity, momentum : ndarray, shape (K, n)
        The state there: coordinates, their velocities, and ∂L/∂q̇.
    member : ndarray of int64, shape (K,)
        The copy of an ensemble; 0 of a single run.
    definitions : tuple of Event
        What was looked for, by `which`. Of a function its name alone.
    coordinates : tuple of str
        What the numbers of positions are of.

    Indexing with a slice or an array gives a smaller table; `of` that of one event. Tables are equal if all their
    columns are, NaN where NaN is, and what was looked for.

    Examples
    --------
    >>> import visviva as vv
    >>> events = ["theta", vv.events.expression(lambda q, v, t, **parameters: v[0])]
    >>> table = vv.systems.pendulum(position=[0.1]).run(t=3.0, events=events).events
    >>> table.which.tolist(), table.of(1).t.shape, table.momentum.shape
    ([0, 1, 0, 1, 0], (2,), (5, 1))
    """

    which: NDArray[np.int64]
    t: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    momentum: NDArray[np.float64]
    member: NDArray[np.int64]
    definitions: tuple[Event, ...]
    coordinates: tuple[str, ...]

    def plot(self, name: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Draw a coordinate against its momentum at the events: of those of a section, a Poincaré section of the run.

        Of one run `Lagrangian.poincare` gives the same points; here they are of all copies of an ensemble, too.

        Units: those of the system.

        Parameters
        ----------
        name : str, optional
            The coordinate; the last if not given.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes
            A color for each copy of an ensemble, else for each event that was looked for; `of` gives those of one.

        Raises
        ------
        InvalidInput
            For a coordinate that is not there, no event at all, what are no axes, or if matplotlib is not installed.

        References
        ----------
        M. Hénon & C. Heiles, Astron. J. 69 (1964) 73.

        Examples
        --------
        >>> import visviva as vv
        >>> stars = vv.systems.henon_heiles().ensemble(momentum=[[0.4, 0.1], [0.4, 0.2]])
        >>> passes = vv.events.coordinate("x", direction=1)
        >>> stars.run(t=100.0, events=[passes]).events.plot("y").get_ylabel()
        'momentum of y'
        """
        from visviva._phase import plot_generalized_section

        return plot_generalized_section(self, name, ax)

    def _exported(self, columns: GeneralizedEventColumnName | Sequence[GeneralizedEventColumnName] | None) -> Columns:
        known = self._names()
        of = {
            name: (("event", *["coordinate"][: getattr(self, name).ndim - 1]), getattr(self, name))
            for name in chosen_columns(columns, known, known)
        }
        return Columns({"event": np.arange(len(self)), "coordinate": np.array(self.coordinates)}, of)

    def __repr__(self) -> str:
        coordinates = self.position.shape[1]
        return f"GeneralizedEventTable({len(self)} events, {coordinates} coordinate{'s' * (coordinates != 1)})"


def found_events(
    system: States,
    result: dict[str, Any],
    events: tuple[Event, ...],
    parameters: NDArray[np.float64],
) -> GeneralizedEventTable:
    """Give the table of what a run found; ``parameters`` has a row for each copy."""
    if not events:
        raise InvalidInput("events", "no events were looked for; run again with events=[...] of visviva.events")
    copies = np.repeat(np.arange(len(result["found"])), result["found"])
    t, states = result["found_t"], result["found_y"]
    n = len(system.coordinates)
    second = other = np.ascontiguousarray(states[:, n:])
    if len(t):
        other = system._model.columns(t, np.ascontiguousarray(states), parameters[copies])[:, :n]
    velocity, momentum = (second, other) if system._second_name == "velocity" else (other, second)
    columns = {
        "which": np.array(result["found_which"], dtype=np.int64),
        "t": t.copy(),
        "position": states[:, :n].copy(),
        "velocity": velocity.copy(),
        "momentum": momentum.copy(),
        "member": copies.astype(np.int64),
    }
    return GeneralizedEventTable._made(columns, definitions=events, coordinates=tuple(system.coordinates))
