"""Write a file of a header and arrays: whole, or not at all.

Every such file is an ``.npz``: ``header`` (UTF-8 JSON as bytes) beside the arrays, no pickle.
"""

from __future__ import annotations

import errno
import json
import os
import secrets
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from visviva._paths import path_text

if TYPE_CHECKING:
    from collections.abc import Mapping
    from os import PathLike

__all__ = ["to_disk", "write"]


def write(path: str | PathLike[str], header: Mapping[str, Any], arrays: Mapping[str, Any]) -> None:
    """Write a file that appears whole or not at all.

    Raises
    ------
    visviva.InvalidInput
        If ``path`` is no path.
    OSError
        If it cannot be written.
    """
    name = path_text("path", path)
    text = json.dumps(header, default=_plain).encode()
    # A link stays a link: what it points to is written.
    target = Path(os.path.realpath(name)) if name else Path()
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder to save in", str(target.parent))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "expected a file to save in, but this is a folder", name)
    # A name of its own for each call: two threads or processes that save to one path do not meet.
    partial = target.with_name(f"{target.name}.{secrets.token_hex(8)}.part")
    try:
        with partial.open("xb") as file:
            np.savez(file, header=np.frombuffer(text, dtype=np.uint8), **arrays)
            to_disk(file)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)


def to_disk(file: IO[Any]) -> None:
    """Wait until the disk has it: a file that takes its name before that is empty after a power cut."""
    file.flush()
    os.fsync(file.fileno())


def _plain(value: object) -> Any:
    """NumPy scalars and arrays of the header as JSON has them; floats keep every bit."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"cannot write {type(value).__name__} into the header")
