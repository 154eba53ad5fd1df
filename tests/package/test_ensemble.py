"""Ensembles as Python sees them: shapes, indexing, refusals."""

import pickle

import numpy as np
import pytest

import visviva as vv

PROBLEM = vv.problems.figure_eight()
SCENE = PROBLEM.scene
STARTS = SCENE.particles.position + 1e-3 * np.random.default_rng(1).normal(size=(5, 3, 3))


def test_shapes_and_members() -> None:
    out = SCENE.ensemble(position=STARTS).run(t=[0.0, 0.5, 1.0], record=("position", "velocity", "energy"))
    assert len(out) == 5
    assert out.position.shape == (5, 3, 3, 3)
    assert out.energy.shape == (5, 3)
    assert out.momentum.shape == out.angular_momentum.shape == out.center_of_mass.shape == (5, 3, 3)
    assert out.status.tolist() == [0] * 5
    for index, member in enumerate(out):
        assert isinstance(member, vv.Trajectory)
        assert np.array_equal(member.position, out.position[index])
        assert np.array_equal(member.momentum, out.momentum[index])
        assert np.array_equal(member.scene.particles.position, STARTS[index])
        assert member.stats.steps == out.per_trajectory["steps"][index]
    assert np.array_equal(out[-1].position, out.position[4])
    with pytest.raises(IndexError):
        out[5]


@pytest.mark.parametrize("chosen", [slice(0, 1), slice(1, 4), slice(None, None, -2), slice(-2, None)])
def test_a_slice_is_a_smaller_ensemble(chosen: slice) -> None:
    copies = SCENE.ensemble(position=STARTS)
    out = copies.run(t=[0.0, 0.5, 1.0], method="dop853")
    some = out[chosen]
    assert isinstance(some, vv.EnsembleTrajectory)
    assert isinstance(copies[chosen], vv.EnsembleScene)
    indices = range(5)[chosen]
    assert len(some) == len(copies[chosen]) == len(indices)
    assert some.stats.steps == sum(out[index].stats.steps for index in indices)
    for member, start, index in zip(some, copies[chosen], indices, strict=True):
        assert start == copies[index]
        assert member.scene == out[index].scene
        assert member.final == out[index].final
        assert np.array_equal(member.position, out[index].position)
    # What is run again has the bits it had among more.
    assert np.array_equal(copies[chosen].run(t=[0.0, 0.5, 1.0], method="dop853").position, some.position)


def test_an_ensemble_keeps_its_own_copy() -> None:
    starts = STARTS.copy()
    copies = SCENE.ensemble(position=starts)
    starts += 1.0
    assert np.array_equal(copies.position, STARTS)


def test_masses_may_differ() -> None:
    masses = np.array([[1.0, 1.0, 1.0], [2.0, 1.0, 0.0]])
    out = SCENE.ensemble(mass=masses).run(t=0.5)
    assert np.array_equal(out[1].scene.particles.mass, masses[1])
    assert out.energy[1, 0] == out[1].scene.invariants().energy


def test_the_end_is_a_new_ensemble() -> None:
    copies = SCENE.ensemble(position=STARTS)
    half = copies.run(t=0.5, method="leapfrog", dt=0.01).final
    assert half.scene.t0 == 0.5
    assert np.array_equal(
        half.run(t=1.0, method="leapfrog", dt=0.01).position[:, 0],
        copies.run(t=0.5, method="leapfrog", dt=0.01).position[:, -1],
    )


def test_pickle() -> None:
    copies = SCENE.ensemble(position=STARTS)
    again = pickle.loads(pickle.dumps(copies))
    assert again.scene == copies.scene
    assert np.array_equal(again.position, copies.position)


@pytest.mark.parametrize(
    ("given", "argument"),
    [
        ({}, "position"),
        ({"position": np.zeros((2, 4, 3))}, "position"),
        ({"position": np.zeros((3, 3))}, "position"),
        ({"velocity": np.full((2, 3, 3), np.nan)}, "velocity"),
        ({"mass": np.ones((2, 4))}, "mass"),
        ({"position": np.zeros((2, 3, 3)), "velocity": np.zeros((3, 3, 3))}, "velocity"),
        ({"position": np.zeros((0, 3, 3))}, "position"),
    ],
)
def test_refusals_by_name(given: dict[str, np.ndarray], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        SCENE.ensemble(**given)
    assert caught.value.argument == argument


def test_a_member_that_fails_keeps_its_own_status() -> None:
    """The middle copy falls head-on; its neighbors have the bits of single runs."""
    pair = vv.Scene(vv.Particles([1.0, 1.0], [[-1, 0, 0], [1, 0, 0]], [[0, -0.5, 0], [0, 0.5, 0]]), vv.Gravity(1.0))
    velocity = pair.particles.velocity * np.array([1.0, 0.0, 0.9])[:, None, None]
    out = pair.ensemble(velocity=velocity).run(t=[1.0, 5.0], method="dop853", rtol=1e-10)
    assert out.status.tolist() == [vv.Status.OK, vv.Status.CLOSE_ENCOUNTER, vv.Status.OK]
    assert [member.status for member in out] == [vv.Status.OK, vv.Status.CLOSE_ENCOUNTER, vv.Status.OK]
    assert np.isfinite(out.position[1, 0]).all()
    assert np.isnan(out.position[1, 1]).all()
    for index in (0, 2):
        alone = pair.with_state(pair.particles.position, velocity[index]).run(t=[1.0, 5.0], method="dop853", rtol=1e-10)
        assert np.array_equal(out.position[index], alone.position)
    with pytest.raises(vv.InvalidInput) as caught:
        _ = out.final
    assert caught.value.argument == "final"
    # Two masses 1 at distance 2, from rest: they meet after π √(d³ / (8 G M)) = π / √2.
    with pytest.raises(vv.CloseEncounter) as encounter:
        pair.with_state(pair.particles.position, np.zeros((2, 3))).run(t=5.0, method="dop853", rtol=1e-10)
    assert encounter.value.bodies == (0, 1)
    # A fall of a relative tolerance of 1e-10; measured 8e-12.
    assert encounter.value.time == pytest.approx(np.pi / np.sqrt(2), rel=1e-10, abs=0)
    assert encounter.value.trajectory.status is vv.Status.CLOSE_ENCOUNTER
    assert encounter.value.trajectory.t.tolist() == [0.0]
