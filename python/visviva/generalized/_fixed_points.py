"""Equilibria of Hamiltonian systems: states at which neither coordinates nor momenta change.

The one idea: Newton's method runs from many states at once, with the derivatives of the rates that the variational
equations have; what it comes to is kept where a step no longer leads elsewhere, and eigenvalues of those derivatives
tell of small motions. Where these leave H level to second order, a minimum or a maximum of any order is stable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._equilibria import SAME, Equilibrium, by_sizes, starts_of_a_search
from visviva.generalized._higher_orders import Energy, curvatures, rises
from visviva.generalized._kinks import with_limits
from visviva.generalized._matrices import LAST_DIGITS, balanced_units, nudges
from visviva.generalized._multiple_zeros import left_open, round_off, told_apart
from visviva.generalized._probe import terms_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._higher_orders import Curvatures
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["fixed_points", "rates_and_slopes", "rounding_of_slopes", "slopes_at"]

#: Newton's steps: enough for the linear way to a zero of the twelfth order, by a twelfth each time, to `SAME`.
_STEPS = 240
#: Singular values below this part of the largest are none.
_SINGULAR = 1e-13
#: A step is as long as the largest coordinate of a turn at most, or of its own start.
_LONGEST = np.pi
#: Where a step is what is left of the one before, to this part of what that one moved, rates are linear.
_LINEAR = 0.1
#: A step is halved so often at most, until rates are less by at least this part of what they would be by the whole.
_HALVINGS = 40
_GAIN = 1e-4
#: Directions between those in which H is level, and how far along them it is looked at, in sizes of a state.
_DIRECTIONS = 8
_FAR_ALONG = (0.03, -0.03, 0.3, -0.3)
#: Rates that are this part of what they are made of are round-off.
_BALANCED = 1e-10
#: Eigenvalues whose real parts are below this part of the largest are imaginary; such equal ones need as many vectors.
_ON_THE_AXIS = 1e-7
#: States are found to this part of their sizes.
_FOUND = SAME


def fixed_points(system: Hamiltonian, near: ArrayLike | None) -> list[Equilibrium]:
    """Equilibria of a Hamiltonian, from starts (S, 2n) or from a search over a turn and momenta as large."""
    n = len(system.coordinates)
    if not system.autonomous:
        raise InvalidInput(
            "H",
            "expected equations that do not depend on the time, which have equilibria; see flow_jacobian over a period",
        )
    if near is not None:
        states = np.atleast_2d(float_array("near", near, None))
        if states.shape[1] != 2 * n:
            raise InvalidInput(
                "near", f"expected states of {n} coordinates and momenta, got an array of shape {states.shape}"
            )
        sizes = np.abs(states[:, :n]).max(axis=1, initial=0.0)
        return by_sizes(system, states, sizes, lambda group: _found(system, group))
    states = starts_of_a_search(2 * n)
    # Momenta are zero in most equilibria.
    return _found(system, np.concatenate([states, np.where(np.arange(2 * n) < n, states, 0.0)]), everywhere=True)


def _found(system: Hamiltonian, states: NDArray[np.float64], *, everywhere: bool = False) -> list[Equilibrium]:
    """Equilibria from starts (S, 2n) of about one size, or of those within a turn."""
    n = len(system.coordinates)
    looked_at = np.abs(states).max(axis=0)
    scales = _scales(system, states)
    starts = states
    states, begun = _reached(system, starts, scales)
    without = np.setdiff1d(np.arange(len(starts)), begun)
    if not everywhere and len(without):
        states = np.concatenate([states, _reached(system, starts[without], scales, descending=True)[0]])
    distinguishing = np.ones(2 * n, dtype=bool)
    distinguishing[system._structure["cyclic"]] = False
    if everywhere:
        # Where a start is left as it is nothing acts, as where a potential underflows: it has been found by no step.
        still = (states == starts[begun])[:, :n] | ~distinguishing[:n]
        states = states[~still.all(axis=1) | ~distinguishing[:n].any()]
        # All places along a cyclic coordinate are alike, and those beyond a turn are the same or far away.
        states[:, ~distinguishing] = 0.0
        states = states[np.abs(states[:, :n]).max(axis=1, initial=0.0) <= np.pi + 1e-6]
    size = np.maximum(looked_at, np.abs(states).max(axis=0, initial=0.0))
    size[size == 0.0] = 1.0
    states = np.where(np.abs(states) < 1e-14 * size, 0.0, states)
    places: list[NDArray[np.float64]] = []
    while len(states):
        places.append(states[0])
        states = states[((np.abs(states - states[0]) > SAME * size) & distinguishing).any(axis=1)]
    energy = _energy(system)
    places = told_apart(energy, places, size, lambda _: scales.units)
    return [_equilibrium(system, energy, place, scales) for place in sorted(places, key=tuple)]


class _Scales(NamedTuple):
    """Of states that are looked at: units (2n) in which rates are alike, sizes (2n) in them, and least rates (2n).

    Momenta are as large as coordinates make them, and rates below the least are round-off.
    """

    units: NDArray[np.float64]
    sizes: NDArray[np.float64]
    least: NDArray[np.float64]


def _scales(system: Hamiltonian, states: NDArray[np.float64]) -> _Scales:
    slopes = np.abs(rates_and_slopes(system, states)[1])
    slopes = np.where(np.isfinite(slopes), slopes, 0.0).max(axis=0)
    units = balanced_units(slopes[None])[0]
    size = float((np.abs(states) / units)[:, : len(units) // 2].max(initial=0.0))
    sizes = units * (size if size > 0.0 else 1.0)
    return _Scales(units, sizes, np.finfo(float).eps * (slopes @ sizes))


def _reached(
    system: Hamiltonian, states: NDArray[np.float64], scales: _Scales, *, descending: bool = False
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
            return np.concatenate(at_kinks), np.concatenate(from_there)
        slopes = slopes * scales.units
        # Rates that change little, as beside a zero of higher order, count as others do.
        most = np.abs(slopes).max(axis=2, keepdims=True)
        most[most == 0.0] = 1.0
        with np.errstate(over="ignore"):
            # A step without end is not a number further on.
            wanted = rates / most[..., 0]
        step = -np.einsum("sij,sj->si", np.linalg.pinv(slopes / most, rcond=_SINGULAR), wanted) * scales.units
        length = np.abs(step / alike).max(axis=1, keepdims=True)
        # Linear rates lead however far.
        linear = (np.abs(step - left) <= _LINEAR * np.abs(moved) + SAME * scales.sizes).all(axis=1, keepdims=True)
        longest = np.where(linear & (length > longest), 2.0 * longest, longest)
        share = longest / np.maximum(length, longest)
        if descending:
            share = _descent(system, (states, rates, step), share)
        moved = step * share
        states, left = states + moved, step - moved
        if (np.abs(step) <= 1e-15 * (scales.sizes + np.abs(states))).all():
            break
    rates, slopes = rates_and_slopes(system, states)
    made_of = np.einsum("sij,sj->si", np.abs(slopes), np.abs(states) + np.abs(step))
    settled = (np.abs(step) <= SAME * (scales.sizes + np.abs(states))).all(axis=1)
    kept: NDArray[np.bool_] = settled & (np.abs(rates) <= _BALANCED * made_of + scales.least).all(axis=1)
    return np.concatenate([states[kept], *at_kinks]), np.concatenate([begun[kept], *from_there])


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


def _equilibrium(system: Hamiltonian, energy: Energy, state: NDArray[np.float64], scales: _Scales) -> Equilibrium:
    n = len(system.coordinates)
    slopes, (units, size, _) = slopes_at(system, state), scales
    others = np.abs(slopes) * (1.0 - np.eye(len(state)))
    if np.isfinite(slopes).all() and others.any(axis=0).all() and others.any(axis=1).all():
        # Slopes where the search began may be of quite another size.
        units = balanced_units(slopes[None])[0]
    if not np.isfinite(slopes).all():
        raise InvalidInput(
            "H",
            f"expected rates that have derivatives at the equilibrium {state.round(6).tolist()}, and they have none: "
            "there is a kink, as that of |q|; round it off, as by sqrt(q² + width²), or look elsewhere by near",
        )
    # Of rates with forces that no function has, nothing but the linear equations tells.
    second, off = _second(slopes[None])[0], np.abs(_second(rounding_of_slopes(system, state, size, slopes)[None])[0])
    left = left_open(energy, state, size, units)
    if left is not None:
        beside = energy.slopes(np.stack([state + left, state - left]))[1]
        off = np.fmax(off, np.abs(beside - second).max(axis=0))
    about = curvatures(np.where(np.abs(second) > off, second, 0.0), off)
    level = about is not None and bool((about.values == 0.0).any())
    if about is not None and level:
        scaled = about.vectors * about.sizes[:, None]
        slopes = _rates_of((scaled * about.values) @ scaled.T * about.sizes * about.sizes[:, None])
    values, vectors = np.linalg.eig(slopes * units / units[:, None])
    largest = np.abs(values).max(initial=0.0)
    # A pair of zeros that are level is told by half of the digits.
    least = _ON_THE_AXIS * largest if level else 0.0
    frequencies = np.sort(np.abs(values.imag[values.imag > least]))
    stable = bool((values.real <= _ON_THE_AXIS * largest).all())
    if stable and not (values.real < -_ON_THE_AXIS * largest).all():
        by_energy = _by_energy(energy, state, about, off, size) if about is not None and level else None
        # A coordinate that runs away by itself has an eigenvalue 0 without a vector of its own.
        own = bool(largest > 0.0) and bool(np.linalg.svd(vectors, compute_uv=False)[-1] > _ON_THE_AXIS)
        stable = own if by_energy is None else by_energy
    return Equilibrium(state[:n], stable, frequencies, state[n:])


def slopes_at(
    system: Hamiltonian, state: NDArray[np.float64], parameters: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """Derivatives of the rates (2n, 2n) at a state, and what they come to where their formulas have none."""
    width = len(state)

    def evaluate(states: NDArray[np.float64]) -> NDArray[np.float64]:
        rates, slopes = rates_and_slopes(system, states, parameters)
        return np.concatenate([rates, slopes.reshape(len(states), -1)], axis=1)

    return with_limits(evaluate, state, width)[width:].reshape(width, width)


def _second(slopes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give ∂²H (S, 2n, 2n) of the derivatives of rates J ∂H."""
    n = slopes.shape[-1] // 2
    return np.concatenate([-slopes[:, n:], slopes[:, :n]], axis=1)


