"""Averages over an elastic collision with a target at rest.

The one idea: the scattering is isotropic in the center-of-mass frame, so every energy transfer up to the greatest is as
likely, and all averages depend on the ratio of the masses alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import positive_array
from visviva._html import Record
from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Moderation(Record):
    """Averages over one elastic collision that is isotropic in the center-of-mass frame, of the shape of the ratios.

    Units: none: ratios and averages are without dimension.

    Attributes
    ----------
    greatest_transfer, mean_transfer : ndarray
        Part of the beam energy that a target takes: q = 4 m₁m₂/(m₁+m₂)² at most, q/2 on the average; every part between
        0 and q is as likely.
    least_kept : ndarray
        1 − q.
    mean_logarithmic_decrement : ndarray
        ⟨ln(E₀/E₁)⟩ = 1 + ((1 − q)/q) ln(1 − q).
    mean_cosine : ndarray
        ⟨cos θ₁⟩ in the laboratory: 2m₁/3m₂, or 1 − (m₂/m₁)²/3 for a heavy projectile.

    References
    ----------
    S. Glasstone, M. C. Edlund, *The Elements of Nuclear Reactor Theory* (1952), ch. VI.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.scattering.moderation(mass_ratio=1.0)  # neutrons in hydrogen
    >>> float(found.greatest_transfer), float(found.mean_transfer), float(found.mean_logarithmic_decrement)
    (1.0, 0.5, 1.0)
    """

    greatest_transfer: NDArray[np.float64]
    mean_transfer: NDArray[np.float64]
    least_kept: NDArray[np.float64]
    mean_logarithmic_decrement: NDArray[np.float64]
    mean_cosine: NDArray[np.float64]


@known_keywords
def moderation(*, mass_ratio: ArrayLike) -> Moderation:
    """Averages over one elastic collision that is isotropic in the center-of-mass frame.

    Units: none: ratios and averages are without dimension.

    Parameters
    ----------
    mass_ratio : array_like
        m₁/m₂.

    Returns
    -------
    Moderation
        Of the shape of the ratios.

    Raises
    ------
    InvalidInput
        For a ratio that is not positive.

    References
    ----------
    S. Glasstone, M. C. Edlund, *The Elements of Nuclear Reactor Theory* (1952), ch. VI.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.moderation(mass_ratio=1.0 / 12.0).mean_logarithmic_decrement.round(6)  # neutrons in graphite
    np.float64(0.157769)
    """
    ratio = positive_array("mass_ratio", mass_ratio)
    if ratio.size == 0:
        return Moderation(*(np.empty(ratio.shape) for _ in range(5)))
    return Moderation(*(column.reshape(ratio.shape)[()] for column in _core.moderation(ratio.ravel()).T))
