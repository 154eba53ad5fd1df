"""Orbits under an inverse-square force and an inverse-cube one, in closed form."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number, positive
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True, repr=False)
class PrecessingConic(Record):
    """A conic that turns about the center, or a spiral; what :func:`precessing_conic` returns.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    beta_squared : float
        β² = 1 − mκ/l²: above 0 a conic in βθ, else a spiral.
    angular_momentum, energy : float
        l and E = mv²/2 − γ/r − κ/2r².
    eccentricity : float
        e of 1/r = (mγ/l²β²)(1 + e cos βθ), of γ < 0 with −1 + e cos βθ; NaN of a spiral.
    r_min, r_max : float
        Least and greatest distance; 0 of a spiral that ends in the center, infinity where it escapes.
    apsidal_angle, precession : float
        π/β and 2π(1/β − 1); NaN where the pericenter does not come again.
    radial_period : float
        2π√(ma³/γ) with a = (r_min + r_max)/2, whatever κ is; infinite where the pericenter does not come again.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7; Whittaker, *Analytical Dynamics*, 4th ed. (1937), §
    48 (Cotes' spirals).

    Examples
    --------
    >>> import visviva as vv
    >>> orbit = vv.orbits.precessing_conic(1.0, 1.0, 0.1, position=[9 / 13, 0, 0], velocity=[0.0, 13 / 9, 0.0])
    >>> round(orbit.beta_squared, 12), round(orbit.eccentricity, 12)
    (0.9, 0.3)
    """

    beta_squared: float
    angular_momentum: float
    energy: float
    eccentricity: float
    r_min: float
    r_max: float
    apsidal_angle: float
    precession: float
    radial_period: float
    _strengths: tuple[float, float] = field(repr=False)
    _state: tuple[float, list[float], list[float]] = field(repr=False)

    def radius(self, angle: ArrayLike) -> NDArray[np.float64]:
        """Give the distance r(θ) at angles since the start.

        Units: angles in radians, distances in those of the orbit.

        Parameters
        ----------
        angle : array_like
            Radians since the start.

        Returns
        -------
        ndarray
            Of the shape of ``angle``.

        Raises
        ------
        InvalidInput
            For an angle beyond an asymptote.

        Examples
        --------
        A spiral into the center:

        >>> import numpy as np, visviva as vv
        >>> spiral = vv.orbits.precessing_conic(1.0, 1.0, 2.0, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.0, 0.0])
        >>> spiral.radius([0.0, 2.0, 4.0]).round(9)
        array([1.        , 0.153271  , 0.01865099])
        """
        angles = float_array("angle", angle, None)
        _, radii = _core.central_inverse_cube(self._strengths, self._state, angles.ravel())
        if np.isnan(radii).any():
            beyond = float(angles.ravel()[np.isnan(radii)][0])
            raise InvalidInput("angle", f"expected angles within the asymptotes of the orbit, got {beyond!r}")
        return radii.reshape(angles.shape)


@known_keywords
def precessing_conic(
    mass: float, strength: float, cubic: float, *, position: ArrayLike, velocity: ArrayLike
) -> PrecessingConic:
    """Find the orbit under F = −γ/r² − κ/r³ through a state, in closed form.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    mass : float
        m > 0.
    strength : float
        γ: positive attracts.
    cubic : float
        κ: positive attracts.
    position, velocity : array_like, shape (3,)
        State relative to the center, not along each other.

    Returns
    -------
    PrecessingConic
        See there.

    Raises
    ------
    InvalidInput
        For a wrong shape, NaN or infinity, a mass that is not positive, and a radial motion.

    Notes
    -----
    The path equation u'' + β²u = mγ/l² is linear. Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.7;
    Whittaker, *Analytical Dynamics* §48 (Cotes' spirals).

    Examples
    --------
    >>> import visviva as vv
    >>> orbit = vv.orbits.precessing_conic(1.0, 1.0, 0.1, position=[9 / 13, 0, 0], velocity=[0.0, 13 / 9, 0.0])
    >>> round(orbit.radial_period, 12), round(orbit.precession, 12)
    (6.179901372065, 0.339873536684)
    """
    strengths = (number("strength", strength), number("cubic", cubic))
    m = positive("mass", mass)
    place, speed = float_array("position", position, (3,)), float_array("velocity", velocity, (3,))
    if not place.any():
        raise InvalidInput("position", "expected one that is not the center")
    state = (m, place.tolist(), speed.tolist())
    found, _ = _core.central_inverse_cube(strengths, state, np.empty(0))
    precession = 2.0 * (found["apsidal_angle"] - np.pi)
    return PrecessingConic(**found, precession=precession, _strengths=strengths, _state=state)
