"""Runs with collisions beside all else: copies, files, events, outputs, runs that go on, what is refused.

Bounds: times and places of contact to some roundings of the largest number, 1e-14.
"""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from colliding import crowd, each_method, head_on, how, spheres

import visviva as vv

if TYPE_CHECKING:
    from pathlib import Path

EPSILON = float(np.finfo(float).eps)


def test_what_mergers_leave_goes_on() -> None:
    random = np.random.default_rng(7)
    x = np.array([[i % 3, (i // 3) % 3, 0.0] for i in range(9)])
    scene = spheres(random.uniform(0.5, 1.5, 9), x, 0.6 * random.normal(size=(9, 3)), 0.2, vv.Gravity(G=1.0))
    first = scene.run(0.7, collisions="merge")
    left = first.final
    gone = left.particles.mass == 0.0
    assert 0 < gone.sum() < 8
    few = vv.Scene(left.particles[~gone], *left.forces, t0=left.t0)
    assert left.invariants().energy == few.invariants().energy
    assert np.array_equal(left.acceleration()[~gone], few.acceleration())
    times = [0.7, 0.9, 1.2]
    on, alone = left.run(times, collisions="merge", rtol=1e-12), few.run(times, collisions="merge", rtol=1e-12)
    assert np.array_equal(on.position[:, ~gone], alone.position)
    assert np.array_equal(on.energy, alone.energy)
    assert on.conservation().momentum.max < 1e-14
    # Whatever spheres do from here on, what was absorbed goes with its host.
    for rule in ("stop", "bounce"):
        on, alone = (start.run(times, collisions=rule, rtol=1e-12) for start in (left, few))
        assert np.array_equal(on.position[:, ~gone], alone.position)
        assert on.status == alone.status
    with pytest.raises(vv.InvalidInput, match=r"is a part of body .* run on with collisions="):
        left.run(1.0)


def test_what_is_a_part_of_another_has_no_energy_of_its_own() -> None:
    """As files of before mergers beside such forces were refused have it."""
    left = vv.Particles([2.0, 0.0, 1.0], [[1, 0, 0], [1, 0, 0], [3, 0, 0]], [[0, 1, 0]] * 3, radius=[0.5, 0.0, 0.5])
    few = left[[0, 2]]
    for force in (vv.Harmonic(1.0), vv.PairPotential(vv.potentials.Morse(1.0, 1.0, 1.5)), vv.Gravity(1.0)):
        found, wanted = vv.Scene(left, force).invariants(), vv.Scene(few, force).invariants()
        assert found.energy == wanted.energy
        assert found.potential_energy == wanted.potential_energy
        np.testing.assert_array_equal(found.torque, wanted.torque)


def test_elements_know_what_has_merged() -> None:
    # A comet falls into the star, and two planets meet.
    places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.2, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, -0.5, 0.0]]
    velocities = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-2.0, 0.9, 0.0], [-0.57, 0.0, 0.0], [0.0, 0.0, 0.0]]
    bodies = vv.Particles([1.0, 1e-3, 2e-3, 1e-3, 1e-6], places, velocities, radius=[0.1, 0.02, 0.02, 0.02, 0.0])
    scene = vv.Scene(bodies, vv.Gravity(G=1.0))
    out = scene.run([0.0, 0.01, 0.5, 1.0], collisions="merge", rtol=1e-12)
    assert set(zip(out.collisions.first.tolist(), out.collisions.second.tolist(), strict=True)) == {(1, 2), (0, 4)}
    found = out.elements()
    assert np.isfinite(found.eccentricity[:2]).all()
    # Bodies 1 and 4 are parts of others from the third row on; body 3 goes on about what the star has become.
    assert np.isnan(found.eccentricity[2:]).tolist() == [[True, False, False, True]] * 2
    assert found.mu[:, 2].tolist() == [1.001, 1.001, 1.0 + 1e-6 + 1e-3, 1.0 + 1e-6 + 1e-3]
    there = [0, 2, 3]
    left = vv.Scene(out.final.particles[there], *scene.forces, t0=1.0)
    alone = left.elements()
    for name in ("semi_major_axis", "eccentricity", "true_anomaly", "mu"):
        assert getattr(found, name)[-1, [1, 2]].tolist() == getattr(alone, name).tolist(), name
        assert np.array_equal(getattr(out.final.elements(), name), getattr(found, name)[-1], equal_nan=True)
    for about in ("center_of_mass", "jacobi"):
        own = out.elements([2, 3], about=about).eccentricity[-1]
        assert own == pytest.approx(left.elements([1, 2], about=about).eccentricity, rel=1e-13, abs=0)
    with pytest.raises(vv.InvalidInput, match="expected a body by itself"):
        out.elements(3, about=1)
    copies = scene.ensemble(position=np.stack([bodies.position] * 2)).run(out.t, collisions="merge", rtol=1e-12)
    assert np.array_equal(copies.elements().eccentricity[1], found.eccentricity, equal_nan=True)


