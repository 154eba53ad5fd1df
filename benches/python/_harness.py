"""What every comparison here shares: timing of two sides in turns, the machine, the row of a table.

The one idea: a ratio of two minima taken in turns on one machine. Machines are noisy and noise only ever
adds, so the least of several repeats is what the code costs; taking the sides in turns exposes both to the
same neighbors. A missed bar is printed like a met one.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import visviva as vv
from visviva import _core

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

REPEATS = int(os.environ.get("VISVIVA_BENCH_REPEATS", "5"))
TIERS: list[str] = _core.info()["simd_available"]


@dataclass(frozen=True)
class Row:
    """One line of a table. `passed` is None where nothing was promised."""

    what: str
    ours: str
    peer: str
    ratio: str
    bar: str
    passed: bool | None

    def __str__(self) -> str:
        verdict = {True: "pass", False: "**MISSED**", None: "—"}[self.passed]
        return f"| {self.what} | {self.ours} | {self.peer} | {self.ratio} | {self.bar} | {verdict} |"


def minima(*sides: Callable[[], object], repeats: int = REPEATS) -> list[float]:
    """Least seconds of each side, taken in turns."""
    least = [float("inf")] * len(sides)
    for _ in range(repeats):
        for index, side in enumerate(sides):
            start = perf_counter()
            side()
            least[index] = min(least[index], perf_counter() - start)
    return least


def faster(what: str, ours: str, peer: str, ratio: float, bar: float | None) -> Row:
    """A row in which the peer's cost over ours must be at least `bar`."""
    passed = None if bar is None else ratio >= bar
    return Row(what, ours, peer, f"{ratio:.2f} ×", "" if bar is None else f"≥ {bar:g} ×", passed)


def at_most(what: str, value: float, bar: float, unit: str = "", peer: str = "", form: str = ".3g") -> Row:
    """A row in which our figure must be at most `bar`."""
    return Row(what, f"{value:{form}}{unit}", peer, "", f"≤ {bar:g}{unit}", value <= bar)


def machine() -> str:
    """Processor, cores, SIMD tier in force, versions."""
    model = "unknown processor"
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line.split(":", 1)[1].strip() for line in cpuinfo.read_text().splitlines() if "model name" in line]
        model = names[0] if names else model
    info = _core.info()
    versions = [f"Python {sys.version.split()[0]}", f"visviva {info['version']} ({info['profile']})"]
    for name in ("numpy", "scipy", "rebound", "heyoka", "numba", "mujoco", "trimesh"):
        try:
            versions.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            continue
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"Machine: {model}, {cores} cores, SIMD {info['simd']}; {', '.join(versions)}."


def report(title: str, rows: Iterable[Row], note: str) -> None:
    """Print a section as Markdown."""
    print(f"## {title}\n\n{note}\n\n| what | visviva | peer | ratio | bar | |\n|---|---|---|---|---|---|")
    for row in rows:
        print(row, flush=True)
    print(f"\n{machine()}\n", flush=True)


def rows_as_json(rows: Iterable[Row]) -> None:
    """Print rows for the process that asked with `rows_in_tier`."""
    print(json.dumps([asdict(row) for row in rows]))


def rows_in_tier(script: str, tier: str) -> list[Row]:
    """Rows of ``script --rows`` in a process of its own with that SIMD tier: the tier is chosen once per process."""
    command = [sys.executable, script, "--rows"]
    done = subprocess.run(
        command, env={**os.environ, "VISVIVA_SIMD": tier}, stdout=subprocess.PIPE, text=True, check=True
    )
    return [Row(**row) for row in json.loads(done.stdout)]


def rebound_simulation(scene: vv.Scene) -> object:
    """The scene as a REBOUND simulation: same masses, states, constant and softening."""
    import rebound

    gravity = next(force for force in scene.forces if isinstance(force, vv.Gravity))
    simulation = rebound.Simulation()
    simulation.G = gravity.G
    simulation.softening = gravity.softening
    simulation.gravity = "basic"
    bodies = scene.particles
    for mass, (x, y, z), (vx, vy, vz) in zip(bodies.mass, bodies.position, bodies.velocity, strict=True):
        simulation.add(m=mass, x=x, y=y, z=z, vx=vx, vy=vy, vz=vz)
    simulation.t = scene.t0
    return simulation
