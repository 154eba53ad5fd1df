"""What a heavy top may do steadily: sleep upright, or go round at one angle, with small nutations about that.

Source: Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.7.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from visviva import _core
from visviva._arrays import number
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._nutation import SteadyPrecession
from visviva.rigid._top_potential import weight

if TYPE_CHECKING:
    from visviva.rigid._heavy_top import HeavyTop

__all__ = ["Steady", "from_the_vertical"]


def from_the_vertical(theta: float) -> float:
    angle = number("theta", theta)
    if not 0.0 <= angle <= np.pi:
        raise InvalidInput("theta", f"expected an angle in [0, π], got {angle}")
    return angle


@known_keywords
class Steady:
    """A base of `HeavyTop`: its motions at one angle from the vertical."""

    __slots__ = ()

    A: float
    C: float
    mass: float
    g: float
    R: float

    @property
    def _numbers(self) -> tuple[float, float, float, float, float]:
        return self.A, self.C, self.mass, self.g, self.R

    @property
    def sleeping_threshold(self) -> float:
        """The spin above which the top stays upright, (C ω₃)² = 4 A M g R, in radians per time."""
        return _core.top_sleeping_threshold(self._numbers)

    def least_spin(self, theta: float) -> float:
        """Give the least spin of a steady precession at an angle: 2√(A M g R cos θ)/C, and 0 from the horizontal down.

        Units: angles in radians, rates in radians per time.

        Parameters
        ----------
        theta : float
            Angle of the axis from the vertical.

        Returns
        -------
        float
            Radians per unit of time.

        Raises
        ------
        InvalidInput
            For an angle outside [0, π], NaN or infinity.

        References
        ----------
        Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.7.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0).least_spin(2.0)
        0.0
        """
        return _core.top_least_spin(self._numbers, from_the_vertical(theta))

    def steady_precession(self, theta: float, spin: float) -> SteadyPrecession:
        """Give both rates of steady precession: A cos θ Ω² − C ω₃ Ω + M g R = 0.

        Units: angles in radians, rates in radians per time.

        Parameters
        ----------
        theta : float
            Angle of the axis from the vertical; beyond π/2 the top hangs.
        spin : float
            ω₃, of either sign.

        Returns
        -------
        SteadyPrecession
            ``slow`` and ``fast``; of a hanging top they have opposite signs.

        Raises
        ------
        InvalidInput
            For a spin below `least_spin`.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> round(top.steady_precession(2.4, 50.0).fast, 12)
        -13.950126683391
        """
        rates, _ = self._precessions(theta, spin)
        return SteadyPrecession(*rates)

    def weak_torque_precession(self, spin: float) -> float:
        """Give the rate M g R/(C ω₃) at which a fast top goes round, at any angle.

        It is the limit of the slow steady precession for (C ω₃)² ≫ A M g R, off by about A M g R cos θ/(C ω₃)² of
        itself; see `steady_precession` for the rate itself.

        Units: angles in radians, rates in radians per time.

        Parameters
        ----------
        spin : float
            ω₃, of either sign.

        Returns
        -------
        float
            Radians per unit of time.

        Raises
        ------
        InvalidInput
            For a spin of 0.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> top.weak_torque_precession(500.0), round(top.steady_precession(0.3, 500.0).slow, 6)
        (0.04, 0.040015)
        """
        own = number("spin", spin)
        if own == 0.0:
            raise InvalidInput("spin", "expected a top that spins, got 0.0")
        return weight(cast("HeavyTop", self)) / self.C / own

    def nutation_frequency(self, theta: float, spin: float) -> SteadyPrecession:
        """Give the frequencies of small nutations about the slow and the fast steady precession.

        Units: angles in radians, rates in radians per time.

        Parameters
        ----------
        theta : float
            Angle of the axis from the vertical.
        spin : float
            ω₃, of either sign.

        Returns
        -------
        SteadyPrecession
            ``slow`` and ``fast``: the frequency about each.

        Raises
        ------
        InvalidInput
            As `steady_precession`.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> round(top.nutation_frequency(0.3, 50.0).slow, 9)
        9.204877599
        """
        _, frequencies = self._precessions(theta, spin)
        return SteadyPrecession(*frequencies)

    def _precessions(self, theta: float, spin: float) -> tuple[list[float], list[float]]:
        return _core.top_steady_precession(self._numbers, from_the_vertical(theta), number("spin", spin))
