"""Parquet files: the very numbers, a group of rows at a time, and of ensembles without the whole in memory."""

import sys
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import _parquet

parquet = pytest.importorskip("pyarrow.parquet")

TIMES = [0.0, 0.5, 1.0]
HOW = {"method": "kahan_li8", "dt": 0.01, "record": ["position", "energy"]}


def ensemble(count: int) -> vv.EnsembleScene:
    scene = vv.problems.figure_eight().scene
    return scene.ensemble(position=scene.particles.position * np.linspace(0.99, 1.01, count)[:, None, None])


@pytest.fixture
def small_groups(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_parquet, "GROUP_BYTES", 8 * 13 * 7)  # seven rows of copy, time, status and ten numbers


def check(path: Path, out: vv.EnsembleTrajectory) -> None:
    table = parquet.read_table(path)
    copies, times = out.energy.shape
    np.testing.assert_array_equal(table["copy"].to_numpy(), np.repeat(np.arange(copies), times))
    np.testing.assert_array_equal(table["time"].to_numpy(), np.tile(out.t, copies))
    np.testing.assert_array_equal(table["status"].to_numpy(), np.repeat(out.status, times))
    np.testing.assert_array_equal(table["energy"].to_numpy(), out.energy.reshape(-1))
    for body in range(out.position.shape[2]):
        for axis, name in enumerate("xyz"):
            found = table[f"position_{body}_{name}"].to_numpy()
            np.testing.assert_array_equal(found, out.position[:, :, body, axis].reshape(-1))
    assert table.num_columns == 3 + 9 + 1


