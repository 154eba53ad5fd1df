"""Period and action of a motion of one degree of freedom that comes back, for any Hamiltonian.

The one idea: a closed curve comes back to a line across its flow, to round-off by Hénon's method; along it p q̇ is a
periodic function of the time, so its mean over equal steps has all digits as soon as it is resolved at all.
M. Hénon, Physica D 5 (1982) 412; L. N. Trefethen & J. A. C. Weideman, SIAM Review 56 (2014) 385.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._calculus import Calculus

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["gauge_part", "oscillation_of_hamiltonian"]

_RTOL = 1e-15
#: The start again: what is nearer to it than this part of how far the motion goes. Another line across is not.
_SAME = 1e-6
#: What a motion is followed for: so many doublings of the shortest time it tells at the start, and so many steps.
_DOUBLINGS = 40
_MOST_STEPS = 200_000
#: Points on the curve, at first and at most, and by how much a mean may change when they are twice as many.
_FEWEST_POINTS = 64
_MOST_POINTS = 65_536
_RESOLVED = 2e-14
#: Places of Gauss's quadrature in each panel.
_GAUSS = 16


def oscillation_of_hamiltonian(system: Hamiltonian, turn: float | None) -> tuple[float, float, float, float]:
    """Give turning points (not known: NaN), period and action, as the core does for a Lagrangian."""
    if len(system.coordinates) != 1:
        raise InvalidInput("H", f"a period is that of one coordinate; there are {list(system.coordinates)}")
    try:
        lagrangian: Any = system.lagrangian()
    except InvalidInput:
        # Not quadratic in the momentum: by its curve in phase space.
        return _by_return(system, turn)
    found: tuple[float, float, float, float] = lagrangian._oscillation(turn)
    return found


def gauge_part(system: Lagrangian, turn: float) -> float:
    """Give ∫ A dq / 2π along a rotation, of the part A(q) q̇ of L: of p dq, and of no period."""
    c = Calculus(system)
    linear = c.derived(c.taken(*system._model.by_degree())[1:2])[0]
    if c.is_zero(linear[0]):
        return 0.0
    start = system._start()
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    before, panels = np.inf, 1
    while panels * _GAUSS <= _MOST_POINTS:
        places = start[0] + turn * (np.arange(panels)[:, None] + 0.5 + 0.5 * nodes).ravel() / panels
        states = np.stack([places, np.zeros_like(places)], axis=1)
        terms = c.values([linear[2]], np.full(len(places), system.t0), states, system._values)[:, 0]
        mean = float((terms.reshape(panels, -1) @ weights).sum() / (2.0 * panels))
        if abs(mean - before) <= _RESOLVED * float(np.abs(terms).max()):
            return mean * abs(turn) / (2.0 * np.pi) * float(np.sign(start[1]))
        before, panels = mean, 2 * panels
    raise ConvergenceError(
        f"the action is not resolved by {_MOST_POINTS} places: what is linear in the velocity is rough"
    )


def _by_return(system: Hamiltonian, turn: float | None) -> tuple[float, float, float, float]:
    start = system._start()
    rates = system._model.rates(np.array([system.t0]), start[None, :], system._values[None, :])[0]
    if not rates.any() or (turn is not None and rates[0] == 0.0):
        raise InvalidInput("position", "the motion stands still: an equilibrium; see equilibria()")
    forward = 1.0 if turn is None else float(np.sign(turn * rates[0]))
    period = _return_time(system, start, rates, turn, forward)
    return np.nan, np.nan, period, _action(system, start, period * forward, turn)


def _return_time(
    system: Hamiltonian, start: NDArray[np.float64], rates: NDArray[np.float64], turn: float | None, forward: float
) -> float:
    span = _shortest_time(system, start, rates)
    far = np.zeros(2) if turn is None else np.array([turn, 0.0])
    for _ in range(_DOUBLINGS):
        span *= 2.0
        try:
            times, states, sizes = _crossings(system, start, rates, far, forward * span)
        except ConvergenceError as error:
            raise InvalidInput("position", f"the motion does not come back: {error}; is it on a separatrix?") from None
        same = (np.abs(states - start - far) <= _SAME * sizes).all(axis=1) & (np.abs(times) > 1e-3 * _SAME * span)
        if same.any():
            return float(abs(times[np.argmax(same)]))
    how = "period(turn=2π) is that of a rotation" if turn is None else "period() is that of one that turns back"
    raise InvalidInput("position" if turn is None else "turn", f"the motion does not come back to its start; {how}")


def _crossings(
    system: Hamiltonian, start: NDArray[np.float64], rates: NDArray[np.float64], far: NDArray[np.float64], span: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Give times since the start and states where the flow passes a line across it there, and how far it goes."""
    end = system.t0 + span
    # Each number by how fast it changes: of a motion that begins at a turning point the momentum alone does.
    name = int(np.argmax(np.abs(rates) * np.array([abs(start[1]) or 1.0, abs(start[0]) or 1.0])))
    if far.any():
        name = 0
    c = Calculus(system)
    variable = c.taken([("variable", [], float(name))], [0])[0]
    section = c.derived([variable - float(start[name] + far[name])])[0][0]
    asked, _ = system._asked(np.array([system.t0, end]), "gauss16", _RTOL, None, None)
    asked["max_steps"] = _MOST_STEPS
    function = {"nodes": c._nodes.all, "root": section._place, "energy": None, "function": None}
    asked["events"] = [function | {"direction": float(np.sign(rates[name])), "last": None}]
    result = system._run(asked, start[None, :], system._values[None, :], 1, progress=False)
    if result["failures"][0] is not None:
        raise ConvergenceError(result["failures"][0], result["reached"][0])
    times, states = result["found_t"] - system.t0, result["found_y"]
    along = np.concatenate([states, result["y"], start[None, :]])
    return times, states, np.ptp(along, axis=0) + np.abs(along).max(axis=0)


