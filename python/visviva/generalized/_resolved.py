"""Whether runs have resolved anything: told by an energy that is conserved, else by steps of half the length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial
from operator import mul
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._accuracy import (
    OF_A_STEP,
    ROUNDING,
    TOLERATED,
    limit_of_energies,
    steps_may_be_taken_again,
    times_may_be_coarse,
    warn_if_coarse,
    warn_of_energy,
    warn_of_step,
)
from visviva.errors import Interrupted
from visviva.generalized._methods import EXACT
from visviva.generalized._rows import rows_of_copies

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["warn_if_unresolved", "warn_of_coarse_times"]

_ROUNDINGS = 8.0
"""So many times what a last digit makes of an energy is rounding."""

_WORTH_A_WORD = 1e-9
"""What times make of the rates, that is told; tolerances are smaller where nobody asked for them."""

_ON_THE_WAY = 17
"""Times at which a motion is looked at whose energies at its ends may be no measure."""


@dataclass(frozen=True)
class _Done:
    """A run of copies from states (B, 2n) to others at a time, with what was asked, parameters and threads."""

    system: GeneralizedSystem
    asked: dict[str, Any]
    starts: NDArray[np.float64]
    lasts: tuple[NDArray[np.float64], float]
    values: NDArray[np.float64]
    threads: int | None

    def again(
        self, changed: dict[str, Any], states: NDArray[np.float64], copies: slice = slice(None)
    ) -> NDArray[np.float64]:
        """The states (copies, times, 2n) of copies that are run once more, otherwise; NaN from where one fails."""
        asked = self.asked | {"events": [], "looked_for": ()} | changed
        result = self.system._run(asked, states[copies], self.values[copies], self.threads, progress=False)
        if result["interrupted"]:
            raise Interrupted("the look at a run that was done was interrupted")
        return rows_of_copies(result, len(asked["outputs"]))


def warn_if_unresolved(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    starts: NDArray[np.float64],
    lasts: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
    threads: int | None,
) -> None:
    """Warn of runs from states (B, 2n) to others at a time whose energies differ by much of what they are sums of.

    Where energies are not conserved, of equal steps that two of half their length contradict.

    Raises
    ------
    Interrupted
        After Ctrl-C while a motion is run again; whoever has the run gives it along.
    """
    # What is exact need not be looked at.
    if asked["method"] in EXACT:
        return
    conserves, copies, (states, t) = system._structure["conserves_energy"], len(starts), lasts
    if copies == 1 and conserves and _is_plainly_kept(system, asked, np.concatenate([starts, states]), t, values):
        return
    done = _Done(system, asked, starts, lasts, values, threads)
    if not conserves:
        if asked["dt"] is not None:
            _look_at_steps(done)
        return
    times = np.repeat([system.t0, t], copies)
    energies, sizes = _energies(system, times, np.concatenate([starts, states]), np.concatenate([values, values]))
    with np.errstate(all="ignore"):
        changes = np.abs(energies[copies:] - energies[:copies])
        sizes = np.maximum(sizes[:copies], sizes[copies:])
        errors = changes / sizes
    errors[~np.isfinite(errors)] = 0.0
    limit = limit_of_energies(asked)
    for copy in np.argsort(-errors):
        if not errors[copy] > limit:
            return
        # A motion that begins at rest and comes back has no energies at its ends to be compared with.
        largest, change = _on_the_way(done, int(copy))
        size = max(sizes[copy], largest)
        # The end is told of where it is off, or nothing is; but what has blown up may come near to where it began.
        at_end = bool(changes[copy] > limit * size) or change <= limit * size
        error = float((changes[copy] if at_end else change) / size)
        if limit < error <= TOLERATED:
            error -= _rounding(done, int(copy)) / size
        if error > limit:
            warn_of_energy(asked, error, int(copy) if copies > 1 else None, at_end=at_end)
            return


def warn_of_coarse_times(
    system: GeneralizedSystem, asked: dict[str, Any], ends: tuple[NDArray[np.float64], ...], values: NDArray[np.float64]
) -> None:
    """Warn where the rates change from one time to the next number by more than is asked for.

    At the ends: states (B, 2n) of copies, with the values of their parameters (B, P).
    """
    if not times_may_be_coarse(*asked["span"]) or system._structure["autonomous"]:
        return

    states = np.concatenate(ends)
    parameters = np.tile(values, (len(states) // len(values), 1))

    def told(states: NDArray[np.float64], times: NDArray[np.float64]) -> NDArray[np.float64]:
        each = np.repeat(times, len(states))
        rows, of_rows = (np.tile(of_states, (len(times), 1)) for of_states in (states, parameters))
        rates: NDArray[np.float64] = system._model.rates(each, rows, of_rows)
        return rates.reshape(len(times), len(states), -1)

    nudged = np.nextafter(states, np.where(np.arange(states.shape[1]) % 2 == 0, np.inf, -np.inf))
    limit = max(asked["rtol"], _WORTH_A_WORD)
    warn_if_coarse(partial(told, states), asked["span"], limit, "a rate of the system changes", partial(told, nudged))


def _look_at_steps(done: _Done) -> None:
    """Warn of the copy whose first step, or one that would follow on the last, is off by most of its velocities."""
    asked, (start, end) = done.asked, done.asked["span"]
    copies, numbers = done.starts.shape
    taken = np.full(copies, np.ceil(abs(end - start) / asked["dt"]), dtype=np.int64)
    if not steps_may_be_taken_again(taken, numbers).any():
        return
    # Of a method of first order two steps, too: they move what rests from where it is, which forces notice in the next.
    steps = (1, 2) if asked["method"] in _of_first_order() else (1,)
    errors = [
        np.max([_off_after_steps(done, before, number) for number in steps], axis=0)
        for before in ((done.starts, done.system.t0), done.lasts)
    ]
    at_end = bool(np.max(errors[1]) > np.max(errors[0]))
    copy = int(np.argmax(errors[at_end]))
    error = float(errors[at_end][copy])
    if error > OF_A_STEP:
        warn_of_step(asked["dt"], error, at_end, copy if copies > 1 else None)


@cache
def _of_first_order() -> frozenset[str]:
    return frozenset(method["name"] for method in _core.methods() if method["order"] == 1)


def _off_after_steps(done: _Done, before: tuple[NDArray[np.float64], float], steps: int) -> NDArray[np.float64]:
    """How far velocities (B,) are off after steps, by those of half their length, in the metric of the kinetic energy.

    As parts of the largest on the way, or at the end: what is lost where hardly anything moves yet is nothing.
    """
    system, asked, (states, t) = done.system, done.asked, before
    n, dt = len(system.coordinates), asked["dt"]
    at = t + steps * float(np.copysign(dt, asked["span"][1] - asked["span"][0]))
    after = []
    for length in (dt, 0.5 * dt):
        y = done.again({"span": (t, at), "outputs": np.array([at]), "dt": length}, states)
        after.append(y[:, -1])
    with np.errstate(all="ignore"):
        told = [(after[0], at), (after[1], at), before, done.lasts]
        p = np.stack([y[:, n:] for y, _ in told])
        v = np.stack([_columns(system, y, time, done.values)[:, :n] for y, time in told])
        # Products of those of a motion that has blown up may be beyond all numbers.
        p_largest, v_largest = (np.abs(x).max(axis=(0, 2)) for x in (p, v))
        p, v = p / p_largest[:, None], v / v_largest[:, None]
        off = np.abs(((p[0] - p[1]) * (v[0] - v[1])).sum(axis=1))
        errors: NDArray[np.float64] = np.sqrt(off / np.abs((p * v).sum(axis=2)).max(axis=0))
        _, energies = _energies(system, np.full(len(states), t), states, done.values)
        rounding = np.isfinite(energies) & (off * p_largest * v_largest <= ROUNDING**2 * energies)
        errors[~np.isfinite(errors) | rounding] = 0.0
    return errors


def _is_plainly_kept(
    system: GeneralizedSystem, asked: dict[str, Any], states: NDArray[np.float64], t: float, values: NDArray[np.float64]
) -> bool:
    """Whether one run's energy is plainly what it was: arithmetic of numbers, a tenth of that of arrays of two."""
    columns = system._model.columns(np.array([system.t0, t]), states, values).tolist()
    n, (first, second) = len(system.coordinates), states.tolist()
    energies, sizes = [], []
    for column, row in zip(columns, (first, second), strict=True):
        kinetic = 0.5 * abs(sum(map(mul, column[:n], row[n:])))
        energies.append(column[n])
        sizes.append(kinetic + abs(column[n] - kinetic))
    # Half of what is warned of, lest it hang on the order of a sum; what is no number is not below it.
    return bool(abs(energies[1] - energies[0]) <= 0.5 * limit_of_energies(asked) * max(sizes))


