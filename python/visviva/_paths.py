"""What may stand for a file or a folder."""

from __future__ import annotations

import os

from visviva.errors import InvalidInput

__all__ = ["path_text"]


def path_text(name: str, given: object, what: str = "file") -> str:
    """Check an argument that is a path, and give it as text.

    Raises
    ------
    InvalidInput
        Naming the argument, for what is neither text nor path-like.

    Examples
    --------
    >>> from visviva._paths import path_text
    >>> path_text("to", 1.5)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: to: expected the path of a file, got float
    """
    try:
        return os.fsdecode(os.fspath(given))  # type: ignore[call-overload]
    except TypeError:
        raise InvalidInput(name, f"expected the path of a {what}, got {type(given).__name__}") from None
