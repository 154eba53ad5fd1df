"""Runs that are written while they go on, and picked up after a crash.

The one idea: such a run is a chain of parts, each of which begins with the ``final`` of the one before and is a file
of its own (`Trajectory.save`), whole or not there at all. Where the parts end follows from what was asked alone, so it
does not matter when, how often and by what the chain was broken. Fixed steps end a part on a node, and keep the bits of
the run in one piece; adaptive ones, and those after a collision, are chosen anew in each part.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import positive, whole_number
from visviva._event_descriptions import from_description
from visviva._files import to_disk
from visviva._joined_parts import joined_result
from visviva._keywords import known_keywords
from visviva._paths import path_text
from visviva._progress import TIME, callback
from visviva.errors import InvalidInput
from visviva.io import load
from visviva.plan import plan_as_dict
from visviva.request import RunRequest, finished, fixed_steps
from visviva.status import Status
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from visviva.scene import Scene
    from visviva.typing import Progress, Report

__all__ = ["resume", "run_saved"]

_FORMAT, _VERSION = "visviva saved run", 1
_REQUEST, _START = "request.json", "start.npz"
# What is asked anew when a run is picked up: none of it changes a bit.
_ANEW = ("threads", "progress", "executor", "save_every", "save_to")
# More files than this help nobody, and a folder of them is slow.
_MOST = 100_000


@dataclass(frozen=True)
class _Part:
    """One part: its output times, and how many of them were asked for; the rest is its end."""

    times: NDArray[np.float64]
    asked: int


@known_keywords
def resume(path: str | PathLike[str], *, threads: int | None = None, progress: Progress = False) -> Trajectory:
    """Go on with a run that was written while it went on, from the last part that is whole.

    Parameters
    ----------
    path : path-like
        The folder that ``run(..., save_to=path)`` wrote.
    threads, progress
        As of `Scene.run`.

    Returns
    -------
    Trajectory
        The whole run, with the bits that it has if nothing ever breaks it. A run that had ended is read and not run.

    Raises
    ------
    visviva.InvalidInput
        If the folder holds no such run, what it began with is damaged, or a part is that of another run. A part that
        is damaged is run again.
    FileNotFoundError
        If there is no such folder.
    visviva.CloseEncounter, visviva.ConvergenceError, visviva.Interrupted
        As of `Scene.run`.

    Examples
    --------
    >>> import pathlib, tempfile, visviva as vv
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "run"
    >>> scene = vv.problems.figure_eight().scene
    >>> out = scene.run(t=5.0, method="kahan_li8", dt=0.01, save_every=1.0, save_to=path)
    >>> (path / "part-000003.npz").unlink()  # as if the machine had stopped in the fourth part
    >>> (path / "part-000004.npz").unlink()
    >>> bool((vv.resume(path).position == out.position).all())
    True
    """
    folder = Path(path_text("path", path, "folder"))
    if not folder.is_dir():
        raise FileNotFoundError(f"no such folder: {str(folder)!r}")
    try:
        request = _read(folder / _REQUEST)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InvalidInput(
            "path",
            f"expected a run that was saved as it went, in {str(folder)!r}; give the folder that save_to named: "
            f"{error}",
        ) from error
    if not (folder / _START).is_file():
        raise InvalidInput(
            "path",
            f"expected {_START}, what the run began with, in {str(folder)!r}, but it is gone; put it back or run anew",
        )
    start = _loaded(folder / _START)
    return _go_on(folder, start.scene, replace(request, threads=threads, progress=progress))


def run_saved(scene: Scene, request: RunRequest) -> Trajectory:
    """Run a scene and write it while it goes on.

    Raises
    ------
    visviva.InvalidInput
        For what cannot be written in parts, before anything runs or is written.
    """
    if request.save_to is None:
        raise InvalidInput(
            "save_to", 'expected the folder that the parts are written to, got none; name a new one, as save_to="run"'
        )
    if request.save_every is None:
        raise InvalidInput(
            "save_every",
            "expected the time of the scene after which a part is written, got none; give one of which some hundred "
            "make the run, or out.save(path) writes it when it is over",
        )
    every = positive("save_every", request.save_every)
    if request.time_transformation is not None:
        raise InvalidInput(
            "save_every",
            "steps under a time transformation follow from the start; leave save_every or time_transformation out",
        )
    asked = request.to_core(scene._keywords, scene._names)
    if any(event["kind"] == "function" for event in asked["events"]):
        raise InvalidInput("save_every", "a function of your own cannot be written; use events of visviva.events")
    if request.threads is not None:
        whole_number("threads", request.threads, 1, 1024)
    with callback(request.progress):
        pass  # it is one, or is refused
    _parts(scene, replace(request, save_every=every), asked, _core.plan(asked))
    folder = Path(path_text("save_to", request.save_to, "folder"))
    if (folder / _REQUEST).exists():
        raise InvalidInput(
            "save_to", f"there is a run in {str(folder)!r}; visviva.resume continues it, or name another folder"
        )
    if folder.exists() and not folder.is_dir():
        raise InvalidInput("save_to", f"expected a folder, got the file {str(folder)!r}; name another")
    if not folder.parent.is_dir():
        raise InvalidInput("save_to", f"expected a folder in one that exists, got {str(folder)!r}; make that one first")
    folder.mkdir(exist_ok=True)
    # A state of no length: the scene, and what it goes on with itself.
    start = RunRequest(t=[scene.t0], record=("position", "velocity")).to_core(scene._keywords, scene._names)
    # What the run is to be warned of is told of the run itself.
    Trajectory(scene, _core.run(start, threads=1, progress=None, ensemble=False)).save(folder / _START)
    written = {**_described(request, asked), "save_every": every}
    partial = folder / f"{_REQUEST}.part"
    with partial.open("w", encoding="utf-8") as file:
        file.write(json.dumps(written))
        to_disk(file)
    partial.replace(folder / _REQUEST)
    return _go_on(folder, scene, replace(request, save_every=every))


def _go_on(folder: Path, scene: Scene, request: RunRequest) -> Trajectory:
    """Read the parts that are there, run those that are not, and join them."""
    whole = request.to_core(scene._keywords, scene._names)
    plan = _core.plan(whole)
    parts = _parts(scene, request, whole, plan)
    results: list[dict[str, Any]] = []
    leg = scene
    with callback(request.progress, TIME, (scene.t0, float(whole["times"][-1]))) as report:
        for number, part in enumerate(parts):
            file = folder / f"part-{number:06}.npz"
            run = _whole(file)
            if run is not None:
                if not np.array_equal(run.t, part.times[: len(run.t)]):
                    raise InvalidInput(
                        "path", f"{str(file)!r} is not that part of this run; take it away, and that part is run again"
                    )
            elif _steps_left(request, results) == 0:
                results[-1]["status"] = np.array([Status.TOO_MANY_STEPS], dtype=np.int8)
                results[-1]["error"] = {
                    "kind": "convergence",
                    "message": "max_steps were taken before the end",
                    "time": leg.t0,
                }
                break
            else:
                run = _run_part(leg, request, plan, part, results, _scaled(report, number, len(parts)))
                if run._result["error"] is None:
                    run.save(file)
            results.append(run._result)
            if run._result.get("error") is not None or int(run._result["status"][0]) != 0:
                break
            leg = run.final
    result = joined_result(results, [part.asked for part in parts])
    result |= {"plan": plan, "error": results[-1].get("error")}
    return finished(result, whole, None, ensemble=False, make=scene._finished)


def _run_part(
    leg: Scene,
    request: RunRequest,
    plan: dict[str, Any],
    part: _Part,
    before: list[dict[str, Any]],
    report: Report | None,
) -> Trajectory:
    """One part; the method is named, so that all parts have the same, unless its equal steps are chosen here."""
    own = replace(request, t=part.times)
    asked = own.to_core(leg._keywords, leg._names)
    asked["end_only"] = False
    chosen_here = request.dt is None and plan["method"] in fixed_steps()
    if not plan["solution"].startswith("closed form") and not chosen_here:
        asked["method"] = plan["method"]
    asked["events"] = _left_of(asked["events"], before)
    if request.max_steps is not None:
        asked["max_steps"] = _steps_left(request, before)
    threads = None if request.threads is None else whole_number("threads", request.threads)
    result = _core.run(asked, threads=threads, progress=report, ensemble=False)
    if asked["events"]:
        result["looked_for"] = asked["events"]
    return Trajectory(leg, result)


def _steps_left(request: RunRequest, before: list[dict[str, Any]]) -> int | None:
    """How many of the most steps are left, of those that were given."""
    if request.max_steps is None:
        return None
    done = sum(result["stats"]["steps"] + result["stats"]["rejected"] for result in before)
    return max(whole_number("max_steps", request.max_steps) - int(done), 0)


def _left_of(events: list[dict[str, Any]], before: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The events of the next part: a run that ends with the third zero ends with the first that is left."""
    found = [0] * len(events)
    for result in before:
        for which in result["events"]["which"] if "events" in result else ():
            found[int(which)] += 1
    return [
        {**event, "last": event["last"] - number} if event["last"] else event
        for event, number in zip(events, found, strict=True)
    ]


