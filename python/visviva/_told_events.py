"""Events as the core is told of them, and as results and files keep them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from visviva._arrays import number
from visviva._event import Event, made, sign
from visviva._names import body_index
from visviva.errors import InvalidInput
from visviva.events import _check_two, apsis, distance, energy, function, plane

__all__ = ["described", "from_description", "resolved", "to_core"]


def to_core(given: Any) -> list[dict[str, Any]]:
    """What the core is told of ``events=``."""
    if isinstance(given, Event) or callable(given):
        given = [given]
    if not isinstance(given, Sequence):
        raise InvalidInput("events", f"expected a list of events, got {type(given).__name__}")
    told = []
    for index, event in enumerate(given):
        if isinstance(event, Event):
            told.append(event._to_core())
        elif callable(event):
            try:
                way = sign(number("direction", getattr(event, "direction", 0)))
                told.append(function(event, direction=way, terminal=getattr(event, "terminal", False))._to_core())
            except InvalidInput as error:
                raise InvalidInput("events", f"events[{index}]: {error.message}") from None
        else:
            raise InvalidInput(
                "events",
                "expected one of visviva.events or a function f(t, position, velocity), "
                f"got events[{index}] = {event!r}",
            )
    return told


# Where an event names bodies.
_BODIES = ("first", "second", "body", "about")


def resolved(told: list[dict[str, Any]], names: tuple[str, ...]) -> list[dict[str, Any]]:
    """The same with the indices of the bodies that were given by name."""
    found = []
    for event in told:
        own = {name: body_index(name, event[name], names) for name in _BODIES if isinstance(event.get(name), str)}
        whole = {**event, **own}
        for first, second in (("first", "second"), ("body", "about")):
            if own and isinstance(whole.get(second), int):
                _check_two(second, whole[first], whole[second])
        found.append(whole)
    return found


def described(told: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What a result and its file keep of the events that the core was told of: of a function its name."""
    return [
        {**event, "function": None, "name": str(getattr(event["function"], "__qualname__", type(event["function"])))}
        if event["kind"] == "function"
        else event
        for event in told
    ]


def from_description(kept: dict[str, Any]) -> Event:
    """The event that `described` wrote, judged anew: it may come from a file."""
    how: dict[str, Any] = {"direction": kept["direction"], "terminal": kept["last"] or False}
    match kept["kind"]:
        case "distance":
            return distance(kept["first"], kept["second"], below=kept["distance"], **how)
        case "plane":
            return plane(kept["point"], kept["normal"], body=kept["body"], **how)
        case "apsis":
            return apsis(kept["body"], kept["about"], **how)
        case "energy":
            return energy(kept["value"], **how)
        case "function":
            return made("function", name=str(kept["name"]), **how)
        case kind:
            raise InvalidInput("events", f"expected an event that visviva knows, got the kind {kind!r}")
