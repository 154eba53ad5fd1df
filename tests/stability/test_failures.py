"""What fails, fails with everything it knows, and fails alone."""

import numpy as np
import pytest

import visviva as vv

# Two bodies of mass 1 at rest, 2 apart, meet after (π/2) √(d³ / 2GM) = π/√2.
COLLISION = np.pi / np.sqrt(2.0)
TIMES = np.linspace(0.0, 3.0, 31)


def colliding(extra: bool = False) -> vv.Scene:
    mass, position = [1.0, 1.0], [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
    if extra:
        mass, position = [0.0, 1.0, 1.0], [[0.0, 50.0, 3.0], *position]
    return vv.Scene(vv.Particles(mass, position, np.zeros((len(mass), 3))), vv.Gravity(1.0))


@pytest.mark.parametrize("extra", [False, True])
def test_a_close_encounter_carries_all_it_knows(extra: bool) -> None:
    with pytest.raises(vv.CloseEncounter) as caught:
        colliding(extra).run(t=TIMES, method="dop853", rtol=1e-10)
    error = caught.value
    # Of a relative tolerance of 1e-10 the time of the fall is off by about as much (measured 1.8e-11). Steps end where
    # they are below the spacing of times, 4e-16: measured at a distance of 1.1e-9.
    assert error.time == pytest.approx(COLLISION, abs=1e-10)
    assert error.bodies == ((1, 2) if extra else (0, 1))
    assert 0.0 < error.distance < 1e-8
    kept = error.trajectory
    assert kept.t[-1] == pytest.approx(2.2)
    assert np.array_equal(kept.t, TIMES[: len(kept.t)])
    # Distance at t from the closed form of the same fall.
    exact = colliding(extra).run(t=kept.t) if not extra else colliding().run(t=kept.t)
    assert np.abs(kept.position[:, -2:] - exact.position).max() < 1e-7


def test_a_close_encounter_backwards() -> None:
    with pytest.raises(vv.CloseEncounter) as caught:
        colliding().run(t=-TIMES, method="dop853", rtol=1e-10)
    # As forwards, to the bit: 1.8e-11.
    assert caught.value.time == pytest.approx(-COLLISION, abs=1e-10)


def test_a_fixed_center_is_met_by_one_body() -> None:
    scene = vv.Scene(
        vv.Particles([1.0, 1.0], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=5.0)),
    )
    with pytest.raises(vv.CloseEncounter) as caught:
        scene.run(t=5.0, method="dop853", rtol=1e-10)
    assert caught.value.bodies == (0, 0)
    # Where steps are below the spacing of times; measured 6e-10.
    assert 0.0 < caught.value.distance < 1e-8


@pytest.mark.parametrize("bad", [0, 4, 10])
@pytest.mark.parametrize("threads", [1, 2])
def test_one_colliding_copy_spoils_no_other(bad: int, threads: int) -> None:
    velocity = np.zeros((11, 2, 3))
    velocity[:, 0, 1] = 0.3 + 0.001 * np.arange(11)
    velocity[:, 1] = -velocity[:, 0]
    velocity[bad] = 0.0
    scene = colliding()
    out = scene.ensemble(velocity=velocity).run(t=TIMES, method="dop853", rtol=1e-10, threads=threads)
    assert np.flatnonzero(out.status).tolist() == [bad]
    for index in range(11):
        if index == bad:
            continue
        alone = scene.with_state(scene.particles.position, velocity[index]).run(t=TIMES, method="dop853", rtol=1e-10)
        assert np.array_equal(out.position[index], alone.position)
        assert np.array_equal(out.velocity[index], alone.velocity)
        assert out.per_trajectory["steps"][index] == alone.stats.steps
        assert out.per_trajectory["evaluations"][index] == alone.stats.evaluations
    # Until it failed it is like the lone run, and from there NaN.
    with pytest.raises(vv.CloseEncounter) as caught:
        scene.run(t=TIMES, method="dop853", rtol=1e-10)
    kept = caught.value.trajectory
    assert np.array_equal(out.position[bad, : len(kept.t)], kept.position)
    assert np.isnan(out.position[bad, len(kept.t) :]).all()
    assert np.isnan(out.velocity[bad, len(kept.t) :]).all()


