"""The same rigid bodies elsewhere: displaced, boosted, turned, backward, or in other units.

The one idea: each is made anew of changed numbers, by `_changed`, and so is checked as any other.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import in_range, positive
from visviva._keywords import known_keywords
from visviva._moves import displacement, orthogonal
from visviva._names import body_label
from visviva.errors import InvalidInput
from visviva.rigid._orientation import quaternion_from_matrix, quaternion_product

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.rigid_bodies import RigidBodies

__all__ = ["FramedBodies"]


@known_keywords
class FramedBodies:
    """Base of `RigidBodies`: what can be seen from another frame."""

    __slots__ = ()

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    orientation: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    pivot: NDArray[np.float64] | None
    names: tuple[str, ...]
    pivoted: NDArray[np.bool_]

    @abstractmethod
    def _changed(self, **changes: ArrayLike | None) -> RigidBodies:
        """The same bodies with other numbers."""

    def shifted(self, position: ArrayLike, velocity: ArrayLike) -> RigidBodies:
        """The bodies displaced by ``position`` (3,) and boosted by ``velocity`` (3,).

        Units: those of the scene.

        Parameters
        ----------
        position, velocity : array_like, shape (3,)
            By what is displaced, and boosted.

        Returns
        -------
        RigidBodies

        Raises
        ------
        visviva.InvalidInput
            For what are not three numbers each; for a boost of a body with a fixed point, which would move.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> wheel = vv.RigidBody(1.0, [1.0, 1.0, 2.0], name="wheel")
        >>> vv.Scene(wheel).rigid_bodies.shifted(np.array([1.0, 0.0, 0.0]), np.zeros(3)).position
        array([[1., 0., 0.]])
        """
        moved_by, boost = displacement(position, velocity)
        if boost.any() and self.pivoted.any():
            which = body_label(int(np.flatnonzero(self.pivoted)[0]), self.names)
            raise InvalidInput(
                "velocity", f"the fixed point of {which} would move in the boosted frame; shift the position only"
            )
        return self._changed(position=self.position + moved_by, velocity=self.velocity + boost)

    def rotated(self, rotation: ArrayLike) -> RigidBodies:
        """The bodies turned (or reflected) about the origin by an orthogonal matrix (3, 3).

        A reflected body is the mirrored one, of which all places in the body change sign.

        Units: the matrix is without dimension.

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            An orthogonal matrix; of determinant −1 a reflection.

        Returns
        -------
        RigidBodies

        Raises
        ------
        visviva.InvalidInput
            For a matrix that is not orthogonal.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> wheel = vv.RigidBody(1.0, [1.0, 1.0, 2.0], position=[1.0, 0.0, 0.0])
        >>> quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        >>> vv.Scene(wheel).rigid_bodies.rotated(quarter).position
        array([[0., 1., 0.]])
        """
        matrix = orthogonal(rotation)
        sign = np.sign(np.linalg.det(matrix))
        turn = quaternion_from_matrix(sign * matrix)
        return self._changed(
            position=self.position @ matrix.T,
            velocity=np.where(self.pivoted[:, None], 0.0, self.velocity @ matrix.T),
            orientation=quaternion_product(turn, self.orientation),
            pivot=None if self.pivot is None else sign * self.pivot,
        )

    def reversed(self) -> RigidBodies:
        """The bodies with their velocities and spins, shape (K, 3), reversed.

        Returns
        -------
        RigidBodies
            With −v and −ω, shape (K, 3); all else as it was.

        Examples
        --------
        >>> import visviva as vv
        >>> wheel = vv.RigidBody(1.0, [1.0, 1.0, 2.0], angular_velocity=[0.0, 0.0, 3.0])
        >>> vv.Scene(wheel).rigid_bodies.reversed().angular_velocity + 0.0
        array([[ 0.,  0., -3.]])
        """
        return self._changed(velocity=-self.velocity, angular_velocity=-self.angular_velocity)

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> RigidBodies:
        """The same bodies in other units.

        Parameters
        ----------
        length, mass, time : float
            How many new units make one old unit. Powers of two change no bit of any mantissa.

        Returns
        -------
        RigidBodies
            With arrays of the same shapes.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a number would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.RigidBody(1.0, [1.0, 2.0, 2.5]).rescaled(length=10.0).principal_moments
        array([[100., 200., 250.]])
        """
        for name, scale in (("length", length), ("mass", mass), ("time", time)):
            positive(name, scale, "number of new units per old one")
        scales = {
            "mass": mass,
            "moments": mass * length * length,
            "inertia": mass * length * length,
            "position": length,
            "velocity": length / time,
            "angular_velocity": 1.0 / time,
            "pivot": length,
        }
        new = {}
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):  # in_range tells it better
            for name, scale in scales.items():
                if (old := getattr(self, name)) is not None:
                    known = ~np.isnan(old)  # but of pivots, that is all
                    new[name] = np.where(
                        known, in_range(name, np.where(known, old, 0.0), np.where(known, old * scale, 0.0)), old
                    )
        return self._changed(**new)
