"""Radial motion in any central potential: its period, its angle, and times between."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.orbits._arguments import fields, with_shape
from visviva.orbits._central import checked, core_potentials

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True, repr=False)
class RadialMotion(Record):
    """Radial motions; what :func:`radial_motion` returns. Every attribute has the shape of the arguments.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    r_min, r_max : ndarray
        Least and greatest distance.
    radial_period : ndarray
        From one pericenter, or one apocenter, to the next; infinite if it escapes. Of a motion that reaches the
        center, twice the time from there to the farthest place. NaN where there is no motion.
    apsidal_angle : ndarray
        From r_min to r_max; NaN where there is no such angle.
    precession : ndarray
        2 (apsidal angle) − 2π, by which the pericenter moves on in a radial period; NaN where it does not return.
    period_error, angle_error : ndarray
        What the integrals of `radial_period` and `apsidal_angle` may lack, as estimated.
    kind : ndarray of str
        As in `RadialRange`, or ``"no_motion"``.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.radial_motion(vv.potentials.Coulomb(-1.0), energy=-0.5, angular_momentum=0.6)
    >>> round(float(found.r_min), 9), round(float(found.r_max), 9), str(found.kind)
    (0.2, 1.8, 'bound')
    """

    r_min: NDArray[np.float64]
    r_max: NDArray[np.float64]
    radial_period: NDArray[np.float64]
    apsidal_angle: NDArray[np.float64]
    precession: NDArray[np.float64]
    period_error: NDArray[np.float64]
    angle_error: NDArray[np.float64]
    kind: NDArray[np.str_]


@known_keywords
def radial_motion(
    potential: Potential | Sequence[Potential],
    *,
    energy: ArrayLike,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
    near: ArrayLike | None = None,
) -> RadialMotion:
    """Find turning points, radial period, apsidal angle and precession.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    energy : array_like
        E.
    angular_momentum : array_like
        l ≥ 0.
    mass : array_like, optional
        m > 0.
    near : array_like, optional
        A distance in the range that is meant, where there are several.

    Returns
    -------
    RadialMotion
        Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument out of its range, and where there are several ranges and `near` is not given.
    ConvergenceError
        If an integral does not come to 1e-12: too near to the top of a barrier, or the potential is not smooth enough.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.radial_motion(vv.potentials.Yukawa(-1.0, length=5.0), energy=-0.2, angular_momentum=0.8)
    >>> round(float(found.radial_period), 9), round(float(found.precession), 9)
    (10.872873754, 0.135129266)
    """
    given = {"energy": energy, "angular_momentum": angular_momentum, "mass": mass}
    shape, flat = checked(**given, **({} if near is None else {"near": near}))
    if near is None:
        flat.append(np.full(flat[0].shape, np.nan))
    found, kinds = _core.central_motion(core_potentials(potential), *flat)
    return described_motion(fields(found, shape), np.array(kinds, dtype=np.str_).reshape(shape))


def described_motion(numbers: dict[str, Any], kind: NDArray[np.str_]) -> RadialMotion:
    """The numbers of motions, and the precession of those that return."""
    returns = (kind == "bound") | (kind == "circular")
    precession = np.where(returns, 2.0 * (numbers["apsidal_angle"] - np.pi), np.nan)[()]
    return RadialMotion(**numbers, precession=precession, kind=kind)


@known_keywords
def radial_period(
    potential: Potential | Sequence[Potential],
    *,
    energy: ArrayLike,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
    near: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Find the time from one pericenter to the next; see `radial_motion`.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    energy, angular_momentum : array_like
        E and l of the motion; broadcast against each other.
    mass : array_like
        m > 0.
    near : array_like, optional
        As of `radial_motion`.

    Returns
    -------
    ndarray
        A time; infinite where the motion escapes. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput, ConvergenceError
        As `radial_motion`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> kepler = vv.potentials.Coulomb(-1.0)
    >>> round(float(vv.orbits.radial_period(kepler, energy=-0.5, angular_momentum=0.5)), 12)
    6.28318530718
    """
    given: dict[str, Any] = {"energy": energy, "angular_momentum": angular_momentum, "mass": mass, "near": near}
    return radial_motion(potential, **given).radial_period


