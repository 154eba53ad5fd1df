"""Indices that choose several copies of an ensemble, with the copies meant; and what a part has of the whole."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

import visviva as vv

Chosen = tuple[Any, list[int]]
"""An index, and the numbers of copies that it means."""


@st.composite
def choices(draw: st.DrawFn, count: int) -> Chosen:
    """Slices, lists, arrays of several types, ranges and masks of so many copies, none of them empty."""
    everything = list(range(count))
    kind = draw(st.sampled_from(["slice", "list", "array", "range", "list of flags", "mask"]))
    if kind == "slice":
        cut = draw(st.slices(count).filter(lambda cut: len(everything[cut]) > 0))
        return cut, everything[cut]
    if kind == "range":
        first = draw(st.integers(0, count - 1))
        steps = range(first, draw(st.integers(first + 1, count)), draw(st.integers(1, 3)))
        return steps, list(steps)
    if kind in ("list", "array"):
        numbers = draw(st.lists(st.integers(-count, count - 1), min_size=1, max_size=count + 2))
        kept = [everything[number] for number in numbers]
        if kind == "list":
            return [draw(st.sampled_from([int, np.int16]))(number) for number in numbers], kept
        dtype = draw(st.sampled_from([np.int8, np.int64, np.uint8]))
        return np.array(kept if dtype is np.uint8 else numbers, dtype=dtype), kept
    flags = draw(st.lists(st.booleans(), min_size=count, max_size=count).filter(any))
    return flags if kind == "list of flags" else np.array(flags), np.flatnonzero(flags).tolist()


def same_rows(found: Any, alone: list[Any]) -> None:
    """An array of copies has the bits of those alone, and NaN where these have ended."""
    assert len(found) == len(alone)
    for rows, own in zip(found, alone, strict=True):
        np.testing.assert_array_equal(rows[: len(own)], own)
        assert np.isnan(rows[len(own) :]).all()


def same_tables(found: Any, alone: list[Any], columns: tuple[str, ...]) -> None:
    """A table has the lines of each copy one after another, numbered from 0."""
    for name in columns:
        np.testing.assert_array_equal(getattr(found, name), np.concatenate([getattr(own, name) for own in alone]))
    np.testing.assert_array_equal(found.member, np.repeat(np.arange(len(alone)), [len(own.t) for own in alone]))


def same_exports(part: Any, whole: Any, numbers: list[int]) -> None:
    """Data sets and frames of a part are those copies of the whole, numbered anew."""
    cut = whole.to_xarray().isel(copy=numbers).assign_coords(copy=np.arange(len(numbers)))
    assert part.to_xarray().identical(cut)
    frame, times = part.to_pandas(), len(whole.t)
    rows = (np.array(numbers)[:, None] * times + np.arange(times)).ravel()
    assert frame.index.get_level_values("copy").tolist() == np.repeat(np.arange(len(numbers)), times).tolist()
    assert frame.index.get_level_values("time").tolist() == np.tile(whole.t, len(numbers)).tolist()
    assert frame.equals(whole.to_pandas().iloc[rows].set_axis(frame.index))


def nothing_can_be_written(*arrays: np.ndarray) -> None:
    for array in arrays:
        assert not array.flags.writeable


def refuses_what_is_no_choice(copies: Any, *, names: bool = False) -> None:
    """What is asked of copies, four of them, by indices that mean none; some of these have names beside."""

    def told(index: Any) -> str:
        try:
            copies[index]
        except (vv.InvalidInput, IndexError) as error:
            return f"{type(error).__name__} {error}"
        raise AssertionError(f"{index!r} means something")

    big = 2**70
    for index in (7, [0, 7], np.array([1, 7, 9]), np.array([7], dtype=np.uint8), np.array([7], dtype=np.uint64)):
        assert told(index) == "IndexError copy 7 of 4"
    assert told(-5) == told([0, -5]) == "IndexError copy -5 of 4"
    assert told([big]) == f"IndexError copy {big} of 4"
    for mask in ([True, False], np.array([True, False])):
        assert told(mask) == "InvalidInput index: expected a mask of shape (4,), got (2,)"
    assert told(np.ones((4, 1), dtype=bool)).endswith("or a mask, got an array of bool of shape (4, 1)")
    assert told((0, 1)).endswith("or a mask, got (0, 1); pass several in a list")
    assert told(np.ma.array([0, 1], mask=[True, False])).endswith("a masked array; pass x.compressed() or x.filled(…)")
    unlike = [True, 1.5, None, [0.5], [0, True], [[0]], [0, [1]], {0}, np.array([0.0]), np.array([[0]]), np.array(True)]
    for index in [*unlike, *([] if names else ["0"])]:
        expected = "index: expected a whole number, a slice, a list or array of whole numbers, or a mask, got"
        assert told(index).startswith(f"InvalidInput {expected} ")
    # An ensemble has a copy at least: no index that chooses none gives one.
    none = told(slice(4, None))
    assert none.startswith("InvalidInput ")
    assert "expected at least one" in none
    for index in ([], np.array([]), np.array([], dtype=int), range(0), np.zeros(4, dtype=bool), [False] * 4):
        assert told(index) == none
