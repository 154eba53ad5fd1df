"""Whether runs have resolved anything, as far as an energy that is conserved tells."""

from __future__ import annotations

from operator import mul
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._accuracy import limit_of_energies, warn_of_energy
from visviva.errors import Interrupted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["warn_if_unresolved"]

_ON_THE_WAY = 17
"""Times at which a motion is looked at whose energies at its ends may be no measure."""


def warn_if_unresolved(
    system: GeneralizedSystem,
    asked: dict[str, Any],
    starts: NDArray[np.float64],
    lasts: tuple[NDArray[np.float64], float],
    values: NDArray[np.float64],
) -> None:
    """Warn of runs from states (B, 2n) to others at a time whose energies differ by much of what they are sums of.

    Raises
    ------
    Interrupted
        After Ctrl-C while a motion is run again; whoever has the run gives it along.
    """
    # What is exact need not be looked at.
    if asked["method"] == "matrix_exponential" or not system._structure["conserves_energy"]:
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
        columns = system._model.columns(times, np.ascontiguousarray(states), values)
        # ½ p·v, of a quadratic kinetic energy.
        kinetic = 0.5 * np.abs((columns[:, :n] * states[:, n:]).sum(axis=1))
        return columns[:, n], kinetic + np.abs(columns[:, n] - kinetic)
