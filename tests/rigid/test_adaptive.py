"""Bodies that torques turn, by methods that choose their steps: quaternions and momenta beside the points."""

import itertools
from typing import Any

import numpy as np
import pytest

import visviva as vv

DOWN = vv.UniformField([0.0, 0.0, -9.81])
# Of Brüls and Cardona's top at t = 2, to 16 digits (benches/python/rigid_scene.py).
CENTER = np.array([-0.1504168227456418, -0.7241655916368957, -0.6730222695604441])
METHODS = ["taylor", "verner98", "dop853", "dormand_prince54", "tsitouras54", "bogacki_shampine32"]


def top(spin: float = 150.0) -> vv.Scene:
    spins = [0.0, spin, -4.61538]
    inertia = np.diag([0.234375, 0.46875, 0.234375])
    return vv.Scene(
        vv.RigidBody(15.0, inertia=inertia, position=[0, 1, 0], angular_velocity=spins, pivot=[0, -1, 0]), DOWN
    )


def company() -> vv.Scene:
    """A planet, a massless body and an asymmetric moon on a spring, all of which gravity moves."""
    return vv.Scene(
        vv.Particles([1.0, 0.0], [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0]], [[0.0, 0.5, 0.0], [0.0, 0.0, 0.2]]),
        vv.RigidBody(2.0, [1.0, 1.5, 2.0], position=[0.0, 0.0, 1.0], angular_velocity=[0.3, 0.2, 1.0]),
        vv.AttachedSpring(0, [0.1, 0.2, 0.3], 5.0, anchor=[0.0, 0.0, 0.0]),
        vv.Gravity(0.05),
    )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_top_is_where_it_should_be(method: str, rtol: float) -> None:
    out = top().run(t=2.0, method=method, rtol=rtol)
    assert out.status == vv.Status.OK
    # 48 turns at a tolerance of each step: measured 13 rtol at order 8, 26 at order 3.
    assert np.abs(out.position[-1, 0] - CENTER).max() < 60 * rtol
    # What a step leaves of lengths is put right: of quaternions, and of the arm of the pivot.
    assert np.linalg.norm(out.orientation[-1, 0]) == pytest.approx(1.0, rel=0.0, abs=4e-16)
    assert np.linalg.norm(out.position[-1, 0]) == pytest.approx(1.0, rel=0.0, abs=1e-15)


def test_errors_follow_the_tolerance() -> None:
    errors = [
        np.abs(top().run(t=2.0, method="verner98", rtol=rtol).position[-1, 0] - CENTER).max()
        for rtol in (1e-6, 1e-8, 1e-10, 1e-12)
    ]
    # Of an order of 8 steps are a third for each two digits, so the error falls by them, give or take one.
    assert all(10.0 < before / after < 1000.0 for before, after in itertools.pairwise(errors))


@pytest.mark.parametrize("end", [2.0, -2.0])
def test_outputs_are_on_the_way(end: float) -> None:
    t = np.linspace(0.0, end, 23)
    found, small = top().run(t=t, method="verner98", rtol=1e-12), top().run(t=t, method="kahan_li8", dt=1 / 128)
    for name, size in [("orientation", 1.0), ("position", 1.0), ("velocity", 150.0), ("angular_velocity", 150.0)]:
        # Between its steps the method is of order 8, and steps are nearly a radian: measured 8e-11 of the sizes.
        assert np.abs(getattr(found, name) - getattr(small, name)).max() < 5e-10 * size, name
    # Outputs change nothing of the way.
    alone = top().run(t=end, method="verner98", rtol=1e-12)
    assert np.array_equal(alone.orientation[-1], found.orientation[-1])


