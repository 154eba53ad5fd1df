"""What held in each copy of an ensemble is what holds in it alone, and the table tells of the copy that did worst."""

import warnings
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

STAR = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.5, 0.0]])
NUMBERS = ("scale", "max", "end", "rms", "slope", "conserved")
ROWS = ("energy", "momentum", "angular_momentum", "center_of_mass")


def copies(**more: object) -> vv.EnsembleTrajectory:
    scene = vv.problems.figure_eight().scene
    speeds = np.array([1.0, 0.9, 0.95])[:, None, None] * scene.particles.velocity
    return scene.ensemble(velocity=speeds).run(t=np.linspace(0.0, 3.0, 31), **more)


@pytest.mark.parametrize("about", [None, "center_of_mass", [1.0, 2.0, 0.0]])
def test_each_number_is_that_of_the_copy(about: object) -> None:
    out = copies()
    table = out.conservation(about)
    for copy, one in enumerate(out):
        alone = one.conservation(about)
        for row in ROWS:
            for number in NUMBERS:
                assert getattr(getattr(table, row), number)[copy] == getattr(getattr(alone, row), number)
        assert table.virial[copy] == alone.virial
        assert table.about == alone.about
    assert not table.energy.max.flags.writeable


def test_the_table_tells_of_the_worst_copy() -> None:
    """Leapfrog of equal steps: of a Kepler orbit the error grows with the eccentricity, here that of copy 1."""
    scene = vv.problems.kepler(e=0.1).scene
    speeds = np.array([1.0, 0.7, 0.9])[:, None, None] * scene.particles.velocity
    table = scene.ensemble(velocity=speeds).run(t=np.linspace(0, 6, 61), method="leapfrog", dt=0.01).conservation()
    assert table.energy.worst == table.energy.max.argmax() == 1
    told = next(line for line in str(table).splitlines() if line.startswith("energy"))
    assert told.split()[1:] == [f"{table.energy.max[1]:.1e}", f"{table.energy.end[1]:.1e}",
                                f"{table.energy.rms[1]:.1e}", f"{table.energy.scale[1]:.6g}", "1"]  # fmt: skip
    assert f"energy {table.energy.max[1]:.1e} (copy 1)" in repr(table)


def test_what_no_copy_conserves_has_no_worst() -> None:
    falls = vv.Scene(STAR, vv.UniformField([0.0, 0.0, -1.0])).ensemble(position=[[[1.0, 0, 0]], [[2.0, 0, 0]]])
    table = falls.run(t=[0.0, 1.0]).conservation()
    assert table.momentum.worst is None
    assert "momentum (conserved in no copy)" in str(table)
    assert table.energy.conserved.all()


def test_copies_whose_drift_is_no_number_are_told() -> None:
    """Energies beyond float64, of the second and the third copy: the table is that of the first."""
    still = vv.Scene(vv.Particles([1.0], [[0.0, 0, 0]], [[1.0, 0.0, 0.0]]))
    speeds = np.zeros((3, 1, 3))
    speeds[:, 0, 0] = 1.0, 1e200, -1e200
    table = still.ensemble(velocity=speeds).run(t=[0.0, 1.0]).conservation()
    assert table.energy.worst == 0
    assert "The energy of 2 copies, 1 the first, is no number" in str(table)
    assert "momentum of" not in str(table)
    assert "no number" not in str(table[:1])
    assert "The energy of copy 0 is no number" in str(table[1:2])


def test_a_copy_that_failed_at_once_is_nan_and_no_other() -> None:
    """Two stars that meet end before the first output; the other two go on."""
    two = vv.Scene(
        vv.Particles([1.0, 1.0], [[0.0, 0, 0], [1.0, 0, 0]], [[0.0, 0, 0], [0.0, 1.0, 0]]), vv.Gravity(G=1.0)
    )
    speeds = [[[0.0, 0, 0], [0.0, 1.0, 0]], [[0.0, 0, 0], [0.0, 0.0, 0]]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vv.AccuracyWarning)
        out = two.ensemble(velocity=speeds).run(t=[2.0, 3.0], method="dop853")
    assert out.status.tolist()[0] == 0 != out.status.tolist()[1]
    table = out.conservation()
    assert np.isnan(table.energy.max).tolist() == [False, True]
    assert table.energy.conserved.tolist() == [True, False]
    assert table.energy.worst == 0
    with pytest.raises(vv.InvalidInput, match=r"^record: there is no row"):
        out[1:].conservation()


def test_generalized_coordinates() -> None:
    many = vv.systems.spherical_pendulum().ensemble(position=[[1.0, 0.0], [2.0, 0.0]], velocity=[[0.0, 1.0]] * 2)
    out = many.run(t=np.linspace(0.0, 10.0, 11), method="rk4", dt=0.1)
    changes = out.conservation()
    assert list(changes) == ["energy", "momentum of phi"]
    for name, values in changes.items():
        assert values.tolist() == [out[copy].conservation()[name] for copy in range(2)]


def test_stats_of_generalized_coordinates(tmp_path: Path) -> None:
    """As of scenes: the numbers of the run, of copies in total, also when loaded."""
    many = vv.systems.pendulum().ensemble(position=[[0.1], [3.0]])
    out = many.run(t=10.0, method="gauss16")
    each = [out[copy].stats for copy in range(2)]
    assert [one.steps for one in each] == out.steps.tolist()
    assert out.stats.steps == sum(one.steps for one in each)
    assert out.stats.evaluations == sum(one.evaluations for one in each) == out.evaluations.sum()
    assert (
        out.stats.longest_step == max(one.longest_step for one in each) == max(out[0].longest_step, out[1].longest_step)
    )
    assert out.stats.method == each[0].method == out[0].method == "gauss16"
    out.save(tmp_path / "run.npz")
    assert vv.load(tmp_path / "run.npz").stats == out.stats


def test_copies_that_failed_are_told_with_the_drifts_up_to_there():
    scene = vv.problems.kepler(e=0.5).scene
    falling = np.stack([scene.particles.velocity, np.zeros_like(scene.particles.velocity)])
    out = scene.ensemble(velocity=falling).run(t=[0.0, 0.5, 5.0], method="dop853")
    kept = out.conservation()
    assert kept.status.tolist() == out.status.tolist() == [vv.Status.OK, vv.Status.CLOSE_ENCOUNTER]
    assert "2 copies, of which 1 failed, told up to there" in str(kept)
