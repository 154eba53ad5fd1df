"""Reports of conservation are read by copy and by the name of a row: the very numbers of the attributes."""

import warnings

import numpy as np
import pytest

import visviva as vv

SCENE = vv.problems.kepler(e=0.5).scene
MASSES = SCENE.particles.mass * np.array([1.0, 1.5, 0.75])[:, None]
# Leapfrog steps are off by enough that no two copies have the same drifts.
OUT = SCENE.ensemble(mass=MASSES).run(t=[1.0, 2.0, 3.0], method="leapfrog", dt=0.05)


def test_rows_of_one_run_by_the_names_that_are_printed() -> None:
    kept = OUT[0].conservation()
    for row in kept.rows:
        assert kept[row.name] is row
        assert kept[row.name.replace(" ", "_")] is row
        assert row.name in str(kept)
    with pytest.raises(vv.InvalidInput, match=r"^name: expected one of energy, .*, got 'enrgy'; did you mean 'energy'"):
        kept["enrgy"]


def test_a_copy_by_its_number_and_its_row_by_name() -> None:
    kept = OUT.conservation()
    assert len(kept) == 3
    assert len({each.energy.max for each in kept}) == 3
    for copy, each in enumerate(kept):
        assert each == kept[copy] == kept[copy - 3] == OUT[copy].conservation()
        for name in ("energy", "momentum", "angular momentum", "center of mass"):
            assert kept[copy][name].max == kept[name].max[copy]
    with pytest.raises(IndexError, match="copy 3 of 3"):
        kept[3]
    with pytest.raises(vv.InvalidInput, match="did you mean 'energy'"):
        kept["Energy"]
    with pytest.raises(vv.InvalidInput, match="index: expected a whole number, a slice, a list or array"):
        kept[1.5]  # type: ignore[call-overload]


def test_some_copies_are_a_report_of_these() -> None:
    kept, some = OUT.conservation(), OUT[1:].conservation()
    assert str(kept[1:]) == str(some)
    assert kept[1:].energy.max.tolist() == some.energy.max.tolist()
    assert kept[::-1].energy.max.tolist() == kept.energy.max[::-1].tolist()
    with pytest.raises(vv.InvalidInput, match="index: expected at least one of 3 copies, got none"):
        kept[3:]


def test_of_a_copy_without_a_row_everything_is_nan() -> None:
    two = vv.Scene(vv.Particles([1.0, 1.0], [[0, 0, 0], [1.0, 0, 0]]), vv.Gravity(G=1.0))
    speeds = [[[0.0, 0, 0], [0.0, 1.0, 0]], [[0.0, 0, 0], [0.0, 0.0, 0]]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vv.AccuracyWarning)
        kept = two.ensemble(velocity=speeds).run(t=[2.0, 3.0], method="dop853").conservation()
    assert [np.isnan(each.energy.max) for each in kept] == [False, True]
    assert kept[1]["energy"].conserved is False
    assert np.isnan(kept[1].virial)