@pytest.mark.parametrize("asked", [{}, {"method": "dop853"}, {"method": "tsitouras54"}, {"method": "verner98"}])
def test_events_are_found_on_the_way(asked: dict[str, Any]) -> None:
    events = [vv.events.plane([0.0, 0.0, -0.3], [0.0, 0.0, 1.0])]
    found = top().run(t=2.0, events=events, rtol=1e-11, **asked).events
    small = top().run(t=2.0, events=events, method="kahan_li8", dt=1 / 2048).events
    assert len(found.t) == len(small.t) == 5
    # The center is as fast as 5, so a place that is off by 1e-10 is met so much later; of the cubics between the steps
    # of the other run 1e-9 is left.
    np.testing.assert_allclose(found.t, small.t, rtol=0.0, atol=2e-9)
    # Found where the polynomial of the center is there, and told with the center where the orientation has it.
    np.testing.assert_allclose(found.position[0][:, 2], -0.3, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("method", ["taylor", "verner98", "dop853", "tsitouras54"])
def test_velocities_of_a_held_body_are_told_within_steps(method: str) -> None:
    """A pendulum from the side: it is slowest up there and at rest at no other place, a half of its period apart."""
    body = vv.RigidBody(
        1.0,
        [0.4, 0.5, 0.3],
        position=[1.0, 0.0, 0.0],
        pivot=[0.0, 0.0, 1.0],
        orientation=[0.0, -np.sin(np.pi / 4), 0.0, np.cos(np.pi / 4)],
    )
    turns = vv.events.function(lambda t, x, v: float(v[0, 2]))
    found = vv.Scene(body, vv.UniformField([0.0, 0.0, -10.0])).run(t=5.0, method=method, rtol=1e-11, events=[turns])
    # J = I + m d² = 1.5 about the pivot, m g d = 10: K(sin² 45°) √(J/mgd) from one to the next, at the bottom and at
    # the sides.
    quarter = 1.8540746773013719 * np.sqrt(0.15)
    np.testing.assert_allclose(found.events.t, quarter * np.arange(1, len(found.events.t) + 1), rtol=0.0, atol=1e-8)
    assert len(found.events.t) == 6


def test_events_change_no_bit_of_the_run() -> None:
    one = vv.RigidBody(1.0, [1, 2, 2.5], velocity=[0, 1, 0], angular_velocity=[0.3, 1, 0.2])
    two = vv.RigidBody(1.0, [1, 2, 2.5], position=[3, 0, 0], velocity=[0, 1, 0], angular_velocity=[1, 0.5, 0.2])
    scene = vv.Scene(one, two, vv.RotationalDrag(0.1))
    asked: dict[str, Any] = {"t": [2.0, 5.0], "method": "verner98"}
    alone = scene.run(**asked)
    for event in (vv.events.distance(0, 1, below=2.0), vv.events.function(lambda t, x, v: float(x[0, 1] - 1.0))):
        # It looks at both, which are on steps of their own.
        seen = scene.run(events=[event], **asked)
        for name in ("orientation", "angular_velocity", "position"):
            assert np.array_equal(getattr(alone, name), getattr(seen, name)), name
        assert np.array_equal(alone.final.rigid_bodies.orientation, seen.final.rigid_bodies.orientation)


@pytest.mark.parametrize("method", ["taylor", "verner98", "dop853"])
def test_a_run_goes_on_behind_the_event_that_ended_it(method: str) -> None:
    """Where a held center is follows from its orientation, not from the polynomial on which the event is sought."""
    stop = vv.events.plane([0.0, 0.0, -0.3], [0.0, 0.0, 1.0], terminal=True)
    scene, times = top(), []
    for _ in range(4):
        out = scene.run(t=2.0, method=method, rtol=1e-9, events=[stop])
        times.append(float(out.events.t[0]))
        scene = out.final
    assert times == pytest.approx(
        top().run(t=2.0, method=method, rtol=1e-12, events=[vv.events.plane([0, 0, -0.3], [0, 0, 1])]).events.t[:4],
        rel=0.0,
        abs=1e-6,
    )


def test_bodies_points_and_massless_ones_together() -> None:
    t = np.linspace(0.0, 10.0, 7)
    small = company().run(t=t, method="kahan_li8", dt=1e-3)
    for method, off in [("taylor", 1e-10), ("verner98", 1e-10), ("dop853", 1e-9)]:
        found = company().run(t=t, method=method, rtol=1e-12)
        for name in ("position", "velocity", "orientation", "angular_velocity"):
            assert np.abs(getattr(found, name) - getattr(small, name)).max() < off, (method, name)
        # It looks at no velocities, so energy is what the tolerance leaves of it.
        assert np.abs(found.energy - found.energy[0]).max() < 1e-10


@pytest.mark.parametrize("torque", [vv.RotationalDrag(0.2), vv.AppliedTorque([0.1, 0.2, 0.3])])
@pytest.mark.parametrize("end", [20.0, 300.0])
def test_what_nothing_couples_to_a_body_is_followed_too(
    torque: vv.RotationalDrag | vv.AppliedTorque, end: float
) -> None:
    """A particle in a well beside a body that a torque turns: it went in a 64th of the run, whatever the tolerance."""
    body = vv.RigidBody(1.0, moments=[1, 2, 2.5], angular_velocity=[0.3, 2.0, 0.5], position=[1.0, 0, 0])
    dot = vv.Particles([1.0], [[3.0, 0, 0]], [[0, 0.5, 0]])
    out = vv.Scene(dot, body, vv.Harmonic(1.0), torque).run(t=end)
    exact = [3.0 * np.cos(end), 0.5 * np.sin(end), 0.0], [np.cos(end), 0.0, 0.0]
    # 48 turns at a tolerance of 1e-9 of each step; measured 4e-9.
    np.testing.assert_allclose(out.position[-1], exact, rtol=0.0, atol=1e-7)


def test_there_and_back() -> None:
    there = company().run(t=10.0, method="verner98", rtol=1e-12).final
    back = there.run(t=0.0, method="verner98", rtol=1e-12)
    start = company().run(t=[0.0, 1.0])
    assert np.abs(back.position[-1] - start.position[0]).max() < 1e-10
    assert np.abs(back.orientation[-1] - start.orientation[0]).max() < 1e-10


@pytest.mark.parametrize("method", ["taylor", "verner98", "tsitouras54"])
def test_a_copy_is_what_it_is_alone(method: str) -> None:
    spins = np.array([[[0.0, 150.0 * (1 + i / 3), -4.6]] for i in range(11)])
    copies = top().ensemble(angular_velocity=spins)
    asked: dict[str, Any] = {"t": [0.3, 1.0], "method": method}
    together = copies.run(threads=2, **asked)
    for threads in (1, 3):
        assert np.array_equal(copies.run(threads=threads, **asked).orientation, together.orientation)
    for i in range(11):
        alone = copies[i].run(**asked)
        assert np.array_equal(alone.orientation, together.orientation[i])
        assert np.array_equal(alone.angular_velocity, together.angular_velocity[i])


def test_a_copy_that_takes_the_place_of_another_begins_anew() -> None:
    """Beside points by themselves: the ninth copy comes into a lane that has the roundings of the first."""
    scene = vv.Scene(
        vv.Particles([1.0, 2.0], [[1.0, 0, 0], [5.0, 0, 0]], [[0, 0.1, 0], [0, 0, 0.0]]),
        vv.RigidBody(1.3, [1.0, 1.5, 2.0], position=[0.3, 0.2, 1.0], angular_velocity=[0.3, 0.2, 1.0]),
        vv.AttachedSpring(0, [0.1, 0.2, 0.3], 5.0, anchor=[0.0, 0.0, 0.0]),
    )
    start = np.array([[1.0, 0, 0], [5.0, 0, 0], [0.3, 0.2, 1.0]])
    places = start + np.random.default_rng(0).normal(size=(19, 3, 3)) * 10.0 ** (np.arange(19) % 5)[:, None, None]
    copies = scene.ensemble(position=places)
    together = copies.run(t=[1.0, 3.0])
    for i in range(19):
        alone = copies[i].run(t=[1.0, 3.0])
        assert np.array_equal(alone.position, together.position[i]), i
        assert np.array_equal(alone.orientation, together.orientation[i]), i


def test_events_of_a_copy_are_those_that_it_has_alone() -> None:
    spins = np.array([[[0.0, 150.0 * (1 + i / 3), -4.6]] for i in range(11)])
    copies = top().ensemble(angular_velocity=spins)
    asked: dict[str, Any] = {"t": 1.5, "events": [vv.events.plane([0.0, 0.0, -0.3], [0.0, 0.0, 1.0])]}
    together = copies.run(threads=3, **asked).events
    for i in range(11):
        alone = copies[i].run(**asked).events
        of_copy = together.member == i
        assert np.array_equal(together.t[of_copy], alone.t), i
        assert np.array_equal(together.position[of_copy], alone.position), i
        assert len(alone.t) > 0


@pytest.mark.parametrize("method", ["taylor", "verner98", "kahan_li8"])
@pytest.mark.parametrize("softening", [0.0, 0.3])
@pytest.mark.parametrize("count", [6, 7, 8, 9, 15])
def test_any_number_of_bodies_pull_beside_one_that_is_turned(method: str, softening: float, count: int) -> None:
    """More than eight massive ones were not pulled at all: a ball is a point, so its scene is that of points."""
    angle = 2.4 * np.arange(count)
    axis = np.linspace(3.0, 9.0, count)
    places = np.column_stack([axis * np.cos(angle), axis * np.sin(angle), 0.1 * axis])
    speeds = np.column_stack([-np.sin(angle), np.cos(angle), 0.0 * angle]) / np.sqrt(axis)[:, None]
    # The last is massless.
    mass = np.append(np.full(count - 1, 1e-2), 0.0)
    ball = vv.RigidBody(1.0, [0.1, 0.1, 0.1], angular_velocity=[0.3, 0.2, 1.0])
    forces = (vv.Gravity(1.0, softening), vv.AppliedTorque([0.0, 0.0, 1e-9]))
    asked: dict[str, Any] = {"rtol": 1e-12} if method != "kahan_li8" else {"dt": 0.05}
    found = vv.Scene(vv.Particles(mass, places, speeds), ball, *forces).run(t=4.0, method=method, **asked)
    points = vv.Particles([1.0, *mass], [[0.0] * 3, *places], [[0.0] * 3, *speeds])
    exact = vv.Scene(points, forces[0]).run(t=4.0, method="dop853", rtol=1e-13).position[-1]
    # Of tolerances of 1e-12 and of order 8 in steps of a hundredth of the shortest turn.
    np.testing.assert_allclose(found.position[-1], [*exact[1:], exact[0]], rtol=0.0, atol=1e-9)


def test_a_crowd_with_masses_of_its_own_in_each_copy() -> None:
    """Nine planets, 200 massless bodies and a middle that is no sphere: each copy as alone, and as in small steps."""
    random = np.random.default_rng(5)
    turn = 2.0 * np.pi * random.random(209)
    axis = np.concatenate([np.linspace(3.0, 9.0, 9), 4.0 + 8.0 * random.random(200)])
    places = np.column_stack([axis * np.cos(turn), axis * np.sin(turn), 0.1 * random.random(209)])
    speeds = np.column_stack([-np.sin(turn), np.cos(turn), np.zeros(209)]) / np.sqrt(axis)[:, None]
    bodies = vv.Particles(np.concatenate([np.full(9, 1e-3), np.zeros(200)]), places, speeds)
    middle = vv.RigidBody(1.0, [0.1, 0.15, 0.2], angular_velocity=[0.3, 0.2, 1.0])
    scene = vv.Scene(bodies, middle, vv.Gravity(1.0))
    # A rigid body keeps its own.
    masses = np.column_stack([bodies.mass * (1.0 + 0.5 * np.arange(3))[:, None], np.ones(3)])
    copies = scene.ensemble(mass=masses)
    together = copies.run(t=1.0, method="verner98", rtol=1e-11, threads=3)
    for i in range(3):
        alone = copies[i].run(t=1.0, method="verner98", rtol=1e-11, threads=1)
        small = copies[i].run(t=1.0, method="kahan_li8", dt=0.0025)
        for name in ("position", "orientation", "angular_velocity"):
            found = getattr(alone, name)
            assert np.array_equal(found, getattr(together, name)[i]), name
            # Of a tolerance of 1e-11 of each step, in distances of ten.
            assert np.abs(found - getattr(small, name)).max() < 1e-8, name


def test_what_looks_at_velocities_takes_it_by_itself() -> None:
    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[1.0, 2.0, 3.0])
    scene = vv.Scene(body, vv.RotationalDrag(0.1), vv.AppliedTorque([1.0, 0.0, 0.0]))
    chosen, small = scene.run(t=5.0), scene.run(t=5.0, method="rk4", dt=2e-4)
    assert "verner98" in str(chosen.plan)
    # Of the tolerance of 1e-9; measured 9e-11.
    assert np.abs(chosen.orientation[-1] - small.orientation[-1]).max() < 1e-9


