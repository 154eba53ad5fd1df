"""Saved runs: one ``.npz`` file, arrays and a JSON header, no pickle.

A file of version 1 holds ``header`` (UTF-8 JSON as bytes), ``t``, ``status``, ``mass``, ``position`` and
``velocity`` of the start with a leading axis over copies, ``column/<name>``, ``final/<name>`` and
``per_trajectory/<name>``, ``rigid/<name>`` of rigid bodies, ``radius`` of spheres and ``collisions/<name>``, and
``events/<name>`` of a run with events, whose definitions are in the header, as are the names of bodies. What a run left
behind for another to go on with is in ``final/held`` and ``final/node``; what the run itself went on with in
``final/start_<name>``. Every later version of visviva must load it: `tests/reference` keeps one.
Files of runs in generalized coordinates are those of `visviva.generalized._saved`, of counts those of
`visviva.scattering._saved` and `visviva.scattering._foil_saved`.
What a file holds is checked when it is loaded (`visviva._stored`), so that nothing fails later.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np

import visviva
from visviva._continuation import ARRAYS, SHARED, turning, with_continuation
from visviva._files import write
from visviva._keywords import known_keywords
from visviva._own_forces import Acting
from visviva._paths import path_text
from visviva._stored import COUNTS, FOIL, FORMAT, GENERALIZED, GROUPS, VERSION, Damaged, check_contents, read_file
from visviva._turning import loads_of_copies_from_file, rigid_for_file, rigid_from_file
from visviva.ensemble import EnsembleScene
from visviva.ensemble_trajectory import EnsembleTrajectory
from visviva.errors import InvalidInput
from visviva.forces import force_from_core
from visviva.particles import Particles
from visviva.plan import plan_as_dict
from visviva.scene import Scene
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from os import PathLike

    from visviva.forces import Force
    from visviva.generalized import GeneralizedEnsembleTrajectory, GeneralizedTrajectory
    from visviva.recorded import Recorded
    from visviva.scattering import FoilResult, MonteCarlo

    _Saved: TypeAlias = (
        Trajectory
        | EnsembleTrajectory
        | GeneralizedTrajectory
        | GeneralizedEnsembleTrajectory
        | MonteCarlo
        | FoilResult
    )

__all__ = ["load", "save"]

# Who reads files of other formats.
_OTHERS = {
    GENERALIZED: "visviva.generalized._saved",
    COUNTS: "visviva.scattering._saved",
    FOIL: "visviva.scattering._foil_saved",
}


@known_keywords
def save(path: str | PathLike[str], run: Recorded) -> None:
    """Write a trajectory or an ensemble; the file appears whole or not at all.

    Parameters
    ----------
    path : path-like
        Written exactly as given; no ending is added. The folder must exist. A link is followed.
    run : Trajectory or EnsembleTrajectory

    Raises
    ------
    visviva.InvalidInput
        If ``path`` is no path.
    OSError
        If it cannot be written.
    """
    path_text("path", path)  # before anything is gathered
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
        "plan": plan_as_dict(result["plan"]),
    }
    if start["own_forces"] is not None:
        header["own_forces"] = start["own_forces"]
    if run._start._names:
        header["names"] = run._start._names
    if "looked_for" in result:
        header["events"] = result["looked_for"]
    if "continuation" in result:
        header["continuation"] = result["continuation"]
    about_rigid, of_rigid = rigid_for_file(run._scene, start["rigid"])
    header |= about_rigid
    arrays = {"t": result["t"], "status": result["status"]}
    arrays |= {name: start[name] for name in ("mass", "position", "velocity")}
    arrays |= {f"{group}/{name}": array for group in GROUPS for name, array in result[group].items()}
    arrays |= {f"events/{name}": array for name, array in result.get("events", {}).items()}
    arrays |= {f"collisions/{name}": array for name, array in result.get("collisions", {}).items()}
    arrays |= of_rigid
    if start["rigid"] is not None:
        arrays |= {f"rigid/{name}": start["rigid"][name] for name in ("orientation", "angular_velocity")}
    if isinstance(run._start, EnsembleScene):
        arrays |= {f"rigid/own_{name}": each for name, each in run._start._inertia.items()}
    if start["radius"] is not None:
        arrays["radius"] = start["radius"]
    if start["continuation"] is not None:
        before = dict(start["continuation"])
        header["start_continuation"] = {name: before.pop(name) for name in (*SHARED, "node")}
        arrays |= {f"final/start_{name}": array for name, array in before.items()}
    write(path, header, arrays)


@known_keywords
def load(
    path: str | PathLike[str],
) -> Trajectory | EnsembleTrajectory | GeneralizedTrajectory | GeneralizedEnsembleTrajectory | MonteCarlo | FoilResult:
    """Read a file that ``save`` of a trajectory, an ensemble or counts wrote, of this or an earlier version.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Trajectory or EnsembleTrajectory, or in generalized coordinates GeneralizedTrajectory or \
