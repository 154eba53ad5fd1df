"""Events: where they are, that none is missed, that they change nothing.

Bounds: an event is where the interpolated motion has it, at rtol 1e-10; what is known in closed form, to some
roundings.
"""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING

import numpy as np
import pytest
from event_scenes import BY_NAME, METHODS, PERIOD, kepler, options

import visviva as vv
from visviva import events

if TYPE_CHECKING:
    from pathlib import Path


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
    # What the method makes of the ellipse: of order 1 half a percent, of order 2 at most 3.5e-5.
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
            # Between its nodes a method has its dense order: of the roughest 8e-7.
            np.testing.assert_allclose(found.mean(), apart.t[0], rtol=0.0, atol=3e-6)


@pytest.mark.parametrize("method", ["kahan_li8", "stormer13", "blanes_moan_rkn6_14", "verner98"])
def test_a_shallow_approach_within_a_step_is_found_wherever_it_is(method: str) -> None:
    """Two bodies in a well: d² = a² cos² + b² sin², below r² for a sixth of a step of 0.3, wherever in that step.

    Where the cubics through its ends pass zero between other samples than the motion does, the way in was lost."""
    step, a, b = 0.3, 4.0, 1.4
    below = b * 1.004
    # d² = r² at a distance x from the quarter of the turn with (a² − b²) sin² x = r² − b².
    half = np.arcsin(np.sqrt((below**2 - b**2) / (a**2 - b**2)))
    for shift in np.linspace(0.0, step, 61, endpoint=False):
        # The quarter of the turn comes when 7 steps and that part of one have passed.
        phase = 0.5 * np.pi - (7.0 * step + shift)
        c, si = np.cos(phase), np.sin(phase)
        places = [[0.5 * a * c, 0.5 * b * si, 0.0], [-0.5 * a * c, -0.5 * b * si, 0.0]]
        speeds = [[-0.5 * a * si, 0.5 * b * c, 0.0], [0.5 * a * si, -0.5 * b * c, 0.0]]
        scene = vv.Scene(vv.Particles([1.0, 1.0], places, speeds), vv.Harmonic(1.0))
        asked = {} if method == "verner98" else {"dt": step}
        out = scene.run(t=3.6, method=method, events=[events.distance(0, 1, below=below, direction=0)], **asked)
        # Of errors of 21 steps in a turn, up to 1e-7 of the distance, where that falls with a slope of 0.3.
        np.testing.assert_allclose(out.events.t, 7.0 * step + shift + np.array([-half, half]), rtol=0.0, atol=1e-6)


@pytest.mark.parametrize(("method", "step"), [("kahan_li8", 0.1), ("kahan_li8", 0.25), ("stormer13", 0.08)])
def test_a_plane_that_is_grazed_is_passed_twice(method: str, step: float) -> None:
    """x = cos(t + φ) beyond 0.9999 for 0.028, somewhere within a step: one of the two ways was lost."""
    half = np.arccos(0.9999)
    plane = events.plane([0.9999, 0.0, 0.0], [1.0, 0.0, 0.0])
    for phase in np.linspace(0.5, 6.0, 45):
        start = vv.Particles(
            [1.0], [[np.cos(phase), 0.3 * np.sin(phase), 0.0]], [[-np.sin(phase), 0.3 * np.cos(phase), 0.0]]
        )
        found = vv.Scene(start, vv.Harmonic(1.0)).run(t=18.0, method=method, dt=step, events=[plane]).events.t
        middles = 2.0 * np.pi * np.arange(1, 4) - phase
        exact = np.sort(np.concatenate([middles - half, middles + half]))
        # A slope of 0.014, and of 25 steps in a turn 1e-9 after three of them.
        np.testing.assert_allclose(found, exact[(exact > 0.0) & (exact < 18.0)], rtol=0.0, atol=2e-5)


@pytest.mark.parametrize("direction", [0, 1, -1])
def test_a_greatest_distance_is_passed_once_each_way(direction: int) -> None:
    """d² = a² cos² + b² sin² grazes what is 1e-4 short of a: twice in half a turn, and never twice at a time."""
    a, b, graze = 4.0, 1.4, 1.0 - 1e-4
    half = np.arcsin(np.sqrt((a**2 - (graze * a) ** 2) / (a**2 - b**2)))
    for phase in np.linspace(0.3, 2.8, 41):
        c, si = np.cos(phase), np.sin(phase)
        places = [[0.5 * a * c, 0.5 * b * si, 0.0], [-0.5 * a * c, -0.5 * b * si, 0.0]]
        speeds = [[-0.5 * a * si, 0.5 * b * c, 0.0], [0.5 * a * si, -0.5 * b * c, 0.0]]
        scene = vv.Scene(vv.Particles([1.0, 1.0], places, speeds), vv.Harmonic(1.0))
        event = events.distance(0, 1, below=graze * a, direction=direction)
        found = scene.run(t=3.0, method="kahan_li8", dt=0.1, events=[event]).events.t
        exact = np.array([np.pi - phase - half, np.pi - phase + half])
        wanted = {0: exact, 1: exact[:1], -1: exact[1:]}[direction]
        np.testing.assert_allclose(found, wanted[(wanted > 0) & (wanted < 3.0)], rtol=0.0, atol=1e-6)


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


def test_tables_of_events_know_the_names_of_bodies() -> None:
    bodies = vv.Particles([1.0, 1e-3], [[0.0, 0, 0], [1.0, 0, 0]], [[0.0, 0, 0], [0, 1.0, 0]], names=["Sun", "Earth"])
    passes = vv.events.plane([0.0, 0.0, 0.0], normal=[0.0, 1.0, 0.0])
    table = vv.Scene(bodies, vv.Gravity(1.0)).run(t=20.0, events=[passes]).events
    assert table.names == ("Sun", "Earth") == table[:1].names == table.of(0).names
    assert list(table._exported(None).axes["body"]) == ["Sun", "Earth"]
    with pytest.raises(vv.InvalidInput, match="body"):
        table.plot(body="Mars")
