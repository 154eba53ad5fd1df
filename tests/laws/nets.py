"""Nets of springs, what acts beside them, and how their series are compared with another method and with copies."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv


def net(count: int, dimensions: int, extra: int = 0, **lengths: float) -> vv.Scene:
    rng = np.random.default_rng(100 * count + dimensions)
    place, speed = rng.normal(size=(2, count, 3))
    place[:, 0] += 1.5 * np.arange(count)
    place[:, dimensions:] = speed[:, dimensions:] = 0.0
    i = np.r_[np.arange(count - 1), rng.integers(0, count - 1, extra)]
    j = np.r_[np.arange(1, count), np.full(extra, count - 1)]
    k, length = rng.uniform(1.0, 20.0, len(i)), rng.uniform(0.5, 2.0, len(i))
    return vv.Scene(vv.Particles(rng.uniform(0.5, 2.0, count), place, 0.3 * speed), vv.Spring(i, j, k=k, length=length))


FIELDS: dict[str, list[Any]] = {
    "nothing": [],
    "a field": [vv.UniformField([0.0, -2.0, 0.0])],
    "fields": [vv.UniformField([0.0, -2.0, 0.0]), vv.Harmonic(k=0.5, center=[1.0, 0.5, 0.0])],
    "drag": [vv.LinearDrag(tau=8.0), vv.UniformMagneticField([0.0, 0.0, 1.0], charge=0.75), vv.Harmonic(k=0.25)],
    "gravity": [vv.Gravity(0.5, softening=0.25)],
    "a drive": [vv.DrivenForce([1.0, 0.5, 0.0], frequency=3.0)],
    "springs": [vv.Spring(0, 1, k=3.0), vv.UniformField([0.5, -2.0, 0.0])],
    "a formula": [vv.ExpressionForce(potential=lambda r, v, t: 0.25 * (r[0] ** 2 + r[1] ** 2) + 0.01 * r[0] ** 4)],
}


def goes_as_by_another_method_with_its_own_bits(scene: vv.Scene, t: float, method: str) -> None:
    """Alone by series as by that method, and among eleven copies, on one thread and on three, with the same bits."""
    ours = scene.run(t=t, method="taylor", rtol=1e-12)
    other = scene.run(t=t, method=method, rtol=1e-13)
    # Nets magnify errors of 1e-12 a hundred times within two units of time; velocities are ten times as large.
    assert ours.position[-1] == pytest.approx(other.position[-1], rel=0, abs=1e-9)
    assert ours.velocity[-1] == pytest.approx(other.velocity[-1], rel=0, abs=1e-8)
    shifted = scene.particles.position + 0.01 * np.arange(11)[:, None, None]
    shifted[5] = scene.particles.position
    for threads in (1, 3):
        copies = scene.ensemble(position=shifted).run(t=t, method="taylor", rtol=1e-12, threads=threads)
        assert np.array_equal(copies[5].position, ours.position)
        assert np.array_equal(copies[5].velocity, ours.velocity)
