"""Numbers and vectors that broadcast against each other, as the core takes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Together:
    """Numbers and vectors that broadcast against each other, as flat arrays of one row or of the result's rows."""

    def __init__(self, numbers: dict[str, NDArray[np.float64]], vectors: dict[str, NDArray[np.float64]]) -> None:
        shape: tuple[int, ...] = ()
        axes = {name: array.shape for name, array in numbers.items()}
        axes |= {name: array.shape[:-1] for name, array in vectors.items()}
        for name, leading in axes.items():
            try:
                shape = np.broadcast_shapes(shape, leading)
            except ValueError:
                message = f"expected axes that broadcast with {shape}, got {leading}"
                raise InvalidInput(name, message) from None
        self.shape = shape
        self.numbers = {name: _flat(array, shape) for name, array in numbers.items()}
        self.vectors = {name: _flat(array, (*shape, 3), 3) for name, array in vectors.items()}

    def pair(self, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Both bodies' numbers or vectors of a name."""
        of = self.numbers if f"{name}1" in self.numbers else self.vectors
        return of[f"{name}1"], of[f"{name}2"]

    def shaped(self, found: NDArray[np.float64], *tail: int) -> NDArray[np.float64]:
        """Results with the axes of what they are of; a number where there are none."""
        return found.reshape((*self.shape, *tail))[()]


def _flat(array: NDArray[np.float64], shape: tuple[int, ...], row: int = 1) -> NDArray[np.float64]:
    """One row if there is one, else all of them."""
    return np.ascontiguousarray(array if array.size == row else np.broadcast_to(array, shape)).ravel()
