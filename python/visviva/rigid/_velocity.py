"""How the points of a rigid body move, and the screw that it moves as."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva import _core
from visviva._html import brief_tuple
from visviva._keywords import known_keywords
from visviva.rigid._arguments import map_rows

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

_ORIGIN = (0.0, 0.0, 0.0)


@known_keywords
class ScrewAxis(NamedTuple):
    """The motion of a body at one time: a rotation about an axis and a velocity along it.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    point : ndarray, shape (…, 3)
        The point of the axis that is nearest to the base point.
    direction : ndarray, shape (…, 3)
        A unit vector along it: of the angular velocity, or of the velocity where there is none.
    rate : ndarray, shape (…)
        |ω|.
    speed : ndarray, shape (…)
        The velocity along the direction, which all points share.
    pitch : ndarray, shape (…)
        How far the body goes along the axis in one radian, ω·v/ω²; infinite where it does not turn.

    References
    ----------
    R. S. Ball, *A Treatise on the Theory of Screws* (1900).

    Examples
    --------
    >>> import visviva as vv
    >>> screw = vv.rigid.screw_axis([0.0, 0.0, 1.0], [0.0, 0.0, 2.0])
    >>> float(screw.rate), float(screw.speed), float(screw.pitch)
    (2.0, 1.0, 0.5)
    """

    point: NDArray[np.float64]
    direction: NDArray[np.float64]
    rate: NDArray[np.float64]
    speed: NDArray[np.float64]
    pitch: NDArray[np.float64]

    def __repr__(self) -> str:
        return brief_tuple(self)


@known_keywords
def velocity_at(
    point: ArrayLike, velocity: ArrayLike, angular_velocity: ArrayLike, about: ArrayLike = _ORIGIN
) -> NDArray[np.float64]:
    """Give the velocity of points of a rigid body, v + ω × (r − r₀).

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    point : array_like, shape (…, 3)
        Where, r.
    velocity : array_like, shape (…, 3)
        Of the base point.
    angular_velocity : array_like, shape (…, 3)
        The same for every base point.
    about : array_like, shape (…, 3)
        The base point r₀; the origin by default.

    Returns
    -------
    ndarray, shape (…, 3)
        Rounded once, wherever the origin is.

    Raises
    ------
    InvalidInput
        For NaN or infinity, another shape, axes that do not broadcast, or a velocity out of the range of float64.

    See Also
    --------
    screw_axis : the axis that the body turns about.

    Notes
    -----
    Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. § 4.9.

    Examples
    --------
    A wheel that rolls: below it is at rest, above it is twice as fast as its middle.

    >>> import visviva as vv
    >>> vv.rigid.velocity_at([[0, 0, -1], [0, 0, 1]], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0])
    array([[0., 0., 0.],
           [6., 0., 0.]])
    """
    motion = (("velocity", velocity, (3,)), ("angular_velocity", angular_velocity, (3,)), ("about", about, (3,)))
    return map_rows(_of_joined(_core.rigid_velocity), (3,), ("point", point, (3,)), *motion)


def _of_joined(function: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> Callable[..., NDArray[np.float64]]:
    """Give the function of separate columns that a function of their joined rows is."""

    def joined(*columns: NDArray[np.float64]) -> NDArray[np.float64]:
        # Single rows serve all, but all have none where one has none.
        count = max(map(len, columns))
        return function(np.concatenate([np.broadcast_to(column, (count, 3)) for column in columns], axis=-1))

    return joined


@known_keywords
def screw_axis(velocity: ArrayLike, angular_velocity: ArrayLike, about: ArrayLike = _ORIGIN) -> ScrewAxis:
    """Give the axis about which a body turns at one time, and along which it moves.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    velocity : array_like, shape (…, 3)
        Of the base point.
    angular_velocity : array_like, shape (…, 3)
        About it, and about any other.
    about : array_like, shape (…, 3)
        The base point; the origin by default.

    Returns
    -------
    ScrewAxis
        ``point``, ``direction``, ``rate``, ``speed`` and ``pitch``. Without angular velocity, the base point and the
        direction of the velocity.

    Raises
    ------
    InvalidInput
        For a body at rest, NaN or infinity, another shape, axes that do not broadcast, or an axis out of the range of
        float64.

    See Also
    --------
    velocity_at : the velocity of other points.

    Notes
    -----
    Every motion of a rigid body is a screw (Chasles); the axis goes through r₀ + ω × v/ω². Ball, *A Treatise on the
    Theory of Screws* (1900).

    Examples
    --------
    A wheel that rolls turns about where it touches the ground:

    >>> import visviva as vv
    >>> axis = vv.rigid.screw_axis([3.0, 0.0, 0.0], [0.0, 3.0, 0.0])
    >>> axis.point, axis.direction, axis.pitch
    (array([ 0.,  0., -1.]), array([0., 1., 0.]), np.float64(0.0))
    """
    motion = (("velocity", velocity, (3,)), ("angular_velocity", angular_velocity, (3,)), ("about", about, (3,)))
    found = map_rows(_of_joined(_core.rigid_screw), (9,), *motion)
    # Of a single body numbers, and no arrays without axes.
    rate, speed, pitch = (found[..., at][()] for at in (6, 7, 8))
    return ScrewAxis(found[..., :3], found[..., 3:6], rate, speed, pitch)
