"""Events as the core is told of them, and as results and files keep them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from visviva._arrays import number
from visviva._event import Event, direction_of, make_event
from visviva._event_arguments import check_two
from visviva._event_functions import name_of, told
from visviva._names import body_index
from visviva.errors import InvalidInput
from visviva.events import apsis, distance, energy, function, plane

__all__ = ["descriptions", "from_description", "of_scene", "to_core"]


def to_core(given: Any) -> list[dict[str, Any]]:
    """What the core is told of ``events=``."""
    if isinstance(given, Event) or callable(given):
        given = [given]
    if not isinstance(given, Sequence) or isinstance(given, str):
        raise InvalidInput("events", f"expected a list of events, got {type(given).__name__}")
    to_send = []
    for index, event in enumerate(given):
        if isinstance(event, Event):
            to_send.append(event._to_core())
        elif getattr(event, "__module__", None) == apsis.__module__:
            name = getattr(event, "__name__", "Event")
            raise InvalidInput("events", f"events[{index}]: expected an event, got what makes one: call {name}(…)")
        elif callable(event):
            try:
                direction = direction_of(number("direction", getattr(event, "direction", 0)))
                to_send.append(
                    function(event, direction=direction, terminal=getattr(event, "terminal", False))._to_core()
                )
            except InvalidInput as error:
                raise InvalidInput("events", f"events[{index}]: {error.message}") from None
        else:
            raise InvalidInput(
                "events",
                "expected one of visviva.events or a function f(t, position, velocity), "
                f"got events[{index}] = {event!r}",
            )
        if to_send[-1]["kind"] == "function":
            to_send[-1]["function"] = told(index, to_send[-1]["function"])
    return to_send


# Where an event names bodies.
_BODIES = ("first", "second", "body", "about")


def of_scene(events: list[dict[str, Any]], names: tuple[str, ...], particles: int) -> list[dict[str, Any]]:
    """The same in a scene of so many bodies: those that were given by name by index, and expressions as numbers."""
    found = []
    for index, event in enumerate(events):
        if event["kind"] == "expression":
            from visviva._event_expressions import traced

            found.append(traced(index, event, names, particles))
            continue
        indices = {name: body_index(name, event[name], names) for name in _BODIES if isinstance(event.get(name), str)}
        resolved = {**event, **indices}
        for first, second in (("first", "second"), ("body", "about")):
            if indices and isinstance(resolved.get(second), int):
                check_two(second, resolved[first], resolved[second])
        found.append(resolved)
    return found


def descriptions(events: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What a result and its file keep of the events that the core was told of: of a function its name."""
    return [_named(event) if event["kind"] == "function" else event for event in events]


def _named(event: dict[str, Any]) -> dict[str, Any]:
    kept = {key: value for key, value in event.items() if key != "sees_turning"}
    return kept | {"function": None, "name": name_of(event["function"])}


def from_description(description: dict[str, Any]) -> Event:
    """The event that `descriptions` wrote, checked anew: it may come from a file."""
    options: dict[str, Any] = {"direction": description["direction"], "terminal": description["last"] or False}
    match description["kind"]:
        case "distance":
            return distance(description["first"], description["second"], below=description["distance"], **options)
        case "plane":
            return plane(description["point"], description["normal"], body=description["body"], **options)
        case "apsis":
            return apsis(description["body"], description["about"], **options)
        case "energy":
            return energy(description["value"], **options)
        case "expression":
            from visviva._event_expressions import from_numbers

            return make_event("expression", **from_numbers(description), **options)
        case "function":
            return make_event("function", name=str(description["name"]), **options)
        case kind:
            raise InvalidInput("events", f"expected an event that visviva knows, got the kind {kind!r}")
