"""The elements of orbits: found from states, and what follows from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._html import Sheet, Shown, as_text
from visviva._keywords import known_keywords
from visviva._text import table
from visviva.orbits._arguments import broadcast, fields, with_shape
from visviva.orbits._rows import OfOrbits

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from visviva.typing import ElementName


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class Elements(OfOrbits, Shown):
    """The elements of orbits about a fixed center, per unit mass; what :func:`elements` returns.

    Every attribute has the shape of the orbits asked for (a number for one orbit), vectors with a last axis of 3.
    Elements are equal if all of these are, NaN where NaN is.

    A circle, e = 0 to 27 digits, has its pericenter where the body is: its anomalies are 0. An orbit in the xy plane
    has its node at x: the argument of its pericenter is counted from there. A parabola has an infinite semi-major axis
    and period; its pericenter is its size. Radial motion has no plane, so its three angles are NaN.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    mu : ndarray
        Strength μ of the acceleration −μ r/|r|³, as given.
    angular_momentum : ndarray
        L = r×v.
    energy : ndarray
        v²/2 − μ/r.
    laplace_runge_lenz : ndarray
        A = v×L − μ r/|r|: towards the pericenter, of length |μ| e.
    hodograph_center, hodograph_radius : ndarray
        The velocities lie on a circle about this vector with the radius |μ|/L; radial motion has no
        center (NaN) and an infinite radius.
    eccentricity : ndarray
        e ≥ 0.
    semi_major_axis, semi_minor_axis : ndarray
        a = |μ/2E| and b = a√|1 − e²|, positive for hyperbolas too; infinite for a parabola.
    semi_latus_rectum : ndarray
        L²/|μ|.
    pericenter, apocenter : ndarray
        Least and greatest distance; the latter infinite if unbound.
    inclination : ndarray
        Angle of L from z in [0, π]; radial motion has no plane: NaN, as for the two angles below.
    node : ndarray
        Angle of the ascending node from x, in (−π, π]; 0 for an orbit in the xy plane.
    argument_of_pericenter : ndarray
        Angle from the node to the pericenter along the motion, in (−π, π].
    true_anomaly : ndarray
        Angle from the pericenter to the body, in (−π, π]; −π of what falls straight in.
    eccentric_anomaly : ndarray
        E of an ellipse in (−π, π], H of a hyperbola, D = tan(ν/2) of a parabola.
    mean_anomaly : ndarray
        E − e sin E, e sinh H ∓ H (+ for repulsion), or D + D³/3.
    time_since_pericenter : ndarray
        Since the nearest pericenter; negative before it.
    period : ndarray
        2π√(a³/μ); infinite if unbound.
    areal_rate : ndarray
        L/2, the area swept per time.
    turning_angle : ndarray
        The angle 2 arcsin(1/e) by which a hyperbola turns the velocity; π for a parabola, NaN if bound.
    longitude_of_ascending_node : ndarray
        `node`.
    longitude_of_pericenter, mean_longitude : ndarray
        ϖ = node + argument of pericenter, and ϖ + mean anomaly; both may be beyond π. So for every inclination;
        REBOUND has Ω − ω, and Ω − ω − M, of orbits that are retrograde (inclination above π/2).

    `to_xarray` and `to_pandas` have a row for each orbit: of a run's elements under its times and the names of the
    bodies (and the number of the copy), of others under their place in the arrays.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7–3.9; Murray & Dermott, *Solar System Dynamics*
    (1999), § 2.8.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.datasets.outer_solar_system().scene.run(t=[0.0, 1e4], method="dop853")
    >>> frame = out.elements(["Jupiter", "Saturn"], about="Sun").to_pandas(["semi_major_axis", "eccentricity"])
    >>> frame.loc[1e4].round(2).values.tolist()
    [[5.2, 0.05], [9.58, 0.05]]
    """

    mu: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]
    energy: NDArray[np.float64]
    laplace_runge_lenz: NDArray[np.float64]
    hodograph_center: NDArray[np.float64]
    hodograph_radius: NDArray[np.float64]
    eccentricity: NDArray[np.float64]
    semi_major_axis: NDArray[np.float64]
    semi_minor_axis: NDArray[np.float64]
    semi_latus_rectum: NDArray[np.float64]
    pericenter: NDArray[np.float64]
    apocenter: NDArray[np.float64]
    inclination: NDArray[np.float64]
    node: NDArray[np.float64]
    argument_of_pericenter: NDArray[np.float64]
    true_anomaly: NDArray[np.float64]
    eccentric_anomaly: NDArray[np.float64]
    mean_anomaly: NDArray[np.float64]
    time_since_pericenter: NDArray[np.float64]
    period: NDArray[np.float64]
    areal_rate: NDArray[np.float64]
    turning_angle: NDArray[np.float64]

    def __repr__(self) -> str:
        from visviva.orbits._elements_table import in_a_line

        return in_a_line(self)

    def __str__(self) -> str:
        from visviva.orbits._elements_table import is_few

        return table(self) if is_few(self) else as_text(self._sheet())

    def _sheet(self) -> Sheet:
        from visviva.orbits._elements_table import elements_table

        return elements_table(self)

    def __reduce__(self) -> tuple[Any, ...]:
        # A dataclass would leave behind what is no field: the times and names of the rows.
        own = {name: getattr(self, name) for name in type(self).__slots__}
        return labeled, (own, getattr(self, "_axes", {}))

    @property
    def longitude_of_ascending_node(self) -> NDArray[np.float64]:
        """`node`, of the shape of the orbits asked for, in radians.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.orbits.elements(1.0, [1.0, 0.5, 0.0], [0.0, 1.0, 0.25])
        >>> round(float(found.longitude_of_ascending_node), 9)
        0.463647609
        """
        return self.node

    @property
    def longitude_of_pericenter(self) -> NDArray[np.float64]:
        """Node + argument of pericenter, of the shape of the orbits asked for, in radians.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.orbits.elements(1.0, [1.0, 0.5, 0.0], [0.0, 1.0, 0.25])
        >>> round(float(found.longitude_of_pericenter), 9)
        -1.183869477
        """
        return self.node + self.argument_of_pericenter

    @property
    def mean_longitude(self) -> NDArray[np.float64]:
        """Longitude of pericenter + mean anomaly, of the shape of the orbits asked for, in radians.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.orbits.elements(1.0, [1.0, 0.5, 0.0], [0.0, 1.0, 0.25])
        >>> round(float(found.mean_longitude), 9)
        -0.454523801
        """
        return self.longitude_of_pericenter + self.mean_anomaly

    def state(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Give the position and velocity that these elements describe.

        Each to a few ulps of its length, also near e = 1, as far as the anomaly tells the place: near the apocenter of
        a long ellipse an ulp of π is one of √(μ/a) in the velocity. Where some elements were replaced and no longer
        agree with the others, the pericenter, e, the three angles and the true anomaly count.

        Units: those of the elements: lengths, and lengths over times.

        Returns
        -------
        position, velocity : ndarray, shape (…, 3)
            The leading axes are those of the orbits.

        Raises
        ------
        InvalidInput
            For radial motion, which these elements do not determine.

        Examples
        --------
        >>> import visviva as vv
        >>> found = vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])
        >>> position, velocity = found.state()
        >>> position.round(12) + 0.0, velocity.round(12) + 0.0
        (array([1., 0., 0.]), array([0. , 1.2, 0. ]))
        """
        needed = ("mu", "energy", "pericenter", "eccentricity", "inclination", "node", "argument_of_pericenter")
        # Infinite for a parabola, and perhaps left out: only the numbers above have to be finite.
        further = ("semi_major_axis", "semi_minor_axis", "true_anomaly", "eccentric_anomaly", "mean_anomaly")
        shape, flat, _ = broadcast({name: getattr(self, name) for name in needed}, {})
        flat += [np.broadcast_to(getattr(self, name), shape).ravel() for name in further]
        position, velocity = _core.orbit_state_again(flat)
        return position.reshape((*shape, 3)), velocity.reshape((*shape, 3))

    def plot(self, element: ElementName | None = None, *, ax: Axes | None = None) -> Figure:
        """Draw elements of a run against time, a line for each body.

        Angles are drawn in degrees; their lines break where they go round.

        Parameters
        ----------
        element : str, optional
            Any attribute that is one number; semi-major axis, eccentricity and inclination, a panel each, if not given.
        ax : matplotlib.axes.Axes, optional
            Where, with one `element`; a new figure if not given.

        Returns
        -------
        matplotlib.figure.Figure
            A new one, or that of `ax`.

        Raises
        ------
        InvalidInput
            For elements of other orbits than those of one run over time, or what is no such element; for three panels
            in one pair of axes; if matplotlib is not installed.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.datasets.outer_solar_system().scene
        >>> out = scene.run(t=np.linspace(0.0, 1e5, 200), method="dop853")
        >>> figure = out.elements(["Jupiter", "Saturn"], about="Sun").plot()
        >>> [axes.get_ylabel() for axes in figure.axes]
        ['semi-major axis', 'eccentricity', 'inclination [degrees]']
        """
        from visviva.orbits._pictures import plot_elements

        return plot_elements(self, element, ax)


