"""What moves a part of a scene: a displacement with a boost, or a turn of space."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["displacement", "orthogonal"]


def displacement(position: ArrayLike, velocity: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Check by what a part is displaced and boosted.

    Raises
    ------
    InvalidInput
        For what are not three finite numbers each.

    Examples
    --------
    >>> from visviva._moves import displacement
    >>> displacement([1, 0, 0], 3.0)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: velocity: expected shape (3,), got (); give its three components
    """
    return float_array("position", position, (3,)), float_array("velocity", velocity, (3,))


def orthogonal(rotation: ArrayLike) -> NDArray[np.float64]:
    """Check a matrix that turns or reflects space.

    Raises
    ------
    InvalidInput
        For another shape, or a matrix that is not orthogonal to 1e-12.

    Examples
    --------
    >>> from visviva._moves import orthogonal
    >>> orthogonal([[1, 0, 0], [0, 2, 0], [0, 0, 1]])
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: rotation: expected an orthogonal matrix, but |R Rᵀ − 1| is 3.0e+00
    """
    matrix = float_array("rotation", rotation, (3, 3))
    defect = float(np.abs(matrix @ matrix.T - np.eye(3)).max())
    if defect > 1e-12:
        raise InvalidInput("rotation", f"expected an orthogonal matrix, but |R Rᵀ − 1| is {defect:.1e}")
    return matrix
