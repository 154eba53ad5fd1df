"""Mass properties: tensors, principal axes, and bodies made of others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva import _core
from visviva._arrays import float_array, mass_array, positive
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._arguments import rows
from visviva.rigid._orientation import rotate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

# How far entries that should be equal may differ, relative to the largest, as in the core.
_ROUNDING = 1e-12


class PrincipalAxes(NamedTuple):
    """Principal moments and the axes that they belong to.

    Attributes
    ----------
    moments : ndarray, shape (3,)
        In ascending order.
    axes : ndarray, shape (3, 3)
        As columns, right-handed: ``axes @ np.diag(moments) @ axes.T`` is the tensor, and the rotation matrix from the
        principal axes to those of the tensor.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> found = vv.rigid.principal_axes([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 3.5]])
    >>> found.moments.round(12), bool(np.isclose(np.linalg.det(found.axes), 1.0))
    (array([1. , 3. , 3.5]), True)
    """

    moments: NDArray[np.float64]
    axes: NDArray[np.float64]


@known_keywords
def inertia_tensor(mass: ArrayLike, position: ArrayLike) -> NDArray[np.float64]:
    """Give the inertia tensor of particles about the origin, Σ m (r² − r rᵀ).

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

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.inertia_tensor([1.0, 1.0], [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    array([[0., 0., 0.],
           [0., 2., 0.],
           [0., 0., 2.]])
    """
    masses, positions = _particles(mass, position)
    return _core.particles_tensor(masses, positions) + 0.0


def _particles(mass: ArrayLike, position: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    sizes: dict[str, tuple[int, str]] = {}
    masses = mass_array(mass, ("N",), sizes)
    return masses, float_array("position", position, ("N", 3), sizes)


def _symmetric(tensor: ArrayLike) -> NDArray[np.float64]:
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

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.rigid.parallel_axis(np.diag([1.0, 1.0, 0.0]), 3.0, [0.0, 0.0, 2.0])
    array([[13.,  0.,  0.],
           [ 0., 13.,  0.],
           [ 0.,  0.,  0.]])
    """
    checked, weight = _symmetric(tensor), positive("mass", mass, "mass")
    return _core.tensor_about(checked, weight, float_array("offset", offset, (3,))) + 0.0


@known_keywords
def rotate_tensor(tensor: ArrayLike, quaternion: ArrayLike) -> NDArray[np.float64]:
    """Give the tensor of a body that is rotated, R I Rᵀ; from the body's axes to space.

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

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.rigid.rotate_tensor(np.diag([1.0, 2.0, 3.0]), [0.5, 0.5, 0.5, 0.5])
    array([[3., 0., 0.],
           [0., 1., 0.],
           [0., 0., 2.]])
    """
    turn = float_array("quaternion", rows("quaternion", quaternion, (4,)), (4,))
    return _core.tensor_rotated(_symmetric(tensor), turn) + 0.0


@known_keywords
@dataclass(frozen=True, eq=False, slots=True)
class MassProperties:
    """Mass, center of mass and inertia tensor of a body; what solids, meshes and composites are made of.

    Two bodies are one by ``+``; ``-`` takes a part out of a body, and refuses what no body is left of.

    Parameters
    ----------
    mass : float
        Positive.
    center : array_like, shape (3,)
        The center of mass.
    tensor : array_like, shape (3, 3)
        The inertia tensor about the center, along the axes of the coordinates.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, a tensor that is not symmetric, NaN or infinity, or another shape.

    Examples
    --------
    A dumbbell of two spheres on a rod:

    >>> import visviva as vv
    >>> ball, rod = vv.rigid.sphere(2.0, 0.1), vv.rigid.rod(0.5, 1.0)
    >>> bell = ball.moved([0.0, 0.0, 0.5]) + ball.moved([0.0, 0.0, -0.5]) + rod
    >>> bell.mass, bell.principal_axes().moments.round(12)
    (4.5, array([0.016     , 1.05766667, 1.05766667]))

    A hollow sphere is a sphere less another:

    >>> (vv.rigid.sphere(8.0, 2.0) - vv.rigid.sphere(1.0, 1.0)).tensor[0, 0].round(12)
    np.float64(12.4)
    """

    mass: float
    center: NDArray[np.float64]
    tensor: NDArray[np.float64]

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", positive("mass", self.mass, "mass"))
        for name, checked in (
            ("center", float_array("center", self.center, (3,))),
            ("tensor", _symmetric(self.tensor)),
        ):
            array = checked + 0.0
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    def about(self, point: ArrayLike) -> NDArray[np.float64]:
        """Give the tensor about a point of the coordinates, by Steiner's theorem.

        Parameters
        ----------
        point : array_like, shape (3,)
            In the coordinates of ``center``.

        Returns
        -------
        ndarray, shape (3, 3)
            Mass times area.

        Raises
        ------
        InvalidInput
            For another shape, NaN or infinity.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> rod = vv.rigid.box(12.0, 1.0, 2.0, 3.0)
        >>> np.diag(rod.about([1.0, 0.0, 0.0]))  # 12 · 1² more across
        array([13., 22., 17.])
        """
        return parallel_axis(self.tensor, self.mass, float_array("point", point, (3,)) - self.center)

    def moved(self, offset: ArrayLike) -> MassProperties:
        """Give the body somewhere else.

        Parameters
        ----------
        offset : array_like, shape (3,)
            By which it is moved.

        Returns
        -------
        MassProperties
            With the same tensor about its center.

        Raises
        ------
        InvalidInput
            For another shape, NaN or infinity.

        Examples
        --------
        >>> import visviva as vv
        >>> rod = vv.rigid.box(12.0, 1.0, 2.0, 3.0)
        >>> rod.moved([1.0, 0.0, 0.0]).center
        array([1., 0., 0.])
        """
        return MassProperties(self.mass, self.center + float_array("offset", offset, (3,)), self.tensor)

    def rotated(self, quaternion: ArrayLike) -> MassProperties:
        """Give the body rotated about the origin.

        Parameters
        ----------
        quaternion : array_like, shape (4,)
            (x, y, z, w), of length 1 within 1e-6.

        Returns
        -------
        MassProperties

        Raises
        ------
        InvalidInput
            For another shape or length, NaN or infinity.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> rod = vv.rigid.box(12.0, 1.0, 2.0, 3.0)
        >>> quarter = vv.rigid.quaternion_from_rotation_vector([0.0, 0.0, np.pi / 2])
        >>> np.diag(rod.rotated(quarter).tensor).round(12)
        array([10., 13.,  5.])
        """
        center = rotate(quaternion, self.center)
        return MassProperties(self.mass, center, rotate_tensor(self.tensor, quaternion))

    def principal_axes(self) -> PrincipalAxes:
        """Give the principal moments about the center and their axes; see `principal_axes`.

        Examples
        --------
        >>> import visviva as vv
        >>> rod = vv.rigid.box(12.0, 1.0, 2.0, 3.0)
        >>> rod.principal_axes().moments
        array([ 5., 10., 13.])
        """
        return principal_axes(self.tensor)

    def __add__(self, other: object) -> MassProperties:
        if not isinstance(other, MassProperties):
            return NotImplemented
        return composite([self, other])

    def __sub__(self, other: object) -> MassProperties:
        if not isinstance(other, MassProperties):
            return NotImplemented
        left = _together([self, other], [1.0, -1.0])
        if not _is_a_body(left.tensor):
            message = (
                f"expected a part of the body that it is taken out of, but what is left has the tensor {left.tensor}"
            )
            raise InvalidInput("other", message)
        return left


def _is_a_body(tensor: NDArray[np.float64]) -> bool:
    try:
        principal_axes(tensor)
    except InvalidInput:
        return False
    return True


def _together(bodies: Sequence[MassProperties], signs: Sequence[float]) -> MassProperties:
    found = _core.bodies_together(
        np.array([sign * body.mass for sign, body in zip(signs, bodies, strict=True)]),
        np.array([body.center for body in bodies]),
        np.array([sign * body.tensor.ravel() for sign, body in zip(signs, bodies, strict=True)]),
    )
    return MassProperties(*found)


@known_keywords
def composite(bodies: list[MassProperties] | tuple[MassProperties, ...]) -> MassProperties:
    """Give bodies together as one.

    Parameters
    ----------
    bodies : sequence of MassProperties
        At least one.

    Returns
    -------
    MassProperties
        About the common center of mass.

    Raises
    ------
    InvalidInput
        For anything else.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.composite([vv.rigid.sphere(1.0, 1.0), vv.rigid.sphere(3.0, 1.0).moved([4.0, 0.0, 0.0])]).center
    array([3., 0., 0.])
    """
    if not isinstance(bodies, list | tuple) or not bodies:
        raise InvalidInput("bodies", f"expected a list of MassProperties, got {bodies!r}")
    for at, body in enumerate(bodies):
        if not isinstance(body, MassProperties):
            raise InvalidInput("bodies", f"expected MassProperties, but bodies[{at}] is {body!r}")
    return _together(bodies, [1.0] * len(bodies))


@known_keywords
def particles(mass: ArrayLike, position: ArrayLike) -> MassProperties:
    """Give the mass properties of particles that keep their distances.

    Parameters
    ----------
    mass : array_like, shape (N,)
        Not negative, and not all zero.
    position : array_like, shape (N, 3)
        Where they are.

    Returns
    -------
    MassProperties
        About the center of mass, to the last digits also where that is far from the origin.

    Raises
    ------
    InvalidInput
        As `inertia_tensor`, and where there is no mass.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.particles([1.0, 1.0], [[1e6, 0.0, 0.0], [1e6 + 2.0, 0.0, 0.0]]).tensor
    array([[0., 0., 0.],
           [0., 2., 0.],
           [0., 0., 2.]])
    """
    masses, positions = _particles(mass, position)
    return MassProperties(*_core.bodies_together(masses, positions, np.zeros((len(masses), 9))))
