"""Sweeps of REBOUND, heyoka and SciPy on the problems of `visviva.problems`; beside which is `work_precision.py`.

What is timed is the integration alone. SciPy gets its right-hand side in NumPy as a careful user writes it.
"""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from threading import Timer
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from _harness import rebound_simulation

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    # What a peer does once, prepared: places and velocities at the end.
    Once = Callable[[], tuple[NDArray[np.float64], NDArray[np.float64]]]

# A peer's run that takes so many times ours of the same error is not repeated.
HOPELESS = 200.0


class Peer:
    """Sweeps of another package on a problem."""

    # A peer is given so many times our time before it is taken no further.
    patience = 3.0
    # And at least so many seconds.
    least = 0.0

    def __init__(self, problem: vv.problems.Problem, ours: vv.WorkPrecision, seconds: float, repeats: int) -> None:
        self.problem, self.ours, self.repeats = problem, ours, repeats
        self.seconds = max(self.least, self.patience * seconds)
        self.scene, self.end = problem.scene, problem.t_end
        self.size = float(np.abs(problem.references[-1].position).max())
        self.energy = self.scene.invariants().energy
        # Series that were taken no further although they might have gained.
        self.out_of_patience: set[str] = set()

    def points(self) -> Iterator[vv.Point]:
        """All runs."""
        raise NotImplementedError

    def finished(self) -> None:
        """A run is over, and its time taken."""

    def point(self, series: str, setting: float, prepare: Callable[[], Once]) -> tuple[vv.Point | None, float]:
        """What it is off, if it is anywhere near, and the least time of several."""
        point, least = None, float("inf")
        for _ in range(self.repeats):
            once = prepare()
            begun = perf_counter()
            try:
                position, velocity = once()
            except Exception as error:  # a peer says in its own way that it cannot
                print(f"  {series} at {setting:g}: {error!s:.60}")
                if isinstance(error, TimeoutError):
                    self.out_of_patience.add(series)
                return None, perf_counter() - begun
            finally:
                took = perf_counter() - begun
                self.finished()
            least = min(least, took)
            point = self.judged(series, setting, least, position, velocity)
            best = None if point is None else self.ours.best(point.position_error)
            if least > self.seconds / self.patience or (best is not None and least > HOPELESS * best.seconds):
                break
        return point, least

    def judged(
        self, series: str, setting: float, seconds: float, position: NDArray[np.float64], velocity: NDArray[np.float64]
    ) -> vv.Point | None:
        """What a run is off, None if it is nowhere near."""
        if not (np.isfinite(position).all() and np.isfinite(velocity).all()):
            return None
        final = self.scene.with_state(position, velocity, self.end)
        error = self.problem.error(final)
        drift = abs(final.invariants().energy - self.energy) / (abs(self.energy) or 1.0)
        return None if error > self.size else vv.Point(series, setting, seconds, error, drift)

    def sweep(self, series: str, settings: Iterator[float], prepare: Callable[[float], Once]) -> Iterator[vv.Point]:
        """Settings from rough to fine, until a run takes too long or nothing is gained any more."""
        best, no_better = float("inf"), 0
        for setting in settings:
            point, took = self.point(series, setting, partial(prepare, setting))
            if point is not None:
                yield point
                no_better = 0 if point.position_error < 0.9 * best else no_better + 1
                best = min(best, point.position_error)
            if took > self.seconds:
                self.out_of_patience.add(series)
                return
            if no_better >= 4 and best < 1e-6:
                return

    def steps(self) -> Iterator[float]:
        """Steps that meet the end, each √2 smaller."""
        yield from ((self.end - self.scene.t0) / round(16.0 * 2.0 ** (0.5 * k)) for k in range(60))


