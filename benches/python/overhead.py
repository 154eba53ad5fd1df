"""What a call costs before any mechanics: the import, and a closed form at one time."""

from __future__ import annotations

import subprocess
import sys
from timeit import Timer
from typing import TYPE_CHECKING

from _harness import Row, at_most, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

IMPORT = "import time, numpy; start = time.perf_counter(); import visviva; print(time.perf_counter() - start)"


def import_time() -> float:
    """Least seconds of ``import visviva`` in a fresh process that has imported NumPy."""
    return min(
        float(subprocess.run([sys.executable, "-c", IMPORT], capture_output=True, text=True, check=True).stdout)
        for _ in range(15)
    )


def call_time(scene: vv.Scene) -> float:
    """Least seconds of ``scene.run(t=1.0)`` and looking at the position."""
    return min(Timer(lambda: scene.run(t=1.0).position).repeat(40, 200)) / 200


def rows() -> Iterator[Row]:
    yield at_most("`import visviva` after numpy", import_time() * 1e3, 60.0, " ms", form=".1f")
    one = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    for name, scene in (
        ("free motion", vv.Scene(one)),
        ("uniform field", vv.Scene(one, vv.UniformField([0.0, 0.0, -9.81]))),
        ("Kepler, e = 0.5", vv.problems.kepler(e=0.5).scene),
    ):
        yield at_most(f"{name}: `scene.run(t=1.0).position`", call_time(scene) * 1e6, 60.0, " µs", form=".1f")


if __name__ == "__main__":
    report("Overhead", rows(), "Least of many; nothing to compare with but the clock.")
