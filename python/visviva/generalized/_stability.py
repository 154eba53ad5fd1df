"""Whether small motions M ξ̈ + C ξ̇ + K ξ = 0 stay small, told also where they are fast and slow at once.

The one idea: with M positive definite and C that takes energy or none, gyroscopic or not, motions stay small where K
has no negative eigenvalue, and grow where it has an odd number of them (W. Thomson & P. G. Tait, N. G. Chetaev). How
many it has is known to the digits of each of its entries: rows and columns are divided by the roots of the diagonal
first (J. J. Sylvester's law of inertia), so no stiff spring hides a soft one. What is not coupled is judged alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._eigenvalues import are_simple, eigenvalues
from visviva.generalized._higher_orders import curvatures
from visviva.generalized._matrices import balanced_units

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["has_energy_of_rest", "is_stable"]

#: Eigenvalues whose real part is below so many times what they may be off are on the imaginary axis.
_UNSURE = 16.0
#: Singular values below this part of the largest are zero.
_LEVEL = 1e-12
#: Roundings of C, of which gyroscopic terms leave no more where they take each other away.
_ROUNDINGS = 8.0
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
    about = curvatures(stiffness, rounding) if has_energy_of_rest(mass, damping) else None
    if about is not None:
        negative = int((about.values < 0.0).sum())
        # Of an odd number the determinant of λ²M + λC + K changes its sign on the way from 0 to large λ.
        if negative == 0 or (negative % 2 and about.values.all()) or (damping == damping.T).all():
            return negative == 0
    values, unsure = eigenvalues(mass, damping, stiffness, rounding)
    grows = (values.real > _UNSURE * unsure).any()
    if grows or _is_pushed(np.linalg.solve(mass, stiffness).astype(np.float64)):
        return False
    on_the_axis = (np.abs(values.real) <= _UNSURE * unsure) & (values.imag > _UNSURE * unsure)
    return are_simple((mass, damping, stiffness), rounding, values[on_the_axis], _UNSURE * unsure[on_the_axis])


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


def has_energy_of_rest(mass: NDArray[np.float64], damping: NDArray[np.float64]) -> bool:
    """Whether motions have an energy, least at rest, that C leaves or takes: gyroscopic terms do no work."""
    zero = np.zeros_like(mass)
    works = damping / 2.0 + damping.T / 2.0
    works = np.where(np.abs(works) > _ROUNDINGS * np.finfo(float).eps * np.abs(damping), works, 0.0)
    of_mass, of_damping = curvatures(mass, zero), curvatures(works, zero)
    if of_mass is None or of_damping is None:
        return False
    return bool(of_mass.values.min() > 0.0 <= of_damping.values.min())
