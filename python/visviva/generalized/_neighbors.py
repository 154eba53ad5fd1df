"""What neighbors of a motion do: derivatives of the flow, and Lyapunov's exponents.

The one idea: the variational equations are run beside the motion itself. On constraints neighbors are on them, too:
what rounding leaves across them is taken out of the state and of all small differences, from part to part.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import ConvergenceError, Interrupted, InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._consistency import constraints_and_rates
from visviva.generalized._matrices import balanced_units
from visviva.generalized._newton import rates_and_slopes
from visviva.generalized._whole import whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._system import GeneralizedSystem
    from visviva.integrators import Method
    from visviva.typing import GeneralizedMethodName

__all__ = ["MOST_STEPS", "flow_jacobian", "lyapunov_exponents", "refuse_kinks"]

#: The most steps of a run.
MOST_STEPS = 100_000_000
#: Where the least growth of neighbors is below this part of the most, it has lost as many of its digits.
_DROWNED = 1e-5
# Parts of a run of which nobody has told how long they may be, the first one beside the others, the shortest beside the
# longest, and what is too short beside one to be a part of its own.
_PARTS = 32
_FIRST_PART = 1.0 / 1024.0
_SHORTEST = 1e-9
_LEFT_OVER = 1e-6
#: Singular values above this part of the largest are none of constraints that depend on each other.
_INDEPENDENT = 1e-12
#: Instants, from this part of a time on, at which slopes are looked at for units; within how many parts of the run at
#: most, and how many steps; and how well the motion is known there.
_INSTANTS = 64
_FIRST = 1e-4
_PARTS_OF_UNITS = 64
_STEPS_OF_UNITS = 10_000
_LOOSE = 1e-6
#: Units are powers of two to this: numbers of about one size stay what they are.
_COARSE = 20.0
#: Steps after which neighbors are put on constraints again.
_STEPS_OF_A_PART = 16


class _Neighbors:
    """Small differences between states: all, or those along constraints."""

    def __init__(self, system: GeneralizedSystem) -> None:
        self._system: Any = system
        self.numbers = 2 * len(system.coordinates)
        self.constrained = bool(system._source.kind == "lagrangian" and self._system._constraints())
        if self.constrained:
            self._calculus = c = Calculus(system)
            holonomic, rates = constraints_and_rates(c, self._system)
            self._holonomic = len(holonomic)
            rows = c.with_derivatives([*holonomic, *rates])
            self._slopes = [slope for row in rows for slope in row[1 : 1 + self.numbers]]

    def directions(self, t: float, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Give orthonormal ones (2n, d), in columns."""
        if not self.constrained:
            return np.eye(self.numbers)
        n = self.numbers // 2
        of_places, by_places, by_velocities = self._slopes_at(t, state)
        places, velocities = _null(of_places), _null(by_velocities)
        moved = -np.linalg.pinv(by_velocities) @ (by_places @ places)
        frame = np.block([[places, np.zeros((n, velocities.shape[1]))], [moved, velocities]])
        along: NDArray[np.float64] = np.linalg.qr(frame)[0]
        return along

    def put_on(
        self, t: float, state: NDArray[np.float64], frame: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Give a state and small differences (2n, d) on the constraints: places first, in any units of velocities."""
        if not self.constrained:
            return state, frame
        state = self._system._model.projected(t, state, self._system._values)[2]
        of_places, by_places, by_velocities = self._slopes_at(t, state)
        places, velocities = np.split(frame, 2)
        places = places - np.linalg.pinv(of_places) @ (of_places @ places)
        velocities = velocities - np.linalg.pinv(by_velocities) @ (by_places @ places + by_velocities @ velocities)
        return state, np.concatenate([places, velocities])

    def _slopes_at(
        self, t: float, state: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Of holonomic constraints by places (h, n), and of the rates of all by places and velocities (m, n)."""
        n = self.numbers // 2
        found = self._calculus.values(self._slopes, np.array([t]), state[None], self._system._values)
        rows = found.reshape(-1, 2 * n)
        return rows[: self._holonomic, :n], rows[self._holonomic :, :n], rows[self._holonomic :, n:]

    def parts(self, asked: dict[str, Any]) -> NDArray[np.float64]:
        """Give times between which rounding may leave the constraints: the ends of the run, without any."""
        begin, end = asked["span"]
        if not self.constrained:
            return np.array([begin, end])
        model, system = self._system._model, self._system
        result = model.run(asked, system._start()[None, :], system._values[None, :], 1, None)
        whole(result, "flow")
        return np.linspace(begin, end, 1 + max(1, int(result["steps"][0]) // _STEPS_OF_A_PART))


def _null(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give orthonormal vectors (n, d), in columns, that rows (m, n) take to zero."""
    _, sizes, turned = np.linalg.svd(rows / np.linalg.norm(rows, axis=1, keepdims=True))
    found: NDArray[np.float64] = turned[int((sizes > _INDEPENDENT * sizes.max(initial=0.0)).sum()) :].T
    return found


def flow_jacobian(
    system: GeneralizedSystem,
    t: float,
    *,
    rtol: float = 1e-12,
    method: GeneralizedMethodName | Method = "gauss16",
    most_steps: int = MOST_STEPS,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Give the state at ``t``, and its derivatives with respect to the state at the start."""
    n = 2 * len(system.coordinates)
    refuse_kinks(system)
    system._check_start()
    asked, _ = system._asked(t, method, rtol, None, None)
    asked["max_steps"] = most_steps
    model, neighbors = system._model.variational(), _Neighbors(system)
    state = system._start()
    _, frame = neighbors.put_on(system.t0, state, np.eye(n))
    for begin, end in pairwise(neighbors.parts(asked)):
        part = asked | {"span": (begin, end), "outputs": np.array([end])}
        both = np.concatenate([state, frame.ravel()])
        result = model.run(part, both[None, :], system._values[None, :], 1, None)
        whole(result, "flow")
        last = result["y"][-1]
        state, frame = neighbors.put_on(end, last[:n], last[n:].reshape(n, n))
    return state, frame


def refuse_kinks(system: GeneralizedSystem) -> None:
    if system._structure["kinks"]:
        raise InvalidInput(
            "system",
            "expected a function without absolute values: where one turns the derivatives of a motion jump, which "
            "variational equations do not tell; compare runs from neighboring starts",
        )


def lyapunov_exponents(
    system: GeneralizedSystem, t: float, *, interval: float | None, rtol: float
) -> NDArray[np.float64]:
    """Give all exponents, by the variational equations and orthonormal frames."""
    n = 2 * len(system.coordinates)
    refuse_kinks(system)
    system._check_start()
    model, neighbors = system._model.variational(), _Neighbors(system)
    whole_time = t - system.t0
    longest = whole_time / (_PARTS if interval is None else max(1, round(abs(whole_time) / interval)))
    state = system._start()
    units = _units(system, system.t0 + min(_PARTS_OF_UNITS * abs(longest), abs(whole_time)) * np.sign(whole_time))
    units = units[:, None]
    frame = np.linalg.qr(neighbors.directions(system.t0, state) / units)[0] * units
    several = frame.shape[1]
    sums = np.zeros(several)
    if not several:
        return sums
    # Unless somebody tells, the first part is short: nobody knows how fast neighbors part.
    length = longest if interval is not None else longest * _FIRST_PART
    shortest = _SHORTEST * abs(longest)
    reached = system.t0
    try:
        while reached != t:
            begin, left = reached, t - reached
            end = begin + length if abs(length) < (1.0 - _LEFT_OVER) * abs(left) else t
            asked = {
                "method": "gauss16",
                "span": (begin, end),
                "rtol": rtol,
                "atol": None,
                "dt": None,
                "max_step": None,
                "max_steps": MOST_STEPS,
                "outputs": np.array([end]),
                "events": [],
            }
            all_of_them = np.zeros((n, n))
            all_of_them[:, :several] = frame
            both = np.concatenate([state, all_of_them.ravel()])
            result = model.run(asked, both[None, :], system._values[None, :], 1, None)
            if result["interrupted"]:
                raise KeyboardInterrupt
            failed, stretch = result["failures"][0], np.zeros(several)
            if failed is None and np.isfinite(result["y"][-1]).all():
                last = result["y"][-1]
                after, moved = neighbors.put_on(end, last[:n], last[n:].reshape(n, n)[:, :several])
                turned, sizes = np.linalg.qr(moved / units)
                stretch = np.abs(np.diag(sizes))
            # What grows most drowns what grows least, or leaves the range of numbers: the frame is made orthonormal
            # again before that.
            if stretch.min() <= _DROWNED * stretch.max():
                if abs(end - begin) <= shortest:
                    raise ConvergenceError(
                        failed or "what neighbors do differs too much in the shortest time to be told apart", begin
                    )
                length = 0.5 * (end - begin)
                continue
            if stretch.min() ** 2 > _DROWNED * stretch.max() ** 2:
                length = 2.0 * length if abs(length) < 0.5 * abs(longest) else longest
            state, frame = after, turned * units
            sums, reached = sums + np.log(stretch), end
    except KeyboardInterrupt as stopped:
        done = None if reached == system.t0 else _exponents(sums, reached - system.t0)
        raise Interrupted(f"the exponents were interrupted at t = {reached:g}", result=done) from stopped
    return _exponents(sums, t - system.t0)


def _units(system: GeneralizedSystem, t: float) -> NDArray[np.float64]:
    """Give units of the numbers of a state in which their rates are not too unlike, on the way to a time.

    Lengths of neighbors are measured in them. At one instant slopes tell little, as of a pendulum at a right angle.
    """
    start, times = system._start()[None, :], system.t0 + np.geomspace(_FIRST, 1.0, _INSTANTS) * (t - system.t0)
    asked, _ = system._asked(t, "gauss16", _LOOSE, None, None, _STEPS_OF_UNITS)
    asked["outputs"] = times
    result = system._model.run(asked, start, system._values[None, :], 1, None)
    if result["interrupted"]:
        raise Interrupted(f"the exponents were interrupted at t = {system.t0:g}", result=None)
    slopes = np.abs(rates_and_slopes(system, np.concatenate([start, result["y"]]))[1])
    alike = balanced_units(np.where(np.isfinite(slopes), slopes, 0.0).max(axis=0)[None])[0]
    units: NDArray[np.float64] = np.exp2(_COARSE * np.rint(np.log2(alike) / _COARSE))
    return units


def _exponents(sums: NDArray[np.float64], time: float) -> NDArray[np.float64]:
    return np.sort(sums / time)[::-1]


def __dir__() -> list[str]:
    return list(__all__)
