"""What a built-in force term adds to a run of six bodies under gravity: time with it over time without it.

    python benches/python/force_terms.py

Both runs take turns, and the least of many is taken of each; steps are fixed, so both take as many. Methods that take
velocities serve the terms that look at them. The bar is 1.3; REBOUND with a force in Python: 41.
"""

from __future__ import annotations

import time

import numpy as np

import visviva as vv

STEPS = 20_000
TURNS = 12


def six() -> vv.Particles:
    """A star and five planets, about its axis."""
    rng = np.random.default_rng(1)
    a = np.array([1.0, 1.7, 2.9, 4.6, 8.0])
    phase = rng.uniform(0, 2 * np.pi, 5)
    position = np.zeros((6, 3))
    velocity = np.zeros((6, 3))
    position[1:] = np.stack([a * np.cos(phase), a * np.sin(phase), 0.05 * rng.normal(size=5)], axis=1)
    velocity[1:] = np.stack([-np.sin(phase), np.cos(phase), 0.05 * rng.normal(size=5)], axis=1) / np.sqrt(a)[:, None]
    return vv.Particles([1.0, 1e-5, 3e-4, 1e-4, 2e-5, 5e-5], position, velocity)


TERMS: dict[str, vv.forces.Force] = {
    "uniform field": vv.UniformField([0.0, 0.0, -1e-3]),
    "electric field": vv.UniformElectricField([0.0, 0.0, -1e-3], np.full(6, 1e-5)),
    "harmonic": vv.Harmonic(1e-9),
    "J2 of the star": vv.Oblate(0, 1.0, 1e-3, 0.01, [0.0, 0.0, 1.0]),
    "J2 and J4 of the star": vv.Oblate(0, 1.0, 1e-3, 0.01, [0.0, 0.0, 1.0], 1e-5),
    "charges": vv.Coulomb(np.full(6, 1e-4), k=1.0),
    "linear drag": vv.LinearDrag(1e7),
    "quadratic drag": vv.QuadraticDrag(1e-12),
    "rotating frame": vv.RotatingFrame([0.0, 0.0, 1e-3]),
    "1PN of the star": vv.PostNewtonian(0, 1.0, 1e4),
}


def seconds(scene: vv.Scene, method: str) -> float:
    dt = 1e-2
    start = time.perf_counter()
    scene.run(t=STEPS * dt, method=method, dt=dt, record="position")
    return time.perf_counter() - start


def main() -> None:
    bodies = six()
    without = vv.Scene(bodies, vv.Gravity(1.0))
    print(f"{'term':24s} {'method':12s} {'ns/step without':>16s} {'with':>8s} {'ratio':>7s}")
    for name, force in TERMS.items():
        scene = vv.Scene(bodies, vv.Gravity(1.0), force)
        for method in ("leapfrog", "rk4", "yoshida4"):
            try:
                scene.plan(t=1.0, method=method, dt=0.01)
            except vv.InvalidInput:
                continue
            times = np.array([[seconds(without, method), seconds(scene, method)] for _ in range(TURNS)]).min(axis=0)
            print(f"{name:24s} {method:12s} {times[0] / STEPS * 1e9:16.0f} {times[1] / STEPS * 1e9:8.0f} "
                  f"{times[1] / times[0]:7.2f}")  # fmt: skip


if __name__ == "__main__":
    main()
