"""Whether runs have resolved anything: told by an energy that is conserved, else by steps of half the length."""

from __future__ import annotations

from operator import mul
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._accuracy import limit_of_energies, warn_of_energy, warn_of_step
from visviva.errors import Interrupted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["warn_if_unresolved"]

_ON_THE_WAY = 17
"""Times at which a motion is looked at whose energies at its ends may be no measure."""

_OF_A_STEP = 0.2
"""Velocities that are off by this part of themselves after one step tell nothing."""

_ROUNDING = 1e-9
"""Velocities below this part of those that the energies would give are the rounding of forces that cancel."""


def warn_if_unresolved(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    starts: NDArray[np.float64],
    lasts: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
) -> None:
    """Warn of runs from states (B, 2n) to others at a time whose energies differ by much of what they are sums of.

    Where energies are not conserved, of equal steps that two of half their length contradict.

    Raises
    ------
    Interrupted
        After Ctrl-C while a motion is run again; whoever has the run gives it along.
    """
    # What is exact need not be looked at.
    if asked["method"] == "matrix_exponential":
        return
    if not system._structure["conserves_energy"]:
        if asked["dt"] is not None:
            _look_at_steps(system, asked, starts, lasts, values)
        return
    copies, (states, t) = len(starts), lasts
    if copies == 1 and _is_plainly_kept(system, asked, starts, lasts, values):
        return
    times = np.repeat([system.t0, t], copies)
    energies, sizes = _energies(system, times, np.concatenate([starts, states]), np.concatenate([values, values]))
    with np.errstate(all="ignore"):
        changes = np.abs(energies[copies:] - energies[:copies])
        sizes = np.maximum(sizes[:copies], sizes[copies:])
        errors = changes / sizes
    errors[~np.isfinite(errors)] = 0.0
    limit = limit_of_energies(asked["dt"])
    for copy in np.argsort(-errors):
        if not errors[copy] > limit:
            return
        # A motion that begins at rest and comes back has no energies at its ends to be compared with.
        error = float(changes[copy] / max(sizes[copy], _largest(system, asked, starts[copy], t, values[copy])))
        if error > limit:
            warn_of_energy(asked["dt"], error, int(copy) if copies > 1 else None)
            return


def _look_at_steps(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    starts: NDArray[np.float64],
    lasts: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
) -> None:
    """Warn of the copy whose first step, or one that would follow on the last, is off by most of its velocities."""
    errors = [_off_after_a_step(system, asked, before, lasts, values) for before in ((starts, system.t0), lasts)]
    at_end = bool(np.max(errors[1]) > np.max(errors[0]))
    copy = int(np.argmax(errors[at_end]))
    error = float(errors[at_end][copy])
    if error > _OF_A_STEP:
        warn_of_step(asked["dt"], error, at_end, copy if len(starts) > 1 else None)


def _off_after_a_step(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    before: tuple[NDArray[np.float64], float],
    end: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
) -> NDArray[np.float64]:
    """How far velocities (B,) are off after one step, by two of half its length, in the metric of the kinetic energy.

    As parts of the largest on the way, or at the end: what is lost where hardly anything moves yet is nothing.
    """
    states, t = before
    n, step = len(system.coordinates), float(np.copysign(asked["dt"], asked["span"][1] - asked["span"][0]))
    way = asked | {"span": (t, t + step), "outputs": np.array([t + step]), "events": [], "looked_for": ()}
    after = []
    for dt in (asked["dt"], 0.5 * asked["dt"]):
        again = system._run(way | {"dt": dt}, states, values, 1, progress=False)
        if again["interrupted"]:
            raise Interrupted("the look at the steps was interrupted")
        y = again["y"].reshape(len(states), -1, 2 * n)
        after.append(y[:, -1] if y.shape[1] else np.full_like(states, np.nan))
    with np.errstate(all="ignore"):
        told = [(after[0], t + step), (after[1], t + step), before, end]
        p = np.stack([y[:, n:] for y, _ in told])
        v = np.stack([_columns(system, y, at, values)[:, :n] for y, at in told])
        # Products of those of a motion that has blown up may be beyond all numbers.
        p_largest, v_largest = (np.abs(x).max(axis=(0, 2)) for x in (p, v))
        p, v = p / p_largest[:, None], v / v_largest[:, None]
        off = np.abs(((p[0] - p[1]) * (v[0] - v[1])).sum(axis=1))
        errors: NDArray[np.float64] = np.sqrt(off / np.abs((p * v).sum(axis=2)).max(axis=0))
        _, energies = _energies(system, np.full(len(states), t), states, values)
        rounding = np.isfinite(energies) & (off * p_largest * v_largest <= _ROUNDING**2 * energies)
        errors[~np.isfinite(errors) | rounding] = 0.0
    return errors


def _is_plainly_kept(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    start: NDArray[np.float64],
    last: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
) -> bool:
    """Whether one run's energy is plainly what it was: arithmetic of numbers, a tenth of that of arrays of two."""
    state, t = last
    states = np.concatenate([start, state])
    columns = system._model.columns(np.array([system.t0, t]), states, values).tolist()
    n, (first, second) = len(system.coordinates), states.tolist()
    energies, sizes = [], []
    for column, row in zip(columns, (first, second), strict=True):
        kinetic = 0.5 * abs(sum(map(mul, column[:n], row[n:])))
        energies.append(column[n])
        sizes.append(kinetic + abs(column[n] - kinetic))
    # Half of what is warned of, lest it hang on the order of a sum; what is no number is not below it.
    return bool(abs(energies[1] - energies[0]) <= 0.5 * limit_of_energies(asked["dt"]) * max(sizes))


def _largest(
    system: GeneralizedSystem, asked: dict[str, Any], start: NDArray[np.float64], t: float, values: NDArray[np.float64]
) -> float:
    """The largest size of energies on the way to that time, which is run again for it."""
    outputs = np.linspace(system.t0, t, _ON_THE_WAY)
    way = asked | {"outputs": outputs, "span": (system.t0, t), "events": []}
    again = system._run(way, start[None, :], values[None, :], 1, progress=False)
    if again["interrupted"]:
        raise Interrupted("the look at the energies was interrupted")
    states = again["y"].reshape(-1, len(start))
    _, sizes = _energies(system, outputs[: len(states)], states, np.tile(values, (len(states), 1)))
    return float(np.max(sizes, initial=0.0, where=np.isfinite(sizes)))


def _energies(
    system: GeneralizedSystem, times: NDArray[np.float64], states: NDArray[np.float64], values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Energies (B,), and those of the kinetic and potential energies that they are sums of."""
    n = len(system.coordinates)
    with np.errstate(all="ignore"):
        columns = _columns(system, states, times, values)
        # ½ p·v, of a quadratic kinetic energy.
        kinetic = 0.5 * np.abs((columns[:, :n] * states[:, n:]).sum(axis=1))
        return columns[:, n], kinetic + np.abs(columns[:, n] - kinetic)


def _columns(
    system: GeneralizedSystem, states: NDArray[np.float64], t: float | NDArray[np.float64], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Of states (B, 2n) the other factors of p·v, then their energies."""
    return system._model.columns(np.broadcast_to(t, len(states)).copy(), np.ascontiguousarray(states), values)