def labeled(columns: Mapping[str, NDArray[np.float64]], axes: Mapping[str, NDArray[Any]]) -> Elements:
    """Elements that know what stands along their axes."""
    elements = Elements(**columns)
    elements._along(axes)
    return elements


@known_keywords
def elements(mu: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> Elements:
    """Find the orbital elements of states.

    Each is right to a few ulps times its own conditioning, also near e = 0 and e = 1: they are found in double-double.

    Units: μ is in length³ / time², in the caller's units of both; angles in radians.

    Parameters
    ----------
    mu : array_like
        Strength of the acceleration −μ r/|r|³: G(m₁ + m₂), negative for repulsion, not 0.
    position, velocity : array_like, shape (…, 3)
        State relative to the center.

    Returns
    -------
    Elements
        With the leading axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a wrong shape, NaN or infinity, a position at the center, or μ = 0, for which there is no conic.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7–3.9; Murray & Dermott, *Solar System Dynamics*
    (1999), § 2.8.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])
    >>> round(float(found.eccentricity), 12), round(float(found.apocenter), 12)
    (0.44, 2.571428571429)
    """
    shape, (mu_,), (position_, velocity_) = broadcast({"mu": mu}, {"position": position, "velocity": velocity})
    columns = _core.orbit_elements(mu_, position_, velocity_)
    return Elements(mu=with_shape(mu_.copy(), shape), **fields(columns, shape))
