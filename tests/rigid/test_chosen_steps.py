"""Bodies that torques turn, run without a method and a step: the steps follow the tolerance."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

DOWN = vv.UniformField([0.0, 0.0, -9.81])
# Of Brüls and Cardona's top at t = 2, to 16 digits (benches/python/rigid_scene.py).
CENTER = [-0.1504168227456418, -0.7241655916368957, -0.6730222695604441]


# Series are chosen for weight and torques along a body's own axes alone (test_series_of_bodies): not beside this.
NONE_IN_SPACE = vv.AppliedTorque([0.0, 0.0, 0.0])


def top(spin: float = 150.0) -> vv.Scene:
    inertia = np.diag([0.234375, 0.46875, 0.234375])
    spins = [0.0, spin, -4.61538]
    body = vv.RigidBody(15.0, inertia=inertia, position=[0, 1, 0], angular_velocity=spins, pivot=[0, -1, 0])
    return vv.Scene(body, DOWN, NONE_IN_SPACE)


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_a_top_is_where_it_should_be(rtol: float) -> None:
    out = top().run(t=2.0, rtol=rtol)
    assert np.abs(out.position[-1, 0] - CENTER).max() < 10 * rtol
    assert out.status == vv.Status.OK
    assert "64 equal parts" in str(out.plan)


def test_outputs_and_backward_runs_are_those_of_small_steps() -> None:
    for end in (2.0, -2.0):
        t = np.linspace(0.0, end, 23)
        chosen, small = top().run(t=t), top().run(t=t, method="kahan_li8", dt=1 / 128)
        # Either is exact to rounding; measured 3e-15.
        assert np.abs(chosen.orientation - small.orientation).max() < 2e-14
        assert np.abs(chosen.velocity - small.velocity).max() < 2e-14


def test_what_looks_at_velocities() -> None:
    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[1.0, 2.0, 3.0])
    scene = vv.Scene(body, vv.RotationalDrag(0.1), vv.AppliedTorque([1.0, 0.0, 0.0]))
    chosen, small = scene.run(t=5.0), scene.run(t=5.0, method="rk4", dt=5e-4)
    # Of the tolerance of 1e-9; measured 5.4e-10.
    assert np.abs(chosen.orientation[-1] - small.orientation[-1]).max() < 3e-9


def test_a_passage_late_in_the_run_is_seen() -> None:
    """What the first stretch does not know of: the steps are chosen again in each part. A sphere on an ellipse of
    eccentricity 0.9 from its far end on, against Kepler's equation."""
    e = 0.9
    place, speed = [1 + e, 0.0, 0.0], [0.0, np.sqrt((1 - e) / (1 + e)), 0.0]
    pull = vv.CentralField(vv.potentials.Coulomb(k=-1.0))
    ball = vv.RigidBody(1.0, [1e-6, 1e-6, 1e-6], position=place, velocity=speed)
    turned = vv.Scene(ball, vv.AppliedTorque([0.0, 0.0, 1e-7]), pull).run(t=10 * np.pi)
    exact = vv.Scene(vv.Particles([1.0], [place], [speed]), pull).run(t=10 * np.pi)
    # The default of rtol, 1e-9, on an ellipse that amplifies it; 2e-10 was seen.
    assert np.abs(turned.position[-1] - exact.position[-1]).max() < 1e-8


def test_a_pendulum_at_rest_and_one_that_swings_long() -> None:
    for turn in ([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]):
        body = vv.RigidBody(1.0, [1.0, 1.0, 0.1], orientation=turn, pivot=[0.0, 0.0, -1.0])
        out = vv.Scene(body, DOWN).run(t=[0.0, 1.0, 300.0])
        assert out.status == vv.Status.OK
        # At rest nothing changes; falling from the side, of an energy of 9.8, measured 8e-11 at a tolerance of 1e-9.
        assert np.abs(out.energy - out.energy[0]).max() < 1e-10


def test_a_copy_is_what_it_is_alone() -> None:
    spins = np.array([[[0.0, 150.0 * (1 + i / 3), -4.6]] for i in range(11)])
    copies = top().ensemble(angular_velocity=spins)
    together = copies.run(t=1.0, threads=2)
    for i in range(11):
        assert np.array_equal(copies[i].run(t=1.0).orientation, together.orientation[i])


def test_copies_of_many_paces_are_what_they_are_alone_however_many_there_are() -> None:
    """Each halves steps of its own, from its own spin on; beyond 32 to a thread, two copies were in one lane."""
    spins = np.random.default_rng(1).normal(size=(40, 1, 3)) * np.logspace(-2.0, 1.0, 40)[:, None, None]
    copies = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 2.0]), vv.AppliedTorque([0.0, 0.0, 0.5])).ensemble(
        angular_velocity=spins
    )
    runs = [copies.run(t=20.0, threads=threads).orientation for threads in (1, 2, 3)]
    alone = np.array([copies[copy].run(t=20.0).orientation for copy in range(40)])
    assert [np.array_equal(run, alone) for run in runs] == [True] * 3


