"""Files of runs in generalized coordinates: what `GeneralizedTrajectory.save` writes and `visviva.load` reads.

A file of version 1 holds ``header`` and arrays. The header has the system as the core takes it (``source``, its nodes
are the equations), a state of it, ``projects`` if starts are put on its constraints, the method and the definitions of
events; arrays are ``start`` (B, 2n) and
``parameters`` (B, P) of the copies, one of a single run; ``times`` (T,) that were asked for; ``t`` and ``y``, rows of
all copies one after the other, ``lengths`` of them; ``status``, ``steps``, ``evaluations`` and ``longest_step`` of each
copy; what events found: ``found`` of each copy, ``events/which``, ``events/t`` and ``events/state``; and, but in the
earliest files, ``last/t`` and ``last/state`` (B, 2n), where each copy's last step ended. No text of a file is ever
evaluated. Every later version of visviva must load it: `tests/reference` keeps one.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

import visviva
from visviva._files import write
from visviva._keywords import known_keywords
from visviva._stored import GENERALIZED, Damaged, check_all, check_keys, check_version
from visviva.events import Event
from visviva.generalized._source import Source
from visviva.generalized._states import _system_from_parts, as_system
from visviva.generalized._symbolic import named_symbols, symbols_of_names
from visviva.status import Status

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from visviva.generalized._ensemble_trajectory import GeneralizedEnsembleTrajectory
    from visviva.generalized._system import GeneralizedSystem
    from visviva.generalized._trajectory import GeneralizedTrajectory

__all__ = ["VERSION", "Saved", "run_from_file"]

VERSION = 1

_PLAIN = (bool, int, float, str, type(None))
_HEADER: dict[str, type | tuple[type, ...]] = {
    "ensemble": bool,
    "source": dict,
    "values": list,
    "position": (list, type(None)),
    "second": list,
    "t0": (int, float),
    "method": str,
    "events": list,
}
_SOURCE: dict[str, type | tuple[type, ...]] = {
    "kind": str,
    "names": list,
    "parameters": list,
    "description": dict,
    "symbols": (list, type(None)),
    "points": (list, type(None)),
}
_EVENT: dict[str, type | tuple[type, ...]] = {"kind": str, "parameters": dict, "direction": int, "terminal": int}
_ARRAYS: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "start": ("f8", ("B", "2n")),
    "parameters": ("f8", ("B", "P")),
    "times": ("f8", ("T",)),
    "t": ("f8", ("rows",)),
    "y": ("f8", ("rows", "2n")),
    "lengths": ("i8", ("B",)),
    "status": ("i1", ("B",)),
    "steps": ("i8", ("B",)),
    "evaluations": ("i8", ("B",)),
    "longest_step": ("f8", ("B",)),
    "found": ("i8", ("B",)),
    "events/which": ("i8", ("E",)),
    "events/t": ("f8", ("E",)),
    "events/state": ("f8", ("E", "2n")),
}
_LAST: dict[str, tuple[str, tuple[str | int, ...]]] = {
    "last/t": ("f8", ("B",)),
    "last/state": ("f8", ("B", "2n")),
}


@known_keywords
class Saved:
    """Base of what a file can hold: `GeneralizedTrajectory` and `GeneralizedEnsembleTrajectory`."""

    __slots__ = ()

    def save(self, path: str | PathLike[str]) -> None:
        """Write the run to a file for `visviva.load`, which appears whole or not at all.

        The equations are in it, as the core has them. Of functions of one's own (points of pictures, events) it keeps
        names alone, of expressions as events their text.

        Parameters
        ----------
        path : path-like
            Written exactly as given; the folder must exist.

        Raises
        ------
        InvalidInput
            If ``path`` is no path.
        OSError
            If it cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile, visviva as vv
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "run.npz"
        >>> vv.systems.pendulum(position=[0.5]).run(t=1.0).save(path)
        >>> vv.load(path).final.run(t=2.0).t.tolist()
        [1.0, 2.0]
        """
        run: Any = self
        ensemble = hasattr(run, "ensemble")
        system = run.ensemble.system if ensemble else run.system
        method, looked_for, arrays = _arrays_of_ensemble(run) if ensemble else _arrays_of_run(run)
        header = {
            "format": GENERALIZED,
            "version": VERSION,
            "written_by": visviva.__version__,
            "ensemble": ensemble,
            "source": _source(system._source),
            "values": system._values,
            "position": system.position,
            "second": system._second,
            "t0": system.t0,
            "method": method,
            "events": [_event(event) for event in looked_for],
        }
        if system._projects:
            header["projects"] = True
        kept = {name: np.asarray(arrays[name], dtype=dtype) for name, (dtype, _) in (_ARRAYS | _LAST).items()}
        write(path, header, kept)


def _arrays_of_run(run: GeneralizedTrajectory) -> tuple[str, tuple[Event, ...], dict[str, Any]]:
    found, looked_for = run._found
    arrays = {name: [getattr(run, name)] for name in ("status", "steps", "evaluations", "longest_step")}
    arrays |= {"start": [run.system._start()], "parameters": [run.system._values], "lengths": [len(run.t)]}
    arrays |= {"last/t": [run._last[0]], "last/state": [run._last[1]]}
    return run.method, looked_for, arrays | {"times": run.t, "t": run.t, "y": run._states} | _event_arrays(found)


def _arrays_of_ensemble(run: GeneralizedEnsembleTrajectory) -> tuple[str, tuple[Event, ...], dict[str, Any]]:
    result = run._result
    arrays = {name: result[name] for name in ("t", "y", "lengths", "steps", "evaluations", "longest_step")}
    arrays |= {"start": run.ensemble._states, "parameters": run.ensemble._parameters}
    arrays |= {"last/t": result["last_t"], "last/state": result["last_y"]}
    asked = run._asked
    return asked["method"], asked["looked_for"], arrays | {"times": run.t, "status": run.status} | _event_arrays(result)


def _event_arrays(result: dict[str, Any]) -> dict[str, Any]:
    kept = {"found": "found", "events/which": "found_which", "events/t": "found_t", "events/state": "found_y"}
    return {name: result[own] for name, own in kept.items()}


def run_from_file(
    header: dict[str, Any], arrays: dict[str, NDArray[Any]]
) -> GeneralizedTrajectory | GeneralizedEnsembleTrajectory:
    """The run or the ensemble of a file, of which everything is checked.

    Raises
    ------
    Damaged
        If something is missing or not as it should be.
    visviva.InvalidInput
        For a system that could not be made.
    """
    from visviva.generalized._ensemble import GeneralizedEnsemble
    from visviva.generalized._ensemble_trajectory import GeneralizedEnsembleTrajectory
    from visviva.generalized._trajectory import STATUS, GeneralizedTrajectory

    _check(header, arrays)
    system = _system(header)
    n = len(system.coordinates)
    if arrays["start"].shape[1] != 2 * n or arrays["parameters"].shape[1] != len(system.parameters):
        raise Damaged("the file has states or parameters of another system than its own")
    endings = {status: ending for ending, status in STATUS.items()}
    result: dict[str, Any] = {
        name: arrays[name].tolist() for name in ("lengths", "steps", "evaluations", "longest_step", "found")
    }
    result |= {"t": arrays["t"], "y": arrays["y"], "endings": [endings[Status(each)] for each in arrays["status"]]}
    result |= {"found_which": arrays["events/which"].tolist()}
    result |= {"found_t": arrays["events/t"], "found_y": arrays["events/state"]}
    result |= _last(arrays, system.t0)
    asked = {"method": header["method"], "looked_for": _events(header["events"]), "outputs": arrays["times"]}
    if not header["ensemble"]:
        return GeneralizedTrajectory(system, result, asked)
    own = dict(zip(system.parameters, arrays["parameters"].T, strict=True))
    copies = GeneralizedEnsemble(system, arrays["start"][:, :n], arrays["start"][:, n:], own)
    return GeneralizedEnsembleTrajectory(copies, result, asked)


def _last(arrays: dict[str, NDArray[Any]], t0: float) -> dict[str, Any]:
    """Where the last steps ended; of files that do not tell, the last rows."""
    if "last/t" in arrays:
        return {"last_t": arrays["last/t"].tolist(), "last_y": arrays["last/state"]}
    times, states = np.full(len(arrays["start"]), t0), arrays["start"].copy()
    ends = np.cumsum(arrays["lengths"])
    for member, (length, end) in enumerate(zip(arrays["lengths"], ends, strict=True)):
        if length:
            times[member], states[member] = arrays["t"][end - 1], arrays["y"][end - 1]
    return {"last_t": times.tolist(), "last_y": states}


def _check(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> None:
    from visviva.generalized._trajectory import STATUS

    check_version(header, VERSION)
    check_keys("header", header, _HEADER)
    check_keys("account of the system", header["source"], _SOURCE)
    lengths: dict[str, int] = {}
    check_all(_ARRAYS, arrays, lengths)
    if _LAST.keys() & arrays.keys():
        check_all(_LAST, arrays, lengths)
    if not lengths["B"] or (not header["ensemble"] and lengths["B"] != 1):
        raise Damaged(f"the file has {lengths['B']} copies")
    for each, of in (("lengths", "rows"), ("found", "E")):
        if (arrays[each] < 0).any() or arrays[each].sum() != lengths[of]:
            raise Damaged(f"the array {each!r} of the file does not count what there is")
    if header["ensemble"] and (arrays["lengths"] > lengths["T"]).any():
        raise Damaged("the file has more rows of a copy than times that were asked for")
    which = arrays["events/which"]
    if ((which < 0) | (which >= len(header["events"]))).any():
        raise Damaged("the file has an event that was not looked for")
    if not np.isin(arrays["status"], [int(status) for status in STATUS.values()]).all():
        raise Damaged("the file has a status that this version does not know")
    stopped = (arrays["status"] == int(Status.STOPPED)) & (arrays["found"] == 0)
    if stopped.any():
        raise Damaged("the file has a run that an event ended, and not the event")


def _source(source: Source) -> dict[str, Any]:
    """A system as JSON has it; of points of a picture, where visviva has them."""
    points = [getattr(source.points, "__module__", ""), getattr(source.points, "__qualname__", "")]
    return {
        "kind": source.kind,
        "names": source.names,
        "parameters": source.parameters,
        "description": source.description,
        "symbols": None if source.symbols is None else named_symbols(source.symbols),
        "points": points if _points(points) is source.points else None,
    }


def _points(where: Any) -> Any:
    """The function of `visviva.systems` of this module and name; None if it is none of those."""
    module, name = map(str, where)
    if not module.startswith("visviva.systems._") or not name.isidentifier():
        return None
    try:
        found = getattr(import_module(module), name, None)
    except ImportError:
        return None
    return found if callable(found) and getattr(found, "__module__", None) == module else None


def _system(header: dict[str, Any]) -> GeneralizedSystem:
    stored = header["source"]
    description = dict(stored["description"])
    description["nodes"] = [(str(operation), list(of), float(value)) for operation, of, value in description["nodes"]]
    names, parameters = tuple(stored["names"]), tuple(stored["parameters"])
    if not all(isinstance(name, str) for name in (*names, *parameters)):
        raise Damaged("the file has names that are no words")
    symbols = None if stored["symbols"] is None else symbols_of_names(stored["symbols"])
    if symbols is not None and tuple(map(len, symbols)) != (len(names), len(names), len(parameters)):
        raise Damaged("the file has symbols of another system than its own")
    points = None if stored["points"] is None else _points(stored["points"])
    source = Source(stored["kind"], names, symbols, parameters, description, points)
    if (description["kind"], description["coordinates"], description["parameters"]) != (
        source.kind,
        len(names),
        len(parameters),
    ):
        raise Damaged("the file has equations of another system than its own")
    state = (header["position"], header["second"], header["t0"])
    projects = header.get("projects") is True
    return as_system(_system_from_parts(_kinds()[source.kind], source, header["values"], state, projects))


def _kinds() -> dict[str, type[GeneralizedSystem]]:
    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

    return {"lagrangian": Lagrangian, "hamiltonian": Hamiltonian}


def _event(event: Event) -> dict[str, Any]:
    """An event as JSON has it; of an expression its text."""
    kept = {name: value if isinstance(value, _PLAIN) else str(value) for name, value in event.parameters}
    if "expression" in kept:
        kept = {"name": kept["expression"]}
    return {
        "kind": event.kind,
        "parameters": kept,
        "direction": event.direction,
        "terminal": event.terminal,
    }


def _events(kept: list[Any]) -> tuple[Event, ...]:
    events = []
    for each in kept:
        if not isinstance(each, dict):
            raise Damaged("the file has an event that says nothing")
        check_keys("account of an event", each, _EVENT)
        parameters = tuple((str(name), value) for name, value in each["parameters"].items())
        events.append(Event(each["kind"], parameters, each["direction"], each["terminal"]))
    return tuple(events)
