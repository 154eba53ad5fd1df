"""What is thrown up from where an event is zero comes down to it, however long the run is beside the flight."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

GRAVITY = 9.81
METHODS: list[dict[str, Any]] = [{}, {"method": "dop853"}, {"method": "taylor"}, {"method": "rk4", "dt": 0.5}]


def height(t: float, position: Any, velocity: Any) -> float:
    """The height of the first body."""
    return float(position[0, 2])


def thrown(speed: float, x: float = 0.0) -> vv.Scene:
    bodies = vv.Particles([1.0], [[x, 0.0, 0.0]], [[1.0, 0.0, speed]])
    return vv.Scene(bodies, vv.UniformField([0.0, 0.0, -GRAVITY]))


@pytest.mark.parametrize("own", [False, True])
@pytest.mark.parametrize("x", [0.0, 1e6])
@pytest.mark.parametrize("options", METHODS)
def test_a_flight_ends_where_it_began(options: dict[str, Any], x: float, own: bool) -> None:
    """The parabola is exact for every method: t = 2 v/g, to what the time and a height that small allow."""
    for speed, flights in ((20.0, 10.0), (20.0, 100.0), (2.0, 1e3), (1e-2, 1e6)):
        flight = 2.0 * speed / GRAVITY
        plane = vv.events.plane([0, 0, 0], [0, 0, 1], direction=-1, terminal=True)
        event = vv.events.function(height, direction=-1, terminal=True) if own else plane
        span = flights * flight
        chosen = options | ({"dt": span / 3} if "dt" in options else {})
        out = thrown(speed, x).run(t=span, events=[event], **chosen)
        assert out.status == vv.Status.STOPPED
        # The last digits of a step that is up to 1e6 flights long, and eight of the places that the plane looks at.
        slack = 1e-12 * flight + 8 * np.finfo(float).eps * x / speed * (not own)
        np.testing.assert_allclose(out.events.t, [flight], rtol=0, atol=slack)


def test_a_ball_goes_on_bouncing() -> None:
    """Flight after flight from where the last one ended, each of which is 0.8 of the one before."""
    ground = vv.events.plane([0, 0, 0], [0, 0, 1], direction=-1, terminal=True)
    scene, speed = thrown(5.0), 5.0
    for _ in range(60):
        out = scene.run(t=scene.t0 + 50.0, events=[ground])
        np.testing.assert_allclose(out.t[-1] - scene.t0, 2 * speed / GRAVITY, rtol=0, atol=1e-13)
        final = out.final
        speed *= 0.8
        bodies = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, speed]])
        scene = vv.Scene(bodies, *final.forces, t0=final.t0)


def test_copies_come_down_each_in_its_time() -> None:
    speeds = np.geomspace(1e-3, 10.0, 9)
    velocity = np.zeros((9, 1, 3))
    velocity[:, 0, 2] = speeds
    ground = vv.events.plane([0, 0, 0], [0, 0, 1], direction=-1)
    for t in (5.0, 60.0, 600.0):
        out = thrown(1.0).ensemble(velocity=velocity).run(t=t, events=[ground], threads=2)
        np.testing.assert_array_equal(np.sort(out.events.member), np.arange(9))
        by_copy = out.events.t[np.argsort(out.events.member)]
        np.testing.assert_allclose(by_copy, 2 * speeds / GRAVITY, rtol=1e-12, atol=0)


def test_what_falls_from_the_ground_is_not_there_again() -> None:
    """At rest or thrown down, it leaves the plane for good; what starts at a place of 1e9 does so to rounding."""
    for x, speed in ((0.0, 0.0), (0.0, -1.0), (1e9, 0.0), (1e9, -1e-3)):
        for options in METHODS[:3]:
            bodies = vv.Particles([1.0], [[0.0, 0.0, x]], [[1.0, 0.0, speed]])
            scene = vv.Scene(bodies, vv.UniformField([0.0, 0.0, -GRAVITY]))
            events = [
                vv.events.plane([0, 0, x], [0, 0, 1]),
                vv.events.function(lambda t, position, velocity, x=x: position[0, 2] - x),
            ]
            for event in events:
                assert len(scene.run(t=100.0, events=[event], **options).events) == 0


@pytest.mark.parametrize("options", [{}, {"method": "taylor"}, {"method": "gauss8"}, {"method": "verner98"}])
@pytest.mark.parametrize("kind", ["lagrangian", "hamiltonian"])
def test_in_generalized_coordinates(kind: str, options: dict[str, Any]) -> None:
    system: vv.Lagrangian | vv.Hamiltonian
    if kind == "lagrangian":
        system = vv.Lagrangian(lambda q, v, t: 0.5 * v[0] ** 2 - GRAVITY * q[0], ["z"], position=[0.0], velocity=[20.0])
    else:
        system = vv.Hamiltonian(
            lambda q, p, t: 0.5 * p[0] ** 2 + GRAVITY * q[0], ["z"], position=[0.0], momentum=[20.0]
        )
    event = vv.events.function(lambda t, position, velocity: position[0], terminal=True)
    for t in (10.0, 1e3, 1e4):
        out = system.run(t, events=[event], **options)
        np.testing.assert_allclose(out.events.t, [40.0 / GRAVITY], rtol=1e-14, atol=0)
