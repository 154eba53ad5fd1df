"""A leapfrog step of six bodies inside one run, against REBOUND's leapfrog."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, faster, minima, rebound_simulation, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

STEPS = 200_000
STEP = 10.0


def disagreement(scene: vv.Scene) -> float:
    """Largest distance after 100 days of 0.1-day steps: drift–kick–drift and kick–drift–kick meet as the step falls."""
    simulation = rebound_simulation(scene)
    simulation.integrator = "leapfrog"
    simulation.dt = 0.1
    simulation.steps(1000)
    theirs = np.array([body.xyz for body in simulation.particles])
    return float(np.abs(scene.run(t=100.0, method="leapfrog", dt=0.1).position[-1] - theirs).max())


def rows() -> Iterator[Row]:
    scene = vv.problems.outer_solar_system().scene
    apart = disagreement(scene)
    assert apart < 1e-8, f"the two sides end {apart:.1e} AU apart"
    simulation = rebound_simulation(scene)
    simulation.integrator = "leapfrog"
    simulation.dt = STEP
    ours, theirs = minima(
        lambda: scene.run(t=STEPS * STEP, method="leapfrog", dt=STEP, threads=1),
        lambda: simulation.steps(STEPS),
        repeats=9,
    )
    yield faster(
        f"outer Solar System, N = 6, {STEPS} steps",
        f"{ours / STEPS * 1e9:.1f} ns per step",
        f"REBOUND leapfrog {theirs / STEPS * 1e9:.1f}",
        theirs / ours,
        1.5,
    )


if __name__ == "__main__":
    report(
        "A leapfrog step",
        rows(),
        "One whole `run` of kick–drift–kick over its steps; REBOUND's drift–kick–drift by `Simulation.steps`.",
    )
