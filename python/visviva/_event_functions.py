"""What functions among events take: points alone, or how rigid bodies are turned, too.

The one idea: the signature tells, before anything runs; and what a function raises while it runs says which one it was.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import check_call, takes
from visviva._text import note_once
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import SupportsFloat

    import numpy as np
    from numpy.typing import NDArray

__all__ = ["check_event_function", "name_of", "sees_turning", "told"]

#: What a function is called with, and beside rigid bodies.
_OF_POINTS = ("t", "position", "velocity")
_OF_RIGID_BODIES = (*_OF_POINTS, "orientation", "angular_velocity")


def sees_turning(call: Callable[..., SupportsFloat]) -> bool:
    """Whether a function takes orientations and angular velocities, too."""
    return not takes(call, _OF_POINTS) and takes(call, _OF_RIGID_BODIES)


def check_event_function(call: Callable[..., SupportsFloat]) -> None:
    """Refuse a function that can be called in neither way.

    Raises
    ------
    visviva.InvalidInput
        Naming ``call``, with what it is called with.
    """
    _refuse_time_elsewhere(call)
    if sees_turning(call):
        return
    try:
        check_call("call", call, _OF_POINTS)
    except InvalidInput as error:
        raise InvalidInput(
            "call", f"{error.message}, or beside rigid bodies as f({', '.join(_OF_RIGID_BODIES)})"
        ) from None


def _refuse_time_elsewhere(call: Callable[..., SupportsFloat]) -> None:
    # As forces have it, which take (position, velocity, t): the place would be taken for the time.
    from visviva.generalized._source import placed_arguments

    placed = [each.name for each in placed_arguments(call)]
    if {"t", "time"} & {*placed[1:3]} and not {"t", "time"} & {*placed[:1]}:
        got = ", ".join(placed)
        raise InvalidInput("call", f"expected a function f({', '.join(_OF_POINTS)}), in this order, got f({got})")


def told(which: int, function: Callable[..., SupportsFloat]) -> Callable[..., SupportsFloat]:
    """A function among the events of a run, under its own name, whose errors say which of them raised it, and when."""

    def call(t: float, *state: NDArray[np.float64]) -> SupportsFloat:
        try:
            return function(t, *state)
        except Exception as error:
            note_once(error, f"raised by events[{which}], the function {call.__qualname__}, at t = {t!r}")
            raise

    call.__qualname__ = name_of(function)
    return call


def name_of(function: object) -> str:
    """What a function is called where it is told of."""
    return str(getattr(function, "__qualname__", type(function).__qualname__))


def __dir__() -> list[str]:
    return list(__all__)