def _parts(scene: Scene, request: RunRequest, asked: Any, plan: dict[str, Any]) -> list[_Part]:
    """The parts of a run: at whole numbers of `save_every`, which fixed steps round to a whole number of steps.

    Raises
    ------
    visviva.InvalidInput
        If there would be too many.
    """
    times = asked["times"]
    if asked["end_only"]:
        times = np.array([scene.t0, times[-1]])
    last = float(times[-1])
    forward = math.copysign(1.0, last - scene.t0)
    if plan["solution"].startswith("closed form"):
        # Any time at once: there is nothing to lose.
        return [_Part(times, len(times))]
    every = float(request.save_every or 0.0)
    base, first, step = scene.t0, 0, every
    steps_per_part = 1
    if request.dt is not None:
        step = abs(float(request.dt))
        steps_per_part = max(1, round(every / step))
        before = scene._keywords["continuation"]
        if before is not None and before["method"] == plan["method"] and before["dt"] == forward * step:
            base, first = before["t0"], before["node"]
    number = abs(last - scene.t0) / (steps_per_part * step)
    if number > _MOST:
        raise InvalidInput("save_every", f"expected at most {_MOST} parts, got {number:.3g}; give a longer time")
    # As the nodes of a run are, t0 + n·h; the last part is not left with less than half a step.
    ends = [base + forward * ((first + count * steps_per_part) * step) for count in range(1, math.ceil(number) + 1)]
    least = 0.5 * step if request.dt is not None else 1e-9 * step
    ends = [end for end in ends if (last - end) * forward > least]
    parts: list[_Part] = []
    place = 0
    for end in [*ends, last]:
        stop = int(np.searchsorted(forward * times, forward * end, side="right")) if end != last else len(times)
        own = times[place:stop]
        parts.append(_Part(own if len(own) and own[-1] == end else np.append(own, end), len(own)))
        place = stop
    return parts


