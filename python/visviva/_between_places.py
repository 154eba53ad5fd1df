"""Motions of a scene through two places: the velocities of some of its bodies that lead them to places at a time."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva._arrays import float_array, number
from visviva._flow_jacobian import flow_jacobian_of
from visviva._names import body_indices
from visviva._shooting import Reached, through
from visviva.errors import AccuracyWarning, CloseEncounter, ConvergenceError, InvalidInput
from visviva.request import FlowRequest

if TYPE_CHECKING:
    from collections.abc import Sequence
    from contextlib import AbstractContextManager

    from numpy.typing import NDArray

    from visviva.request import BoundaryRequest
    from visviva.scene import Scene

__all__ = ["boundary_value"]

#: Times of a motion at which its extent is looked at.
_LOOKS = 17
#: The most steps of a run that tries velocities, and the most trials.
_MOST_STEPS_OF_A_TRIAL = 20_000
_MOST_TRIALS = 500
#: How close steps are held, if nobody says.
_RTOL = 1e-12


def boundary_value(scene: Scene, request: BoundaryRequest) -> Scene:
    """Give the scene with the velocities that lead bodies to places at a time."""
    particles = scene.particles
    if scene.rigid_bodies is not None:
        raise InvalidInput("scene", "motions between two places are found of particles, not beside rigid bodies")
    if request.body is None:
        bodies = np.arange(len(particles))
    else:
        given = request.body
        several = [given] if isinstance(given, str) or not np.ndim(given) else list(cast("Sequence[int | str]", given))
        bodies = np.asarray(body_indices("body", several, particles.names, len(particles)))
        if len(np.unique(bodies)) < len(bodies):
            raise InvalidInput("body", f"expected each body once, got {request.body!r}")
    shape = (3,) if np.ndim(request.position) == 1 and len(bodies) == 1 else (len(bodies), 3)
    goal = float_array("position", request.position, shape).ravel()
    rtol = _RTOL if request.rtol is None and request.dt is None else request.rtol
    how = {"method": request.method, "dt": request.dt, "rtol": rtol, "threads": request.threads}
    motions = _Motions(scene, bodies, how)
    return motions.scene_with(through(motions, number("t", request.t), goal))


class _Motions:
    """See `visviva._shooting.Motions`."""

    def __init__(self, scene: Scene, bodies: NDArray[np.intp], how: dict[str, Any]) -> None:
        self._scene, self._bodies, self._how = scene, bodies, how
        self.t0 = scene.t0
        self.start = scene.particles.position[bodies].ravel()
        self.second = scene.particles.velocity[bodies].ravel()
        self.rates_by_second = 1.0
        self._trials = 0

    def scene_with(self, second: NDArray[np.float64]) -> Scene:
        velocity = self._scene.particles.velocity.copy()
        velocity[self._bodies] = second.reshape(-1, 3)
        return self._scene.with_state(velocity=velocity)

    def farthest(self, t: float) -> NDArray[np.float64]:
        try:
            places = self._run(self.second, list(np.linspace(self.t0, t, _LOOKS))).position[:, self._bodies]
        except ConvergenceError:
            return np.abs(self.start)
        farthest: NDArray[np.float64] = np.abs(places).max(axis=0).ravel()
        return farthest

    def reached(self, second: NDArray[np.float64], t: float) -> Reached:
        self._trials += 1
        if self._trials > _MOST_TRIALS:
            raise ConvergenceError(f"{_MOST_TRIALS} motions were tried, and none that arrives was found")
        out = self._run(second, t)
        with _quietly():
            flow = flow_jacobian_of(self.scene_with(second), FlowRequest(t, **self._how), self._numbers(1))
        place, velocity = (each[-1][self._bodies].ravel() for each in (out.position, out.velocity))
        return Reached(place, flow[self._numbers(0)], velocity)

    def straight(self, velocity: NDArray[np.float64]) -> NDArray[np.float64] | None:
        return velocity

    def end(self, second: NDArray[np.float64], t: float) -> NDArray[np.float64]:
        place: NDArray[np.float64] = self._run(second, t).position[-1][self._bodies].ravel()
        return place

    def _numbers(self, kind: int) -> NDArray[np.intp]:
        """Give where places (0) or velocities (1) of the bodies are among all numbers of a state."""
        first = 3 * (kind * len(self._scene.particles) + self._bodies)
        return (first[:, None] + np.arange(3)).ravel()

    def _run(self, second: NDArray[np.float64], t: Any) -> Any:
        try:
            with _quietly():
                return self.scene_with(second).run(t, max_steps=_MOST_STEPS_OF_A_TRIAL, **self._how)
        except CloseEncounter as error:
            raise ConvergenceError(str(error)) from error


def _quietly() -> AbstractContextManager[Any]:
    """Give a context in which a motion that is only tried does not warn."""
    return warnings.catch_warnings(action="ignore", category=AccuracyWarning)


def __dir__() -> list[str]:
    return list(__all__)
