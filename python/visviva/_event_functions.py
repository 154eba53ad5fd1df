"""What functions among events take: points alone, or how rigid bodies are turned, too.

The one idea: the signature tells, before anything runs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import check_call, takes

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["check_event_function", "sees_turning"]

#: What a function is called with, and beside rigid bodies.
_OF_POINTS = ("t", "position", "velocity")
_OF_RIGID_BODIES = (*_OF_POINTS, "orientation", "angular_velocity")


def sees_turning(call: Callable[..., float]) -> bool:
    """Whether a function takes orientations and angular velocities, too."""
    return not takes(call, _OF_POINTS) and takes(call, _OF_RIGID_BODIES)


def check_event_function(call: Callable[..., float]) -> None:
    """Refuse a function that can be called in neither way.

    Raises
    ------
    visviva.InvalidInput
        Naming ``call``, with what it is called with.
    """
    if not sees_turning(call):
        check_call("call", call, _OF_POINTS)


def __dir__() -> list[str]:
    return list(__all__)
