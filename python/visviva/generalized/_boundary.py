"""Motions of a system through two places."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array
from visviva._shooting import Reached, through
from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._neighbors import flow_jacobian, refuse_kinks

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.generalized._system import GeneralizedSystem

__all__ = ["boundary_value"]

#: The most steps of a run that tries a velocity.
_MOST_STEPS_OF_A_TRIAL = 20_000
#: Times of a motion at which its extent is looked at.
_LOOKS = 17


def boundary_value(system: GeneralizedSystem, t: float, position: ArrayLike, *, rtol: float) -> GeneralizedSystem:
    """Give the system with the velocities (or momenta) that lead to a place at a time."""
    refuse_kinks(system)
    free: Any = system
    if system._source.kind == "lagrangian" and free._constraints():
        raise InvalidInput("system", "motions between two places are found of systems without constraints")
    goal = float_array("position", position, (len(system.coordinates),))
    return system._at(None, through(_Motions(system, rtol), t, goal))


class _Motions:
    """See `visviva._shooting.Motions`."""

    def __init__(self, system: GeneralizedSystem, rtol: float) -> None:
        self._system, self._rtol = system, rtol
        self.t0, self.second = system.t0, system._second
        self.start = system._start()[: len(system.coordinates)]
        self.rates_by_second = _rates_by_second(system)

    def farthest(self, t: float) -> NDArray[np.float64]:
        try:
            times = np.linspace(self.t0, t, _LOOKS)
            out = self._system.run(times, rtol=self._rtol, max_steps=_MOST_STEPS_OF_A_TRIAL)
        except (ConvergenceError, InvalidInput):
            return np.abs(self.start)
        farthest: NDArray[np.float64] = np.abs(np.vstack([self.start, out.position])).max(axis=0)
        return farthest

    def reached(self, second: NDArray[np.float64], t: float) -> Reached:
        system, n = self._system, len(self.start)
        other = system._at(None, second)
        state, jacobian = flow_jacobian(other, t, rtol=self._rtol, most_steps=_MOST_STEPS_OF_A_TRIAL)
        rates = system._model.rates(np.array([t]), state[None, :], system._values[None, :])[0]
        rate = state[n:] if system._source.kind == "lagrangian" else rates[:n]
        return Reached(state[:n], jacobian[:n, n:], rate)

    def straight(self, velocity: NDArray[np.float64]) -> NDArray[np.float64] | None:
        system: Any = self._system
        if system._source.kind == "lagrangian":
            return velocity
        try:
            momenta: NDArray[np.float64] = system.legendre_transform().conjugate(self.start, velocity)
        except (InvalidInput, ConvergenceError):
            return None
        return momenta

    def end(self, second: NDArray[np.float64], t: float) -> NDArray[np.float64]:
        place: NDArray[np.float64] = self._system._at(None, second).run(t, rtol=self._rtol).position[-1]
        return place


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
