"""Anomalies of ellipses, hyperbolas and parabolas, and Kepler's equation between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.orbits._arguments import broadcast, shaped

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
def eccentric_from_mean(mean: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Solve Kepler's equation M = E − e sin E for E.

    E is in the same turn as M, to an ulp or two times dE/dM, also near e = 1 and M = 0.

    Parameters
    ----------
    mean : array_like
        Any angle or number.
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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.eccentric_from_mean(1.0, 0.5)), 12)
    1.498701133518
    """
    return _anomaly("eccentric_from_mean", "mean", mean, eccentricity)


@known_keywords
def hyperbolic_from_mean(mean: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False) -> NDArray[np.float64]:
    """Solve Kepler's equation of the hyperbola, M = e sinh H − H, for H.

    With ``repulsive``, M = e sinh H + H.

    Parameters
    ----------
    mean : array_like
        Any angle or number.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the centre repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        Hyperbolic anomaly H, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.hyperbolic_from_mean(1.0, 1.5)), 12)
    1.161635444505
    """
    return _anomaly("hyperbolic_from_mean", "mean", mean, eccentricity, repulsive)


@known_keywords
def parabolic_from_mean(mean: ArrayLike) -> NDArray[np.float64]:
    """Solve Barker's equation M = D + D³/3 for D = tan(ν/2).

    M = √(μ/2q³) t, t since the pericentre at distance q.

    Parameters
    ----------
    mean : array_like
        Any angle or number.

    Returns
    -------
    ndarray
        Parabolic anomaly D, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a number out of range, NaN or infinity.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.parabolic_from_mean(1.0)), 12)
    0.817731673887
    """
    return _anomaly("parabolic_from_mean", "mean", mean, 0.0)


@known_keywords
def mean_from_eccentric(eccentric: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Give the mean anomaly M of the eccentric anomaly E on an ellipse.

    M = E − e sin E.

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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.mean_from_eccentric(1.0, 0.5)), 12)
    0.579264507596
    """
    return _anomaly("mean_from_eccentric", "eccentric", eccentric, eccentricity)


@known_keywords
def mean_from_hyperbolic(
    hyperbolic: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False
) -> NDArray[np.float64]:
    """Give the mean anomaly M of the hyperbolic anomaly H on a hyperbola.

    M = e sinh H − H (repulsion: e sinh H + H).

    Parameters
    ----------
    hyperbolic : array_like
        Any number.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the centre repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        Mean anomaly M, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.mean_from_hyperbolic(1.0, 1.5)), 12)
    0.762801790466
    """
    return _anomaly("mean_from_hyperbolic", "hyperbolic", hyperbolic, eccentricity, repulsive)


@known_keywords
def mean_from_parabolic(parabolic: ArrayLike) -> NDArray[np.float64]:
    """Give the mean anomaly M of the parabolic anomaly D on a parabola.

    M = D + D³/3. Then M = √(μ/2q³) t, t since the pericentre at distance q.

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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.mean_from_parabolic(1.0)), 12)
    1.333333333333
    """
    return _anomaly("mean_from_parabolic", "parabolic", parabolic, 0.0)


@known_keywords
def true_from_eccentric(eccentric: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Give the true anomaly ν of the eccentric anomaly E on an ellipse.

    tan(ν/2) = √((1+e)/(1−e)) tan(E/2). Whole turns are kept.

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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.true_from_eccentric(1.0, 0.5)), 12)
    1.51554815288
    """
    return _anomaly("true_from_eccentric", "eccentric", eccentric, eccentricity)


@known_keywords
def true_from_hyperbolic(
    hyperbolic: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False
) -> NDArray[np.float64]:
    """Give the true anomaly ν of the hyperbolic anomaly H on a hyperbola.

    tan(ν/2) = √((e+1)/(e−1)) tanh(H/2) (repulsion: the inverse root).

    Parameters
    ----------
    hyperbolic : array_like
        Any number.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the centre repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        True anomaly ν, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity out of range, NaN or infinity, or shapes that do not broadcast.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.true_from_hyperbolic(1.0, 1.5)), 12)
    1.603572580036
    """
    return _anomaly("true_from_hyperbolic", "hyperbolic", hyperbolic, eccentricity, repulsive)


@known_keywords
def true_from_parabolic(parabolic: ArrayLike) -> NDArray[np.float64]:
    """Give the true anomaly ν of the parabolic anomaly D on a parabola.

    tan(ν/2) = D.

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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.true_from_parabolic(1.0)), 12)
    1.570796326795
    """
    return _anomaly("true_from_parabolic", "parabolic", parabolic, 0.0)


@known_keywords
def eccentric_from_true(true_anomaly: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Give the eccentric anomaly E of the true anomaly ν on an ellipse.

    tan(ν/2) = √((1+e)/(1−e)) tan(E/2). Whole turns are kept.

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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.eccentric_from_true(1.0, 0.5)), 12)
    0.611063702733
    """
    return _anomaly("eccentric_from_true", "true_anomaly", true_anomaly, eccentricity)


@known_keywords
def hyperbolic_from_true(
    true_anomaly: ArrayLike, eccentricity: ArrayLike, *, repulsive: bool = False
) -> NDArray[np.float64]:
    """Give the hyperbolic anomaly H of the true anomaly ν on a hyperbola.

    tan(ν/2) = √((e+1)/(e−1)) tanh(H/2) (repulsion: the inverse root).

    Parameters
    ----------
    true_anomaly : array_like
        In radians, inside the asymptotes.
    eccentricity : array_like
        e > 1.
    repulsive : bool, optional
        Whether the centre repels: the other branch of the hyperbola.

    Returns
    -------
    ndarray
        Hyperbolic anomaly H, of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For an eccentricity or angle out of range, NaN or infinity, or shapes that do not broadcast.

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.hyperbolic_from_true(1.0, 1.5)), 12)
    0.498713495861
    """
    return _anomaly("hyperbolic_from_true", "true_anomaly", true_anomaly, eccentricity, repulsive)


@known_keywords
def parabolic_from_true(true_anomaly: ArrayLike) -> NDArray[np.float64]:
    """Give the parabolic anomaly D of the true anomaly ν on a parabola.

    tan(ν/2) = D.

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

    Examples
    --------
    >>> import visviva as vv
    >>> round(float(vv.orbits.parabolic_from_true(1.0)), 12)
    0.546302489844
    """
    return _anomaly("parabolic_from_true", "true_anomaly", true_anomaly, 0.0)


def _anomaly(
    name: str, argument: str, anomaly: ArrayLike, eccentricity: ArrayLike, repulsive: object = False
) -> NDArray[np.float64]:
    if not isinstance(repulsive, (bool, np.bool_)):
        raise InvalidInput("repulsive", f"expected True or False, got {repulsive!r}")
    shape, flat, _ = broadcast({argument: anomaly, "eccentricity": eccentricity}, {})
    return shaped(_core.orbit_anomaly(name, flat[0], flat[1], bool(repulsive)), shape)