@pytest.mark.parametrize("rule", ["bounce", "merge"])
@pytest.mark.parametrize("options", [{"method": "kahan_li8", "dt": 0.0625}, {"method": "stormer13", "dt": 0.03125}])
def test_a_run_goes_on_to_the_bits_of_one(rule: str, options: dict[str, Any]) -> None:
    scene = crowd(9, 5, radius=0.2, rule=rule)
    first = scene.run(1.0, collisions=rule, **options)
    assert len(first.collisions) > 0
    # A node after the last collision: there the run can be cut.
    cut = float(first.collisions.t[-1] + 8 * options["dt"])
    long = scene.run([cut, 3.0], collisions=rule, **options)
    half = scene.run(cut, collisions=rule, **options)
    rest = half.final.run(3.0, collisions=rule, **options)
    assert len(half.collisions) + len(rest.collisions) == len(long.collisions) > len(half.collisions)
    assert np.array_equal(rest.position[-1], long.position[-1])
    assert np.array_equal(rest.final.particles.mass, long.final.particles.mass)


@pytest.mark.parametrize("rule", ["bounce", "merge", "stop"])
@each_method
def test_copies_have_the_bits_that_they_have_alone(rule: str, method: str) -> None:
    scene = crowd(9, 5, rule=rule)
    random = np.random.default_rng(1)
    starts = scene.particles.position + 0.02 * random.normal(size=(7, 9, 3))
    radii = np.full((7, 9), 0.35) * random.uniform(0.5, 1.0, (7, 1))
    radii[2] = 0.0
    copies = scene.ensemble(position=starts, radius=radii)
    times = np.linspace(0.0, 2.0, 5)
    options = {"collisions": rule, **how(method)}
    one, three = (copies.run(times, threads=threads, **options) for threads in (1, 3))
    assert np.array_equal(one.position, three.position, equal_nan=True)
    for index in range(7):
        alone = copies[index].run(times, **options)
        rows = len(alone.t)
        assert np.array_equal(alone.position, one.position[index, :rows])
        assert np.isnan(one.position[index, rows:]).all()
        mine = one[index]
        for name in ("t", "first", "second", "speed", "survivor", "energy_lost"):
            assert np.array_equal(getattr(alone.collisions, name), getattr(mine.collisions, name))
        assert np.array_equal(mine.final.particles.mass, alone.final.particles.mass)
        assert np.array_equal(mine.final.particles.radius, alone.final.particles.radius)
        assert mine.stats.steps == alone.stats.steps
    assert (one.collisions.member != 2).all()


@pytest.mark.parametrize("rule", ["bounce", "merge", "stop"])
def test_results_are_kept(rule: str, tmp_path: Path) -> None:
    scene = crowd(9, 5, rule=rule)
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None])
    for run in (scene.run(1.0, collisions=rule), copies.run(1.0, collisions=rule)):
        path = tmp_path / "run.npz"
        run.save(path)
        for again in (vv.load(path), pickle.loads(pickle.dumps(run))):
            for name in ("t", "first", "second", "speed", "position", "energy_lost", "survivor", "member"):
                assert np.array_equal(getattr(again.collisions, name), getattr(run.collisions, name))
            assert again._start._keywords["radius"].tolist() == run._start._keywords["radius"].tolist()
            assert np.array_equal(again.energy, run.energy, equal_nan=True)
    assert pickle.loads(pickle.dumps(copies)).radius.tolist() == copies.radius.tolist()


