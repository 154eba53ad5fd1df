"""Results are read-only: what is derived from them on first use stays true."""

import copy
import pickle
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

SCENE = vv.problems.figure_eight().scene
COPIES = SCENE.ensemble(position=SCENE.particles.position * np.array([1.0, 0.9])[:, None, None])
COLUMNS = ("position", "velocity", "energy", "momentum", "angular_momentum", "center_of_mass")
RECORDED = [("position", "velocity"), COLUMNS]


def arrays(out: vv.Trajectory | vv.EnsembleTrajectory) -> Iterator[np.ndarray]:
    yield out.t
    yield from (getattr(out, name) for name in COLUMNS)
    if isinstance(out, vv.EnsembleTrajectory):
        yield out.status
        yield from out.per_trajectory.values()
        yield from arrays(out[-1])
        yield out[:1].position
    final = out.final
    yield from (final.position, final.velocity) if isinstance(final, vv.EnsembleScene) else (final.particles.position,)


@pytest.mark.parametrize("record", RECORDED, ids=["computed", "recorded"])
@pytest.mark.parametrize("start", [SCENE, COPIES], ids=["scene", "ensemble"])
def test_no_array_of_a_result_can_be_written(
    start: vv.Scene | vv.EnsembleScene, record: tuple[str, ...], tmp_path: Path
) -> None:
    out = start.run([0.0, 0.5, 1.0], record=record)
    out.save(tmp_path / "run.npz")
    for same in (out, pickle.loads(pickle.dumps(out)), copy.deepcopy(out), vv.load(tmp_path / "run.npz")):
        for array in arrays(same):
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0
        assert np.array_equal(same.energy, out.energy)


def test_a_copy_is_ones_own() -> None:
    out = SCENE.run(1.0)
    energy = out.energy.copy()
    heliocentric = out.position.copy()
    heliocentric -= heliocentric[:, :1]
    assert np.array_equal(out.energy, energy)
    assert np.array_equal(SCENE.run(1.0).position, out.position)


def test_the_arrays_that_were_given_stay_writeable() -> None:
    mass, position = np.ones((2, 3)), COPIES.position.copy()
    SCENE.ensemble(mass=mass, position=position)
    mass[0], position[0] = 2.0, 0.0


@pytest.mark.parametrize("start", [SCENE, COPIES], ids=["scene", "ensemble"])
def test_a_column_cannot_be_made_writable(start: vv.Scene | vv.EnsembleScene) -> None:
    out = start.run([0.0, 0.5, 1.0], record=COLUMNS)
    for name in COLUMNS:
        with pytest.raises(ValueError, match="WRITEABLE"):
            getattr(out, name).setflags(write=True)
