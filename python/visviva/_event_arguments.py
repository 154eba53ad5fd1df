"""What events are told of: bodies, by number or name, and points.

The one idea: a name waits for the scene to say which body it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._arrays import float_array, whole_number
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["body_of", "check_two", "point_of"]


def body_of(name: str, value: object) -> int | str:
    """The number of a body, or its name.

    Raises
    ------
    visviva.InvalidInput
        For what is neither.
    """
    return value if isinstance(value, str) else whole_number(name, value, low=0)


def check_two(name: str, first: int | str, second: int | str) -> None:
    """Refuse one body in the place of two.

    Raises
    ------
    visviva.InvalidInput
        Naming the second.
    """
    if first == second:
        raise InvalidInput(name, f"expected two bodies, got {first} twice")


def point_of(name: str, value: ArrayLike) -> tuple[float, float, float]:
    """A point, or a vector.

    Raises
    ------
    visviva.InvalidInput
        For another shape, or what are no numbers.
    """
    x, y, z = float_array(name, value, (3,)).tolist()
    return x, y, z


def __dir__() -> list[str]:
    return list(__all__)
