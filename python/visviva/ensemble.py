"""Many copies of a scene in one run, and what comes back: arrays with a leading axis B.

Each copy gets the bits it would get alone. A copy that fails has a status and NaN from there on; the
others do not notice.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, mass_array
from visviva._keywords import known_keywords
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.particles import Particles
from visviva.recorded import Recorded
from visviva.runnable import Runnable
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray

    from visviva import _core
    from visviva.scene import Scene

__all__ = ["EnsembleScene", "EnsembleTrajectory"]


@known_keywords
class EnsembleScene(Runnable["EnsembleTrajectory"]):
    """B copies of a scene. Made by `Scene.ensemble`.

    Attributes
    ----------
    scene : Scene
        The forces, the time, and whatever the copies share.
    mass : ndarray, shape (B, N)
    position, velocity : ndarray, shape (B, N, 3)

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None])
    >>> len(copies), copies.position.shape, copies[1] == scene
    (2, (2, 2, 3), False)
    """

    __slots__ = ("_keywords", "mass", "position", "scene", "velocity")

    _is_ensemble = True

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
        self._keywords: _core._Scene = {
            "mass": self.mass,
            "position": self.position,
            "velocity": self.velocity,
            "forces": scene._keywords["forces"],
            "t0": scene.t0,
        }

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, index: int) -> Scene:
        from visviva.scene import Scene

        particles = Particles(self.mass[index], self.position[index], self.velocity[index])
        return Scene(particles, *self.scene.forces, t0=self.scene.t0)

    def __iter__(self) -> Iterator[Scene]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        return f"EnsembleScene({count(len(self), 'copy', 'copies')} of {self.scene!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self.scene, self.position, self.velocity, self.mass)

    def _finished(self, result: dict[str, Any]) -> EnsembleTrajectory:
        return EnsembleTrajectory(self, result)


@known_keywords
class EnsembleTrajectory(Recorded):
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

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> out = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None]).run(t=1.0)
    >>> out.position.shape, out[1].position.shape
    ((2, 2, 2, 3), (2, 2, 3))
    """

    __slots__ = ("ensemble",)

    def __init__(self, ensemble: EnsembleScene, result: dict[str, Any]) -> None:
        super().__init__(result)
        self.ensemble = ensemble

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
        copies = count(len(self), "copy", "copies")
        return f"EnsembleTrajectory({copies}, {count(len(self.t), 'time')}, {failed} failed)"

    @property
    def _start(self) -> EnsembleScene:
        return self.ensemble

    def _found(self, name: str) -> NDArray[np.float64]:
        recorded: NDArray[np.float64] | None = self._result["columns"].get(name)
        # A copy's own property computes it, or says what to record.
        return np.stack([getattr(trajectory, name) for trajectory in self]) if recorded is None else recorded

    @property
    def status(self) -> NDArray[np.int8]:
        """How each copy ended, values of `Status`, shape (B,)."""
        status: NDArray[np.int8] = self._result["status"]
        return status

    @property
    def per_trajectory(self) -> dict[str, NDArray[Any]]:
        """What each copy cost: ``steps``, ``evaluations``, …, each of shape (B,)."""
        return dict(self._result["per_trajectory"])

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


def _rebuild(
    scene: Scene, position: NDArray[np.float64], velocity: NDArray[np.float64], mass: NDArray[np.float64]
) -> EnsembleScene:
    return EnsembleScene(scene, position=position, velocity=velocity, mass=mass)