def test_outputs_do_not_steer() -> None:
    scene = crowd(9, 5)
    for options in ({}, {"method": "leapfrog", "dt": 0.03}):
        few = scene.run([0.0, 2.0], collisions="bounce", **options)
        many = scene.run(np.linspace(0.0, 2.0, 501), collisions="bounce", **options)
        assert np.array_equal(few.position[-1], many.position[-1])
        assert few.collisions.t.tolist() == many.collisions.t.tolist()


@pytest.mark.parametrize("rule", ["bounce", "merge"])
def test_events_beside_collisions(rule: str) -> None:
    def half(t: float, position: Any, velocity: Any) -> float:
        assert position.shape == velocity.shape == (2, 3)
        return float(position[0, 0] + 1.5)

    scene = head_on(1.0, 3.0)
    plane = vv.events.plane([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], body=0)
    out = scene.run(4.0, collisions=rule, events=[vv.events.distance(0, 1, below=2.0), plane, half])
    # After the bounce body 0 goes back at speed 2, after the merger at 1/2.
    speed, at = (2.0, -0.375) if rule == "bounce" else (0.5, 0.1875)
    assert out.events.of(1).t == pytest.approx([1.0, 1.625 + (1.0 + at) / speed], rel=1e-13, abs=0)
    # Only what comes near counts, not what parts.
    assert out.events.of(0).t == pytest.approx([1.0], rel=1e-13, abs=0)
    last = scene.run(5.0, collisions=rule, events=[vv.events.plane([-1.0, 0, 0], [1.0, 0, 0], body=0, terminal=2)])
    assert last.status is vv.Status.STOPPED
    assert last.final.t0 == pytest.approx(1.625 + (1.0 + at) / speed, rel=1e-13, abs=0)


def test_without_spheres_nothing_is_looked_for() -> None:
    scene = vv.problems.pleiades().scene
    plain = scene.run([0.0, 1.0], record=["position", "energy"])
    points = scene.ensemble(radius=np.zeros((1, 7)))[0]
    for options in ({"collisions": "bounce"}, {"collisions": "merge"}):
        with pytest.raises(vv.InvalidInput, match=r"^collisions: expected bodies with a radius"):
            scene.run([0.0, 1.0], **options)
        out = points.run([0.0, 1.0], record=["position", "energy"], **options)
        assert np.array_equal(out.position, plain.position)
        assert len(out.collisions) == 0
        assert "no two bodies can touch" in str(out.plan)
    bigger = vv.Scene(scene.particles._changed(radius=np.full(7, 1e-9)), *scene.forces)
    assert np.array_equal(bigger.run([0.0, 1.0]).position, plain.position)
    assert "pass through each other" in str(bigger.plan(1.0))
    assert "spheres that touch" in str(bigger.plan(1.0, collisions="stop"))
    with pytest.raises(vv.InvalidInput, match="collisions"):
        _ = plain.collisions


def test_stopped_spheres_go_on_with_a_bounce() -> None:
    stopped = head_on(1.0, 3.0).run(4.0, collisions="stop")
    assert stopped.status is vv.Status.STOPPED
    assert stopped.t.tolist() == [0.0, 1.625]
    again = stopped.final.run(4.0, collisions="stop")
    assert again.status is vv.Status.STOPPED
    assert again.final.t0 == stopped.final.t0
    on = stopped.final.run(4.0, collisions="bounce")
    once = head_on(1.0, 3.0).run(4.0, collisions="bounce")
    assert np.allclose(on.position[-1], once.position[-1], rtol=0.0, atol=1e-14)
    assert on.velocity[0, :, 0].tolist() == [1.0, -1.0], "the row of the start is as it was given"


