"""Equal steps that go over walls, wells and pulses narrower than they are: the run ends before them, by name.

Steps that a method chooses are taken again, shorter ones; of those that were asked for nothing is left but to tell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

PLACE = 50.31
DT = 0.05
#: Of height 5, for bodies whose energy is 1/2, by the distance from their middle in widths.
WALLS: dict[str, Callable[[Any], Any]] = {
    "gauss": lambda u: 5 * np.exp(-(u**2)),
    "step": lambda u: 2.5 * (1 + np.tanh(u)),
    "eighth power": lambda u: 5 / (1 + u**8),
}
METHODS = ("euler", "midpoint", "rk4", "leapfrog", "stormer13")
#: Steps of these look beyond their ends as well.
WANDERING = ("yoshida4", "kahan_li8")
BODIES = vv.Particles([1.0, 2.0], [[0.0, 0, 0], [0.0, 1, 0]], [[1.0, 0, 0], [0.0, 0, 0]])


def wall(name: str, width: float) -> vv.ExpressionForce:
    return vv.ExpressionForce(
        potential=lambda r, v, t, w: WALLS[name]((r[0] - PLACE) / w), parameters={"w": width}, bodies=[0]
    )


def stopped(scene: vv.Scene, **how: Any) -> vv.Trajectory:
    with pytest.raises(vv.ConvergenceError, match=r"narrower than the step.*shorter dt") as error:
        scene.run(100.0, **how)
    assert error.value.trajectory is not None
    return error.value.trajectory


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", WALLS)
def test_a_run_ends_where_a_step_would_pass_over_a_wall(name: str, method: str) -> None:
    for width in (2e-3, 1e-3, 1e-5) if name == "gauss" else (1e-3,):
        out = stopped(vv.Scene(BODIES, wall(name, width)), method=method, dt=DT)
        # At the last node before the wall, to which free flight leads.
        nodes = int(PLACE / DT)
        assert out.final.t0 == pytest.approx(nodes * DT, rel=0.0, abs=1e-12)
        # Of a power there is something left ten widths before its middle.
        felt = 1e-5 if "power" in name else 1e-11
        assert out.final.particles.position[0, 0] == pytest.approx(nodes * DT, rel=0.0, abs=felt)


@pytest.mark.parametrize("method", WANDERING)
@pytest.mark.parametrize("name", WALLS)
def test_what_looks_beyond_its_steps_says_at_least_that_it_does_not_resolve_a_wall(name: str, method: str) -> None:
    for width in (1e-2, 1e-3, 1e-5):
        with pytest.raises((vv.ConvergenceError, vv.AccuracyWarning), match=r"narrower than the step|does not resolve"):
            vv.Scene(BODIES, wall(name, width)).run(100.0, method=method, dt=DT)


@pytest.mark.parametrize("method", ["rk4", "leapfrog"])
def test_and_before_a_pulse_in_time(method: str) -> None:
    pulse = vv.ExpressionForce(force=lambda r, v, t: [np.exp(-(((t - PLACE) / 1e-3) ** 2)), 0, 0])
    out = stopped(vv.Scene(BODIES, pulse), method=method, dt=DT)
    assert out.final.t0 == pytest.approx(int(PLACE / DT) * DT, rel=0.0, abs=1e-12)


def test_outputs_that_a_part_of_such_a_step_leads_to_are_not_kept() -> None:
    scene = vv.Scene(BODIES, wall("gauss", 1e-4))
    times = [10.0, 50.29, 50.3, 50.305, 50.34, 60.0]
    with pytest.raises(vv.ConvergenceError, match="narrower") as error:
        scene.run(times, method="rk4", dt=DT)
    out = error.value.trajectory
    assert out is not None
    # 50.3 is a node, and the step from there passes over it.
    assert out.t.tolist() == times[:3]
    assert np.isfinite(out.position).all()
    # An end between nodes is led to by a part of a step, which is looked into as well.
    with pytest.raises(vv.ConvergenceError, match="narrower"):
        scene.run([10.0, 50.33], method="rk4", dt=DT)
    assert scene.run([10.0, 50.302], method="rk4", dt=DT).t.tolist() == [10.0, 50.302]


@pytest.mark.parametrize("method", ["rk4", "leapfrog"])
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_end_alone_and_the_others_go_on_with_the_bits_that_they_have_alone(method: str, threads: int) -> None:
    # 37 copies, so that lanes, blocks of lanes and chunks are not full.
    widths = np.where(np.arange(37) % 3 == 1, 1e-3, np.linspace(0.5, 1.5, 37))
    force = wall("gauss", 1.0)
    scene = vv.Scene(BODIES, force, vv.UniformField((0.0, 0.01, 0.0)))
    many = scene.ensemble(parameters={force: {"w": widths}})
    out = many.run(np.linspace(0.0, 100.0, 5), method=method, dt=DT, threads=threads)
    for copy in range(37):
        narrow = copy % 3 == 1
        assert (out.status[copy] == vv.Status.STEP_FAILURE) == narrow
        alone = many[copy]
        if narrow:
            with pytest.raises(vv.ConvergenceError) as error:
                alone.run(np.linspace(0.0, 100.0, 5), method=method, dt=DT)
            assert error.value.trajectory is not None
            rows = len(error.value.trajectory.t)
            assert rows == 3
            assert np.isnan(out.position[copy, rows:]).all()
            assert np.array_equal(out.position[copy, :rows], error.value.trajectory.position)
            assert np.array_equal(out[copy].final.particles.position, error.value.trajectory.final.particles.position)
        else:
            one = alone.run(np.linspace(0.0, 100.0, 5), method=method, dt=DT)
            assert np.array_equal(out.position[copy], one.position)


def test_events_before_the_wall_are_kept() -> None:
    scene = vv.Scene(BODIES, wall("gauss", 1e-4))
    plane = vv.events.plane(point=(20.0, 0.0, 0.0), normal=(1.0, 0.0, 0.0), body=0)
    with pytest.raises(vv.ConvergenceError, match="narrower") as error:
        scene.run(100.0, method="leapfrog", dt=DT, events=[plane])
    out = error.value.trajectory
    assert out is not None
    # Free flight of 400 steps from 0, each of which rounds a place by half a digit of 20.
    assert out.events.t.tolist() == pytest.approx([20.0], rel=0.0, abs=1e-11)


@pytest.mark.parametrize("method", [*METHODS, *WANDERING])
def test_steps_that_see_a_wall_go_on_to_the_end(method: str) -> None:
    # Forty steps of 0.05 through a wall of width 1.
    out = vv.Scene(BODIES, wall("gauss", 1.0)).run(100.0, method=method, dt=0.002 if method == "euler" else DT)
    assert out.position[-1, 0, 0] < PLACE
    # Of the first order 0.002 times the force of 1.5 for ten times its time; of the others a thousandth is lost.
    lost = 0.1 if method == "euler" else 3e-3
    assert out.velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=lost)


@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # the slow ones see the wall, and coarsely
def test_a_copy_ends_where_it_ends_alone_whatever_is_beside_it() -> None:
    # Kicked to a thousandfold speed towards a wall that slow steps see, some in lanes beside copies at rest.
    kicked = vv.ExpressionForce(
        acceleration=lambda r, v, t, kick: (kick * np.exp(-(((t - 3.03) / 0.06) ** 2)), 0.0 * t, 0.0 * t),
        parameters={"kick": 0.0},
    )
    body = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[0.01, 0.0, 0.0]])
    narrow = vv.ExpressionForce(potential=lambda r, v, t: 1e4 * np.exp(-(((r[0] - 3.0) / 0.02) ** 2)))
    scene = vv.Scene(body, kicked, narrow)
    kicks = np.array([0.0, 60.0, 0.0, 100.0, 10.0, 0.0, 30.0])
    many = scene.ensemble(parameters={kicked: {"kick": kicks}})
    how = {"method": "rk4", "dt": 0.02}
    out = many.run(6.0, **how)
    plane = vv.events.plane(point=(1.0, 0.0, 0.0), normal=(1.0, 0.0, 0.0))
    watched = many.run(6.0, events=[plane], **how)
    assert set(out.status.tolist()) == {vv.Status.OK, vv.Status.STEP_FAILURE}
    for copy in range(len(kicks)):
        try:
            alone = many[copy].run(6.0, **how)
        except vv.ConvergenceError as error:
            alone = error.trajectory
        assert alone is not None
        assert alone.status == out.status[copy] == watched.status[copy]
        assert alone.final.t0 == out[copy].final.t0 == watched[copy].final.t0
        assert alone.stats.steps == out[copy].stats.steps


def test_a_run_that_goes_on_ends_where_one_run_ends() -> None:
    scene = vv.Scene(BODIES, wall("gauss", 1e-3))
    whole = stopped(scene, method="leapfrog", dt=DT)
    rest = stopped(scene.run(40.0, method="leapfrog", dt=DT).final, method="leapfrog", dt=DT)
    assert rest.final.t0 == whole.final.t0
    assert np.array_equal(rest.final.particles.position, whole.final.particles.position)


PULSES: dict[str, Callable[[Any], Any]] = {
    "gauss": lambda t: np.exp(-((t - 30.0) ** 2)),
    "laser": lambda t: np.exp(-(((t - 30.0) / 2.0) ** 2)) * np.cos(3.0 * t),
    "switch": lambda t: 1.0 + np.tanh(t - 30.0),
}


@pytest.mark.parametrize("dt", [0.05, 0.25, 0.4])
@pytest.mark.parametrize("method", ["leapfrog", "yoshida4", "rk4", "kahan_li8"])
@pytest.mark.parametrize("pulse", PULSES)
@pytest.mark.parametrize("start", [0.0, 1e-12, 1.0])
def test_far_ends_of_a_pulse_that_steps_see_are_not_unseen(pulse: str, method: str, dt: float, start: float) -> None:
    # At rest, where every push is much beside what is there: e⁻⁹⁰⁰ at first, and steps of a fraction of its width.
    body = vv.Particles([1.0], [[start, 0.0, 0.0]], [[0.0, 0.0, 0.0]])
    force = vv.ExpressionForce(acceleration=lambda r, v, t: (PULSES[pulse](t), 0.0 * t, 0.0 * t))
    scene = vv.Scene(body, force)
    exact = scene.run(40.0, method="dop853", rtol=1e-11)
    out = scene.run(40.0, method=method, dt=dt)
    # Of the second order, for ten widths: (dt)² of what it gives is more than any of these loses.
    assert out.velocity[-1, 0, 0] == pytest.approx(exact.velocity[-1, 0, 0], rel=dt * dt, abs=0.1 * dt * dt)


def test_a_pole_is_told_by_what_it_does_and_not_as_unseen() -> None:
    # Head-on through 1/r¹², of which a step on either side feels hardly anything.
    body = vv.Particles([1.0], [[-1.01, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    scene = vv.Scene(body, vv.ExpressionForce(potential=lambda r, v, t: 1e-9 / r[0] ** 12))
    with pytest.warns(vv.AccuracyWarning):
        out = scene.run(2.0, method="rk4", dt=0.1)
    assert out.status == vv.Status.OK


@pytest.mark.parametrize("method", ["leapfrog", "rk4"])
def test_rigid_bodies_end_before_a_wall_as_points_do(method: str) -> None:
    body = vv.RigidBody(
        mass=1.0, moments=[1.0, 2.0, 3.0], position=[0.0] * 3, velocity=[1.0, 0, 0], angular_velocity=[0.3, 0.2, 0.1]
    )
    narrow = vv.ExpressionForce(potential=lambda r, v, t: WALLS["gauss"]((r[0] - PLACE) / 1e-3))
    out = stopped(vv.Scene([body], narrow, vv.AppliedTorque([0.0, 0.0, 0.01], body=0)), method=method, dt=DT)
    assert out.final.t0 == pytest.approx(int(PLACE / DT) * DT, rel=0.0, abs=1e-12)


def test_steps_of_a_transformed_time_cannot_be_shorter_either() -> None:
    body = vv.Particles([1.0], [[0.3, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    pull = vv.CentralField(vv.potentials.Plummer(1e-2, 0.5))
    narrow = vv.ExpressionForce(potential=lambda r, v, t: WALLS["gauss"]((r[0] - PLACE) / 1e-3))
    how = {"method": "leapfrog", "dt": 0.02, "time_transformation": "distance"}
    out = stopped(vv.Scene(body, pull, narrow), **how)
    assert PLACE - 10.0 < out.final.particles.position[0, 0] < PLACE
    without = vv.Scene(body, pull).run(100.0, **how)
    assert without.position[-1, 0, 0] > 80.0


def test_spheres_that_may_touch_end_before_a_wall() -> None:
    spheres = vv.Particles([1.0, 1.0], [[0.0, 0, 0], [20.0, 0, 0]], [[1.0, 0, 0], [0.0, 0, 0]], radius=[0.5, 0.5])
    narrow = vv.ExpressionForce(potential=lambda r, v, t: WALLS["gauss"]((r[0] - PLACE) / 1e-3))
    # The first gives all of its velocity to the second, which goes on 1 ahead of where the first would be.
    out = stopped(vv.Scene(spheres, narrow), method="leapfrog", dt=DT, collisions="bounce", restitution=1.0)
    # The last node before the wall is no farther from it than a step.
    assert out.final.particles.position[:, 0] == pytest.approx([19.0, PLACE], rel=0.0, abs=DT)
    assert out.final.particles.position[1, 0] < PLACE


@pytest.mark.parametrize("off", [-0.6, -0.2, 0.0, 0.1, 0.5])
@pytest.mark.parametrize("method", ["rk4", "leapfrog"])
@pytest.mark.parametrize("width", [1e-3, 1e-4])
def test_a_wall_whose_top_is_at_a_node_is_told(width: float, method: str, off: float) -> None:
    # There the force is nothing, and of the function a look sees all.
    top = vv.ExpressionForce(potential=lambda r, v, t: WALLS["gauss"]((r[0] - 5.3) / width - off), bodies=[0])
    with pytest.raises((vv.ConvergenceError, vv.AccuracyWarning), match=r"narrower than the step|does not resolve"):
        vv.Scene(BODIES, top).run(10.0, method=method, dt=DT)
