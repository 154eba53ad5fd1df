"""Some of the copies of an ensemble: which of them an index means, and what is asked of these.

The one idea: one function decides what an index of copies may be, so that ensembles and their runs, of scenes and in
generalized coordinates, accept the same and refuse the rest with the same words.
"""

from __future__ import annotations

from operator import index as whole
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    from visviva import _core

__all__ = ["One", "Some", "each_of", "lines_of", "of_copies", "one_or_some", "rows_of"]

One: TypeAlias = int | np.integer
"""An index that means one copy."""

Some: TypeAlias = slice | list[int] | list[bool] | range | NDArray[np.integer] | NDArray[np.bool]
"""An index that means several, which are an ensemble."""

_EXPECTED = "expected a whole number, a slice, a list or array of whole numbers, or a mask"

_Each = TypeVar("_Each")

_OF_COPIES = ("mass", "position", "velocity")
_OF_RIGID_BODIES = ("moments", "axes", "center", "orientation", "angular_velocity")
"""What is each copy's own."""


def one_or_some(index: Any, count: int) -> int | slice | NDArray[np.intp]:
    """Which of so many copies an index means: one, by its number from 0, or several: a slice as it came, or numbers.

    Raises
    ------
    InvalidInput
        For what is none, a mask of another length, and what chooses no copy.
    IndexError
        For a number of no copy.

    Examples
    --------
    >>> import numpy as np
    >>> from visviva._some_copies import one_or_some
    >>> one_or_some(-1, 4), one_or_some([0, -1, 0], 4), one_or_some(np.array([2.0, 1.0, 3.0, 4.0]) > 1.5, 4)
    (3, array([0, 3, 0]), array([0, 2, 3]))
    """
    if isinstance(index, slice):
        if not range(count)[index]:
            _refuse_none(count)
        return index
    # True is 1 to Python, and in a mask it is none.
    if isinstance(index, bool):
        _refuse(index)
    try:
        number = whole(index)
    except TypeError:
        return _several(index, count)
    if not -count <= number < count:
        raise IndexError(f"copy {number} of {count}")
    return number % count


def _several(index: Any, count: int) -> NDArray[np.intp]:
    """The numbers from 0 of copies in a list or an array of numbers, or where a mask is true."""
    if isinstance(index, tuple):
        _refuse(index, "; pass several in a list")
    if isinstance(index, np.ndarray) and hasattr(index, "mask"):  # not np.ma, which would be imported for this
        raise InvalidInput("index", f"{_EXPECTED}, got a masked array; pass x.compressed() or x.filled(…)")
    try:
        # Of what a list mixes NumPy would make numbers of one type: True would be 1, and large numbers floats.
        array = np.asarray(index, dtype=object if isinstance(index, list) else None)
        if array.ndim == 1 and array.dtype.kind == "O":
            array = _of_one_kind(array)
    except (TypeError, ValueError):
        _refuse(index)
    if array.ndim != 1:
        _refuse(index)
    if array.dtype.kind == "b":
        if len(array) != count:
            raise InvalidInput("index", f"expected a mask of shape ({count},), got {array.shape}")
        array = np.flatnonzero(array)
    if not len(array):
        _refuse_none(count)
    if array.dtype.kind not in "iuO":
        _refuse(index)
    outside = (array < -count) | (array >= count)
    if outside.any():
        raise IndexError(f"copy {array[outside][0]} of {count}")
    return array.astype(np.intp) % count


def _of_one_kind(array: NDArray[Any]) -> NDArray[Any]:
    """Objects as a mask if all are true or false, and else as whole numbers of any size; TypeError if they are not."""
    masks = [isinstance(each, bool | np.bool) for each in array]
    if masks and all(masks):
        return array.astype(np.bool)
    if any(masks):
        raise TypeError
    return np.array([whole(each) for each in array], dtype=object)


def _refuse(index: Any, advice: str = "") -> NoReturn:
    came = f"an array of {index.dtype} of shape {index.shape}" if isinstance(index, np.ndarray) else shortened(index)
    raise InvalidInput("index", f"{_EXPECTED}, got {came}{advice}") from None


def _refuse_none(count: int) -> NoReturn:
    raise InvalidInput("index", f"expected at least one of {count} copies, got none")


def rows_of(chosen: int | slice | NDArray[np.intp]) -> slice | NDArray[np.intp]:
    """The rows of what `one_or_some` gave."""
    return slice(chosen, chosen + 1) if isinstance(chosen, int) else chosen


def each_of(values: Sequence[_Each], chosen: slice | NDArray[np.intp]) -> tuple[_Each, ...]:
    """What each of several copies has in a list or a tuple."""
    return tuple(values[chosen] if isinstance(chosen, slice) else (values[copy] for copy in chosen.tolist()))


def lines_of(lengths: NDArray[np.intp], copies: NDArray[np.intp]) -> NDArray[np.intp]:
    """The lines of several copies in a table that has so many of one copy after another.

    Examples
    --------
    >>> import numpy as np
    >>> from visviva._some_copies import lines_of
    >>> lines_of(np.array([2, 0, 3]), np.array([2, 0]))
    array([2, 3, 4, 0, 1])
    """
    numbers, begin = lengths[copies], np.cumsum(lengths) - lengths
    # From the place in the new table to that in the old one.
    ahead = begin[copies] - (np.cumsum(numbers) - numbers)
    lines: NDArray[np.intp] = np.arange(numbers.sum()) + np.repeat(ahead, numbers)
    return lines


def of_copies(asked: _core._Request, copies: slice | NDArray[np.intp]) -> _core._Request:
    """What is asked of some copies, without where an earlier run left them."""
    request: Any = dict(asked)
    for name in _OF_COPIES:
        request[name] = request[name][copies]
    if asked["radius"] is not None:
        request["radius"] = asked["radius"][copies]
    if asked["rigid"] is not None:
        own: Any = asked["rigid"]
        request["rigid"] = own | {name: own[name][copies] for name in _OF_RIGID_BODIES}
        if own["own_loads"] is not None:
            request["rigid"]["loads"], request["rigid"]["own_loads"] = _sets_of(own["own_loads"], copies)
    if asked["own_forces"] is not None:
        request["forces"], request["own_forces"] = _sets_of(asked["own_forces"], copies)
    request["continuation"] = None
    return cast("_core._Request", request)


def _sets_of(own: tuple[list[Any], list[int]], copies: slice | NDArray[np.intp]) -> tuple[Any, Any]:
    """What the first of some copies has, and what each has if they differ.

    A set that none of them has is none of theirs, and what is planned of all is planned of the first.
    """
    sets, which = own
    chosen = np.asarray(which)[copies]
    used, of_copy = np.unique(chosen, return_inverse=True)
    return sets[chosen[0]], ([sets[each] for each in used], of_copy.tolist()) if len(used) > 1 else None
