"""Rotations as quaternions, matrices and rotation vectors."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._keywords import known_keywords
from visviva._packages import needed
from visviva.errors import InvalidInput
from visviva.rigid._arguments import checked_rows, map_rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from scipy.spatial.transform import Rotation


@known_keywords
def quaternion_product(a: ArrayLike, b: ArrayLike) -> NDArray[np.float64]:
    """Rotate by b, then by a.

    Units: none: rotations are without dimension.

    Parameters
    ----------
    a, b : array_like, shape (…, 4)
        Quaternions (x, y, z, w).

    Returns
    -------
    ndarray, shape (…, 4)
        Their product.

    Raises
    ------
    InvalidInput
        For a quaternion whose length is not 1 within 1e-6, or axes that do not broadcast.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5 (the parameters of Euler).

    Examples
    --------
    >>> import visviva as vv
    >>> half_turn = [0.0, 0.0, 1.0, 0.0]
    >>> vv.rigid.quaternion_product(half_turn, half_turn)
    array([ 0.,  0.,  0., -1.])
    """
    return map_rows(_core.rotation_product, (4,), ("a", a, (4,)), ("b", b, (4,)))


@known_keywords
def rotate(quaternion: ArrayLike, vector: ArrayLike) -> NDArray[np.float64]:
    """Rotate vectors: those of the body, seen in space.

    Units: those of the vectors; quaternions are without dimension.

    Parameters
    ----------
    quaternion : array_like, shape (…, 4)
        (x, y, z, w).
    vector : array_like, shape (…, 3)
        What to rotate.

    Returns
    -------
    ndarray, shape (…, 3)
        To 4 ε of the length of the vector.

    Raises
    ------
    InvalidInput
        As `quaternion_product`.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5 (the parameters of Euler).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.rotate([0.6, 0.0, 0.8, 0.0], [1.0, 0.0, 0.0])
    array([-0.28,  0.  ,  0.96])
    """
    return _rotated(quaternion, vector, back=False)


@known_keywords
def rotate_back(quaternion: ArrayLike, vector: ArrayLike) -> NDArray[np.float64]:
    """Rotate vectors the opposite way: those of space, seen in the body.

    Units: those of the vectors; quaternions are without dimension.

    Parameters
    ----------
    quaternion : array_like, shape (…, 4)
        (x, y, z, w).
    vector : array_like, shape (…, 3)
        What to rotate.

    Returns
    -------
    ndarray, shape (…, 3)
        To 4 ε of the length of the vector.

    Raises
    ------
    InvalidInput
        As `quaternion_product`.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5 (the parameters of Euler).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.rotate_back([0.6, 0.0, 0.0, 0.8], [0.0, 1.0, 0.0])
    array([ 0.  ,  0.28, -0.96])
    """
    return _rotated(quaternion, vector, back=True)


def _rotated(quaternion: ArrayLike, vector: ArrayLike, back: bool) -> NDArray[np.float64]:
    function = partial(_core.rotated, back=back)
    return map_rows(function, (3,), ("quaternion", quaternion, (4,)), ("vector", vector, (3,)))


@known_keywords
def matrix(quaternion: ArrayLike) -> NDArray[np.float64]:
    """Give the matrices of rotations; their columns are the body's axes in space.

    Units: none: rotations are without dimension.

    Parameters
    ----------
    quaternion : array_like, shape (…, 4)
        (x, y, z, w).

    Returns
    -------
    ndarray, shape (…, 3, 3)
        Rotation matrices.

    Raises
    ------
    InvalidInput
        For a quaternion whose length is not 1 within 1e-6.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5 (the parameters of Euler).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.matrix([0.0, 0.0, 1.0, 0.0])
    array([[-1.,  0.,  0.],
           [ 0., -1.,  0.],
           [ 0.,  0.,  1.]])
    """
    return _form("matrix", (3, 3), ("quaternion", quaternion, (4,)))


@known_keywords
def quaternion_from_matrix(matrix: ArrayLike) -> NDArray[np.float64]:
    """Give the quaternions of rotation matrices.

    Units: none: rotations are without dimension.

    Parameters
    ----------
    matrix : array_like, shape (…, 3, 3)
        Rotation matrices.

    Returns
    -------
    ndarray, shape (…, 4)
        (x, y, z, w), to 4 ε; of the two signs, that with which the largest part is positive.

    Raises
    ------
    InvalidInput
        For a matrix whose columns are not unit vectors at right angles within 1e-6, or a reflection.

    Notes
    -----
    Shepperd's choice of the largest part (J. Guidance 1 (1978) 223), and one step of the power method with the matrix
    4 q qᵀ that the rotation matrix tells.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.quaternion_from_matrix([[-1, 0, 0], [0, -1, 0], [0, 0, 1]])
    array([0., 0., 1., 0.])
    """
    return _form("from_matrix", (4,), ("matrix", matrix, (3, 3)))


@known_keywords
def rotation_vector(quaternion: ArrayLike) -> NDArray[np.float64]:
    """Give the vectors about which to rotate, by their lengths.

    Units: angles in radians; quaternions are without dimension.

    Parameters
    ----------
    quaternion : array_like, shape (…, 4)
        (x, y, z, w).

    Returns
    -------
    ndarray, shape (…, 3)
        Of lengths in [0, π].

    Raises
    ------
    InvalidInput
        For a quaternion whose length is not 1 within 1e-6.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5–4.7.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.rotation_vector([0.0, 0.0, 1.0, 0.0])
    array([0.        , 0.        , 3.14159265])
    """
    return _form("rotation_vector", (3,), ("quaternion", quaternion, (4,)))


@known_keywords
def quaternion_from_rotation_vector(rotation_vector: ArrayLike) -> NDArray[np.float64]:
    """Give the quaternions of rotations about vectors, by their lengths.

    Units: angles in radians; quaternions are without dimension.

    Parameters
    ----------
    rotation_vector : array_like, shape (…, 3)
        Of any length.

    Returns
    -------
    ndarray, shape (…, 4)
        (x, y, z, w).

    Raises
    ------
    InvalidInput
        For NaN or infinity, or another shape.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 4.5–4.7.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.rigid.quaternion_from_rotation_vector([0.0, 0.0, np.pi]).round(15)
    array([0., 0., 1., 0.])
    """
    return _form("from_rotation_vector", (4,), ("rotation_vector", rotation_vector, (3,)))


@known_keywords
def from_scipy(rotation: Rotation) -> NDArray[np.float64]:
    """Give the quaternions of a ``scipy.spatial.transform.Rotation``.

    Units: none: rotations are without dimension.

    Parameters
    ----------
    rotation : scipy.spatial.transform.Rotation
        One rotation or several.

    Returns
    -------
    ndarray, shape (…, 4)
        (x, y, z, w).

    Raises
    ------
    InvalidInput
        For what is no rotation of SciPy.

    Examples
    --------
    >>> import visviva as vv
    >>> from scipy.spatial.transform import Rotation
    >>> vv.rigid.from_scipy(Rotation.identity())
    array([0., 0., 0., 1.])
    """
    if not hasattr(rotation, "as_quat"):
        raise InvalidInput("rotation", f"expected a scipy.spatial.transform.Rotation, got {type(rotation).__name__}")
    return np.asarray(checked_rows("rotation", rotation, (4,)))


@known_keywords
def to_scipy(quaternion: ArrayLike) -> Rotation:
    """Give a ``scipy.spatial.transform.Rotation`` of quaternions; needs SciPy.

    Units: none: rotations are without dimension.

    Parameters
    ----------
    quaternion : array_like, shape (…, 4)
        (x, y, z, w).

    Returns
    -------
    scipy.spatial.transform.Rotation
        The same rotations. Its ``apply`` refuses vectors that are read-only, as those of results are: give it a copy,
        or use `rotate`.

    Raises
    ------
    InvalidInput
        For a quaternion whose length is not 1 within 1e-6.
    MissingPackage
        Without the package scipy: ``pip install 'visviva[scipy]'``.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.to_scipy([0.0, 0.0, 1.0, 0.0]).apply([1.0, 0.0, 0.0])
    array([-1.,  0.,  0.])
    """
    module = needed("scipy.spatial.transform", "to_scipy")
    made: Rotation = module.Rotation.from_quat(_form("normalized", (4,), ("quaternion", quaternion, (4,))))
    return made


def _form(name: str, result: tuple[int, ...], argument: tuple[str, ArrayLike, tuple[int, ...]]) -> NDArray[np.float64]:
    """Give another form of each rotation, by its name in the core."""
    return map_rows(partial(_core.rotation_form, name), result, argument)
