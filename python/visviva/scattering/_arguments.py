"""Arguments of functions of one array, and their evaluation by the core."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import NDArray


def evaluate(
    function: str,
    name: str,
    values: object,
    limit: float,
    *,
    half_distance: float = 0.0,
    mass_ratio: object = 1.0,
) -> NDArray[np.float64]:
    """Check an array within [0, limit] and evaluate one of the core's functions on it."""
    array = float_array(name, values, None)
    wrong = (array < 0.0) | (array > limit)
    if wrong.any():
        bound = {np.pi: "[0, π]", np.pi / 2.0: "[0, π/2]"}.get(limit, "[0, ∞)")
        raise InvalidInput(name, f"expected numbers in {bound}, got {array[wrong][0]}")
    ratio = positive("mass_ratio", mass_ratio)
    result = _core.scattering_function(function, half_distance, ratio, array.ravel()).reshape(array.shape)
    return result[()]