def _described(request: RunRequest, asked: Any) -> dict[str, Any]:
    """The request as JSON has it; floats keep every bit."""
    told_: dict[str, Any] = {}
    for option in fields(RunRequest):
        if option.name not in _ANEW:
            told_[option.name] = getattr(request, option.name)
    told_["t"] = asked["times"] if not asked["end_only"] else float(asked["times"][-1])
    told_["events"] = asked["events"]
    told_["record"] = asked["record"]
    told_["method"] = asked["method"]
    text = json.dumps(told_, default=lambda value: np.asarray(value).tolist())
    return {"format": _FORMAT, "version": _VERSION, "request": json.loads(text)}


def _read(file: Path) -> RunRequest:
    written = json.loads(file.read_text(encoding="utf-8"))
    if written["format"] != _FORMAT:
        raise ValueError(f"the file is a {written['format']!r}")
    if written["version"] > _VERSION:
        raise ValueError(f"it has version {written['version']}, this visviva reads up to {_VERSION}")
    own = dict(written["request"])
    own["events"] = [from_description(event) for event in own["events"]]
    return RunRequest(**own, save_every=positive("save_every", written["save_every"]))


def _loaded(file: Path) -> Trajectory:
    run = load(file)
    if not isinstance(run, Trajectory):
        raise InvalidInput("path", f"expected one run in {str(file)!r}, got an ensemble")
    run._result["plan"] = plan_as_dict(run._result["plan"])
    return run


def _whole(file: Path) -> Trajectory | None:
    """A part that is there and was written to its end; one that was not is run again."""
    if not file.exists():
        return None
    try:
        return _loaded(file)
    except InvalidInput:
        return None


def _scaled(report: Report | None, number: int, parts: int) -> Report | None:
    """Progress of a part as that of the whole, in thousandths of parts."""
    if report is None:
        return None
    return lambda done, total: report(1000 * number + 1000 * done // max(total, 1), 1000 * parts)


def __dir__() -> list[str]:
    return list(__all__)
