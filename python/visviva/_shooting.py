"""Motions through two places: shooting by the flow's derivatives, and continuation where Newton's method finds none.

The one idea: where the motion goes is changed a little at a time, and the velocity follows along the curve of solutions
by its length of arc, which turns back at conjugate points where a velocity as a function of the place would end.
E. L. Allgower & K. Georg, *Numerical Continuation Methods* (1990), chapter 6. Scenes and systems in generalized
coordinates are `Motions` alike: what a velocity (or momentum) leads to is all that is asked of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from visviva.errors import ConvergenceError, InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["Motions", "Reached", "through"]

#: Misses of a place, relative to its size: that of a solution, and of one that round-off lets come no nearer.
_HIT = 1e-13
_NEAREST = 1e-10
_MOST_NEWTON, _MOST_HALVINGS = 50, 12
#: Steps along a curve of solutions; lengths of them in sizes of a velocity, and what a corrector is to reach.
_MOST_ALONG = 300
_FIRST, _LONGEST, _SHORTEST = 0.05, 0.5, 1e-5
_MOST_CORRECTIONS, _ON_THE_CURVE = 6, 1e-8
#: The shortest time of a straight line is the whole over 2 to this power.
_SHORTEST_TIME = 7
#: What a run may miss the place by.
_ARRIVED = 1e-6
#: Where velocities change a place by less than this part of what they would in free motion, places are conjugate.
_CONJUGATE = 1e-9


class Reached(NamedTuple):
    """Where a velocity leads: places, their derivatives by the velocities, and velocities there."""

    place: NDArray[np.float64]
    by_second: NDArray[np.float64]
    rate: NDArray[np.float64]


class Motions(Protocol):
    """Motions that begin in the same places at the same time, with one velocity or another."""

    t0: float
    start: NDArray[np.float64]
    """The places."""
    second: NDArray[np.float64]
    """The present velocities, or momenta."""
    rates_by_second: float
    """How large the derivatives of velocities by them are."""

    def farthest(self, t: float) -> NDArray[np.float64]:
        """Give the farthest that each coordinate comes from zero in the present motion, or at the start of none."""

    def reached(self, second: NDArray[np.float64], t: float) -> Reached:
        """Give where a velocity leads.

        Raises
        ------
        ConvergenceError, InvalidInput
            Where it leads nowhere.
        """

    def straight(self, velocity: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """Give what has these velocities at the start, if anything has."""

    def end(self, second: NDArray[np.float64], t: float) -> NDArray[np.float64]:
        """Give the places that a run comes to."""


def through(motions: Motions, t: float, goal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the velocities (or momenta) that lead to places at a time.

    Raises
    ------
    InvalidInput
        For the time of the start.
    ConvergenceError
        If no such motion is found.
    """
    if t == motions.t0:
        raise InvalidInput("t", f"expected another time than the start, {motions.t0:g}")
    shooting = _Shooting(motions, t, goal)
    found = shooting.newton(motions.second, t)
    if found is None:
        found = shooting.by_moving_the_goal()
    if found is None:
        found = shooting.from_a_straight_line()
    if found is None or not shooting.arrives(found):
        raise ConvergenceError(shooting.told())
    return found


