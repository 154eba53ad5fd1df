"""Runs of a system in generalized coordinates: `Runs`, what `run` and `plan` are asked and what they do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._accuracy import times_may_be_coarse
from visviva._arrays import float_array, number, whole_number
from visviva._keywords import known_keywords
from visviva._long_arrays import first_turned_back, room_for
from visviva.errors import ConvergenceError, Interrupted, InvalidInput
from visviva.generalized._methods import check_atol, check_rtol, method_name
from visviva.generalized._resolved import warn_if_unresolved, warn_of_coarse_times
from visviva.generalized._states import States, as_system
from visviva.status import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._plan import GeneralizedPlan
    from visviva.generalized._trajectory import GeneralizedTrajectory
    from visviva.integrators import Method
    from visviva.typing import GeneralizedEvent, GeneralizedMethodName, Progress

__all__ = ["Runs"]

#: Of a run that is not told another.
RTOL = 1e-12
#: Of a run that is not told how many.
MOST_STEPS = 100_000_000


@known_keywords
class Runs(States):
    """Base of `GeneralizedSystem`: runs from the start."""

    __slots__ = ()

    def _asked(
        self,
        t: ArrayLike,
        method: object,
        rtol: float,
        dt: float | None,
        max_step: float | None,
        max_steps: int | None = None,
        events: Any = (),
        atol: Any = None,
    ) -> tuple[dict[str, Any], NDArray[np.float64]]:
        outputs = self._outputs(t)
        rtol = number("rtol", rtol)
        if not 1e-15 <= rtol <= 1e-2:
            raise InvalidInput("rtol", f"expected a tolerance between 1e-15 and 1e-2, got {rtol:g}")
        for name, value in (("dt", dt), ("max_step", max_step)):
            if value is not None and number(name, value) <= 0.0:
                raise InvalidInput(name, f"expected a positive number, got {value!r}; the direction is that of t")
        name = method_name(method, self, dt, max_step)
        check_rtol(rtol, RTOL, dt)
        asked = {
            "method": name,
            "span": (self.t0, float(outputs[-1])),
            "rtol": rtol,
            "atol": None if atol is None else self._absolute(atol, name),
            "dt": None if dt is None else number("dt", dt),
            "max_step": None if max_step is None else number("max_step", max_step),
            "max_steps": MOST_STEPS if max_steps is None else whole_number("max_steps", max_steps, low=1),
            "outputs": outputs,
            "events": [],
            "looked_for": (),
        }
        if not (isinstance(events, tuple) and not events):
            from visviva.generalized._events import described, events_of, events_to_core

            looked_for = events_of(events)
            asked |= {"looked_for": described(looked_for), "events": events_to_core(self, looked_for)}
        return asked, outputs

    def _absolute(self, atol: Any, method: str) -> list[float]:
        """Give the absolute tolerance of each number of a state."""
        check_atol(method)
        n, kinds = len(self.coordinates), ("position", self._second_name)
        given = dict(atol) if isinstance(atol, Mapping) else dict.fromkeys(kinds, atol)
        unknown = [kind for kind in given if kind not in kinds]
        if unknown:
            raise InvalidInput("atol", f"expected {kinds[0]!r} and {kinds[1]!r}, got {unknown[0]!r}")
        found: list[float] = []
        for kind in kinds:
            if kind not in given:
                found += [math.nan] * n  # from the sizes of the motion
                continue
            each = given[kind]
            values = [number("atol", each)] * n if np.ndim(each) == 0 else float_array("atol", each, (n,)).tolist()
            if min(values) <= 0.0:
                raise InvalidInput("atol", f"expected positive tolerances, got {min(values):g}")
            found += values
        return found

    def _outputs(self, t: ArrayLike) -> NDArray[np.float64]:
        """Give the times that are read: all that are asked for, or of an end the start and it."""
        if _is_end(t):
            end = number("t", t)
            return np.array([self.t0] if end == self.t0 else [self.t0, end])
        outputs = float_array("t", t, None)
        if outputs.ndim > 1 or not outputs.size:
            raise InvalidInput(
                "t", f"expected the end, or output times in one row, got an array of shape {outputs.shape}"
            )
        wrong = first_turned_back(self.t0, outputs)
        if wrong is not None:
            before = outputs[wrong - 1] if wrong else self.t0
            came = f"got {outputs[wrong]:g} after {before:g} as t[{wrong}]"
            raise InvalidInput("t", f"expected times in order from t0 = {self.t0:g} on, {came}")
        return outputs

    def run(
        self,
        t: ArrayLike,
        *,
        method: GeneralizedMethodName | Method = "auto",
        rtol: float = RTOL,
        atol: float | ArrayLike | Mapping[str, ArrayLike] | None = None,
        dt: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        events: Sequence[GeneralizedEvent] | GeneralizedEvent = (),
        progress: Progress = False,
    ) -> GeneralizedTrajectory:
        """Run from the start.

        Units: those of the system, which are those of its parameters; angles in radians.

        Parameters
        ----------
        t : float or array_like, shape (T,)
            The end, or output times in order; they change no step.
        method : str
            ``auto``: where the equations are linear with constant coefficients, ``matrix_exponential``, and where the
            one equation is that of a pendulum, ``elliptic_functions``, which are exact at any time and take no steps;
            where an absolute value turns on the way, ``dop853``, which makes its steps small there; else ``gauss16``,
            as also where a step is given.
            ``gauss16`` (also ``gauss8``, ``gauss4``): implicit, symplectic for any Lagrangian and Hamiltonian; where
            energy is conserved its step is chosen at the start and then held. Or a method of `visviva.methods`:
            adaptive ones (``dop853``), ones with a fixed step (``rk4``), and symplectic ones where accelerations do not
            depend on velocities. Or, of a Lagrangian, a variational integrator with a fixed step
            (``variational_midpoint``, ``variational_trapezoidal``, and ``variational_lobatto4``, ``6`` and ``8`` of
            those orders): it makes the action of a discrete path stationary, so it is symplectic and keeps the
            momenta of cyclic coordinates to round-off, with forces and dissipation by d'Alembert's principle. With
            holonomic constraints ``rattle`` does the same, and ``rattle4``, ``6`` and ``8`` are its compositions of
            those orders.
        rtol : float
            Relative tolerance of a step, from 1e-15 to 1e-2; if not given 1e-12. Refused beside `dt`.
        atol : float, array_like of shape (n,), or dict, optional
            Absolute tolerance of methods that estimate their error in a step, as ``dop853``: the root mean square of
            the errors, each divided by ``atol + rtol·|number|``, is at most 1. ``{"position": ..., "velocity": ...}``
            (of a Hamiltonian ``"momentum"``) has one for each kind. Where none is given it is a thousandth of `rtol`
            times how fast or far the motion goes from the start. Other methods refuse it.
        dt : float, optional
            The step of every step.
        max_step : float, optional
            The longest step, of methods that choose theirs; others refuse it.
        max_steps : int, optional
            The run ends with an error beyond this number of steps.
        events : sequence, optional
            Of `visviva.events`: names of coordinates and `visviva.events.coordinate`, where one passes a value;
            expressions of SymPy, functions ``f(q, v, t, **parameters)`` as that of the system, and
            `visviva.events.expression`, which pass zero; `energy` and `function` as of scenes. What is found on the way
            comes back in ``out.events``. Events change no bit of the run. A terminal one ends it: rows, ``final`` and
            the table end there, with `Status.STOPPED`; where `t` is an end time, the last row is that of the event.
        progress : bool or callable
            As in `Scene.run`.

        Returns
        -------
        GeneralizedTrajectory

        Raises
        ------
        InvalidInput
            For what cannot be run, before anything runs.
        ConvergenceError
            At a singularity; where constraints come to depend on each other (the change point of a mechanism); where
            dry friction, as of ``abs(v[0])``, holds a velocity at zero; where a step of `dt` goes over a wall, a bump
            or a pulse of exp or tanh that is narrower than it. ``.trajectory`` holds what was computed.
        Interrupted
            By Ctrl-C; ``.trajectory`` holds what was computed.

        Warns
        -----
        AccuracyWarning
            The energy is conserved, but at the end off by more than a hundredth of kinetic + |potential| (a tenth, of
            steps of `dt`): something shorter than a step was passed over, or the tolerance resolves nothing. Times
            are so far from zero that rates change from one to the next number, by 1e-9 or more.

        References
        ----------
        Gauss's methods: E. Hairer, C. Lubich & G. Wanner, *Geometric Numerical Integration*, 2nd ed., sections II.1.3
        and VIII.6. Variational integrators: J. E. Marsden & M. West, Acta Numerica 10 (2001) 357, section 1.5, parts
        2 and 3; constraints in part 3 there, and section VII.1 of the former. The matrix exponential: C. Moler &
        C. Van Loan, SIAM Review 45 (2003) 3. Elliptic functions: NIST Digital Library of Mathematical Functions,
        section 22.19(i).

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> out = vv.systems.pendulum(position=[3.0]).run(t=np.linspace(0.0, 10.0, 101))
        >>> out["theta"].shape, bool(abs(out.energy - out.energy[0]).max() < 1e-13)
        ((101,), True)
        """
        from visviva.generalized._trajectory import STATUS, GeneralizedTrajectory

        start = self._start()
        asked, outputs = self._asked(t, method, rtol, dt, max_step, max_steps, events, atol)
        self._check_start()
        result = self._run(asked, start[None, :], self._values[None, :], 1, progress)
        if STATUS[result["endings"][0]] is Status.STOPPED and _is_end(t):
            _end_at_the_stop(result)
        out = GeneralizedTrajectory(as_system(self), result, asked)
        warn_of_coarse_times(as_system(self), asked, (start[None, :], out._states[-1:]), self._values[None, :])
        if result["interrupted"]:
            raise Interrupted("the run was interrupted", out)
        failure = result["failures"][0]
        if failure is not None:
            raise ConvergenceError(failure, result["reached"][0], out)
        assert len(out.t) == len(outputs) or out.status is Status.STOPPED
        if len(out.t):
            lasts = out._states[-1:], float(out.t[-1])
            try:
                warn_if_unresolved(as_system(self), asked, start[None, :], lasts, self._values[None, :], 1)
            except Interrupted as interrupted:
                interrupted.trajectory = out
                raise
        return out

    def _run(
        self,
        asked: dict[str, Any],
        states: NDArray[np.float64],
        parameters: NDArray[np.float64],
        threads: int | None,
        progress: Progress,
    ) -> dict[str, Any]:
        threads = None if threads is None else whole_number("threads", threads)
        span = asked["span"]
        # Far from the time zero, times within a run have fewer digits than the run itself.
        shift = span[0] if times_may_be_coarse(*span) and self._knows_no_time(asked) else 0.0
        if shift:
            with room_for("t", asked["outputs"].shape):
                shifted = asked["outputs"] - shift
            asked = asked | {"span": (0.0, span[1] - shift), "outputs": shifted}
        if progress is False:
            result = self._model.run(asked, states, parameters, threads, None)
        else:
            from visviva._progress import TIME, callback

            alone = (TIME, span)
            of = alone if len(states) == 1 else ("copies", (0.0, float(len(states))))
            with callback(progress, *of) as report:
                result = self._model.run(asked, states, parameters, threads, report)
        if shift:
            result |= {name: result[name] + shift for name in ("t", "found_t")}
            result |= {name: [time + shift for time in result[name]] for name in ("reached", "last_t")}
        return result

    def _knows_no_time(self, asked: dict[str, Any]) -> bool:
        """Whether nothing that is asked depends on the time itself, but for differences between times."""
        of_events = [node[0] for event in asked["events"] for node in event["nodes"] or ()]
        functions = any(event["function"] is not None for event in asked["events"])
        return bool(self._structure["autonomous"]) and not functions and "time" not in of_events

    def plan(
        self,
        t: ArrayLike,
        *,
        method: GeneralizedMethodName | Method = "auto",
        rtol: float = RTOL,
        atol: float | ArrayLike | Mapping[str, ArrayLike] | None = None,
        dt: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        events: Sequence[GeneralizedEvent] | GeneralizedEvent = (),
    ) -> GeneralizedPlan:
        """What `run` would do, and why.

        Units: those of the system.

        Parameters
        ----------
        t, method, rtol, atol, dt, max_step, max_steps, events
            As in `run`.

        Returns
        -------
        GeneralizedPlan
            Print it. Output times have shape (T,), as of `run`.

        Raises
        ------
        InvalidInput
            For what `run` refuses.

        Examples
        --------
        >>> import visviva as vv
        >>> print(vv.systems.spherical_pendulum().plan(t=10.0).conserved)
        ('energy', 'momentum of phi')
        """
        from visviva.generalized._plan import GeneralizedPlan

        asked, _ = self._asked(t, method, rtol, dt, max_step, max_steps, events, atol)
        if self.position is not None:
            self._check_start()
        return GeneralizedPlan._of(as_system(self), asked)


def _is_end(t: ArrayLike) -> bool:
    """Whether a time is asked for, and no row of them."""
    return isinstance(t, float | int) or np.ndim(t) == 0


def _end_at_the_stop(result: dict[str, Any]) -> None:
    """Add the state at the event that ended the run, as its last row: the end there was for the one asked for."""
    if result["found_t"][-1] == result["t"][-1]:
        return
    result["t"] = np.append(result["t"], result["found_t"][-1])
    result["y"] = np.concatenate([result["y"], result["found_y"][-1:]])
    result["lengths"] = [len(result["t"])]
