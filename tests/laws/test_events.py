"""Events: where they are, that none is missed, that they change nothing."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv
from visviva import events

if TYPE_CHECKING:
    from pathlib import Path

FIXED = {"dt": 2.0 * np.pi / 2000}
BY_NAME = {method.name: method for method in vv.methods()}
METHODS = list(BY_NAME)


def options(method: str) -> dict[str, Any]:
    return {"rtol": 1e-11} if BY_NAME[method].adaptive else FIXED


def kepler(e: float = 0.3) -> vv.Scene:
    """Two bodies of masses 1 and 0.5 at the pericenter, with the period 2π and the semi-major axis 1."""
    mass = np.array([1.0, 0.5])
    mu = mass.sum()
    speed = np.sqrt(mu * (1.0 + e) / (1.0 - e))
    x, v = np.array([1.0 - e, 0.0, 0.0]), np.array([0.0, speed, 0.0])
    share = np.array([-mass[1], mass[0]]) / mu
    return vv.Scene(vv.Particles(mass, share[:, None] * x, share[:, None] * v), vv.Gravity(G=1.0))


PERIOD = 2.0 * np.pi / np.sqrt(1.5)


@pytest.mark.parametrize("method", METHODS)
def test_apsides_are_half_periods_apart(method: str) -> None:
    order, symplectic = BY_NAME[method].order, BY_NAME[method].symplectic
    step = {} if BY_NAME[method].adaptive else {"dt": PERIOD / (2000 if order > 1 else 128_000)}
    if BY_NAME[method].adaptive:
        step = {"rtol": 1e-13 if BY_NAME[method].order >= 5 else 1e-9}
    out = kepler().run(t=5.2 * PERIOD, method=method, events=[events.apsis(1, 0)], **step)
    table = out.events
    expected = 0.5 * PERIOD * np.arange(1, 11)
    assert len(table) == 10
    # What the method itself is off after so many periods: of second order the phase, (ωh)²/24 of the time for steps of
    # a 2000th of the period, times what the eccentricity makes of it; where energy drifts (midpoint, Heun) 6e-4. Euler
    # is off by 0.08.
    bar = {1: 0.2, 2: 2e-4 if symplectic else 1e-3, 3: 1e-4}.get(order, 1e-8 if order == 4 else 1e-10)
    np.testing.assert_allclose(table.t, expected, rtol=0.0, atol=bar)
    relative = table.position[:, 1] - table.position[:, 0]
    velocity = table.velocity[:, 1] - table.velocity[:, 0]
    # Located to round-off: r·v changes by about 1 in a unit of time, and t has the spacing 4e-15.
    assert np.abs((relative * velocity).sum(axis=1)).max() < 3e-14
    distances = np.linalg.norm(relative, axis=1)
    np.testing.assert_allclose(distances[1::2], 0.7, rtol=1e-4 if order > 1 else 1e-2)
    np.testing.assert_allclose(distances[::2], 1.3, rtol=1e-4 if order > 1 else 1e-2)


def test_apsides_of_an_accurate_run_are_at_their_times_to_round_off() -> None:
    out = kepler().run(t=3.2 * PERIOD, method="kahan_li8", dt=PERIOD / 400, events=[events.apsis(1, 0)])
    # 25 units in the last place of the last time: round-off of 1200 steps, and r·v that changes by about one in a unit
    # of time is known to 1e-15.
    np.testing.assert_allclose(out.events.t, 0.5 * PERIOD * np.arange(1, 7), rtol=0.0, atol=5e-14)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("end", [3.1 * PERIOD, -3.1 * PERIOD])
def test_directions_are_those_of_time(direction: int, end: float) -> None:
    out = kepler().run(t=end, method="dop853", rtol=1e-12, events=[events.apsis(1, 0, direction=direction)])
    distances = np.linalg.norm(out.events.position[:, 1] - out.events.position[:, 0], axis=1)
    assert len(distances) == 3
    np.testing.assert_allclose(distances, 0.7 if direction == 1 else 1.3, rtol=1e-10)


# Between its nodes a method of order 1 leaves a polygon, whose least distance is not where r·v = 0.
@pytest.mark.parametrize("method", [name for name in METHODS if BY_NAME[name].dense_order > 1])
@pytest.mark.parametrize("depth", [1e-2, 1e-5, 1e-8])
def test_two_zeros_in_one_step_are_found(method: str, depth: float) -> None:
    """The distance goes below its bound for a time far shorter than a step."""
    step = {"rtol": 1e-10} if BY_NAME[method].adaptive else {"dt": PERIOD / 1000}
    scene = kepler()
    apart = scene.run(t=1.5 * PERIOD, method=method, events=[events.apsis(1, 0, direction=1)], **step).events
    least = np.linalg.norm(apart.position[0, 1] - apart.position[0, 0])
    for below, zeros in ((least * (1.0 + depth), 2), (least * (1.0 - depth), 0)):
        event = events.distance(0, 1, below=below, direction=0)
        out = scene.run(t=[0.5 * PERIOD, 1.5 * PERIOD], method=method, events=[event], **step)
        # The start is at the pericenter, too: it parts once from the larger bound.
        found = out.events.t[out.events.t > 0.5 * PERIOD]
        assert len(found) == zeros
        if zeros:
            np.testing.assert_allclose(found.mean(), apart.t[0], atol=1e-5)


def test_a_fly_by_on_one_long_step_is_found() -> None:
    """Two bodies on which nothing acts: an adaptive step is as long as the run."""
    scene = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [-700.0, 0.5, 0]], [[0, 0, 0], [1.0, 0, 0]]))
    out = scene.run(t=[0.0, 1e4], events=[events.distance(0, 1, below=1.0, direction=0)])
    # 700 ∓ √(1 - 0.5²), to the round-off of numbers of this size.
    np.testing.assert_allclose(out.events.t, 700.0 + np.sqrt(0.75) * np.array([-1.0, 1.0]), rtol=1e-14)
    assert out.events.position.shape == (2, 2, 3)
    assert np.isfinite(out.events.position).all()


def test_no_event_is_missed_in_a_chaotic_orbit() -> None:
    """Crossings of many planes against the sign changes of a fine record of the same run."""
    scene = vv.problems.figure_eight().scene
    scene = scene.with_state(scene.particles.position * [1.0, 1.1, 1.0], scene.particles.velocity, 0.0)
    fine = scene.run(t=np.linspace(0.0, 40.0, 400_001), method="dop853", rtol=1e-9)
    asked = [events.plane([x, 0, 0], [1.0, y, 0], body=body) for x in (-0.3, 0.1) for y in (0, 1) for body in range(3)]
    asked += [events.apsis(i, j) for i, j in ((0, 1), (1, 2), (0, 2))]
    out = scene.run(t=40.0, method="dop853", rtol=1e-9, events=asked)
    for which, event in enumerate(asked):
        what = dict(event.parameters)
        if event.kind == "plane":
            values = (fine.position[:, what["body"]] - what["point"]) @ what["normal"]
        else:
            i, j = what["body"], what["about"]
            values = ((fine.position[:, i] - fine.position[:, j]) * (fine.velocity[:, i] - fine.velocity[:, j])).sum(1)
        flips = np.flatnonzero((values[:-1] != 0) & (np.sign(values[1:]) != np.sign(values[:-1])))
        found = out.events.of(which).t
        assert len(found) == len(flips)
        assert (found >= fine.t[flips] - 1e-13).all()
        assert (found <= fine.t[flips + 1] + 1e-13).all()


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # Euler's method, whose bits are as good as any
def test_events_change_no_bit(method: str) -> None:
    times = np.linspace(0.0, 9.0, 40)
    scene = vv.problems.figure_eight().scene
    for one in (scene, kepler()):
        asked = [events.apsis(1, 0), events.plane([0.1, 0, 0], [1, 2, 0], body=1), events.energy(-1.0)]
        asked.append(lambda t, x, v: x[0, 1] - 0.1 * t)
        plain = one.run(t=times, method=method, record=("position", "velocity", "energy"), **options(method))
        watched = one.run(
            t=times, method=method, record=("position", "velocity", "energy"), events=asked, **options(method)
        )
        for column in ("position", "velocity", "energy"):
            np.testing.assert_array_equal(getattr(plain, column), getattr(watched, column))
        assert watched.final == plain.final
        assert watched.stats.steps == plain.stats.steps
        assert len(watched.events) > 5


@pytest.mark.parametrize("method", ["dop853", "leapfrog", "stormer13"])
def test_members_have_the_events_they_have_alone(method: str) -> None:
    scene = vv.problems.figure_eight().scene
    factors = 1.0 + 0.005 * np.arange(21)
    copies = scene.ensemble(velocity=scene.particles.velocity * factors[:, None, None])
    asked = [events.apsis(1, 0), events.distance(0, 2, below=1.1, direction=0), events.plane([0, 0, 0], [1, 0, 0])]
    runs = [copies.run(t=6.0, method=method, events=asked, threads=threads, **options(method)) for threads in (1, 2, 3)]
    for run in runs[1:]:
        for name in ("which", "t", "position", "velocity", "member"):
            np.testing.assert_array_equal(getattr(run.events, name), getattr(runs[0].events, name))
    for index in (0, 7, 20):
        alone = scene.with_state(copies.position[index], copies.velocity[index], 0.0)
        table = alone.run(t=6.0, method=method, events=asked, **options(method)).events
        of_copy = runs[0][index].events
        assert len(table) >= 3
        assert not of_copy.member.any()
        for name in ("which", "t", "position", "velocity"):
            np.testing.assert_array_equal(getattr(table, name), getattr(of_copy, name))
    some = runs[0][5:8].events
    np.testing.assert_array_equal(np.unique(some.member), [0, 1, 2])


@pytest.mark.parametrize("method", ["dop853", "leapfrog"])
def test_members_that_drift_have_the_events_they_have_alone(method: str) -> None:
    """Where a body is in the scene takes the origin of its own member: elsewhere in some, at rest in others."""
    scene = vv.problems.figure_eight().scene
    drift = np.where(np.arange(19) % 3 == 0, 0.0, 0.02 * np.arange(19))
    copies = scene.ensemble(velocity=scene.particles.velocity + drift[:, None, None] * [1.0, 0.5, 0.0])
    asked = [events.plane([0.1, 0, 0], [1, 0.5, 0], body=1), events.apsis(2, [0.3, 0.1, 0]), events.apsis(0, 1)]
    run = copies.run(t=6.0, method=method, events=asked, **options(method))
    for index in (0, 1, 2, 8, 9, 18):
        alone = scene.with_state(copies.position[index], copies.velocity[index], 0.0)
        table = alone.run(t=6.0, method=method, events=asked, **options(method)).events
        assert set(table.which) == {0, 1, 2}
        for name in ("which", "t", "position", "velocity"):
            np.testing.assert_array_equal(getattr(table, name), getattr(run[index].events, name))


@pytest.mark.parametrize(("method", "each"), [("dop853", 4.5), ("leapfrog", 5.0)])
def test_only_steps_that_may_hold_a_zero_are_looked_into(method: str, each: float) -> None:
    """The inside of a step of dop853 takes three evaluations more, and a shadow step of leapfrog one."""
    scene = kepler(0.5)
    step = {"rtol": 1e-9} if method == "dop853" else {"dt": PERIOD / 500}
    plain = scene.run(t=50.2 * PERIOD, method=method, **step).stats
    far = scene.run(t=50.2 * PERIOD, method=method, events=[events.plane([3.0, 0, 0], [1, 0, 0])], **step).stats
    assert far.evaluations == plain.evaluations
    out = scene.run(t=50.2 * PERIOD, method=method, events=[events.apsis(1, 0)], **step)
    assert len(out.events) == 100
    assert out.stats.evaluations - plain.evaluations <= each * len(out.events)


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
    assert out.events.t == pytest.approx([end], rel=1e-15)
    if out.events.t[0] == end:
        assert list(out.t) == [0.25, 0.5, 1.0][: 2 if end == 0.5 else 3]


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
    np.testing.assert_allclose(table.t, other.t, atol=1e-8)
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


def test_the_energy_passes_a_value() -> None:
    scene = kepler()
    level = scene.run(t=1.0).energy[0]
    kinetic = events.function(lambda t, x, v: 0.5 * float((v**2).sum(axis=1) @ [1.0, 0.5]) - 0.4)
    out = scene.run(t=2.1 * PERIOD, method="dop853", events=[events.energy(level + 1e-3), kinetic])
    assert set(out.events.which) == {1}
    values = 0.5 * (out.events.velocity**2).sum(axis=2) @ [1.0, 0.5]
    np.testing.assert_allclose(values, 0.4, rtol=1e-14)


def test_what_a_function_raises_ends_the_run() -> None:
    class Broken(Exception):
        pass

    broken = Broken("as it is")

    def fail(t: float, position: np.ndarray, velocity: np.ndarray) -> float:
        if t > 1.0:
            raise broken
        return 1.0

    for scene in (kepler(), kepler().ensemble(mass=np.array([[1.0, 0.5], [1.0, 0.4]]))):
        for method in ("dop853", "leapfrog"):
            with pytest.raises(Broken) as caught:
                scene.run(t=10.0, method=method, events=[fail], threads=2, **options(method))
            assert caught.value is broken

    def stop(t: float, position: np.ndarray, velocity: np.ndarray) -> float:
        if t > 1.0:
            raise KeyboardInterrupt
        return 1.0

    with pytest.raises(vv.Interrupted):
        kepler().run(t=10.0, method="dop853", events=[stop])


def test_tables_are_saved_and_pickled(tmp_path: Path) -> None:
    scene = kepler()
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None])
    for out in (scene.run(t=9.0, events=[events.apsis(1, 0)]), copies.run(t=9.0, events=[events.apsis(1, 0)])):
        out.save(tmp_path / "run.npz")
        for again in (vv.load(tmp_path / "run.npz"), pickle.loads(pickle.dumps(out))):
            for name in ("which", "t", "position", "velocity", "member"):
                np.testing.assert_array_equal(getattr(again.events, name), getattr(out.events, name))
    event = events.plane([0, 0, 1], [0, 0, 1], body=3, terminal=2)
    assert pickle.loads(pickle.dumps(event)) == event
    assert hash(event) == hash(events.plane([0, 0, 1], [0, 0, 1], body=3, terminal=2))
