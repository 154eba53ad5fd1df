"""Period and action of a motion of one degree of freedom that comes back, for any Hamiltonian and any Lagrangian.

The one idea: a closed curve comes back to a line across its flow, to round-off by Hénon's method; along it ∫ p q̇ dt is
integrated over panels that are halved where it turns. M. Hénon, Physica D 5 (1982) 412.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._methods import ACROSS_KINKS
from visviva.generalized._whole import whole

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian
    from visviva.generalized._lagrangian import Lagrangian

    _Of: TypeAlias = Hamiltonian | Lagrangian

__all__ = [
    "action_by_return",
    "action_of_hamiltonian",
    "action_of_lagrangian",
    "gauge_part",
    "period_by_return",
    "period_of_hamiltonian",
    "period_of_lagrangian",
]

#: The first keeps the step of its start, and the energy. The second finds kinks, and takes few steps where most of the
#: motion is slow.
_HELD, _CHOSEN = "gauss16", ACROSS_KINKS
_RTOL = {_HELD: 1e-15, _CHOSEN: 1e-14}
_OF_A_ROTATION = "the period of a rotation is period(turn=2π)"
_OF_AN_OSCILLATION = "the period of an oscillation is period()"
#: The start again: what is nearer to it than this part of how far the motion goes. Another line across is not.
_SAME = 1e-6
#: What a motion is followed for: so many doublings of the shortest time it tells at the start, and so many steps.
_DOUBLINGS = 40
_MOST_STEPS = 100_000
#: Panels of a quadrature, at first, and how often each may be halved; by how much it may change then.
_PANELS = 4
_MOST_HALVINGS = 40
_RESOLVED = 4e-15
#: What rates may miss of how far a motion goes in a panel, as a part of how far it goes in all.
_ADDS_UP = 1e-8
#: What the last digits of the start may change of a period, and what is the same after a turn, as in the core.
_KNOWN = 1e-9
_REPEATS = 1e-9
#: Places of Gauss's quadrature in each panel.
_GAUSS = 16
_MOST_PANELS = 4096


def period_of_hamiltonian(system: Hamiltonian, turn: float | None) -> float:
    """Give the period of a motion of one coordinate."""
    lagrangian = _by_velocity(system)
    return period_by_return(system, turn) if lagrangian is None else period_of_lagrangian(lagrangian, turn)


def action_of_hamiltonian(system: Hamiltonian, turn: float | None) -> float:
    """Give its action variable."""
    lagrangian = _by_velocity(system)
    return action_by_return(system, turn) if lagrangian is None else action_of_lagrangian(lagrangian, turn)


def period_of_lagrangian(system: Lagrangian, turn: float | None) -> float:
    """Give the period of a motion of one coordinate, of an energy that is quadratic in the velocity."""
    return _by_slopes(system, turn, 2, period_by_return)


def action_of_lagrangian(system: Lagrangian, turn: float | None) -> float:
    """Give its action variable."""
    return _by_slopes(system, turn, 3, action_by_return)


def _by_slopes(
    system: Lagrangian, turn: float | None, which: int, otherwise: Callable[[Lagrangian, float | None], float]
) -> float:
    """Give one number of a quadrature of slopes, or otherwise where that does not tell those beside a kink.

    Over the shortest panel that has the kink within it the slope of |q| has no bounds, and where a steep wall is right
    beside it all that is left of the energy is lost there. The motion itself passes the kink by an event.
    """
    try:
        return float(system._oscillation(turn)[which])
    except InvalidInput as refusal:
        if "no finite number" not in refusal.message or not system._structure["kinks"]:
            raise
        try:
            return otherwise(system, turn)
        except (ConvergenceError, InvalidInput):
            # The slope is infinite there.
            raise refusal from None


def period_by_return(system: _Of, turn: float | None) -> float:
    """Give the period of a motion of one coordinate, of any function."""
    return float(_by_return(system, turn)[0])


def action_by_return(system: _Of, turn: float | None) -> float:
    """Give its action variable."""
    _, span, method = _by_return(system, turn)
    return _action(system, (span, method), turn)


def _by_velocity(system: Hamiltonian) -> Any:
    """Give the Lagrangian of a Hamiltonian that is quadratic in the momentum, or None."""
    if len(system.coordinates) != 1:
        raise InvalidInput("H", f"a period is that of one coordinate; there are {list(system.coordinates)}")
    try:
        return system.lagrangian()
    except InvalidInput:
        return None


def gauge_part(system: Lagrangian, turn: float) -> float:
    """Give ∫ A dq / 2π along a rotation, of the part A(q) q̇ of L: of p dq, and of no period."""
    c = Calculus(system)
    linear = c.with_derivatives(c.adopted(*system._model.by_degree())[1:2])[0]
    if c.is_zero(linear[0]):
        return 0.0
    start = system._start()
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    before, panels = np.inf, 1
    while panels <= _MOST_PANELS:
        places = start[0] + turn * (np.arange(panels)[:, None] + 0.5 + 0.5 * nodes).ravel() / panels
        states = np.stack([places, np.zeros_like(places)], axis=1)
        terms = c.values([linear[2]], np.full(len(places), system.t0), states, system._values)[:, 0]
        mean = float((terms.reshape(panels, -1) @ weights).sum() / (2.0 * panels))
        if abs(mean - before) <= 4.0 * _RESOLVED * float(np.abs(terms).max()):
            return mean * abs(turn) / (2.0 * np.pi) * float(np.sign(start[1]))
        before, panels = mean, 2 * panels
    raise ConvergenceError(
        f"the action is not resolved by {_MOST_PANELS} panels: what is linear in the velocity is rough"
    )


def _by_return(system: _Of, turn: float | None) -> tuple[float, float, str]:
    """Give the period, the time along which the coordinate goes the way of the turn, and the method that tells them."""
    start = system._start()
    system._check_start()
    rates = _rates(system, start)
    if not rates.any():
        raise InvalidInput("position", "the motion stands still: an equilibrium; see equilibria()")
    if turn is not None:
        if rates[0] == 0.0:
            raise InvalidInput("turn", f"the motion turns back before it has gone so far; {_OF_AN_OSCILLATION}")
        _refuse_unless_it_repeats(system, start, turn)
    forward = 1.0 if turn is None else float(np.sign(turn * rates[0]))
    period, method, doubt = _return_time(system, start, turn, forward)
    try:
        nearby, _, _ = _return_time(system, start * (1.0 + 2.0**-50), turn, forward, method)
    except InvalidInput:
        nearby = np.inf
    if abs(nearby - period) > _KNOWN * period:
        if doubt is not None:
            raise doubt
        raise InvalidInput("position", "the motion is on a separatrix, but for round-off, and has no period")
    return period, period * forward, method


def _rates(system: _Of, state: NDArray[np.float64]) -> NDArray[np.float64]:
    found: NDArray[np.float64] = _rates_at(system, np.array([system.t0]), state[None, :])[0]
    return found


def _rates_at(system: _Of, times: NDArray[np.float64], states: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rates (N, 2) of both numbers of states (N, 2)."""
    found: NDArray[np.float64] = system._model.rates(times, states, system._values[None, :])
    return np.stack([states[:, 1], found[:, 0]], axis=1) if found.shape[1] == 1 else found


