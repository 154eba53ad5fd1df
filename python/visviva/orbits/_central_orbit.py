"""One orbit in any central potential, at any time and at any angle."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.orbits._central import core_potentials, terms_of
from visviva.orbits._radial import RadialMotion, described_motion

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True, repr=False)
class CentralOrbit(Record):
    """An orbit in a central potential; what :func:`central_orbit` returns.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    potentials : tuple of Potential
        Those that are added.
    mass, energy, angular_momentum : float
        m, E = mv²/2 + V and l = m abs(r×v).
    motion : RadialMotion
        Turning points, radial period, apsidal angle, precession and kind of this orbit.
    time_since_pericenter, angle_since_pericenter : float
        At the start, from the nearest pericenter, with its sign; NaN of a circle, and where there is no pericenter.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> sun = vv.potentials.Coulomb(-1.0)
    >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.2, 0.0])
    >>> round(orbit.energy, 12), round(orbit.angular_momentum, 12)
    (-0.28, 1.2)
    """

    potentials: tuple[Potential, ...]
    mass: float
    energy: float
    angular_momentum: float
    motion: RadialMotion
    time_since_pericenter: float
    angle_since_pericenter: float
    _state: tuple[float, list[float], list[float]] = field(repr=False)
    _plane: NDArray[np.float64] = field(repr=False)

    @property
    def turning_points(self) -> tuple[float, float]:
        """Least and greatest distance, in the caller's units; see `RadialMotion`.

        Examples
        --------
        >>> import visviva as vv
        >>> sun = vv.potentials.Coulomb(-1.0)
        >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.2, 0.0])
        >>> [round(r, 9) for r in orbit.turning_points]
        [1.0, 2.571428571]
        """
        return float(self.motion.r_min), float(self.motion.r_max)

    @property
    def radial_period(self) -> float:
        """From one pericenter to the next, a time in the caller's units.

        Examples
        --------
        >>> import visviva as vv
        >>> sun = vv.potentials.Coulomb(-1.0)
        >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.2, 0.0])
        >>> round(orbit.radial_period, 9)
        14.99332061
        """
        return float(self.motion.radial_period)

    @property
    def apsidal_angle(self) -> float:
        """From pericenter to apocenter, in radians.

        Examples
        --------
        >>> import visviva as vv
        >>> sun = vv.potentials.Coulomb(-1.0)
        >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.2, 0.0])
        >>> round(orbit.apsidal_angle, 9)
        3.141592654
        """
        return float(self.motion.apsidal_angle)

    @property
    def precession(self) -> float:
        """By how much the pericenter moves on in a radial period, in radians.

        Examples
        --------
        >>> import visviva as vv
        >>> field = [vv.potentials.Coulomb(-1.0), vv.potentials.PowerLaw(-0.05, 2.0)]
        >>> orbit = vv.orbits.central_orbit(field, position=[9 / 13, 0.0, 0.0], velocity=[0.0, 13 / 9, 0.0])
        >>> round(orbit.precession, 9)
        0.339873537
        """
        return float(self.motion.precession)

    def position(self, t: ArrayLike) -> NDArray[np.float64]:
        """Give positions at times since the start, of either sign and in any order.

        Units: those of the orbit.

        Parameters
        ----------
        t : array_like, any shape
            Times.

        Returns
        -------
        ndarray, shape (…, 3)
            About the center; the leading axes are those of ``t``.

        Raises
        ------
        InvalidInput
            For NaN or infinity, a time after the body has reached a center or the end of a table, and an orbit that
            turns nowhere.
        ConvergenceError
            As `radial_motion`.

        Examples
        --------
        >>> import visviva as vv
        >>> field = vv.potentials.Plummer(-1.0, 0.5)
        >>> orbit = vv.orbits.central_orbit(field, position=[1.0, 0.0, 0.0], velocity=[0.0, 0.5, 0.0])
        >>> orbit.position([0.0, 2.0 * orbit.radial_period]).round(9)
        array([[ 1.        ,  0.        ,  0.        ],
               [-0.50801735,  0.86134684,  0.        ]])
        """
        places = self._places("t", t, angles=False)
        return self._vectors(places[..., 0], places[..., 1])

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Give velocities at times since the start; as `position`.

        Units: those of the orbit.

        Parameters
        ----------
        t : array_like
            Times since the start.

        Returns
        -------
        ndarray
            Of the shape of ``t`` and one axis of 3 more.

        Raises
        ------
        visviva.InvalidInput
            For NaN or infinity.
        visviva.ConvergenceError
            As `radial_motion`.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> sun = vv.potentials.Coulomb(-1.0)
        >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.0, 0.0])
        >>> orbit.velocity([0.0, np.pi / 2]).round(12) + 0.0
        array([[ 0.,  1.,  0.],
               [-1.,  0.,  0.]])
        """
        places = self._places("t", t, angles=False)
        radius, angle, outward = np.moveaxis(places, -1, 0)
        across = self.angular_momentum / (self.mass * radius)
        return self._vectors(outward, angle) + self._vectors(across, angle + 0.5 * np.pi)

    def angle(self, t: ArrayLike) -> NDArray[np.float64]:
        """Give the angle gone through since the start, not reduced to a turn; as `position`.

        Parameters
        ----------
        t : array_like
            Times since the start, in the units of the orbit.

        Returns
        -------
        ndarray
            Radians, of the shape of ``t``.

        Raises
        ------
        visviva.InvalidInput
            For NaN or infinity.
        visviva.ConvergenceError
            As `radial_motion`.

        Examples
        --------
        >>> import visviva as vv
        >>> sun = vv.potentials.Coulomb(-1.0)
        >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 1.0, 0.0])
        >>> orbit.angle([0.0, 1.0, 10.0]).round(12)  # a circle
        array([ 0.,  1., 10.])
        """
        return self._places("t", t, angles=False)[..., 1]

    def radius(self, angle: ArrayLike) -> NDArray[np.float64]:
        """Give the distance r(θ) at angles since the start: the path.

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
            For an angle that the orbit does not come to, and of a radial motion.
        ConvergenceError
            As `radial_motion`.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> orbit = vv.orbits.central_orbit(
        ...     vv.potentials.Coulomb(-1.0), position=[0.5, 0.0, 0.0], velocity=[0.0, 3.0**0.5, 0.0]
        ... )
        >>> orbit.radius([0.0, np.pi / 2, np.pi]).round(12)
        array([0.5 , 0.75, 1.5 ])
        """
        if self.angular_momentum == 0.0:
            raise InvalidInput("angle", "a radial motion has no path r(θ)")
        return self._places("angle", angle, angles=True)[..., 0]

    def _places(self, name: str, values: ArrayLike, *, angles: bool) -> NDArray[np.float64]:
        given = float_array(name, values, None)
        found = _core.central_places(core_potentials(self.potentials), self._state, given.ravel(), angles=angles)
        return found.reshape((*given.shape, 3))

    def _vectors(self, length: NDArray[np.float64], angle: NDArray[np.float64]) -> NDArray[np.float64]:
        turned: NDArray[np.float64] = (
            np.cos(angle)[..., None] * self._plane[0] + np.sin(angle)[..., None] * self._plane[1]
        )
        return length[..., None] * turned

    def plot(self, kind: Literal["orbit", "effective_potential"] = "orbit", *, ax: Axes | None = None) -> Figure:
        """Draw the orbit, or the effective potential with the energy and the turning points.

        Parameters
        ----------
        kind : {"orbit", "effective_potential"}
            What to draw.
        ax : matplotlib.axes.Axes, optional
            Where; a figure of its own if not given.

        Returns
        -------
        matplotlib.figure.Figure
            The caller's; pyplot's state is not touched.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed, and for another kind.

        Examples
        --------
        >>> import visviva as vv
        >>> sun = vv.potentials.Coulomb(-1.0)
        >>> orbit = vv.orbits.central_orbit(sun, position=[1.0, 0.0, 0.0], velocity=[0.0, 0.8, 0.0])
        >>> orbit.plot("effective_potential").axes[0].get_xlabel()
        'r'
        """
        from visviva.orbits._pictures import plot_orbit

        return plot_orbit(self, kind, ax)


