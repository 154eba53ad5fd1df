"""The trials of `Scene.advise`: what is tried, against what it is judged, and by how much it is off.

The one idea: errors are measured, on a stretch that a reference does in a moment. The reference is that of the method
whose runs to the two tightest tolerances differ least; what is less than their difference nobody can tell.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._accuracy import resolves_nothing
from visviva._trial import run_stretch
from visviva.errors import ConvergenceError, InvalidInput

if TYPE_CHECKING:
    from visviva import _core
    from visviva.integrators import Method

__all__ = ["TIGHTEST", "Trial", "trial_of"]

# The tightest tolerance, and one that is a little looser.
TIGHTEST, _LOOSER = 2.3e-14, 1e-13
# The reference of a stretch takes this long, that of the whole span no longer than this.
_SECONDS, _WHOLE = 0.03, 1.0
# Errors are looked at so many times: what a method loses in an encounter it may have back soon after. Of many bodies,
# whose energies take as long as steps, at fewer.
_MOST_OUTPUTS, _FEWEST_OUTPUTS, _PAIRS = 256, 32, 1 << 14
# Of these it is made: by the first of those that are equally sure.
_REFERENCES = ("dop853", "verner98", "taylor")


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
class Trial:
    """The stretch that is tried: what is asked, how much of it, and the reference there.

    A step of the reference is between the two of `steps`: those of bodies that have steps of their own are counted
    together.
    """

    asked: dict[str, Any]
    fraction: float
    judged: tuple[_Judged, ...]
    seconds: float
    steps: tuple[float, float]
    method: str
    uncertain: float

    def of_method(self, method: Method, **how: float) -> tuple[float, int, float] | None:
        """Error of the whole, steps and seconds of the stretch; None if a method does not get through it."""
        asked = self.asked | {"method": method.name, "dt": None, "rtol": 1e-9} | how
        found = _measured(asked, self.fraction, [judged.column for judged in self.judged])
        if found is None:
            return None
        columns, steps, seconds = found
        whole = 1.0 / self.fraction
        return max(judged.error(columns) * judged.growth(method, whole) for judged in self.judged), steps, seconds

    def growth(self, method: Method) -> float:
        """By how much the error of a run is more than that of the stretch."""
        return max(judged.growth(method, 1.0 / self.fraction) for judged in self.judged)

    def whole(self) -> Trial | None:
        """The same of the whole span, where a reference does that in about a second; None elsewhere."""
        fraction, seconds = self.fraction, self.seconds
        while fraction < 1.0:
            # Of a short stretch the time tells little; four times as much takes about four times as long.
            if 4.0 * seconds > _WHOLE:
                return None
            fraction = min(1.0, 4.0 * fraction)
            tight = self.asked | {"method": self.method, "dt": None, "rtol": TIGHTEST}
            longer = _measured(tight, fraction, [judged.column for judged in self.judged])
            if longer is None:
                return None
            seconds = longer[2]
        found = _referred(self.asked, 1.0, self.judged, self.method)
        if found is None:
            return None
        judged, uncertain = found
        return replace(self, fraction=1.0, judged=judged, uncertain=uncertain, seconds=seconds)


def trial_of(prepared: _core._Scene, asked: dict[str, Any], of: str) -> Trial:
    """A stretch that DOP853 does within a moment to the tightest tolerance, or the whole span."""
    asked |= {"events": [], "max_steps": None, "continuation": None, "atol": None, "max_step": None}
    tight = asked | {"method": "dop853", "dt": None, "rtol": TIGHTEST}
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
        if column == "position":
            scale = _size(prepared["position"][0], columns[column][0])
        else:
            scale = _energy_scale(prepared, float(values[0]))
        judged.append(_Judged(column, bodies, scale or 1.0, values))
    between = span / steps, span / steps * len(massless)
    trial = Trial(asked, fraction, tuple(judged), seconds, between, "dop853", np.inf)
    for method in _REFERENCES:
        referred = _referred(asked, fraction, trial.judged, method)
        if referred is not None and referred[1] < trial.uncertain:
            trial = replace(trial, judged=referred[0], method=method, uncertain=referred[1])
    return trial


def _referred(
    asked: dict[str, Any], fraction: float, judged: tuple[_Judged, ...], method: str
) -> tuple[tuple[_Judged, ...], float] | None:
    """What is judged against a method's own reference, and what that is off by at most; None if it has none."""
    runs = [
        _measured(asked | {"method": method, "dt": None, "rtol": rtol}, fraction, [each.column for each in judged])
        for rtol in (TIGHTEST, _LOOSER)
    ]
    if runs[0] is None or runs[1] is None:
        return None
    columns, looser = runs[0][0], runs[1][0]
    own = tuple(replace(each, reference=_of(columns, each.column, each.bodies)) for each in judged)
    return own, max(each.error(looser) for each in own)


def _measured(asked: dict[str, Any], fraction: float, columns: list[str]) -> tuple[dict[str, Any], int, float] | None:
    """The columns of a stretch, its steps and seconds; None if refused, warned of or ended early."""
    try:
        request = cast("_core._Request", asked | {"record": columns})
        result, seconds = run_stretch(request, fraction, _FEWEST_OUTPUTS)
        if result["error"] or result["status"].any() or resolves_nothing(result):
            return None
        steps, outputs = result["stats"]["steps"], _outputs(asked)
        if outputs > _FEWEST_OUTPUTS:
            # Between nodes each output may take a step of its own, which is none of the run's.
            result, _ = run_stretch(request, fraction, outputs)
    except InvalidInput:
        return None
    return result["columns"], steps, seconds


def _outputs(asked: dict[str, Any]) -> int:
    bodies: int = asked["mass"].shape[1]
    pairs = max(1, bodies * (bodies - 1) // 2)
    return min(_MOST_OUTPUTS, max(_FEWEST_OUTPUTS, _PAIRS // pairs))


def _of(columns: dict[str, Any], column: str, bodies: Any) -> Any:
    return columns[column][0] if bodies is None else columns[column][0][:, bodies]


def _size(start: Any, positions: Any) -> float:
    """How far from their center bodies are at most; of one alone, or of all in one place, how far they come.

    From where the center is by then: a motion that all share makes no system larger.
    """
    places = np.concatenate([start[None], positions])
    apart = float(np.abs(places - places.mean(axis=1, keepdims=True)).max())
    return apart or float(np.abs(places - start).max())


def _energy_scale(prepared: _core._Scene, start: float) -> float:
    """The energy; where that is a small difference, the parts."""
    mass, velocity = prepared["mass"][0], prepared["velocity"][0]
    kinetic = 0.5 * float((mass * (velocity**2).sum(axis=1)).sum())
    parts = kinetic + abs(start - kinetic)
    return abs(start) if abs(start) > 1e-3 * parts else parts


def __dir__() -> list[str]:
    return list(__all__)
