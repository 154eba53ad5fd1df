"""Events in a Parquet file: the very ones, a group at a time, without a trace of what was refused."""

import sys
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

ASKED = {
    "beam_energy": vv.scattering.Spectrum([1.1, 1.5], [1.0, 2.0]), "masses": (1.0, 4.0), "b_max": 3.0, "seed": 5,
    "first_event": 2**40 + 1, "divergence": 0.01,
}  # fmt: skip
GROUP = vv.scattering._events._GROUP


def write(path: object, n_events: int, **changes: object) -> dict[str, np.ndarray]:
    potential = vv.potentials.PowerLaw(-1.0, 4)  # captures
    return vv.scattering.scattering_events(potential, **{**ASKED, "n_events": n_events, **changes}, to=path)


def test_a_file_holds_the_very_events(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    count = GROUP + 1001
    seen: list[tuple[int, int]] = []
    assert write(tmp_path / "events.parquet", count, progress=lambda *done: seen.append(done)) == {}
    assert seen == sorted(seen)
    assert seen[-1] == (count, count)
    table = parquet.read_table(tmp_path / "events.parquet")
    arrays = vv.scattering.scattering_events(vv.potentials.PowerLaw(-1.0, 4), **ASKED, n_events=count)
    assert table.column_names == list(arrays)
    for name, column in arrays.items():
        stored = table[name].to_numpy()
        assert stored.dtype == column.dtype
        assert np.array_equal(stored, column, equal_nan=name not in ("event", "component")), name
    assert parquet.ParquetFile(tmp_path / "events.parquet").num_row_groups == 2


def test_an_interrupted_file_holds_what_came_before(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")

    def stop(done: int, total: int) -> None:
        if done > GROUP:
            raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted, match=f"after {GROUP} of {3 * GROUP} events"):
        write(str(tmp_path / "events.parquet"), 3 * GROUP, progress=stop)
    events = parquet.read_table(tmp_path / "events.parquet")["event"].to_numpy()
    assert events[[0, -1]].tolist() == [2**40 + 1, 2**40 + GROUP]


def test_what_is_refused_leaves_no_file(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    for changes in ({"b_max": -1.0}, {"masses": (1.0, 0.0)}, {"divergence": 1.0}):
        with pytest.raises(vv.InvalidInput, match=next(iter(changes))):
            write(tmp_path / "events.parquet", 10, **changes)
    with pytest.raises(vv.InvalidInput, match="to"):
        write(3, 10)
    assert not list(tmp_path.iterdir())


def test_without_pyarrow_it_is_said_how_to_get_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(vv.InvalidInput, match=r"visviva\[parquet\]") as caught:
        write(tmp_path / "events.parquet", 10)
    assert caught.value.argument == "to"
    assert not list(tmp_path.iterdir())


def test_events_that_no_memory_is_there_for_are_refused_before_anything_runs() -> None:
    """Their 10 numbers or so would take some 100 bytes each; Python once ended with the process."""
    with pytest.raises(vv.InvalidInput, match=r"1000000000000 events would take .*write them to a file by to="):
        vv.scattering.scattering_events(vv.potentials.Coulomb(1.0), **ASKED, n_events=10**12)
