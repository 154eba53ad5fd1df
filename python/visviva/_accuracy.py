"""A word of warning after a run that resolved nothing."""

from __future__ import annotations

import warnings

from visviva.errors import AccuracyWarning

_TOLERATED = 1e-2
"""Of kinetic + |potential| energy: beyond it not even the shape of an orbit can be trusted."""

_WANTED = 1e-3
"""What the step that is named aims at."""


def judge(found: tuple[int, float, float, int], *, ensemble: bool) -> None:
    """Warns of an energy error (copy, error, dt, order of the method) that is out of all proportion."""
    copy, error, dt, order = found
    if error <= _TOLERATED:
        return
    # The error goes as dt to the power of the order, if not quite yet where it is this large: half of that step.
    step = 0.5 * dt * (_WANTED / error) ** (1.0 / order)
    whose = f"in copy {copy}, " if ensemble else ""
    message = (
        f"{whose}the energy at the end is off by {error:.2g} of kinetic + |potential|: a step of dt = {dt:g} does not "
        f"resolve this motion; try dt = {float(f'{step:.0e}'):g}, or an adaptive method (dop853)"
    )
    warnings.warn(message, AccuracyWarning, stacklevel=4)
