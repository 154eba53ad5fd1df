"""A word of warning after a run that resolved nothing, or whose times are too coarse."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import AccuracyWarning

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva import _core

TOLERATED = 1e-2
"""Of kinetic + |potential| energy: beyond it not even the shape of an orbit can be trusted."""

OF_A_STEP = 0.2
"""A velocity that is off by this part of itself after one step tells nothing."""

ROUNDING = 1e-9
"""What moves in a step may be below this, as a part of what moves it, by the rounding of forces that cancel."""

_FEW_STATES = 4_096
"""Numbers of bodies, and of pairs of them, of all copies, for which a step more takes no time that anybody sees."""

_MANY_STEPS = 1_000
"""Six steps more are nothing beside so many."""

_OF_TOLERANCE = 1e4
"""What many steps that follow `rtol` lose of an energy is not so many times it; what close passages multiply is."""

_OF_STEEP_WALLS = 1e5
"""In generalized coordinates, where a bounce off a steep wall takes many steps."""

_WANTED = 1e-3
"""What the step that is named aims at."""

_UNRESOLVED = 0.1
"""An energy error from which no asymptotic law can be read."""

_LOW_ORDER = 4

_BLOWN_UP = 1e4
"""Energy errors beyond it have grown from step to step, and tell nothing of how much shorter a step must be."""

_OF_POINTS = (
    "an adaptive method (verner98)",
    "an adaptive method (verner98), which finds the steps that close bodies take",
)
_OF_STEPS = ("an adaptive method (verner98)",) * 2
_OF_RIGID_BODIES = ("leaving dt out, for steps that follow rtol",) * 2
"""What may be tried beside a shorter step: where it nearly does, and where it does nothing of the kind."""

_EVIDENCE = {
    "first_step": "after the first step",
    "step_from_the_end": "after a step from the end",
    "drive": "by a DrivenForce that has less than two steps to a period",
}
"""What tells that a step does not resolve a motion."""

_FAR = 1e3
"""So many times the span from the time zero, a phase of a thousand turns still has ten digits."""

_PACKAGE = str(Path(__file__).parent)


_TRIED = 17
"""Times of the run at which forces are asked."""
_BESIDE = (1, -1, 2, 3)
"""Numbers beside them: phases at neighbors may round to the same number."""
_ROUNDINGS = 8.0
"""So many times what a rounding of the state changes is rounding."""


def callers_inside() -> int:
    """How many frames from here on are of this package; the next one is the user's."""
    depth = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame = frame.f_back
        depth += 1
    return depth


def warn_if_unresolved(result: dict[str, Any], asked: _core._Request, *, ensemble: bool) -> None:
    """Warn of a step longer than the run, events without zeros, and a motion that was not resolved.

    That is told by an energy error out of all proportion, else by an orbit, a turn of a charge or a step.
    """
    for place in result.pop("without_numbers", ()):
        message = f"events[{place}] gave NaN whenever it was asked: it has no zeros, and none were looked for"
        warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())
    if "dt_beyond" in result:
        dt, span = result["dt_beyond"]
        message = f"dt = {dt:g} is longer than the run, which takes {span:g}: all of it is part of one step"
        warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())
    copy, error, dt, order = result.get("energy_error", (0, 0.0, None, 1))
    follows = dt is None and asked["atol"] is None
    if error <= (min(TOLERATED, _OF_TOLERANCE * asked["rtol"]) if follows else TOLERATED):
        if "too_long" in result:
            _warn_of_turn(result, ensemble=ensemble)
        elif "unresolved" in result:
            _warn_of_step(result, asked, ensemble=ensemble)
        return
    whose = f"in copy {copy}, " if ensemble else ""
    advice = _advice(result, error, dt, order, _OF_POINTS if asked["rigid"] is None else _OF_RIGID_BODIES)
    if error <= TOLERATED:
        advice = (
            f"{error / asked['rtol']:.0e} times rtol = {asked['rtol']:g}, to which each step is held: close passages, "
            "or many steps, multiply it; try a smaller rtol"
        )
    size = f"{error:.2g}" if error < np.inf else "more than 1e308"
    message = f"{whose}the energy at the end is off by {size} of kinetic + |potential|: {advice}"
    warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def resolves_nothing(result: dict[str, Any]) -> bool:
    """Whether a run is warned of, by its energy, an orbit, a turn of a charge or a step."""
    return result.get("energy_error", (0, 0.0))[1] > TOLERATED or "too_long" in result or "unresolved" in result


def steps_may_be_taken_again(steps: NDArray[np.int64], each: int) -> NDArray[np.bool_]:
    """Of copies that took so many steps, of so many bodies and pairs, or coordinates, each: where it costs nothing."""
    few = len(steps) * each <= _FEW_STATES
    return (steps > 0) & (few | (steps >= _MANY_STEPS))


def times_may_be_coarse(t0: float, end: float) -> bool:
    """Whether a run is so far from the time zero, beside its span, that what forces make of times is worth a look."""
    return max(abs(t0), abs(end)) > _FAR * abs(end - t0) > 0.0


