"""Arguments that are checked and broadcast against each other, and functions of them evaluated by the core."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive, positive_array
from visviva._together import Together
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator

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
    array = angles(name, values, limit)
    ratio = positive("mass_ratio", mass_ratio)
    result = _core.scattering_function(function, half_distance, ratio, array.ravel()).reshape(array.shape)
    return result[()]


def angles(name: str, values: object, limit: float = np.pi) -> NDArray[np.float64]:
    """Check an array of any shape within [0, limit]."""
    array = float_array(name, values, None)
    wrong = (array < 0.0) | (array > limit)
    if wrong.any():
        bound = {np.pi: "[0, π]", np.pi / 2.0: "[0, π/2]"}.get(limit, "[0, ∞)")
        degrees = of_degrees(np.abs(array).max()) if limit <= np.pi else ""
        raise InvalidInput(name, f"expected numbers in {bound}, got {array[wrong][0]}{degrees}")
    return array


def of_degrees(angle: float) -> str:
    """Give what a refusal of an angle adds where it looks like one in degrees."""
    return "; angles are in radians: pass numpy.radians(…) of degrees" if np.pi < abs(angle) <= 360.0 else ""


@contextmanager
def in_radians(**angles: float | None) -> Iterator[None]:
    """Add what an angle in degrees lacks to the core's refusals of arguments by name."""
    try:
        yield
    except InvalidInput as refusal:
        angle = angles.get(refusal.argument)
        if angle is None or not (hint := of_degrees(angle)):
            raise
        raise InvalidInput(refusal.argument, refusal.message + hint) from None


def flat_broadcast(arguments: dict[str, NDArray[np.float64]]) -> tuple[list[NDArray[np.float64]], tuple[int, ...]]:
    """Numbers that broadcast, as flat arrays of one or of as many as the result has, and the result's shape."""
    given = Together(arguments, {})
    return list(given.numbers.values()), given.shape


def encounter(
    mass_ratio: object, q_value: object, beam_energy: object, products: object
) -> dict[str, NDArray[np.float64]]:
    """Check what a collision is told by; NaN stands for an energy or products that are not given."""
    released = float_array("q_value", q_value, None)
    nothing = np.array(np.nan)
    energy, third, fourth = nothing, nothing, nothing
    if beam_energy is not None:
        energy = positive_array("beam_energy", beam_energy)
    if products is not None:
        if not isinstance(products, tuple) or len(products) != 2:
            raise InvalidInput(
                "products", f"expected a tuple of two masses, in units of the target's, got {products!r}"
            )
        third, fourth = (positive_array("products", mass) for mass in products)
    if beam_energy is None and (products is not None or (released != 0.0).any()):
        what = "products" if products is not None else "q_value"
        raise InvalidInput("beam_energy", f"expected the projectile's energy, which {what} needs, got None")
    if mass_ratio is None:
        if products is not None or (released != 0.0).any():
            raise InvalidInput("mass_ratio", "expected m1/m2, which a Q-value or other products need, got None")
        mass_ratio = 1.0
    ratio = positive_array("mass_ratio", mass_ratio)
    return {"mass_ratio": ratio, "q_value": released, "beam_energy": energy, "third": third, "fourth": fourth}


def kinematic(
    function: str,
    name: str,
    values: NDArray[np.float64],
    mass_ratio: object,
    q_value: object,
    beam_energy: object,
    products: object,
) -> NDArray[np.float64]:
    """Evaluate one of the core's functions of an angle and a collision, over all that broadcasts."""
    if mass_ratio is None and "recoil" not in function:
        # Recoils of elastic collisions are the same of any masses.
        raise InvalidInput("mass_ratio", "expected m1/m2, got None")
    given = encounter(mass_ratio, q_value, beam_energy, products)
    (angle, ratio, released, energy, third, fourth), shape = flat_broadcast({name: values} | given)
    if 0 in shape:
        return np.empty(shape)
    found = _core.kinematics(function, angle, ratio, released, energy, (third, fourth))
    return found.reshape(shape)[()]
