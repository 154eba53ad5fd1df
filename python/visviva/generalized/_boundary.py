"""Motions through two places: shooting by the flow's derivatives, and continuation where Newton's method finds none.

The one idea: where the motion goes is changed a little at a time, and the velocity follows along the curve of solutions
by its length of arc, which turns back at conjugate points where a velocity as a function of the place would end.
E. L. Allgower & K. Georg, *Numerical Continuation Methods* (1990), chapter 6.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from visviva._arrays import float_array
from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._neighbors import flow_jacobian, refuse_kinks

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["boundary_value"]

#: The most steps of a run that tries a velocity.
_MOST_STEPS_OF_A_TRIAL = 20_000
#: Misses of a place, relative to its size: that of a solution, and of one that round-off lets come no nearer.
_HIT = 1e-13
_NEAREST = 1e-10
_MOST_NEWTON, _MOST_HALVINGS = 50, 12
#: Times of a motion at which its extent is looked at.
_LOOKS = 17
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


class _Reached(NamedTuple):
    """Where a velocity leads: places, their derivatives by the velocities, and velocities there."""

    place: NDArray[np.float64]
    by_second: NDArray[np.float64]
    rate: NDArray[np.float64]


def boundary_value(system: GeneralizedSystem, t: float, position: ArrayLike, *, rtol: float) -> GeneralizedSystem:
    """Give the system with the velocities (or momenta) that lead to a place at a time."""
    refuse_kinks(system)
    free: Any = system
    if system._source.kind == "lagrangian" and free._constraints():
        raise InvalidInput("system", "motions between two places are found of systems without constraints")
    goal = float_array("position", position, (len(system.coordinates),))
    if t == system.t0:
        raise InvalidInput("t", f"expected another time than the start, {system.t0:g}")
    shooting = _Shooting(system, t, goal, rtol)
    found = shooting.newton(system._second, t)
    if found is None:
        found = shooting.by_moving_the_goal()
    if found is None:
        found = shooting.from_a_straight_line()
    if found is None or not shooting.arrives(found):
        raise ConvergenceError(shooting.told())
    return system._at(None, found)


class _Shooting:
    """Trials of one boundary value, and the nearest of them."""

    def __init__(self, system: GeneralizedSystem, t: float, goal: NDArray[np.float64], rtol: float) -> None:
        self._system, self._t, self._goal, self._rtol = system, t, goal, rtol
        self._nearest, self._spread = np.inf, np.inf
        # Relative to the places themselves, and to where the motion comes on the way: systems may be of any size.
        self._scale = np.maximum(np.abs(goal), self._extent())
        # What cannot be run from the start is refused by its name; a velocity that is tried may be none of a motion.
        self._spread_of_free_motion = abs(t - system.t0) * _rates_by_second(system)
        self._present = self._reached(system._second, t, (ConvergenceError,))
        if self._present is not None:
            self._scale = np.maximum(self._scale, np.abs(self._present.place))

    def _extent(self) -> NDArray[np.float64]:
        """Give the farthest that each coordinate comes from zero in the present motion, or at the start of none."""
        start = self._system._start()[: len(self._goal)]
        try:
            times = np.linspace(self._system.t0, self._t, _LOOKS)
            out = self._system.run(times, rtol=self._rtol, max_steps=_MOST_STEPS_OF_A_TRIAL)
        except (ConvergenceError, InvalidInput):
            return np.abs(start)
        farthest: NDArray[np.float64] = np.abs(np.vstack([start, out.position])).max(axis=0)
        return farthest

    def _reached(
        self,
        second: NDArray[np.float64],
        t: float,
        may_fail: tuple[type[Exception], ...] = (ConvergenceError, InvalidInput),
    ) -> _Reached | None:
        system, n = self._system, len(self._goal)
        try:
            other = system._at(None, second)
            state, jacobian = flow_jacobian(other, t, rtol=self._rtol, most_steps=_MOST_STEPS_OF_A_TRIAL)
        except may_fail:
            return None
        if not (np.isfinite(state).all() and np.isfinite(jacobian).all()):
            return None
        rates = system._model.rates(np.array([t]), state[None, :], system._values[None, :])[0]
        rate = state[n:] if system._source.kind == "lagrangian" else rates[:n]
        return _Reached(state[:n], jacobian[:n, n:], rate)

    def _size(self, miss: NDArray[np.float64]) -> float:
        sizes = np.where(self._scale > 0.0, self._scale, self._scale.max(initial=0.0))
        return float((np.abs(miss) / np.where(sizes > 0.0, sizes, 1.0)).max())

    def newton(self, second: NDArray[np.float64], t: float) -> NDArray[np.float64] | None:
        """Give what Newton's method comes to, its steps halved until they lead nearer."""
        reached = self._present if second is self._system._second and t == self._t else self._reached(second, t)
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
        out = self._system._at(None, second).run(self._t, rtol=self._rtol)
        miss = self._size(out.position[-1] - self._goal)
        if miss > _ARRIVED:
            self._nearest = miss
        return miss <= _ARRIVED

    def _note(self, size: float, reached: _Reached, t: float) -> None:
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

        return self._along(missed, self._system._second, 0.0, 1.0, self._t)

    def from_a_straight_line(self) -> NDArray[np.float64] | None:
        """Follow the motion from a straight line in a short time, as the time grows."""
        system, n = self._system, len(self._goal)
        start, whole = system._start()[:n], self._t - system.t0

        def missed(second: NDArray[np.float64], part: float) -> Any:
            reached = self._reached(second, system.t0 + part * whole)
            return reached and (reached.place - self._goal, reached.by_second, reached.rate * whole)

        for halvings in range(_SHORTEST_TIME + 1):
            part = 0.5**halvings
            velocity = (self._goal - start) / (part * whole)
            try:
                second = velocity
                if system._source.kind == "hamiltonian":
                    second = system.legendre_transform().conjugate(start, velocity)
            except (InvalidInput, ConvergenceError):
                return None
            found = self.newton(second, self._t if halvings == 0 else system.t0 + part * whole)
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


def _rates_by_second(system: GeneralizedSystem) -> float:
    """Give the size of the derivatives of velocities by the second half of the state: ∂q̇/∂q̇, or ∂²H/∂p∂p."""
    n = len(system.coordinates)
    if system._source.kind == "lagrangian":
        return 1.0
    nodes, roots = system._model.expressions("curvatures")
    start = system._start()[None, :]
    found = system._model.evaluate(nodes, roots, np.array([system.t0]), start, system._values[None, :])[0]
    size = float(np.linalg.norm(found.reshape(2 * n, 2 * n)[n:, n:]))
    return size if np.isfinite(size) and size > 0.0 else 1.0


def _tangent(at: Any, unit: float, before: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the direction of the curve of solutions that goes on as one before."""
    matrix = np.column_stack([unit * at[1], at[2]])
    rows = np.abs(matrix).max(axis=1)
    direction = np.linalg.svd(matrix / np.where(rows > 0.0, rows, 1.0)[:, None])[2][-1]
    forward: NDArray[np.float64] = direction if direction @ before >= 0.0 else -direction
    return forward