def warn_if_coarse(
    told: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    span: tuple[float, float],
    rtol: float,
    what: str,
    nudged: Callable[[NDArray[np.float64]], NDArray[np.float64]] | None = None,
) -> None:
    """Warn where what is told of times (T,), in rows, changes by more than the tolerance from one to the next number.

    With what is told where states are a rounding off (`nudged`), each number is measured by itself, and what such a
    rounding changes is none of the times.
    """
    times = np.linspace(*span, _TRIED)
    apart = float(np.spacing(np.abs(times).max()))
    here, *beside = (told(times + off * apart) for off in (0, *_BESIDE))
    with np.errstate(all="ignore"):
        sizes = np.abs(here).max(axis=None if nudged is None else 0)
        rounding = 0.0 if nudged is None else _ROUNDINGS * np.abs(nudged(times) - here).max(axis=0)
        shares = [
            (np.abs(there - here) - rounding) / (abs(off) * sizes) for off, there in zip(_BESIDE, beside, strict=True)
        ]
    change = float(np.nanmax(np.where(sizes > 0.0, shares, 0.0)))
    if change > rtol:
        message = (
            f"times near {times[-1]:g} are numbers {apart:.2g} apart, and from one to the next {what} "
            f"by {change:.2g} of itself: no method errs by less; count time from the start of the run, "
            "with t0 = 0, and put what has gone before into a phase"
        )
        warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def _warn_of_step(result: dict[str, Any], asked: _core._Request, *, ensemble: bool) -> None:
    """Warn of a step that two of half its length contradict, where energies know nothing: under drag, without mass."""
    copy, velocity, error, by, dt, order = result["unresolved"]
    whose = f"in copy {copy}, " if ensemble else ""
    # The error of one step goes as dt to one power more than that at the end.
    advice = _advice(result, error, dt, order + 1, _OF_STEPS if asked["rigid"] is None else _OF_RIGID_BODIES)
    if by == "drive":
        # What steps see of it does not go as a power of them.
        advice = "take steps of a sixth of its period or less, or an adaptive method (verner98)"
    size = f"{error:.2g} of itself" if error < np.inf else "more than 1e308"
    message = f"{whose}{_EVIDENCE[by]} {velocity} is off by {size}: {advice}"
    warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def _warn_of_turn(result: dict[str, Any], *, ensemble: bool) -> None:
    """Warn of a turn with too few steps: total energies hardly know of a light body that is lost."""
    copy, (body, place), steps, fewest, at_pericenter = result["too_long"]
    tight = ", as tight as at its pericenter," if at_pericenter else ""
    whose = f"in copy {copy}, " if ensemble else ""
    # A turn may take no time beside a step, or a step be hardly too long.
    shorter = f"a step that is {max(fewest / steps, 1.1):.2g} times shorter or less, or " if steps > 0.0 else ""
    message = (
        f"{whose}a turn of body {body} {place}{tight} has {steps:.3g} steps, and the method "
        f"tells nothing of orbits with fewer than {fewest:g}: take {shorter}an adaptive method (taylor, verner98)"
    )
    warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def _advice(result: dict[str, Any], error: float, dt: float | None, order: int, others: tuple[str, str]) -> str:
    if dt is None:
        return "the tolerance does not resolve this motion; try a smaller rtol, and no atol"
    # The error goes as dt to the power of the order, if not quite yet where it is this large: half of that step. Where
    # it has grown to the energy itself it tells little: then as for a low order.
    power = 1.0 / (order if error < _UNRESOLVED else min(order, _LOW_ORDER))
    longest = min(dt, result.get("dt_beyond", (dt, dt))[1])
    named = f"dt = {float(f'{0.5 * longest * (_WANTED / min(error, _BLOWN_UP)) ** power:.0e}'):g}"
    problem = f"a step of dt = {dt:g} does not resolve this motion; "
    if error < _UNRESOLVED:
        return f"{problem}try {named}, or {others[0]}"
    return f"{problem}try {others[1]}, or at most {named}"


def limit_of_energies(asked: dict[str, Any]) -> float:
    """The least error of an energy, in generalized coordinates, that is warned of: of equal steps, or chosen ones."""
    if asked["dt"] is not None:
        return _UNRESOLVED
    return min(TOLERATED, _OF_STEEP_WALLS * asked["rtol"]) if asked["atol"] is None else TOLERATED


def warn_of_energy(asked: dict[str, Any], error: float, copy: int | None, *, at_end: bool = True) -> None:
    """Warn of a run in generalized coordinates of which a conserved energy is off by as much, at the end or before."""
    whose = "" if copy is None else f"in copy {copy}, "
    dt = asked["dt"]
    if error <= TOLERATED:
        cause = (
            f"{error / asked['rtol']:.0e} times rtol = {asked['rtol']:g}, to which each step is held: sharp bends, or "
            "many steps, multiply it; try a smaller rtol, or another method (dop853)"
        )
    elif dt is None:
        cause = (
            "something that is shorter than a step was passed over, or the tolerance does not resolve this motion; "
            "give a max_step below the time that its narrowest part takes, or a smaller rtol"
        )
    else:
        cause = _too_long(dt)
    where = "at the end" if at_end else "on the way"
    message = f"{whose}the energy {where} is off by {error:.2g} of kinetic + |potential|: {cause}"
    warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def warn_of_step(dt: float, error: float, at_end: bool, copy: int | None) -> None:
    """Warn of a step in generalized coordinates that two of half its length contradict."""
    whose = "" if copy is None else f"in copy {copy}, "
    which = _EVIDENCE["step_from_the_end" if at_end else "first_step"]
    message = f"{whose}{which} the velocities are off by {error:.2g} of themselves: {_too_long(dt)}"
    warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def _too_long(dt: float) -> str:
    return (
        f"a step of dt = {dt:g} does not resolve this motion; take a shorter one, or leave it to gauss16, which "
        "chooses its own"
    )
