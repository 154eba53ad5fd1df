"""A circle has no apsides: what rounding and the errors of steps make of r·v = 0 is not told as events."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from event_scenes import METHODS, kepler, options

import visviva as vv

ADAPTIVE = ["taylor", "dop853", "verner98", "tsitouras54", "dormand_prince54"]
TURN = 2.0 * np.pi / np.sqrt(1.5)
APSIDES = [vv.events.apsis(1, 0)]


def circle(angle: float, tilt: float = 0.0, e: float = 0.0) -> vv.Scene:
    """On a circle, or an ellipse, turned in its plane and out of it."""
    c, s, k, z = np.cos(angle), np.sin(angle), np.cos(tilt), np.sin(tilt)
    turn = np.array([[1, 0, 0], [0, k, -z], [0, z, k]]) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    body = kepler(e).particles
    return vv.Scene(vv.Particles(body.mass, body.position @ turn.T, body.velocity @ turn.T), vv.Gravity(1.0))


@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize("rtol", [1e-9, 1e-12])
@pytest.mark.parametrize("method", ADAPTIVE)
def test_adaptive_steps_round_a_circle(method: str, rtol: float, angle: float) -> None:
    """Two thousand were told of ten turns: a continuous extension wavers by its tolerance."""
    found = circle(angle).run(t=10.0 * TURN, method=method, rtol=rtol, events=APSIDES).events
    # What has become an ellipse by the errors of steps has two to a turn.
    assert len(found) <= 20
    assert (np.diff(found.t) > 0.05 * TURN).all()


@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize(("method", "dt"), [("kahan_li8", 0.01), ("sofroniou_spaletta10", 0.01), ("stormer13", 0.01)])
def test_equal_steps_round_a_circle(method: str, dt: float, angle: float) -> None:
    """Of each turn three hundred zeros were told, which were rounding."""
    found = circle(angle, 0.4).run(t=5.0 * TURN, method=method, dt=dt, events=APSIDES).events
    assert len(found) <= 10
    assert (np.diff(found.t) > 0.05 * TURN).all()


@pytest.mark.parametrize("e", [1e-6, 1e-3])
@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize("method", METHODS)
def test_ellipses_that_are_nearly_circles_keep_their_apsides(method: str, angle: float, e: float) -> None:
    order = {each.name: each for each in vv.methods()}[method]
    if not order.adaptive and order.order < 4:
        return  # their steps make an ellipse of their own
    scene = circle(angle, e=e)
    for how in ({"events": APSIDES}, {"events": [vv.events.apsis(1, 0, direction=1)]}):
        found = scene.run(t=3.2 * TURN, method=method, **how, **options(method)).events
        expected = np.arange(1, 7) / 2.0 if how["events"] is APSIDES else np.arange(1, 4)
        assert np.allclose(found.t / TURN, expected, rtol=0.0, atol=2e-3 if e == 1e-6 else 1e-5)


def test_series_know_more_than_their_tolerance() -> None:
    found = circle(0.7, e=1e-10).run(t=3.2 * TURN, method="taylor", events=APSIDES).events
    assert np.allclose(found.t / TURN, np.arange(1, 7) / 2.0, rtol=0.0, atol=1e-2)


@pytest.mark.parametrize("threads", [1, 3])
def test_circles_among_copies_and_massless_bodies(threads: int) -> None:
    """Each is told of as if it were alone, whatever it is beside."""
    axes, e = np.array([1.0, 1.5, 2.0, 3.0, 4.0]), np.array([0.0, 0.1, 0.0, 1e-4, 0.0])
    bodies = vv.Particles.from_elements(1.0, np.zeros(5), G=1.0, semi_major_axis=axes, eccentricity=e)
    scene = vv.Scene(bodies, vv.Gravity(1.0))
    asked = [vv.events.apsis(body, 0) for body in range(1, 6)]
    out = scene.run(t=60.0, method="dop853", events=asked, threads=threads)
    count = np.bincount(out.events.which, minlength=5)
    turns = 60.0 / (2.0 * np.pi * axes**1.5)
    assert (count[e > 0.0] == (2.0 * turns[e > 0.0]).astype(int)).all()
    assert (count[e == 0.0] <= 1).all()
    copies = scene.ensemble(position=np.broadcast_to(bodies.position, (9, 6, 3)))
    each = copies.run(t=60.0, method="dop853", events=asked, threads=threads).events
    for copy in range(9):
        assert (each.t[each.member == copy] == out.events.t).all()


@pytest.mark.parametrize("method", ADAPTIVE)
def test_a_terminal_apsis_of_a_circle_ends_nothing(method: Any) -> None:
    out = circle(0.0).run(t=3.0, method=method, events=[vv.events.apsis(1, 0, terminal=True)])
    assert out.status is vv.Status.OK
    assert len(out.events) == 0


def test_runs_backward_have_the_same_apsides() -> None:
    scene = circle(0.7, e=1e-3)
    there = scene.run(t=3.2 * TURN, method="dop853", events=APSIDES)
    back = there.final.run(t=0.0, method="dop853", events=APSIDES)
    # The start is one, which a run backward does not quite reach, or passes.
    assert np.allclose(back.events.t[:6][::-1], there.events.t, rtol=0.0, atol=1e-4)
    assert len(circle(0.7).run(t=-30.0, method="dop853", events=APSIDES).events) <= 1


@pytest.mark.parametrize("how", [{"atol": 1e-9}, {"atol": {"position": 1e-9, "velocity": 1e-9}}, {"atol": [1e-9] * 2}])
def test_absolute_tolerances_are_errors_of_steps_too(how: Any) -> None:
    found = circle(0.3).run(t=10.0 * TURN, method="dop853", rtol=1e-13, events=APSIDES, **how).events
    assert len(found) <= 20
    assert (np.diff(found.t) > 0.05 * TURN).all()


@pytest.mark.parametrize(
    "how", [{"method": "dop853"}, {"method": "taylor"}, {"method": "leapfrog", "dt": 0.02}], ids=str
)
def test_apsides_of_copies_with_masses_of_their_own_are_those_of_each_alone(how: dict[str, Any]) -> None:
    """Ten bodies, twelve copies, one thread and three: what counts as rounding is judged by each copy's own bodies."""
    count, copies = 10, 12
    semi_major_axis, angle = np.linspace(1.0, 6.0, count - 1), np.arange(1.0, count)
    mass, place, velocity = np.array([1.0] + [1e-6] * (count - 1)), np.zeros((count, 3)), np.zeros((count, 3))
    place[1:, :2] = (semi_major_axis * np.array([np.cos(angle), np.sin(angle)])).T
    velocity[1:, :2] = (np.sqrt(0.95 / semi_major_axis) * np.array([-np.sin(angle), np.cos(angle)])).T
    masses = np.tile(mass, (copies, 1))
    masses[:, 1:] *= np.linspace(0.5, 2.0, copies)[:, None]
    ensemble = vv.Scene(vv.Particles(mass, place, velocity), vv.Gravity(1.0)).ensemble(mass=masses)
    one, three = (ensemble.run(t=20.0, events=APSIDES, threads=threads, **how) for threads in (1, 3))
    np.testing.assert_array_equal(one.events.t, three.events.t)
    alone = ensemble[5].run(t=20.0, events=APSIDES, **how)
    assert len(alone.events.t) == 6
    np.testing.assert_array_equal(alone.events.t, one.events.t[one.events.member == 5])
