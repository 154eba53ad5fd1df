"""The scene: what there is. Running it is asked of the core; nothing here is mechanics.

The idea of this room: a scene is frozen, so what the core needs to know about it is prepared once,
when it is made, and a run of a closed form costs little more than the call.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from visviva._arrays import number
from visviva._attributes_elsewhere import OF_SCENES
from visviva._body_force import BodyForce
from visviva._continuation import with_continuation
from visviva._frames import Framed
from visviva._html import Sheet
from visviva._keywords import known_keywords
from visviva._scene_boundary import BetweenPlaces
from visviva._scene_parts import bodies_and_particles, sorted_parts
from visviva._scene_state import AtPresent
from visviva._turning import described, joined_bodies, with_centers
from visviva.forces import Force
from visviva.runnable import Runnable
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from visviva import _core
    from visviva._scene_parts import Part
    from visviva.advice import Advice
    from visviva.ensemble import EnsembleScene
    from visviva.particles import Particles
    from visviva.request import RunRequest
    from visviva.rigid_bodies import RigidBodies

__all__ = ["Scene"]


@known_keywords
@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Scene(Runnable[Trajectory], Framed, AtPresent, BetweenPlaces):
    """Particles and the forces on them, at a time.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    *parts : Particles, RigidBodies or Force, or sequence of them
        One `Particles`, any number of `RigidBody` and `RigidBodies`, and of forces, in any order.
    particles : Particles, optional
    forces : sequence of Force, optional
        Parts given by name, as the attributes have them.
    t0 : float, optional
        The time of the given state.

    Attributes
    ----------
    particles : Particles
        All bodies as points: the particles, then the centers of mass of rigid bodies.
    rigid_bodies : RigidBodies or None
    body_forces : tuple
        Forces on points of rigid bodies, and torques.

    Notes
    -----
    Whatever acts on particles acts on the centers of mass of rigid bodies; gravity turns those that are no spheres, too
    (MacCullagh's terms). Bodies that nothing turns move in closed form in their orientation, whatever moves their
    centers. All others take the methods of `visviva.rigid.methods`, with equal steps or with steps that they choose.

    Raises
    ------
    visviva.InvalidInput
        If there is more than one `Particles`, or no body at all, or a part is neither bodies nor a force.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> pair = vv.Particles([0.5, 0.5], [[-0.5, 0, 0], [0.5, 0, 0]], [[0, -0.5, 0], [0, 0.5, 0]])
    >>> out = vv.Scene(pair, vv.Gravity(G=1.0)).run(t=2 * np.pi)
    >>> bool(np.allclose(out.position[-1], pair.position, atol=1e-14))
    True
    """

    particles: Particles
    forces: tuple[Force, ...]
    t0: float
    rigid_bodies: RigidBodies | None
    body_forces: tuple[BodyForce, ...]
    _keywords: _core._Scene = field(init=False, repr=False)

    if not TYPE_CHECKING:  # a type checker that saw this function would let every misspelt name pass

        def __getattr__(self, name: str) -> Any:
            advice = f"; {OF_SCENES[name]}" if name in OF_SCENES else ""
            raise AttributeError(f"'Scene' object has no attribute {name!r}{advice}", name=name, obj=self)

    def __init__(
        self,
        *parts: Part | Sequence[Part],
        particles: Particles | None = None,
        forces: Force | BodyForce | Sequence[Force | BodyForce] = (),
        t0: float = 0.0,
    ) -> None:
        all_parts, found, rigid = sorted_parts(parts, particles, forces)
        bodies = joined_bodies(rigid) if rigid else None
        points = with_centers(found, bodies) if bodies else found[0]
        acting = (part._resolved(points.names, len(points)) for part in all_parts if isinstance(part, Force))
        known_bodies = bodies_and_particles(points, bodies)
        loads = (part._resolved(*known_bodies) for part in all_parts if isinstance(part, BodyForce))
        self._set(points, tuple(acting), number("t0", t0), bodies, tuple(loads))

    def _set(
        self,
        particles: Particles,
        forces: tuple[Force, ...],
        t0: float,
        rigid_bodies: RigidBodies | None,
        body_forces: tuple[BodyForce, ...],
        told: list[dict[str, Any]] | None = None,
    ) -> None:
        object.__setattr__(self, "particles", particles)
        object.__setattr__(self, "forces", forces)
        object.__setattr__(self, "t0", t0)
        object.__setattr__(self, "rigid_bodies", rigid_bodies)
        object.__setattr__(self, "body_forces", body_forces)
        prepared: _core._Scene = {
            "mass": particles.mass[None],
            "position": particles.position[None],
            "velocity": particles.velocity[None],
            "radius": particles.radius[None] if np.count_nonzero(particles.radius) else None,
            "rigid": None if rigid_bodies is None else described(rigid_bodies, body_forces),
            "forces": [force._to_core() for force in forces] if told is None else told,
            "own_forces": None,
            "t0": t0,
            "continuation": None,
        }
        object.__setattr__(self, "_keywords", prepared)

    def __repr__(self) -> str:
        of_points = len(self.particles) - (len(self.rigid_bodies) if self.rigid_bodies else 0)
        points = (self.particles[:of_points],) if of_points or self.rigid_bodies is None else ()
        rigid = () if self.rigid_bodies is None else (self.rigid_bodies,)
        parts = ", ".join(map(repr, (*points, *rigid, *self.forces, *self.body_forces)))
        return f"Scene({parts}, t0={self.t0!r})"

    def _sheet(self) -> Sheet:
        rigid = () if self.rigid_bodies is None else (self.rigid_bodies,)
        parts = ((type(part).__name__, repr(part)) for part in (self.particles, *rigid))
        forces = ((type(force).__name__, repr(force)) for force in (*self.forces, *self.body_forces))
        return Sheet(f"Scene at t0 = {self.t0:g}", [*parts, *forces])

    def _execute(self, request: RunRequest) -> Trajectory:
        if request.save_every is None and request.save_to is None:
            return Runnable._execute(self, request)
        from visviva.saved_runs import run_saved

        return run_saved(self, request)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return (
            self.particles == other.particles
            and self.forces == other.forces
            and self.t0 == other.t0
            and self.rigid_bodies == other.rigid_bodies
            and self.body_forces == other.body_forces
        )

    def __hash__(self) -> int:
        return hash((self.particles, self.forces, self.t0, self.rigid_bodies, self.body_forces))

    def __reduce__(self) -> tuple[Any, ...]:
        turning = (self.rigid_bodies, self.body_forces)
        return _rebuild, (self.particles, self.forces, self.t0, self._keywords["continuation"], *turning)

    @property
    def _names(self) -> tuple[str, ...]:
        return self.particles.names

    def _finished(self, result: dict[str, Any]) -> Trajectory:
        return Trajectory(self, result)

    def ensemble(
        self,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        mass: ArrayLike | None = None,
        radius: ArrayLike | None = None,
        parameters: Mapping[Force | BodyForce | int | str, Mapping[str, ArrayLike]] | None = None,
        orientation: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        moments: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> EnsembleScene:
        """Many copies of the scene that differ in their states, or in the parameters of their forces.

        Units: those of the scene.

        Parameters
        ----------
        position, velocity : array_like, shape (B, N, 3), optional
            One state per copy; what is not given is the scene's own in every copy.
        mass : array_like, shape (B, N), optional
            Masses per copy; of rigid bodies with their `moments` or `inertia`, which belong to them.
        radius : array_like, shape (B, N), optional
            Radii per copy.
        parameters : dict of dict, optional
            For some forces of the scene (each given itself, by the name of its class or, of forces on points, by its
            place among them), values of some of their parameters with a leading axis over the copies:
            ``{force: {"k": values}}``. Those of its potential, of a formula by their names in it, are named alike, and
            copies with equal values share it. Copies share SIMD lanes and threads as those of one set of parameters do,
            unless more than numbers differs: a term that a value of 0 leaves out, a softening, an exponent, a table, a
            formula's parameters. Of forces on rigid bodies numbers and vectors may differ, which bodies, axes and
            functions are meant may not.
        orientation : array_like, shape (B, K, 4), optional
            Quaternions of the rigid bodies per copy; points that are held stay where they are.
        angular_velocity : array_like, shape (B, K, 3), optional
            Their angular velocities per copy.
        moments : array_like, shape (B, K, 3), optional
            Their principal moments of inertia about the center of mass per copy, as `RigidBodies` takes them; points
            that are held stay where they are in the bodies. Copies whose bodies have other symmetries (spheres, two
            equal moments, none, rods) may take other methods, and run apart; the plan is that of the least symmetric.
        inertia : array_like, shape (B, K, 3, 3), optional
            Their inertia tensors per copy, in place of `moments`.

        Returns
        -------
        EnsembleScene

        Raises
        ------
        visviva.InvalidInput
            If nothing is given or the numbers of copies disagree; a force or a parameter that is not there, or a value
            that the force refuses; moments that are those of no body.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.figure_eight().scene
        >>> starts = scene.particles.position + 1e-3 * np.random.default_rng(1).normal(size=(8, 3, 3))
        >>> scene.ensemble(position=starts).run(t=1.0).position.shape
        (8, 2, 3, 3)
        >>> pull = vv.CentralField(vv.potentials.Coulomb(k=-1.0))
        >>> drag = vv.LinearDrag(tau=1.0)
        >>> probe = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 1.0, 0]]), pull, drag)
        >>> out = probe.ensemble(parameters={drag: {"tau": [1.0, 2.0, 4.0]}}).run(t=1.0)
        >>> out.velocity[:, -1, 0, 1].round(3).tolist()
        [0.052, 0.219, 0.355]
        >>> wheel = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 2.0]), vv.AppliedTorque([0.0, 0.0, 1.0]))
        >>> out = wheel.ensemble(moments=[[[1.0, 1.0, 2.0]], [[1.0, 1.0, 0.5]]]).run(t=1.0)
        >>> out.angular_velocity[:, -1, 0, 2].round(9).tolist()
        [0.5, 2.0]
        >>> torques = [[0.0, 0.0, 1.0], [0.0, 0.0, 3.0]]
        >>> out = wheel.ensemble(parameters={"AppliedTorque": {"torque": torques}}).run(t=1.0)
        >>> out.angular_velocity[:, -1, 0, 2].round(9).tolist()
        [0.5, 1.5]
        """
        from visviva.ensemble import EnsembleScene

        return EnsembleScene(
            self,
            position=position,
            velocity=velocity,
            mass=mass,
            radius=radius,
            parameters=parameters,
            orientation=orientation,
            angular_velocity=angular_velocity,
            moments=moments,
            inertia=inertia,
        )

    def advise(self, t: ArrayLike, *, accuracy: float, of: Literal["energy", "position"] = "energy") -> Advice:
        """Which method and which step would hold an error, by a trial of the first stretch of the run.

        Every method of the registry is tried on as much of the run as a reference does in a moment, with ever smaller
        steps until it holds what the stretch may be off, if over the whole span its error grows as theory says: the
        energy of a symplectic method not at all and its phase linearly, any other's linearly and quadratically.

        A first part tells nothing of an encounter that comes after it, nor of chaos that has not begun. So the fastest
        of what was found are then run over the whole span, and made tighter until they hold there, if a reference does
        that in about a second. Of a longer run (`Advice.tried` is the part that every method did) the answer is that
        of its first part: compare two runs, or try the span in which its hardest part is. What may be off is told by
        the two tightest runs of the reference: where they differ by more than what is asked for, no method is named.
        It takes some seconds.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end of the run, or its output times, as of ``run``, in the units of the scene.
        accuracy : float
            The error that may be made, from 5e-13: of the energy, relative to it; of positions, relative to the size of
            the system, the farthest that a body comes from the middle of all, which may move.
        of : {"energy", "position"}, optional
            Of what. Massless bodies have no energy: beside it they are judged by their positions.

        Returns
        -------
        Advice
            Print it; ``scene.run(t, **advice.how)`` runs the fastest.

        Raises
        ------
        visviva.InvalidInput
            For an accuracy that is not between 5e-13 and 1, another word for `of`, times that `run` refuses, or rigid
            bodies: trials know points only.
        visviva.ConvergenceError
            If no method holds it, if no run tells whether one does, or a trial ends early.

        References
        ----------
        Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), IX.8 and X.3.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.outer_solar_system().scene
        >>> advice = scene.advise(1e5, accuracy=1e-8)
        >>> out = scene.run(1e5, **advice.how)
        >>> out.conservation().energy.max < 1e-8
        True
        """
        from visviva.advice import advise
        from visviva.request import PlanRequest

        asked = PlanRequest(t).to_core(self._keywords, self._names)
        return advise(self._keywords, asked, accuracy, of, closed=self._turns_freely and self.plan(t).closed_form)

    def _like(
        self,
        particles: Particles,
        forces: Iterable[Force],
        t0: float,
        change: Callable[[Any], Any] | None = None,
        told: list[dict[str, Any]] | None = None,
        loads: tuple[BodyForce, ...] | None = None,
        **turning: Any,
    ) -> Scene:
        scene = object.__new__(type(self))
        if self.rigid_bodies is None:
            scene._set(particles, tuple(forces), number("t0", t0), None, (), told)
            return scene
        rigid, loads = self.rigid_bodies, self.body_forces if loads is None else loads
        if change is not None:
            rigid, loads = change(rigid), tuple(map(change, loads))
        own = {name: getattr(particles, name)[-len(rigid) :] for name in ("mass", "position", "velocity")}
        rigid = rigid._changed(**(own | turning))
        points = with_centers([particles[: len(particles) - len(rigid)]], rigid, particles.names)
        scene._set(points, tuple(forces), number("t0", t0), rigid, loads, told)
        return scene


def _rebuild(
    particles: Particles,
    forces: tuple[Force, ...],
    t0: float,
    continuation: _core._Continuation | None = None,
    rigid_bodies: RigidBodies | None = None,
    body_forces: tuple[BodyForce, ...] = (),
) -> Scene:
    scene = object.__new__(Scene)
    scene._set(particles, forces, t0, rigid_bodies, body_forces)
    return with_continuation(scene, continuation)


def __dir__() -> list[str]:
    return list(__all__)