def _rounding(done: _Done, copy: int) -> float:
    """What rounding of the state at the end, and of the sum that its energy is, makes of that."""
    from visviva.generalized._calculus import Calculus
    from visviva.generalized._rounding import rounding_of

    c, ((states, t), start) = Calculus(done.system), (done.lasts, done.starts[copy])
    last = states[copy]
    beside = np.stack([last, np.nextafter(last, np.inf), np.nextafter(last, -np.inf)])
    energies, _ = _energies(done.system, np.full(3, t), beside, np.tile(done.values[copy], (3, 1)))
    of_state = float(np.abs(energies[1:] - energies[0]).max())
    of_sum = rounding_of(c, c.of_system("energy"), np.array([done.system.t0, t]), np.stack([start, last])).sum()
    return _ROUNDINGS * of_state + float(of_sum)


def _on_the_way(done: _Done, copy: int) -> tuple[float, float]:
    """The largest size of energies of a copy on the way to its end, which is run again, and their largest change."""
    system, (_, t) = done.system, done.lasts
    outputs = np.linspace(system.t0, t, _ON_THE_WAY)
    way = {"outputs": outputs, "span": (system.t0, t)}
    states = done.again(way, done.starts, slice(copy, copy + 1))[0]
    energies, sizes = _energies(system, outputs, states, np.tile(done.values[copy], (len(states), 1)))
    known = np.isfinite(sizes)
    changes = np.abs(energies - energies[:1])
    largest, change = (float(np.max(each, initial=0.0, where=known)) for each in (sizes, changes))
    return largest, change


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
