"""One event that is looked for; see `visviva.events`.

The one idea: it is plain data, a kind and its numbers, so it is compared, pickled and written to files as it is. What
the core is told follows from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import number, whole_number
from visviva._event_functions import sees_turning
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from visviva.typing import EventDirection

__all__ = ["Event", "checked_direction", "direction_of", "make_event"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Event(Record):
    """Something to look for. Made by the functions of `visviva.events`.

    Attributes
    ----------
    kind : str
    parameters : tuple of (str, object)
    direction : {1, -1, 0}
        1 for zeros passed upwards in time (also in a run backwards), -1 downwards, 0 both.
    terminal : int
        The run ends with the zero of this number; 0 if it does not.

    References
    ----------
    Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993), II.6 (event location).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.events.apsis(1, 0, direction=1).kind
    'apsis'
    """

    kind: str
    parameters: tuple[tuple[str, object], ...]
    direction: EventDirection
    terminal: int

    def _to_core(self) -> dict[str, Any]:
        parameters: dict[str, Any] = dict(self.parameters)
        if self.kind == "coordinate":
            raise InvalidInput(
                "events",
                "coordinate is of runs in generalized coordinates; of bodies there are apsis, distance, energy, "
                "expression, plane, and functions f(t, position, velocity)",
            )
        if "name" in parameters and "nodes" not in parameters:
            raise InvalidInput(
                "events", f"of the function {parameters['name']!r} a run keeps its name alone; give it again"
            )
        if self.kind == "function":
            parameters["sees_turning"] = sees_turning(parameters["function"])
        return {
            "kind": self.kind,
            **parameters,
            "direction": float(self.direction),
            "last": self.terminal or None,
        }


def make_event(kind: str, direction: object, terminal: object, **parameters: Any) -> Event:
    """The event, of which direction and end have been looked at.

    Raises
    ------
    visviva.InvalidInput
        For a direction that is none of the three, or an end that is none.
    """
    sign = checked_direction(direction)
    last = whole_number("terminal", int(terminal) if isinstance(terminal, bool | np.bool) else terminal, low=0)
    return Event(kind, tuple(parameters.items()), sign, last)


def checked_direction(direction: object) -> EventDirection:
    """Which zeros are events.

    Raises
    ------
    visviva.InvalidInput
        For anything but 1, -1 and 0.
    """
    sign = number("direction", direction)
    if sign not in (-1.0, 0.0, 1.0):
        raise InvalidInput("direction", f"expected 1 for upwards, -1 for downwards or 0 for both, got {direction!r}")
    return direction_of(sign)


def direction_of(value: float) -> EventDirection:
    """The direction that a number tells by its sign, as that of an attribute of a function does in SciPy."""
    return 1 if value > 0.0 else -1 if value < 0.0 else 0
