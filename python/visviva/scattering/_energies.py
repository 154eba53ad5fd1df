"""Two-body kinematics with a target at rest: energies, and how far they reach."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._keywords import known_keywords, one_of
from visviva.errors import InvalidInput
from visviva.scattering._arguments import angles, encounter, flat_broadcast, kinematic

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def energy_transfer(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Part of the beam energy that the target takes.

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
        4 m₁m₂/(m₁+m₂)² · sin²(ψ/2) of an elastic collision, in [0, 1]. Of the shape of the arguments, broadcast.

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
    >>> vv.scattering.energy_transfer([np.pi], mass_ratio=1.0)
    array([1.])
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("energy_transfer", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def energy_kept(
    cm_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Part of the beam energy that the projectile has afterwards, without a subtraction from 1.

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
        1 + Q/E₀ less what the target takes. Of the shape of the arguments, broadcast.

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
    >>> vv.scattering.energy_kept(np.pi, mass_ratio=[0.5, 1.0]).round(12)
    array([0.11111111, 0.        ])
    """
    values = angles("cm_angle", cm_angle)
    return kinematic("energy_kept", "cm_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def kinematic_factor(
    lab_angle: ArrayLike,
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
    branch: Literal["fast", "slow"] = "fast",
) -> NDArray[np.float64]:
    """Part of the beam energy that the projectile has at a laboratory angle.

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
    branch : {"fast", "slow"}
        Which of the two energies, where a heavy projectile has two.

    Returns
    -------
    ndarray
        E₁/E₀; the kinematic factor of backscattering. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle beyond the greatest one, which the message gives; for ``'slow'`` where there is one energy only;
        else as `lab_angle`.

    References
    ----------
    W. K. Chu, J. W. Mayer, M.-A. Nicolet, *Backscattering Spectrometry* (1978), ch. 2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.scattering.kinematic_factor(np.pi, mass_ratio=4.001506179 / 196.923232301).round(7)  # alphas on gold
    np.float64(0.9219247)
    """
    one_of("branch", branch, ("fast", "slow"))
    values = angles("lab_angle", lab_angle)
    return kinematic(branch, "lab_angle", values, mass_ratio, q_value, beam_energy, products)


@known_keywords
def greatest_lab_angle(
    *,
    mass_ratio: ArrayLike,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Greatest laboratory angle of the projectile.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
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
        asin(m₂/m₁) of a heavy projectile; π where every angle is reached. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a ratio, energy or product that is not positive, an energy below the threshold, or shapes that do not
        broadcast.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §17; with a Q-value: R. D. Evans, *The Atomic Nucleus* (1955),
    ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> np.degrees(vv.scattering.greatest_lab_angle(mass_ratio=[0.5, 1.0, 2.0])).round(9)
    array([180.,  90.,  30.])
    >>> np.degrees(vv.scattering.greatest_lab_angle(mass_ratio=0.25, q_value=-1.0, beam_energy=1.26)).round(7)
    np.float64(20.8761026)
    """
    return kinematic("greatest_lab_angle", "angle", np.array(0.0), mass_ratio, q_value, beam_energy, products)


@known_keywords
def greatest_recoil_angle(
    *,
    mass_ratio: ArrayLike | None = None,
    q_value: ArrayLike = 0.0,
    beam_energy: ArrayLike | None = None,
    products: tuple[ArrayLike, ArrayLike] | None = None,
) -> NDArray[np.float64]:
    """Greatest laboratory angle of the target.

    Units: angles in radians; ratios and parts are without dimension, energies in one unit, any.

    Parameters
    ----------
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
        π/2 of an elastic collision. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a ratio, energy or product that is not positive, an energy below the threshold, or shapes that do not
        broadcast.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §17; with a Q-value: R. D. Evans, *The Atomic Nucleus* (1955),
    ch. 12 §2.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> np.degrees(vv.scattering.greatest_recoil_angle(mass_ratio=1.0))
    np.float64(90.0)
    """
    return kinematic("greatest_recoil_angle", "angle", np.array(0.0), mass_ratio, q_value, beam_energy, products)


@known_keywords
def threshold_energy(
    *, mass_ratio: ArrayLike, q_value: ArrayLike, products: tuple[ArrayLike, ArrayLike] | None = None
) -> NDArray[np.float64]:
    """Least beam energy of a collision that takes up energy.

    Units: the energy is in those of `q_value`; ratios are without dimension.

    Parameters
    ----------
    mass_ratio : array_like
        m₁/m₂.
    q_value : array_like
        Energy that is released, negative where it is taken up.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        −Q (m₃+m₄)/(m₃+m₄−m₁), which is −Q (m₁+m₂)/m₂ for unchanged masses; 0 for Q ≥ 0. Of the shape of the arguments,
        broadcast.

    Raises
    ------
    InvalidInput
        For a ratio or product that is not positive, or shapes that do not broadcast.

    References
    ----------
    R. D. Evans, *The Atomic Nucleus* (1955), ch. 12 §2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.threshold_energy(mass_ratio=0.25, q_value=[-1.0, 0.0, 1.0])
    array([1.25, 0.  , 0.  ])
    """
    return _special("threshold_energy", mass_ratio, q_value, products)


@known_keywords
def two_branch_energy(
    *, mass_ratio: ArrayLike, q_value: ArrayLike, products: tuple[ArrayLike, ArrayLike] | None = None
) -> NDArray[np.float64]:
    """Beam energy at which a laboratory angle begins, or ceases, to have two energies.

    There the projectile is as fast in the center-of-mass frame as the frame itself. A light projectile that takes up
    energy has two branches from the threshold to here; a heavy one that releases energy has them beyond.

    Units: the energy is in those of `q_value`; ratios are without dimension.

    Parameters
    ----------
    mass_ratio : array_like
        m₁/m₂.
    q_value : array_like
        Energy that is released, negative where it is taken up.
    products : tuple of two array_like, optional
        Masses of what projectile and target become, in units of m₂; unchanged by default.

    Returns
    -------
    ndarray
        Q m₄/(m₁ − m₄); NaN where there is no such energy. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a ratio or product that is not positive, or shapes that do not broadcast.

    References
    ----------
    R. D. Evans, *The Atomic Nucleus* (1955), ch. 12 §2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.two_branch_energy(mass_ratio=[0.25, 4.0], q_value=-1.0)
    array([1.33333333,        nan])
    """
    return _special("turning_energy", mass_ratio, q_value, products)


def _special(name: str, mass_ratio: object, q_value: object, products: object) -> NDArray[np.float64]:
    if mass_ratio is None:
        raise InvalidInput("mass_ratio", "expected m1/m2, got None")
    given = encounter(mass_ratio, q_value, 1.0, products)
    del given["beam_energy"]
    (ratio, released, third, fourth), shape = flat_broadcast(given)
    if 0 in shape:
        return np.empty(shape)
    return _core.special_energy(name, ratio, released, (third, fourth)).reshape(shape)[()]
