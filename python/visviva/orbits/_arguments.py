"""Broadcast the arguments of orbit functions for the core, and give its flat results their axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def broadcast(
    scalars: dict[str, ArrayLike], vectors: dict[str, ArrayLike]
) -> tuple[tuple[int, ...], list[NDArray[np.float64]], list[NDArray[np.float64]]]:
    """Check and broadcast the arguments; give the shape of the orbits and flat arrays, (N,) and (N, 3)."""
    numbers = {name: float_array(name, value, None) for name, value in scalars.items()}
    triples = {name: float_array(name, value, None) for name, value in vectors.items()}
    for name, value in triples.items():
        if value.shape[-1:] != (3,):
            raise InvalidInput(name, f"expected shape (…, 3), got {value.shape}")
    shape: tuple[int, ...] = ()
    came: list[str] = []
    for name, leading in [(n, x.shape) for n, x in numbers.items()] + [(n, x.shape[:-1]) for n, x in triples.items()]:
        try:
            shape = np.broadcast_shapes(shape, leading)
        except ValueError:
            message = f"expected axes that broadcast with {shape} of {', '.join(came)}, got {leading}"
            raise InvalidInput(name, message) from None
        came.append(name)
    flat = [np.broadcast_to(x, shape).ravel() for x in numbers.values()]
    return shape, flat, [np.broadcast_to(x, (*shape, 3)).reshape(-1, 3) for x in triples.values()]


def with_shape(values: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Give the values their axes; a number if there are none."""
    result: NDArray[np.float64] = values.reshape((*shape, *values.shape[1:]))[()]
    return result


def fields(columns: dict[str, NDArray[np.float64]], shape: tuple[int, ...]) -> dict[str, NDArray[np.float64]]:
    """Give each named column its axes."""
    return {name: with_shape(values, shape) for name, values in columns.items()}


def anomaly(
    name: str, argument: str, given: ArrayLike, eccentricity: ArrayLike, repulsive: object = False
) -> NDArray[np.float64]:
    """Evaluate one of the core's conversions, ``name``, on its broadcast arguments."""
    if not isinstance(repulsive, (bool, np.bool_)):
        raise InvalidInput("repulsive", f"expected True or False, got {repulsive!r}")
    shape, flat, _ = broadcast({argument: given, "eccentricity": eccentricity}, {})
    return with_shape(_core.orbit_anomaly(name, flat[0], flat[1], bool(repulsive)), shape)