def _refuse_unless_it_repeats(system: _Of, start: NDArray[np.float64], turn: float) -> None:
    # No faster: a velocity may have a limit.
    places, momenta = np.meshgrid(start[0] + turn * np.arange(8) / 8, start[1] * np.array([1.0, 0.7, 0.4]))
    here = np.stack([places.ravel(), momenta.ravel()], axis=1)
    times, far = np.full(len(here), system.t0), np.array([turn, 0.0])
    first, second = (_rates_at(system, times, x) for x in (here, here + far))
    if (np.abs(first - second) > _REPEATS * np.abs(first).max(axis=0)).any():
        raise InvalidInput("turn", f"the energy does not repeat after {turn:g}, so the motion has no period of that")


def _return_time(
    system: _Of, start: NDArray[np.float64], turn: float | None, forward: float, method: str | None = None
) -> tuple[float, str, InvalidInput | None]:
    """Give the time of return, the method that came there, of those that may if none is given, and why no other did."""
    rates = _rates(system, start)
    span = _shortest_time(system, start, rates)
    far = np.zeros(2) if turn is None else np.array([turn, 0.0])
    method = method or (_CHOSEN if system._structure["kinks"] else _HELD)
    doubt = None
    why = ""
    for _ in range(_DOUBLINGS):
        span *= 2.0
        try:
            result = _followed(system, start, rates, (far, forward * span, method))
            if result["endings"][0] == "too many steps" and method == _HELD:
                doubt = _no_return(turn, _many_steps(result), _of_many_steps(system))
                method = _CHOSEN
                result = _followed(system, start, rates, (far, forward * span, method))
            if result["endings"][0] == "too many steps":
                raise doubt or _no_return(turn, _many_steps(result), _of_many_steps(system))
            whole(result, "motion")
        except ConvergenceError as error:
            why = f" ({error})"
            break
        times, states = result["found_t"] - system.t0, result["found_y"]
        along = np.concatenate([states, result["y"], start[None, :]])
        sizes = np.ptp(along, axis=0) + np.abs(along).max(axis=0)
        same = (np.abs(states - start - far) <= _SAME * sizes).all(axis=1) & (np.abs(times) > 1e-3 * _SAME * span)
        if same.any():
            return float(abs(times[np.argmax(same)])), method, doubt
    raise doubt or _no_return(turn, why, "")


