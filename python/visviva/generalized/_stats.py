"""What a run in generalized coordinates cost and what ran, alike for one and for an ensemble."""

from __future__ import annotations

from dataclasses import dataclass

from visviva._html import Record
from visviva._keywords import known_keywords

__all__ = ["GeneralizedStats"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class GeneralizedStats(Record):
    """What a run in generalized coordinates cost, and what ran; of an ensemble, in total.

    Attributes
    ----------
    steps, evaluations : int
        Steps taken; evaluations of the equations, of which one is of all stages.
    longest_step : float
        In the units of the system's time.
    method : str
        What ran: where ``"auto"`` was asked for, what it chose.

    Examples
    --------
    >>> import visviva as vv
    >>> stats = vv.systems.pendulum(position=[0.5]).run(t=1.0, method="rk4", dt=0.01).stats
    >>> stats.method, stats.steps, round(stats.longest_step, 12)
    ('rk4', 100, 0.01)
    """

    steps: int
    evaluations: int
    longest_step: float
    method: str


def __dir__() -> list[str]:
    return list(__all__)
