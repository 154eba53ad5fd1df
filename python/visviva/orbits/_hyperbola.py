"""Anomalies of hyperbolas: the hyperbolic one H, M = e sinh H ∓ H, and the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import known_keywords
from visviva.orbits._arguments import anomaly

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def hyperbolic_from_mean(mean: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False) -> NDArray[np.float64]:
    """Solve Kepler's equation of the hyperbola, M = e sinh H − H, for H.

    With ``repulsive``, M = e sinh H + H.

    Units: none: M, H and e are without dimension.

    Parameters
    ----------
    mean : array_like
        The mean anomaly M, any number.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the center repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        Hyperbolic anomaly H, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.hyperbolic_from_mean(1.0, 1.5)), 12)
    1.161635444505
    """
    return anomaly("hyperbolic_from_mean", "mean", mean, eccentricity, repulsive)


@known_keywords
def mean_from_hyperbolic(
    hyperbolic: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False
) -> NDArray[np.float64]:
    """Give the mean anomaly M of the hyperbolic anomaly H on a hyperbola.

    M = e sinh H − H (repulsion: e sinh H + H).

    Units: none: M, H and e are without dimension.

    Parameters
    ----------
    hyperbolic : array_like
        Any number.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the center repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        Mean anomaly M, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.mean_from_hyperbolic(1.0, 1.5)), 12)
    0.762801790466
    """
    return anomaly("mean_from_hyperbolic", "hyperbolic", hyperbolic, eccentricity, repulsive)


@known_keywords
def true_from_hyperbolic(
    hyperbolic: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False
) -> NDArray[np.float64]:
    """Give the true anomaly ν of the hyperbolic anomaly H on a hyperbola.

    tan(ν/2) = √((e+1)/(e−1)) tanh(H/2) (repulsion: the inverse root).

    Units: ν is in radians; H and e are without dimension.

    Parameters
    ----------
    hyperbolic : array_like
        Any number.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the center repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        True anomaly ν, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.true_from_hyperbolic(1.0, 1.5)), 12)
    1.603572580036
    """
    return anomaly("true_from_hyperbolic", "hyperbolic", hyperbolic, eccentricity, repulsive)


@known_keywords
def hyperbolic_from_true(
    true_anomaly: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False
) -> NDArray[np.float64]:
    """Give the hyperbolic anomaly H of the true anomaly ν on a hyperbola.

    tan(ν/2) = √((e+1)/(e−1)) tanh(H/2) (repulsion: the inverse root).

    Units: ν is in radians; H and e are without dimension.

    Parameters
    ----------
    true_anomaly : array_like
        In radians, inside the asymptotes.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the center repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        Hyperbolic anomaly H, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity or angle out of range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.hyperbolic_from_true(1.0, 1.5)), 12)
    0.498713495861
    """
    return anomaly("hyperbolic_from_true", "true_anomaly", true_anomaly, eccentricity, repulsive)
