"""Many copies of a scene in one run, and what comes back: arrays with a leading axis B.

Each copy gets the bits it would get alone. A copy that fails has a status and NaN from there on; the
others do not notice.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import float_array, mass_array
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.particles import Particles
from visviva.plan import Plan
from visviva.request import execute, keywords
from visviva.trajectory import Stats, Trajectory

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from os import PathLike

    from numpy.typing import ArrayLike, NDArray

    from visviva._progress import Progress
    from visviva.scene import Scene

__all__ = ["EnsembleScene", "EnsembleTrajectory"]


@known_keywords
class EnsembleScene:
    """B copies of a scene. Made by `Scene.ensemble`.

    Attributes
    ----------
    scene : Scene
        The forces, the time, and whatever the copies share.
    mass : ndarray, shape (B, N)
    position, velocity : ndarray, shape (B, N, 3)
    """

    __slots__ = ("_keywords", "mass", "position", "scene", "velocity")

    def __init__(
        self,
        scene: Scene,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        mass: ArrayLike | None = None,
    ) -> None:
        own = {"mass": scene.particles.mass, "position": scene.particles.position, "velocity": scene.particles.velocity}
        given = {
            name: float_array(name, value, (None, *own[name].shape))
            for name, value in (("position", position), ("velocity", velocity))
            if value is not None
        }
        if mass is not None:
            given["mass"] = mass_array(mass, (None, *own["mass"].shape))
        if not given:
            raise InvalidInput("position", "give position, velocity or mass with a leading axis over the copies")
        lengths = {name: array.shape[0] for name, array in given.items()}
        first, count = next(iter(lengths.items()))
        for name, length in lengths.items():
            if length != count:
                raise InvalidInput(name, f"expected {count} copies like {first}, got {length}")
        if count == 0:
            raise InvalidInput(first, "expected at least one copy, got none")
        full = {
            name: given[name] if name in given else np.broadcast_to(array, (count, *array.shape)).copy()
            for name, array in own.items()
        }
        for array in full.values():
            array.flags.writeable = False
        self.scene = scene
        self.mass, self.position, self.velocity = full["mass"], full["position"], full["velocity"]
        self._keywords: dict[str, Any] = {**scene._keywords, **full}

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, index: int) -> Scene:
        from visviva.scene import Scene

        particles = Particles(self.mass[index], self.position[index], self.velocity[index])
        return Scene(particles, *self.scene.forces, t0=self.scene.t0)

    def __iter__(self) -> Iterator[Scene]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        return f"EnsembleScene({len(self)} copies of {self.scene!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self.scene, self.position, self.velocity, self.mass)

    def run(
        self,
        t: ArrayLike,
        *,
        method: str = "auto",
        dt: float | None = None,
        rtol: float = 1e-9,
        atol: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        record: Sequence[str] = ("position", "velocity"),
        events: Sequence[object] = (),
        threads: int | None = None,
        progress: Progress = False,
    ) -> EnsembleTrajectory:
        """Run every copy; arguments as `Scene.run`.

        Returns
        -------
        EnsembleTrajectory

        Raises
        ------
        visviva.InvalidInput
            Something asked for makes no sense; nothing has run. A copy that fails on the way raises
            nothing: see `EnsembleTrajectory.status`.
        visviva.Interrupted
            Ctrl-C; ``.trajectory`` holds what was done.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> out = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None]).run(t=1.0)
        >>> out.position.shape, out[1].position.shape
        ((2, 2, 2, 3), (2, 2, 3))
        """
        request = keywords(self._keywords, t, method, dt, rtol, atol, max_step, max_steps, record, events)
        return execute(self, request, threads, progress, ensemble=True, make=EnsembleTrajectory)

    def plan(
        self,
        t: ArrayLike,
        *,
        method: str = "auto",
        dt: float | None = None,
        rtol: float = 1e-9,
        atol: float | None = None,
        max_step: float | None = None,
        max_steps: int | None = None,
        record: Sequence[str] = ("position", "velocity"),
        events: Sequence[object] = (),
    ) -> Plan:
        """What `run` would do with the same arguments, without doing it."""
        request = keywords(self._keywords, t, method, dt, rtol, atol, max_step, max_steps, record, events)
        return Plan._from_core(_core.plan(**request))


@known_keywords
class EnsembleTrajectory:
    """The motions of the copies. Made by `EnsembleScene.run` and `load`.

    Attributes
    ----------
    ensemble : EnsembleScene
    t : ndarray, shape (T,)
    position, velocity : ndarray, shape (B, T, N, 3)
    energy : ndarray, shape (B, T)
    momentum, angular_momentum, center_of_mass : ndarray, shape (B, T, 3)
    status : ndarray of int8, shape (B,)
        Values of `Status`; rows after a failure are NaN.
    stats : Stats
        Totals over the copies; `per_trajectory` has them one by one.

    Indexing gives the `Trajectory` of one copy.
    """

    __slots__ = ("_columns", "_result", "ensemble", "t")

    def __init__(self, ensemble: EnsembleScene, result: dict[str, Any]) -> None:
        self.ensemble = ensemble
        self.t: NDArray[np.float64] = result["t"]
        self._result = result
        self._columns: dict[str, NDArray[np.float64]] = dict(result["columns"])

    def __len__(self) -> int:
        return len(self.ensemble)

    def __getitem__(self, index: int) -> Trajectory:
        count = len(self)
        if not -count <= index < count:
            raise IndexError(f"copy {index} of {count}")
        row = slice(index % count, index % count + 1)
        result = dict(self._result)
        result["columns"] = {name: column[row] for name, column in self._result["columns"].items()}
        result["status"] = self.status[row]
        result["final"] = {name: value[row] for name, value in self._result["final"].items()}
        result["per_trajectory"] = {name: value[row] for name, value in self.per_trajectory.items()}
        own = {name: int(value[index]) for name, value in self.per_trajectory.items() if name in self._result["stats"]}
        result["stats"] = {**self._result["stats"], **own}
        return Trajectory(self.ensemble[index], result)

    def __iter__(self) -> Iterator[Trajectory]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        failed = int(np.count_nonzero(self.status))
        return f"EnsembleTrajectory({len(self)} copies, {len(self.t)} times, {failed} failed)"

    def _column(self, name: str) -> NDArray[np.float64]:
        if name not in self._columns:
            # A copy's own property computes it, or says what to record.
            self._columns[name] = np.stack([getattr(trajectory, name) for trajectory in self])
        return self._columns[name]

    @property
    def position(self) -> NDArray[np.float64]:
        """Positions, shape (B, T, N, 3)."""
        return self._column("position")

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities, shape (B, T, N, 3)."""
        return self._column("velocity")

    @property
    def energy(self) -> NDArray[np.float64]:
        """Total energies, shape (B, T)."""
        return self._column("energy")

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Total momenta, shape (B, T, 3)."""
        return self._column("momentum")

    @property
    def angular_momentum(self) -> NDArray[np.float64]:
        """Total angular momenta about the origin, shape (B, T, 3)."""
        return self._column("angular_momentum")

    @property
    def center_of_mass(self) -> NDArray[np.float64]:
        """Centres of mass, shape (B, T, 3)."""
        return self._column("center_of_mass")

    @property
    def recorded(self) -> tuple[str, ...]:
        """Names of the recorded columns."""
        return tuple(self._result["columns"])

    @property
    def status(self) -> NDArray[np.int8]:
        """How each copy ended, values of `Status`, shape (B,)."""
        status: NDArray[np.int8] = self._result["status"]
        return status

    @property
    def stats(self) -> Stats:
        """What the run cost in total."""
        return Stats._from_core(self._result["stats"])

    @property
    def per_trajectory(self) -> dict[str, NDArray[Any]]:
        """What each copy cost: ``steps``, ``evaluations``, …, each of shape (B,)."""
        return dict(self._result["per_trajectory"])

    @property
    def plan(self) -> Plan:
        """What ran, what was skipped, and why."""
        return Plan._from_core(self._result["plan"])

    @property
    def final(self) -> EnsembleScene:
        """The copies at the last time, ready to run on.

        Raises
        ------
        visviva.InvalidInput
            If copies failed, so that they do not share a time; ``out[i].final`` works for each.
        """
        if self.status.any():
            failed = np.flatnonzero(self.status)[:8].tolist()
            raise InvalidInput("final", f"copies {failed} failed, so the copies do not share a time; use out[i].final")
        last = self._result["final"]
        shared = self.ensemble.scene.with_state(last["position"][0], last["velocity"][0], float(last["t"][0]))
        return EnsembleScene(shared, position=last["position"], velocity=last["velocity"], mass=self.ensemble.mass)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one ``.npz`` file that this and every later version loads."""
        from visviva.io import save

        save(path, self)


def _rebuild(
    scene: Scene, position: NDArray[np.float64], velocity: NDArray[np.float64], mass: NDArray[np.float64]
) -> EnsembleScene:
    return EnsembleScene(scene, position=position, velocity=velocity, mass=mass)
