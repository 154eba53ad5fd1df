"""What a run gives back: recorded columns, and whatever follows from them on first use."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np

from visviva import _core
from visviva._continuation import continuation_after, with_continuation
from visviva._drawn import Drawn
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.recorded import Recorded
from visviva.status import Status

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva._exported import Columns
    from visviva._html import Sheet
    from visviva.body import BodyMotion
    from visviva.conservation import Conservation
    from visviva.scene import Scene

__all__ = ["Status", "Trajectory"]

_DERIVED = {name: needs_velocity for name, _, _, needs_velocity in _core.columns()}


@known_keywords
class Trajectory(Recorded, Drawn):
    """The motion of a scene at the output times. Made by `Scene.run` and `load`.

    Units: those of the scene; angles in radians.

    Attributes
    ----------
    scene : Scene
        The scene that was run.
    t : ndarray, shape (T,)
        Output times; fewer than asked for if the run failed.
    position, velocity : ndarray, shape (T, N, 3)
    orientation : ndarray, shape (T, K, 4)
        Of rigid bodies: quaternions (x, y, z, w) from the body to space.
    angular_velocity : ndarray, shape (T, K, 3)
        Of rigid bodies, along the body's axes.
    energy, kinetic_energy, potential_energy, virial : ndarray, shape (T,)
    momentum, angular_momentum, center_of_mass : ndarray, shape (T, 3)
        Recorded, or computed from position and velocity on first use. The angular momentum is about
        the origin.
    status : Status
    stats : Stats
    plan : Plan
        What ran and why.
    final : Scene
        The scene at the last state that was reached, ready to run on.

    Every array is read-only; ``out.position.copy()`` is yours. ``out["Jupiter"]`` is the motion of a body that has this
    name.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.problems.kepler(e=0.5).scene.run(t=1.0)
    >>> out.t, out.position.shape, out.status.name
    (array([0., 1.]), (2, 2, 3), 'OK')
    """

    __slots__ = ("scene",)

    scene: Scene

    def __init__(self, scene: Scene, result: dict[str, Any]) -> None:
        # Words only for what is wrong: a closed form at one time must not pay for them.
        if getattr(scene, "_is_ensemble", None) is not False or type(result) is not dict or "t" not in result:
            from visviva.scene import Scene

            made_by(self, "the run of a scene, or visviva.load", scene=(scene, Scene), result=(result, dict))
        super().__init__(result)
        object.__setattr__(self, "scene", scene)

    def __repr__(self) -> str:
        span = f"t = {self.t[0]:g} … {self.t[-1]:g}" if len(self.t) else "empty"
        bodies = count(len(self.scene.particles), "body", "bodies")
        return f"Trajectory({count(len(self.t), 'time')}, {bodies}, {span}, {self.status.name})"

    def _sheet(self) -> Sheet:
        return self._run_sheet("Trajectory", self.status.name)

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, body: str) -> BodyMotion:
        if not isinstance(body, str):
            raise InvalidInput(
                "body", f"expected the name of a body, got {body!r}; times are rows of the columns: out.position[i]"
            )
        return self.body(body)

    def __iter__(self) -> NoReturn:
        raise TypeError("a Trajectory is read by its columns: t, position, velocity, …; out['name'] is a body")

    @property
    def _start(self) -> Scene:
        return self.scene

    @property
    def _scene(self) -> Scene:
        return self.scene

    def _found(self, name: str) -> NDArray[np.float64]:
        recorded = self._result["columns"].get(name)
        if recorded is not None:
            first: NDArray[np.float64] = recorded[0]
            return first
        if name in _DERIVED:
            return self._derive(name)
        raise InvalidInput("record", f"{name} was not recorded; run again with {name!r} in record")

    def _derive(self, name: str, about: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        from visviva._mergers import by_era
        from visviva.invariants import conserved

        needs = ("position", "velocity") if _DERIVED[name] else ("position",)
        missing = [column for column in needs if column not in self._result["columns"]]
        if missing:
            raise InvalidInput(
                "record",
                f"{name} was not recorded and cannot be computed without {' and '.join(missing)}; "
                f"run again with {name!r} or {', '.join(map(repr, needs))} in record",
            )
        point = np.zeros(3) if about is None else about
        if self.scene.rigid_bodies is not None:
            columns = (self.position, self.velocity if _DERIVED[name] else None)
            turning = (self.orientation, self.angular_velocity)
            return conserved(self.scene, *columns, point, [name], turning)[name]

        def told(scene: Scene, position: NDArray[np.float64], velocity: NDArray[np.float64] | None) -> Any:
            return conserved(scene, position, velocity, point, [name])

        return by_era(self, told, velocity="velocity" in needs)[name]

    def _exported(self, columns: str | Sequence[str] | None) -> Columns:
        made = super()._exported(columns)
        return replace(made, attributes={**made.attributes, "status": self.status.name})

    @property
    def status(self) -> Status:
        """How the run ended."""
        return Status(int(self._result["status"][0]))

    @property
    def final(self) -> Scene:
        """The scene at the last state that was reached, ready to run on.

        After fixed steps that ended on a node it keeps, out of sight, what the method holds there: the digits beyond
        float64 and the past of a multistep method. Run on with the same method and `dt`, it goes on to the bits of one
        long run; ``plan`` says so. Anything made from it (``rescaled``, ``with_state``, a `Scene` of its parts) is a
        new scene, and so is it to any other method or step. More than 2^25 numbers, of huge ensembles, are not kept.

        Examples
        --------
        >>> import visviva as vv
        >>> scene, how = vv.problems.figure_eight().scene, {"method": "stormer13", "dt": 0.01}
        >>> in_two = scene.run(t=1.0, **how).final.run(t=2.0, **how)
        >>> bool((in_two.position[-1] == scene.run(t=2.0, **how).position[-1]).all())
        True
        """
        last = self._result["final"]
        turning = {name: last[name][0] for name in ("orientation", "angular_velocity") if name in last}
        scene = self.scene.with_state(last["position"][0], last["velocity"][0], float(last["t"][0]), **turning)
        if "mass" in last:
            own = {name: last[name][0] for name in ("mass", "radius") if name in last}
            scene = scene._like(scene.particles._changed(**own), scene.forces, scene.t0)
        return with_continuation(scene, continuation_after(self.scene._keywords, self._result))

    def angular_momentum_about(self, about: ArrayLike | str) -> NDArray[np.float64]:
        """Angular momentum about a fixed point or about the moving center of mass, shape (T, 3).

        Units: those of the scene.

        Parameters
        ----------
        about : array_like, shape (3,), or "center_of_mass"

        Returns
        -------
        ndarray, shape (T, 3)
            Mass · length² / time, in the units of the scene.

        Raises
        ------
        visviva.InvalidInput
            If position or velocity was not recorded.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=1.0)
        >>> out.angular_momentum_about([1.0, 0.0, 0.0]).shape
        (2, 3)
        """
        from visviva._mergers import by_era
        from visviva.invariants import internal_motion, reference_point

        point = reference_point(about)
        if point is None and self.scene.rigid_bodies is not None:
            turning = (self.orientation, self.angular_velocity)
            return internal_motion(self.scene, self.position, self.velocity, turning)["angular_momentum"]
        if point is None:
            return by_era(self, internal_motion)["angular_momentum"]
        return self._derive("angular_momentum", point)

    def conservation(self, about: ArrayLike | str | None = None) -> Conservation:
        """How well the invariants held: drift of each, as a table.

        Units: those of the scene.

        Parameters
        ----------
        about : array_like, shape (3,), or "center_of_mass", optional
            Reference point of the angular momentum; the origin by default.

        Returns
        -------
        Conservation
            A row for each quantity: its largest, last and rms drift, in the units of the scene and relative to a scale.

        Raises
        ------
        visviva.InvalidInput
            If a quantity was neither recorded nor can be computed; the message says what to record.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2.

        Examples
        --------
        >>> import visviva as vv
        >>> table = vv.problems.kepler(e=0.5).scene.run(t=1.0).conservation()
        >>> table.energy.max < 1e-14
        True
        """
        from visviva.conservation import conservation_of

        return conservation_of(self, about)


def __dir__() -> list[str]:
    return list(__all__)
