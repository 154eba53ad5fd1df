"""Thin bodies of uniform density: rods along z, discs and plates across it, their centers of mass at the origin."""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva._keywords import known_keywords
from visviva.rigid._solids import solid_of_kind

if TYPE_CHECKING:
    from visviva.rigid._mass import MassProperties


@known_keywords
def rod(mass: float, length: float) -> MassProperties:
    """Give a thin rod along z, which has no moment about itself.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, length : float
        Positive.

    Returns
    -------
    MassProperties
        About the middle. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 32, problem 2.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.rod(12.0, 1.0).tensor.diagonal()
    array([1., 1., 0.])
    """
    return solid_of_kind("rod", mass, length=length)


@known_keywords
def disc(mass: float, radius: float, *, inner_radius: float = 0.0) -> MassProperties:
    """Give a thin disc across z, with a hole of the inner radius; with ``inner_radius=radius`` a thin ring.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, radius : float
        Positive.
    inner_radius : float
        From 0 to the radius.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length out of range.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3; Landau & Lifshitz, *Mechanics*, 3rd ed., § 32,
    problem 2 (limits of the cylinder and the box).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.disc(4.0, 1.0).tensor.diagonal()
    array([1., 1., 2.])
    """
    return solid_of_kind("disc", mass, radius=radius, inner_radius=inner_radius)


@known_keywords
def plate(mass: float, a: float, b: float) -> MassProperties:
    """Give a thin rectangle with sides a, b along x, y.

    Units: those of the caller; the tensor is in mass · length².

    Parameters
    ----------
    mass, a, b : float
        Positive.

    Returns
    -------
    MassProperties
        About the center. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3; Landau & Lifshitz, *Mechanics*, 3rd ed., § 32,
    problem 2 (limits of the cylinder and the box).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.plate(12.0, 1.0, 2.0).tensor.diagonal()
    array([4., 1., 5.])
    """
    return solid_of_kind("plate", mass, a=a, b=b)
