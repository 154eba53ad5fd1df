"""Running a case, here or in a process of another SIMD tier, and what came of it as bytes."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import warnings
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np

import visviva as vv
from visviva import _core
from visviva._mergers import hosts, remaining

TIERS: list[str] = [tier for tier in _core.info()["simd_available"] if tier != _core.info()["simd"]]
Bits = dict[str, bytes | str]


def _bits(**arrays: Any) -> Bits:
    return {
        name: repr(np.shape(array)).encode() + np.ascontiguousarray(array).tobytes() for name, array in arrays.items()
    }


_LATEST: deque[tuple[Any, tuple[float, ...], dict[str, Any], tuple[Any, str]]] = deque(maxlen=4)


def execute(start: Any, t: tuple[float, ...], how: dict[str, Any]) -> tuple[Any, str]:
    """The result, also of a run that failed on the way, and how it ended: "" or the name of the refusal.

    Most laws ask for the run as the recipe has it: the last few are kept.
    """
    for other, times, options, found in _LATEST:
        if other is start and times == t and options == how:
            return found
    found = _execute(start, t, how)
    _LATEST.append((start, t, how, found))
    return found


def _execute(start: Any, t: tuple[float, ...], how: dict[str, Any]) -> tuple[Any, str]:
    with warnings.catch_warnings(action="ignore"):
        try:
            return start.run(t=list(t), **how), ""
        except (vv.CloseEncounter, vv.ConvergenceError) as error:
            return error.trajectory, type(error).__name__
        except vv.InvalidInput as error:
            return None, f"refused {error.argument}"


def outcome(start: Any, t: tuple[float, ...], how: dict[str, Any]) -> Bits:
    """Everything that a run gives, as bytes: columns, status, where it ended and what it cost."""
    result, ended = execute(start, t, how)
    if result is None:
        return {"ended": ended}
    columns = {name: getattr(result, name) for name in result.recorded}
    found = _bits(t=result.t, **columns) | events(result, how) | collisions(result, how)
    if isinstance(start, vv.Scene):
        found |= {"ended": ended, **_bits(status=np.int8(result.status)), **final(result)}
        found["steps"] = f"{result.stats.steps} {result.stats.rejected} {result.stats.evaluations}"
    else:
        found |= _bits(status=result.status, **result.per_trajectory)
        found["ended"] = ended
    return found


def events(result: Any, how: dict[str, Any]) -> Bits:
    """The table of what was found, if anything was looked for."""
    if not how.get("events"):
        return {}
    columns = {name: getattr(result.events, name) for name in ("which", "t", "position", "velocity", "member")}
    return {f"events {name}": value for name, value in _bits(**columns).items()}


def collisions(result: Any, how: dict[str, Any]) -> Bits:
    """The table of spheres that touched, if they were looked for."""
    if not how.get("collisions"):
        return {}
    columns = {name: getattr(result.collisions, name) for name in ("t", "first", "second", "speed", "position")}
    columns |= {name: getattr(result.collisions, name) for name in ("energy_lost", "survivor", "member")}
    return {f"collisions {name}": value for name, value in _bits(**columns).items()}


def final(result: Any) -> Bits:
    end = result.final
    states = {name: getattr(end.particles, name) for name in ("mass", "radius", "position", "velocity")}
    if end.rigid_bodies is not None:
        states |= {name: getattr(end.rigid_bodies, name) for name in ("orientation", "angular_velocity")}
    return {f"final {name}": value for name, value in _bits(t0=end.t0, **states).items()}


def differences(first: Bits, second: Bits, *, of: tuple[str, ...] | None = None) -> list[str]:
    """What is not the same in both."""
    names = first.keys() | second.keys() if of is None else of
    return sorted(name for name in names if first.get(name) != second.get(name))


class Worker:
    """A process of one tier that runs what it is sent."""

    def __init__(self, tier: str) -> None:
        command = [sys.executable, str(Path(__file__).resolve())]
        environment = {**os.environ, "VISVIVA_SIMD": tier, "VISVIVA_THREADS": "1"}
        self._process = subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def outcome(self, start: Any, t: tuple[float, ...], how: dict[str, Any]) -> Bits:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        pickle.dump((start, t, how), self._process.stdin)
        self._process.stdin.flush()
        answer = pickle.load(self._process.stdout)
        if isinstance(answer, Exception):
            raise answer
        found: Bits = answer
        return found

    def close(self) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.wait()
        self._process.stdout.close()


_WORKERS: dict[str, Worker] = {}


def worker(tier: str) -> Worker:
    """The process of that tier, begun on first use."""
    if tier not in _WORKERS:
        _WORKERS[tier] = Worker(tier)
    return _WORKERS[tier]


def close_workers() -> None:
    while _WORKERS:
        _WORKERS.popitem()[1].close()


def _serve() -> None:
    answers = os.fdopen(os.dup(1), "wb")
    while True:
        try:
            asked = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        try:
            answer: Any = outcome(*asked)
        except Exception as error:  # told to the one who asked
            answer = error
        pickle.dump(answer, answers)
        answers.flush()


if __name__ == "__main__":
    _serve()


def ends_in_a_closed_form(result: Any, how: dict[str, Any]) -> bool:
    """Whether what mergers have left goes on in a closed form, which takes no steps and looks for no events."""
    if how.get("collisions") != "merge":
        return False
    runs = (
        [result] if np.ndim(result.status) == 0 else [result[int(copy)] for copy in np.flatnonzero(result.status == 0)]
    )
    for scene in (run.final for run in runs if run.status == 0):
        parts = hosts(scene.particles)
        rest = None if parts is None else remaining(scene, parts)
        if rest is not None and rest.plan(rest.t0 + 1.0).closed_form:
            return True
    return False
