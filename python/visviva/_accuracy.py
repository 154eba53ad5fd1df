"""A word of warning after a run that resolved nothing."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import AccuracyWarning

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TOLERATED = 1e-2
"""Of kinetic + |potential| energy: beyond it not even the shape of an orbit can be trusted."""

_WANTED = 1e-3
"""What the step that is named aims at."""


_UNRESOLVED = 0.1
"""An energy error from which no asymptotic law can be read."""

_LOW_ORDER = 4

_BLOWN_UP = 1e4
"""Energy errors beyond it have grown from step to step, and tell nothing of how much shorter a step must be."""

_PACKAGE = str(Path(__file__).parent)


def _callers_inside() -> int:
    """How many frames from here on are of this package; the next one is the user's."""
    depth = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame = frame.f_back
        depth += 1
    return depth


def warn_if_unresolved(result: dict[str, Any], *, ensemble: bool) -> None:
    """Warn of a step longer than the run, events without zeros, and an energy error out of all proportion."""
    for place in result.pop("without_numbers", ()):
        message = f"events[{place}] gave NaN whenever it was asked: it has no zeros, and none were looked for"
        warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())
    if "dt_beyond" in result:
        dt, span = result["dt_beyond"]
        message = f"dt = {dt:g} is longer than the run, which takes {span:g}: all of it is part of one step"
        warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())
    copy, error, dt, order = result.get("energy_error", (0, 0.0, None, 1))
    if error <= _TOLERATED:
        _judge_turns(result, ensemble=ensemble)
        return
    whose = f"in copy {copy}, " if ensemble else ""
    advice = _advice(result, error, dt, order)
    size = f"{error:.2g}" if error < np.inf else "more than 1e308"
    message = f"{whose}the energy at the end is off by {size} of kinetic + |potential|: {advice}"
    warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())


def _judge_turns(result: dict[str, Any], *, ensemble: bool) -> None:
    """Warn of an orbit with too few steps: total energies hardly know of a light body that is lost."""
    if "too_long" not in result:
        return
    copy, (body, about), steps, fewest, at_pericenter = result["too_long"]
    tight = ", as tight as at its pericenter," if at_pericenter else ""
    whose = f"in copy {copy}, " if ensemble else ""
    # A turn may take no time beside a step.
    shorter = f"a step that is {fewest / steps:.2g} times shorter or less, or " if steps > 0.0 else ""
    message = (
        f"{whose}a turn of body {body} about body {about}{tight} has {steps:.3g} steps, and the method "
        f"tells nothing of orbits with fewer than {fewest:g}: take {shorter}an adaptive method (taylor, verner98)"
    )
    warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())


def _advice(result: dict[str, Any], error: float, dt: float | None, order: int) -> str:
    if dt is None:
        return "the tolerance does not resolve this motion; try a smaller rtol (the default is 1e-9), and no atol"
    # The error goes as dt to the power of the order, if not quite yet where it is this large: half of that step. Where
    # it has grown to the energy itself it tells little: then as for a low order.
    power = 1.0 / (order if error < _UNRESOLVED else min(order, _LOW_ORDER))
    longest = min(dt, result.get("dt_beyond", (dt, dt))[1])
    named = f"dt = {float(f'{0.5 * longest * (_WANTED / min(error, _BLOWN_UP)) ** power:.0e}'):g}"
    problem = f"a step of dt = {dt:g} does not resolve this motion; "
    if error < _UNRESOLVED:
        return f"{problem}try {named}, or an adaptive method (verner98)"
    return (
        f"{problem}try an adaptive method (verner98), which finds the steps that close bodies take, or at most {named}"
    )


def judge_energies(dt: float, energies: NDArray[np.float64], sizes: NDArray[np.float64], *, ensemble: bool) -> None:
    """Warn of energies (B, 2) at both ends of runs in equal steps that are conserved and differ out of all proportion.

    `sizes` (B, 2) are those of the kinetic and potential energies that they are sums of.
    """
    with np.errstate(all="ignore"):
        errors = np.abs(energies[:, 1] - energies[:, 0]) / sizes.max(axis=1)
    worst = int(np.argmax(np.where(np.isfinite(errors), errors, 0.0)))
    if not errors[worst] > _UNRESOLVED:
        return
    whose = f"in copy {worst}, " if ensemble else ""
    message = (
        f"{whose}the energy at the end is off by {errors[worst]:.2g} of kinetic + |potential|: a step of dt = {dt:g} "
        "does not resolve this motion; take a shorter one, or leave it to gauss16, which chooses its own"
    )
    warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())
