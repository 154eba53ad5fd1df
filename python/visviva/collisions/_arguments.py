"""Masses and vectors of two bodies, checked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._arrays import float_array, positive_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def vector(name: str, value: object) -> NDArray[np.float64]:
    """Check an array of vectors: three numbers along the last axis."""
    array = float_array(name, value, None)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InvalidInput(name, f"expected three components along the last axis, got shape {array.shape}")
    return array


def masses(mass1: object, mass2: object) -> dict[str, NDArray[np.float64]]:
    """Check the masses of both."""
    return {"mass1": positive_array("mass1", mass1), "mass2": positive_array("mass2", mass2)}


def vectors(**given: object) -> dict[str, NDArray[np.float64]]:
    """Check vectors by name."""
    return {name: vector(name, value) for name, value in given.items()}
