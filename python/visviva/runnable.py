"""What can be run: ``run`` and ``plan``, for a scene and for an ensemble of them.

Their arguments are the fields of the request (`visviva.request`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar, cast

from visviva import _core
from visviva._html import Shown
from visviva._keywords import known_keywords
from visviva.plan import Plan
from visviva.request import FlowRequest, MegnoRequest, PlanRequest, RunRequest, asked_by, execute

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from visviva.ensemble import EnsembleScene
    from visviva.megno import Megno
    from visviva.scene import Scene

__all__ = ["Runnable"]

_Result = TypeVar("_Result")


@known_keywords
class Runnable(Shown, ABC, Generic[_Result]):
    """Base of `Scene` and `EnsembleScene`; ``_Result`` is what their runs give."""

    __slots__ = ()

    _is_ensemble: ClassVar[bool] = False
    _keywords: _core._Scene  # what the core is told of what there is

    @property
    @abstractmethod
    def _names(self) -> tuple[str, ...]:
        """Names of the bodies, if they have some."""

    @abstractmethod
    def _finished(self, result: dict[str, Any]) -> _Result:
        """What the user gets for the core's answer."""

    @asked_by(RunRequest)
    def run(self, request: RunRequest) -> _Result:
        """Run the scene, or every copy of an ensemble.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end time, or the output times in the order of the motion, forwards or backwards, in the units of the
            scene. An end time alone records the start and the end.
        method : str or Method, optional
            One of `visviva.methods`, or its name. ``"auto"`` takes a closed form where there is one, else ``"taylor"``
            for up to eight massive bodies or charges that attract or repel each other, alone or in uniform, electric
            and magnetic fields and rotating frames, where few springs hold all bodies, under forces that are linear in
            places and velocities, beside formulas (`ExpressionForce`) of polynomials, sines and cosines, for rigid
            bodies that nothing but their weight and torques along their axes turn, and for those with two equal moments
            that springs hold, ``"dop853"`` beside other formulas, of which its shorter steps see more, else
            ``"verner98"``. A method named here always runs.
        dt : float, optional
            The length of the step of a fixed-step method. It may be negative only in a run backwards in time.
        time_transformation : {"potential_energy", "distance"}, optional
            For the steps of a symplectic method to change without losing what it is for: they are equal not in time but
            in another time, dt ∝ 1/Ω, and `dt` is the first of them; close encounters are resolved. ``"distance"``: Ω =
            Σ 1/r over pairs of bodies one of which has mass and over centers of fields (softened as the forces are, by
            the length of a potential that is finite at r = 0); reversible under any forces of places and time [1]_.
            ``"potential_energy"``: Ω = −V, of bodies with mass under `Gravity` or in an attractive Coulomb
            `CentralField` and nothing else; symplectic [2]_ [3]_. With compositions of leapfrogs (which then begin with
            a drift) two bodies stay on their conic to round-off and err in time alone, through a collision, too. For
            methods with ``Method.time_transformation``; anything else is refused. Made for few bodies, which share a
            step; a massless one has a time of its own, as if it were alone with those that have mass. A state between
            steps costs four of them. Run on from ``final``, `dt` is again the first step.
        rtol : float, optional
            Relative tolerance of an adaptive method, at least 2.3e-14. If not given 1e-9 of a method that is named, and
            1e-12 of what `auto` chooses, whose order is so high that three more digits cost little. A fixed-step method
            refuses it.
        atol : float, array_like of shape (N,), or dict, optional
            Absolute tolerance of an adaptive method, of all bodies or of each; ``{"position": ..., "velocity": ...}``
            has one for each kind. By default, and for a kind left out, `rtol` times the size of the kind at the start.
            The error of each position and velocity in a step is kept to ``atol + rtol * its distance`` from the center
            of the motion. A fixed-step method refuses it.
        max_step : float, optional
            The longest step an adaptive method may take. A fixed-step method refuses it.
        max_steps : int, optional
            The run ends with an error beyond this number of steps, of any method.
        record : str or sequence of str, optional
            Columns to store: ``position``, ``velocity``, ``energy``, ``momentum``,
            ``angular_momentum``, ``center_of_mass``, ``kinetic_energy``, ``potential_energy``, ``virial``, and of rigid
            bodies ``orientation`` and ``angular_velocity``. What is not asked for is not computed. A recorded column
            knows the integrator's states; one computed later, from positions and velocities, may differ in its last
            bits.
        events : sequence, optional
            Of `visviva.events`, or functions ``f(t, position, velocity)``, beside rigid bodies also
            ``f(t, position, velocity, orientation, angular_velocity)``: their zeros on the way come back in
            ``out.events``. They change no bit of the run. A terminal one ends it: rows, ``final`` and the table end
            there, with `Status.STOPPED`; where `t` is an end time, the last row of a single run is that of the event.
            No closed form is used. An ensemble with functions runs on one thread.
        collisions : {"merge", "bounce", "stop"}, optional
            What bodies with a `Particles.radius` do when they touch; by default they pass through each other.
            ``"merge"``: they become one body in the place of the more massive (of equal ones, the first); mass,
            momentum, center of mass and volume are kept, the angular momentum of both about each other is not. The
            other has no mass and no radius from then on and goes with it: ``out.final.particles.mass`` tells, and a run
            with any ``collisions`` goes on from there. Charges add; springs and dampers pull what their ends have
            become, those between two that merge are gone; `Oblate` keeps the shape of a body that is left and loses
            that of one that is not; `PostNewtonian` is of what its bodies are parts of. Other forces are in proportion
            to masses, as `Gravity`, `UniformField` and `LinearDrag` are, or refused. ``"bounce"``: an impulse along the
            line of their centers; a massless body bounces off a massive one, two massless ones as if they had equal
            masses. Of several contacts at one instant those that approach fastest go first, and those of one body that
            approach equally fast together, as symmetry asks [4]_; which are at one instant is told to 1e-12 of the
            radii.
            ``"stop"``: the run ends there, with `Status.STOPPED`. A row at the time of a collision has the state before
            it; steps begin anew after it. All bodies are on the same steps, no closed form is used while two may touch,
            and ``out.collisions`` is the table of them. Spheres that overlap at the start merge there, or are refused
            with the other rules; collisions where no body has a radius are refused. Those that bounce and come to rest
            on each other end the run, with `Status.RESTING`.
        restitution : float, optional
            The part of their speed along the line of centers with which spheres part that bounce, from 0 to 1, the
            default.
        threads : int, optional
            Threads to use; by default ``VISVIVA_THREADS``, else the cores available.
        progress : bool or callable, optional
            True shows a bar (with tqdm installed, else a line): the steps that were taken, or the time that is reached,
            or the copies that are done, with the rate and the time that is left. A callable is called as
            ``f(done, total)``, numbers whose ratio is the part that is done.
        executor : concurrent.futures.Executor or dask.distributed.Client, optional
            Of an ensemble: who runs it. Copies go out in parts, motions come home, with the bits of the run without
            one; the part of a worker that is lost is done again. Each worker uses `threads` threads, or one; `progress`
            counts copies. Events that are functions of one's own stay here, and are refused.
        save_every : float, optional
            Of a scene: the time of the scene after which what was done is written to `save_to`, each time a file. After
            a crash ``visviva.resume(save_to)`` goes on from the last one that is whole, to the bits of a run that none
            broke. Fixed steps (the time is rounded to a whole number of them) have the bits that they have without it;
            adaptive ones, and steps after a collision, are chosen anew after each part. Not with a time transformation
            or functions as events.
        save_to : path-like, optional
            The folder of these files. It is made, in one that exists; it must hold no run yet.

        Returns
        -------
        Trajectory or EnsembleTrajectory
            The latter from an ensemble.

        Raises
        ------
        visviva.InvalidInput
            Something asked for makes no sense; nothing has run.
        visviva.CloseEncounter
            Of a scene: two bodies came so close that the step fell to zero; ``.trajectory`` holds what was done.
        visviva.ConvergenceError
            Of a scene: the step control gave up, `max_steps` was reached, spheres came to rest on each other, or equal
            steps would pass over a wall, a bump or a pulse of an `ExpressionForce` that is narrower than the step;
            ``.trajectory`` likewise. A copy of an ensemble that fails raises nothing: see `EnsembleTrajectory.status`.
        visviva.Interrupted
            Ctrl-C; ``.trajectory`` likewise. It is a `KeyboardInterrupt`, which ``except Exception`` lets pass.

        Warns
        -----
        visviva.AccuracyWarning
            Fixed steps, beside rigid bodies, too, resolved nothing: the energy at the end is off by more than a
            hundredth of kinetic + |potential| (a fiftieth where forces take or give energy and half the steps tell), an
            orbit or a charge in a magnetic field turns in fewer than six steps, a step and two of half its length lead
            to other velocities, or the step is longer than the run. Steps that follow `rtol` (and no `atol`): that
            energy is off by more than 1e4 times it.

        References
        ----------
        .. [1] S. Mikkola and S. Aarseth, Celest. Mech. Dyn. Astron. 84 (2002) 343.
        .. [2] S. Mikkola and K. Tanikawa, Mon. Not. R. Astron. Soc. 310 (1999) 745.
        .. [3] M. Preto and S. Tremaine, Astron. J. 118 (1999) 2532.
        .. [4] J. J. Moreau, in Nonsmooth Mechanics and Applications (Springer, 1988) 1, § 8.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.figure_eight().scene
        >>> out = scene.run(t=[0.0, 1.0, 2.0], method="kahan_li8", dt=0.01)
        >>> out.position.shape, out.stats.steps
        ((3, 3, 3), 200)
        >>> starts = scene.particles.position * np.array([1.0, 0.9])[:, None, None]
        >>> scene.ensemble(position=starts).run(t=1.0).position.shape
        (2, 2, 3, 3)
        """
        return self._execute(request)

    def _execute(self, request: RunRequest) -> _Result:
        return execute(self._keywords, request, names=self._names, ensemble=self._is_ensemble, make=self._finished)

    @asked_by(PlanRequest)
    def plan(self, request: PlanRequest) -> Plan:
        """What `run` would do with the same arguments, without doing it.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end time, or the output times, in the units of the scene.
        method, dt, time_transformation, rtol, atol, max_step, max_steps, record, events, collisions, restitution
            As of `run`.

        Returns
        -------
        Plan
            Print it.

        Raises
        ------
        visviva.InvalidInput
            As `run`.

        Examples
        --------
        >>> import visviva as vv
        >>> plan = vv.problems.outer_solar_system().scene.plan(t=1e6, method="leapfrog", dt=10.0)
        >>> plan.method, plan.evaluations_per_step, plan.pairs_per_evaluation
        ('leapfrog', 1, 15)
        """
        asked = request.to_core(self._keywords, self._names)
        return Plan._from_core(_core.plan(asked), asked)

    @asked_by(MegnoRequest)
    def megno(self, request: MegnoRequest) -> Megno:
        """Whether the motion is regular or chaotic: the mean exponential growth of nearby orbits (MEGNO).

        A neighbor starts next to the scene, or next to each copy of an ensemble, in a random direction, and goes by the
        linear equations of the motion beside it. How far it gets is seen at some 2000 instants. All forces do, and all
        methods but ``taylor`` and those of Boris. In an ensemble copies have the figures that they have alone, but for
        rounding, which close encounters amplify: there a smaller `rtol` tells regular from chaotic.

        Units: those of the scene.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end, or output times in the order of the motion, forwards or backwards. Some hundred periods of the
            slowest motion tell regular from chaotic.
        method, dt, rtol, threads : optional
            As of `run`.
        seed : int, optional
            Of the direction, by NumPy's generator. Regular motions come to 2 from every one, after a hundred periods up
            to some tenths.

        Returns
        -------
        Megno
            Arrays with an axis over copies and one over times; numbers for one scene and one end.

        Raises
        ------
        visviva.InvalidInput
            As `run`; rigid bodies; a motion so far from the origin that rounding hides neighbors.
        visviva.ConvergenceError
            Of a scene: the motion, or its neighbor, ended early. Copies of an ensemble tell it by `Megno.status`.
        visviva.Interrupted
            Ctrl-C.

        Warns
        -----
        visviva.AccuracyWarning
            As `run`.

        References
        ----------
        P. Cincotta & C. Simó, Astron. Astrophys. Suppl. 147 (2000) 205; of differences of two motions: G. Benettin, L.
        Galgani & J.-M. Strelcyn, Phys. Rev. A 14 (1976) 2338.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> planets = vv.datasets.outer_solar_system().scene
        >>> bool(abs(planets.megno(t=365.25 * 2000).mean_megno - 2.0) < 0.1)
        True
        >>> velocity = planets.particles.velocity * np.array([1.0, 1.2])[:, None, None]
        >>> planets.ensemble(velocity=velocity).megno(t=[1e5, 2e5]).mean_megno.shape
        (2, 2)
        """
        from visviva.megno import megno_of

        return megno_of(cast("Scene | EnsembleScene", self), request)

    @asked_by(FlowRequest)
    def flow_jacobian(self, request: FlowRequest) -> NDArray[np.float64]:
        """Derivatives of the state at a time with respect to the state at the start: the state transition matrix.

        A small difference of each number of the start goes by the linear equations of the motion beside it. All forces
        do, and all methods but ``taylor`` and those of Boris. Gravity, charges, potentials, springs, dampers, uniform
        fields, rotating frames, linear and quadratic drag, and formulas without roots that may vanish have exact
        derivatives; what is off is what steps leave, so a smaller `rtol` gives more digits. Those of other forces are
        differences, right to 11 digits and more. Of either a motion loses what neighbors become larger in between than
        at the end, as at a narrow pericenter: one more difference, of all numbers together, tells it.

        Units: those of the scene, a row those of a number of the state over those of each.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end, or output times in the order of the motion, forwards or backwards.
        method, dt, rtol, threads : optional
            As of `run`.

        Returns
        -------
        ndarray, shape (6N, 6N), (T, 6N, 6N), (B, 6N, 6N) or (B, T, 6N, 6N)
            Rows and columns are x, y, z of the first body, of the second and so on, then their velocities. Where
            forces have an energy it is symplectic in places and momenta (Liouville: its determinant is 1). NaN after
            the end of a copy that ended early, as its run tells.

        Raises
        ------
        visviva.InvalidInput
            As `run`; rigid bodies; bodies that have merged; a motion so far from the origin that rounding hides
            neighbors.
        visviva.ConvergenceError
            Of a scene: the motion, or its neighbor, ended early, or derivatives are lost by more than a hundredth of
            what they add up to; a copy of an ensemble is NaN then.
        visviva.Interrupted
            Ctrl-C.

        Warns
        -----
        visviva.AccuracyWarning
            As `run`, and for derivatives that are off by more than 1e-6 of what they add up to.

        References
        ----------
        E. Hairer, S. P. Nørsett & G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., section I.14; O.
        Montenbruck & E. Gill, *Satellite Orbits* (2000), chapter 7.

        Examples
        --------
        Where a satellite is after a quarter of an hour for a small difference of its speed:

        >>> import numpy as np, visviva as vv
        >>> earth = vv.CentralField(vv.potentials.PowerLaw(k=-3.986004418e14, n=1.0))
        >>> satellite = vv.Particles([1.0], [[7.0e6, 0.0, 0.0]], [[0.0, 7546.05, 0.0]])
        >>> flow = vv.Scene(satellite, earth).flow_jacobian(900.0)
        >>> flow.shape
        (6, 6)
        >>> bool(abs(np.linalg.det(flow) - 1.0) < 1e-9)
        True
        """
        from visviva._flow_jacobian import flow_jacobian_of

        return flow_jacobian_of(cast("Scene | EnsembleScene", self), request)


def __dir__() -> list[str]:
    return list(__all__)
