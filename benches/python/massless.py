"""A thousand massless bodies beside the Sun and four planets, against the five alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from _harness import Row, at_most, minima, report

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Iterator

MASSLESS, SPAN = 1000, 200_000.0


def scenes() -> tuple[vv.Scene, vv.Scene]:
    """Five massive bodies, and the same with massless ones on orbits from 4 to 40 AU."""
    scene = vv.problems.outer_solar_system().scene
    five = scene.particles
    mass, x, v = five.mass[:5], five.position[:5], five.velocity[:5]
    random = np.random.default_rng(5)
    radius, angle = random.uniform(4.0, 40.0, MASSLESS), random.uniform(0.0, 2.0 * np.pi, MASSLESS)
    speed = np.sqrt(scene.forces[0].G * mass[0] / radius)
    tilt = random.uniform(-0.1, 0.1, MASSLESS)
    place = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), tilt], axis=1) + x[0]
    velocity = speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), tilt], axis=1) + v[0]
    every = vv.Particles(
        np.concatenate([mass, np.zeros(MASSLESS)]), np.concatenate([x, place]), np.concatenate([v, velocity])
    )
    return vv.Scene(vv.Particles(mass, x, v), *scene.forces), vv.Scene(every, *scene.forces)


def rows() -> Iterator[Row]:
    alone, every = scenes()
    pairs = (10 + 5 * MASSLESS) / 10
    for threads in (1, 2):
        few, many = minima(
            lambda: alone.run(t=SPAN, method="dop853", threads=1),
            lambda threads=threads: every.run(t=SPAN, method="dop853", threads=threads),
        )
        yield at_most(
            f"time per pair, 5 massive and {MASSLESS} massless, {threads} threads",
            many / few / pairs,
            1.3,
            " ×",
            f"the five alone: {few * 1e3:.2f} ms; all: {many * 1e3:.1f} ms, {pairs:.0f} × the pairs",
        )


if __name__ == "__main__":
    report(
        "Massless bodies",
        rows(),
        f"DOP853 at its default tolerance over {SPAN:.0f} days. What the massless bodies make a run longer by, over "
        "what they make the pairs more by.",
    )