def _many_steps(result: dict[str, Any]) -> str:
    return f" in {_MOST_STEPS} steps, until t = {result['reached'][0]:.6g}"


def _no_return(turn: float | None, why: str, further: str) -> InvalidInput:
    if turn is None:
        return InvalidInput("position", f"the motion does not come back to its start{why}; {_OF_A_ROTATION}{further}")
    return InvalidInput(
        "turn", f"the motion does not come to its start after a turn{why}; {_OF_AN_OSCILLATION}{further}"
    )


def _of_many_steps(system: _Of) -> str:
    """Say how a period of more steps than are taken here is found: no argument of it changes their number."""
    passing = f"vv.events.coordinate({system.coordinates[0]!r}, place, direction=1)"
    told = f"; one of more steps is the time between two events of run(t, events=[{passing}])"
    if system._source.kind == "hamiltonian":
        return told
    return f"{told}; near a limit of the velocity, as that of light, the same motion takes far fewer as a Hamiltonian"


def _followed(
    system: _Of,
    start: NDArray[np.float64],
    rates: NDArray[np.float64],
    along: tuple[NDArray[np.float64], float, str],
) -> dict[str, Any]:
    """Give the motion so far on, for a time, by a method, with its passages of a line across the flow at the start."""
    far, span, method = along
    end = system.t0 + span
    # Each number by how fast it changes: of a motion that begins at a turning point the momentum alone does.
    name = int(np.argmax(np.abs(rates) * np.array([abs(start[1]) or 1.0, abs(start[0]) or 1.0])))
    if far.any():
        name = 0
    c = Calculus(system)
    variable = c.adopted([("variable", [], float(name))], [0])[0]
    section = c.with_derivatives([variable - float(start[name] + far[name])])[0][0]
    asked, _ = system._asked(np.array([system.t0, end]), method, _RTOL[method], None, None)
    asked["max_steps"] = _MOST_STEPS
    function = {"nodes": c._nodes.all, "root": section._place, "energy": None, "function": None}
    asked["events"] = [function | {"direction": float(np.sign(rates[name])), "last": None}]
    return system._run(asked, start[None, :], system._values[None, :], 1, progress=False)