def _shortest_time(system: Hamiltonian, start: NDArray[np.float64], rates: NDArray[np.float64]) -> float:
    nodes, second = system._model.expressions("curvatures")
    found = system._model.evaluate(nodes, second, np.array([system.t0]), start[None, :], system._values[None, :])[0]
    frequency = np.sqrt(abs(found[0] * found[3] - found[1] * found[2]))
    if np.isfinite(frequency) and frequency > 0.0:
        return float(1.0 / frequency)
    times = [abs(value / rate) for value, rate in zip(start, rates, strict=True) if value and rate]
    return float(min(times)) if times else float(1.0 / np.abs(rates).max())


def _action(system: Hamiltonian, start: NDArray[np.float64], span: float, turn: float | None) -> float:
    """Give ∮ p dq / 2π: along the motion of a rotation, the area of an oscillation."""
    before, points = np.inf, _FEWEST_POINTS
    while points <= _MOST_POINTS:
        times = system.t0 + span * np.arange(points + 1) / points
        asked, _ = system._asked(times, "gauss16", _RTOL, None, None)
        result = system._run(asked, start[None, :], system._values[None, :], 1, progress=False)
        states = result["y"][-points - 1 : -1]
        rates = system._model.rates(times[:-1], states, system._values[None, :])
        momentum = states[:, 1]
        if turn is None:
            # ∮ dq = 0: what a large constant momentum would cancel is left out.
            momentum = momentum - momentum.mean()
        terms = momentum * rates[:, 0]
        action = float(terms.mean() * abs(span) / (2.0 * np.pi))
        action = abs(action) if turn is None else action
        if abs(action - before) <= _RESOLVED * float(np.abs(terms).mean() * abs(span) / (2.0 * np.pi)):
            return action
        before, points = action, 2 * points
    raise ConvergenceError(f"the action is not resolved by {_MOST_POINTS} points of the motion: it turns too sharply")
