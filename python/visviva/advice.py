"""Advice: which method and which step hold an error that is asked for, by a short trial.

The one idea: on the first stretch of the very run every method of the registry is tried with larger and larger steps
against a reference, and the largest that hold what the stretch may be off are compared by their time. From the stretch
to the whole, errors grow as the theory has it: the energy of a symplectic method not at all and its phase linearly, the
energy of any other method linearly and its phase quadratically. A motion that is chaotic, or one that has its hardest
part after the stretch, is worse than that.
Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration* 2nd ed., IX.8, X.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._arrays import number
from visviva._html import Record, Sheet, Shown
from visviva._keywords import known_keywords, one_of
from visviva._text import count
from visviva._trial import run_stretch
from visviva.errors import ConvergenceError, InvalidInput
from visviva.integrators import methods

if TYPE_CHECKING:
    from visviva import _core
    from visviva.integrators import Method
    from visviva.typing import RunSettings

__all__ = ["Advice", "Option", "advise"]

# The reference of a stretch takes this long, and its error is below this one.
_SECONDS, _FLOOR = 0.03, 5e-13
_OUTPUTS = 32
_TIGHTEST = 2.3e-14
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
        What the run is expected to be off, relative, without dimension.
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
        part = "the whole of it" if self.tried == 1.0 else f"the first {self.tried:.2g} of it"
        of = f"{self.of}, and positions of massless bodies," if self.judges_massless else self.of
        return f"{of} to {self.accuracy:g}, by a trial of {part}"

    def _rows(self) -> list[tuple[str, str, str, str, str]]:
        rows: list[tuple[str, str, str, str, str]] = []
        for option in self.options:
            by = option.how.get("dt", option.how.get("rtol"))
            shown = "" if by is None else f"{'dt' if 'dt' in option.how else 'rtol'} {by:.4g}"
            name = option.how["method"] if by is not None else "auto: closed form"
            rows.append((name, shown, f"{option.error:.1e}", f"{option.steps}", f"{option.seconds:.2g} s"))
        return rows


@dataclass(frozen=True, slots=True)
class _Judged:
    """What is judged: a column, of some bodies, over a scale; and what it was in the reference."""

    column: str
    bodies: Any
    scale: float
    reference: Any

    def error(self, columns: dict[str, Any]) -> float:
        return float(np.abs(_of(columns, self.column, self.bodies) - self.reference).max()) / self.scale

    def growth(self, method: Method, whole: float) -> float:
        """By how much the error of a run is more than that of its stretch, which it is `whole` times as long as."""
        return float(whole ** ((0 if method.symplectic else 1) + (1 if self.column == "position" else 0)))


@dataclass(frozen=True, slots=True)
class _Trial:
    """The stretch that is tried: what is asked, how much of it, and the reference there."""

    asked: dict[str, Any]
    fraction: float
    judged: tuple[_Judged, ...]
    seconds: float
    step: float

    def of_method(self, method: Method, **how: float) -> tuple[float, int, float] | None:
        """Error of the whole, steps and seconds of the stretch; None if a method does not get through it."""
        asked = self.asked | {"method": method.name, "dt": None, "rtol": 1e-9} | how
        try:
            found = _measured(asked, self.fraction, [judged.column for judged in self.judged])
        except InvalidInput:
            return None
        if found is None:
            return None
        columns, steps, seconds = found
        whole = 1.0 / self.fraction
        return max(judged.error(columns) * judged.growth(method, whole) for judged in self.judged), steps, seconds


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
    trial = _reference(prepared, dict(asked), of)
    options: list[Option] = []
    # The best are likely among those of high order: with their times known, others are soon given up.
    for method in sorted(methods(), key=lambda method: -method.order):
        fastest = min((option.seconds * trial.fraction for option in options), default=trial.seconds)
        option = _option(trial, method, wanted, _PATIENCE * max(fastest, _SECONDS / 8.0))
        if option is not None:
            options.append(option)
    if not options:
        raise ConvergenceError(
            f"no method holds {wanted:g} of {of} over this span, as far as a trial of its first {trial.fraction:.2g} "
            "tells; ask for less, or for a shorter span"
        )
    return Advice(wanted, of, massless, tuple(sorted(options, key=lambda option: option.seconds)), trial.fraction)


def _of(columns: dict[str, Any], column: str, bodies: Any) -> Any:
    return columns[column][0] if bodies is None else columns[column][0][:, bodies]


def _measured(asked: dict[str, Any], fraction: float, columns: list[str]) -> tuple[dict[str, Any], int, float] | None:
    """The columns of a stretch, its steps and seconds; None if it does not come to its end."""
    result, seconds = run_stretch(cast("_core._Request", asked | {"record": columns}), fraction, _OUTPUTS)
    if result["error"] or result["status"].any():
        return None
    return result["columns"], result["stats"]["steps"], seconds


def _reference(prepared: _core._Scene, asked: dict[str, Any], of: str) -> _Trial:
    """A stretch that DOP853 does within a moment to the tightest tolerance, or the whole span."""
    asked |= {"events": [], "max_steps": None, "continuation": None, "atol": None, "max_step": None}
    tight = asked | {"method": "dop853", "dt": None, "rtol": _TIGHTEST}
    massless = prepared["mass"][0] == 0.0
    # A massless body has no energy by which it could be judged.
    wanted = {"position": None} if of == "position" else {"energy": None, "position": massless}
    if of == "energy" and not massless.any():
        del wanted["position"]
    elif massless.all():
        wanted = {"position": None}
    fraction, done = 1.0 / 65536.0, None
    while True:
        found = _measured(tight, fraction, list(wanted))
        if found is None:
            break
        done = (fraction, *found)
        if fraction == 1.0 or found[2] > _SECONDS:
            break
        fraction = min(1.0, 4.0 * fraction)
    if done is None or done[2] == 0:
        raise ConvergenceError("a trial of the first steps ended early, so there is nothing to advise on")
    fraction, columns, steps, seconds = done
    span = abs(float(asked["times"][-1]) - asked["t0"]) * fraction
    judged = []
    for column, bodies in wanted.items():
        values = _of(columns, column, bodies)
        scale = _size(prepared, values) if column == "position" else _energy_scale(prepared, float(values[0]))
        judged.append(_Judged(column, bodies, scale or 1.0, values))
    return _Trial(asked, fraction, tuple(judged), seconds, span / steps)


def _size(prepared: _core._Scene, positions: Any) -> float:
    """How far from the center of the bodies they are at first, or come."""
    start = prepared["position"][0]
    center = start.mean(axis=0)
    return float(max(np.abs(positions - center).max(), np.abs(start - center).max()))


def _energy_scale(prepared: _core._Scene, start: float) -> float:
    """The energy; where that is a small difference, the parts."""
    mass, velocity = prepared["mass"][0], prepared["velocity"][0]
    kinetic = 0.5 * float((mass * (velocity**2).sum(axis=1)).sum())
    parts = kinetic + abs(start - kinetic)
    return abs(start) if abs(start) > 1e-3 * parts else parts


def _option(trial: _Trial, method: Method, accuracy: float, patience: float) -> Option | None:
    """The largest step or tolerance with which a method holds the error over the whole, if it does in time."""
    whole = 1.0 / trial.fraction
    if any(accuracy < _FLOOR * judged.growth(method, whole) for judged in trial.judged):
        return None
    direction = 1.0 if float(trial.asked["times"][-1]) >= trial.asked["t0"] else -1.0
    # From a step that is too long on: of as many evaluations as a longest one of the reference.
    sizes = (
        [max(10.0 ** (-0.5 * k), _TIGHTEST) for k in range(4, 28)]
        if method.adaptive
        else [16.0 * direction * trial.step * method.stages / 12.0 * 2.0 ** (-0.5 * k) for k in range(2 * _HALVINGS)]
    )
    name = "rtol" if method.adaptive else "dt"
    # Every fourth until one holds, then those that were passed over, the longest first.
    stride = 4
    held = None
    for k in range(0, len(sizes), stride):
        found = trial.of_method(method, **{name: sizes[k]})
        if found is not None and found[0] <= accuracy:
            held = k
            break
        # Too long a step may be refused or fail; one that takes too long is no better when it is shorter.
        if found is not None and found[2] > patience:
            return None
    if held is None:
        return None
    for k in [*range(max(0, held - stride + 1), held), held]:
        found = trial.of_method(method, **{name: sizes[k]})
        if found is not None and found[0] <= accuracy:
            error, steps, seconds = found
            how: RunSettings = {"method": method.name}
            how["rtol" if method.adaptive else "dt"] = sizes[k]
            return Option(how, error, round(steps * whole), seconds * whole)
    return None


def __dir__() -> list[str]:
    return list(__all__)
