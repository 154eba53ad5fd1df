"""Steps of scenes with rigid bodies, taken once more: of another length, or from where a run has come to.

Where forces do not conserve energy, a step that two of half its length contradict tells that it resolves nothing, as
the core itself tells of particles.
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._accuracy import OF_A_STEP, ROUNDING
from visviva._some_copies import of_copies
from visviva.errors import Error

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["COLUMNS", "after_a_step", "unresolved"]

COLUMNS = ("position", "velocity", "orientation", "angular_velocity")
"""The state of a scene with rigid bodies."""


def after_a_step(
    asked: _core._Request, states: Sequence[NDArray[np.float64]], t0: float, dt: float, threads: int | None
) -> list[NDArray[np.float64]]:
    """The states of all copies after the time that one step of the run takes, in steps `dt`.

    Raises
    ------
    Error
        What a run raises; of copies that end before, there are other states.
    """
    position, velocity, orientation, angular_velocity = states
    rigid: Any = asked["rigid"]
    request: Any = dict(asked)
    request |= {"position": position, "velocity": velocity, "t0": t0, "dt": dt}
    request["rigid"] = rigid | {"orientation": orientation, "angular_velocity": angular_velocity}
    request["times"] = np.array([t0 + np.copysign(asked["dt"] or 0.0, asked["times"][-1] - asked["t0"])])
    request |= {"end_only": True, "record": [], "continuation": None, "events": []}
    result = _core.run(request, threads=threads, progress=None, ensemble=True)
    return [result["final"][name] for name in COLUMNS]


def unresolved(
    result: dict[str, Any], asked: _core._Request, copies: NDArray[np.intp], order: int, threads: int | None
) -> tuple[Any, ...] | None:
    """Give the worst step of some copies that does not resolve the run, at its start or its end, as the core does."""
    dt = asked["dt"]
    if dt is None or not len(copies):
        return None
    continued = asked["continuation"] is not None
    asked = of_copies(asked, copies)
    rigid: Any = asked["rigid"]
    start = [asked["position"], asked["velocity"], rigid["orientation"], rigid["angular_velocity"]]
    end = [result["final"][name][copies] for name in COLUMNS]
    worst = None
    for by, states, t in (("first_step", start, asked["t0"]), ("step_from_the_end", end, float(asked["times"][-1]))):
        if by == "first_step" and continued:
            continue  # It was looked at when that began.
        with suppress(Error):
            whole, halves = (after_a_step(asked, states, t, length, threads) for length in (dt, 0.5 * dt))
            for which, errors in _errors(states, whole, halves, end, abs(dt)):
                copy, body = (int(i) for i in np.unravel_index(np.argmax(errors), errors.shape))
                error = float(errors[copy, body])
                if error > OF_A_STEP and (worst is None or error > worst[2]):
                    worst = (int(copies[copy]), f"{which} {body}", error, by, abs(dt), order)
    return worst


def _errors(
    before: Sequence[NDArray[np.float64]],
    whole: Sequence[NDArray[np.float64]],
    halves: Sequence[NDArray[np.float64]],
    end: Sequence[NDArray[np.float64]],
    step: float,
) -> list[tuple[str, NDArray[np.float64]]]:
    """How far the velocities and the spins of all bodies of all copies are off, as parts of the largest on the way."""
    places = np.max([np.abs(states[0]).max(axis=2) for states in (before, whole)], axis=0)
    places = np.maximum(places, 1e-3 * places.max(axis=1, keepdims=True))
    found = []
    for which, column, known in (
        ("the velocity of body", 1, ROUNDING * places),
        ("the spin of rigid body", 3, ROUNDING),
    ):
        with np.errstate(all="ignore"):
            off = np.linalg.norm(whole[column] - halves[column], axis=2)
            sizes = [np.linalg.norm(states[column], axis=2) for states in (before, whole, halves, end)]
            errors = np.where(off * step > known, off / np.max(sizes, axis=0), 0.0)
            errors[~np.isfinite(whole[column]).all(axis=2)] = np.inf
        found.append((which, np.nan_to_num(errors, nan=0.0, posinf=np.inf)))
    return found
