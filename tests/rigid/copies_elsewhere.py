"""Copies that are saved, pickled, cut, sent to executors, streamed and run on are the same copies, to the bit."""

import pickle
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

COLUMNS = ("position", "velocity", "orientation", "angular_velocity", "energy", "angular_momentum")


def assert_same(found: Any, expected: Any, columns: tuple[str, ...] = COLUMNS) -> None:
    for column in columns:
        assert np.array_equal(getattr(found, column), getattr(expected, column)), column


def assert_same_elsewhere(
    copies: vv.EnsembleScene, times: list[float], how: dict[str, Any], folder: Path
) -> tuple[Any, Any, list[Any]]:
    """Give the run at these times, that which goes on from it, and those that a file and a pickle gave back."""
    out = copies.run(t=times, **how)
    on = out.final.run(t=1.0, **how)
    out.save(folder / "run.npz")
    loaded = vv.load(folder / "run.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    others = [loaded, pickle.loads(pickle.dumps(out))]
    for other in others:
        assert list(other.ensemble) == list(copies)
        assert_same(other.ensemble.run(t=times, **how), out)
        assert_same(other.final.run(t=1.0, **how), on)
        assert_same(other, out)
    assert_same(copies[3:9].run(t=times, **how), out[3:9])
    assert list(copies[3:9]) == [copies[copy] for copy in range(3, 9)]
    for copy in (0, 4, 10):
        assert_same(on[copy], copies[copy].run(t=times, **how).final.run(t=1.0, **how))
    with ThreadPoolExecutor(2) as executor:
        assert_same(copies.run(t=times, executor=executor, **how), out)
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    copies.run_to_parquet(t=times, to=folder / "run.parquet", copies_at_once=4, **how)
    table, streamed = out.to_pandas(), pandas.read_parquet(folder / "run.parquet")
    assert len(table) == len(times) * len(copies)
    for column in table.columns:
        if column in streamed:
            assert np.array_equal(streamed[column], table[column]), column
    return out, on, others