def test_one_that_cannot_be_followed_does_not_end_well() -> None:
    """A spin that no step of the run resolves; the copy beside it is as alone."""
    body = vv.RigidBody(1.0, [1.0, 2.0, 2.5], position=[1.0, 0.0, 0.0])
    scene = vv.Scene(body, vv.AttachedSpring(0, [0.1, 0.2, 0.3], 1.0, anchor=[0.0, 0.0, 0.0]))
    fast = scene.ensemble(angular_velocity=[[[0.0, 0.0, 1.0]], [[1e300, 1.0, 1e300]]]).run(t=1e3)
    assert fast.status[0] == vv.Status.OK
    assert fast.status[1] != vv.Status.OK
    alone = scene.ensemble(angular_velocity=[[[0.0, 0.0, 1.0]]]).run(t=1e3)
    assert np.array_equal(fast.orientation[0], alone.orientation[0])


def test_its_cost_is_not_guessed() -> None:
    assert top().plan(t=2.0).cost() is None


@pytest.mark.parametrize(
    ("moments", "told"),
    [
        ([1.0, 1.0, 2.0], "did not agree to rtol; a larger rtol, a shorter run, or a step dt"),
        ([1.0, 1.5, 2.0], "more than 1e9 steps; a larger rtol, a shorter run, or a step dt or a method of your own"),
    ],
)
def test_turns_without_an_end_are_told_as_that(moments: list[float], told: str) -> None:
    """Over 1e8 turns by chosen steps: not that anything became infinite, nor that an adaptive method may pass."""
    body = vv.RigidBody(1.0, moments, angular_velocity=[0.3, 0.2, 1.0])
    with pytest.raises(vv.ConvergenceError, match=told):
        vv.Scene(body, vv.AppliedTorque([0.0, 0.0, 1e-9])).run([0, 1e9])


def test_one_passage_of_short_steps_is_no_run_without_an_end() -> None:
    """Steps of 1e-10 of the run at the pericenter of an orbit of e = 1 − 1e-5, some of a few hundred in all."""
    pull, e = vv.CentralField(vv.potentials.Coulomb(k=-1.0)), 1 - 1e-5
    speed = [0.0, float(np.sqrt((1 - e) / (1 + e))), 0.0]
    body = vv.RigidBody(
        1.0, [1e-6, 1.2e-6, 1.5e-6], position=[1 + e, 0.0, 0.0], velocity=speed, angular_velocity=[0.0, 0.0, 0.1]
    )
    out = vv.Scene(body, vv.AppliedTorque([0.0, 0.0, 1e-7]), pull).run(t=2 * np.pi)
    assert out.status is vv.Status.OK
    assert out.stats.steps < 1000


TILT = [float(np.sin(0.25)), 0.0, 0.0, float(np.cos(0.25))]
ARM = [0.0, float(-0.5 * np.sin(0.5)), float(0.5 * np.cos(0.5))]


def asymmetric_top() -> vv.Scene:
    body = vv.RigidBody(
        1.0,
        [0.1, 0.13, 0.05],
        pivot=[0.0, 0.0, -0.5],
        orientation=TILT,
        position=ARM,
        angular_velocity=[0.5, 0.0, 30.0],
    )
    return vv.Scene(body, DOWN, NONE_IN_SPACE)


@pytest.mark.parametrize(("t", "bound"), [(10.0, 1e-10), (100.0, 1e-8)])
def test_three_moments_that_differ_take_quaternions_in_steps_held_closer(t: float, bound: float) -> None:
    """Exact turns of such a body are elliptic functions and took ten times as long; against `kahan_li8`.

    Errors of steps, each held to a thousandth of rtol = 1e-9, add up quadratically: 3e-12 and 3e-10 were seen.
    """
    scene = asymmetric_top()
    out = scene.run(t=t)
    assert out.stats.method == "verner98"
    assert "1e-12" in str(scene.plan(t=t))
    exact = scene.run(t=t, method="kahan_li8", dt=0.005).orientation[-1, 0]
    assert np.abs(out.orientation[-1, 0] - exact).max() < bound
    assert np.array_equal(out.orientation, scene.run(t=t, method="verner98", rtol=1e-12).orientation)
    # A tolerance of steps by hand is one of steps.
    steered = scene.run(t=t, rtol=1e-9, atol=1e-9)
    assert np.array_equal(steered.orientation, scene.run(t=t, method="verner98", rtol=1e-9, atol=1e-9).orientation)
    looked = scene.run(t=t, events=[vv.events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])])
    assert np.array_equal(out.orientation, looked.orientation)


@pytest.mark.parametrize(
    ("how", "argument"),
    [
        ({"method": "kahan_li8", "dt": 0.01, "atol": 1e-3}, "atol"),
        ({"method": "kahan_li8", "dt": 0.01, "rtol": 1e-3}, "rtol"),
        ({"dt": 0.01, "max_step": 0.1}, "max_step"),
    ],
)
def test_what_steers_no_equal_steps_is_refused_with_a_way_that_is_taken(how: Any, argument: str) -> None:
    """No time transformation steps bodies that torques turn."""
    with pytest.raises(vv.InvalidInput, match=rf"^{argument}: .*name an adaptive method such as verner98") as told:
        top().run(t=0.1, **how)
    assert "time_transformation" not in str(told.value)
    # The way that is named.
    steered = {name: value for name, value in how.items() if name == argument}
    assert top().run(t=0.1, method="verner98", **steered).status == vv.Status.OK
