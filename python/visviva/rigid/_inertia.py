"""Inertia tensors: of particles, about other points, in other axes, and their principal axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva import _core
from visviva._arrays import float_array, mass_array, positive
from visviva._html import brief_tuple
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._arguments import checked_rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

# How far entries that should be equal may differ, relative to the largest, as in the core.
_ROUNDING = 1e-12


@known_keywords
class PrincipalAxes(NamedTuple):
    """Principal moments and the axes that they belong to.

    Units: those of the caller; a tensor is in mass · length².

    Attributes
    ----------
    moments : ndarray, shape (3,)
        In ascending order.
    axes : ndarray, shape (3, 3)
        As columns, right-handed: ``axes @ np.diag(moments) @ axes.T`` is the tensor, and the rotation matrix from the
        principal axes to those of the tensor.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.4.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> found = vv.rigid.principal_axes([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 3.5]])
    >>> found.moments.round(12), bool(np.isclose(np.linalg.det(found.axes), 1.0))
    (array([1. , 3. , 3.5]), True)
    """

    moments: NDArray[np.float64]
    axes: NDArray[np.float64]

    def __repr__(self) -> str:
        return brief_tuple(self)


@known_keywords
def inertia_tensor(mass: ArrayLike, position: ArrayLike) -> NDArray[np.float64]:
    """Give the inertia tensor of particles about the origin, Σ m (r² − r rᵀ).

    Units: those of the caller; a tensor is in mass · length².

    Parameters
    ----------
    mass : array_like, shape (N,)
        Not negative.
    position : array_like, shape (N, 3)
        Where they are.

    Returns
    -------
    ndarray, shape (3, 3)
        Summed in double-double.

    Raises
    ------
    InvalidInput
        For a negative mass, NaN or infinity, or shapes that do not agree.

    See Also
    --------
    particles : the same with the center of mass, and about it.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.inertia_tensor([1.0, 1.0], [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    array([[0., 0., 0.],
           [0., 2., 0.],
           [0., 0., 2.]])
    """
    masses, positions = checked_particles(mass, position)
    return _core.particles_tensor(masses, positions) + 0.0


def checked_particles(mass: ArrayLike, position: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Masses and positions of particles, judged."""
    sizes: dict[str, tuple[int, str]] = {}
    masses = mass_array(mass, ("N",), sizes)
    return masses, float_array("position", position, ("N", 3), sizes)


def symmetric(tensor: ArrayLike) -> NDArray[np.float64]:
    """An inertia tensor, symmetric to the last bit."""
    array = float_array("tensor", tensor, (3, 3))
    apart = np.abs(array - array.T)
    if (apart > _ROUNDING * np.abs(array).max()).any():
        i, j = np.unravel_index(int(apart.argmax()), (3, 3))
        message = (
            f"expected a symmetric tensor, but tensor[{i}, {j}] = {array[i, j]} and tensor[{j}, {i}] = {array[j, i]}"
        )
        raise InvalidInput("tensor", message)
    return np.where(apart == 0.0, array, 0.5 * array + 0.5 * array.T)


@known_keywords
def principal_axes(tensor: ArrayLike) -> PrincipalAxes:
    """Give the principal moments of inertia and the principal axes.

    Units: those of the caller; a tensor is in mass · length².

    Parameters
    ----------
    tensor : array_like, shape (3, 3)
        An inertia tensor.

    Returns
    -------
    PrincipalAxes
        ``moments``, ascending, and ``axes`` as columns, right-handed. The same tensor always gives the same axes: of
        the first two the largest component is positive, and where moments agree (a sphere, a symmetric body) the axes
        are turned no more than they must be: those of a diagonal tensor are the axes themselves.

    Raises
    ------
    InvalidInput
        For a tensor that is not symmetric, or moments that are those of no body: negative, or one of them larger than
        the other two together, by more than rounding (1e-12).

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.4.

    Examples
    --------
    >>> import visviva as vv
    >>> moments, axes = vv.rigid.principal_axes([[5.0, -2.0, 0.0], [-2.0, 5.0, 0.0], [0.0, 0.0, 4.0]])
    >>> moments.round(12)
    array([3., 4., 7.])
    >>> axes.round(3)
    array([[ 0.707,  0.   ,  0.707],
           [ 0.707,  0.   , -0.707],
           [ 0.   ,  1.   ,  0.   ]])
    """
    return PrincipalAxes(*_core.principal_axes(float_array("tensor", tensor, (3, 3))))


@known_keywords
def parallel_axis(tensor: ArrayLike, mass: float, offset: ArrayLike) -> NDArray[np.float64]:
    """Give a tensor about another point, from that about the center of mass (Steiner): I + m (a² − a aᵀ).

    Units: those of the caller; a tensor is in mass · length².

    Parameters
    ----------
    tensor : array_like, shape (3, 3)
        About the center of mass.
    mass : float
        Of the body.
    offset : array_like, shape (3,)
        From the center of mass to the point, or the other way.

    Returns
    -------
    ndarray, shape (3, 3)
        About that point.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, a tensor that is not symmetric, NaN or infinity, or another shape.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.rigid.parallel_axis(np.diag([1.0, 1.0, 0.0]), 3.0, [0.0, 0.0, 2.0])
    array([[13.,  0.,  0.],
           [ 0., 13.,  0.],
           [ 0.,  0.,  0.]])
    """
    checked, weight = symmetric(tensor), positive("mass", mass, "mass")
    return _core.tensor_about(checked, weight, float_array("offset", offset, (3,))) + 0.0


@known_keywords
def rotate_tensor(tensor: ArrayLike, quaternion: ArrayLike) -> NDArray[np.float64]:
    """Give the tensor of a body that is rotated, R I Rᵀ; from the body's axes to space.

    Units: the quaternion is without dimension, the tensor in mass · length².

    Parameters
    ----------
    tensor : array_like, shape (3, 3)
        Along the body's axes.
    quaternion : array_like, shape (4,)
        (x, y, z, w), from the body to space.

    Returns
    -------
    ndarray, shape (3, 3)
        Along the axes of space, symmetric.

    Raises
    ------
    InvalidInput
        For a quaternion whose length is not 1 within 1e-6, a tensor that is not symmetric, or another shape.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.4.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.rigid.rotate_tensor(np.diag([1.0, 2.0, 3.0]), [0.5, 0.5, 0.5, 0.5])
    array([[3., 0., 0.],
           [0., 1., 0.],
           [0., 0., 2.]])
    """
    turn = float_array("quaternion", checked_rows("quaternion", quaternion, (4,)), (4,))
    return _core.tensor_rotated(symmetric(tensor), turn) + 0.0
