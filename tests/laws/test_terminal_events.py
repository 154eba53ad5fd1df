"""Events that end a run: where, with which rows, of members and of bodies that are integrated apart.

Bounds: a distance at its event, to some roundings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from event_scenes import BY_NAME, METHODS, PERIOD, kepler, options

import visviva as vv
from visviva import events

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # Euler's method, which ends all the same
def test_a_terminal_event_ends_the_run(method: str) -> None:
    scene = kepler()
    times = np.linspace(0.0, 4.0 * PERIOD, 81)
    asked = [events.apsis(1, 0, direction=1, terminal=2), events.plane([0, 0, 0], [0, 1, 0], body=1)]
    out = scene.run(t=times, method=method, events=asked, **options(method))
    assert out.status is vv.Status.STOPPED
    last = out.events.of(0)
    assert len(last) == 2
    assert out.final.t0 == last.t[-1]
    np.testing.assert_array_equal(out.final.particles.position, last.position[-1])
    assert out.events.t.max() == out.final.t0
    whole = scene.run(t=times, method=method, **options(method))
    rows = int((times <= out.final.t0).sum())
    np.testing.assert_array_equal(out.t, times[:rows])
    np.testing.assert_array_equal(out.position, whole.position[:rows])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("end", [0.5, 1.0])
def test_an_event_on_an_output_keeps_its_row(method: str, end: float) -> None:
    """A body that comes to a plane at the very node of an output, before the end of the run or at it."""
    body = vv.Particles(mass=[1.0], position=[[-end, 0.0, 0.0]], velocity=[[1.0, 0.0, 0.0]])
    plane = events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], terminal=True)
    scene = vv.Scene(body)
    how = {} if BY_NAME[method].adaptive else {"dt": 0.125}
    out = scene.run([0.25, 0.5, 1.0], method=method, events=[plane], **how)
    # Adaptive methods find the time to round-off.
    assert out.events.t == pytest.approx([end], rel=1e-15, abs=0)
    if out.events.t[0] == end:
        assert list(out.t) == [0.25, 0.5, 1.0][: 2 if end == 0.5 else 3]


@pytest.mark.parametrize("how", [{"method": "leapfrog", "dt": 0.125}, {}])
def test_an_event_at_the_end_that_was_asked_for_adds_no_row(how: dict[str, Any]) -> None:
    body = vv.Particles(mass=[1.0], position=[[-1.0, 0.0, 0.0]], velocity=[[1.0, 0.0, 0.0]])
    out = vv.Scene(body).run(1.0, events=[events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], terminal=True)], **how)
    assert out.status is vv.Status.STOPPED
    assert out.t.tolist() == [0.0, 1.0]


def test_the_last_row_has_rigid_bodies_as_they_are_at_the_event() -> None:
    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], position=[0.0, 0.0, 2.0], angular_velocity=[0.3, 0.9, -0.5])
    ground = events.plane([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], terminal=True)
    out = vv.Scene(body, vv.UniformField([0.0, 0.0, -1.0])).run(5.0, events=[ground])
    ended = out.final.rigid_bodies
    np.testing.assert_array_equal(out.orientation[-1], ended.orientation)
    np.testing.assert_array_equal(out.angular_velocity[-1], ended.angular_velocity)
    assert np.abs(out.orientation[-1] - out.orientation[0]).max() > 0.1
    assert np.abs(out.angular_velocity[-1] - out.angular_velocity[0]).max() > 0.1


@pytest.mark.parametrize("method", ["dop853", "leapfrog"])
def test_members_stop_each_at_its_own_event(method: str) -> None:
    scene = kepler()
    copies = scene.ensemble(velocity=scene.particles.velocity * np.linspace(0.9, 1.1, 11)[:, None, None])
    times = np.linspace(0.0, 0.7 * PERIOD, 50)
    out = copies.run(
        t=times, method=method, events=[events.apsis(1, 0, direction=-1, terminal=True)], **options(method)
    )
    stopped = out.status == vv.Status.STOPPED
    assert stopped.any()
    assert not stopped.all()
    for index in range(len(copies)):
        of_copy = out[index].events.t
        assert len(of_copy) == int(stopped[index])
        reached = times <= of_copy[0] if len(of_copy) else np.ones(len(times), dtype=bool)
        np.testing.assert_array_equal(np.isfinite(out.position[index]).all(axis=(1, 2)), reached)
    assert "0 failed" in repr(out)


def test_bodies_that_are_integrated_apart_are_brought_to_the_event() -> None:
    """Massless bodies beside an adaptive method, and bodies on which nothing acts, are units of their own."""
    rng = np.random.default_rng(1)
    mass = np.zeros(70)
    mass[:2] = 1.0, 1e-3
    angle = rng.uniform(0.0, 2.0 * np.pi, 70)
    radius = np.concatenate([[0.0, 1.0], rng.uniform(1.5, 3.0, 68)])
    position = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    speed = np.divide(1.0, np.sqrt(radius), where=radius > 0, out=np.zeros(70))
    velocity = speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1)
    scene = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1.0))
    asked = [
        events.plane([0, 0, 0], [0, 1.0, 0], body=1),
        events.apsis(5, 0),
        events.distance(3, 66, below=2.0, direction=0),
        lambda t, x, v: x[10, 0] - x[69, 0],
    ]
    plain = scene.run(t=[0.0, 10.0, 20.0], rtol=1e-11)
    out = scene.run(t=[0.0, 10.0, 20.0], rtol=1e-11, events=asked)
    np.testing.assert_array_equal(out.position, plain.position)
    separation = out.events.of(2).position[:, 3] - out.events.of(2).position[:, 66]
    np.testing.assert_allclose(np.linalg.norm(separation, axis=1), 2.0, rtol=1e-14)
    assert len(separation) > 0
    assert len(out.events.of(3)) > 0
    assert np.isfinite(out.events.of(3).position).all()
    assert np.isnan(out.events.of(0).position[:, 5:]).all()
    stop = scene.run(t=np.linspace(0, 20, 201), rtol=1e-11, events=[events.distance(3, 66, below=2.0, terminal=True)])
    assert stop.status is vv.Status.STOPPED
    assert stop.final.t0 == stop.events.t[-1]
    separation = stop.final.particles.position[3] - stop.final.particles.position[66]
    # Each comes there by its own steps: what rtol leaves.
    assert abs(np.linalg.norm(separation) - 2.0) < 1e-8
    assert stop.t[-1] <= stop.final.t0 < stop.t[-1] + 0.1


@pytest.mark.parametrize(("massive", "massless"), [(1, 9), (2, 9), (3, 9), (8, 9), (9, 9), (3, 300), (9, 300)])
@pytest.mark.parametrize("height", [0.0, 0.1])
def test_series_see_massless_bodies_move(massive: int, massless: int, height: float) -> None:
    """Bodies that are looked at together are on one step, where massless ones stood still in series, with status OK."""
    rng = np.random.default_rng(massive)
    angle = np.linspace(0.0, 2.0 * np.pi, massive, endpoint=False)
    radius = np.concatenate([[0.0], np.linspace(8.0, 12.0, massive - 1), rng.uniform(1.0, 2.0, massless)])
    angle = np.concatenate([angle, rng.uniform(0.0, 2.0 * np.pi, massless)])
    mass = np.concatenate([[1.0], np.full(massive - 1, 1e-3), np.zeros(massless)])
    speed = 1.1 * np.divide(1.0, np.sqrt(radius), where=radius > 0, out=np.zeros(len(radius)))
    position = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), height * np.cos(angle)], axis=1)
    velocity = speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1)
    scene = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1.0))
    last = len(mass) - 1
    asked = [
        events.apsis(massive, 0),
        events.plane([0, 0, 0], [0, 1.0, 0], body=last),
        events.distance(massive, last, below=2.0, direction=0),
        lambda t, x, v: x[massive + 1, 0] - x[last, 0],
    ]
    table = scene.run(t=20.0, method="taylor", rtol=1e-12, events=asked).events
    other = scene.run(t=20.0, method="dop853", rtol=1e-12, events=asked).events
    assert {0, 1, 3} <= set(table.which)
    np.testing.assert_array_equal(table.which, other.which)
    # The tolerance, magnified by some turns.
    np.testing.assert_allclose(table.t, other.t, rtol=0, atol=1e-8)
    copies = scene.ensemble(velocity=velocity * np.array([1.0, 1.01, 0.99])[:, None, None])
    for threads in (1, 3):
        together = copies.run(t=20.0, method="taylor", rtol=1e-12, events=asked, threads=threads)
        np.testing.assert_array_equal(together[0].events.t, table.t)


@pytest.mark.parametrize("massive", [2, 20])
def test_an_event_of_massive_bodies_stops_those_that_follow_them(massive: int) -> None:
    """Few massive bodies are one system in a lane; many are in all lanes, and are integrated again on other threads."""
    rng = np.random.default_rng(3)
    massless = 300
    radius = np.concatenate([[0.0], 1.0 + 0.2 * np.arange(massive - 1), rng.uniform(8.0, 12.0, massless)])
    angle = rng.uniform(0.0, 2.0 * np.pi, len(radius))
    angle[1] = -0.5
    position = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), 0.1 * np.cos(angle)], axis=1)
    speed = np.divide(1.0, np.sqrt(radius), where=radius > 0, out=np.zeros(len(radius)))
    velocity = speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1)
    mass = np.where(np.arange(len(radius)) < massive, 1e-6, 0.0)
    mass[0] = 1.0
    scene = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1.0))
    # The second body rises through the plane y = 0 after about 0.5.
    asked = [events.plane([0, 0, 0], [0, 1.0, 0], body=1, direction=1)]
    ending = [events.plane([0, 0, 0], [0, 1.0, 0], body=1, direction=1, terminal=True)]
    times = np.linspace(0.0, 2.0, 21)
    plain = scene.run(t=times, rtol=1e-10, method="dop853")
    watched = scene.run(t=times, rtol=1e-10, method="dop853", events=asked)
    np.testing.assert_array_equal(watched.position, plain.position)
    assert watched.final == plain.final
    assert len(watched.events) == 1
    runs = [scene.run(t=times, rtol=1e-10, method="dop853", events=ending, threads=n) for n in (1, 2, 3)]
    for run in runs:
        assert run.status is vv.Status.STOPPED
        assert run.final.t0 == watched.events.t[0]
        rows = int((times <= run.final.t0).sum())
        np.testing.assert_array_equal(run.position, plain.position[:rows])
        assert run.final == runs[0].final
        assert run.stats.evaluations == runs[0].stats.evaluations
        assert run.stats.steps == runs[0].stats.steps
        assert run.stats.steps < plain.stats.steps
    # A run to the time of the event ends its last steps there: what rtol leaves.
    to_there = scene.run(t=[0.0, float(runs[0].final.t0)], rtol=1e-10, method="dop853").final.particles
    np.testing.assert_allclose(runs[0].final.particles.position, to_there.position, rtol=0.0, atol=1e-7)


COLUMNS = ("position", "velocity", "energy", "angular_momentum")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # Euler's method, which ends all the same
def test_the_last_row_of_a_run_to_an_end_time_is_the_event(method: str) -> None:
    """In every column; a table of output times has rows at those times alone."""
    scene = kepler()
    asked = [events.apsis(1, 0, direction=1, terminal=True)]
    out = scene.run(4.0 * PERIOD, method=method, events=asked, record=COLUMNS, **options(method))
    assert list(out.t) == [scene.t0, out.final.t0]
    np.testing.assert_array_equal(out.position[-1], out.events.position[-1])
    np.testing.assert_array_equal(out.velocity[-1], out.events.velocity[-1])
    there = out.final.run([out.final.t0], record=COLUMNS)
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(out, name)[-1], getattr(there, name)[0])


def test_the_last_row_of_a_contact_has_the_masses_of_before_and_after() -> None:
    """Two spheres merge, what they become passes a plane: its energy is that of one body, 2·½²/2."""
    pair = vv.Particles(mass=[1.0, 1.0], position=[[0, 0, 0], [3, 0, 0]], velocity=[[0, 0, 0], [-1, 0, 0]], radius=0.5)
    scene = vv.Scene(pair)
    out = scene.run(10.0, collisions="stop", record=("position", "energy"))
    assert list(out.t) == [0.0, 2.0]
    np.testing.assert_array_equal(out.position[-1], [[0, 0, 0], [1, 0, 0]])
    plane = events.plane([-0.5, 0.0, 0.0], [1.0, 0.0, 0.0], terminal=True)
    merged = scene.run(10.0, collisions="merge", events=[plane], record=("position", "energy"))
    # From 1/2 at t = 2 over a length of 1 at half the speed.
    assert merged.t == pytest.approx([0.0, 4.0], abs=1e-15)
    assert merged.energy == pytest.approx([0.5, 0.25], abs=1e-15)


def test_a_saved_run_to_an_end_time_ends_with_the_event(tmp_path: Path) -> None:
    scene = kepler()
    how = {"events": [events.apsis(1, 0, direction=1, terminal=True)], "method": "dop853", "record": COLUMNS}
    straight = scene.run(4.0 * PERIOD, **how)
    saved = scene.run(4.0 * PERIOD, save_every=0.3 * PERIOD, save_to=tmp_path / "run", **how)
    for out in (saved, vv.resume(tmp_path / "run")):
        assert len(out.t) == 2
        # Parts have steps of their own: as near as rtol = 1e-9 holds them.
        assert out.t == pytest.approx(straight.t, rel=1e-7, abs=0)
        assert out.energy == pytest.approx(straight.energy, rel=1e-7, abs=0)


@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize("method", ["rk4", "leapfrog", "dop853"])
def test_what_comes_and_goes_after_the_end_in_the_same_step_is_not_told(method: str, backward: bool) -> None:
    # y = (t - 1.5)² - 0.01 is zero at 1.4 and 1.6, in the step of 4 in which x = t comes to 1: at the second of the two
    # it becomes positive, which it is at 1 as well.
    sign = -1.0 if backward else 1.0
    throw = vv.Scene(
        vv.Particles([1.0], [[0.0, 2.24, 0.0]], [[sign, -3.0 * sign, 0.0]]), vv.UniformField((0.0, 2.0, 0.0))
    )
    end = events.plane([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], body=0, terminal=True)
    turn = events.plane([0.0, 0.0, 0.0], [0.0, 1.0, 0.0], body=0)
    how = {"method": method} if method == "dop853" else {"method": method, "dt": 4.0}
    out = throw.run(4.0 * sign, events=[end, turn], **how)
    assert out.events.which.tolist() == [0]
    assert out.events.t.tolist() == pytest.approx([sign], rel=0.0, abs=1e-14)  # uniform motion
    both = throw.run(4.0 * sign, events=[turn], **how).events.t
    assert both.tolist() == pytest.approx([1.4 * sign, 1.6 * sign], rel=0.0, abs=1e-14)  # every method knows parabolas
