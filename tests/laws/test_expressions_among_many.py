"""Compiled expressions as events where much else goes on: many bodies, copies of masses of their own, massless crowds.

A table is the same to the bit for any number of threads and for each copy alone; beside the same formulas as functions
of Python, which are asked elsewhere in a step, counts are the same, and so are times, to what locating leaves.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

HOW: list[dict[str, Any]] = [
    {"method": "dop853", "rtol": 1e-9},
    {"method": "verner98", "rtol": 1e-10},
    {"method": "leapfrog", "dt": 0.01},
]
# Linear, a square, a root, one with the time, and one of velocities.
FORMULAS: list[Any] = [
    lambda t, x, v: x[1, 0] - x[0, 0],
    lambda t, x, v: (x[2] - x[0]) @ (x[2] - x[0]) - 2.25,
    lambda t, x, v: np.sqrt((x[3] - x[1]) @ (x[3] - x[1])) - 1.5,
    lambda t, x, v: np.sin(3.0 * t) + 0.25 * x[2, 1],
    lambda t, x, v: (x[4] - x[0]) @ (v[4] - v[0]),
]


def ring(bodies: int) -> vv.Particles:
    """A star, and light bodies on circles around it, a little inclined."""
    rng = np.random.default_rng(bodies)
    radius = np.linspace(1.0, 2.5, bodies - 1)
    angle = rng.uniform(0.0, 2.0 * np.pi, bodies - 1)
    place = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.05 * rng.normal(size=bodies - 1)], axis=1)
    speed = np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1) / np.sqrt(radius)[:, None]
    start = np.zeros((1, 3))
    return vv.Particles([1.0, *[1e-4] * (bodies - 1)], np.vstack([start, place]), np.vstack([start, speed]))


def compiled(**more: Any) -> list[vv.events.Event]:
    return [vv.events.expression(formula, **more) for formula in FORMULAS]


@pytest.mark.parametrize("how", HOW, ids=lambda how: how["method"])
def test_copies_of_many_bodies_with_masses_of_their_own(how: dict[str, Any]) -> None:
    """Twelve bodies, eleven copies; two forces."""
    bodies = ring(12)
    scene = vv.Scene(bodies, vv.Gravity(1.0), vv.UniformField((0.0, 0.02, 0.0)))
    masses = bodies.mass * np.linspace(0.8, 1.2, 11)[:, None]
    copies = scene.ensemble(mass=masses)
    out = copies.run(5.0, events=compiled(), threads=1, **how)
    table = out.events
    assert (np.bincount(table.which, minlength=5) > 0).all()
    assert copies.run(5.0, events=compiled(), threads=3, **how).events == table
    plain = copies.run(5.0, events=FORMULAS, **how).events
    assert np.array_equal(plain.which, table.which)
    assert np.array_equal(plain.member, table.member)
    # Of one motion: a hundred roundings of a time of 5, where a formula goes slowly through zero.
    np.testing.assert_allclose(table.t, plain.t, rtol=0.0, atol=1e-13)
    for copy in (0, 4, 10):
        alone = copies[copy].run(5.0, events=compiled(), **how).events
        mine = out[copy].events
        for name in ("which", "t", "position", "velocity"):
            assert getattr(alone, name).tobytes() == getattr(mine, name).tobytes(), name


@pytest.mark.parametrize("how", HOW, ids=lambda how: how["method"])
def test_hundreds_of_massless_bodies(how: dict[str, Any]) -> None:
    """Three hundred beside five: what looks at one of either, and at both."""
    massive, crowd = ring(5), ring(301)
    mass = np.concatenate([massive.mass, np.zeros(300)])
    place = np.vstack([massive.position, crowd.position[1:] * 1.01])
    speed = np.vstack([massive.velocity, crowd.velocity[1:]])
    scene = vv.Scene(vv.Particles(mass, place, speed), vv.Gravity(1.0))
    formulas = [
        lambda t, x, v: x[7, 0],
        lambda t, x, v: x[150, 1] - x[2, 1],
        lambda t, x, v: np.sqrt(x[300] @ x[300]) - np.sqrt(x[304] @ x[304]) * (1.0 + 0.01 * np.sin(5.0 * t)),
        lambda t, x, v: x[1] @ v[1] + 1e-3,
    ]
    events = [vv.events.expression(formula) for formula in formulas]
    one, three = (scene.run(4.0, events=events, threads=threads, **how) for threads in (1, 3))
    assert one.events == three.events
    assert set(one.events.which.tolist()) >= {0, 1}
    assert one.position.tobytes() == scene.run(4.0, **how).position.tobytes()
    plain = scene.run(4.0, events=formulas, **how).events
    assert np.array_equal(plain.which, one.events.which)
    # A function of Python looks at all bodies, which share their steps then: motions differ by their tolerances, 1e-9,
    # and times by that over the slowest rate, 0.05.
    np.testing.assert_allclose(one.events.t, plain.t, rtol=0.0, atol=1e-7)
    for which, t, x, v in zip(one.events.which, one.events.t, one.events.position, one.events.velocity, strict=True):
        # Roundings of numbers of about 1.
        assert abs(formulas[which](t, x, v)) < 1e-14


@pytest.mark.parametrize("threads", [1, 3])
def test_an_end_inside_an_ensemble_is_that_of_each_copy(threads: int) -> None:
    scene = vv.Scene(ring(10), vv.Gravity(1.0))
    copies = scene.ensemble(mass=scene.particles.mass * np.linspace(0.7, 1.3, 20)[:, None])
    event = vv.events.expression(FORMULAS[0], direction=1, terminal=1)
    out = copies.run(20.0, events=[event], method="dop853", threads=threads)
    assert (out.status == vv.Status.STOPPED).all()
    assert np.array_equal(out.events.member, np.arange(20))
    # Heavier stars bring their planets round sooner.
    assert (np.diff(out.events.t) < 0.0).all()
    for copy in (0, 9, 19):
        assert copies[copy].run(20.0, events=[event], method="dop853").final.t0 == out.events.t[copy]
