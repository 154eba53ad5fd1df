"""Whether small motions M ξ̈ + C ξ̇ + K ξ = 0 stay small, told also where they are fast and slow at once.

The one idea: with M positive definite and C that takes energy or none, motions stay small where K has no negative
eigenvalue (W. Thomson & P. G. Tait), and how many it has is known to the digits of each of its entries: rows and
columns are divided by the roots of the diagonal first (J. J. Sylvester's law of inertia), so no stiff spring hides a
soft one. What is not coupled is judged alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._eigenvalues import eigenvalues
from visviva.generalized._higher_orders import curvatures
from visviva.generalized._matrices import balanced_units

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._higher_orders import Curvatures

__all__ = ["is_stable", "level_and_held"]

#: Eigenvalues whose real part is below so many times what they may be off are on the imaginary axis.
_UNSURE = 16.0
#: Singular values below this part of the largest are zero.
_LEVEL = 1e-12
#: The cosine of directions that are at a right angle but for round-off.
_APART = 1e-7


def is_stable(
    mass: NDArray[np.float64],
    damping: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    rounding: NDArray[np.float64],
) -> bool:
    """Whether no small motion grows; one that neither grows nor returns counts. The rounding is that of K."""
    known = np.where(np.abs(stiffness) > rounding, stiffness, 0.0)
    return all(
        _block(*(matrix[np.ix_(block, block)] for matrix in (mass, damping, known, rounding)))
        for block in _blocks(np.abs(mass) + np.abs(damping) + np.abs(known))
    )


def _blocks(coupled: NDArray[np.float64]) -> list[NDArray[np.intp]]:
    """Give the coordinates that know each other, in groups."""
    reached = (coupled + coupled.T != 0.0) | np.eye(len(coupled), dtype=bool)
    for _ in range(len(coupled).bit_length()):
        reached = reached @ reached
    return [np.flatnonzero(row) for row in np.unique(reached, axis=0)]


def _block(
    mass: NDArray[np.float64],
    damping: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    rounding: NDArray[np.float64],
) -> bool:
    lowest = [_lowest(mass, np.zeros_like(mass)), _lowest(damping, np.zeros_like(mass)), _lowest(stiffness, rounding)]
    of_mass, of_damping, of_stiffness = lowest
    if of_mass is not None and of_damping is not None and of_stiffness is not None and of_mass > 0.0 <= of_damping:
        return of_stiffness >= 0.0
    values, unsure = eigenvalues(mass, damping, stiffness, rounding)
    grows = (values.real > _UNSURE * unsure).any()
    return not grows and not _is_pushed(np.linalg.solve(mass, stiffness).astype(np.float64))


def _is_pushed(stiffness: NDArray[np.float64]) -> bool:
    """Whether a displacement to which nothing returns forces one along which nothing does: of M⁻¹K, not symmetric.

    Such a motion grows as t², as that of a blade that is turned on an incline: what K takes to zero is then among what
    it leads to, and has no part along what is zero from the left.
    """
    units = balanced_units(stiffness[None])[0]
    left, sizes, right = np.linalg.svd(stiffness * units / units[:, None])
    level = sizes <= _LEVEL * sizes[0]
    if not level.any():
        return False
    along = np.linalg.svd(left[:, level].T @ right[level].T, compute_uv=False)
    return bool(along[-1] <= _APART)


def _lowest(matrix: NDArray[np.float64], rounding: NDArray[np.float64]) -> float | None:
    """Give an eigenvalue of the sign of the lowest one, 0 where that is round-off; nothing if it is not symmetric."""
    found = curvatures(matrix, rounding)
    return None if found is None else float(found.values.min())


def level_and_held(
    mass: NDArray[np.float64],
    damping: NDArray[np.float64],
    stiffness: NDArray[np.float64],
    rounding: NDArray[np.float64],
) -> Curvatures | None:
    """Give the curvatures of K, if it is level, and nothing turns: M is positive, and no terms are gyroscopic."""
    zero = np.zeros_like(mass)
    of_mass, of_damping = _lowest(mass, zero), _lowest(damping, zero)
    if of_mass is None or of_damping is None or not of_mass > 0.0 <= of_damping:
        return None
    found = curvatures(np.where(np.abs(stiffness) > rounding, stiffness, 0.0), rounding)
    return found if found is not None and found.values.min() == 0.0 else None
