"""What is constant on a conic, and the times that follow from its size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from visviva import _core
from visviva._html import Shown
from visviva._keywords import known_keywords
from visviva._text import short_repr, table
from visviva.orbits._arguments import broadcast, fields, with_shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class Conic(Shown):
    """What is constant on a conic, for a body of mass m in V(r) = −γ/r; see :func:`conic`.

    Every attribute has the shape of the conics asked for (a number for one).

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    mass, strength : ndarray
        m and γ, as given; γ < 0 repels.
    angular_momentum : ndarray
        l = m|r×v|.
    energy : ndarray
        E = mv²/2 − γ/r.
    eccentricity : ndarray
        e = √(1 + 2El²/mγ²).
    semi_major_axis, semi_minor_axis : ndarray
        a = |γ/2E| and b = a√|1 − e²|, positive for hyperbolas too (b is then the impact parameter); infinite for
        a parabola.
    semi_latus_rectum : ndarray
        l²/m|γ|.
    r_min, r_max : ndarray
        Least and greatest distance; the latter infinite if unbound.
    period : ndarray
        2π√(ma³/γ); infinite if unbound.
    areal_rate : ndarray
        l/2m.
    turning_angle : ndarray
        The angle 2 arcsin(1/e) by which a hyperbola turns the velocity; π for a parabola, NaN if bound.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7; Landau & Lifshitz, *Mechanics*, 3rd ed., § 15.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.conic(1.0, 1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])
    >>> round(float(found.eccentricity), 12), round(float(found.r_max), 12)
    (0.44, 2.571428571429)
    """

    mass: NDArray[np.float64]
    strength: NDArray[np.float64]
    angular_momentum: NDArray[np.float64]
    energy: NDArray[np.float64]
    eccentricity: NDArray[np.float64]
    semi_major_axis: NDArray[np.float64]
    semi_minor_axis: NDArray[np.float64]
    semi_latus_rectum: NDArray[np.float64]
    r_min: NDArray[np.float64]
    r_max: NDArray[np.float64]
    period: NDArray[np.float64]
    areal_rate: NDArray[np.float64]
    turning_angle: NDArray[np.float64]

    def __repr__(self) -> str:
        return short_repr(self)

    def __str__(self) -> str:
        return table(self)


@known_keywords
def conic(mass: ArrayLike, strength: ArrayLike, position: ArrayLike, velocity: ArrayLike) -> Conic:
    """Find the constants of the conic through a state, for a body of mass m in V(r) = −γ/r.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    mass : array_like
        m > 0.
    strength : array_like
        γ in energy times length: positive attracts (G M m), negative repels.
    position, velocity : array_like, shape (…, 3)
        State relative to the center.

    Returns
    -------
    Conic
        With the leading axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a wrong shape, NaN or infinity, a mass that is not positive, γ = 0, or a position at the center.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7; Landau & Lifshitz, *Mechanics*, 3rd ed., § 15.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.conic(2.0, 3.0, [1.25, 0.0, 0.0], [0.25, 0.875, 0.0])
    >>> float(found.angular_momentum), float(found.energy)
    (2.1875, -1.571875)
    """
    scalars = {"mass": mass, "strength": strength}
    shape, flat, vectors = broadcast(scalars, {"position": position, "velocity": velocity})
    return _conic(shape, flat, _core.conic_from_state(*flat, *vectors))


@known_keywords
def conic_from_constants(
    mass: ArrayLike, strength: ArrayLike, *, angular_momentum: ArrayLike, energy: ArrayLike
) -> Conic:
    """Find the conic of given angular momentum and energy, for a body of mass m in V(r) = −γ/r.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    mass : array_like
        m > 0.
    strength : array_like
        γ in energy times length: positive attracts, negative repels.
    angular_momentum : array_like
        l ≥ 0.
    energy : array_like
        E, not below the circle's −mγ²/2l² (but for rounding); for repulsion above 0.

    Returns
    -------
    Conic
        With the axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7; Landau & Lifshitz, *Mechanics*, 3rd ed., § 15.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.orbits.conic_from_constants(1.0, 1.0, angular_momentum=0.5, energy=-0.5)
    >>> float(found.semi_major_axis), float(found.semi_minor_axis)
    (1.0, 0.5)
    """
    given = {"mass": mass, "strength": strength, "angular_momentum": angular_momentum, "energy": energy}
    shape, flat, _ = broadcast(given, {})
    return _conic(shape, flat, _core.conic_from_constants(*flat))


@known_keywords
def period(mu: ArrayLike, semi_major_axis: ArrayLike) -> NDArray[np.float64]:
    """Find the period 2π√(a³/μ) of ellipses.

    Units: μ is in length³ / time², in the caller's units of both.

    Parameters
    ----------
    mu : array_like
        G(m₁ + m₂) > 0.
    semi_major_axis : array_like
        a > 0.

    Returns
    -------
    ndarray
        Periods, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument that is not positive and finite, or shapes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7–3.8 (Kepler's third law).

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.period(1.0, 4.0)), 12)
    50.265482457437
    """
    shape, flat, _ = broadcast({"mu": mu, "semi_major_axis": semi_major_axis}, {})
    return with_shape(_core.orbit_period(*flat), shape)


@known_keywords
def semi_major_axis(mu: ArrayLike, period: ArrayLike) -> NDArray[np.float64]:
    """Find the semi-major axis ∛(μ(T/2π)²) of ellipses of given periods.

    Units: μ is in length³ / time², in the caller's units of both.

    Parameters
    ----------
    mu : array_like
        G(m₁ + m₂) > 0.
    period : array_like
        T > 0.

    Returns
    -------
    ndarray
        Semi-major axes, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument that is not positive and finite, or shapes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7–3.8 (Kepler's third law).

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> round(float(vv.orbits.semi_major_axis(1.0, 16 * np.pi)), 12)
    4.0
    """
    shape, flat, _ = broadcast({"mu": mu, "period": period}, {})
    return with_shape(_core.orbit_semi_major_axis(*flat), shape)


@known_keywords
def free_fall_time(mu: ArrayLike, start: ArrayLike, end: ArrayLike = 0.0) -> NDArray[np.float64]:
    """Find the time to fall from rest at one distance from the center to another.

    √(R³/2μ)(θ + sin θ cos θ) with r = R cos²θ; to the center itself π√(R³/8μ).

    Units: μ is in length³ / time², in the caller's units of both.

    Parameters
    ----------
    mu : array_like
        G(m₁ + m₂) > 0.
    start : array_like
        Distance R of release, above 0.
    end : array_like, optional
        Distance to fall to, from 0 to R.

    Returns
    -------
    ndarray
        Times, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an argument out of its range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., ch. 3, exercise 11, and § 3.8.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.free_fall_time(1.0, 2.0)), 12)
    3.14159265359
    """
    shape, flat, _ = broadcast({"mu": mu, "start": start, "end": end}, {})
    return with_shape(_core.orbit_free_fall_time(*flat), shape)


def _conic(shape: tuple[int, ...], flat: list[NDArray[np.float64]], columns: dict[str, NDArray[np.float64]]) -> Conic:
    mass, strength = flat[:2]
    return Conic(mass=with_shape(mass, shape), strength=with_shape(strength, shape), **fields(columns, shape))
