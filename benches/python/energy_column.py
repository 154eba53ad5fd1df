"""What an energy column costs: 100 001 outputs of the Sun and eight planets, one and two steps apart.

The run without it is the same run, outputs and all, that records positions and velocities. Beside it, with no bar: the
same outputs with nothing recorded at them, and the run to the end alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, minima, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

OUTPUTS, STEP = 100_000, 1.0
MASSES = 1.0, 1.7e-7, 2.4e-6, 3.0e-6, 3.2e-7, 9.5e-4, 2.9e-4, 4.4e-5, 5.2e-5
RADII = 0.39, 0.72, 1.0, 1.52, 5.2, 9.5, 19.2, 30.1
G = 2.9591220828559115e-4


def planets() -> vv.Scene:
    """The Sun and eight planets on circles, a golden angle apart (AU, days, solar masses)."""
    radius, angle = np.array(RADII), 2.4 * np.arange(8)
    toward = np.stack([np.cos(angle), np.sin(angle), 0.02 * np.sin(2.0 * angle)], axis=1)
    along = np.stack([-np.sin(angle), np.cos(angle), np.zeros(8)], axis=1)
    position = np.vstack([np.zeros(3), radius[:, None] * toward])
    velocity = np.vstack([np.zeros(3), np.sqrt(G / radius)[:, None] * along])
    return vv.Scene(vv.Particles(MASSES, position, velocity), vv.Gravity(G))


def rows() -> Iterator[Row]:
    scene = planets()
    for method in ("leapfrog", "yoshida4", "kahan_li8"):
        for apart in (1, 2):
            yield row(scene, method, apart)


def row(scene: vv.Scene, method: str, apart: int) -> Row:
    times = STEP * np.arange(0, apart * OUTPUTS + 1, apart)

    def run(t: object, *record: str) -> vv.Trajectory:
        return scene.run(t=t, method=method, dt=STEP, threads=1, record=record)

    energy, states, nothing, end = minima(
        lambda: run(times, "energy"),
        lambda: run(times, "position", "velocity"),
        lambda: run(times),
        lambda: run(times[-1]),
    )
    ratio = energy / states
    return Row(
        f"{method}, {apart} steps per output" if apart > 1 else f"{method}, a step per output",
        f"{energy * 1e3:.1f} ms against {states * 1e3:.1f}: {ratio:.2f} ×",
        f"against nothing recorded {energy / nothing:.2f} ×, against the end only {energy / end:.2f} ×",
        "",
        "≤ 1.5 ×",
        ratio <= 1.5,
    )


if __name__ == "__main__":
    report("An energy column", rows(), f"{OUTPUTS + 1} outputs of nine bodies.")
