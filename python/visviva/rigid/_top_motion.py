"""The motion of a heavy top: angles, what follows from them, and its pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.rigid._euler import angular_velocity_from_euler, quaternion_from_euler
from visviva.rigid._orientation import rotate, rotate_back

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from visviva.rigid._heavy_top import HeavyTop


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True, repr=False)
class TopMotion(Record):
    """The states of a heavy top; what `HeavyTop.solve` returns.

    Of a single time, arrays have no axis over the times. All are read-only.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    top : HeavyTop
        Whose motion it is.
    t : ndarray, shape (T,)
        The times, as given.
    theta, phi, psi : ndarray, shape (T,)
        Euler's angles: θ in [0, π]; φ and ψ without jumps of 2π. Where the axis goes through the vertical itself, φ
        jumps by π, and ψ with it.
    theta_dot, phi_dot, psi_dot : ndarray, shape (T,)
        Their rates.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.7.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
    >>> motion = top.solve(np.linspace(0.0, 3.0, 301), theta=0.3, psi_dot=50.0)
    >>> motion.theta.shape, round(motion.theta.min(), 9)
    ((301,), np.float64(0.3))
    """

    top: HeavyTop
    t: NDArray[np.float64]
    theta: NDArray[np.float64]
    phi: NDArray[np.float64]
    psi: NDArray[np.float64]
    theta_dot: NDArray[np.float64]
    phi_dot: NDArray[np.float64]
    psi_dot: NDArray[np.float64]

    @property
    def orientation(self) -> NDArray[np.float64]:
        """Quaternions (x, y, z, w) from the body, whose third axis is the top's, to space, shape (T, 4).

        Without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.orientation.shape
        (2, 4)
        """
        return quaternion_from_euler(self._angles)

    @property
    def axis(self) -> NDArray[np.float64]:
        """The top's axis in space, shape (T, 3), without dimension: (sin θ sin φ, −sin θ cos φ, cos θ).

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.axis.round(6)
        array([[ 0.      , -0.29552 ,  0.955336],
               [ 0.127091, -0.29441 ,  0.947191]])
        """
        sine = np.sin(self.theta)
        return np.stack([sine * np.sin(self.phi), -sine * np.cos(self.phi), np.cos(self.theta)], axis=-1)

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """The angular velocity along the body's axes, shape (T, 3), in radians per time.

        Its last component is the spin ω₃.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.angular_velocity[:, 2].round(12)
        array([50., 50.])
        """
        return angular_velocity_from_euler(self._angles, self._rates)

    @property
    def body_angular_momentum(self) -> NDArray[np.float64]:
        """The angular momentum about the fixed point, along the body's axes, shape (T, 3).

        In the caller's units.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.body_angular_momentum[:, 2].round(12)  # C ω₃
        array([50., 50.])
        """
        return self.angular_velocity * [self.top.A, self.top.A, self.top.C]

    @property
    def angular_momentum(self) -> NDArray[np.float64]:
        """The angular momentum about the fixed point in space, shape (T, 3), in the caller's units.

        Its last component is p_φ, which stays.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.angular_momentum[:, 2].round(9)
        array([47.76682446, 47.76682446])
        """
        return rotate(self.orientation, self.body_angular_momentum)

    @property
    def energy(self) -> NDArray[np.float64]:
        """Kinetic and potential energy, shape (T,), in the caller's units.

        The latter is 0 at the horizontal; both together are always the same, but for rounding.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.energy.round(9)
        array([1269.10672978, 1269.10672978])
        """
        kinetic = 0.5 * (self.body_angular_momentum * self.angular_velocity).sum(axis=-1)
        value: NDArray[np.float64] = kinetic + self.top.mass * self.top.g * self.top.R * np.cos(self.theta)
        return value

    @property
    def casimir(self) -> NDArray[np.float64]:
        """The angular momentum along the vertical γ as the body sees both, shape (T,), in the caller's units.

        The Casimir function L·γ = p_φ.

        Examples
        --------
        >>> import visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> motion = top.solve([0.0, 1.0], theta=0.3, psi_dot=50.0)
        >>> motion.casimir.round(9)
        array([47.76682446, 47.76682446])
        """
        vertical = rotate_back(self.orientation, [0.0, 0.0, 1.0])
        value: NDArray[np.float64] = (self.body_angular_momentum * vertical).sum(axis=-1)
        return value

    @property
    def _angles(self) -> NDArray[np.float64]:
        return np.stack([self.phi, self.theta, self.psi], axis=-1)

    @property
    def _rates(self) -> NDArray[np.float64]:
        return np.stack([self.phi_dot, self.theta_dot, self.psi_dot], axis=-1)

    def plot(
        self, kind: Literal["nutation", "theta", "effective_potential"] = "nutation", *, ax: Axes | None = None
    ) -> Figure:
        """Draw the motion, as a matplotlib Figure.

        Parameters
        ----------
        kind : {"nutation", "theta", "effective_potential"}
            Where the axis points, on the unit sphere, with the two circles that it nods between; its angle from the
            vertical against time; or the potential in which it nods, with the energy.
        ax : matplotlib.axes.Axes, optional
            Where, of three dimensions where the picture has them; a figure of its own if not given.

        Returns
        -------
        matplotlib.figure.Figure
            With one panel; that of ``ax`` if that is given.

        Raises
        ------
        visviva.InvalidInput
            For another kind, axes of other dimensions, fewer than two times, or no matplotlib.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> top = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
        >>> figure = top.solve(np.linspace(0.0, 3.0, 301), theta=0.3, psi_dot=50.0).plot()
        >>> figure.axes[0].get_title()
        'nutation'
        """
        from visviva.rigid._pictures import plot_top

        return plot_top(self, kind, ax)

    def __repr__(self) -> str:
        return f"TopMotion(t of shape {self.t.shape})"
