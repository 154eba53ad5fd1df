"""Arrays of quaternions, vectors and matrices: checked, as rows for the core, and their axes back."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray


def checked_rows(name: str, value: ArrayLike, axes: tuple[int, ...]) -> NDArray[np.float64]:
    """Check an array whose last axes have these lengths; of a SciPy rotation, take the quaternions."""
    if axes == (4,) and hasattr(value, "as_quat"):
        value = value.as_quat()
    array = float_array(name, value, None)
    if array.shape[array.ndim - len(axes) :] != axes or array.ndim < len(axes):
        expected = ", ".join(map(str, axes))
        raise InvalidInput(name, f"expected shape (…, {expected}), got {array.shape}")
    return array


def map_rows(
    function: Callable[..., NDArray[np.float64]],
    result: tuple[int, ...],
    *arguments: tuple[str, ArrayLike, tuple[int, ...]],
) -> NDArray[np.float64]:
    """Give a function of the core for each entry of arrays, whose leading axes broadcast.

    Parameters
    ----------
    function : callable
        Of one array of rows for each argument; an argument that is the same for all entries has a single row.
    result : tuple of int
        The last axes of what it gives for one entry.
    *arguments : tuple
        The name of each argument, what came, and its last axes.
    """
    lead: tuple[int, ...] = ()
    checked: list[NDArray[np.float64]] = []
    for name, value, axes in arguments:
        array = checked_rows(name, value, axes)
        own = array.shape[: array.ndim - len(axes)]
        try:
            shape = np.broadcast_shapes(lead, own)
        except ValueError:
            before = " and ".join(other for other, *_ in arguments[: len(checked)])
            raise InvalidInput(name, f"expected axes that broadcast with {lead} of {before}, got {own}") from None
        lead = shape
        checked.append(array)
    flat = [_flat(array, lead, axes) for array, (_, _, axes) in zip(checked, arguments, strict=True)]
    return function(*flat).reshape(*lead, *result)


def _flat(array: NDArray[np.float64], lead: tuple[int, ...], axes: tuple[int, ...]) -> NDArray[np.float64]:
    width = prod(axes)
    # A single row serves all rows, but not none.
    if array.size != width or 0 in lead:
        array = np.ascontiguousarray(np.broadcast_to(array, (*lead, *axes)))
    return array.reshape(-1, width)
