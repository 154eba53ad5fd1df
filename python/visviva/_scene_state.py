"""What a scene tells of its present state: accelerations, invariants and orbital elements.

The idea of this room: nothing runs. Each is computed from the bodies and forces as they are at the scene's time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from visviva import _core
from visviva import forces as force_classes
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva._body_force import BodyForce
    from visviva.forces import Force
    from visviva.invariants import Invariants
    from visviva.orbits import Elements
    from visviva.particles import Particles
    from visviva.rigid_bodies import RigidBodies
    from visviva.scene import Scene

__all__ = ["AtPresent"]


@known_keywords
class AtPresent:
    """A base of `Scene`: what follows from its state without a run."""

    __slots__ = ()

    if TYPE_CHECKING:  # fields of a scene
        particles: Particles
        forces: tuple[Force, ...]
        t0: float
        rigid_bodies: RigidBodies | None
        body_forces: tuple[BodyForce, ...]
        _keywords: _core._Scene

    @property
    def _turns_freely(self) -> bool:
        """Whether nothing turns the rigid bodies, if there are some."""
        rigid = self.rigid_bodies
        if rigid is None:
            return True
        round_ones = (rigid.principal_moments == rigid.principal_moments[:, :1]).all()
        pulled = len(self.particles) > 1 and any(isinstance(force, force_classes.Gravity) for force in self.forces)
        return not (self.body_forces or rigid.pivoted.any() or (pulled and not round_ones))

    def acceleration(self) -> NDArray[np.float64]:
        """Accelerations of the bodies at the scene's state and time, shape (N, 3), in the units of the scene.

        Returns
        -------
        ndarray, shape (N, 3)
            Length per time², in the units of the scene; of rigid bodies that of their centers, after the particles.

        Raises
        ------
        visviva.InvalidInput
            Beside rigid bodies that torques turn.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.Scene(vv.Particles([8.0, 0.0], [[0, 0, 0], [2, 0, 0]]), vv.Gravity(G=1.0)).acceleration()[1]
        array([-2.,  0.,  0.])
        """
        from visviva._mergers import hosts, remaining

        if not self._turns_freely:
            raise InvalidInput("rigid_bodies", "accelerations are not available for rigid bodies under torques")

        p = self.particles
        parts = hosts(p)
        if parts is not None:
            place = np.searchsorted(np.unique(parts), parts)
            return remaining(cast("Scene", self), parts).acceleration()[place]
        return _core.acceleration(
            mass=p.mass, forces=self._keywords["forces"], position=p.position, velocity=p.velocity, t0=self.t0
        )

    def invariants(self, about: ArrayLike | str | None = None) -> Invariants:
        """Momentum, angular momentum, energy, center of mass and König's split at the scene's state.

        Units: those of the scene.

        Parameters
        ----------
        about : array_like, shape (3,), or "center_of_mass", optional
            The reference point of angular momentum, torque and virial; the origin by default.

        Returns
        -------
        Invariants

        Raises
        ------
        visviva.InvalidInput
            For another reference point.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.problems.pythagorean().scene.invariants().energy
        -12.816666666666666
        """
        from visviva.invariants import invariants_of

        return invariants_of(cast("Scene", self), about)

    def elements(
        self,
        bodies: str | int | Sequence[str | int] | None = None,
        *,
        about: str | int = 0,
        G: float | None = None,
    ) -> Elements:
        """The osculating elements of bodies at the scene's state: the way back from `Particles.from_elements`.

        Units: those of the scene; angles in radians.

        Parameters
        ----------
        bodies, about, G : optional
            As of `Trajectory.elements`.

        Returns
        -------
        Elements
            Arrays of shape (K,) for K bodies, numbers for one that was given alone.

        Raises
        ------
        visviva.InvalidInput
            As of `Trajectory.elements`.

        References
        ----------
        Murray & Dermott, *Solar System Dynamics* (1999), § 2.8; § 9.7 for Jacobi coordinates.

        Examples
        --------
        >>> import visviva as vv
        >>> planets = vv.datasets.outer_solar_system().scene
        >>> planets.elements(about="Sun").eccentricity.round(3).tolist()
        [0.048, 0.053, 0.046, 0.007, 0.255]
        """
        from visviva._mergers import hosts
        from visviva._osculating import elements_of

        p = self.particles
        parts = hosts(p)
        merged = None if parts is None else (parts != np.arange(len(p)), p.mass)
        return elements_of(cast("Scene", self), p.position, p.velocity, bodies, about, G, merged)
