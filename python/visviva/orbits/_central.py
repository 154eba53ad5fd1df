"""Motion in any central potential: where it may be, and its circles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import number, positive
from visviva._html import Record, Shown
from visviva._keywords import known_keywords
from visviva._parameter import wrapped
from visviva._text import short_repr, table
from visviva.errors import InvalidInput
from visviva.orbits._arguments import broadcast, fields, with_shape
from visviva.potentials import Potential

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray


def terms_of(potential: Potential | Sequence[Potential]) -> tuple[Potential, ...]:
    """One potential, or several that are added, as several."""
    try:
        terms = (potential,) if isinstance(potential, Potential) else tuple(potential)
    except TypeError:  # not a sequence
        terms = ()
    if not terms or not all(isinstance(term, Potential) for term in terms):
        raise InvalidInput(
            "potential",
            f"expected one of visviva.potentials, or several to be added, got {potential!r}{_cure(potential)}",
        )
    return terms


def _cure(given: object) -> str:
    several = given if isinstance(given, list | tuple) else (given,)
    return next(filter(None, map(wrapped, several)), "")


def core_potentials(potential: Potential | Sequence[Potential]) -> list[dict[str, Any]]:
    """What the core takes for one potential, or for several that are added."""
    return [term._to_core() for term in terms_of(potential)]


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

    Units: those of the caller, one consistent system.

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

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.3; Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.orbits.effective_potential(vv.potentials.Coulomb(-1.0), [0.5, 1.0, 2.0], angular_momentum=1.0)
    array([ 0.   , -0.5  , -0.375])
    """
    shape, flat = checked(r=r, angular_momentum=angular_momentum, mass=mass)
    return with_shape(_core.central_effective(core_potentials(potential), flat[0], flat[1], flat[2], path=False), shape)


@known_keywords
def path_equation(
    potential: Potential | Sequence[Potential],
    u: ArrayLike,
    *,
    angular_momentum: ArrayLike,
    mass: ArrayLike = 1.0,
) -> NDArray[np.float64]:
    """Find d²u/dθ² = −u − m F(1/u)/(l²u²), which the path u(θ) = 1/r(θ) obeys.

    Units: those of the caller, one consistent system.

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

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.5.

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
    return with_shape(_core.central_effective(core_potentials(potential), flat[0], flat[1], flat[2], path=True), shape)


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class CircularOrbits(Shown):
    """Circles in a potential; what :func:`circular_orbit` and :func:`circular_orbits` return.

    Every attribute has the shape of what was asked; of all circles of an angular momentum, shape (K,).

    Units: those of the caller, one consistent system; angles in radians.

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

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.3 and § 3.6.

    Examples
    --------
    >>> import visviva as vv
    >>> circle = vv.orbits.circular_orbit(vv.potentials.Coulomb(-1.0), 4.0)
    >>> float(circle.angular_velocity), bool(circle.stable)
    (0.125, True)
    """

    radius: NDArray[np.float64]
    energy: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    stable: NDArray[np.bool_]
    radial_frequency: NDArray[np.float64]
    growth_rate: NDArray[np.float64]
    apsidal_angle: NDArray[np.float64]

    def __repr__(self) -> str:
        return short_repr(self)

    def __str__(self) -> str:
        return table(self)


@known_keywords
def circular_orbit(
    potential: Potential | Sequence[Potential], radius: ArrayLike, *, mass: ArrayLike = 1.0
) -> CircularOrbits:
    """Find what a circle of a given radius needs, and whether it lasts.

    Units: those of the caller, one consistent system; angles in radians.

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

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.3 and § 3.6.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.circular_orbit(vv.potentials.Yukawa(-1.0, length=1.0), [1.0, 2.0])
    >>> found.stable, found.radial_frequency.round(9)
    (array([ True, False]), array([0.60653066,        nan]))
    """
    shape, flat = checked(radius=radius, mass=mass)
    found = _core.central_circles(core_potentials(potential), *flat)
    rate = found.pop("radial_rate")
    found["radial_frequency"] = np.where(rate > 0.0, rate, np.nan)
    found["growth_rate"] = np.maximum(-rate, 0.0)
    stable: NDArray[np.bool_] = (rate > 0.0).reshape(shape)[()]
    return CircularOrbits(stable=stable, **fields(found, shape))


@known_keywords
def circular_orbits(
    potential: Potential | Sequence[Potential], *, angular_momentum: float, mass: float = 1.0
) -> CircularOrbits:
    """Find every circle of a given angular momentum: the stationary places of the effective potential.

    Units: those of the caller, one consistent system; angles in radians.

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
        One entry for each circle, by radius; none where nothing attracts. Attributes have shape (K,).

    Raises
    ------
    InvalidInput
        For an argument out of its range.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.3 and § 3.6.

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
@dataclass(frozen=True, slots=True, repr=False)
class RadialRange(Record):
    """A range of distance in which a motion may be.

    Units: those of the caller's lengths.

    Attributes
    ----------
    r_min, r_max : float
        Its ends; 0 for the center, infinity where it escapes.
    kind : str
        ``"bound"``, ``"circular"``, ``"escapes"``, ``"reaches_the_center"``, ``"reaches_the_center_or_escapes"``, or
        ``"leaves_the_table"`` where the potential is known no farther.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

    Examples
    --------
    >>> import visviva as vv
    >>> [allowed] = vv.orbits.range_of_motion(vv.potentials.Coulomb(-1.0), energy=-0.5, angular_momentum=0.6)
    >>> round(allowed.r_min, 9), round(allowed.r_max, 9), allowed.kind
    (0.2, 1.8, 'bound')
    """

    r_min: float
    r_max: float
    kind: str


@known_keywords
def range_of_motion(
    potential: Potential | Sequence[Potential], *, energy: float, angular_momentum: float, mass: float = 1.0
) -> tuple[RadialRange, ...]:
    """Find every range of distance that energy and angular momentum allow, with all turning points.

    Units: those of the caller, one consistent system.

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
        From the center outward; empty if there is no motion. Where an inverse-cube force keeps a body on a circle at
        every distance, one ``"circular"`` range of all of them.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity.

    Notes
    -----
    At a turning point r²(E − V) = l²/2m. The left side is stationary where V + r V′/2 = E, and that function of the
    distance has pieces that are monotone at any energy; so each turning point is one root between two known signs.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 14.

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