def _rates_of(second: NDArray[np.float64]) -> NDArray[np.float64]:
    n = len(second) // 2
    return np.concatenate([second[n:], -second[:n]])


def rounding_of_slopes(
    system: Hamiltonian, state: NDArray[np.float64], size: NDArray[np.float64], slopes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give what the last digits of the state, as they are found, and of parameters make of the derivatives of rates."""
    off = LAST_DIGITS * np.abs(slopes)
    n = len(state)
    for signs in nudges(n + len(system._values)):
        other = slopes_at(system, state + _FOUND * size * signs[:n], system._values * (1.0 + LAST_DIGITS * signs[n:]))
        off = np.fmax(off, np.abs(other - slopes))
    return off


def _energy(system: Hamiltonian) -> Energy:
    n = len(system.coordinates)
    c = Calculus(system)
    (row,) = c.with_derivatives(c.of_system("function"))
    sums = [terms_of(c, [each]) for each in row[1 : 1 + 2 * n]]

    def slopes(states: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rates, derivatives = rates_and_slopes(system, states)
        return np.concatenate([-rates[:, n:], rates[:, :n]], axis=1), _second(derivatives)

    def sizes(states: NDArray[np.float64]) -> NDArray[np.float64]:
        times = np.full(len(states), system.t0)
        found = [
            np.abs(c.values(each, times, states, system._values)).sum(axis=1) if each else np.zeros(len(states))
            for each in sums
        ]
        return np.stack(found, axis=1)

    return Energy(slopes, sizes)


def _by_energy(
    energy: Energy,
    state: NDArray[np.float64],
    about: Curvatures,
    off: NDArray[np.float64],
    size: NDArray[np.float64],
) -> bool | None:
    """Whether H has a minimum or a maximum where it is level to second order; nothing if that is not known.

    Where it stays level are equilibria, too: that a motion drifts along them does not count, as along a coordinate that
    nothing depends on.
    """
    known = set(np.sign(about.values[about.values != 0.0]))
    if len(known) > 1:
        return None
    beside = set(rises(energy, state, about, off))
    if {-1.0, 1.0} <= known | beside:
        return False
    return True if 0.0 not in beside or _stays_level(energy, state, about, size) else None


def _stays_level(energy: Energy, state: NDArray[np.float64], about: Curvatures, size: NDArray[np.float64]) -> bool:
    """Whether all is in balance far along every direction in which H is level to second order."""
    level = (about.vectors * about.sizes[:, None])[:, about.values == 0.0]
    mixed = np.random.default_rng(0).normal(size=(level.shape[1], _DIRECTIONS))
    ways = level @ np.concatenate([np.eye(level.shape[1]), mixed], axis=1)
    ways = ways * (1.0 / np.abs(ways / size[:, None]).max(axis=0))
    places = np.concatenate([state + part * ways.T for part in _FAR_ALONG])
    return bool(round_off(energy, places, size).all())
