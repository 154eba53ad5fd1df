"""Whether sums vanish, seen at states of all sizes that a system may have.

The one idea: a sum that vanishes does so at every state, but one that does not is seen only where its terms are not
drowned by others, nor too small to be numbers. So states are of many sizes, the system's own first; a state tells
something only beyond what its own rounding does to the terms; and where a term is seen at none, nothing is said.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.generalized._rounding import rounding_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._calculus import Calculus
    from visviva.generalized._nodes import Expression
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["VANISHES", "Finding", "Probe", "terms_of"]

#: A sum that is less than this of what it is made of, at all states that are looked at, vanishes.
VANISHES = 1e-12
#: States at which a test must have values, and those at which every term must be seen.
_FEWEST = 8
_SEEN = 4
#: A term is seen if it is more than this of all of them together, and known to that part of itself.
_VISIBLE = 1e-9
_KNOWN = 1e-3
#: Sums below this have lost their digits.
_SMALLEST = 1e-280
#: States of each size.
_STATES = 12
#: How far states are moved to see what rounding does, and how much of what that changes is rounding.
_JOLT = 4.0 * float(np.finfo(float).eps)
_NOISE = 64.0
#: Sums that are multiplied out to no more terms than this.
_MOST_TERMS = 256


@dataclass(frozen=True, slots=True)
class Finding:
    """What became of a sum.

    Attributes
    ----------
    known : bool
        Whether it has values at states near the start.
    residual : float
        The largest of it, relative to what it is made of: near the start or, if it vanishes there, anywhere.
    seen : bool
        Whether each of its terms is seen somewhere.
    largest : float
        The largest of it near the start, with its sign.
    """

    known: bool
    residual: float
    seen: bool
    largest: float

    @property
    def vanishes(self) -> bool:
        """Whether it does at all states."""
        return self.residual <= VANISHES


class Probe:
    """States of a system at which sums are looked at, always the same."""

    def __init__(self, calculus: Calculus) -> None:
        self._calculus = calculus
        system = calculus._system
        self._t, self._states, self._near = _states(system)
        rng = np.random.default_rng(20261124)
        self._moved_t = self._t * (1.0 + _JOLT * rng.choice([-1.0, 1.0], self._t.shape))
        self._moved = self._states * (1.0 + _JOLT * rng.choice([-1.0, 1.0], self._states.shape))

    def check_sum(self, parts: list[Expression]) -> Finding:
        """Look at a sum."""
        c = self._calculus
        terms = terms_of(c, parts)
        if not terms:
            return Finding(known=True, residual=0.0, seen=True, largest=0.0)
        with np.errstate(all="ignore"):
            values = c.values(terms, self._t, self._states, c._system._values)
            moved = c.values(terms, self._moved_t, self._moved, c._system._values)
            lost = rounding_of(c, terms, self._t, self._states)
            sizes = np.abs(values).sum(axis=1)
            noise = np.abs(moved - values)
            usable = np.isfinite(sizes) & np.isfinite(noise).all(axis=1)
            known = int((usable & self._near).sum()) >= _FEWEST
            usable &= sizes > _SMALLEST
            values, sizes, noise, near = values[usable], sizes[usable], noise[usable], self._near[usable]
            lost = lost[usable]
            sums = values.sum(axis=1)
            rounding = _NOISE * noise.sum(axis=1)
            counted = np.where(np.abs(sums) > VANISHES * sizes + rounding, np.abs(sums), 0.0) / sizes
            # What is only rounding is told as such, relative to what it may be.
            clear = rounding <= VANISHES * sizes
            counted = np.maximum(counted, np.where(clear, np.abs(sums) / sizes, 0.0))
            # What may be nothing but lost digits, as beside what has left the range of numbers, tells nothing.
            may_be_lost = np.abs(sums) <= lost.sum(axis=1) + VANISHES * sizes
            counted = np.where(may_be_lost & (counted > VANISHES), 0.0, counted)
            noise = np.maximum(noise, lost)
            seen = (np.abs(values) > _VISIBLE * sizes[:, None]) & (noise <= _KNOWN * np.abs(values))
        beside = float(counted[near].max(initial=0.0))
        residual = beside if beside > VANISHES else float(counted.max(initial=0.0))
        largest = sums[near][np.argmax(np.abs(sums[near]))] if near.any() else 0.0
        return Finding(known, residual, bool((seen.sum(axis=0) >= _SEEN).all()), float(largest))


def _states(system: GeneralizedSystem) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Give times (N), states (N, 2n), and which are near the start."""
    n, rng = len(system.coordinates), np.random.default_rng(20260728)
    start = np.zeros(2 * n) if system.position is None else system._start()
    ones = np.ones(n)
    place, speed = _own(start[:n]), _own(start[n:])
    near = [(start, ones, ones, 1.0), (start, place, speed, 1.0), (start, 0.1 * place, 0.1 * speed, 0.1)]
    still = np.zeros(2 * n)
    far: list[tuple[Any, Any, Any, float]] = []
    # About zero in all sizes, and velocities in all sizes with each.
    decades = np.arange(-12.0, 13.0, 2.0)
    for turn in range(3):
        speeds = rng.permutation(decades)
        far += [
            (still, ones * 10.0**size, ones * 10.0**other, 10.0 ** rng.choice([-6.0, -3.0, 0.0, 0.0, 2.0]))
            for size, other in zip(decades, speeds if turn else decades, strict=True)
        ]
    # In sizes of the start and of parameters, which may be lengths.
    own = [place * 10.0**size for size in (-6.0, -4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0)]
    own += [ones * size for size in sorted({abs(float(value)) for value in system._values if value})[:16]]
    for scale in own:
        sizes = (speed, speed * 10.0 ** rng.uniform(-6.0, 2.0), ones * 10.0 ** rng.uniform(-9.0, 9.0))
        far += [(still, scale, each, 10.0 ** rng.choice([-3.0, 0.0, 0.0])) for each in sizes]
    # Each number of a size of its own.
    far += [
        (still, place * 10.0 ** rng.uniform(-3.0, 3.0, n), speed * 10.0 ** rng.uniform(-3.0, 3.0, n), 1.0)
        for _ in range(4)
    ]
    times: list[NDArray[np.float64]] = []
    states: list[NDArray[np.float64]] = []
    for center, scale, other, span in near + far:
        count = 4 * _STATES if len(times) < len(near) else _STATES
        states.append(center + np.concatenate([scale, other]) * rng.normal(size=(count, 2 * n)))
        times.append(system.t0 + span * rng.normal(size=count))
    beside = sum(len(each) for each in times[: len(near)])
    all_times = np.concatenate(times)
    return all_times, np.concatenate(states), np.arange(len(all_times)) < beside


