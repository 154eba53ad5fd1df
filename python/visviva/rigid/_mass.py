"""Mass properties, and bodies made of others; tensors alone are in `_inertia.py`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive
from visviva._attributes_elsewhere import OF_SOLIDS, no_attribute
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.rigid._inertia import (
    PrincipalAxes,
    checked_particles,
    parallel_axis,
    principal_axes,
    rotate_tensor,
    symmetric,
)
from visviva.rigid._orientation import rotate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, eq=False, slots=True, repr=False)
class MassProperties(Record):
    """Mass, center of mass and inertia tensor of a body; what solids, meshes and composites are made of.

    Two bodies are one by ``+``; ``-`` takes a part out of a body, and refuses what no body is left of.

    Units: those of the caller; a tensor is in mass · length².

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

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3.

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

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_SOLIDS)

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", positive("mass", self.mass, "mass"))
        for name, checked in (
            ("center", float_array("center", self.center, (3,))),
            ("tensor", symmetric(self.tensor)),
        ):
            array = checked + 0.0
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    def about(self, point: ArrayLike) -> NDArray[np.float64]:
        """Give the tensor about a point of the coordinates, by Steiner's theorem.

        Units: those of the caller; a tensor is in mass · length².

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

        Units: those of the caller; a tensor is in mass · length².

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

        Units: the quaternion is without dimension, the tensor in mass · length².

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

        Units: those of the caller; a tensor is in mass · length².

        Returns
        -------
        PrincipalAxes
            ``moments``, shape (3,), and ``axes``, shape (3, 3).

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
        if not is_a_body(left.tensor):
            message = (
                f"expected a part of the body that it is taken out of, but what is left has the tensor {left.tensor}"
            )
            raise InvalidInput("other", message)
        return left


def is_a_body(tensor: NDArray[np.float64]) -> bool:
    """Whether some body has that tensor."""
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

    Units: those of the caller; a tensor is in mass · length².

    Parameters
    ----------
    bodies : sequence of MassProperties
        At least one.

    Returns
    -------
    MassProperties
        About the common center of mass. With ``center``, shape (3,), and ``tensor``, shape (3, 3).

    Raises
    ------
    InvalidInput
        For what is no list of `MassProperties`, or none at all.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3.

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

    Units: those of the caller; a tensor is in mass · length².

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

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 5.3.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.rigid.particles([1.0, 1.0], [[1e6, 0.0, 0.0], [1e6 + 2.0, 0.0, 0.0]]).tensor
    array([[0., 0., 0.],
           [0., 2., 0.],
           [0., 0., 2.]])
    """
    masses, positions = checked_particles(mass, position)
    return MassProperties(*_core.bodies_together(masses, positions, np.zeros((len(masses), 9))))
