"""What a run will do, readable: the answer of ``scene.plan(...)``."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from visviva._keywords import known_keywords

__all__ = ["Plan"]


@known_keywords
@dataclass(frozen=True, slots=True)
class Plan:
    """What will run, what is skipped and why, and the cost of a step.

    Printing it shows the whole of it, the way a database explains a query.

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

    def __str__(self) -> str:
        return self.text

    @property
    def closed_form(self) -> bool:
        """Whether the motion is known in closed form, so that no step is taken."""
        return self.solution.startswith("closed form")

    @classmethod
    def _from_core(cls, plan: dict[str, Any]) -> Plan:
        """The plan of a dictionary of the core's, or of a file, which an older version may have written."""
        known = {name: plan[name] for name in cls.__slots__ if name in plan}
        for name in ("rows", "skipped"):
            known[name] = tuple(tuple(row) for row in known.get(name, ()))
        return cls(**known)