def test_too_few_steps_keep_what_was_done() -> None:
    with pytest.raises(vv.ConvergenceError) as caught:
        vv.problems.pleiades().scene.run(t=np.linspace(0, 3, 31), method="dop853", rtol=1e-10, max_steps=50)
    error = caught.value
    assert error.time is not None
    assert 0.0 < error.time < 3.0
    assert error.trajectory.t[-1] <= error.time


def test_after_an_encounter_the_final_scene_is_of_one_time() -> None:
    """A massless body falls into the star; the planet, which went on to the end, is taken back to that time."""
    stars = vv.Particles([1.0, 1e-3], [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.45, 0.0]])
    falling = vv.Particles(
        [1.0, 1e-3, 0.0], [*stars.position.tolist(), [1.0, 0.0, 0.0]], [*stars.velocity.tolist(), [0.0, 0.0, 0.0]]
    )
    for record in (("position", "velocity"), ("energy",)):
        with pytest.raises(vv.CloseEncounter) as caught:
            vv.Scene(falling, vv.Gravity(1.0)).run(t=3.0, method="dop853", record=record)
        final = caught.value.trajectory.final
        # The fall from rest at distance 1 onto mass 1 takes π/√8; the planet pulls a little.
        assert final.t0 == caught.value.time == pytest.approx(np.pi / np.sqrt(8.0), abs=1e-4)
        alone = vv.Scene(stars, vv.Gravity(1.0)).run(t=final.t0, method="dop853").final
        assert np.array_equal(final.particles.position[:2], alone.particles.position)
        assert np.array_equal(final.particles.velocity[:2], alone.particles.velocity)


def test_after_an_encounter_bodies_that_do_not_interact_are_of_one_time() -> None:
    """One of three falls into the center, the others circle: they are where a run to that time finds them."""
    field = vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=5.0))
    x, v = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.6, 0.0], [0.5, 0.0, 0.0]]
    with pytest.raises(vv.CloseEncounter) as caught:
        vv.Scene(vv.Particles([1.0, 1.0, 1.0], x, v), field).run(t=5.0, method="dop853")
    final = caught.value.trajectory.final
    assert final.t0 == caught.value.time < 2.0
    others = vv.Scene(vv.Particles([1.0, 1.0], x[1:], v[1:]), field).run(t=final.t0, method="dop853")
    assert np.array_equal(final.particles.position[1:], others.position[-1])


def test_a_final_scene_of_fixed_steps_is_the_last_that_is_finite() -> None:
    """One of two bodies meets the center to the bit and is no number from then on."""
    field = vv.CentralField(vv.potentials.Coulomb(-1.0))
    particles = vv.Particles([1.0, 1.0], [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], [[-1.0, 0.0, 0.0], [0.0, 0.7, 0.0]])
    scene = vv.Scene(particles, field)
    # A first kick of half a step of 2 makes the speed -2; the drift then ends at -3, through the center; a speed of 0.5
    # before it ends in the center itself.
    scene = scene.with_state(particles.position, [[0.5, 0.0, 0.0], [0.0, 0.7, 0.0]], 0.0)
    for record in (("position", "velocity"), ("position",)):
        with pytest.raises(vv.ConvergenceError) as caught:
            scene.run(t=np.linspace(0.0, 8.0, 9), method="leapfrog", dt=2.0, record=record)
        final = caught.value.trajectory.final
        assert final.t0 == caught.value.time == caught.value.trajectory.t[-1]
        assert np.isfinite(final.particles.position).all()
        assert np.array_equal(final.particles.position, caught.value.trajectory.position[-1])
