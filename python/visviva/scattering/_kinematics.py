"""Two-body kinematics of elastic collisions with a target at rest: angles and energies of either frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._keywords import known_keywords
from visviva.scattering._arguments import evaluate

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def lab_angle(cm_angle: ArrayLike, *, mass_ratio: float) -> NDArray[np.float64]:
    """Laboratory angle of the projectile after an elastic collision.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the centre-of-mass frame, in [0, π].
    mass_ratio : float
        m₁/m₂.

    Returns
    -------
    ndarray
        tan θ₁ = sin ψ / (m₁/m₂ + cos ψ), with the right quadrant; in [0, π].

    Raises
    ------
    InvalidInput
        For an angle outside [0, π] or a ratio that is not positive.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> np.degrees(vv.scattering.lab_angle(np.pi / 2, mass_ratio=1.0)).round(12)
    np.float64(45.0)
    """
    return evaluate("lab_angle", "cm_angle", cm_angle, np.pi, mass_ratio=mass_ratio)


@known_keywords
def recoil_angle(cm_angle: ArrayLike) -> NDArray[np.float64]:
    """Laboratory angle of the target after the collision, (π − ψ)/2.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the centre-of-mass frame, in [0, π].

    Returns
    -------
    ndarray
        In [0, π/2].

    Raises
    ------
    InvalidInput
        For an angle outside [0, π].

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.recoil_angle([3.141592653589793])
    array([6.123234e-17])
    """
    return evaluate("recoil_angle", "cm_angle", cm_angle, np.pi)


@known_keywords
def energy_transfer(cm_angle: ArrayLike, *, mass_ratio: float) -> NDArray[np.float64]:
    """Fraction of the beam energy that the target takes, 4 m₁m₂/(m₁+m₂)² · sin²(ψ/2).

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the centre-of-mass frame, in [0, π].
    mass_ratio : float
        m₁/m₂.

    Returns
    -------
    ndarray
        In [0, 1].

    Raises
    ------
    InvalidInput
        For an angle outside [0, π] or a ratio that is not positive.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.scattering.energy_transfer([np.pi], mass_ratio=1.0)
    array([1.])
    """
    return evaluate("energy_transfer", "cm_angle", cm_angle, np.pi, mass_ratio=mass_ratio)


@known_keywords
def cm_angle(lab_angle: ArrayLike, *, mass_ratio: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centre-of-mass angles that lead to a laboratory angle of the projectile.

    Parameters
    ----------
    lab_angle : array_like
        In [0, π].
    mass_ratio : float
        m₁/m₂.

    Returns
    -------
    tuple of ndarray
        θ₁ + asin(γ sin θ₁), and for γ = m₁/m₂ > 1 also π + θ₁ − asin(γ sin θ₁). NaN where there is no such angle:
        beyond asin(m₂/m₁) for γ > 1, beyond π/2 for γ = 1, and in the second array for γ ≤ 1.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π] or a ratio that is not positive.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> first, second = vv.scattering.cm_angle(np.radians(20.0), mass_ratio=2.0)
    >>> np.degrees([first, second]).round(9)
    array([ 63.1601778, 156.8398222])
    """
    return (
        evaluate("cm_angle", "lab_angle", lab_angle, np.pi, mass_ratio=mass_ratio),
        evaluate("second_cm_angle", "lab_angle", lab_angle, np.pi, mass_ratio=mass_ratio),
    )