@known_keywords
def apsidal_angle(
    potential: Potential | Sequence[Potential],
    *,
    energy: ArrayLike,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
    near: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Find the angle from pericenter to apocenter; see `radial_motion`.

    Units: those of the caller, one consistent system; the angle in radians.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    energy, angular_momentum : array_like
        E and l of the motion; broadcast against each other.
    mass : array_like
        m > 0.
    near : array_like, optional
        As of `radial_motion`.

    Returns
    -------
    ndarray
        Radians; NaN where there is no such angle. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput, ConvergenceError
        As `radial_motion`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> kepler = vv.potentials.Coulomb(-1.0)
    >>> round(float(vv.orbits.apsidal_angle(kepler, energy=-0.5, angular_momentum=0.5)), 12)
    3.14159265359
    """
    given: dict[str, Any] = {"energy": energy, "angular_momentum": angular_momentum, "mass": mass, "near": near}
    return radial_motion(potential, **given).apsidal_angle


@known_keywords
def precession(
    potential: Potential | Sequence[Potential],
    *,
    energy: ArrayLike,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
    near: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Find the angle by which the pericenter moves on in a radial period; see `radial_motion`.

    Units: those of the caller, one consistent system; the angle in radians.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    energy, angular_momentum : array_like
        E and l of the motion; broadcast against each other.
    mass : array_like
        m > 0.
    near : array_like, optional
        As of `radial_motion`.

    Returns
    -------
    ndarray
        Radians in a radial period; NaN where the pericenter does not come again. Of the shape of the arguments,
        broadcast.

    Raises
    ------
    InvalidInput, ConvergenceError
        As `radial_motion`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> field = [vv.potentials.Coulomb(-1.0), vv.potentials.PowerLaw(-0.05, 2.0)]
    >>> round(float(vv.orbits.precession(field, energy=-0.4, angular_momentum=1.0)), 12)
    0.339873536684
    """
    given: dict[str, Any] = {"energy": energy, "angular_momentum": angular_momentum, "mass": mass, "near": near}
    return radial_motion(potential, **given).precession


@known_keywords
def time_of_flight(
    potential: Potential | Sequence[Potential],
    start: ArrayLike,
    end: ArrayLike,
    *,
    energy: ArrayLike,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
) -> NDArray[np.float64]:
    """Find the time between two distances of one range, without a turn between.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    start, end : array_like
        Distances, in either order.
    energy, angular_momentum, mass : array_like
        As in `radial_motion`.

    Returns
    -------
    ndarray
        Times, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For distances that are not in one range of motion (the message gives the ranges).
    ConvergenceError
        As `radial_motion`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> kepler = vv.potentials.Coulomb(-1.0)
    >>> round(float(vv.orbits.time_of_flight(kepler, 2.0, 1.0, energy=-0.5, angular_momentum=0.0)), 12)
    2.570796326795
    """
    given = {"start": start, "end": end, "energy": energy, "angular_momentum": angular_momentum, "mass": mass}
    shape, flat = checked(**given)
    times, _ = _core.central_passage(core_potentials(potential), *flat)
    return with_shape(times, shape)


@known_keywords
def swept_angle(
    potential: Potential | Sequence[Potential],
    start: ArrayLike,
    end: ArrayLike,
    *,
    energy: ArrayLike,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
) -> NDArray[np.float64]:
    """Find the angle about the center between two distances of one range; as `time_of_flight`.

    Units: those of the caller, one consistent system; the angle in radians.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    start, end : array_like
        Two distances of one range of motion.
    energy, angular_momentum : array_like
        E and l of the motion; broadcast against each other.
    mass : array_like
        m > 0.

    Returns
    -------
    ndarray
        Radians. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput, ConvergenceError
        As `time_of_flight`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    From the end of the latus rectum of an ellipse, θ = π/2, to the end of its minor axis, cos θ = −e:

    >>> import visviva as vv
    >>> kepler = vv.potentials.Coulomb(-1.0)
    >>> found = vv.orbits.swept_angle(kepler, 0.75, 1.0, energy=-0.5, angular_momentum=0.75**0.5)
    >>> round(float(found), 9)
    0.523598776
    """
    given = {"start": start, "end": end, "energy": energy, "angular_momentum": angular_momentum, "mass": mass}
    shape, flat = checked(**given)
    _, angles = _core.central_passage(core_potentials(potential), *flat)
    return with_shape(angles, shape)
