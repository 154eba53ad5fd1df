"""Anomalies of ellipses: the eccentric one E, M = E − e sin E, and the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import known_keywords
from visviva.orbits._arguments import anomaly

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def eccentric_from_mean(mean: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Solve Kepler's equation M = E − e sin E for E.

    E is in the same turn as M, to an ulp or two times dE/dM, also near e = 1 and M = 0.

    Units: angles in radians; e is without dimension.

    Parameters
    ----------
    mean : array_like
        The mean anomaly M in radians, any number.
    eccentricity : array_like
        0 ≤ e < 1.

    Returns
    -------
    ndarray
        Eccentric anomaly E, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    Murray & Dermott, *Solar System Dynamics* (1999), § 2.4; J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd
    ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.eccentric_from_mean(1.0, 0.5)), 12)
    1.498701133518
    """
    return anomaly("eccentric_from_mean", "mean", mean, eccentricity)


@known_keywords
def mean_from_eccentric(eccentric: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Give the mean anomaly M of the eccentric anomaly E on an ellipse.

    M = E − e sin E.

    Units: angles in radians; e is without dimension.

    Parameters
    ----------
    eccentric : array_like
        In radians, any turn.
    eccentricity : array_like
        0 ≤ e < 1.

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
    Murray & Dermott, *Solar System Dynamics* (1999), § 2.4; J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd
    ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.mean_from_eccentric(1.0, 0.5)), 12)
    0.579264507596
    """
    return anomaly("mean_from_eccentric", "eccentric", eccentric, eccentricity)


@known_keywords
def true_from_eccentric(eccentric: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Give the true anomaly ν of the eccentric anomaly E on an ellipse.

    tan(ν/2) = √((1+e)/(1−e)) tan(E/2). Whole turns are kept.

    Units: angles in radians; e is without dimension.

    Parameters
    ----------
    eccentric : array_like
        In radians, any turn.
    eccentricity : array_like
        0 ≤ e < 1.

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
    Murray & Dermott, *Solar System Dynamics* (1999), § 2.4; J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd
    ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.true_from_eccentric(1.0, 0.5)), 12)
    1.51554815288
    """
    return anomaly("true_from_eccentric", "eccentric", eccentric, eccentricity)


@known_keywords
def eccentric_from_true(true_anomaly: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Give the eccentric anomaly E of the true anomaly ν on an ellipse.

    tan(ν/2) = √((1+e)/(1−e)) tan(E/2). Whole turns are kept.

    Units: angles in radians; e is without dimension.

    Parameters
    ----------
    true_anomaly : array_like
        In radians, any turn.
    eccentricity : array_like
        0 ≤ e < 1.

    Returns
    -------
    ndarray
        Eccentric anomaly E, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    References
    ----------
    Murray & Dermott, *Solar System Dynamics* (1999), § 2.4; J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd
    ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.eccentric_from_true(1.0, 0.5)), 12)
    0.611063702733
    """
    return anomaly("eccentric_from_true", "true_anomaly", true_anomaly, eccentricity)
