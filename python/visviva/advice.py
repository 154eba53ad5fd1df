"""Advice: which method and which step hold an error that is asked for, by a short trial.

The one idea: on the first stretch of the very run every method of the registry is tried with larger and larger steps
against a reference, and the largest that hold what the stretch may be off are compared by their time. From the stretch
to the whole, errors grow as the theory has it: the energy of a symplectic method not at all and its phase linearly, the
energy of any other method linearly and its phase quadratically. A motion that is chaotic, or one that has its hardest
part after the stretch, is worse than that: so where a reference does the whole span in about a second, the fastest of
what was found are run over all of it, and made tighter until they hold there.
Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration* 2nd ed., IX.8, X.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log2
from time import perf_counter
from typing import TYPE_CHECKING

from visviva._advice_trial import TIGHTEST, trial_of
from visviva._arrays import number
from visviva._html import Record, Sheet, Shown
from visviva._keywords import known_keywords, one_of
from visviva._text import count
from visviva._trial import run_stretch
from visviva.errors import ConvergenceError, InvalidInput
from visviva.integrators import methods

if TYPE_CHECKING:
    from visviva import _core
    from visviva._advice_trial import Trial
    from visviva.integrators import Method
    from visviva.typing import MethodName, RunSettings

__all__ = ["Advice", "Option", "advise"]

# Errors below this one float64 tells little of.
_FLOOR = 5e-13
# What trials of the whole span take together, and by how many steps of the ladder an option is tightened there at most.
_BUDGET, _TIGHTER = 2.0, 8
# No step is done in less time, whatever a stretch of a few of them tells.
_STEP = 2e-8
# A stretch that a reference does in so many seconds is as long as one for which a method is given up at all.
_LEAST = 0.03 / 8.0
# Beyond so many halvings of a step, or if a trial takes so many times the fastest, a method is given up.
_HALVINGS, _PATIENCE = 16, 8.0


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Option(Record):
    """A method with a step or a tolerance that holds the error.

    Attributes
    ----------
    how : dict
        Arguments for ``run``: ``method``, and ``dt`` or ``rtol``.
    error : float
        What the run is expected to be off, relative, without dimension: at most, at up to 256 times.
    steps : int
    seconds : float
        What it is expected to take, in seconds.

    Examples
    --------
    >>> import visviva as vv
    >>> option = vv.problems.kepler(e=0.5).scene.advise(t=10.0, accuracy=1e-6).options[0]
    >>> option.error <= 1e-6, "method" in option.how
    (True, True)
    """

    how: RunSettings
    error: float
    steps: int
    seconds: float


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Advice(Shown):
    """Which method and step hold an error; the answer of `Scene.advise`. Print it.

    Attributes
    ----------
    accuracy : float
    of : str
        What was asked for; the accuracy is relative, without dimension.
    judges_massless : bool
        Whether massless bodies, which have no energy, were judged by their positions, relative to the size of the
        system.
    options : tuple of Option
        What holds it, the fastest first.
    tried : float
        The part of the span that was tried, without dimension.

    References
    ----------
    Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), IX.8 and X.3.

    Examples
    --------
    >>> import visviva as vv
    >>> orbit = vv.problems.kepler(e=0.5).scene
    >>> advice = orbit.advise(t=10.0, accuracy=1e-6)
    >>> advice.accuracy, all(option.error <= 1e-6 for option in advice.options), "method" in advice.how
    (1e-06, True, True)
    """

    accuracy: float
    of: str
    judges_massless: bool
    options: tuple[Option, ...]
    tried: float

    @property
    def how(self) -> RunSettings:
        """Arguments for ``run`` of the fastest: ``scene.run(t, **advice.how)``."""
        return self.options[0].how.copy()

    def __str__(self) -> str:
        lines = [f"{'':<20}{'dt or rtol':>14}{'error':>11}{'steps':>12}{'time':>12}"]
        lines += [f"{row[0]:<20}{row[1]:>14}{row[2]:>11}{row[3]:>12}{row[4]:>12}" for row in self._rows()]
        return "\n".join([self._title(), *lines])

    def __repr__(self) -> str:
        best, more = self._rows()[0], len(self.options) - 1
        rest = f", {count(more, 'more option')}" if more else ""
        return (
            f"Advice({self.of} to {self.accuracy:g}: {' '.join(best[:2]).strip()}{rest}; print shows the whole of it)"
        )

    def _sheet(self) -> Sheet:
        return Sheet(self._title(), self._rows(), ("", "dt or rtol", "error", "steps", "time"))

    def _title(self) -> str:
        of = f"{self.of}, and positions of massless bodies," if self.judges_massless else self.of
        return f"{of} to {self.accuracy:g}, by a trial of {_part(self.tried)}"

    def _rows(self) -> list[tuple[str, str, str, str, str]]:
        rows: list[tuple[str, str, str, str, str]] = []
        for option in self.options:
            by = option.how.get("dt", option.how.get("rtol"))
            shown = "" if by is None else f"{'dt' if 'dt' in option.how else 'rtol'} {by:.4g}"
            name = option.how["method"] if by is not None else "auto: closed form"
            rows.append((name, shown, f"{option.error:.1e}", f"{option.steps}", f"{option.seconds:.2g} s"))
        return rows


def advise(prepared: _core._Scene, asked: _core._Request, accuracy: float, of: str, closed: bool) -> Advice:
    """What `Scene.advise` gives; `asked` is the request of the whole span, `closed` whether there is a closed form."""
    wanted = number("accuracy", accuracy)
    if not _FLOOR <= wanted < 1.0:
        raise InvalidInput(
            "accuracy", f"expected an error from {_FLOOR:g}, below which float64 tells little, to 1, got {wanted:g}"
        )
    one_of("of", of, ("energy", "position"))
    if prepared["rigid"] is not None:
        raise InvalidInput("rigid_bodies", "trials know points only: try steps of vv.rigid.methods() by themselves")
    massless = of == "energy" and bool((prepared["mass"][0] == 0.0).any())
    if closed:
        # Closed forms are right to some ulps.
        return Advice(wanted, of, massless, (Option({"method": "auto"}, 1e-14, 0, run_stretch(asked, 1.0)[1]),), 1.0)
    trial = trial_of(prepared, dict(asked), of)
    _check_reference(trial, wanted, of)
    options: list[Option] = []
    # The best are likely among those of high order: with their times known, others are soon given up.
    for method in sorted(methods(), key=lambda method: -method.order):
        fastest = min((option.seconds * trial.fraction for option in options), default=trial.seconds)
        option = _option(trial, method, wanted, _PATIENCE * max(fastest, _LEAST))
        if option is not None:
            options.append(option)
    options = _over_the_whole(trial, sorted(options, key=lambda option: option.seconds), wanted, of)
    if not options:
        raise ConvergenceError(
            f"no method holds {wanted:g} of {of} over this span, as far as a trial of {_part(trial.fraction)} tells; "
            "ask for less, or for a shorter span"
        )
    return Advice(wanted, of, massless, tuple(options), trial.fraction)


def _part(fraction: float) -> str:
    return "the whole of it" if fraction == 1.0 else f"the first {fraction:.2g} of it"


def _check_reference(trial: Trial, accuracy: float, of: str) -> None:
    """Refuse what no run tells, as of a motion that has forgotten where it began."""
    if trial.uncertain > accuracy:
        raise ConvergenceError(
            f"no run tells {of} to {accuracy:g} over {_part(trial.fraction)}: the two tightest of {trial.method} "
            f"differ by {trial.uncertain:.1e}, as those of chaotic motions do; ask for less, or for a shorter span"
        )


def _over_the_whole(trial: Trial, options: list[Option], accuracy: float, of: str) -> list[Option]:
    """The options, the fastest of them as they are over the whole span, where that can be tried in a moment.

    One that is off by more there, because what is hard comes later, has its step or tolerance made smaller, or goes.
    """
    whole = trial.whole() if trial.fraction < 1.0 else None
    if whole is None:
        return options
    _check_reference(whole, accuracy, of)
    known = {method.name: method for method in methods()}
    kept: list[Option] = []
    # What the stretch told of times is told better by the whole.
    spent, longer = 0.0, whole.seconds / (trial.seconds / trial.fraction)
    for option in options:
        if spent + max(longer * option.seconds, _STEP * option.steps) > _BUDGET:
            kept.append(option)  # of which the stretch is all that is known
            continue
        by_step = "dt" in option.how
        name, size, factor = ("dt", option.how["dt"], 0.5**0.5) if by_step else ("rtol", option.how["rtol"], 0.1**0.5)
        for _ in range(_TIGHTER):
            found = whole.of_method(known[option.how["method"]], **{name: size})
            spent += found[2] if found is not None else longer * option.seconds
            if found is not None and found[0] <= accuracy:
                kept.append(Option(_settings(option.how["method"], name, size), *found))
                break
            size *= factor
            if spent > _BUDGET or (name == "rtol" and size < TIGHTEST):
                break
    return sorted(kept, key=lambda option: option.seconds)


def _settings(method: MethodName, name: str, size: float) -> RunSettings:
    return {"method": method, "dt": size} if name == "dt" else {"method": method, "rtol": size}


def _option(trial: Trial, method: Method, accuracy: float, patience: float) -> Option | None:
    """The largest step or tolerance with which a method holds the error over the whole, if it does in time."""
    whole = 1.0 / trial.fraction
    if accuracy < _FLOOR * trial.growth(method):
        return None
    direction = 1.0 if float(trial.asked["times"][-1]) >= trial.asked["t0"] else -1.0
    # From a step that is too long on: of as many evaluations as a longest one of the reference.
    shortest, longest = (16.0 * step * method.stages / 12.0 for step in trial.steps)
    halvings = _HALVINGS + log2(longest / shortest)
    sizes = (
        [max(10.0 ** (-0.5 * k), TIGHTEST) for k in range(4, 28)]
        if method.adaptive
        else [direction * longest * 2.0 ** (-0.5 * k) for k in range(round(2.0 * halvings))]
    )
    name = "rtol" if method.adaptive else "dt"
    # Every fourth until one holds, then those that were passed over, the longest first.
    stride = 4
    held = None
    for k in range(0, len(sizes), stride):
        begun = perf_counter()
        found = trial.of_method(method, **{name: sizes[k]})
        if found is not None and found[0] <= accuracy:
            held = k
            break
        # Too long a step may be refused or fail, also after a while; of one that is shorter a trial takes longer still.
        longer = 1.0 if method.adaptive else 2.0 ** (0.5 * stride)
        if longer * (perf_counter() - begun) > patience:
            return None
    if held is None:
        return None
    for k in [*range(max(0, held - stride + 1), held), held]:
        found = trial.of_method(method, **{name: sizes[k]})
        if found is not None and found[0] <= accuracy:
            error, steps, seconds = found
            return Option(_settings(method.name, name, sizes[k]), error, round(steps * whole), seconds * whole)
    return None


def __dir__() -> list[str]:
    return list(__all__)