def test_steps_are_counted_over_all_legs() -> None:
    scene = head_on(1.0, 3.0)
    out = scene.run(4.0, collisions="bounce", method="leapfrog", dt=0.01)
    assert out.stats.steps == 162 + 1 + 237
    with pytest.raises(vv.ConvergenceError, match="max_steps") as caught:
        scene.run(4.0, collisions="bounce", method="leapfrog", dt=0.01, max_steps=300)
    assert caught.value.trajectory.stats.steps == 300
    assert len(caught.value.trajectory.collisions) == 1


def test_what_has_no_meaning_is_refused() -> None:
    bodies = vv.Particles([1, 1], [[0, 0, 0], [1, 0, 0]], radius=0.1)
    scene = vv.Scene(bodies)
    overlap = vv.Scene(vv.Particles([1, 1], [[0, 0, 0], [1, 0, 0]], radius=0.75))
    for of, options, words in (
        (scene, {"collisions": "merge", "t": -1.0}, "cannot be undone"),
        (scene, {"collisions": "bounce", "restitution": 0.5, "t": -1.0}, "does not come back"),
        (scene, {"collisions": "bounce", "restitution": 1.5}, "from 0 to 1"),
        (scene, {"collisions": "bounce", "restitution": float("nan")}, "restitution: expected finite"),
        (scene, {"collisions": "stop", "restitution": 1.0}, "restitution: expected None"),
        (scene, {"restitution": 1.0}, "restitution: expected None"),
        (scene, {"collisions": "bonce"}, "did you mean 'bounce'"),
        (scene, {"collisions": 1}, "collisions: expected one of merge, bounce, stop, got 1"),
        (overlap, {"collisions": "bounce"}, "bodies 0 and 1 overlap by 0.5 at the start"),
        (overlap, {"collisions": "stop"}, "bodies 0 and 1 overlap"),
        (vv.Scene(bodies, vv.QuadraticDrag([1.0, 2.0])), {"collisions": "merge"}, "QuadraticDrag"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            of.run(**{"t": 1.0, **options})
    for radius in (-1.0, [0.1], [0.1, float("inf")], "large", [[0.1, 0.1]]):
        with pytest.raises(vv.InvalidInput, match="radius"):
            vv.Particles([1, 1], [[0, 0, 0], [1, 0, 0]], radius=radius)  # type: ignore[arg-type]
    assert overlap.run(1.0).status is vv.Status.OK, "they pass through each other"


def test_forces_that_name_bodies_go_with_bounces() -> None:
    bodies = vv.Particles([1.0, 1.0], [[-2, 0, 0], [2, 0, 0]], radius=1.0)
    out = vv.Scene(bodies, vv.Spring(0, 1, k=0.5, length=3.0)).run([0.0, 10.0], collisions="bounce", rtol=1e-12)
    # Relative motion is 3 + cos(t); it reaches 2 at rest: a graze each time.
    assert out.energy[-1] == pytest.approx(out.energy[0], rel=1e-10, abs=0)
    bodies = vv.Particles([1.0, 1.0], [[-2, 0, 0], [2, 0, 0]], radius=1.25)
    out = vv.Scene(bodies, vv.Spring(0, 1, k=0.5, length=3.0)).run([0.0, 10.0], collisions="bounce", rtol=1e-12)
    first = float(np.arccos(-0.5))
    assert np.allclose(out.collisions.t, first * np.array([1.0, 3.0]), rtol=0.0, atol=1e-10)


def test_radii_go_with_their_bodies() -> None:
    bodies = vv.Particles([1, 2, 3], np.eye(3), radius=[0.1, 0.2, 0.3], names=["a", "b", "c"])
    assert bodies[["c", "a"]].radius.tolist() == [0.3, 0.1]
    assert bodies.rescaled(length=10.0).radius.tolist() == [1.0, 2.0, 3.0]
    assert vv.Particles([1, 2], np.eye(3)[:2], radius=0.5).radius.tolist() == [0.5, 0.5]
    assert bodies != vv.Particles([1, 2, 3], np.eye(3), names=["a", "b", "c"])
    assert pickle.loads(pickle.dumps(bodies)) == bodies
    assert hash(pickle.loads(pickle.dumps(bodies))) == hash(bodies)
    moved = vv.Scene(bodies).with_state(2 * np.eye(3), np.zeros((3, 3)))
    assert moved.particles.radius.tolist() == [0.1, 0.2, 0.3]
    assert not bodies.radius.flags.writeable
    star = vv.Particles([1.0], [[0, 0, 0]], radius=0.005)
    both = vv.Particles.from_elements(star, [0.0, 1e-6], G=1.0, semi_major_axis=[1.0, 2.0], radius=[0.0, 1e-4])
    assert both.radius.tolist() == [0.005, 0.0, 1e-4]


@each_method
@pytest.mark.parametrize("t0", [1e9, -1e9, 1e12])
def test_far_from_the_time_zero_bounces_lose_nothing(method: str, t0: float) -> None:
    """A time of 1e9 tells no more than 1e-7: what comes after a bounce goes on from where it was, not from there."""
    places, speeds = (
        [[-1.5, 0, 0], [0, 0, 0], [0.5, 0, 0], [1.5, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [-0.7, 0, 0], [0, 0, 0]],
    )
    here = spheres([1e6, 1.0, 2.0, 1e6], places, speeds, 0.125, vv.UniformField((0, -0.5, 0)))
    times = np.array([0.0, 2.5, 5.0, 9.0, 10.0])
    there = vv.Scene(here.particles, *here.forces, t0=t0)
    near, far = (
        scene.run(scene.t0 + times, collisions="bounce", record=("position", "velocity", "energy"), **how(method))
        for scene in (here, there)
    )
    assert len(near.collisions) == len(far.collisions) > 8
    # A dozen bounces, each of which takes the rounding of the one before some times over.
    for name in ("position", "velocity", "energy"):
        assert np.allclose(getattr(far, name), getattr(near, name), rtol=1e-11, atol=1e-11), name
    assert np.allclose(far.collisions.t - t0, near.collisions.t, rtol=0.0, atol=abs(t0) * EPSILON)


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_far_from_the_time_zero_have_their_own_masses(threads: int) -> None:
    """Nine balls in a row and nine copies, each as alone, and as at zero but for a rounding of each bounce."""
    masses = np.random.default_rng(3).uniform(0.5, 2.0, (9, 9))
    x = np.zeros((9, 3))
    x[:, 0] = np.arange(9.0)
    v = np.zeros((9, 3))
    v[:, 0] = np.random.default_rng(4).normal(size=9)
    here = spheres(masses[0], x, v, 0.25)
    there = vv.Scene(here.particles, t0=1e9)
    times = np.array([0.5, 1.0, 2.0])
    near = here.ensemble(mass=masses).run(times, collisions="bounce", threads=threads)
    far = there.ensemble(mass=masses).run(1e9 + times, collisions="bounce", threads=threads)
    assert len(near.collisions) == len(far.collisions) > 40
    assert np.allclose(far.position, near.position, rtol=0.0, atol=1e-12)
    for copy in (0, 8):
        alone = vv.Scene(vv.Particles(masses[copy], x, v, radius=0.25), t0=1e9).run(1e9 + times, collisions="bounce")
        assert np.array_equal(alone.position, far.position[copy])


def test_what_merges_far_from_the_time_zero_goes_on_from_there() -> None:
    """The one that is left moves freely, by its closed form, from the instant of the contact."""
    here = spheres([1.0, 3.0], [[-2, 0, 0], [2, 0, 0]], [[1.0, 0.3, 0], [-0.7, 0, 0]], [0.5, 0.25])
    near = here.run([1.0, 3.0, 8.0], collisions="merge")
    far = vv.Scene(here.particles, t0=1e9).run(1e9 + np.array([1.0, 3.0, 8.0]), collisions="merge")
    assert len(near.collisions) == 1
    assert np.allclose(far.position, near.position, rtol=0.0, atol=1e-14)
