"""Newton's method from many states of a Hamiltonian at once, to where neither coordinates nor momenta change.

The one idea: derivatives of the rates are those of the variational equations, in units in which they are alike; what it
comes to is kept where a step no longer leads elsewhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva.generalized._matrices import balanced_units
from visviva.generalized._searches import SAME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["Scales", "rates_and_slopes", "reached", "scales_of", "steps_to_zeros"]

#: Newton's steps: enough for the linear way to a zero of the twelfth order, by a twelfth each time, to `SAME`.
_STEPS = 240
#: Singular values below this part of the largest are none.
_SINGULAR = 1e-13
#: One over a number of condition below which a matrix is far from singular.
_REGULAR = 1e-8
#: A step is as long as the largest coordinate of a turn at most, or of its own start.
_LONGEST = np.pi
#: Where a step is what is left of the one before, to this part of what that one moved, rates are linear.
_LINEAR = 0.1
#: A step is halved so often at most, until rates are less by at least this part of what they would be by the whole.
_HALVINGS = 40
_GAIN = 1e-4
#: Slopes that are as many times as large as those of most states.
_AT_A_POLE = 1e6
#: Rates that are this part of what they are made of are round-off.
_BALANCED = 1e-10


class Scales(NamedTuple):
    """Of states that are looked at: units (2n) in which rates are alike, sizes (2n) in them, and least rates (2n).

    Momenta are as large as coordinates make them, and rates below the least are round-off.
    """

    units: NDArray[np.float64]
    sizes: NDArray[np.float64]
    least: NDArray[np.float64]


def scales_of(system: Hamiltonian, states: NDArray[np.float64]) -> Scales:
    """Give those of states (S, 2n), by what rates depend on there."""
    slopes = np.abs(rates_and_slopes(system, states)[1])
    slopes = np.where(np.isfinite(slopes), slopes, 0.0)
    largest = slopes.max(axis=(1, 2))
    # A start next to a pole is no measure of all others.
    slopes = slopes[largest / _AT_A_POLE <= np.median(largest)].max(axis=0)
    units = balanced_units(slopes[None])[0]
    with np.errstate(over="ignore"):
        size = float((np.abs(states) / units)[:, : len(units) // 2].max(initial=0.0))
        sizes = units * (size if size > 0.0 else 1.0)
        return Scales(units, sizes, np.finfo(float).eps * (slopes @ sizes))


def reached(
    system: Hamiltonian, states: NDArray[np.float64], scales: Scales, *, descending: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Where Newton's method ends from each state (S, 2n), if it comes to an equilibrium, and from which.

    ``descending``, steps are halved until the rates are less.
    """
    n = states.shape[1] // 2
    # Of coordinates and of what momenta make of them.
    alike = np.concatenate([np.ones(n), scales.units[n:] / scales.units[:n]])
    longest = np.fmax(_LONGEST, np.abs(states[:, :n]).max(axis=1, initial=0.0, keepdims=True))
    step, left, moved = np.full(states.shape, np.inf), np.full(states.shape, np.inf), np.zeros(states.shape)
    begun = np.arange(len(states))
    at_kinks, from_there = [states[:0]], [begun[:0]]
    # Those that stand still are not moved on with the rest.
    still: list[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]] = []
    for _ in range(_STEPS):
        rates, slopes = rates_and_slopes(system, states)
        # Nothing changes there, whether or not rates have derivatives, as 3 q |q| has.
        kinks = (rates == 0.0).all(axis=1) & ~np.isfinite(slopes).all(axis=(1, 2))
        at_kinks.append(states[kinks])
        from_there.append(begun[kinks])
        finite = np.isfinite(rates).all(axis=1) & np.isfinite(slopes).all(axis=(1, 2))
        states, longest, left, moved = (each[finite] for each in (states, longest, left, moved))
        begun = begun[finite]
        rates, slopes = rates[finite], slopes[finite]
        if not len(states):
            break
        slopes = slopes * scales.units
        # Rates that change little, as beside a zero of higher order, count as others do.
        most = np.abs(slopes).max(axis=2, keepdims=True)
        most[most == 0.0] = 1.0
        with np.errstate(over="ignore"):
            # A step without end is not a number further on.
            wanted = rates / most[..., 0]
        step = -_solved(slopes / most, wanted) * scales.units
        length = np.abs(step / alike).max(axis=1, keepdims=True)
        # Linear rates lead however far.
        linear = (np.abs(step - left) <= _LINEAR * np.abs(moved) + SAME * scales.sizes).all(axis=1, keepdims=True)
        longest = np.where(linear & (length > longest), 2.0 * longest, longest)
        share = longest / np.maximum(length, longest)
        if descending:
            share = _descent(system, (states, rates, step), share)
        moved = step * share
        states, left = states + moved, step - moved
        stands = (np.abs(step) <= 1e-15 * (scales.sizes + np.abs(states))).all(axis=1)
        still.append((states[stands], step[stands], begun[stands]))
        states, step, longest, left, moved = (each[~stands] for each in (states, step, longest, left, moved))
        begun = begun[~stands]
    ends = [*still, (states, step[: len(states)], begun)]
    states, step, begun = (np.concatenate(each) for each in zip(*ends, strict=True))
    order = np.argsort(begun)
    states, step, begun = states[order], step[order], begun[order]
    rates, slopes = rates_and_slopes(system, states)
    made_of = np.einsum("sij,sj->si", np.abs(slopes), np.abs(states) + np.abs(step))
    settled = (np.abs(step) <= SAME * (scales.sizes + np.abs(states))).all(axis=1)
    kept: NDArray[np.bool_] = settled & (np.abs(rates) <= _BALANCED * made_of + scales.least).all(axis=1)
    return np.concatenate([states[kept], *at_kinks]), np.concatenate([begun[kept], *from_there])


