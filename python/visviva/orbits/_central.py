"""Motion in any central potential: where it may be, its circles, its period and its angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import number, positive
from visviva._keywords import known_keywords
from visviva._text import table
from visviva.errors import InvalidInput
from visviva.orbits._arguments import broadcast, fields, shaped
from visviva.potentials import Potential

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray


def core_potentials(potential: Potential | Sequence[Potential]) -> list[dict[str, Any]]:
    """What the core takes for one potential, or for several that are added."""
    terms = [potential] if isinstance(potential, Potential) else list(potential)
    if not terms or not all(isinstance(term, Potential) for term in terms):
        raise InvalidInput(
            "potential", f"expected one of visviva.potentials, or several to be added, got {potential!r}"
        )
    return [term._to_core() for term in terms]


def checked(**columns: ArrayLike) -> tuple[tuple[int, ...], list[NDArray[np.float64]]]:
    """Broadcast numbers; masses and distances are above 0, angular momenta at least 0."""
    shape, flat, _ = broadcast(columns, {})
    for name, values in zip(columns, flat, strict=True):
        if name in ("mass", "radius", "r", "u") and not np.all(values > 0.0):
            raise InvalidInput(name, f"expected numbers above 0, got {float(values[~(values > 0.0)][0])!r}")
        if name in ("angular_momentum", "start", "end") and not np.all(values >= 0.0):
            raise InvalidInput(name, f"expected numbers of at least 0, got {float(values[values < 0.0][0])!r}")
    return shape, flat


@known_keywords
def effective_potential(
    potential: Potential | Sequence[Potential],
    r: ArrayLike,
    *,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
) -> NDArray[np.float64]:
    """Find the effective potential V(r) + l²/2mr², in which r moves as on a line.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    r : array_like
        Distances above 0.
    angular_momentum : array_like
        l ≥ 0.
    mass : array_like, optional
        m > 0.

    Returns
    -------
    ndarray
        Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity, or shapes that do not broadcast.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.orbits.effective_potential(vv.potentials.Coulomb(-1.0), [0.5, 1.0, 2.0], angular_momentum=1.0)
    array([ 0.   , -0.5  , -0.375])
    """
    shape, flat = checked(r=r, angular_momentum=angular_momentum, mass=mass)
    return shaped(_core.central_effective(core_potentials(potential), flat[0], flat[1], flat[2], path=False), shape)


@known_keywords
def path_equation(
    potential: Potential | Sequence[Potential],
    u: ArrayLike,
    *,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
) -> NDArray[np.float64]:
    """Find d²u/dθ² = −u − m F(1/u)/(l²u²), which the path u(θ) = 1/r(θ) obeys.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r) with F = −dV/dr; several are added.
    u : array_like
        1/r > 0.
    angular_momentum : array_like
        l > 0.
    mass : array_like, optional
        m > 0.

    Returns
    -------
    ndarray
        Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity, or shapes that do not broadcast.

    Examples
    --------
    On a circle u is constant:

    >>> import visviva as vv
    >>> float(vv.orbits.path_equation(vv.potentials.Coulomb(-2.0), 8.0, angular_momentum=0.5))
    0.0
    """
    shape, flat = checked(u=u, angular_momentum=angular_momentum, mass=mass)
    if not np.all(flat[1] > 0.0):
        raise InvalidInput("angular_momentum", "expected numbers above 0: a radial motion has no path u(θ)")
    return shaped(_core.central_effective(core_potentials(potential), flat[0], flat[1], flat[2], path=True), shape)


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class CircularOrbits:
    """Circles in a potential; what :func:`circular_orbit` and :func:`circular_orbits` return.

    Attributes
    ----------
    radius, energy, angular_momentum, angular_velocity : ndarray
        r, E = V + r V′/2, l = √(m r³V′) and ω = √(V′/mr).
    stable : ndarray of bool
        Whether a small disturbance stays small: V″ + 3V′/r > 0.
    radial_frequency : ndarray
        √((V″ + 3V′/r)/m), that of a small radial oscillation; NaN where there is none.
    growth_rate : ndarray
        Of an unstable circle the rate at which a disturbance grows; 0 of a stable one.
    apsidal_angle : ndarray
        π ω over the radial frequency, from pericenter to apocenter of an orbit nearby; NaN where there is none.
    """

    radius: NDArray[np.float64]
    energy: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    stable: NDArray[np.bool_]
    radial_frequency: NDArray[np.float64]
    growth_rate: NDArray[np.float64]
    apsidal_angle: NDArray[np.float64]

    def __str__(self) -> str:
        return table(self)


@known_keywords
def circular_orbit(
    potential: Potential | Sequence[Potential], radius: ArrayLike, *, mass: ArrayLike = 1.0
) -> CircularOrbits:
    """Find what a circle of a given radius needs, and whether it lasts.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    radius : array_like
        r > 0, where the force attracts.
    mass : array_like, optional
        m > 0.

    Returns
    -------
    CircularOrbits
        Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        Where the force repels, for an argument out of its range, and shapes that do not broadcast.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.circular_orbit(vv.potentials.Yukawa(-1.0, length=1.0), [1.0, 2.0])
    >>> found.stable, found.radial_frequency.round(9)
    (array([ True, False]), array([0.60653066,        nan]))
    """
    shape, flat = checked(radius=radius, mass=mass)
    found = _core.central_circles(core_potentials(potential), *flat)
    square = found.pop("radial_square")
    found["radial_frequency"] = np.sqrt(np.where(square > 0.0, square, np.nan))
    found["growth_rate"] = np.sqrt(np.maximum(-square, 0.0))
    stable: NDArray[np.bool_] = (square > 0.0).reshape(shape)[()]
    return CircularOrbits(stable=stable, **fields(found, shape))


@known_keywords
def circular_orbits(
    potential: Potential | Sequence[Potential], *, angular_momentum: float, mass: float = 1.0
) -> CircularOrbits:
    """Find every circle of a given angular momentum: the stationary places of the effective potential.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    angular_momentum : float
        l > 0.
    mass : float, optional
        m > 0.

    Returns
    -------
    CircularOrbits
        One entry for each circle, by radius; none where nothing attracts.

    Raises
    ------
    InvalidInput
        For an argument out of its range.

    Examples
    --------
    A well and, farther out, a barrier:

    >>> import visviva as vv
    >>> found = vv.orbits.circular_orbits(vv.potentials.LennardJones(1.0, 1.0), angular_momentum=1.0)
    >>> found.radius.round(9), found.stable
    (array([1.13599664, 2.20363527]), array([ True, False]))
    """
    momentum, m = positive("angular_momentum", angular_momentum), positive("mass", mass)
    radii = _core.central_circular_radii(core_potentials(potential), momentum, m)
    return circular_orbit(potential, np.array(radii), mass=m)


@known_keywords
@dataclass(frozen=True, slots=True)
class RadialRange:
    """A range of distance in which a motion may be.

    Attributes
    ----------
    r_min, r_max : float
        Its ends; 0 for the center, infinity where it escapes.
    kind : str
        ``"bound"``, ``"circular"``, ``"escapes"``, ``"reaches_the_center"``, ``"reaches_the_center_or_escapes"``, or
        ``"leaves_the_table"`` where the potential is known no farther.
    """

    r_min: float
    r_max: float
    kind: str


@known_keywords
def range_of_motion(
    potential: Potential | Sequence[Potential], *, energy: float, angular_momentum: float, mass: float = 1.0
) -> tuple[RadialRange, ...]:
    """Find every range of distance that energy and angular momentum allow, with all turning points.

    Parameters
    ----------
    potential : Potential or sequence of Potential
        V(r); several are added.
    energy : float
        E.
    angular_momentum : float
        l ≥ 0.
    mass : float, optional
        m > 0.

    Returns
    -------
    tuple of RadialRange
        From the center outward; empty if there is no motion.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity.

    Notes
    -----
    At a turning point r²(E − V) = l²/2m. The left side is stationary where V + r V′/2 = E, and that function of the
    distance has pieces that are monotone at any energy; so each turning point is one root between two known signs.

    Examples
    --------
    >>> import visviva as vv
    >>> for part in vv.orbits.range_of_motion(vv.potentials.LennardJones(1.0, 1.0), energy=0.1, angular_momentum=1.5):
    ...     print(round(part.r_min, 6), round(part.r_max, 6), part.kind)
    1.069026 1.384935 bound
    3.303707 inf escapes
    """
    values = (number("energy", energy), number("angular_momentum", angular_momentum), positive("mass", mass))
    if values[1] < 0.0:
        raise InvalidInput("angular_momentum", f"expected a number of at least 0, got {values[1]!r}")
    return tuple(RadialRange(*part) for part in _core.central_ranges(core_potentials(potential), *values))


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class RadialMotion:
    """Radial motions; what :func:`radial_motion` returns. Every attribute has the shape of what was asked.

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
    return shaped(times, shape)


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
    return shaped(angles, shape)
