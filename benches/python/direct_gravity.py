"""Direct gravity, float64: nanoseconds per ordered pair against REBOUND's ``gravity="basic"``.

Both sides advance the same bodies by leapfrog with a step so short that nothing moves; what is timed is
force evaluations. Runs are short and many: a neighbor on the machine spoils a long one for sure. Run with
``--rows`` for the tier in force only.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np
from _harness import TIERS, Row, faster, minima, rebound_simulation, report, rows_as_json, rows_in_tier

import visviva as vv
from visviva import _core

if TYPE_CHECKING:
    from collections.abc import Iterator

STEP = 1e-9
BARS = {"avx512": 5.0, "avx2": 4.5, "portable": None}


def sphere(count: int) -> vv.Scene:
    """Equal masses in a Plummer sphere of scale length 1, cut at 99 % of the mass."""
    random = np.random.default_rng(1913)
    radius = 1.0 / np.sqrt(random.uniform(1e-6, 0.99, count) ** (-2.0 / 3.0) - 1.0)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    position = radius[:, None] * direction
    return vv.Scene(
        vv.Particles(np.full(count, 1.0 / count), position, 0.1 * random.normal(size=(count, 3))), vv.Gravity(1.0)
    )


def disagreement(scene: vv.Scene) -> float:
    """Largest difference of the accelerations, over the largest acceleration."""
    simulation = rebound_simulation(scene)
    simulation.integrator = "leapfrog"
    simulation.dt = 1e-300
    simulation.steps(1)
    theirs = np.array([[body.ax, body.ay, body.az] for body in simulation.particles])
    ours = scene.acceleration()
    return float(np.abs(theirs - ours).max() / np.abs(ours).max())


def rows() -> Iterator[Row]:
    tier = _core.info()["simd"]
    # A shared machine is seldom quiet: many repeats where there is a bar, short ones of the slow tier.
    repeats, few = (60, 8) if BARS[tier] else (15, 2)
    for count, steps in ((1024, 8 * few), (4096, few)):
        scene = sphere(count)
        difference = disagreement(scene)
        assert difference < 1e-12, f"the accelerations disagree by {difference:.1e}"
        simulation = rebound_simulation(scene)
        simulation.integrator = "leapfrog"
        simulation.dt = STEP
        pairs = count * (count - 1)

        def run(threads: int, scene: vv.Scene = scene, steps: int = steps) -> vv.Trajectory:
            return scene.run(t=steps * STEP, method="leapfrog", dt=STEP, threads=threads)

        evaluations = run(1).stats.evaluations
        ours, theirs = minima(lambda: run(1), lambda s=simulation, n=steps: s.steps(n), repeats=repeats)
        ours_pair, theirs_pair = ours / evaluations / pairs * 1e9, theirs / steps / pairs * 1e9
        yield faster(
            f"N = {count}, one thread, {tier}; accelerations agree to {difference:.0e}",
            f"{ours_pair:.3f} ns per ordered pair",
            f"REBOUND basic {theirs_pair:.3f}",
            theirs_pair / ours_pair,
            BARS[tier],
        )
        if count == 4096:
            # Turns of their own: both cores are quiet together still more seldom.
            one, two = (
                least / evaluations / pairs * 1e9
                for least in minima(lambda: run(1), lambda: run(2), repeats=2 * repeats)
            )
            yield faster(
                f"N = {count}, two threads against one, {tier}",
                f"{two:.3f} ns per ordered pair",
                f"one thread {one:.3f}",
                one / two,
                1.8,
            )


if __name__ == "__main__":
    if "--rows" in sys.argv:
        rows_as_json(rows())
    else:
        report(
            "Direct gravity",
            (row for tier in reversed(TIERS) for row in rows_in_tier(__file__, tier)),
            "Unsoftened Plummer sphere; time of a run over its force evaluations, both sides by leapfrog.",
        )