def _solved(slopes: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    """Least solutions (S, m) of linear equations: by singular values only of those matrices that may be singular."""
    solved: NDArray[np.float64] = np.empty(wanted.shape)
    with np.errstate(all="ignore"):
        inverse = _inverses(slopes)
        # The product of the largest singular values of a matrix and of its inverse is at most this.
        condition = np.sqrt((slopes**2).sum(axis=(1, 2))) * np.sqrt((inverse**2).sum(axis=(1, 2)))
    regular = condition * _REGULAR < 1.0
    solved[regular] = np.einsum("sij,sj->si", inverse[regular], wanted[regular])
    by_values = np.linalg.pinv(slopes[~regular], rcond=_SINGULAR)
    solved[~regular] = np.einsum("sij,sj->si", by_values, wanted[~regular])
    return solved


def steps_to_zeros(forces: NDArray[np.float64], stiffness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Newton's steps (S, n) to where forces (S, n) vanish, by minus their derivatives (S, n, n).

    Not numbers where these are none, or nothing changes a force.
    """
    rows = np.abs(stiffness).max(axis=2)
    judged = np.isfinite(forces).all(axis=1) & np.isfinite(stiffness).all(axis=(1, 2)) & (rows > 0.0).all(axis=1)
    steps = np.full(forces.shape, np.nan)
    scaled = stiffness[judged] / rows[judged][..., None]
    # Of the ground of a curved valley far off one coordinate is much larger than another, and it is not level for that.
    columns = np.abs(scaled).max(axis=1)
    columns[columns == 0.0] = 1.0
    steps[judged] = _solved(scaled / columns[:, None], forces[judged] / rows[judged]) / columns
    return steps


def _inverses(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inverses of matrices (S, m, m); not numbers where one has none."""
    inverse: NDArray[np.float64] = np.full(slopes.shape, np.nan)
    try:
        inverse[:] = np.linalg.inv(slopes)
    except np.linalg.LinAlgError:
        regular = np.linalg.det(slopes) != 0.0
        inverse[regular] = np.linalg.inv(slopes[regular])
    return inverse


def _descent(
    system: Hamiltonian,
    at: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    share: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Parts of steps (S, 1), halved until each rate is less than at the state; not a number if none is."""
    states, rates, step = at
    # Those of places and of momenta have units of their own.
    sizes = np.abs(rates)
    sizes = np.where(sizes > 0.0, sizes, sizes.max(axis=1, keepdims=True))
    sizes[sizes == 0.0] = 1.0
    share, longer = share.copy(), np.arange(len(states))
    for _ in range(_HALVINGS):
        rates = rates_and_slopes(system, states[longer] + step[longer] * share[longer])[0]
        ahead = np.abs(rates / sizes[longer]).max(axis=1)
        longer = longer[~(ahead <= 1.0 - _GAIN * share[longer, 0])]
        share[longer] *= 0.5
        if not len(longer):
            break
    # No part of a step leads down: the state is given up.
    share[longer] = np.nan
    return share


def rates_and_slopes(
    system: GeneralizedSystem, states: NDArray[np.float64], parameters: NDArray[np.float64] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rates (S, 2n) at states, and their derivatives (S, 2n, 2n)."""
    count, n = states.shape
    model = system._model.variational()
    unit = np.broadcast_to(np.eye(n).ravel(), (count, n * n))
    numbers = system._values if parameters is None else parameters
    t, values = np.full(count, system.t0), np.broadcast_to(numbers, (count, len(numbers)))
    with np.errstate(all="ignore"):
        found = model.rates(t, np.concatenate([states, unit], axis=1), np.ascontiguousarray(values))
    return found[:, :n], found[:, n:].reshape(count, n, n)
