"""Places of balance that others go on from: in which directions, and whether they are such places at all.

The one idea: from a place on a curve a step along the direction that forces leave level, brought back by Newton's
method, ends in balance, about as far off as the step was.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.generalized._newton import steps_to_zeros
from visviva.generalized._searches import SAME

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    _Forces = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
    _Balanced = Callable[[NDArray[np.float64]], NDArray[np.bool_]]

__all__ = ["AWAY", "LevelGround"]

#: A direction is level where its stiffness is this part of the largest.
_LEVEL = 1e-6
#: Two steps along it, in sizes of places: none of both may lead back, as it does to an isolated place that is level.
_ASIDE = (0.02, 0.007)
#: What is nearer to zero, in sizes of places, may be what rounding has left of it.
_TOO_NEAR = 1e-4
#: Newton's steps back to the ground, and how far off, in parts of a step, it may lead.
_STEPS = 8
AWAY = 0.5
#: Directions between those that are level; how many turns on a circle, and halvings from one of these to the next.
_MIXED = 6
_ON_A_CIRCLE = 97
_HALVINGS = 48
#: Roundings of what forces are the sums of, and how many times as large they are along a valley as across, on its
#: ground.
_ROUNDINGS = 64.0
_ON_THE_GROUND = 10.0
#: Newton's steps across, of which the last are less than rounding.
_STEPS_ACROSS = 4


class LevelGround:
    """The places of balance of a system: forces (S, n) there with minus their slopes, and whether they are round-off.

    Only the coordinates that move are looked at: nothing depends on the others.
    """

    def __init__(self, forces: _Forces, balanced: _Balanced, moving: NDArray[np.bool_]) -> None:
        self._forces, self._balanced, self._moving = forces, balanced, moving

    def goes_on(self, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.intp]:
        """In how many directions (R,) equilibria go on from places (R, n) among others of a size (n).

        Steps go with that size, or with how far off the place itself is, as on a ring that is small beside others.
        Where curves cross there are some directions of those that are level, and not what is between them: that is 1.
        """
        found = np.zeros(len(places), dtype=np.intp)
        if not len(places) or not self._moving.any():
            return found
        known, levels, vectors = self._level(places, size)
        own = np.abs(places[known] / size).max(axis=1, keepdims=True)
        near = np.where(own < _TOO_NEAR, 1.0, own)

        def leads(rows: NDArray[np.bool_], along: NDArray[np.float64]) -> NDArray[np.bool_]:
            """Whether it goes on from those, along vectors in sizes of places or against them."""
            from_here, ahead = places[known[rows]], along * size
            both = (ahead, near[rows] * ahead)
            on = [self._lead_on(from_here, sign * by, size) for sign in (1.0, -1.0) for by in both]
            anywhere: NDArray[np.bool_] = np.any(on, axis=0)
            return anywhere

        directions = np.zeros(len(known), dtype=np.intp)
        for which in range(vectors.shape[1]):
            rows = levels[:, which]
            if rows.any():
                directions[rows] += leads(rows, vectors[rows, which])
        several = levels.sum(axis=1) > 1
        if several.any():
            whole = directions[several] == levels[several].sum(axis=1)
            for parts in np.random.default_rng(0).normal(size=(_MIXED, vectors.shape[1])):
                mixed = np.einsum("sk,skn->sn", levels[several] * parts, vectors[several])
                whole &= leads(several, mixed / np.abs(mixed).max(axis=1, keepdims=True))
            crossing = self._cross(places[known[several]], (levels[several], vectors[several]), near[several] * size)
            directions[several] = np.where(whole, directions[several], (directions[several] > 0) | crossing)
        found[known] = directions
        return found

    def _level(
        self, places: NDArray[np.float64], size: NDArray[np.float64]
    ) -> tuple[NDArray[np.intp], NDArray[np.bool_], NDArray[np.float64]]:
        """Of places (R, n) those with stiffnesses, in which of directions they are level, and these (K, k, n) in sizes.

        Beside what is as stiff as places near by: where curves cross, there may be no stiffness at all.
        """
        steps = _ASIDE[0] * size * np.eye(len(size))[self._moving]
        around = places + np.concatenate([0.0 * steps[:1], steps, -steps])[:, None]
        with np.errstate(all="ignore"):
            stiffness = self._forces(around.reshape(-1, len(size)))[1][:, self._moving][:, :, self._moving]
        units = size[self._moving]
        stiffness = (stiffness * units * units[:, None]).reshape(len(around), len(places), len(units), len(units))
        known = np.flatnonzero(np.isfinite(stiffness[0]).all(axis=(1, 2)))
        stiffness = np.where(np.isfinite(stiffness), stiffness, 0.0)[:, known]
        _, values, vectors = np.linalg.svd(stiffness[0])
        stiffest = np.fmax(values[:, 0], np.abs(stiffness).max(axis=(0, 2, 3)))
        every = np.zeros((*vectors.shape[:2], len(size)))
        every[:, :, self._moving] = vectors
        return known, values <= _LEVEL * stiffest[:, None], every

    def _cross(
        self,
        places: NDArray[np.float64],
        level: tuple[NDArray[np.bool_], NDArray[np.float64]],
        size: NDArray[np.float64],
    ) -> NDArray[np.bool_]:
        """Whether curves cross at places (R, n) of sizes (R, n) that are level in two directions.

        On a small circle about a crossing forces along it change sign where a curve comes through.
        """
        found = np.zeros(len(places), dtype=bool)
        turns = np.linspace(0.0, 2.0 * np.pi, _ON_A_CIRCLE)
        for at in np.flatnonzero(level[0].sum(axis=1) == 2).tolist():
            pair = level[1][at][level[0][at]] * size[at]

            def on(turn: NDArray[np.float64], radius: float, at: int = at, pair: NDArray[np.float64] = pair) -> Any:
                return places[at] + radius * (np.stack([np.cos(turn), np.sin(turn)], axis=1) @ pair)

            def along(turn: NDArray[np.float64], radius: float, on: Any = on, pair: Any = pair) -> NDArray[np.float64]:
                with np.errstate(all="ignore"):
                    forces = self._forces(on(turn, radius))[0]
                ahead = np.stack([-np.sin(turn), np.cos(turn)], axis=1) @ pair
                led: NDArray[np.float64] = np.where(np.isfinite(forces), forces * ahead, 0.0)[:, self._moving].sum(
                    axis=1
                )
                return led

            found[at] = all(self._comes_through(on, along, turns, radius, size[at]) for radius in _ASIDE)
        return found

    def _comes_through(
        self, on: Any, along: Any, turns: NDArray[np.float64], radius: float, size: NDArray[np.float64]
    ) -> bool:
        """Whether a curve of equilibria comes through a circle about a place."""
        signs = np.sign(along(turns, radius))
        changes = np.flatnonzero((signs[1:] != signs[:-1]) | (signs[:-1] == 0.0))
        low, high, below = turns[changes], turns[changes + 1], signs[changes]
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            same = np.sign(along(middle, radius)) == below
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        begun = on(np.where(below == 0.0, turns[changes], 0.5 * (low + high)), radius)
        ends, there = self._brought_back(begun)
        return bool((there & (np.abs((ends - begun) / size).max(axis=1, initial=0.0) <= AWAY * radius)).any())

    def judged(
        self, states: NDArray[np.float64], size: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
        """States (R, …), of which the first numbers are places (n), and in how many directions equilibria go on (R,).

        Those on curves are exactly there, and without those from which something leads on.
        """
        states, n = states.copy(), len(size)
        directions = self.goes_on(states[:, :n], size)
        on = directions > 0
        states[on, :n] = self.polished(states[on, :n], size)
        kept = ~on
        kept[on] = self.holds(states[on, :n], size)
        return states[kept], directions[kept]

    def holds(self, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether at places (R, n) on curves nothing leads on along them but what is round-off there.

        Along a valley that falls slowly, forces are less than the rounding of those farther off: they are seen when
        those across have come to nothing.
        """
        kept = np.ones(len(places), dtype=bool)
        if not len(places) or not self._moving.any():
            return kept
        places, units = places.copy(), size[self._moving]
        known = np.arange(len(places))
        for _ in range(_STEPS_ACROSS):
            with np.errstate(all="ignore"):
                forces, stiffness = (each[:, self._moving] for each in self._forces(places[known]))
            stiffness = stiffness[:, :, self._moving]
            finite = np.isfinite(stiffness).all(axis=(1, 2)) & np.isfinite(forces).all(axis=1)
            known, forces = known[finite], forces[finite] * units
            stiffness = stiffness[finite] * units * units[:, None]
            at = np.ix_(known, self._moving)
            here = places[at]
            places[at] += units * np.einsum("sij,sj->si", np.linalg.pinv(stiffness, rcond=_LEVEL), forces)
        _, values, vectors = np.linalg.svd(stiffness)
        level = values <= _LEVEL * values[:, :1]
        led = np.einsum("skn,sn->sk", vectors, forces)
        made_of = np.einsum("sij,sj->si", np.abs(stiffness), np.abs(here / units))
        seen = np.abs(led) > _ROUNDINGS * np.finfo(float).eps * np.einsum("skn,sn->sk", np.abs(vectors), made_of)
        across = np.abs(np.where(level, 0.0, led)).max(axis=1, keepdims=True)
        kept[known] = ~(level & seen & (np.abs(led) > _ON_THE_GROUND * across)).any(axis=1)
        return kept

    def polished(self, places: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.float64]:
        """Places (R, n) on curves, exactly there, if they were next to it."""
        ends, there = self._brought_back(places)
        near = there & (np.abs((ends - places) / size) <= SAME).all(axis=1)
        return np.where(near[:, None], ends, places)

    def _lead_on(
        self, places: NDArray[np.float64], ahead: NDArray[np.float64], size: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Whether steps ahead (R, n) from places end beside them, and no nearer than that."""
        on = np.ones(len(places), dtype=bool)
        for part in _ASIDE:
            step = part * ahead
            ends, there = self._brought_back(places + step)
            length = np.abs(step / size).max(axis=1)
            on &= there & (np.abs((ends - places - step) / size).max(axis=1) <= AWAY * length)
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


def __dir__() -> list[str]:
    return list(__all__)