GeneralizedEnsembleTrajectory, or of events that were counted MonteCarlo or FoilResult
        Whichever was saved.

    Raises
    ------
    visviva.InvalidInput
        If the file is not one of these, is damaged, or was written by a later version of the format; or if ``path``
        is no path.
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
    name = path_text("path", path)
    with open(name, "rb") as stream:
        try:
            header, arrays = read_file(stream)
            if header["format"] in _OTHERS:
                return cast("_Saved", import_module(_OTHERS[header["format"]]).run_from_file(header, arrays))
            check_contents(header, arrays)
            return _run_from_file(header, arrays)
        except MemoryError:  # a good file may be too large
            raise
        except Damaged as error:
            raise InvalidInput("path", f"{error.message} ({name!r})") from error
        # NumPy, zipfile, zlib and json raise what they please, and what they let pass the parts of a scene refuse.
        except Exception as error:
            if isinstance(error, InvalidInput) and error.argument == "path":
                raise
            raise InvalidInput(
                "path", f"expected a run that visviva saved, but {name!r} is none, or is damaged: {error}"
            ) from error


def _run_from_file(header: dict[str, Any], arrays: dict[str, Any]) -> Trajectory | EnsembleTrajectory:
    result: dict[str, Any] = {group: {} for group in GROUPS}
    result |= {"t": arrays["t"], "status": arrays["status"], "stats": header["stats"], "plan": header["plan"]}
    if "continuation" in header:
        result["continuation"] = header["continuation"]
    if any(name.startswith("events/") for name in arrays):
        result |= {"events": {}, "looked_for": header.get("events", [])}
    if any(name.startswith("collisions/") for name in arrays):
        result["collisions"] = {}
    before: Any = header.get("start_continuation")
    if before is not None:
        # Files of before rigid bodies went on have none.
        before |= turning(None, len(arrays["mass"]))
        there = [name for name in ARRAYS if f"final/start_{name}" in arrays]
        before |= {name: arrays.pop(f"final/start_{name}") for name in there}
    for name, array in arrays.items():
        group, _, member = name.partition("/")
        if member and group != "rigid":
            result[group][member] = array
    forces = [force_from_core(description) for description in header["forces"]]
    names = header.get("names")
    radius = arrays.get("radius", np.zeros(arrays["mass"].shape))
    first = Particles(arrays["mass"][0], arrays["position"][0], arrays["velocity"][0], names, radius[0])
    bodies, loads = rigid_from_file(header, arrays, first)
    scene = Scene(*bodies, *forces, *loads, t0=header["t0"])
    run: Trajectory | EnsembleTrajectory
    if header["ensemble"]:
        count = len(arrays["mass"])
        own_forces = _forces_of_copies(header) or (scene.forces,) * count
        own_loads = loads_of_copies_from_file(header) or (scene.body_forces,) * count
        copies = EnsembleScene._of(
            scene,
            Acting(own_forces, own_loads),
            mass=arrays["mass"],
            position=arrays["position"],
            velocity=arrays["velocity"],
            radius=radius,
            orientation=arrays.get("rigid/orientation"),
            angular_velocity=arrays.get("rigid/angular_velocity"),
            moments=arrays.get("rigid/own_moments"),
            inertia=arrays.get("rigid/own_inertia"),
        )
        run = EnsembleTrajectory(with_continuation(copies, before), result)
    else:
        run = Trajectory(with_continuation(scene, before), result)
    _ = run.stats, run.plan, run.status, "events" in result and run.events
    _ = "collisions" in result and run.collisions
    return run


def _forces_of_copies(header: dict[str, Any]) -> tuple[tuple[Force, ...], ...] | None:
    """The forces on points of each copy; None where they are the same in all."""
    if header.get("own_forces") is None:
        return None
    sets, of_copy = header["own_forces"]
    of_first = list(map(force_from_core, sets[0]))
    # Most sets have most forces of the first: made once, they are checked and compared once.
    own = [
        tuple(
            known if description == told else force_from_core(description)
            for description, told, known in zip(forces, sets[0], of_first, strict=True)
        )
        for forces in sets
    ]
    return tuple(own[which] for which in of_copy)


def __dir__() -> list[str]:
    return list(__all__)