class _Shooting:
    """Trials of one boundary value, and the nearest of them."""

    def __init__(self, motions: Motions, t: float, goal: NDArray[np.float64]) -> None:
        self._motions, self._t, self._goal = motions, t, goal
        self._nearest, self._spread = np.inf, np.inf
        # Relative to the places themselves, and to where the motion comes on the way: systems may be of any size.
        self._scale = np.maximum(np.abs(goal), motions.farthest(t))
        # What cannot be run from the start is refused by its name; a velocity that is tried may be none of a motion.
        self._spread_of_free_motion = abs(t - motions.t0) * motions.rates_by_second
        self._present = self._reached(motions.second, t, (ConvergenceError,))
        if self._present is not None:
            self._scale = np.maximum(self._scale, np.abs(self._present.place))

    def _reached(
        self,
        second: NDArray[np.float64],
        t: float,
        may_fail: tuple[type[Exception], ...] = (ConvergenceError, InvalidInput),
    ) -> Reached | None:
        try:
            found = self._motions.reached(second, t)
        except may_fail:
            return None
        return found if all(np.isfinite(part).all() for part in found) else None

    def _size(self, miss: NDArray[np.float64]) -> float:
        sizes = np.where(self._scale > 0.0, self._scale, self._scale.max(initial=0.0))
        return float((np.abs(miss) / np.where(sizes > 0.0, sizes, 1.0)).max())

    def newton(self, second: NDArray[np.float64], t: float) -> NDArray[np.float64] | None:
        """Give what Newton's method comes to, its steps halved until they lead nearer."""
        reached = self._present if second is self._motions.second and t == self._t else self._reached(second, t)
        if reached is None:
            return None
        size = self._size(reached.place - self._goal)
        for _ in range(_MOST_NEWTON):
            self._note(size, reached, t)
            if size <= _HIT:
                return second
            try:
                change = np.linalg.solve(reached.by_second, reached.place - self._goal)
            except np.linalg.LinAlgError:
                return None
            for _ in range(_MOST_HALVINGS):
                trial = second - change
                other = self._reached(trial, t)
                if other is not None and self._size(other.place - self._goal) < size:
                    break
                change = 0.5 * change
            else:
                # Nearer is what round-off does not allow.
                return second if size <= _NEAREST else None
            second, reached, size = trial, other, self._size(other.place - self._goal)
        return None

    def arrives(self, second: NDArray[np.float64]) -> bool:
        """Whether a run with the velocity found arrives, too: one of 1e16 is somewhere else by its rounding."""
        miss = self._size(self._motions.end(second, self._t) - self._goal)
        if miss > _ARRIVED:
            self._nearest = miss
        return miss <= _ARRIVED

    def _note(self, size: float, reached: Reached, t: float) -> None:
        if t == self._t and size < self._nearest:
            self._nearest = size
            self._spread = float(np.linalg.svd(reached.by_second, compute_uv=False)[-1]) / self._spread_of_free_motion

    def by_moving_the_goal(self) -> NDArray[np.float64] | None:
        """Follow the motion from the present one, as the place of arrival moves from where that goes."""
        if self._present is None:
            return None
        begin = self._present.place
        way = self._goal - begin

        def missed(second: NDArray[np.float64], part: float) -> Any:
            reached = self._reached(second, self._t)
            return reached and (reached.place - begin - part * way, reached.by_second, -way)

        return self._along(missed, self._motions.second, 0.0, 1.0, self._t)

    def from_a_straight_line(self) -> NDArray[np.float64] | None:
        """Follow the motion from a straight line in a short time, as the time grows."""
        motions = self._motions
        whole = self._t - motions.t0

        def missed(second: NDArray[np.float64], part: float) -> Any:
            reached = self._reached(second, motions.t0 + part * whole)
            return reached and (reached.place - self._goal, reached.by_second, reached.rate * whole)

        for halvings in range(_SHORTEST_TIME + 1):
            part = 0.5**halvings
            second = motions.straight((self._goal - motions.start) / (part * whole))
            if second is None:
                return None
            found = self.newton(second, self._t if halvings == 0 else motions.t0 + part * whole)
            if found is not None:
                return found if halvings == 0 else self._along(missed, found, part, 1.0, self._t)
        return None

    def _along(
        self, missed: Callable[..., Any], second: NDArray[np.float64], part: float, end: float, t: float
    ) -> NDArray[np.float64] | None:
        """Follow solutions of missed(second, part) = 0 until part is `end`, by the length of arc."""
        at = missed(second, part)
        if at is None:
            return None
        # A velocity of such a size changes a place by its own: a unit for all of them together.
        slopes = np.linalg.norm(at[1] / np.where(self._scale > 0.0, self._scale, 1.0)[:, None], ord=2)
        unit = max(float(np.linalg.norm(second)), 1.0 / float(slopes) if slopes > 0.0 else 1.0)
        point, length = np.append(second / unit, part), _FIRST
        tangent = _tangent(at, unit, np.append(np.zeros(len(second)), 1.0))
        for _ in range(_MOST_ALONG):
            corrected = self._corrected(missed, point + length * tangent, tangent, unit)
            if corrected is None or abs(float(tangent @ _tangent(corrected[1], unit, tangent))) < 0.7:
                length *= 0.5
                if length < _SHORTEST:
                    return None
                continue
            other, at, easy = corrected
            if (point[-1] - end) * (other[-1] - end) <= 0.0:
                among = (end - point[-1]) / (other[-1] - point[-1])
                found = self.newton(unit * (point + among * (other - point))[:-1], t)
                if found is not None:
                    return found
            point, tangent = other, _tangent(at, unit, tangent)
            length = min(2.0 * length, _LONGEST) if easy else length
        return None

    def _corrected(
        self, missed: Callable[..., Any], point: NDArray[np.float64], tangent: NDArray[np.float64], unit: float
    ) -> tuple[NDArray[np.float64], Any, bool] | None:
        """Give the solution across the tangent, what is known there, and whether it took few steps."""
        for turn in range(_MOST_CORRECTIONS):
            at = missed(unit * point[:-1], float(point[-1]))
            if at is None:
                return None
            if self._size(at[0]) <= _ON_THE_CURVE:
                return point, at, turn <= 3
            matrix = np.vstack([np.column_stack([unit * at[1], at[2]]), tangent])
            try:
                point = point - np.linalg.solve(matrix, np.append(at[0], 0.0))
            except np.linalg.LinAlgError:
                return None
        return None

    def told(self) -> str:
        """Say why there is no answer, and what may be done."""
        if not np.isfinite(self._nearest):
            return "no velocity that was tried could be run to the time of arrival; start with another one"
        message = f"no motion through both places was found: the nearest missed by {self._nearest:.2g} of its size"
        if self._spread < _CONJUGATE:
            return (
                f"{message}, at a conjugate point, where motions meet whatever their velocities, and to other places "
                "there are none or many; take another time, or start with another velocity"
            )
        return f"{message}; start with another velocity, or take a shorter time"


def _tangent(at: Any, unit: float, before: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the direction of the curve of solutions that goes on as one before."""
    matrix = np.column_stack([unit * at[1], at[2]])
    rows = np.abs(matrix).max(axis=1)
    direction = np.linalg.svd(matrix / np.where(rows > 0.0, rows, 1.0)[:, None])[2][-1]
    forward: NDArray[np.float64] = direction if direction @ before >= 0.0 else -direction
    return forward
