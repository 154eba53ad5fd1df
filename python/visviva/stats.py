"""What a run cost and what ran: a table of numbers, alike for a trajectory, and in total for an ensemble."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from visviva._html import Record
from visviva._keywords import known_keywords

__all__ = ["Stats"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Stats(Record):
    """What a run cost, and what ran.

    Attributes
    ----------
    steps, rejected, evaluations : int
        Steps taken and rejected, and force evaluations.
    seconds : float
        Of the core alone, in seconds.
    threads : int
    simd : str
        The tier: ``"portable"``, ``"avx2"`` or ``"avx512"``.
    method : str
        What ran: where ``"auto"`` was asked for, what it chose.

    Examples
    --------
    >>> import visviva as vv
    >>> stats = vv.problems.figure_eight().scene.run(t=1.0, method="leapfrog", dt=0.01).stats
    >>> stats.method, stats.steps, stats.rejected
    ('leapfrog', 100, 0)
    """

    steps: int
    rejected: int
    evaluations: int
    seconds: float
    threads: int
    simd: str
    method: str

    @classmethod
    def _from_core(cls, stats: dict[str, Any]) -> Stats:
        return cls(**{name: stats[name] for name in cls.__slots__})


def __dir__() -> list[str]:
    return list(__all__)
