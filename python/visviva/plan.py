"""What a run will do, readable: the answer of ``scene.plan(...)``."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from visviva._html import Record, Sheet, Shown
from visviva._keywords import known_keywords
from visviva._text import count

if TYPE_CHECKING:
    from visviva import _core

__all__ = ["Cost", "Plan"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Cost(Record):
    """What a run would cost: the answer of `Plan.cost`.

    Attributes
    ----------
    steps, evaluations : int
        Steps and force evaluations, of all copies together.
    memory : int
        Bytes of the results.
    seconds : float
        Time in seconds, as the trial went.
    exact : bool
        Whether the number of steps is exact, as that of equal steps is; else it is scaled from the trial.

    Examples
    --------
    >>> import visviva as vv
    >>> cost = vv.problems.figure_eight().scene.plan(t=1.0, method="leapfrog", dt=0.01).cost()
    >>> cost.steps, cost.exact
    (100, True)
    """

    steps: int
    evaluations: int
    memory: int
    seconds: float
    exact: bool


@known_keywords
@dataclass(frozen=True, slots=True)
class Plan(Shown):
    """What will run, what is skipped and why, and the cost of a step.

    Printing it shows the whole of it, the way a database explains a query, and what the run would cost: `cost`.

    Attributes
    ----------
    method : str
        The method that runs; ``"closed form"`` needs none.
    solution : str
        ``"closed form: ..."`` or ``"integration"``; where ensemble members differ, each with the number of members.
    particles, active, passive : int
        All bodies; those with mass; test particles.
    rows : tuple of (str, str, str)
        What was decided: subject, decision, reason.
    skipped : tuple of (str, str)
        What is not done, and why.
    evaluations_per_step, pairs_per_evaluation : int
        The cost of one step: force evaluations, and interacting pairs in each.
    lanes : str
        How SIMD is used.
    threads : int
        Threads that take part.
    text : str
        What ``print`` shows.

    Examples
    --------
    >>> import visviva as vv
    >>> scene = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]))
    >>> scene.plan(t=10.0).solution.split(":")[0]
    'closed form'
    """

    # A field that is added later has a default, for the files that lack it.
    method: str
    solution: str
    particles: int
    active: int
    passive: int
    rows: tuple[tuple[str, str, str], ...]
    skipped: tuple[tuple[str, str], ...]
    evaluations_per_step: int
    pairs_per_evaluation: int
    lanes: str
    threads: int
    text: str = field(repr=False)
    # What `cost` tries; not there in the plan of what has run.
    _asked: _core._Request | None = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        bodies = count(self.particles, "body", "bodies")
        return f"Plan({self.method!r}, {self.solution!r}, {bodies}; print shows the whole of it)"

    def _sheet(self) -> Sheet:
        skipped = [(f"skipped: {what}", "", why) for what, why in self.skipped]
        cost = f"{self.evaluations_per_step} force evaluations a step, {self.pairs_per_evaluation} pairs in each"
        return Sheet(f"Plan: {self.method}", [*self.rows, *skipped], ("", "decision", "reason"), cost)

    def __str__(self) -> str:
        found = self.cost()
        if found is None:
            return self.text
        about = "" if found.exact else "about "
        lines = [
            f"steps: {about}{found.steps:_}".replace("_", " "),
            f"force evaluations: {'about ' if found.steps else ''}{found.evaluations:_}".replace("_", " "),
            f"memory of the results: {_size(found.memory)}",
            f"time: about {_duration(found.seconds)}",
        ]
        return "\n".join([self.text, "expected", *(f"  {line}" for line in lines)])

    def __reduce__(self) -> tuple[Any, ...]:
        # Without what was asked, which may hold functions.
        return type(self), tuple(getattr(self, name) for name in self.__slots__[:-1])

    def cost(self) -> Cost | None:
        """What the run would cost, by a trial of a few milliseconds: steps, force evaluations, memory and time.

        Returns
        -------
        Cost or None
            Steps and force evaluations are scaled from the trial where they are not known before. Seconds are those of
            this machine, as busy as it is. Events are not looked for in the trial. None where the trial fails or would
            be long (10⁸ pairs in a step), where rigid bodies move in closed form but for the steps on which events are
            looked for, which no trial takes, and of what has run: see ``out.stats``.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.outer_solar_system().scene
        >>> cost = scene.plan(t=1e5, method="leapfrog", dt=10.0).cost()
        >>> cost.steps, cost.memory
        (10000, 576)
        """
        from visviva._trial import cost

        return None if self._asked is None else cost(self._asked, self)

    @property
    def closed_form(self) -> bool:
        """Whether the motion is known in closed form, so that no step is taken.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.problems.kepler(e=0.5).scene.plan(t=1.0).closed_form
        True
        """
        return self.solution.startswith("closed form")

    @classmethod
    def _from_core(cls, plan: dict[str, Any], asked: _core._Request | None = None) -> Plan:
        """The plan of a dictionary of the core's, or of a file, which an older version may have written."""
        known = {name: plan[name] for name in cls.__slots__ if name in plan}
        for name in ("rows", "skipped"):
            known[name] = tuple(tuple(row) for row in known.get(name, ()))
        return cls(**known, _asked=asked)


def plan_as_dict(plan: dict[str, Any] | _core.Planned) -> dict[str, Any]:
    """The plan of a run or of a file as a dictionary: that of a run is made when somebody asks."""
    return plan if isinstance(plan, dict) else plan.told()


def _size(size: float) -> str:
    for unit in ("bytes", "kB", "MB", "GB"):
        if size < 1000.0:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:.3g} TB"


def _duration(seconds: float) -> str:
    for size, unit in ((1e-6, "ns"), (1e-3, "µs"), (1.0, "ms")):
        if seconds < size:
            return f"{seconds / size * 1000.0:.2g} {unit}"
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    minutes = seconds / 60.0
    return f"{minutes:.3g} minutes" if minutes < 100.0 else f"{minutes / 60.0:.3g} hours"


def __dir__() -> list[str]:
    return list(__all__)
