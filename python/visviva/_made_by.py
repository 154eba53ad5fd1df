"""Refuse to make by hand what only a run makes: its class says how one comes by it.

Results are public so that they can be named in types and asked for their kind; nobody needs to call their classes.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NoReturn

from visviva._text import article
from visviva.errors import InvalidInput

__all__ = ["NamedCode", "made_by"]

# What is always in what the core gives, and in what it was asked.
_TIMES = {"result": "t", "asked": "outputs"}
# The last letters of what formats a number.
_NUMERIC = tuple("bcdoxXeEfFgGn%")
_WORDS = {"dict": "what the core gives", "ndarray": "an array"}


def made_by(made: object, how: str, /, **given: tuple[object, type]) -> None:
    """Check the kinds of what a result is made of.

    Parameters
    ----------
    made : object
        What is being made.
    how : str
        What gives one.
    **given : (object, type)
        Of each argument what came, and what it must be.

    Raises
    ------
    InvalidInput
        Naming the first argument of another kind.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.Trajectory(3, {})
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: scene: expected a Scene, got an int; a Trajectory is made by the run of a scene, or \
visviva.load
    """
    for argument, (value, kind) in given.items():
        if not isinstance(value, kind) or (isinstance(value, dict) and _TIMES[argument] not in value):
            wanted = _WORDS.get(kind.__name__) or article(kind.__name__)
            came, result = article(type(value).__name__), article(type(made).__name__)
            raise InvalidInput(argument, f"expected {wanted}, got {came}; {result} is made by {how}")


class NamedCode(IntEnum):
    """Base of the codes of the core: numbers that print as their names.

    Raises
    ------
    InvalidInput
        For what is none of them, with those that there are.

    Examples
    --------
    >>> import visviva as vv
    >>> print(vv.Status.OK), f"{vv.Status.OK} is {vv.Status.OK:d}"
    OK
    (None, 'OK is 0')
    >>> vv.Status(99)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: Status: expected one of 0 (OK), 1 (CLOSE_ENCOUNTER), 2 (STEP_FAILURE), \
3 (INTERRUPTED), 4 (TOO_MANY_STEPS), 5 (STOPPED), 6 (OUTSIDE_DOMAIN), 7 (RESTING), got 99
    """

    def __str__(self) -> str:
        return self.name

    def __format__(self, spec: str) -> str:
        # Who asks for what only numbers have gets the number.
        try:
            return format(int(self) if spec.endswith(_NUMERIC) or spec.startswith("0") else self.name, spec)
        except ValueError:
            return format(int(self), spec)

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        known = ", ".join(f"{member.value} ({member.name})" for member in cls)
        raise InvalidInput(cls.__name__, f"expected one of {known}, got {value!r}")
