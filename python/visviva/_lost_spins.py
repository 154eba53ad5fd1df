"""Spins of slender bodies that rounding of an angular momentum takes from, told after a run.

The one idea: where torques turn a body its state holds the angular momentum in space, to its last digit. Of a needle,
or of what is held at the end of a long arm, the part along the axis of least moment is next to nothing of it, and the
spin about that axis is known to no more digits than are left there.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from visviva._accuracy import callers_inside
from visviva.errors import AccuracyWarning

if TYPE_CHECKING:
    from visviva import _core

__all__ = ["warn_of_lost_spins"]

_STEPS = 10.0
"""So many times the rounding of one step a run of some hundred leaves."""

_TOLERATED = 1e-6
"""Less is not told, whatever was asked for: equal steps are not held to a tolerance."""


def warn_of_lost_spins(asked: _core._Request, *, ensemble: bool) -> None:
    """Warn of bodies whose angular velocities are known to fewer digits than ``rtol`` asks for, and than six."""
    rigid = asked["rigid"]
    if rigid is None:
        return
    moments = rigid["moments"]
    with np.errstate(over="ignore"):
        spread = moments.max(axis=-1) / np.where(moments > 0.0, moments, np.inf).min(axis=-1)
    lost = _STEPS * np.finfo(float).eps * spread
    copy, body = np.unravel_index(int(np.argmax(lost)), lost.shape)
    if not lost[copy, body] > max(asked["rtol"], _TOLERATED):
        return
    whose = f" of copy {copy}" if ensemble else ""
    message = (
        f"the largest moment of rigid body {body}{whose} is {spread[copy, body]:.1g} times the least: rounding of its "
        f"angular momentum leaves about {lost[copy, body]:.0e} of its angular velocity about that axis; take a rod (a "
        "moment of 0) for what does not spin about itself, or a shorter arm"
    )
    warnings.warn(message, AccuracyWarning, stacklevel=callers_inside())


def __dir__() -> list[str]:
    return list(__all__)
