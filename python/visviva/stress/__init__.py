"""Stability under abuse: what every method makes of scenes that nobody should ask for.

``visviva stress`` prints the table of `run`. A wrong number that is told as a right one, a number that is not finite
and has no name, an exception that is not of this package and a run that hangs are failures; a named refusal is none.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from visviva._html import Sheet, Shown, first_rows
from visviva._keywords import known_keywords, unknown_name
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.integrators import methods as all_methods
from visviva.stress.cases import CASES
from visviva.stress.verdict import Verdict, judged

if TYPE_CHECKING:
    from collections.abc import Sequence

    from visviva.typing import MethodName

__all__ = ["Report", "Verdict", "run"]


def __dir__() -> list[str]:
    return sorted(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)


@known_keywords
class Report(Shown):
    """The verdicts on every case, method by method.

    Attributes
    ----------
    verdicts : list of Verdict
    failures : list of Verdict
        Those of which something is wrong.

    Examples
    --------
    >>> import visviva as vv
    >>> report = vv.stress.run(["dop853"], cases=["two bodies in one place"])
    >>> len(report.verdicts), report.failures
    (1, [])
    """

    def __init__(self, verdicts: Sequence[Verdict]) -> None:
        self.verdicts = list(verdicts)
        self.failures = [verdict for verdict in self.verdicts if verdict.word == "FAILED"]

    def __repr__(self) -> str:
        return f"Report({count(len(self.verdicts), 'verdict')}, {len(self.failures)} failed; print shows them)"

    def _sheet(self) -> Sheet:
        caption = f"{count(len(self.verdicts), 'verdict')}, {len(self.failures)} failed"
        if not self.failures:
            words = Counter(verdict.word for verdict in self.verdicts)
            return Sheet(caption, [(word, f"{number}") for word, number in words.items()])
        bad = [(verdict.case, *line(verdict).split(maxsplit=2)) for verdict in self.failures]
        rows, note = first_rows(len(bad), bad.__getitem__)
        return Sheet(caption, rows, ("case", "method", "", ""), note)

    def __str__(self) -> str:
        lines = []
        for case in dict.fromkeys(verdict.case for verdict in self.verdicts):
            lines.append(case)
            lines += [f"    {line(verdict)}" for verdict in self.verdicts if verdict.case == case]
        failed = len(self.failures)
        return "\n".join([*lines, "", f"{len(self.verdicts)} verdicts, {failed} failed"])


def line(verdict: Verdict) -> str:
    """A verdict as one line of a table.

    Examples
    --------
    >>> from visviva.stress import Verdict, line
    >>> line(Verdict("a case", "rk4", "ok", "", 1.5e-9, 2e-12, 0.01)).split()
    ['rk4', 'ok', 'position', '1.5e-09,', 'energy', '2.0e-12']
    """
    position, energy = verdict.position_error, verdict.energy_error
    errors = [f"{what} {error:.1e}" for what, error in (("position", position), ("energy", energy)) if error == error]
    note = verdict.told.split("\n")[0]
    return f"{verdict.method:<24}{verdict.word:<9}{', '.join(errors)}{'; ' if errors and note else ''}{note[:140]}"


@known_keywords
def run(
    methods: Sequence[MethodName] | None = None, *, long: bool = False, cases: Sequence[str] | None = None
) -> Report:
    """Put methods under abuse.

    Parameters
    ----------
    methods : sequence of str, optional
        Names of methods; all by default.
    long : bool
        Whether cases that take minutes are among them.
    cases : sequence of str, optional
        Names of cases; all by default.

    Returns
    -------
    Report
        Prints as a table.

    Raises
    ------
    InvalidInput
        For a method that is not known.

    Examples
    --------
    >>> import visviva as vv
    >>> report = vv.stress.run(["dop853"], cases=["two bodies in one place"])
    >>> report.verdicts[0].word, len(report.failures)
    ('refused', 0)
    """
    known = all_methods()
    for name in methods or ():
        if name not in [method.name for method in known]:
            raise InvalidInput("methods", f"expected names of methods, got {name!r}; `visviva.methods()` lists them")
    chosen = [method for method in known if methods is None or method.name in methods]
    wanted = [case for case in CASES if (long or not case.long) and (cases is None or case.name in cases)]
    return Report([judged(case, method) for case in wanted for method in chosen if _fits(case.how, method.adaptive)])


def _fits(how: dict[str, object], adaptive: bool) -> bool:
    """Whether a case is meant for such methods: those at a stability limit are about steps that are given."""
    return not (adaptive and how.get("fixed"))
