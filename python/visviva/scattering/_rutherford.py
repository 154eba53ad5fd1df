"""Scattering by a Coulomb center V = k/r in closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import positive
from visviva._keywords import known_keywords, one_of
from visviva.errors import InvalidInput
from visviva.potentials import Coulomb
from visviva.scattering._arguments import evaluate

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential

_FRAMES = ("cm", "lab", "recoil")


@known_keywords
def rutherford_angle(potential: Potential, *, energy: float, impact_parameter: ArrayLike) -> NDArray[np.float64]:
    """Deflection by a Coulomb center, 2 atan(k / 2Eb).

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Coulomb
        V = k/r.
    energy : float
        Of relative motion, ½μu².
    impact_parameter : array_like
        Not negative.

    Returns
    -------
    ndarray
        Positive for repulsion, negative for attraction; ±π head-on. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For another potential, an energy that is not positive, or a negative impact parameter.

    References
    ----------
    E. Rutherford, Phil. Mag. 21 (1911) 669; L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §19.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_angle(vv.potentials.Coulomb(0.7), energy=1.3, impact_parameter=[0.0, 0.9])
    array([3.14159265, 0.58134496])
    """
    half = _half_distance(potential, energy)
    return evaluate("rutherford_deflection", "impact_parameter", impact_parameter, np.inf, half_distance=half)


@known_keywords
def rutherford_closest_approach(
    potential: Potential, *, energy: float, impact_parameter: ArrayLike
) -> NDArray[np.float64]:
    """Distance of closest approach to a Coulomb center, κ + √(κ² + b²) with κ = k/2E.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Coulomb
        V = k/r.
    energy : float
        Of relative motion, ½μu².
    impact_parameter : array_like
        Not negative.

    Returns
    -------
    ndarray
        Without cancellation for attraction. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        As `rutherford_angle`.

    References
    ----------
    E. Rutherford, Phil. Mag. 21 (1911) 669; L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §19.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_closest_approach(vv.potentials.Coulomb(0.7), energy=1.3, impact_parameter=[0.9])
    array([1.20863761])
    """
    half = _half_distance(potential, energy)
    return evaluate("rutherford_closest_approach", "impact_parameter", impact_parameter, np.inf, half_distance=half)


@known_keywords
def rutherford_impact_parameter(potential: Potential, *, energy: float, angle: ArrayLike) -> NDArray[np.float64]:
    """Impact parameter of a scattering angle, |k|/2E · cot(ψ/2).

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Coulomb
        V = k/r.
    energy : float
        Of relative motion, ½μu².
    angle : array_like
        Scattering angles |ψ| in the center-of-mass frame, in [0, π].

    Returns
    -------
    ndarray
        Infinite at angle 0. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For another potential, an energy that is not positive, or an angle outside [0, π].

    References
    ----------
    E. Rutherford, Phil. Mag. 21 (1911) 669; L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §19.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_impact_parameter(vv.potentials.Coulomb(0.7), energy=1.3, angle=[0.58134496182639963])
    array([0.9])
    """
    half = _half_distance(potential, energy)
    return evaluate("rutherford_impact_parameter", "angle", angle, np.pi, half_distance=half)


@known_keywords
def rutherford_cross_section(
    potential: Potential,
    *,
    energy: float,
    angle: ArrayLike,
    frame: Literal["cm", "lab", "recoil"] = "cm",
    mass_ratio: float | None = None,
) -> NDArray[np.float64]:
    """Differential cross section dσ/dΩ of Rutherford scattering.

    Units: energies and lengths are those of the potential, angles in radians.

    Parameters
    ----------
    potential : Coulomb
        V = k/r; the sign of k does not matter.
    energy : float
        Of relative motion, ½μu² = beam energy · m₂/(m₁ + m₂).
    angle : array_like
        In [0, π]; in [0, π/2] for recoils.
    frame : {"cm", "lab", "recoil"}
        What the angle is: of the center-of-mass frame, of the projectile in the laboratory, or of the target there.
    mass_ratio : float, optional
        m₁/m₂; needed for ``"lab"``.

    Returns
    -------
    ndarray
        Area per steradian: (k/4E)² / sin⁴(ψ/2), with the jacobian of the frame, both branches together. Infinite at
        angle 0 (90° for recoils); 0 where no projectile goes. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For another potential, an energy or ratio that is not positive, or an angle out of range.

    References
    ----------
    E. Rutherford, Phil. Mag. 21 (1911) 669; L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §19.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_cross_section(vv.potentials.Coulomb(1.0), energy=1.0, angle=[0.6], frame="lab",
    ...                                        mass_ratio=1.0)
    array([2.02990831])
    """
    one_of("frame", frame, _FRAMES)
    if frame == "lab" and mass_ratio is None:
        raise InvalidInput("mass_ratio", "expected m1/m2, which the laboratory frame needs, got None")
    half = _half_distance(potential, energy)
    limit = np.pi / 2.0 if frame == "recoil" else np.pi
    ratio = 1.0 if mass_ratio is None else mass_ratio
    return evaluate(f"rutherford_{frame}", "angle", angle, limit, half_distance=half, mass_ratio=ratio)


def _half_distance(potential: object, energy: object) -> float:
    if not isinstance(potential, Coulomb):
        raise InvalidInput("potential", f"expected a Coulomb potential, got {potential!r}")
    return _core.rutherford_half_distance(potential.k, positive("energy", energy))
