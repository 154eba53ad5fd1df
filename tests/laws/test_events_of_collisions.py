"""Events beside collisions: what a collision makes jump, what rests on a plane, and copies of both.

Bounds: times and places of contact to some roundings of the largest number, 1e-14.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from colliding import spheres

import visviva as vv

EPSILON = float(np.finfo(float).eps)


def test_events_miss_no_short_approach_either() -> None:
    for speed in (1.0, 1e4, 1e8):
        scene = spheres([1, 2], [[-3, 0.1, 0], [3, 0, 0]], [[speed, 0, 0], [-speed, 0, 0]], 0.0)
        for options in ({"method": "dop853"}, {"method": "leapfrog", "dt": 1.0}):
            out = scene.run(100.0, events=[vv.events.distance(0, 1, below=0.2)], **options)
            assert out.events.t == pytest.approx([(6.0 - np.sqrt(0.03)) / (2.0 * speed)], rel=1e-14, abs=0)


TWO_BALLS = vv.Scene(vv.Particles([1.0, 2.0], [[0, 0, 0], [3.0, 0, 0]], [[1.0, 0, 0], [0, 0, 0]], radius=0.5))


def test_what_a_collision_makes_jump_is_an_event() -> None:
    """The energy falls from 1/2 to 1/4 in the bounce at t = 2, the speed of the first from 1 to 0, and r·v turns."""
    events = [
        vv.events.energy(0.4),
        vv.events.energy(0.4, direction=1),
        lambda t, x, v: v[0, 0] - 0.5,
        vv.events.apsis(0, 1),
        vv.events.energy(0.1),
    ]
    out = TWO_BALLS.run(5.0, collisions="bounce", restitution=0.5, events=events)
    assert [int(which) for which in out.events.which] == [0, 2, 3]
    np.testing.assert_array_equal(out.events.t, [out.collisions.t[0]] * 3)
    # The state is that after it.
    np.testing.assert_allclose(out.events.velocity[:, 0, 0], 0.0, rtol=0.0, atol=1e-15)
    back = out.final.run(t=0.0, collisions="bounce", restitution=1.0, events=[vv.events.apsis(0, 1)])
    assert len(back.events) == len(back.collisions)
    many = TWO_BALLS.ensemble(velocity=[[[1.0, 0, 0], [0, 0, 0]], [[0.5, 0, 0], [0, 0, 0]]])
    stopped = many.run(5.0, collisions="bounce", restitution=0.5, events=[vv.events.energy(0.4, terminal=True)])
    assert [vv.Status(int(each)) for each in stopped.status] == [vv.Status.STOPPED, vv.Status.OK]


def test_a_function_that_fails_in_a_collision_is_told() -> None:
    def slow(t: float, position: np.ndarray, velocity: np.ndarray) -> float:
        if velocity[0, 0] < 0.5:
            raise ValueError("too slow")
        return 1.0

    with pytest.raises(ValueError, match="too slow"):
        TWO_BALLS.run(5.0, collisions="bounce", events=[slow])


@pytest.mark.parametrize("method", ["auto", "leapfrog", "rk4", "taylor"])
def test_what_rests_on_a_plane_does_not_pass_it(method: vv.typing.MethodName) -> None:
    """Beside a ball that comes, in a frame that moves with both, it is there to an ulp: the run ended with that."""
    steps = {} if method in ("auto", "taylor") else {"dt": 0.1}
    plane = vv.events.plane([3.0, 0, 0], [1.0, 0, 0], body=1, terminal=True)
    out = TWO_BALLS.run(1.9, collisions="bounce", method=method, events=[plane], **steps)
    assert out.status is vv.Status.OK
    touching = vv.Scene(
        vv.Particles(
            [1.0, 2.0, 1.0],
            [[0, 0, 0], [2.0, 0, 0], [-5.0, 0.5, 0]],
            [[0.3, 0.1, 0], [0.3, 0.1, 0], [1.1, 0, 0]],
            radius=0.5,
        )
    )
    apart = vv.events.distance(0, 1, below=2.0, direction=0)
    assert len(touching.run(3.0, collisions="bounce", events=[apart]).events) == 0


def test_what_creeps_through_a_plane_passes_it() -> None:
    """In each step by less than places are rounded by: 1e-12 a step, a million away."""
    creeping = vv.Scene(vv.Particles([1.0], [[1e6 - 1e-9, 0, 0]], [[1e-12, 0, 0]]), vv.UniformField([0, 0, -1e-3]))
    out = creeping.run(1e4, method="rk4", dt=1.0, events=[vv.events.plane([1e6, 0, 0], [1.0, 0, 0], body=0)])
    assert len(out.events) == 1


def test_jumps_of_copies_are_those_that_each_has_alone() -> None:
    """Twelve balls with masses of their own in each of ten copies, by one thread and three."""
    rng = np.random.default_rng(3)
    places = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0), [0.0]), -1).reshape(-1, 3)
    speeds = rng.normal(size=(10, 12, 3)) * [1.0, 1.0, 0.0]
    gas = vv.Scene(vv.Particles(np.ones(12), places, speeds[0], radius=0.3), vv.Harmonic(1.0, (1.5, 1.0, 0.0)))
    copies = gas.ensemble(mass=rng.uniform(0.5, 2.0, (10, 12)), velocity=speeds)
    events = [vv.events.energy(0.8 * float(gas.invariants().energy)), vv.events.apsis(0, 1)]
    asked: dict[str, Any] = {"collisions": "bounce", "restitution": 0.7, "events": events, "method": "verner98"}
    by_one, by_three = (copies.run(2.0, threads=threads, **asked) for threads in (1, 3))
    assert np.isin(by_one.events.t, by_one.collisions.t).sum() > 5
    for name in ("t", "which", "position", "velocity"):
        np.testing.assert_array_equal(getattr(by_one.events, name), getattr(by_three.events, name))
    for copy in (0, 7):
        alone = copies[copy].run(2.0, **asked)
        own = by_one.events.member == copy
        np.testing.assert_array_equal(by_one.events.t[own], alone.events.t)
        np.testing.assert_array_equal(by_one.events.velocity[own], alone.events.velocity)


@pytest.mark.parametrize("asked", [5.0, [0.0, 5.0]])
def test_an_event_that_ends_a_run_after_a_merger(asked: Any) -> None:
    """The last row was asked of bodies in one place that pulled each other: refused, and all that was run was lost."""
    place, velocity = [[0, 0, 0], [1.0, 0, 0], [0, 3.0, 0]], [[0, 0, 0], [-1.0, 0, 0], [0, -0.5, 0]]
    scene = vv.Scene(vv.Particles([1.0, 0.1, 0.1], place, velocity, radius=[0.1, 0.1, 0.01]), vv.Gravity(1.0))
    end = [vv.events.distance(0, 2, below=1.5, terminal=True)]
    record = ("position", "velocity", "energy", "momentum")
    out = scene.run(t=asked, collisions="merge", events=end, record=record)
    assert out.status == vv.Status.STOPPED
    assert len(out.collisions) == len(out.events) == 1
    last = out.final.particles
    assert np.linalg.norm(last.position[2] - last.position[0]) == pytest.approx(1.5, rel=1e-13, abs=0)
    # Merged bodies are in one place; momentum is what it was.
    np.testing.assert_array_equal(last.position[0], last.position[1])
    np.testing.assert_allclose(last.mass @ last.velocity, [-0.1, -0.05, 0.0], rtol=0, atol=1e-13)
    if asked == 5.0:
        np.testing.assert_array_equal(out.position[-1], last.position)
        np.testing.assert_allclose(out.momentum[-1], [-0.1, -0.05, 0.0], rtol=0, atol=1e-13)
        kinetic = 0.5 * last.mass @ (last.velocity**2).sum(axis=1)
        np.testing.assert_allclose(out.energy[-1], kinetic - 1.1 * 0.1 / 1.5, rtol=1e-12, atol=0)