def test_a_spin_that_dies_out_and_one_that_begins() -> None:
    """Drag alone: ω = ω₀ exp(−t/I) about a principal axis, and the angle is what it was times I (1 − exp(−t/I))."""
    moment = 2.0
    body = vv.RigidBody(1.0, [1.5, 1.7, moment], angular_velocity=[0.0, 0.0, 3.0])
    out = vv.Scene(body, vv.RotationalDrag(1.0)).run(t=[1.0, 40.0], method="verner98", rtol=1e-10)
    spin = 3.0 * np.exp(-np.array([1.0, 40.0]) / moment)
    np.testing.assert_allclose(out.angular_velocity[:, 0, 2], spin, rtol=0.0, atol=3e-9)
    half = 0.5 * 3.0 * moment * (1.0 - np.exp(-np.array([1.0, 40.0]) / moment))
    turn = 2.0 * np.arctan2(out.orientation[:, 0, 2], out.orientation[:, 0, 3])
    np.testing.assert_allclose(np.sin(turn - 2.0 * half), 0.0, rtol=0.0, atol=2e-9)
    # From rest a constant torque gives t/I: no momentum to be small against at first.
    rest = vv.Scene(vv.RigidBody(1.0, [1.5, 1.7, moment]), vv.AppliedTorque([0.0, 0.0, 1.0]))
    out = rest.run(t=5.0, method="verner98")
    np.testing.assert_allclose(out.angular_velocity[-1, 0], [0.0, 0.0, 5.0 / moment], rtol=0.0, atol=1e-12)
    assert out.stats.steps < 60


def test_steps_are_steered_as_those_of_points() -> None:
    short = top().run(t=0.1, method="verner98", max_step=1e-3)
    assert short.stats.steps >= 100
    loose = top().run(t=0.1, method="verner98", atol=1e-3)
    assert loose.status == vv.Status.OK
    with pytest.raises(vv.InvalidInput, match=r"method: got stormer13.*choose their steps, .*verner98.*with a step"):
        top().run(t=0.1, method="stormer13", dt=0.01)