@known_keywords
def central_orbit(
    potential: Potential | Sequence[Potential], *, position: ArrayLike, velocity: ArrayLike, mass: float = 1.0
) -> CentralOrbit:
    """Find the orbit through a state, in a central potential.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    position, velocity : array_like, shape (3,)
        State relative to the center.
    mass : float, optional
        m > 0.

    Returns
    -------
    CentralOrbit
        With its constants, and r, θ and the state at any time.

    Raises
    ------
    InvalidInput
        For a wrong shape, NaN or infinity, a mass that is not positive, or a position at the center.
    ConvergenceError
        As `radial_motion`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> field = [vv.potentials.Coulomb(-1.0), vv.potentials.PowerLaw(-0.05, 2.0)]
    >>> orbit = vv.orbits.central_orbit(field, position=[9 / 13, 0.0, 0.0], velocity=[0.0, 13 / 9, 0.0])
    >>> round(orbit.radial_period, 9), round(orbit.precession, 9)
    (6.179901372, 0.339873537)
    """
    terms = terms_of(potential)
    described = core_potentials(terms)
    m = positive("mass", mass)
    place, speed = float_array("position", position, (3,)), float_array("velocity", velocity, (3,))
    if not place.any():
        raise InvalidInput("position", "expected one that is not the center")
    state = (m, place.tolist(), speed.tolist())
    found, kind = _core.central_state(described, state)
    time, angle = found.pop("phase")
    return CentralOrbit(
        potentials=terms,
        mass=m,
        energy=found.pop("energy"),
        angular_momentum=found.pop("angular_momentum"),
        time_since_pericenter=time,
        angle_since_pericenter=angle,
        _state=state,
        _plane=np.array([found.pop("outward"), found.pop("across")]),
        motion=described_motion({name: np.float64(value) for name, value in found.items()}, np.array(kind)),
    )