def _shortest_time(system: _Of, start: NDArray[np.float64], rates: NDArray[np.float64]) -> float:
    nodes, second = system._model.expressions("curvatures")
    found = system._model.evaluate(nodes, second, np.array([system.t0]), start[None, :], system._values[None, :])[0]
    with np.errstate(all="ignore"):
        hamiltonian = system._source.kind == "hamiltonian"
        frequency = np.sqrt(abs(found[0] * found[3] - found[1] * found[2] if hamiltonian else found[0] / found[3]))
        # Next to an inflection a frequency tells nothing, and a fall from there all the same.
        acceleration = abs(rates[1] * found[3]) if hamiltonian else abs(rates[1])
        fall = np.sqrt(abs(start[0]) / acceleration)
        known = [float(time) for time in (1.0 / frequency, fall) if np.isfinite(time) and time > 0.0]
    if known:
        return min(known)
    times = [abs(value / rate) for value, rate in zip(start, rates, strict=True) if value and rate]
    return float(min(times)) if times else float(1.0 / np.abs(rates).max())


def _action(system: _Of, along: tuple[float, str], turn: float | None) -> float:
    """Give ∮ p dq / 2π for a time by a method: along the motion of a rotation, the area of an oscillation."""
    (span, method), start = along, system._start()
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    center = None

    def integrals(edges: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Of ∫ p q̇ dt between pairs of parts of the period (N, 2), and whether the rates add up to how far it goes."""
        nonlocal center
        middle, half = edges.mean(axis=1)[:, None], 0.5 * np.diff(edges, axis=1)
        inside = len(edges) * _GAUSS
        parts = np.concatenate([(middle + half * nodes).ravel(), edges.ravel()])
        times = system.t0 + span * np.append(0.0, parts)
        states = _states(system, start, times, method)
        rates = _rates_at(system, times[1:], states)
        momenta = states[:, 1]
        if system._source.kind == "lagrangian":
            momenta = system._model.columns(times[1:], states, system._values[None, :])[:, 0]
        if center is None:
            # ∮ dq = 0: what a large constant momentum would cancel is left out.
            center = float(0.5 * (momenta.max() + momenta.min())) if turn is None else 0.0
        found: NDArray[np.float64] = ((momenta - center) * rates[:, 0])[:inside].reshape(-1, _GAUSS) @ weights
        # A burst between two nodes leaves its trace.
        gone = np.einsum("ngs,g->ns", rates[:inside].reshape(-1, _GAUSS, 2), weights) * half * span
        ends = states[inside:].reshape(-1, 2, 2)
        size = np.ptp(states, axis=0) + _RESOLVED * np.abs(states).max(axis=0)
        whole: NDArray[np.bool_] = (np.abs(gone - (ends[:, 1] - ends[:, 0])) <= _ADDS_UP * size).all(axis=1)
        return found * half[:, 0] * abs(span), whole

    ends = np.linspace(0.0, 1.0, _PANELS + 1)
    edges = np.stack([ends[:-1], ends[1:]], axis=1)
    (whole, _), done = integrals(edges), 0.0
    size = float(np.abs(whole).sum())
    for _ in range(_MOST_HALVINGS):
        middle = edges.mean(axis=1)
        halves = np.stack([np.stack([edges[:, 0], middle], axis=1), np.stack([middle, edges[:, 1]], axis=1)], axis=1)
        parts, adds_up = (each.reshape(-1, 2) for each in integrals(halves.reshape(-1, 2)))
        rough = (np.abs(parts.sum(axis=1) - whole) > _RESOLVED * size) | ~adds_up.all(axis=1)
        done += float(parts[~rough].sum())
        if not rough.any():
            action = done / (2.0 * np.pi)
            return abs(action) if turn is None else action
        edges, whole = halves[rough].reshape(-1, 2), parts[rough].ravel()
    raise ConvergenceError("the action is not resolved: the motion turns too sharply, or the function has kinks")


def _states(system: _Of, start: NDArray[np.float64], times: NDArray[np.float64], method: str) -> NDArray[np.float64]:
    """Give states at times after the first, which is the start's; the times need no order."""
    order = np.argsort(np.abs(times[1:] - times[0]))
    asked, _ = system._asked(times[1:][order], method, _RTOL[method], None, None)
    result = system._run(asked, start[None, :], system._values[None, :], 1, progress=False)
    whole(result, "motion")
    states = np.empty((len(order), 2))
    states[order] = result["y"][-len(order) :]
    return states
