"""Rows of quaternions, vectors and matrices for the core, and their axes back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def rows(name: str, value: ArrayLike, axes: tuple[int, ...]) -> NDArray[np.float64]:
    """Check an array whose last axes have these lengths; of a SciPy rotation, take the quaternions."""
    if axes == (4,) and hasattr(value, "as_quat"):
        value = value.as_quat()
    array = float_array(name, value, None)
    if array.shape[array.ndim - len(axes) :] != axes or array.ndim < len(axes):
        expected = ", ".join(map(str, axes))
        raise InvalidInput(name, f"expected shape (…, {expected}), got {array.shape}")
    return array


def joined(arguments: dict[str, ArrayLike]) -> tuple[tuple[int, ...], NDArray[np.float64]]:
    """Check vectors and broadcast their leading axes; give these, and flat rows of one vector after the other."""
    checked = {name: rows(name, value, (3,)) for name, value in arguments.items()}
    shape: tuple[int, ...] = ()
    for name, array in checked.items():
        try:
            shape = np.broadcast_shapes(shape, array.shape[:-1])
        except ValueError:
            message = f"expected axes that broadcast with {shape} of the arguments before, got {array.shape[:-1]}"
            raise InvalidInput(name, message) from None
    whole = [np.broadcast_to(array, (*shape, 3)) for array in checked.values()]
    return shape, np.concatenate(whole, axis=-1).reshape(-1, 3 * len(whole))


def together(
    first: tuple[str, NDArray[np.float64]], second: tuple[str, NDArray[np.float64]]
) -> tuple[tuple[int, ...], NDArray[np.float64], NDArray[np.float64]]:
    """Broadcast the leading axes of two arrays of rows; give them and flat rows, a single one where one is enough."""
    (name_a, a), (name_b, b) = first, second
    try:
        shape = np.broadcast_shapes(a.shape[:-1], b.shape[:-1])
    except ValueError:
        message = f"expected axes that broadcast with {a.shape[:-1]} of {name_a}, got {b.shape[:-1]}"
        raise InvalidInput(name_b, message) from None
    return shape, _flat(a, shape), _flat(b, shape)


def _flat(array: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.float64]:
    width = array.shape[-1]
    # A single row serves all rows, but not none.
    if array.size != width or 0 in shape:
        array = np.ascontiguousarray(np.broadcast_to(array, (*shape, width)))
    return array.reshape(-1, width)
