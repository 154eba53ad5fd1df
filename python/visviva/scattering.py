"""Scattering of a beam by a Coulomb centre V = k/r: closed forms, two-body kinematics, Monte Carlo.

Angles are in radians. ``energy`` is that of relative motion, ½μu²; ``beam_energy`` is the projectile's in the
laboratory, where the target is at rest. ``mass_ratio`` is m₁/m₂, projectile over target. The functions of one array
keep its shape.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive
from visviva._keywords import did_you_mean, known_keywords
from visviva._monte_carlo import monte_carlo
from visviva._tally import Beam, CrossSection, MonteCarlo, Tally
from visviva.errors import InvalidInput
from visviva.potentials import Coulomb

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential

__all__ = [
    "Beam",
    "CrossSection",
    "MonteCarlo",
    "Tally",
    "cm_angle",
    "energy_transfer",
    "lab_angle",
    "monte_carlo",
    "recoil_angle",
    "rutherford_angle",
    "rutherford_closest_approach",
    "rutherford_cross_section",
    "rutherford_impact_parameter",
]

_FRAMES = ("cm", "lab", "recoil")


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
    return _evaluate("lab_angle", "cm_angle", cm_angle, np.pi, mass_ratio=mass_ratio)


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
    return _evaluate("recoil_angle", "cm_angle", cm_angle, np.pi)


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
    return _evaluate("energy_transfer", "cm_angle", cm_angle, np.pi, mass_ratio=mass_ratio)


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
        _evaluate("cm_angle", "lab_angle", lab_angle, np.pi, mass_ratio=mass_ratio),
        _evaluate("second_cm_angle", "lab_angle", lab_angle, np.pi, mass_ratio=mass_ratio),
    )


@known_keywords
def rutherford_angle(potential: Potential, *, energy: float, impact_parameter: ArrayLike) -> NDArray[np.float64]:
    """Deflection by a Coulomb centre, 2 atan(k / 2Eb).

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
        Positive for repulsion, negative for attraction; ±π head-on.

    Raises
    ------
    InvalidInput
        For another potential, an energy that is not positive, or a negative impact parameter.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_angle(vv.potentials.Coulomb(0.7), energy=1.3, impact_parameter=[0.0, 0.9])
    array([3.14159265, 0.58134496])
    """
    half = _half_distance(potential, energy)
    return _evaluate("rutherford_deflection", "impact_parameter", impact_parameter, np.inf, half_distance=half)


@known_keywords
def rutherford_closest_approach(
    potential: Potential, *, energy: float, impact_parameter: ArrayLike
) -> NDArray[np.float64]:
    """Distance of closest approach to a Coulomb centre, κ + √(κ² + b²) with κ = k/2E.

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
        Without cancellation for attraction.

    Raises
    ------
    InvalidInput
        As `rutherford_angle`.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_closest_approach(vv.potentials.Coulomb(0.7), energy=1.3, impact_parameter=[0.9])
    array([1.20863761])
    """
    half = _half_distance(potential, energy)
    return _evaluate("rutherford_closest_approach", "impact_parameter", impact_parameter, np.inf, half_distance=half)


@known_keywords
def rutherford_impact_parameter(potential: Potential, *, energy: float, angle: ArrayLike) -> NDArray[np.float64]:
    """Impact parameter of a scattering angle, |k|/2E · cot(ψ/2).

    Parameters
    ----------
    potential : Coulomb
        V = k/r.
    energy : float
        Of relative motion, ½μu².
    angle : array_like
        Scattering angles |ψ| in the centre-of-mass frame, in [0, π].

    Returns
    -------
    ndarray
        Infinite at angle 0.

    Raises
    ------
    InvalidInput
        For another potential, an energy that is not positive, or an angle outside [0, π].

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_impact_parameter(vv.potentials.Coulomb(0.7), energy=1.3, angle=[0.58134496182639963])
    array([0.9])
    """
    half = _half_distance(potential, energy)
    return _evaluate("rutherford_impact_parameter", "angle", angle, np.pi, half_distance=half)


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

    Parameters
    ----------
    potential : Coulomb
        V = k/r; the sign of k does not matter.
    energy : float
        Of relative motion, ½μu² = beam energy · m₂/(m₁ + m₂).
    angle : array_like
        In [0, π]; in [0, π/2] for recoils.
    frame : {"cm", "lab", "recoil"}
        What the angle is: of the centre-of-mass frame, of the projectile in the laboratory, or of the target there.
    mass_ratio : float, optional
        m₁/m₂; needed for ``"lab"``.

    Returns
    -------
    ndarray
        Area per steradian: (k/4E)² / sin⁴(ψ/2), with the jacobian of the frame, both branches together. Infinite at
        angle 0 (90° for recoils); 0 where no projectile goes.

    Raises
    ------
    InvalidInput
        For another potential, an energy or ratio that is not positive, or an angle out of range.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.rutherford_cross_section(vv.potentials.Coulomb(1.0), energy=1.0, angle=[0.6], frame="lab",
    ...                                        mass_ratio=1.0)
    array([2.02990831])
    """
    if frame not in _FRAMES:
        hint = did_you_mean(str(frame), _FRAMES)
        raise InvalidInput("frame", f"expected one of {', '.join(_FRAMES)}, got {frame!r}{hint}")
    if frame == "lab" and mass_ratio is None:
        raise InvalidInput("mass_ratio", "expected m1/m2, which the laboratory frame needs, got None")
    half = _half_distance(potential, energy)
    limit = np.pi / 2.0 if frame == "recoil" else np.pi
    ratio = 1.0 if mass_ratio is None else mass_ratio
    return _evaluate(f"rutherford_{frame}", "angle", angle, limit, half_distance=half, mass_ratio=ratio)


def _half_distance(potential: object, energy: object) -> float:
    if not isinstance(potential, Coulomb):
        raise InvalidInput("potential", f"expected a Coulomb potential, got {potential!r}")
    return _core.rutherford_half_distance(potential.k, positive("energy", energy))


def _evaluate(
    function: str,
    name: str,
    values: object,
    limit: float,
    *,
    half_distance: float = 0.0,
    mass_ratio: object = 1.0,
) -> NDArray[np.float64]:
    """Check an array within [0, limit] and evaluate one of the core's functions on it."""
    array = float_array(name, values, None)
    wrong = (array < 0.0) | (array > limit)
    if wrong.any():
        bound = {np.pi: "[0, π]", np.pi / 2.0: "[0, π/2]"}.get(limit, "[0, ∞)")
        raise InvalidInput(name, f"expected numbers in {bound}, got {array[wrong][0]}")
    ratio = positive("mass_ratio", mass_ratio)
    result = _core.scattering_function(function, half_distance, ratio, array.ravel()).reshape(array.shape)
    return result[()]


def __dir__() -> list[str]:
    return list(__all__)
