"""What a run in generalized coordinates gives: `GeneralizedTrajectory`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from visviva._arrays import whole_number
from visviva._exported import Columns, Exported
from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva.errors import InvalidInput
from visviva.generalized._columns import exported
from visviva.generalized._pictures import Drawn
from visviva.generalized._saved import Saved
from visviva.generalized._states import States
from visviva.generalized._stats import GeneralizedStats
from visviva.status import Status
from visviva.typing import GeneralizedColumnName

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from visviva.events import Event
    from visviva.generalized._events import GeneralizedEventTable
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["GeneralizedTrajectory", "check_run"]

STATUS = {
    "finished": Status.OK,
    "stopped": Status.STOPPED,
    "step too small": Status.STEP_FAILURE,
    "not finite": Status.STEP_FAILURE,
    "too many steps": Status.TOO_MANY_STEPS,
    "interrupted": Status.INTERRUPTED,
}


def check_run(trajectory: object) -> None:
    """Refuse what is no run.

    Raises
    ------
    visviva.InvalidInput
        By name.
    """
    if not isinstance(trajectory, GeneralizedTrajectory):
        raise InvalidInput("trajectory", f"expected what `run` gives, got {type(trajectory).__name__}")


@known_keywords
class GeneralizedTrajectory(Exported[GeneralizedColumnName], Drawn, Saved, Shown):
    """The motion of a system in generalized coordinates at the output times. Made by ``run``.

    Units: those of the system, which are those of its parameters; angles in radians.

    Attributes
    ----------
    system : Lagrangian or Hamiltonian
        What was run.
    t : ndarray, shape (T,)
        Output times; fewer than asked for if the run failed, or an event ended it.
    position, velocity, momentum : ndarray, shape (T, n)
        Coordinates; their velocities; ∂L/∂q̇.
    energy : ndarray, shape (T,)
        Jacobi's integral Σ q̇ ∂L/∂q̇ − L, or H.
    reactions : ndarray, shape (T, c)
        Multipliers λ of the constraints, in their order, holonomic ones first: the force Σ λ ∂g/∂q acts on the system.
    status : Status
    method : str
        What ran.
    steps, evaluations : int
        What it took; an evaluation is one of all stages.
    longest_step : float

    ``out["theta"]`` is a coordinate over time.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.4, § 2.7 and § 8.1.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.systems.double_pendulum().run(t=1.0)
    >>> out.position.shape, out.status.name
    ((2, 2), 'OK')
    """

    __slots__ = (
        "_columns",
        "_found",
        "_last",
        "_states",
        "evaluations",
        "longest_step",
        "method",
        "status",
        "steps",
        "system",
        "t",
    )

    system: GeneralizedSystem
    t: NDArray[np.float64]
    status: Status
    steps: int
    evaluations: int
    longest_step: float
    method: str
    _states: NDArray[np.float64]
    _columns: NDArray[np.float64] | None
    _found: tuple[dict[str, Any], tuple[Event, ...]]
    _last: tuple[float, NDArray[np.float64]]

    def __init__(
        self, system: GeneralizedSystem, result: dict[str, Any], asked: dict[str, Any], member: int = 0
    ) -> None:
        known = isinstance(system, States) and type(result) is type(asked) is dict
        if not (known and "t" in result and "outputs" in asked):
            from visviva.generalized._system import GeneralizedSystem

            how = "the run of a Lagrangian or a Hamiltonian"
            made_by(self, how, system=(system, GeneralizedSystem), result=(result, dict), asked=(asked, dict))
        lengths = result["lengths"]
        member = whole_number("member", member, 0, len(lengths) - 1)
        first = sum(lengths[:member])
        rows = slice(first, first + lengths[member])
        self.system = system
        self.t = result["t"][rows]
        self._states = result["y"][rows]
        for array in (self.t, self._states):
            array.flags.writeable = False
        self.status = STATUS[result["endings"][member]]
        self.steps = result["steps"][member]
        self.evaluations = result["evaluations"][member]
        self.longest_step = result["longest_step"][member]
        self.method = asked["method"]
        self._columns = None
        self._last = (result["last_t"][member], result["last_y"][member])
        first = sum(result["found"][:member])
        own = slice(first, first + result["found"][member])
        found = {name: result[name][own] for name in ("found_which", "found_t", "found_y")}
        self._found = (found | {"found": [result["found"][member]]}, asked["looked_for"])

    def __repr__(self) -> str:
        names = ", ".join(self.system.coordinates)
        span = f"t = {self.t[0]:g} … {self.t[-1]:g}" if len(self.t) else "empty"
        return f"GeneralizedTrajectory({names}; {len(self.t)} times, {span}, {self.status.name})"

    def _sheet(self) -> Sheet:
        span = f", {self.t[0]:g} to {self.t[-1]:g}" if len(self.t) else ""
        rows = [
            ("of", repr(self.system)),
            ("times", f"{len(self.t)}{span}"),
            ("method", self.method),
            ("steps", f"{self.steps}; {self.evaluations} evaluations"),
            ("ended", self.status.name),
        ]
        return Sheet("Trajectory in generalized coordinates", rows)

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if not isinstance(name, str) or name not in self.system.coordinates:
            raise self._no_coordinate(name)
        return self.position[:, self.system.coordinates.index(name)]

    def __iter__(self) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} is read by its columns: t, position, …; out['name'] is a coordinate")

    @property
    def _whose(self) -> GeneralizedSystem:
        return self.system

    def _column(self, first: int, last: int | None) -> NDArray[np.float64]:
        if self._columns is None:
            columns = self.system._model.columns(self.t, self._states, self.system._values[None, :])
            columns.flags.writeable = False
            self._columns = columns
        return self._columns[:, first:last]

    def _exported(self, columns: str | Sequence[str] | None) -> Columns:
        found = exported(self, columns, self._row_axes, self.system.coordinates)
        return replace(found, attributes={"method": self.method, "status": self.status.name})

    @property
    def stats(self) -> GeneralizedStats:
        """What the run cost.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.double_pendulum().run(t=1.0).stats.method
        'gauss16'
        """
        return GeneralizedStats(self.steps, self.evaluations, self.longest_step, self.method)

    @property
    def events(self) -> GeneralizedEventTable:
        """The events that were found, each column of shape (K, …).

        Raises
        ------
        InvalidInput
            If none were looked for.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.henon_heiles().run(t=10.0, events=["x", vv.events.coordinate("y", 0.2)])
        >>> out.events.which.tolist(), out.events.of(1).position[:, 1]
        ([1, 0, 0, 1, 0, 1, 0], array([0.2, 0.2, 0.2]))
        """
        from visviva.generalized._events import found_events

        return found_events(self.system, *self._found, self.system._values[None, :])

    @property
    def final(self) -> GeneralizedSystem:
        """The system at the last time, or where the run ended before: ready to run on.

        That is at the event that stopped it or, of a run that was interrupted or failed, at the end of its last step.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.systems.pendulum(position=[0.5]).run(t=[0.0, 1.0])
        >>> out.final.t0, bool((out.final.position == out.position[-1]).all())
        (1.0, True)
        >>> try:
        ...     vv.systems.double_pendulum().run(t=1e4, max_steps=100)
        ... except vv.ConvergenceError as error:
        ...     error.trajectory.final.t0 > 1.0
        True
        """
        n = len(self.system.coordinates)
        if self.status is Status.STOPPED:
            found, _ = self._found
            last, t0 = found["found_y"][-1], float(found["found_t"][-1])
        else:
            t0, last = self._last
        return self.system._at(last[:n], last[n:], t0=t0)

    def conservation(self) -> dict[str, float]:
        """The largest change of what is conserved, relative to it or, where that is larger, to what it is a sum of.

        An energy near zero is the difference of others: its changes are relative to Σ p q̇, twice the kinetic one.

        Units: changes are relative, without dimension.

        Returns
        -------
        dict of str to float

        Examples
        --------
        >>> import visviva as vv
        >>> changes = vv.systems.spherical_pendulum().run(t=10.0).conservation()
        >>> sorted(changes), max(changes.values()) < 1e-13
        (['energy', 'momentum of phi'], True)
        """
        changes: dict[str, float] = {}
        if not len(self):
            return changes
        moving = float(np.abs((self.momentum * self.velocity).sum(axis=1)).max())
        for name in self.system.conserved:
            if name == "energy":
                values, whole = self.energy, moving
            else:
                index = self.system.coordinates.index(name.removeprefix("momentum of "))
                values, speed = self.momentum[:, index], float(np.abs(self.velocity[:, index]).max())
                whole = moving / speed if speed > 0.0 else 0.0
            scale = max(float(np.abs(values).max()), whole)
            changes[name] = float(np.ptp(values)) / scale if scale > 0.0 else 0.0
        return changes
