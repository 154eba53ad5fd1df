"""Equilibria that fill curves and surfaces: how they go on from each place, and which few stand for one of those.

The one idea: from a place on a curve a step along the direction that forces leave level, brought back by Newton's
method, ends in balance, about as far off as the step was. So places are joined, too, along a row of steps between them.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._newton import steps_to_zeros

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.generalized._equilibria import Equilibrium

    _Forces = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
    _Balanced = Callable[[NDArray[np.float64]], NDArray[np.bool_]]

__all__ = ["Ground", "GroundOnConstraints", "some_of_each"]

#: So many places stand for a whole curve.
_SOME = 12
#: A direction is level where its stiffness is this part of the largest.
_LEVEL = 1e-6
#: Two steps along it, in sizes of places: none of both may lead back, as it does to an isolated place that is level.
_ASIDE = (0.02, 0.007)
#: What is nearer to zero, in sizes of places, may be what rounding has left of it.
_TOO_NEAR = 1e-4
#: Newton's steps back to the ground, and how far off, in parts of a step, it may lead.
_STEPS = 8
_AWAY = 0.5
#: Places between two that are looked at, and how much farther than these one may be from the next.
_BETWEEN = 8
_NO_JUMP = 2.5
#: A curve has places this part of a size apart.
_EXTENDED = 1e-2
_MOST_DISTANCES = 1_000_000
#: More arcs than these are no few curves, and are left as they are.
_MOST_ARCS = 48


class Ground:
    """The places of balance of a system: forces (S, n) there with minus their slopes, and whether they are round-off.

    Only the coordinates that move are looked at: nothing depends on the others.
    """

    def __init__(self, forces: _Forces, balanced: _Balanced, moving: NDArray[np.bool_]) -> None:
        self._forces, self._balanced, self._moving = forces, balanced, moving

    def goes_on(self, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.intp]:
        """In how many directions (R,) equilibria go on from places (R, n) among others of a size (n).

        Steps go with that size, or with how far off the place itself is, as on a ring that is small beside others.
        """
        found = np.zeros(len(places), dtype=np.intp)
        if not len(places) or not self._moving.any():
            return found
        with np.errstate(all="ignore"):
            stiffness = self._forces(places)[1][:, self._moving][:, :, self._moving]
        known = np.flatnonzero(np.isfinite(stiffness).all(axis=(1, 2)))
        units = size[self._moving]
        _, values, vectors = np.linalg.svd(stiffness[known] * units * units[:, None])
        for level in range(values.shape[1]):
            where = values[:, level] <= _LEVEL * values[:, 0]
            if not where.any():
                continue
            ahead = np.zeros((int(where.sum()), places.shape[1]))
            ahead[:, self._moving] = vectors[where, level] * units
            from_here = places[known[where]]
            own = np.abs(from_here / size).max(axis=1, keepdims=True)
            ahead_by = (ahead, np.where(own < _TOO_NEAR, 1.0, own) * ahead)
            sides = [self._lead_on(from_here, sign * by, size) for sign in (1.0, -1.0) for by in ahead_by]
            found[known[where]] += np.any(sides, axis=0)
        return found

    def _lead_on(
        self, places: NDArray[np.float64], ahead: NDArray[np.float64], size: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Whether steps ahead (R, n) from places end beside them, and no nearer than that."""
        on = np.ones(len(places), dtype=bool)
        for part in _ASIDE:
            step = part * ahead
            ends, there = self._brought_back(places + step)
            length = np.abs(step / size).max(axis=1)
            on &= there & (np.abs((ends - places - step) / size).max(axis=1) <= _AWAY * length)
        return on

    def _brought_back(self, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Where Newton's method leads from places (R, n), and whether it is in balance there."""
        places = places.copy()
        with np.errstate(all="ignore"):
            for _ in range(_STEPS):
                forces, stiffness = self._forces(places)
                step = steps_to_zeros(forces[:, self._moving], stiffness[:, self._moving][:, :, self._moving])
                places[:, self._moving] += np.where(np.isfinite(step), step, 0.0)
            return places, self._balanced(places)

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
        joined = self._are_joined(places[ends[:, 0]], places[ends[:, 1]], size).tolist()
        for (to, was), same in zip(pairs, joined, strict=True):
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
        kept += [replace(alike[at], continuum=max(alike[at].continuum, own)) for at, own in zip(told, on, strict=True)]
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