@pytest.mark.usefixtures("small_groups")
def test_a_file_of_an_ensemble_holds_the_very_numbers(tmp_path: Path) -> None:
    out = ensemble(11).run(TIMES, **HOW)
    out.to_parquet(tmp_path / "copies.parquet")
    check(tmp_path / "copies.parquet", out)
    file = parquet.ParquetFile(tmp_path / "copies.parquet")
    assert file.num_row_groups == -(-33 // 7)
    assert file.schema_arrow.metadata[b"method"] == b"kahan_li8"


@pytest.mark.parametrize("at_once", [1, 4, 8, 100, None])
def test_a_file_written_while_it_runs_has_the_bits_of_the_run(tmp_path: Path, at_once: int | None) -> None:
    copies = ensemble(19)
    status = copies.run_to_parquet(TIMES, **HOW, to=tmp_path / "copies.parquet", copies_at_once=at_once)
    out = copies.run(TIMES, **HOW)
    check(tmp_path / "copies.parquet", out)
    np.testing.assert_array_equal(status, out.status)
    assert parquet.ParquetFile(tmp_path / "copies.parquet").num_row_groups == -(-19 // (at_once or 19))


def test_copies_that_end_are_told_apart(tmp_path: Path) -> None:
    # The second copy falls onto the first body, and its rows are NaN from there on.
    scene = vv.Scene(
        vv.Particles([1.0, 0.0], [[0.0, 0, 0], [1.0, 0, 0]], [[0.0, 0, 0], [0.0, 1.0, 0]]), vv.Gravity(1.0)
    )
    copies = scene.ensemble(velocity=[[[0.0, 0, 0], [0.0, v, 0]] for v in (1.0, 0.0, 0.9)])
    how = {"t": [0.0, 3.0], "method": "dop853", "record": "position"}
    path = tmp_path / "copies.parquet"
    status = copies.run_to_parquet(**how, to=path, copies_at_once=1)
    np.testing.assert_array_equal(status, copies.run(**how).status)
    assert status.astype(bool).tolist() == [False, True, False]
    table = parquet.read_table(path, filters=[("status", "=", 0)])
    assert table["copy"].to_pylist() == [0, 0, 2, 2]
    assert np.isfinite(table["position_1_x"].to_numpy()).all()


def test_memory_is_that_of_the_parts(tmp_path: Path) -> None:
    # The positions of all copies would be 24 MB; numpy's arrays are seen by tracemalloc.
    copies, times = ensemble(400), np.linspace(0.0, 1.0, 834)
    tracemalloc.start()
    try:
        copies.run_to_parquet(times, method="leapfrog", dt=0.05, record="position", to=tmp_path / "a", copies_at_once=8)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert parquet.ParquetFile(tmp_path / "a").metadata.num_rows == 400 * 834
    assert most < 8e6  # a part, its columns and its table: 0.5 MB each


SPRING = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Harmonic(k=1.0))
LONG = np.linspace(0.0, 50.0, 60_000)


@pytest.mark.parametrize(
    "made",
    [
        lambda: SPRING.run(t=LONG),
        lambda: SPRING.ensemble(position=np.ones((20, 1, 3))).run(t=LONG[:3_000]),
        lambda: vv.systems.oscillator(position=[1.0]).run(t=LONG),
        lambda: vv.problems.kepler(e=0.5).scene.run(t=LONG).elements(about=0),
        lambda: (
            SPRING.ensemble(position=np.ones((6_000, 1, 3)))
            .run(t=30.0, events=[vv.events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0])])
            .events
        ),
    ],
    ids=["run", "ensemble", "generalized", "elements", "events"],
)
def test_a_long_result_is_written_in_the_memory_of_a_group(
    made: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of rows of 5 to 30 numbers that are 2.4 MB together at least; of a million as of these."""
    monkeypatch.setattr(_parquet, "GROUP_BYTES", 1 << 17)
    result = made()
    result.to_parquet(tmp_path / "once")  # what is computed on first use stays with the result
    tracemalloc.start()
    try:
        result.to_parquet(tmp_path / "a")
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    rows = parquet.ParquetFile(tmp_path / "a").metadata.num_rows
    assert rows >= 54_000
    assert most < 1.2e6  # some groups, 0.48 MB, and the numbers of all events, 0.93 MB


def test_an_interrupted_file_holds_the_copies_before(tmp_path: Path) -> None:
    path, seen = tmp_path / "copies.parquet", []

    def stop(done: int, total: int) -> None:
        seen.append((done, total))
        if done >= 8:
            raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted, match=r"after 4 of 24 copies, which .* holds"):
        ensemble(24).run_to_parquet(TIMES, **HOW, to=path, copies_at_once=4, progress=stop)
    assert parquet.read_table(path)["copy"].to_pylist() == np.repeat(range(4), 3).tolist()
    assert seen[-1] == (8, 24)  # told as done, and yet not written


def test_ctrl_c_in_the_first_part_leaves_no_file(tmp_path: Path) -> None:
    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted, match=r"after 0 of 9 copies$"):
        ensemble(9).run_to_parquet(TIMES, **HOW, to=tmp_path / "a", progress=stop)
    assert not list(tmp_path.iterdir())


def test_progress_counts_copies(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    ensemble(20).run_to_parquet(
        1.0, **HOW, to=tmp_path / "a", copies_at_once=6, progress=lambda *done: seen.append(done)
    )
    assert seen == sorted(seen)
    assert seen[-1] == (20, 20)


def test_what_is_refused_leaves_no_file(tmp_path: Path) -> None:
    copies, path = ensemble(3), tmp_path / "copies.parquet"
    for changes, named in (
        ({"dt": -1.0}, "dt"),
        ({"method": "leapfog"}, "method"),
        ({"record": "speed"}, "record"),
        ({"copies_at_once": 0}, "copies_at_once"),
        ({"threads": 0}, "threads"),
        ({"to": 3}, "to"),
        ({"executor": None}, "executor"),
    ):
        with pytest.raises(vv.InvalidInput, match=f"^{named}: "):
            copies.run_to_parquet(TIMES, **({**HOW, "to": path} | changes))
    with pytest.raises(vv.InvalidInput, match=r"^columns: there is no column 'speed'"):
        copies.run(TIMES, **HOW).to_parquet(path, "speed")
    with pytest.raises(vv.InvalidInput, match=r"^path: expected the path of a file, got None"):
        copies.run(TIMES, **HOW).to_parquet(None)
    assert not list(tmp_path.iterdir())


def test_a_warning_names_the_copy_of_the_whole(tmp_path: Path) -> None:
    scene = vv.problems.kepler(e=0.9).scene
    copies = scene.ensemble(position=np.broadcast_to(scene.particles.position, (5, 2, 3)))
    how = {"t": 10.0, "method": "leapfrog", "dt": 0.3}
    with pytest.warns(vv.AccuracyWarning) as whole:
        copies.run(**how)
    with pytest.warns(vv.AccuracyWarning) as parts:
        copies.run_to_parquet(**how, to=tmp_path / "a", copies_at_once=2)
    assert [str(each.message) for each in parts] == [str(each.message) for each in whole]
    assert parts[0].filename == __file__


def test_other_results_are_written_too(tmp_path: Path) -> None:
    planets = vv.datasets.outer_solar_system().scene.run(t=[0.0, 50.0, 100.0])
    planets.to_parquet(tmp_path / "a", ["velocity", "energy"])
    table = parquet.read_table(tmp_path / "a")
    np.testing.assert_array_equal(table["velocity_Saturn_z"].to_numpy(), planets["Saturn"].velocity[:, 2])
    np.testing.assert_array_equal(table["energy"].to_numpy(), planets.energy)
    found = planets.elements(about="Sun")
    found.to_parquet(tmp_path / "b", "node")
    table = parquet.read_table(tmp_path / "b")
    assert table["body"].to_pylist()[:2] == ["Jupiter", "Saturn"]
    np.testing.assert_array_equal(table["node"].to_numpy(), found.node.reshape(-1))


def test_parts_of_a_wider_array_are_written(tmp_path: Path) -> None:
    # Coordinates are columns of the states of all copies, and so no table of their own.
    out = vv.systems.double_pendulum().ensemble(position=[[1.0, 0.5], [0.2, 0.1]]).run(t=[0.0, 0.5, 1.0])
    out.to_parquet(tmp_path / "a")
    table = parquet.read_table(tmp_path / "a")
    for at, name in enumerate(out.ensemble.system.coordinates):
        np.testing.assert_array_equal(table[f"position_{name}"].to_numpy(), out.position[..., at].reshape(-1))
    np.testing.assert_array_equal(table["status"].to_numpy(), np.repeat(out.status, 3))


def test_a_table_without_rows_keeps_its_columns(tmp_path: Path) -> None:
    out = vv.problems.kepler(e=0.5).scene.run(1.0, events=[vv.events.distance(0, 1, below=1e-6)])
    out.events.to_parquet(tmp_path / "a", "t")
    table = parquet.read_table(tmp_path / "a")
    assert (table.num_rows, table.column_names) == (0, ["event", "t"])


def test_without_pyarrow_it_is_said_how_to_get_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    copies = ensemble(2)
    for call in (
        lambda: copies.run(1.0).to_parquet(tmp_path / "a"),
        lambda: copies.run_to_parquet(1.0, to=tmp_path / "a"),
    ):
        with pytest.raises(ImportError, match=r"pip install 'visviva\[parquet\]'"):
            call()
    assert not list(tmp_path.iterdir())
