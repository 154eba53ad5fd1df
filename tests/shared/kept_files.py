"""Files of results, taken apart and put together again; whether damaged ones are refused, and full disks survived."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv


def parts(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """The header and the arrays of a file."""
    with np.load(path) as file:
        arrays = dict(file)
    return json.loads(arrays.pop("header").tobytes()), arrays


def written(path: Path, header: object, arrays: dict[str, np.ndarray]) -> Path:
    """A file of these, whose header may be any text."""
    text = header if isinstance(header, bytes) else json.dumps(header).encode()
    np.savez(path, header=np.frombuffer(text, np.uint8), **arrays)
    return path


def refused(path: Path, use: Callable[[Any], object] = lambda out: None) -> bool:
    """Whether the file is refused by name; if it loads, it can be used."""
    try:
        out = vv.load(path)
    except vv.InvalidInput as error:
        if error.argument != "path":
            raise
        return True
    use(out)
    return False


def the_old_file_stays(path: Path, old: Any, new: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two results the second, saved over the first where the disk is full, leaves that alone and nothing beside."""
    old.save(path)
    before = path.read_bytes()

    def full_disk(file: Any, **_: object) -> None:
        file.write(b"half")
        raise OSError("no space left")

    monkeypatch.setattr(np, "savez", full_disk)
    with pytest.raises(OSError, match="no space left"):
        new.save(path)
    assert path.read_bytes() == before
    assert [entry.name for entry in path.parent.iterdir()] == [path.name]