class Rebound(Peer):
    """IAS15, Bulirsch–Stoer, leapfrog of orders 2 to 8 and, for planets, WHFast and SABA."""

    # Ends a run that takes too long.
    timer: Timer | None = None

    def points(self) -> Iterator[vv.Point]:
        if find_spec("rebound") is None or not any(isinstance(force, vv.Gravity) for force in self.scene.forces):
            return
        yield from self.sweep("REBOUND ias15", (10.0**-k for k in range(1, 12)), self.adaptive("ias15", "epsilon"))
        yield from self.sweep("REBOUND bs", (10.0**-k for k in range(2, 15)), self.adaptive("bs", "eps_rel"))
        for order in (2, 4, 6, 8):
            yield from self.sweep(f"REBOUND leapfrog {order}", self.steps(), self.fixed("leapfrog", order=order))
        if "applegate" in self.problem.source.lower():
            yield from self.sweep("REBOUND whfast", self.steps(), self.fixed("whfast", safe_mode=0, corrector=17))
            yield from self.sweep("REBOUND saba", self.steps(), self.fixed("saba", safe_mode=0))

    def finished(self) -> None:
        if self.timer is not None:
            self.timer.cancel()

    def made(self, name: str, **settings: Any) -> Any:
        simulation: Any = rebound_simulation(self.scene)
        simulation.integrator = name
        for key, value in settings.items():
            setattr(simulation.integrator, key, value)
        return simulation

    def adaptive(self, name: str, tolerance: str) -> Callable[[float], Once]:
        def prepare(setting: float) -> Once:
            settings = {tolerance: setting} | ({"eps_abs": setting} if tolerance == "eps_rel" else {})
            simulation = self.made(name, **settings)
            simulation.dt = 1e-4 * (self.end - self.scene.t0)
            # Its steps may fall to 1e-47 (IAS15 on the figure-eight, ε = 1e-5): it would go on for ever.
            self.timer = Timer(self.seconds, simulation.stop)
            self.timer.start()

            def once() -> Any:
                simulation.integrate(self.end, exact_finish_time=1)
                if simulation.t != self.end:
                    raise TimeoutError(f"not within {self.seconds:.3g} s, steps of {simulation.dt:.1g}")
                return self.state(simulation)

            return once

        return prepare

    def fixed(self, name: str, **settings: Any) -> Callable[[float], Once]:
        def prepare(setting: float) -> Once:
            simulation = self.made(name, **settings)
            simulation.dt = setting
            count = round((self.end - self.scene.t0) / setting)

            def once() -> Any:
                simulation.steps(count)
                simulation.synchronize()
                return self.state(simulation)

            return once

        return prepare

    def state(self, simulation: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        position, velocity = np.empty((simulation.N, 3)), np.empty((simulation.N, 3))
        simulation.serialize_particle_data(xyz=position, vxvyvz=velocity)
        return position, velocity


class Heyoka(Peer):
    """Taylor series of the order that the tolerance asks for; compiled before it is timed."""

    def points(self) -> Iterator[vv.Point]:
        forces = self.scene.forces
        if find_spec("heyoka") is None or not any(isinstance(force, vv.Gravity) for force in forces):
            return
        yield from self.sweep("heyoka", iter((1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 2.3e-16)), self.prepare)

    def prepare(self, tolerance: float) -> Once:
        import heyoka

        bodies = self.scene.particles
        start = np.concatenate([bodies.position, bodies.velocity], axis=1).ravel()
        if getattr(self, "compiled", (None, None))[0] != tolerance:
            gravity = next(force for force in self.scene.forces if isinstance(force, vv.Gravity))
            system = heyoka.model.nbody(len(bodies), masses=bodies.mass.tolist(), Gconst=gravity.G)
            made = heyoka.taylor_adaptive(system, start, tol=tolerance, compact_mode=len(bodies) > 3)
            self.compiled = (tolerance, made)
        integrator: Any = self.compiled[1]
        integrator.time = self.scene.t0
        integrator.state[:] = start

        def once() -> Any:
            integrator.propagate_until(self.end)
            rows = np.array(integrator.state).reshape(-1, 6)
            return rows[:, :3], rows[:, 3:]

        return once


class Scipy(Peer):
    """`solve_ivp` with DOP853 and LSODA, of the accelerations that visviva's forces are, in NumPy."""

    patience = 12.0
    least = 0.5

    def points(self) -> Iterator[vv.Point]:
        if find_spec("scipy") is None:
            return
        derivative = self.patient(self.derivative())
        for method in ("DOP853", "LSODA"):
            tolerances = (10.0**-k for k in range(3, 14))
            yield from self.sweep(f"SciPy {method}", tolerances, partial(self.prepare, method, derivative))

    def prepare(self, method: str, derivative: Any, tolerance: float) -> Once:
        from scipy.integrate import solve_ivp

        bodies = self.scene.particles
        start = np.concatenate([bodies.position.ravel(), bodies.velocity.ravel()])

        def once() -> Any:
            self.deadline = perf_counter() + self.seconds
            found = solve_ivp(
                derivative,
                (self.scene.t0, self.end),
                start,
                method,
                t_eval=[self.end],
                rtol=tolerance,
                atol=1e-3 * tolerance,
            )
            if not found.success:
                raise ArithmeticError(found.message)
            state = found.y[:, -1].reshape(2, -1, 3)
            return state[0], state[1]

        return once

    def patient(self, derivative: Any) -> Any:
        """It gives up when it is too late."""

        def rates(t: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
            if perf_counter() > self.deadline:
                raise TimeoutError(f"not within {self.seconds:.3g} s")
            return derivative(t, y)

        return rates

    def derivative(self) -> Any:
        count, mass = len(self.scene.particles), self.scene.particles.mass
        terms = [TERMS[force.kind](force, mass) for force in self.scene.forces]

        def rates(t: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
            position, velocity = y.reshape(2, count, 3)
            acceleration = terms[0](t, position, velocity)
            for term in terms[1:]:
                acceleration = acceleration + term(t, position, velocity)
            return np.concatenate((velocity.ravel(), acceleration.ravel()))

        return rates


def gravity_term(force: Any, mass: NDArray[np.float64]) -> Any:
    first, second = np.triu_indices(len(mass), 1)
    pairs = np.arange(len(first))
    incidence = np.zeros((len(mass), len(first)))
    incidence[first, pairs], incidence[second, pairs] = force.G * mass[second], -force.G * mass[first]

    def term(_: float, position: NDArray[np.float64], __: Any) -> NDArray[np.float64]:
        separation = position[second] - position[first]
        square = np.einsum("ij,ij->i", separation, separation)
        return incidence @ (separation / (square * np.sqrt(square))[:, None])

    return term


def spring_term(force: Any, mass: NDArray[np.float64]) -> Any:
    i, j, k = force.i, force.j, force.k
    share = np.zeros((len(mass), 1))
    share[i], share[j] = k / mass[i], -k / mass[j]
    return lambda _, position, __: share * (position[j] - position[i])


def driven_term(force: Any, mass: NDArray[np.float64]) -> Any:
    from math import cos

    amplitude = np.array(force.amplitude) / mass[:, None]
    return lambda t, _, __: amplitude * cos(force.frequency * t + force.phase)


def magnetic_term(force: Any, mass: NDArray[np.float64]) -> Any:
    x, y, z = force.B
    turn = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) * force.charge
    return lambda _, __, velocity: velocity @ turn / mass[:, None]


def uniform_term(force: Any, mass: NDArray[np.float64]) -> Any:
    everywhere = np.array([force.g] * len(mass))
    return lambda _, __, ___: everywhere


def quadratic_term(force: Any, mass: NDArray[np.float64]) -> Any:
    share = -force.coefficient / mass[:, None]
    return lambda _, __, velocity: share * np.linalg.norm(velocity, axis=1, keepdims=True) * velocity


TERMS: dict[str, Any] = {
    "gravity": gravity_term,
    "spring": spring_term,
    "driven_force": driven_term,
    "uniform_magnetic_field": magnetic_term,
    "linear_drag": lambda force, _: lambda _t, _x, velocity: velocity * (-1.0 / force.tau),
    "quadratic_drag": quadratic_term,
    "uniform_field": uniform_term,
}


PEERS: dict[str, type[Peer]] = {"SciPy": Scipy, "REBOUND": Rebound, "heyoka": Heyoka}
