"""A symmetric top with a fixed point, in uniform gravity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number
from visviva._attributes_elsewhere import OF_TOPS, no_attribute
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._nutation import Nutation
from visviva.rigid._steady_precession import Steady, from_the_vertical
from visviva.rigid._top_motion import TopMotion
from visviva.rigid._top_potential import TopMomenta, effective_potential

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class HeavyTop(Record, Steady):
    """A symmetric top that turns about a fixed point on its axis, in uniform gravity.

    Angles are Euler's, z–x–z: θ from the vertical up to the axis, φ about the vertical, ψ about the axis. The spin is
    ω₃ = ψ̇ + φ̇ cos θ, which stays what it is.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    A, C : float
        Moments of inertia about the fixed point, across the axis and along it.
    mass, g, R : float
        Mass, acceleration of gravity, and distance of the center of mass from the fixed point.

    Raises
    ------
    InvalidInput
        For a number that is not positive, C larger than 2A, or no torque of gravity (R = 0 or g = 0), with which the
        body turns freely and none of these questions has an answer.

    Notes
    -----
    Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 5.7.

    Examples
    --------
    >>> import visviva as vv
    >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
    >>> top.sleeping_threshold
    20.0
    >>> top.steady_precession(0.3, spin=50.0)
    SteadyPrecession(slow=0.416578700573935, fast=10.050937314806921)
    """

    A: float
    C: float
    mass: float
    g: float
    R: float

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_TOPS)

    def __post_init__(self) -> None:
        for name in ("A", "C", "mass", "g", "R"):
            object.__setattr__(self, name, number(name, getattr(self, name)))
        _core.top_sleeping_threshold(self._numbers)

    def momenta(self, theta: float, *, psi_dot: float, phi_dot: float = 0.0) -> TopMomenta:
        """Give the momenta p_φ = A φ̇ sin²θ + p_ψ cos θ and p_ψ = C (ψ̇ + φ̇ cos θ), which stay what they are.

        Units: those of the top; angles in radians.

        Parameters
        ----------
        theta : float
            Angle of the axis from the vertical, in [0, π].
        psi_dot, phi_dot : float
            Rates of Euler's angles.

        Returns
        -------
        TopMomenta

        Raises
        ------
        InvalidInput
            For an angle outside [0, π], NaN or infinity.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0).momenta(0.0, psi_dot=50.0)
        TopMomenta(p_phi=50.0, p_psi=50.0)
        """
        angle, spin, around = from_the_vertical(theta), number("psi_dot", psi_dot), number("phi_dot", phi_dot)
        sine, cosine = float(np.sin(angle)), float(np.cos(angle))
        along = self.C * (spin + around * cosine)
        return TopMomenta(self.A * around * sine * sine + along * cosine, along)

    def effective_potential(self, theta: ArrayLike, *, p_phi: float, p_psi: float) -> NDArray[np.float64]:
        """Give the potential in which the axis nods: (p_φ − p_ψ cos θ)²/(2A sin²θ) + M g R cos θ.

        The axis is where it does not exceed E′ = E − p_ψ²/(2C); `nutation` gives the ends of that range.

        Units: those of the top; angles in radians.

        Parameters
        ----------
        theta : array_like
            Angles of the axis from the vertical, in [0, π].
        p_phi, p_psi : float
            The momenta; see `momenta`.

        Returns
        -------
        ndarray
            Of the shape of `theta`; infinite at 0 unless the momenta are equal, and at π unless they are opposite.

        Raises
        ------
        InvalidInput
            For an angle outside [0, π], NaN or infinity.

        Notes
        -----
        Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. eq. (5.60).

        Examples
        --------
        Momenta that are equal let the axis through the vertical:

        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> top.effective_potential([0.0, 0.1], p_phi=30.0, p_psi=30.0).round(6).tolist()
        [20.0, 20.125459]
        """
        angles = float_array("theta", theta, None)
        if not ((angles >= 0.0) & (angles <= np.pi)).all():
            outside = angles[(angles < 0.0) | (angles > np.pi)][0]
            raise InvalidInput("theta", f"expected angles in [0, π], got {outside}")
        return effective_potential(self, angles, number("p_phi", p_phi), number("p_psi", p_psi))

    def nutation(self, theta: float, *, psi_dot: float, theta_dot: float = 0.0, phi_dot: float = 0.0) -> Nutation:
        """Give the nutation of a top from where it is and how it turns.

        Units: those of the top; angles in radians.

        Parameters
        ----------
        theta : float
            Angle of the axis from the vertical, in [0, π].
        psi_dot, theta_dot, phi_dot : float
            Rates of Euler's angles.

        Returns
        -------
        Nutation
            Its range, period and kind; roots of the cubic in double-double.

        Raises
        ------
        InvalidInput
            For an angle outside [0, π], NaN or infinity.

        Examples
        --------
        A top that is let go falls, and comes up again to a cusp:

        >>> import visviva as vv
        >>> found = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0).nutation(0.3, psi_dot=50.0)
        >>> found.kind, round(found.theta_min, 12), round(found.period, 12)
        ('cusp', 0.3, 0.682256015831)
        """
        rates = (number("theta_dot", theta_dot), number("phi_dot", phi_dot), number("psi_dot", psi_dot))
        found = _core.top_nutation(self._numbers, from_the_vertical(theta), *rates)
        low, high = found["theta"]
        one, two, three = found["roots"]
        return Nutation(
            theta_min=low,
            theta_max=high,
            period=found["period"],
            kind=found["kind"],
            roots=(one, two, three),
            turning=found["turning"],
        )

    def nutation_range(
        self, theta: float, *, psi_dot: float, theta_dot: float = 0.0, phi_dot: float = 0.0
    ) -> tuple[float, float]:
        """Give the least and the greatest angle from the vertical; see `nutation`.

        Parameters
        ----------
        theta : float
            Angle of the axis from the vertical, in [0, π].
        psi_dot, theta_dot, phi_dot : float
            Rates of Euler's angles, in radians per time.

        Returns
        -------
        tuple of float
            Radians.

        Raises
        ------
        InvalidInput
            As `nutation`.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> low, high = top.nutation_range(0.3, psi_dot=50.0)
        >>> round(low, 12), round(high, 12)
        (0.3, 0.326733714645)
        """
        found = self.nutation(theta, psi_dot=psi_dot, theta_dot=theta_dot, phi_dot=phi_dot)
        return found.theta_min, found.theta_max

    def solve(
        self,
        t: ArrayLike,
        *,
        theta: float,
        psi_dot: float,
        theta_dot: float = 0.0,
        phi_dot: float = 0.0,
        phi: float = 0.0,
        psi: float = 0.0,
    ) -> TopMotion:
        """Give the motion at any times, in closed form.

        Theta functions give the angles and their rates: each state costs the same, however far it is from the start,
        through the poles, on the separatrix, of a sleeping top and of one that does not spin.

        Units: those of the top; angles in radians.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            Times since the start, of either sign and in any order. Any other shape takes the place of (T,) in all that
            is given.
        theta : float
            Angle of the axis from the vertical at the start, in [0, π].
        psi_dot, theta_dot, phi_dot : float
            Rates of Euler's angles at the start. At θ = 0, φ̇ + ψ̇ alone matters, at π φ̇ − ψ̇.
        phi, psi : float, optional
            The other two angles at the start.

        Returns
        -------
        TopMotion
            With ``.theta``, ``.phi``, ``.psi``, their rates, ``.axis`` and ``.orientation``. The orientation is within
            1e-14 + 4 ε (|φ| + |ψ| + λ t) of the exact one, with λ the rate of nutation, wherever the start decides it:
            near the separatrix its own rounding is amplified.
            Rates are within 1e-14 of the largest of them, φ̇ and ψ̇ apart within that over sin θ.

        Raises
        ------
        InvalidInput
            For an angle outside [0, π], NaN or infinity, rates beyond 1e30 √(M g R/A), a start that is upright within
            1e-60 and yet not at rest there, or a time until which the turns cannot be counted.

        Notes
        -----
        Klein & Sommerfeld, *Über die Theorie des Kreisels* ch. VI; Whittaker, *Analytical Dynamics* § 73.

        Examples
        --------
        A top that is let go nods and goes round at the mean rate M g R/(C ω₃) = 0.4, nearly:

        >>> import numpy as np, visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> out = top.solve(np.array([0.0, 10.0, 1000.0]), theta=0.3, psi_dot=50.0)
        >>> out.phi.round(3)
        array([  0.   ,   4.2  , 416.468])
        """
        times = float_array("t", t, None)
        angles = (from_the_vertical(theta), number("phi", phi), number("psi", psi))
        rates = (number("theta_dot", theta_dot), number("phi_dot", phi_dot), number("psi_dot", psi_dot))
        found = _core.top_motion(self._numbers, angles, rates, times.ravel())
        columns = [np.ascontiguousarray(column).reshape(times.shape) for column in found.T]
        kept = times.copy()
        for array in (kept, *columns):
            array.flags.writeable = False
        one, two, three, one_dot, two_dot, three_dot = columns
        return TopMotion(
            top=self,
            t=kept,
            theta=one,
            phi=two,
            psi=three,
            theta_dot=one_dot,
            phi_dot=two_dot,
            psi_dot=three_dot,
        )
