"""Equilibria that fill curves and surfaces: which of them are on the same one, and which few stand for it.

The one idea: what goes on from a place goes on to the next, so places are joined along a row of steps between them.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._ground import AWAY, LevelGround

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.generalized._equilibria import Equilibrium

__all__ = ["Ground", "GroundOnConstraints", "some_of_each"]

#: So many places stand for a whole curve.
_SOME = 12
#: Places between two that are looked at, and how much farther than these one may be from the next.
_BETWEEN = 8
_NO_JUMP = 2.5
#: What leads from one place to another along a curve is a row of steps, each so much of the distance, and so many at
#: most; there the other is ahead, and no more than this part of what is left aside.
_STEPS_BETWEEN = 12
_MOST_STEPS = 60
_BESIDE = 0.3
#: A curve has places this part of a size apart.
_EXTENDED = 1e-2
_MOST_DISTANCES = 1_000_000
#: More arcs than these are no few curves, and are left as they are.
_MOST_ARCS = 48


class Ground(LevelGround):
    """The places of balance of a system, and the curves and surfaces that they are on."""

    #: Whether stiffnesses tell which directions are level.
    _is_level_known = True

    def curves(self, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.intp]:
        """Of places (R, n) that lie on curves or surfaces which of these each is on (R,), numbered from 0."""
        count = len(places)
        scaled = places / size
        # The tree of shortest edges (R. C. Prim): what is joined at all is joined along it.
        nearest, before = np.abs(scaled - scaled[0]).max(axis=1), np.zeros(count, dtype=np.intp)
        left = np.ones(count, dtype=bool)
        left[0] = False
        edges = np.zeros((count - 1, 2), dtype=np.intp)
        for edge in edges:
            following = np.argmin(np.where(left, nearest, np.inf)).item()
            edge[:] = before[following], following
            left[following] = False
            apart = np.abs(scaled - scaled[following]).max(axis=1)
            nearer = apart < nearest
            nearest[nearer], before[nearer] = apart[nearer], following
        joined = self._are_joined(places[edges[:, 0]], places[edges[:, 1]], size)
        numbers = np.zeros(count, dtype=np.intp)
        for (one, other), same in zip(edges, joined.tolist(), strict=True):
            numbers[other] = numbers[one] if same else numbers.max() + 1
        return self._arcs_joined(places, size, numbers)

    def _arcs_joined(
        self, places: NDArray[np.float64], size: NDArray[np.float64], numbers: NDArray[np.intp]
    ) -> NDArray[np.intp]:
        """Numbers of curves, of which arcs are joined that are nearer to another curve than to each other."""
        arcs = range(int(numbers.max()) + 1)
        if not 1 < len(arcs) <= _MOST_ARCS:
            return numbers
        pairs, edges = list(combinations(arcs, 2)), []
        for pair in pairs:
            one, other = (np.flatnonzero(numbers == each) for each in pair)
            apart = np.abs((places[one][:, None] - places[other]) / size).max(axis=2)
            at = np.unravel_index(int(apart.argmin()), apart.shape)
            edges.append((one[at[0]], other[at[1]]))
        ends = np.array(edges)
        names = np.array(arcs)
        joined = self._are_joined(places[ends[:, 0]], places[ends[:, 1]], size)
        apart = np.flatnonzero(~joined)
        if self._is_level_known:
            joined[apart] = self._walked(places[ends[apart, 0]], places[ends[apart, 1]], size)
        for (to, was), same in zip(pairs, joined.tolist(), strict=True):
            if same:
                names[names == names[was]] = names[to]
        return np.unique(names[numbers], return_inverse=True)[1]

    def _are_joined(
        self, first: NDArray[np.float64], second: NDArray[np.float64], size: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Whether places (R, n) are joined to others: brought back, a row of places between goes on without a jump."""
        joined: NDArray[np.bool_] = np.ones(len(first), dtype=bool)
        before = first
        most = _NO_JUMP / _BETWEEN * np.abs((second - first) / size).max(axis=1)
        for part in range(1, _BETWEEN):
            ends, there = self._brought_back(first + part / _BETWEEN * (second - first))
            joined &= there & (np.abs((ends - before) / size).max(axis=1) <= most)
            before = ends
        joined &= np.abs((second - before) / size).max(axis=1) <= most
        return joined

    def _walked(
        self, first: NDArray[np.float64], second: NDArray[np.float64], size: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Whether a curve leads from places (R, n) to others, by short steps along it."""
        joined: NDArray[np.bool_] = np.zeros(len(first), dtype=bool)
        going: NDArray[np.intp] = np.arange(len(first))
        heading = (second - first) / size
        part = np.abs(heading).max(axis=1, keepdims=True) / _STEPS_BETWEEN
        for _ in range(_MOST_STEPS):
            if not len(going):
                break
            known, _, vectors = self._level(first, size)
            going, (first, second, heading, part) = (
                going[known],
                (each[known] for each in (first, second, heading, part)),
            )
            ahead = vectors[:, -1]
            ahead = np.copysign(1.0, (ahead * heading).sum(axis=1, keepdims=True)) * ahead
            ahead /= np.abs(ahead).max(axis=1, keepdims=True)
            step = part * ahead * size
            ends, there = self._brought_back(first + step)
            there &= (np.abs((ends - first - step) / size) <= AWAY * part).all(axis=1)
            left = (second - first) / size
            # What is beside the way is on another curve.
            aside = left - ahead * ((left * ahead).sum(axis=1) / (ahead * ahead).sum(axis=1))[:, None]
            far = np.abs(left).max(axis=1)
            come = (far <= part[:, 0]) & (np.abs(aside).max(axis=1) <= _BESIDE * far)
            joined[going[come]] = True
            on = there & ~come
            heading = (ends - first)[on] / size
            going, first, second, part = going[on], ends[on], second[on], part[on]
        return joined

    def some(self, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which of places (R, n) are told: of a curve or a surface that has many of them some, far from each other."""
        told = np.ones(len(places), dtype=bool)
        on = np.flatnonzero(self.goes_on(places, size) > 0) if len(places) > _SOME else np.zeros(0, dtype=np.intp)
        if len(on) <= _SOME:
            return told
        numbers = self.curves(places[on], size)
        for number in range(int(numbers.max()) + 1):
            those = on[numbers == number]
            told[those] = _far_apart(places[those] / size)
        return told


class GroundOnConstraints(Ground):
    """Places of balance on constraints: `reached` gives those that Newton's method comes to from some, in any order."""

    _is_level_known = False

    def __init__(self, reached: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> None:
        self._reached = reached

    def _brought_back(self, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        ends = self._reached(places)
        if not len(ends):
            return places, np.zeros(len(places), dtype=bool)
        # A batch at a time: the distances of all to all are many.
        batches = np.array_split(places, 1 + len(places) * len(ends) // _MOST_DISTANCES)
        nearest = [np.abs(batch[:, None] - ends).max(axis=2).argmin(axis=1) for batch in batches]
        return ends[np.concatenate(nearest)], np.ones(len(places), dtype=bool)

    def some_on(
        self, places: NDArray[np.float64], size: NDArray[np.float64]
    ) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Which of places (R, n) are told, as `some`, and which of all lie on curves or surfaces."""
        told, on = np.ones(len(places), dtype=bool), np.zeros(len(places), dtype=bool)
        if len(places) <= _SOME:
            return told, on
        numbers = self.curves(places, size)
        for number in range(int(numbers.max()) + 1):
            those = np.flatnonzero(numbers == number)
            # Many places next to each other are one that is not known well.
            if len(those) > _SOME and (np.ptp(places[those] / size, axis=0) > _EXTENDED).any():
                on[those] = True
                told[those] = _far_apart(places[those] / size)
        return told, on


def some_of_each(ground: Ground, found: list[Equilibrium]) -> list[Equilibrium]:
    """Of equilibria, stable ones and others, those that `Ground.some` tells."""
    kept = []
    for stable in (False, None, True):
        alike = [each for each in found if each.stable is stable]
        if not alike:
            continue
        places = np.array([each.position for each in alike])
        size = np.abs(places).max(axis=0)
        size[size == 0.0] = size.max() if size.any() else 1.0
        told = np.flatnonzero(ground.some(places, size)).tolist()
        # A search among larger places has seen no curve in a small one.
        on = ground.goes_on(places[told], size).tolist()
        holds = ground.holds(places[told], size).tolist()
        for at, own, each in zip(told, on, holds, strict=True):
            continuum = max(alike[at].continuum, own)
            if each or not continuum:
                kept.append(replace(alike[at], continuum=continuum))
    return kept


def _far_apart(places: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which of places (R, n) are some of them, each as far as may be from those before."""
    told = np.zeros(len(places), dtype=bool)
    apart = np.full(len(places), np.inf)
    following = 0
    for _ in range(min(_SOME, len(places))):
        told[following] = True
        apart = np.fmin(apart, np.abs(places - places[following]).max(axis=1))
        following = int(np.argmax(apart))
    return told


def __dir__() -> list[str]:
    return list(__all__)
