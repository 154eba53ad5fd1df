"""The round-off floor of Kahan–Li 8 on Applegate's outer Solar System over 3.65e6 days.

A step is on the floor when truncation no longer shows: the error of the same step in double-double would be
below the bar. Here the floor is taken from the data: from the largest step whose error is below the bar, every
smaller step must stay below it. REBOUND's leapfrog of order 8 and SABA(10,6,4) run beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, rebound_simulation, report
from _reference import Reference, error

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

STEPS = (36.5, 29.2, 25.0, 20.0, 14.6, 10.0, 7.3)
OUTPUTS = 1001
POSITION_BAR, ENERGY_BAR = 5e-10, 1e-14


def by_rebound(
    scene: vv.Scene, integrator: str, kind: str, step: float, end: float
) -> tuple[NDArray[np.float64], float]:
    """Positions at the end and the largest relative change of the energy at 100 synchronised times on the way."""
    simulation = rebound_simulation(scene)
    simulation.integrator = integrator
    setattr(simulation.integrator, "order" if integrator == "leapfrog" else "type", kind)
    simulation.dt = step
    start = simulation.energy()
    worst = 0.0
    steps = round(end / step)
    for part in range(100):
        simulation.steps(steps * (part + 1) // 100 - steps * part // 100)
        simulation.synchronize()
        worst = max(worst, abs(simulation.energy() / start - 1.0))
    return np.array([body.xyz for body in simulation.particles]), worst


def rows() -> Iterator[Row]:
    problem = vv.problems.outer_solar_system("applegate")
    scene, end = problem.scene, problem.t_end
    truth = Reference(scene).positions(end)
    gap = error(problem.references[0].position, truth)
    assert gap < 5e-11, f"the two references are {gap:.1e} AU apart"
    worst_position = worst_energy = 0.0
    times = np.linspace(0.0, end, OUTPUTS)
    for step in STEPS:
        out = scene.run(t=times, method="kahan_li8", dt=step, record=("position", "energy"))
        position, energy = error(out.position[-1], truth), float(np.abs(out.energy / out.energy[0] - 1.0).max())
        worst_position, worst_energy = max(worst_position, position), max(worst_energy, energy)
        yield Row(
            f"step {step:g} d",
            f"{position:.1e} AU, max abs ΔE/E {energy:.1e}",
            "",
            "",
            f"≤ {POSITION_BAR:g} AU, ≤ {ENERGY_BAR:g}",
            position <= POSITION_BAR and energy <= ENERGY_BAR,
        )
    for step in (20.0, 14.6, 10.0, 7.3):
        out = scene.run(t=times, method="stormer13", dt=step, record=("position", "energy"))
        position, energy = error(out.position[-1], truth), float(np.abs(out.energy / out.energy[0] - 1.0).max())
        yield Row(f"stormer13, step {step:g} d", f"{position:.1e} AU, max abs ΔE/E {energy:.1e}", "", "", "", None)
    best = (np.inf, "", np.inf)
    for name, integrator, kind, steps in (
        ("leapfrog 8", "leapfrog", 8, (73.0, 36.5, 18.25)),
        ("SABA(10,6,4)", "saba", "10_6_4", (182.5, 91.25, 73.0)),
    ):
        for step in steps:
            state, energy = by_rebound(scene, integrator, kind, step, end)
            position = error(state, truth)
            best = min(best, (position, name, energy))
            yield Row(f"REBOUND {name}, step {step:g} d", "", f"{position:.1e} AU, {energy:.1e}", "", "", None)
    yield Row(
        f"worst of ours against the best of REBOUND's ({best[1]})",
        f"{worst_position:.1e} AU, {worst_energy:.1e}",
        f"{best[0]:.1e} AU, {best[2]:.1e}",
        f"{best[0] / worst_position:.0f} × closer",
        "",
        None,
    )


if __name__ == "__main__":
    report(
        "Round-off floor of Kahan–Li 8",
        rows(),
        f"Largest distance of a body from the extended-precision reference at 3.65e6 d; energy at {OUTPUTS} times.",
    )
