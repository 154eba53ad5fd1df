"""Two bodies as a center of mass and a relative motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._keywords import known_keywords
from visviva._together import Together
from visviva.collisions._arguments import masses, vectors

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def reduced_mass(mass1: ArrayLike, mass2: ArrayLike) -> NDArray[np.float64]:
    """Mass with which two bodies move about each other, μ = m₁m₂/(m₁+m₂).

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive.

    Returns
    -------
    ndarray
        Never above the smaller mass, and the smaller mass where the other is infinitely larger. Of the shape of the
        arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, or shapes that do not broadcast.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 13; Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.1.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.collisions.reduced_mass(2.0, [2.0, 1e300])
    array([1., 2.])
    """
    given = Together(masses(mass1, mass2), {})
    if 0 in given.shape:
        return np.empty(given.shape)
    return given.shaped(_core.reduced_mass(given.pair("mass")))


@known_keywords
def to_relative(
    mass1: ArrayLike, mass2: ArrayLike, vector1: ArrayLike, vector2: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Center of mass, and the first body as seen from the second, of two positions or of two velocities.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive.
    vector1, vector2 : array_like, shape (..., 3)
        Positions or velocities.

    Returns
    -------
    center, relative : ndarray, shape (..., 3)
        R = (m₁r₁ + m₂r₂)/(m₁+m₂) and r = r₁ − r₂.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, or shapes that do not broadcast.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 13; Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.1.

    Examples
    --------
    >>> import visviva as vv
    >>> center, relative = vv.collisions.to_relative(1.0, 3.0, [4.0, 0.0, 0.0], [0.0, 0.0, 8.0])
    >>> center, relative
    (array([1., 0., 6.]), array([ 4.,  0., -8.]))
    """
    return _split("to_relative", mass1, mass2, vectors(vector1=vector1, vector2=vector2))


@known_keywords
def from_relative(
    mass1: ArrayLike, mass2: ArrayLike, center: ArrayLike, relative: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions or velocities of two bodies from their center of mass and the first as seen from the second.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive.
    center, relative : array_like, shape (..., 3)
        R and r as of `to_relative`.

    Returns
    -------
    vector1, vector2 : ndarray, shape (..., 3)
        R + (m₂/M) r and R − (m₁/M) r.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, or shapes that do not broadcast.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 13; Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.1.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.collisions.from_relative(1.0, 3.0, [1.0, 0.0, 6.0], [4.0, 0.0, -8.0])
    (array([4., 0., 0.]), array([0., 0., 8.]))
    """
    return _split("from_relative", mass1, mass2, vectors(center=center, relative=relative))


def _split(
    name: str, mass1: object, mass2: object, given: dict[str, NDArray[np.float64]]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    together = Together(masses(mass1, mass2), given)
    if 0 in together.shape:
        return np.empty((*together.shape, 3)), np.empty((*together.shape, 3))
    first, second = together.vectors.values()
    found = _core.relative_split(name, together.pair("mass"), (first, second))
    return together.shaped(found[:, 0], 3), together.shaped(found[:, 1], 3)
