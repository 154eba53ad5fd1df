"""What may stand for a file or a folder."""

from __future__ import annotations

import os
from contextlib import suppress

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
    if isinstance(given, str | bytes | os.PathLike):
        with suppress(TypeError):  # of a path-like whose text is none
            return os.fsdecode(given)
    raise InvalidInput(name, f"expected the path of a {what}, got {type(given).__name__}")
