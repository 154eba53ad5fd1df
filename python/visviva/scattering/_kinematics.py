"""Two-body kinematics with a target at rest: angles and jacobians of either frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import known_keywords
from visviva.scattering._arguments import angles, kinematic

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def lab_angle(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Laboratory angle of the projectile after a collision.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the center-of-mass frame, in [0, π].
    mass_ratio : array_like
        m₁/m₂.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        tan θ₁ = sin ψ / (γ + cos ψ), with the right quadrant; in [0, π]. γ is m₁/m₂, over √(1 + 2Q/μu²) with a Q-value.
        Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd ed., §3.11; with a Q-value: R. D. Evans, *The Atomic
    Nucleus* (1955), ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> np.degrees(vv.scattering.lab_angle(np.pi / 2, mass_ratio=1.0)).round(12)
    np.float64(45.0)
    >>> vv.scattering.lab_angle(np.pi, mass_ratio=[0.5, 2.0]).round(6)
    array([3.141593, 0.      ])
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("lab_angle", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def recoil_angle(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike | None = None,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Laboratory angle of the target after a collision, on the other side of the beam.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the center-of-mass frame, in [0, π].
    mass_ratio : array_like, optional
        m₁/m₂. Of no consequence, and not needed, without Q and products.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        (π − ψ)/2 of an elastic collision; in [0, π]. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §17; with a Q-value: R. D. Evans, *The Atomic Nucleus* (1955),
    ch. 12 §2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.recoil_angle([3.141592653589793])
    array([6.123234e-17])
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("recoil_angle", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def opening_angle(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Angle between projectile and target after a collision, θ₁ + θ₂.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the center-of-mass frame, in [0, π].
    mass_ratio : array_like
        m₁/m₂.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        In [0, π]; π/2 for equal masses and no Q, more for a light projectile, less for a heavy one. Of the shape of the
        arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §17; with a Q-value: R. D. Evans, *The Atomic Nucleus* (1955),
    ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> np.degrees(vv.scattering.opening_angle(1.1, mass_ratio=[0.25, 1.0, 4.0])).round(3)
    array([110.197,  90.   ,  69.803])
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("opening_angle", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def lab_jacobian(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Solid angle of the center-of-mass frame per solid angle of the projectile in the laboratory.

    A cross section in the laboratory is the one of the center-of-mass frame times this, summed over the branches.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the center-of-mass frame, in [0, π].
    mass_ratio : array_like
        m₁/m₂.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        dΩ/dΩ₁ = (1 + γ² + 2γ cos ψ)^(3/2) / |1 + γ cos ψ|; infinite at the greatest laboratory angle. Of the shape of
        the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd ed., §3.11; with a Q-value: R. D. Evans, *The Atomic
    Nucleus* (1955), ch. 12 §2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.lab_jacobian(1.2, mass_ratio=1.0).round(12)  # 4 cos θ₁
    np.float64(3.301342459639)
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("lab_jacobian", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def recoil_jacobian(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike | None = None,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Solid angle of the center-of-mass frame per solid angle of the target in the laboratory.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    cm_angle : array_like
        Scattering angles in the center-of-mass frame, in [0, π].
    mass_ratio : array_like, optional
        m₁/m₂. Of no consequence, and not needed, without Q and products.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        dΩ/dΩ₂, 4 cos θ₂ of an elastic collision. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §17; with a Q-value: R. D. Evans, *The Atomic Nucleus* (1955),
    ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.scattering.recoil_jacobian(np.pi)
    np.float64(4.0)
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("recoil_jacobian", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def cm_angle(
    lab_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Center-of-mass angles that lead to a laboratory angle of the projectile.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    lab_angle : array_like
        In [0, π].
    mass_ratio : array_like
        m₁/m₂.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    tuple of ndarray
        θ₁ + asin(γ sin θ₁), and for γ > 1 also π + θ₁ − asin(γ sin θ₁); γ is m₁/m₂, over √(1 + 2Q/μu²) with a Q-value.
        NaN where there is no such angle: beyond asin(1/γ) for γ > 1, beyond π/2 for γ = 1, and in the second array for
        γ ≤ 1. Each of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd ed., §3.11; with a Q-value: R. D. Evans, *The Atomic
    Nucleus* (1955), ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> first, second = vv.scattering.cm_angle(np.radians(20.0), mass_ratio=2.0)
    >>> np.degrees([first, second]).round(9)
    array([ 63.1601778, 156.8398222])
    """
    values = angles("lab_angle", lab_angle)
    given = (values, mass_ratio, q_value, beam_energy, products)
    return kinematic("cm_angle", "lab_angle", *given), kinematic("second_cm_angle", "lab_angle", *given)


@known_keywords
def cm_angle_from_recoil(
    recoil_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike | None = None,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Center-of-mass angles that lead to a laboratory angle of the target.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
    recoil_angle : array_like
        In [0, π].
    mass_ratio : array_like, optional
        m₁/m₂. Of no consequence, and not needed, without Q and products.
    q_value : array_like, optional
        Energy that is released (Q > 0) or taken up (Q < 0), in the unit of `beam_energy`.
    beam_energy : array_like, optional
        The projectile's in the laboratory; needed with a Q-value or with `products`.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    tuple of ndarray
        π − 2θ₂ of an elastic collision; with a Q-value there may be a second. NaN where there is no such angle. Each of
        the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle outside [0, π], a ratio, energy or product that is not positive, an energy below the threshold,
        which the message gives, or shapes that do not broadcast.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §17; with a Q-value: R. D. Evans, *The Atomic Nucleus* (1955),
    ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> first, second = vv.scattering.cm_angle_from_recoil(np.radians([30.0, 100.0]))
    >>> np.degrees(first).round(9), second
    (array([120.,  nan]), array([nan, nan]))
    """
    values = angles("recoil_angle", recoil_angle)
    given = (values, mass_ratio, q_value, beam_energy, products)
    first = kinematic("recoil_cm_angle", "recoil_angle", *given)
    return first, kinematic("second_recoil_cm_angle", "recoil_angle", *given)
