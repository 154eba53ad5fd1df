"""Saved runs: one ``.npz`` file, arrays and a JSON header, no pickle.

A file of version 1 holds ``header`` (UTF-8 JSON as bytes), ``t``, ``status``, ``mass``, ``position`` and
``velocity`` of the start with a leading axis over copies, ``column/<name>``, ``final/<name>`` and
``per_trajectory/<name>``. Every later version of visviva must load it: `tests/reference` keeps one.
"""

from __future__ import annotations

import errno
import json
import os
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import visviva
from visviva._keywords import known_keywords
from visviva.ensemble import EnsembleScene, EnsembleTrajectory
from visviva.errors import InvalidInput
from visviva.forces import force_from_core
from visviva.particles import Particles
from visviva.scene import Scene
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from os import PathLike

    from visviva.recorded import Recorded

__all__ = ["load", "save"]

FORMAT = "visviva run"
VERSION = 1
_GROUPS = ("columns", "final", "per_trajectory")


@known_keywords
def save(path: str | PathLike[str], run: Recorded) -> None:
    """Write a trajectory or an ensemble; the file appears whole or not at all.

    Parameters
    ----------
    path : path-like
        Written exactly as given; no ending is added. The folder must exist.
    run : Trajectory or EnsembleTrajectory
    """
    result = run._result
    start = run._start._keywords
    header = {
        "format": FORMAT,
        "version": VERSION,
        "written_by": visviva.__version__,
        "ensemble": run._start._is_ensemble,
        "t0": start["t0"],
        "forces": start["forces"],
        "stats": result["stats"],
        "plan": result["plan"],
    }
    arrays = {"t": result["t"], "status": result["status"]}
    arrays |= {name: start[name] for name in ("mass", "position", "velocity")}
    arrays |= {f"{group}/{name}": array for group in _GROUPS for name, array in result[group].items()}
    text = json.dumps(header, default=_plain).encode()
    target = Path(path)
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder to save the run in", str(target.parent))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "expected a file to save the run in, but this is a folder", str(path))
    partial = target.with_name(f"{target.name}.{os.getpid()}.part")
    try:
        with partial.open("wb") as file:
            np.savez(file, header=np.frombuffer(text, dtype=np.uint8), **arrays)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)


@known_keywords
def load(path: str | PathLike[str]) -> Trajectory | EnsembleTrajectory:
    """Read a file that `Trajectory.save` or `EnsembleTrajectory.save` wrote, of this or an earlier version.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Trajectory or EnsembleTrajectory
        Whichever was saved.

    Raises
    ------
    visviva.InvalidInput
        If the file is not one of these, is damaged, or was written by a later version of the format.
    FileNotFoundError
        If there is no such file.

    Examples
    --------
    >>> import pathlib, tempfile, visviva as vv
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "run.npz"
    >>> vv.problems.figure_eight().scene.run(t=1.0).save(path)
    >>> vv.load(path).final.t0
    1.0
    """
    name = os.fspath(path)
    try:
        # Opened here because NumPy leaves the file open when it finds it damaged.
        with open(name, "rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        header = json.loads(arrays.pop("header").tobytes())
        found, version = header["format"], int(header["version"])
    except (ValueError, KeyError, TypeError, AttributeError, EOFError, zipfile.BadZipFile) as error:
        raise InvalidInput("path", f"expected a run that visviva saved, but {name!r} is none, or is damaged") from error
    if found != FORMAT:
        raise InvalidInput("path", f"expected a {FORMAT!r}, but {name!r} holds a {found!r}")
    if version > VERSION:
        raise InvalidInput(
            "path", f"the file has format version {version}, this visviva reads up to {VERSION}; use a newer visviva"
        )
    return _restore(header, arrays)


def _restore(header: dict[str, Any], arrays: dict[str, Any]) -> Trajectory | EnsembleTrajectory:
    result: dict[str, Any] = {group: {} for group in _GROUPS}
    result |= {"t": arrays["t"], "status": arrays["status"], "stats": header["stats"], "plan": header["plan"]}
    for name, array in arrays.items():
        group, _, member = name.partition("/")
        if member:
            result[group][member] = array
    forces = [force_from_core(description) for description in header["forces"]]
    first = Particles(arrays["mass"][0], arrays["position"][0], arrays["velocity"][0])
    scene = Scene(first, *forces, t0=header["t0"])
    if not header["ensemble"]:
        return Trajectory(scene, result)
    copies = EnsembleScene(scene, mass=arrays["mass"], position=arrays["position"], velocity=arrays["velocity"])
    return EnsembleTrajectory(copies, result)


def _plain(value: object) -> Any:
    """NumPy scalars and arrays of the header as JSON has them; floats keep every bit."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"cannot write {type(value).__name__} into the header")
