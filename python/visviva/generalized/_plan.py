"""What a run of a system in generalized coordinates will do: `GeneralizedPlan`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from visviva._html import Sheet, Shown
from visviva._keywords import known_keywords
from visviva.generalized._methods import EXACT

if TYPE_CHECKING:
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["GeneralizedPlan"]

_MASS = {
    "constant": "constant: of parameters alone",
    "diagonal": "diagonal: quotients, no system of equations",
    "blocks": "in blocks that do not know each other, each solved by itself",
    "full": "full: solved with numbers at every evaluation, never inverted as an expression",
    "none": "none: Hamilton's equations are of the first order",
}


@known_keywords
@dataclass(frozen=True, slots=True)
class GeneralizedPlan(Shown):
    """What will run, and what was found on the way.

    Attributes
    ----------
    method : str
        What takes the steps.
    conserved : tuple of str
        What the expressions tell to be conserved.
    rows : tuple of (str, str)
        Everything that was found: subject, finding.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.systems.double_pendulum().plan(t=1.0).method
    'gauss16'
    """

    method: str
    conserved: tuple[str, ...]
    rows: tuple[tuple[str, str], ...]

    @classmethod
    def _of(cls, system: GeneralizedSystem, asked: dict[str, Any]) -> GeneralizedPlan:
        found = system._structure
        n, constraints = len(system.coordinates), system._constraints()
        held = found["holds_steps"] and asked["method"].startswith("gauss") and asked["dt"] is None
        steps = (
            "none: exact at every output time" if asked["method"] in EXACT
            else f"{asked['dt']:g}, all alike" if asked["dt"] is not None
            else "chosen at the start, then held: energy is conserved" if held
            else "chosen as it goes"
        )  # fmt: skip
        equations = (
            "linear, with constant coefficients" if found["linear"]
            else "that of a pendulum" if found["pendulum"]
            else "not linear"
        )  # fmt: skip
        rows = (
            ("coordinates", ", ".join(system.coordinates)),
            ("degrees of freedom", f"{n - constraints}" + (f" ({constraints} constraints)" if constraints else "")),
            ("time", "does not enter" if found["autonomous"] else "enters"),
            ("conserved", ", ".join(system.conserved) or "nothing that the expressions tell"),
            ("mass matrix", _MASS[found["mass_matrix"]]),
            ("accelerations", "of places alone" if found["nystrom"] else "of velocities, too"),
            ("operations", f"{found['operations']} per evaluation, for eight states at once"),
            ("equations", equations),
            *([("kinks", "an absolute value, which turns within a step")] if found["kinks"] else []),
            ("method", asked["method"]),
            ("steps", steps),
            *([("events", f"{len(asked['events'])}, located between the nodes")] if asked["events"] else []),
        )
        return cls(asked["method"], tuple(system.conserved), rows)

    def __repr__(self) -> str:
        return f"GeneralizedPlan({self.method!r}, conserved={self.conserved!r}; print shows the whole of it)"

    def _sheet(self) -> Sheet:
        return Sheet(f"Plan: {self.method}", self.rows)

    def __str__(self) -> str:
        width = max(len(subject) for subject, _ in self.rows)
        return "\n".join(f"{subject:<{width}}  {finding}" for subject, finding in self.rows)
