"""Many copies of a scene in one run. Each copy gets the bits it would get alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, overload

import numpy as np

from visviva._arrays import float_array, mass_array, radius_array, read_only
from visviva._continuation import continuation_of_copies, with_continuation
from visviva._html import Sheet
from visviva._keywords import frozen, known_keywords
from visviva._made_by import made_by
from visviva._own_forces import Acting, described, forces_of_copies
from visviva._rigid_copies import (
    checked_inertia,
    checked_turning,
    core_rigid_of_copies,
    inertia_of_one,
    turning_of_copies,
)
from visviva._some_copies import each_of, one_or_some, rows_of
from visviva._text import count
from visviva.ensemble_trajectory import EnsembleTrajectory
from visviva.errors import InvalidInput
from visviva.request import StreamRequest, asked_by
from visviva.runnable import Runnable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import ArrayLike, NDArray

    from visviva import _core
    from visviva._body_force import BodyForce
    from visviva._some_copies import One, Some
    from visviva.forces import Force
    from visviva.request import RunRequest
    from visviva.scene import Scene

__all__ = ["EnsembleScene"]


@known_keywords
@frozen
class EnsembleScene(Runnable["EnsembleTrajectory"]):
    """B copies of a scene. Made by `Scene.ensemble`.

    Units: those of the scene.

    Attributes
    ----------
    scene : Scene
        The forces, the time, and whatever the copies share.
    mass : ndarray, shape (B, N)
    position, velocity : ndarray, shape (B, N, 3)
    radius : ndarray, shape (B, N)
    forces : tuple of tuple of Force
        Those on points of each copy.
    body_forces : tuple of tuple
        Those on rigid bodies of each copy.

    Indexing with a number gives the `Scene` of one copy. A slice, a list or array of numbers, or a mask of shape (B,)
    gives the ensemble of these copies, which may be taken more than once.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> scene = vv.problems.kepler(e=0.5).scene
    >>> copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.9])[:, None, None])
    >>> len(copies), copies.position.shape, copies[1] == scene
    (2, (2, 2, 3), False)
    >>> copies[[1, 0, 1]].mass.shape, copies[np.array([False, True])][0] == copies[1]
    ((3, 2), True)
    """

    __slots__ = ("_inertia", "_keywords", "body_forces", "forces", "mass", "position", "radius", "scene", "velocity")

    _is_ensemble = True

    scene: Scene
    mass: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    radius: NDArray[np.float64]
    forces: tuple[tuple[Force, ...], ...]
    body_forces: tuple[tuple[BodyForce, ...], ...]
    _inertia: dict[str, NDArray[np.float64]]

    def __init__(
        self,
        scene: Scene,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        mass: ArrayLike | None = None,
        radius: ArrayLike | None = None,
        parameters: Mapping[Force | BodyForce | int | str, Mapping[str, ArrayLike]] | None = None,
        orientation: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        moments: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> None:
        from visviva.scene import Scene

        made_by(self, "scene.ensemble(...)", scene=(scene, Scene))
        self._set(
            scene,
            None if parameters is None else forces_of_copies(scene, parameters),
            position=position,
            velocity=velocity,
            mass=mass,
            radius=radius,
            orientation=orientation,
            angular_velocity=angular_velocity,
            moments=moments,
            inertia=inertia,
        )

    @classmethod
    def _of(cls, scene: Scene, acting: Acting, **own: ArrayLike | None) -> EnsembleScene:
        """Copies in which this acts, and that have this of their own."""
        copies = object.__new__(cls)
        copies._set(scene, acting, **own)
        return copies

    def _like(self, scene: Scene, **own: ArrayLike | None) -> EnsembleScene:
        """Copies in which acts what acts in these."""
        return self._of(scene, Acting(self.forces, self.body_forces), **own)

    def _set(
        self,
        scene: Scene,
        acting: Acting | None,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        mass: ArrayLike | None = None,
        radius: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        moments: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> None:
        own = {name: getattr(scene.particles, name) for name in ("mass", "position", "velocity", "radius")}
        given = {
            name: read_only(float_array(name, value, ("B", *own[name].shape)), value)
            for name, value in (("position", position), ("velocity", velocity))
            if value is not None
        }
        if mass is not None:
            given["mass"] = read_only(mass_array(mass, ("B", *own["mass"].shape)), mass)
        if radius is not None:
            each = float_array("radius", radius, ("B", *own["radius"].shape))
            given["radius"] = read_only(radius_array(each, each.shape), radius)
        turning = checked_turning(scene, orientation, angular_velocity)
        own_inertia = checked_inertia(scene, moments, inertia)
        lengths = {name: array.shape[0] for name, array in (given | turning | own_inertia).items()}
        if acting is not None:
            lengths["parameters"] = len(acting.forces)
        if not lengths:
            raise InvalidInput(
                "position",
                "expected position, velocity, mass, radius or parameters with a leading axis over the copies, or of "
                "rigid bodies orientation, angular_velocity, moments or inertia, got none",
            )
        first, count = next(iter(lengths.items()))
        for name, length in lengths.items():
            if length != count:
                raise InvalidInput(name, f"expected {count} copies like {first}, got {length}")
        if count == 0:
            raise InvalidInput(first, "expected at least one copy, got none")
        full = {
            name: given[name] if name in given else read_only(np.broadcast_to(array, (count, *array.shape)).copy())
            for name, array in own.items()
        }
        forces, own_forces = (scene._keywords["forces"], None) if acting is None else described(acting.forces)
        loads = None if acting is None else acting.loads
        rigid = core_rigid_of_copies(scene, count, loads, turning, own_inertia, full, given=frozenset(given))
        prepared: _core._Scene = {
            "mass": full["mass"],
            "position": full["position"],
            "velocity": full["velocity"],
            # Some copies may be of points: who says so knows of radii.
            "radius": full["radius"] if radius is not None or full["radius"].any() else None,
            "rigid": rigid,
            "forces": forces,
            "own_forces": own_forces,
            "t0": scene.t0,
            "continuation": None,
        }
        acting = acting or Acting((scene.forces,) * count, (scene.body_forces,) * count)
        state = {"scene": scene, **full, "forces": acting.forces, "body_forces": acting.loads}
        for name, value in {**state, "_keywords": prepared, "_inertia": own_inertia}.items():
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.mass)

    @overload
    def __getitem__(self, index: One) -> Scene: ...
    @overload
    def __getitem__(self, index: Some) -> EnsembleScene: ...
    def __getitem__(self, index: One | Some) -> Scene | EnsembleScene:
        chosen = one_or_some(index, len(self))
        state = {name: getattr(self, name)[chosen] for name in ("mass", "position", "velocity", "radius")}
        own = turning_of_copies(self._keywords, chosen)
        inertia: dict[str, Any] = {name: each[chosen] for name, each in self._inertia.items()}
        continuation = continuation_of_copies(self._keywords["continuation"], rows_of(chosen))
        if not isinstance(chosen, int):
            if self._keywords["radius"] is None:
                del state["radius"]
            acting = Acting(each_of(self.forces, chosen), each_of(self.body_forces, chosen))
            return with_continuation(EnsembleScene._of(self.scene, acting, **state, **own, **inertia), continuation)
        bodies = self.scene.particles._in_state(**{name: read_only(array) for name, array in state.items()})
        told = self._keywords["forces"]
        if self._keywords["own_forces"] is not None:
            sets, which = self._keywords["own_forces"]
            told = sets[which[chosen]]
        own |= inertia_of_one(inertia)
        loads = self.body_forces[chosen]
        copy = self.scene._like(bodies, self.forces[chosen], self.scene.t0, told=told, loads=loads, **own)
        if self._keywords["radius"] is not None:
            copy._keywords["radius"] = bodies.radius[None]
        return with_continuation(copy, continuation)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            from visviva.scene import Scene

            known = f"; each copy has one: ensemble[i].{name}" if hasattr(Scene, name) else ""
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}{known}", name=name, obj=self
            )

    def __iter__(self) -> Iterator[Scene]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        return f"EnsembleScene({count(len(self), 'copy', 'copies')} of {self.scene!r})"

    def _sheet(self) -> Sheet:
        of = self.scene._sheet()
        return Sheet(f"{count(len(self), 'copy', 'copies')} of a scene at t0 = {self.scene.t0:g}", of.rows)

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.position, self.velocity, self.mass)
        own = turning_of_copies(self._keywords, slice(None)) | self._inertia
        radius = self._keywords["radius"]
        return _rebuild, (
            self.scene,
            *state,
            self._keywords["continuation"],
            self.forces,
            radius,
            own,
            self.body_forces,
        )

    @property
    def _names(self) -> tuple[str, ...]:
        return self.scene.particles.names

    def _execute(self, request: RunRequest) -> EnsembleTrajectory:
        if request.save_every is not None or request.save_to is not None:
            raise InvalidInput(
                "save_every",
                "an ensemble is not written in stretches of time; run_to_parquet writes it some copies at a time",
            )
        if request.executor is None:
            return super()._execute(request)
        from visviva._copies_apart import run_apart

        return run_apart(self, request)

    @asked_by(StreamRequest)
    def run_to_parquet(self, request: StreamRequest) -> NDArray[np.int8]:
        """Run the copies into a Parquet file, some at a time, in memory that does not grow with their number.

        Parameters
        ----------
        t, method, dt, time_transformation, rtol, atol, max_step, max_steps, record, collisions, restitution, threads
            As of `run`, in the units of the scene; `record` is what the file holds, with the same bits.
        events
            As of `run`. What ends copies ends them here, too; the tables of events and collisions are not kept.
        to : path-like
            The file, exactly as named; one that exists is replaced. Its columns are those of
            `EnsembleTrajectory.to_parquet`.
        copies_at_once : int, optional
            How many copies are run before they are written; by default what takes about 32 MB, but at least 8.
        progress : bool or callable, optional
            As of `run`; copies are counted.

        Returns
        -------
        ndarray of int8, shape (B,)
            How each copy ended, values of `Status`; the rows in the file have it, too.

        Raises
        ------
        visviva.MissingPackage
            Without the package pyarrow: ``pip install 'visviva[parquet]'``.
        visviva.InvalidInput
            As `run`, and for what is no path; there is no file then.
        visviva.Interrupted
            After Ctrl-C. The file holds the copies before the number in the message.

        Warns
        -----
        visviva.AccuracyWarning
            As `run`, once for all copies.

        Examples
        --------
        >>> import pathlib, tempfile, numpy as np, pyarrow.parquet, visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> copies = scene.ensemble(velocity=scene.particles.velocity * np.linspace(0.9, 1.0, 100)[:, None, None])
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "copies.parquet"
        >>> status = copies.run_to_parquet(t=[0.0, 1.0], record="energy", to=path, copies_at_once=32)
        >>> file = pyarrow.parquet.ParquetFile(path)
        >>> file.metadata.num_rows, file.metadata.num_row_groups, status.any()
        (200, 4, np.False_)
        """
        from visviva._streamed import run_streamed

        return run_streamed(self, request)

    def _finished(self, result: dict[str, Any]) -> EnsembleTrajectory:
        return EnsembleTrajectory(self, result)


def _rebuild(
    scene: Scene,
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    mass: NDArray[np.float64],
    continuation: _core._Continuation | None,
    forces: tuple[tuple[Force, ...], ...],
    radius: NDArray[np.float64] | None,
    turning: dict[str, NDArray[np.float64]],
    loads: tuple[tuple[BodyForce, ...], ...],
) -> EnsembleScene:
    state = {"position": position, "velocity": velocity, "mass": mass, "radius": radius}
    return with_continuation(EnsembleScene._of(scene, Acting(forces, loads), **state, **turning), continuation)


def __dir__() -> list[str]:
    return list(__all__)
