"""What outputs cost: leapfrog of six bodies with ten and with two steps per output, against the end only.

Whole `scene.run` calls: arrays, trajectory and all. REBOUND beside it, asked the usual way: a loop of
``integrate`` to each time with ``exact_finish_time=0`` and ``serialize_particle_data``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, minima, rebound_simulation, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

STEP = 10.0
"""2000 steps hold the 1001 outputs of the bar; 20 000 fill more memory than the caches, fresh at each run."""
LENGTHS = 2_000, 20_000


def rows() -> Iterator[Row]:
    for steps in LENGTHS:
        yield from rows_of(steps)


def rows_of(steps: int) -> Iterator[Row]:
    scene = vv.problems.outer_solar_system().scene
    end = steps * STEP

    def run(times: object) -> vv.Trajectory:
        return scene.run(t=times, method="leapfrog", dt=STEP, threads=1)

    def by_rebound(times: np.ndarray) -> None:
        simulation = rebound_simulation(scene)
        simulation.integrator = "leapfrog"
        simulation.dt = STEP
        store = np.empty((len(times), 6, 3))
        for row, time in enumerate(times):
            simulation.integrate(time, exact_finish_time=0)
            simulation.serialize_particle_data(xyz=store[row])

    cases = [
        ("10 steps per output, on nodes", STEP * np.arange(0, steps + 1, 10), 1.1),
        ("2 steps per output, on nodes", STEP * np.arange(0, steps + 1, 2), 1.35),
        ("10 steps per output, between nodes", np.append(STEP * (np.arange(0, steps, 10) + 0.3), end), None),
        ("2 steps per output, between nodes", np.append(STEP * (np.arange(0, steps, 2) + 0.3), end), None),
    ]
    without, *with_outputs = minima(
        lambda: run(end), *(lambda times=times: run(times) for _, times, _ in cases), repeats=400
    )
    theirs = minima(
        lambda: by_rebound(np.array([end])),
        *(lambda times=times: by_rebound(times) for _, times, _ in cases[:2]),
        repeats=5,
    )
    peer = dict(zip((name for name, _, _ in cases), theirs[1:], strict=False))
    for (name, times, bar), seconds in zip(cases, with_outputs, strict=True):
        ratio = seconds / without
        slowed = f"REBOUND {peer[name] / theirs[0]:.2f} ×" if name in peer else ""
        yield Row(
            f"{name} ({len(times)} outputs)",
            f"{seconds * 1e3:.2f} ms against {without * 1e3:.2f}: {ratio:.3f} ×",
            slowed,
            "",
            "" if bar is None else f"≤ {bar:g} ×",
            None if bar is None else ratio <= bar,
        )


if __name__ == "__main__":
    report(
        "Outputs",
        rows(),
        "Six bodies, {} and {} steps; time with outputs over time with the end only.".format(*LENGTHS),
    )
