"""A word of warning after a run that resolved nothing."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path
from typing import Any

from visviva.errors import AccuracyWarning

_TOLERATED = 1e-2
"""Of kinetic + |potential| energy: beyond it not even the shape of an orbit can be trusted."""

_WANTED = 1e-3
"""What the step that is named aims at."""


_PACKAGE = str(Path(__file__).parent)


def _callers_inside() -> int:
    """How many frames from here on are of this package; the next one is the user's."""
    depth = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame = frame.f_back
        depth += 1
    return depth


def judge(result: dict[str, Any], *, ensemble: bool) -> None:
    """Warn of a step that is longer than the run, and of an energy error that is out of all proportion."""
    if "dt_beyond" in result:
        dt, span = result["dt_beyond"]
        message = f"dt = {dt:g} is longer than the run, which takes {span:g}: all of it is part of one step"
        warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())
    copy, error, dt, order = result.get("energy_error", (0, 0.0, 0.0, 1))
    if error <= _TOLERATED:
        return
    # The error goes as dt to the power of the order, if not quite yet where it is this large: half of that step.
    step = 0.5 * dt * (_WANTED / error) ** (1.0 / order)
    whose = f"in copy {copy}, " if ensemble else ""
    message = (
        f"{whose}the energy at the end is off by {error:.2g} of kinetic + |potential|: a step of dt = {dt:g} does not "
        f"resolve this motion; try dt = {float(f'{step:.0e}'):g}, or an adaptive method (dop853)"
    )
    warnings.warn(message, AccuracyWarning, stacklevel=_callers_inside())
