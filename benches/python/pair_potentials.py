"""Potentials between all pairs, float64: nanoseconds per ordered pair against gravity between the same bodies.

All advance the same bodies by leapfrog with a step so short that nothing moves; what is timed is force evaluations, in
turns with those of gravity. Run with ``--rows`` for the tier in force only.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import numpy as np
from _harness import TIERS, Row, minima, report, rows_as_json, rows_in_tier

import visviva as vv
from visviva import _core

if TYPE_CHECKING:
    from collections.abc import Iterator

COUNT = 4096
STEP = 1e-9
STEPS = {"avx512": 4, "avx2": 4, "portable": 1}
BARS = {"LennardJones": 4.0, "ScreenedCoulomb zbl": 8.0}


def lattice() -> vv.Particles:
    """A simple cubic lattice of spacing 1, its sites shaken by a tenth."""
    random = np.random.default_rng(1924)
    sites = np.stack(np.meshgrid(*[np.arange(16.0)] * 3), axis=-1).reshape(-1, 3)
    position = sites + random.uniform(-0.1, 0.1, sites.shape)
    return vv.Particles(np.full(COUNT, 1.0), position, 0.1 * random.normal(size=(COUNT, 3)))


def potentials() -> dict[str, vv.potentials.Potential]:
    """What is compared with gravity; a table and a function of one's own are of the well before them."""
    well = vv.potentials.LennardJones(epsilon=1e-3, sigma=0.9)
    r = np.geomspace(0.5, 40.0, 2000)
    return {
        "LennardJones": well,
        "ScreenedCoulomb zbl": vv.potentials.ScreenedCoulomb(k=1.0, length=0.2),
        "Yukawa": vv.potentials.Yukawa(k=1.0, length=2.0),
        "Morse": vv.potentials.Morse(depth=1e-3, a=2.0, r_e=1.0),
        "Mie 14-7": vv.potentials.Mie(epsilon=1e-3, sigma=0.9, n=14.0, m=7.0),
        "PowerLaw n = 2.5": vv.potentials.PowerLaw(k=1.0, n=2.5),
        "ScreenedCoulomb thomas_fermi": vv.potentials.ScreenedCoulomb(k=1.0, length=0.2, screening="thomas_fermi"),
        "Tabulated, 2000 points": vv.potentials.Tabulated(r, well.value(r)),
        "Custom": vv.potentials.Custom(well.value, 0.5, 40.0, tolerance=1e-9),
    }


def rows() -> Iterator[Row]:
    tier = _core.info()["simd"]
    bodies, steps = lattice(), STEPS[tier]
    gravity = vv.Scene(bodies, vv.Gravity(G=1e-6))

    def run(scene: vv.Scene) -> vv.Trajectory:
        return scene.run(t=steps * STEP, method="leapfrog", dt=STEP, threads=1)

    evaluations = run(gravity).stats.evaluations
    for name, potential in potentials().items():
        scene = vv.Scene(bodies, vv.PairPotential(potential))
        ours, theirs = minima(lambda s=scene: run(s), lambda: run(gravity), repeats=7)
        ours, theirs = (seconds / evaluations / (COUNT * (COUNT - 1)) * 1e9 for seconds in (ours, theirs))
        bar = BARS.get(name)
        yield Row(
            f"{name}, N = {COUNT}, one thread, {tier}",
            f"{ours:.3f} ns per ordered pair",
            f"gravity {theirs:.3f}",
            f"{ours / theirs:.2f} ×",
            "" if bar is None else f"≤ {bar:g} ×",
            None if bar is None else ours / theirs <= bar,
        )


if __name__ == "__main__":
    if "--rows" in sys.argv:
        rows_as_json(rows())
    else:
        report(
            "Pair potentials",
            (row for tier in reversed(TIERS) for row in rows_in_tier(__file__, tier)),
            "Shaken cubic lattice; time of a run over its force evaluations, ours over gravity's.",
        )