def _own(start: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give sizes of numbers: their own, that of the largest for those that are 0, or 1."""
    largest = np.abs(start).max(initial=0.0)
    sizes: NDArray[np.float64] = np.where(start != 0.0, np.abs(start), largest if largest > 0.0 else 1.0)
    return sizes


def terms_of(c: Calculus, parts: list[Expression]) -> list[Expression]:
    """Give what a sum is made of, products of sums multiplied out."""
    nodes = c._nodes
    from visviva.generalized._nodes import Expression

    # What occurs in many places is multiplied out once.
    known: dict[int, list[int]] = {}

    def expand(place: int) -> list[int]:
        if place not in known:
            found = expanded(place)
            known[place] = found if len(found) <= _MOST_TERMS else [place]
        return known[place]

    def expanded(place: int) -> list[int]:
        operation, arguments, _ = nodes.all[place]
        if operation == "sum":
            return [each for argument in arguments for each in expand(argument)]
        if operation == "quotient":
            return [nodes.add("quotient", (each, arguments[1])) for each in expand(arguments[0])]
        # Powers stay: multiplied out, differences would drown in what they are differences of.
        if operation == "product" and len(set(arguments)) == len(arguments):
            found: list[tuple[int, ...]] = [()]
            for argument in arguments:
                found = [(*before, each) for before in found for each in expand(argument)]
                if len(found) > _MOST_TERMS:
                    return [place]
            return [nodes.add("product", each) for each in found]
        return [place]

    found = [each for part in parts for each in expand(part._place)]
    # Those that occur twice are one.
    unique = [Expression(nodes, place) for place in dict.fromkeys(found)]
    counts = [found.count(each._place) for each in unique]
    scaled = [each if count == 1 else each * float(count) for each, count in zip(unique, counts, strict=True)]
    return [each for each in c.simplified(scaled) if not c.is_zero(each)]
