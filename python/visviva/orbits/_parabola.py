"""Anomalies of parabolas: D = tan(ν/2), M = D + D³/3, and the true one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import known_keywords
from visviva.orbits._arguments import anomaly

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def parabolic_from_mean(mean: ArrayLike) -> NDArray[np.float64]:
    """Solve Barker's equation M = D + D³/3 for D = tan(ν/2).

    M = √(μ/2q³) t, t since the pericenter at distance q.

    Units: none: M and D are without dimension.

    Parameters
    ----------
    mean : array_like
        The mean anomaly M, any number.

    Returns
    -------
    ndarray
        Parabolic anomaly D, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a number out of range, NaN or infinity.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.parabolic_from_mean(1.0)), 12)
    0.817731673887
    """
    return anomaly("parabolic_from_mean", "mean", mean, 0.0)


@known_keywords
def mean_from_parabolic(parabolic: ArrayLike) -> NDArray[np.float64]:
    """Give the mean anomaly M of the parabolic anomaly D on a parabola.

    M = D + D³/3. Then M = √(μ/2q³) t, t since the pericenter at distance q.

    Units: none: M and D are without dimension.

    Parameters
    ----------
    parabolic : array_like
        tan(ν/2).

    Returns
    -------
    ndarray
        Mean anomaly M, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a number out of range, NaN or infinity.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.mean_from_parabolic(1.0)), 12)
    1.333333333333
    """
    return anomaly("mean_from_parabolic", "parabolic", parabolic, 0.0)


@known_keywords
def true_from_parabolic(parabolic: ArrayLike) -> NDArray[np.float64]:
    """Give the true anomaly ν of the parabolic anomaly D on a parabola.

    tan(ν/2) = D.

    Units: ν is in radians; D is without dimension.

    Parameters
    ----------
    parabolic : array_like
        tan(ν/2).

    Returns
    -------
    ndarray
        True anomaly ν, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a number out of range, NaN or infinity.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.true_from_parabolic(1.0)), 12)
    1.570796326795
    """
    return anomaly("true_from_parabolic", "parabolic", parabolic, 0.0)


@known_keywords
def parabolic_from_true(true_anomaly: ArrayLike) -> NDArray[np.float64]:
    """Give the parabolic anomaly D of the true anomaly ν on a parabola.

    tan(ν/2) = D.

    Units: ν is in radians; D is without dimension.

    Parameters
    ----------
    true_anomaly : array_like
        In radians, between −π and π.

    Returns
    -------
    ndarray
        Parabolic anomaly D, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an angle out of range, NaN or infinity.

    References
    ----------
    J. M. A. Danby, *Fundamentals of Celestial Mechanics*, 2nd ed. (1988), ch. 6.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.parabolic_from_true(1.0)), 12)
    0.546302489844
    """
    return anomaly("parabolic_from_true", "true_anomaly", true_anomaly, 0.0)
