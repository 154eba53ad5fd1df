"""A word of warning after a run that resolved nothing."""

from __future__ import annotations

import warnings
from typing import Any

from visviva.errors import AccuracyWarning

_TOLERATED = 1e-2
"""Of kinetic + |potential| energy: beyond it not even the shape of an orbit can be trusted."""

_WANTED = 1e-3
"""What the step that is named aims at."""


def judge(result: dict[str, Any], *, ensemble: bool) -> None:
    """Warns of a step that is longer than the run, and of an energy error that is out of all proportion.

    `execute` calls it, for `run`, behind which its keywords are looked at: the fourth caller is the user.
    """
    if "dt_beyond" in result:
        dt, span = result["dt_beyond"]
        message = f"dt = {dt:g} is longer than the run, which takes {span:g}: all of it is part of one step"
        warnings.warn(message, AccuracyWarning, stacklevel=5)
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
    warnings.warn(message, AccuracyWarning, stacklevel=5)
