"""What can be said of a free rotation as a whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva import _core
from visviva._arrays import float_array
from visviva._html import Record
from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

_Kind = Literal["steady", "symmetric", "about_smallest", "about_largest", "separatrix"]


@known_keywords
@dataclass(frozen=True, eq=False, kw_only=True, slots=True, repr=False)
class Polhode(Record):
    """The path of the angular momentum in the body; what :func:`polhode` returns.

    Units: those of the caller, one consistent system; angles in radians.

    Attributes
    ----------
    kind : str
        ``"steady"``: the angular velocity stays what it is, in the body and in space; ``"symmetric"``: it goes round
        the axis of a symmetric body; ``"about_smallest"``, ``"about_largest"``: it goes round the axis of that moment;
        ``"separatrix"``: it comes ever nearer to the axis of the moment between.
    axis : int or None
        The axis that the angular momentum goes round, and to which it keeps the same side (on the separatrix: that of
        the largest moment); None if it is steady.
    middle_axis : int or None
        The axis about which its component changes sign every `flip_time`.
    rate : float
        λ, that of the argument of the elliptic functions.
    modulus, complement : float
        k and √(1 − k²), each to its last digits.
    period : float
        After which the angular velocity in the body is the same again, 4K/λ; infinite where it never is, or always.
    flip_time : float
        Between two times at which the component along the middle axis changes sign: half the period.
    precession_rate : float
        The mean rate at which the body's `axis` goes round the angular momentum; of a steady motion, |ω|.
    largest : ndarray, shape (3,)
        The largest angular momentum along each axis of the body, with the sign that it has at time 0.
    moments, angular_velocity : ndarray, shape (3,)
        As given: the principal moments, and the angular velocity along their axes at time 0.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 37.

    Examples
    --------
    >>> import visviva as vv
    >>> found = vv.rigid.polhode([1.0, 2.0, 3.0], [0.1, 1.0, 0.3])
    >>> found.kind, found.axis, found.middle_axis
    ('about_largest', 2, 1)
    """

    kind: _Kind
    axis: int | None
    middle_axis: int | None
    rate: float
    modulus: float
    complement: float
    period: float
    flip_time: float
    precession_rate: float
    largest: NDArray[np.float64]
    moments: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]

    def plot(self, *, ax: Axes | None = None) -> Figure:
        """Draw the path of the angular velocity on the inertia ellipsoid, all of it, and the separatrix in gray.

        Of a motion over times of your own, as it is at each of them, see `FreeRotation.plot`.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where, of three dimensions; a figure of its own if not given.

        Returns
        -------
        matplotlib.figure.Figure
            With one panel; that of ``ax`` if that is given. Its axes are ω / √2T, in which the ellipsoid is Σ I x² = 1.

        Raises
        ------
        InvalidInput
            For axes of two dimensions, a body at rest, the inertia ellipsoid of a rod, which has no end, or if
            matplotlib is not installed.

        References
        ----------
        Landau & Lifshitz, *Mechanics*, 3rd ed., § 37; Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.6.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.rigid.polhode([1.0, 2.0, 3.0], [0.1, 1.0, 0.3]).plot().axes[0].get_title()
        'polhode'
        """
        from visviva.rigid._pictures import plot_polhode

        return plot_polhode(self, ax)


@known_keywords
def polhode(moments: ArrayLike, angular_velocity: ArrayLike) -> Polhode:
    """Describe the free rotation of a body: its kind, period and rates.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    moments : array_like, shape (3,)
        The principal moments of inertia, in any order.
    angular_velocity : array_like, shape (3,)
        Along the body's principal axes.

    Returns
    -------
    Polhode
        See there.

    Raises
    ------
    InvalidInput
        As `free_rotation`.

    Notes
    -----
    Landau & Lifshitz, *Mechanics* § 37.

    Examples
    --------
    >>> import visviva as vv
    >>> path = vv.rigid.polhode([1.0, 2.0, 3.0], [1e-4, 1.0, 1e-4])
    >>> path.kind, path.axis, round(path.period, 9)
    ('about_largest', 2, 71.014506079)
    """
    # Copies, since results are read-only and what was given is the caller's.
    spin, own = (
        np.array(float_array("angular_velocity", angular_velocity, (3,))),
        np.array(float_array("moments", moments, (3,))),
    )
    found = _core.polhode(own, spin)
    steady = found["kind"] == "steady"
    largest = np.array(found["largest"])
    for array in (largest, own, spin):
        array.flags.writeable = False
    return Polhode(
        kind=found["kind"],
        axis=None if steady else found["axes"][2],
        middle_axis=None if steady else found["axes"][1],
        rate=found["rate"],
        modulus=found["modulus"],
        complement=found["complement"],
        period=found["period"],
        flip_time=0.5 * found["period"],
        precession_rate=found["precession"],
        largest=largest,
        moments=own,
        angular_velocity=spin,
    )


@known_keywords
def period(moments: ArrayLike, angular_velocity: ArrayLike) -> float:
    """Give the time after which the angular velocity of a free body is the same again, along its own axes.

    Units: those of the caller's time.

    Parameters
    ----------
    moments, angular_velocity : array_like, shape (3,)
        As in `polhode`.

    Returns
    -------
    float
        4K/λ; infinite on the separatrix, and where the angular velocity is steady.

    Raises
    ------
    InvalidInput
        As `free_rotation`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 37.

    Examples
    --------
    >>> import visviva as vv
    >>> round(vv.rigid.period([0.6, 0.8, 1.0], [3.0, 0.5, -0.9]), 12)
    6.862616178058
    """
    return polhode(moments, angular_velocity).period


@known_keywords
def flip_time(moments: ArrayLike, angular_velocity: ArrayLike) -> float:
    """Give the time between two flips of the middle axis (Dzhanibekov's effect): half the `period`.

    Units: those of the caller's time.

    Parameters
    ----------
    moments, angular_velocity : array_like, shape (3,)
        As in `polhode`.

    Returns
    -------
    float
        2K/λ, between two changes of sign of the angular velocity about the middle axis.

    Raises
    ------
    InvalidInput
        As `free_rotation`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 37.

    Examples
    --------
    >>> import visviva as vv
    >>> round(vv.rigid.flip_time([1.0, 2.0, 3.0], [1e-8, 1.0, 1e-8]), 10)
    67.4128083186
    """
    return polhode(moments, angular_velocity).flip_time


@known_keywords
def precession_rate(moments: ArrayLike, angular_velocity: ArrayLike) -> float:
    """Give the mean rate at which the axis of a free body goes round its angular momentum.

    Parameters
    ----------
    moments, angular_velocity : array_like, shape (3,)
        As in `polhode`.

    Returns
    -------
    float
        In radians per unit of time; of a symmetric body L/A.

    Raises
    ------
    InvalidInput
        As `free_rotation`.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 37.

    Examples
    --------
    >>> import visviva as vv
    >>> round(vv.rigid.precession_rate([2.0, 2.0, 3.0], [0.5, 0.0, 1.25]), 12)
    1.940521837033
    """
    return polhode(moments, angular_velocity).precession_rate
