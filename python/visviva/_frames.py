"""The same scene elsewhere: displaced, boosted, turned, in other units, backward, or in another state.

The one idea: bodies and forces know how they change; a scene of the changed parts is the changed scene.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, Self

from visviva._arrays import float_array, in_range
from visviva._keywords import known_keywords
from visviva._moves import displacement, orthogonal
from visviva._turning import centers_of_turned

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import ArrayLike

    from visviva.forces import Force
    from visviva.particles import Particles
    from visviva.rigid_bodies import RigidBodies

__all__ = ["Framed"]


@known_keywords
class Framed(ABC):
    """What has particles and forces at a time, and can be seen from another frame."""

    __slots__ = ()

    particles: Particles
    forces: tuple[Force, ...]
    t0: float
    rigid_bodies: RigidBodies | None

    @abstractmethod
    def _like(
        self,
        particles: Particles,
        forces: Iterable[Force],
        t0: float,
        change: Callable[[Any], Any] | None = None,
        **turning: Any,
    ) -> Self:
        """One of these parts; rigid bodies and the forces on them as `change` makes them, then turned."""

    def shifted(self, *, position: ArrayLike = (0.0, 0.0, 0.0), velocity: ArrayLike = (0.0, 0.0, 0.0)) -> Self:
        """The scene displaced by `position` and boosted by `velocity`, the fields with it.

        Parameters
        ----------
        position, velocity : array_like, shape (3,), optional
            By what is displaced, and boosted, in the units of the scene; nothing if not given.

        Returns
        -------
        Scene
            In the same units.

        Raises
        ------
        visviva.InvalidInput
            For a boost of a field with a fixed center.

        References
        ----------
        Landau & Lifshitz, *Mechanics*, 3rd ed., § 3 and § 8.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]])).shifted(position=[1.0, 2.0, 3.0])
        >>> scene.particles.position
        array([[1., 2., 3.]])
        """
        moved_by, boost = displacement(position, velocity)
        p = self.particles
        moved = p._changed(position=p.position + moved_by, velocity=p.velocity + boost)
        forces = (force.shifted(moved_by, boost) for force in self.forces)
        return self._like(moved, forces, self.t0, lambda part: part.shifted(moved_by, boost))

    def in_frame(self, *, velocity: ArrayLike, origin: ArrayLike = (0.0, 0.0, 0.0)) -> Self:
        """The scene as seen from a frame that moves at the constant `velocity`: r′ = r − origin − V t.

        Parameters
        ----------
        velocity : array_like, shape (3,)
            Velocity V of the frame, in the units of the scene.
        origin : array_like, shape (3,), optional
            Where the frame's origin is at t = 0, likewise.

        Returns
        -------
        Scene
            With r′ and v′ = v − V, shape (N, 3), in the same units.

        Raises
        ------
        visviva.InvalidInput
            For another shape, NaN or infinity; as `shifted`.

        References
        ----------
        Landau & Lifshitz, *Mechanics*, 3rd ed., § 3 and § 8.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.Scene(vv.Particles([1.0], [[7.0, 0.0, 0.0]], [[4.0, 0.0, 0.0]]), t0=1.0)
        >>> scene.in_frame(velocity=[5.0, 0.0, 0.0]).particles.velocity
        array([[-1.,  0.,  0.]])
        """
        frame = float_array("velocity", velocity, (3,))
        return self.shifted(position=-(float_array("origin", origin, (3,)) + frame * self.t0), velocity=-frame)

    def center_of_mass_frame(self) -> Self:
        """The scene in the frame in which its center of mass rests at the origin.

        Returns
        -------
        Scene
            In the same units; its total momentum is zero but for rounding.

        References
        ----------
        Landau & Lifshitz, *Mechanics*, 3rd ed., § 3 and § 8.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.outer_solar_system().scene.center_of_mass_frame()
        >>> bool(np.abs(scene.invariants().momentum).max() < 1e-18)
        True
        """
        position, velocity = self.particles.center_of_mass()
        return self.shifted(position=-position, velocity=-velocity)

    def rotated(self, rotation: ArrayLike) -> Self:
        """The scene turned (or reflected) about the origin by an orthogonal matrix, shape (3, 3).

        Parameters
        ----------
        rotation : array_like, shape (3, 3)
            The matrix, without dimension; of determinant −1 a reflection.

        Returns
        -------
        Scene
            In the same units, with every vector R·r.

        Raises
        ------
        visviva.InvalidInput
            If the matrix is not orthogonal to 1e-12.

        References
        ----------
        Landau & Lifshitz, *Mechanics*, 3rd ed., § 9.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> mirror = vv.problems.kepler(e=0.5).scene.rotated(np.diag([1.0, -1.0, 1.0]))
        >>> float(mirror.invariants().angular_momentum[2]) < 0.0
        True
        """
        matrix = orthogonal(rotation)
        p = self.particles
        turned = p._changed(position=p.position @ matrix.T, velocity=p.velocity @ matrix.T)
        forces = (force.rotated(matrix) for force in self.forces)
        return self._like(turned, forces, self.t0, lambda part: part.rotated(matrix))

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self:
        """The same scene in other units: how many new units of each kind make one old unit.

        Parameters
        ----------
        length, mass, time : float, optional
            How many new units make one old unit, positive. Powers of two change no bit of any mantissa.

        Returns
        -------
        Scene
            The same motion, every number in the new units.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, a force cannot be scaled, or a number would leave the range of float64.

        References
        ----------
        Landau & Lifshitz, *Mechanics*, 3rd ed., § 10.

        Examples
        --------
        >>> import visviva as vv
        >>> days = vv.problems.outer_solar_system().scene
        >>> f"{days.rescaled(time=1 / 365.25).forces[0].G:.3f}"
        '39.477'
        """
        particles = self.particles.rescaled(length=length, mass=mass, time=time)
        forces = (force.rescaled(length=length, mass=mass, time=time) for force in self.forces)
        scales = {"length": length, "mass": mass, "time": time}
        later = in_range("t0", self.t0, self.t0 * time)
        return self._like(particles, forces, later, lambda part: part.rescaled(**scales))

    def reversed(self) -> Self:
        """The scene with every velocity, shape (N, 3), reversed: its run retraces the path.

        Returns
        -------
        Scene
            In the same units, with −v, shape (N, 3), and every force reversed.

        Raises
        ------
        visviva.InvalidInput
            If a force has no reverse: drag, or a force that goes on with time.

        References
        ----------
        Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), chapter V.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.Scene(vv.Particles([1.0], [[0, 0, 0]], [[1.0, 2.0, 3.0]])).reversed().particles.velocity
        array([[-1., -2., -3.]])
        """
        p = self.particles
        forces = (force.reversed() for force in self.forces)
        return self._like(p._changed(velocity=-p.velocity), forces, self.t0, lambda part: part.reversed())

    def with_state(
        self,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        t0: float | None = None,
        *,
        orientation: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
    ) -> Self:
        """The scene with other positions, velocities, or another time; what is not given stays.

        A fixed point of a rigid body stays where it is in space, unless `position` is given, and the velocity of its
        center of mass follows from `orientation` and `angular_velocity`, unless `velocity` is given.

        Parameters
        ----------
        position, velocity : array_like, shape (N, 3), optional
            Of the particles, then of the centers of mass of rigid bodies, in the units of the scene.
        t0 : float, optional
            The time; that of the scene if not given.
        orientation : array_like, shape (K, 4), optional
            Quaternions (x, y, z, w) of the rigid bodies; as they are if not given.
        angular_velocity : array_like, shape (K, 3), optional
            Along their axes, in radians per time; as they are if not given.

        Returns
        -------
        Scene
            In the same units, with the same forces.

        Raises
        ------
        visviva.InvalidInput
            For another shape, NaN or infinity; an orientation or an angular velocity without rigid bodies; a velocity
            of a body with a fixed point that does not follow from its spin.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.pythagorean().scene
        >>> scene.with_state(2 * scene.particles.position, scene.particles.velocity).particles.position[0]
        array([2., 6., 0.])

        From rest, at the same places:

        >>> float(abs(scene.with_state(velocity=0 * scene.particles.velocity).particles.velocity).max())
        0.0
        """
        state = {name: value for name, value in (("position", position), ("velocity", velocity)) if value is not None}
        moved = self.particles._changed(**state) if state else self.particles
        given = {"orientation": orientation, "angular_velocity": angular_velocity}
        turning: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
        if turning:
            moved = centers_of_turned(self.rigid_bodies, moved, turning, given=frozenset(state))
        return self._like(moved, self.forces, self.t0 if t0 is None else t0, **turning)
