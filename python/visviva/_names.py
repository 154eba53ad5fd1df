"""Names of bodies: what may be one, and which body one stands for.

The one idea: a name is resolved to the index of a body where the bodies are known (a scene, a request), so the core,
files of forces and events, and everything below deal with indices alone.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from visviva._arrays import whole_number
from visviva._keywords import did_you_mean
from visviva.errors import InvalidInput

__all__ = ["CENTER_OF_MASS", "JACOBI", "body_index", "body_indices", "body_label", "checked_names"]

# What an orbit may be about beside a body; no body may be called so.
CENTER_OF_MASS, JACOBI = "center_of_mass", "jacobi"


def checked_names(given: object, count: int) -> tuple[str, ...]:
    """The names of `count` bodies, all different; none at all if None or nothing is given.

    Examples
    --------
    >>> from visviva._names import checked_names
    >>> checked_names(["Sun", "Sun"], 2)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: names: expected a name of its own for each body, got 'Sun' twice
    """
    if given is None:
        return ()
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise InvalidInput("names", f"expected a sequence of names, one for each body, got {given!r}")
    names = tuple(given)
    for name in names:
        if not isinstance(name, str) or not name.strip():
            raise InvalidInput("names", f"expected names that are texts and not empty, got {name!r}")
        if name in (CENTER_OF_MASS, JACOBI):
            raise InvalidInput("names", f"expected another name than {name!r}, which orbits may be about")
    if names and len(names) != count:
        raise InvalidInput("names", f"expected {count} names, one for each body, got {len(names)}")
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise InvalidInput("names", f"expected a name of its own for each body, got {twice!r} twice")
    return tuple(map(str, names))


def body_index(argument: str, value: object, names: tuple[str, ...], count: int | None = None) -> int:
    """The index of the body that a name or an index stands for; `count` is the number of bodies, if it is known.

    Examples
    --------
    >>> from visviva._names import body_index
    >>> body_index("body", "Mars", ("Sun", "Mars"))
    1
    """
    if not isinstance(value, str):
        return whole_number(argument, value, low=0, high=2**63 - 1 if count is None else count - 1)
    if value in names:
        return names.index(value)
    if not names:
        raise InvalidInput(argument, f"expected the index of a body, got {value!r}: these bodies have no names")
    shown = ", ".join(names[:12]) + (", …" if len(names) > 12 else "")
    raise InvalidInput(argument, f"expected one of the bodies {shown}, got {value!r}{did_you_mean(value, names)}")


def body_indices(argument: str, value: Any, names: tuple[str, ...], count: int) -> list[int]:
    """The indices of several bodies, given by names, indices, a slice or a mask."""
    if isinstance(value, slice):
        return list(range(count))[value]
    if isinstance(value, np.ndarray) and value.dtype == np.bool:
        if value.shape != (count,):
            raise InvalidInput(argument, f"expected a mask of shape ({count},), got {value.shape}")
        return np.flatnonzero(value).tolist()
    if isinstance(value, str) or not isinstance(value, Iterable):
        return [body_index(argument, value, names, count)]
    return [body_index(argument, each, names, count) for each in value]


def body_label(index: int, names: tuple[str, ...]) -> str:
    """What a message calls a body."""
    return names[index] if names else f"body {index}"
