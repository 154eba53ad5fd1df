"""What a run recorded and found, alike for a trajectory and for an ensemble of them.

Results are read-only, arrays and attributes alike: what is derived from them on first use stays true. A copy of an
array (``out.position.copy()``) may be changed.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._attributes_elsewhere import OF_RUNS
from visviva._column_axes import COLUMN_AXES
from visviva._exported import Columns, Exported, chosen_columns, labels
from visviva._html import Sheet, Shown
from visviva._keywords import frozen, known_keywords
from visviva._names import body_index
from visviva._text import count
from visviva._totals import Totals
from visviva.errors import InvalidInput
from visviva.plan import Plan, plan_as_dict
from visviva.stats import Stats
from visviva.typing import ColumnName

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from numpy.typing import NDArray

    from visviva.body import BodyMotion
    from visviva.collision_table import CollisionTable
    from visviva.events import EventTable
    from visviva.orbits import Elements
    from visviva.runnable import Runnable
    from visviva.scene import Scene

__all__ = ["Recorded"]


@known_keywords
@frozen
class Recorded(Exported[ColumnName], Totals, Shown, ABC):
    """Base of `Trajectory` and `EnsembleTrajectory`: a view of the core's answer, column by column."""

    __slots__ = ("_columns", "_result", "t")

    t: NDArray[np.float64]
    _result: dict[str, Any]
    _columns: dict[str, NDArray[np.float64]]

    def __init__(self, result: dict[str, Any]) -> None:
        # What is handed out is made read-only when it is: a short run must not pay for all of it.
        result["t"].setflags(write=False)
        object.__setattr__(self, "t", result["t"])
        object.__setattr__(self, "_result", result)
        object.__setattr__(self, "_columns", {})

    def __reduce__(self) -> tuple[Any, ...]:
        # By way of the constructor, which makes the arrays read-only again.
        return type(self), (self._start, {**self._result, "plan": plan_as_dict(self._result["plan"])})

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            advice = self._elsewhere(name)
            raise AttributeError(
                f"{type(self).__name__!r} object has no attribute {name!r}{advice}", name=name, obj=self
            )

    def _elsewhere(self, name: str) -> str:
        return f"; it is {OF_RUNS[name]}" if name in OF_RUNS else ""

    @property
    @abstractmethod
    def _start(self) -> Runnable[Any]:
        """What was run."""

    @abstractmethod
    def _found(self, name: str) -> NDArray[np.float64]:
        """The column, recorded or computed; InvalidInput says what to record if it is neither."""

    @property
    @abstractmethod
    def _scene(self) -> Scene:
        """What the copies share: forces, and names of bodies."""

    def _column(self, name: str) -> NDArray[np.float64]:
        if name not in self._columns:
            found = self._found(name)
            found.setflags(write=False)
            # Seen through a read-only buffer: of that nobody can make a writable array again.
            self._columns[name] = np.asarray(found.data.toreadonly()) if found.size else found
        return self._columns[name]

    @property
    def position(self) -> NDArray[np.float64]:
        """Positions, shape (T, N, 3), or (B, T, N, 3) of an ensemble, in the units of the scene."""
        return self._column("position")

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities, shape (T, N, 3), or (B, T, N, 3), in the units of the scene."""
        return self._column("velocity")

    @property
    def orientation(self) -> NDArray[np.float64]:
        """Quaternions (x, y, z, w) of rigid bodies, from the body to space, shape (T, K, 4), or (B, T, K, 4).

        Without dimension.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out.orientation.shape
        (6, 1, 4)
        """
        return self._column("orientation")

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """Angular velocities of rigid bodies along their axes, shape (T, K, 3), or (B, T, K, 3).

        In radians per time of the scene.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out.angular_velocity.shape
        (6, 1, 3)
        """
        return self._column("angular_velocity")

    def body(self, body: str | int) -> BodyMotion:
        """The motion of one body: views of its rows of the columns; ``out["Jupiter"]`` is ``out.body("Jupiter")``.

        Parameters
        ----------
        body : str or int
            Its name, if the particles have names, or its index.

        Returns
        -------
        BodyMotion
            Its columns, in the units of the run, without the axis over the bodies.

        Raises
        ------
        visviva.InvalidInput
            If there is no such body.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.datasets.outer_solar_system().scene.run(t=[0.0, 1000.0], method="dop853")
        >>> out.body(5).name, out["Pluto"].position.shape
        ('Pluto', (2, 3))
        """
        from visviva.body import BodyMotion

        return BodyMotion(self, body_index("body", body, self._start._names, self._start._keywords["mass"].shape[-1]))

    def elements(
        self,
        bodies: str | int | Sequence[str | int] | None = None,
        *,
        about: str | int = 0,
        G: float | None = None,
    ) -> Elements:
        """The osculating elements of bodies at the output times.

        The conic on which a body would go on if at that instant all but what it orbits were gone: of the relative
        position and velocity, with μ = G times the masses of both.

        Parameters
        ----------
        bodies : str or int, or sequence of them, optional
            Names or indices; by default all that orbit something, in their order: all but the body `about`; all but
            the first about "jacobi".
        about : str or int, optional
            The body that they orbit, by name or index. ``"jacobi"``: each orbits the center of mass of all bodies
            before it; ``"center_of_mass"``: that of all the other bodies.
        G : float, optional
            The gravitational constant; by default that of the scene's `Gravity`.

        Returns
        -------
        Elements
            Arrays of shape (T, K) for K bodies, (T,) for one that was given alone, with a leading axis B of an
            ensemble; vectors with a last axis of 3. Angles are in radians, x the reference direction, z the pole. What
            they are for circular, planar, parabolic and radial orbits is said in `visviva.orbits.Elements`. Rows that a
            failed copy of an ensemble does not have are NaN, as its states are; and those of a body after it has merged
            into another, which then has the mass of both, and of copies in which that has merged which they are about.
            Lengths, times and masses are in the units of the scene. In a `RotatingFrame` orbits are those of the
            velocities in an inertial frame, v + Ω × r, seen along the axes of that instant: sizes and shapes stay, and
            angles turn.

        Raises
        ------
        visviva.InvalidInput
            If there is no such body; if a body is at the very place of what it orbits, or neither has mass; if the
            scene has no gravity and no `G` is given; if positions or velocities were not recorded.

        References
        ----------
        Murray & Dermott, *Solar System Dynamics* (1999), § 2.8; § 9.7 for Jacobi coordinates.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.datasets.outer_solar_system().scene.run(t=[0.0, 1e4], method="dop853")
        >>> out.elements(["Jupiter", "Saturn"], about="Sun").semi_major_axis.round(2).tolist()
        [[5.2, 9.54], [5.2, 9.58]]
        """
        from visviva._mergers import parts_and_masses
        from visviva._osculating import elements_of

        merged = parts_and_masses(self) if self._result.get("collisions") else None
        given = {"copy": np.arange(len(self.position)), "time": self.t}
        rows = {axis: given[axis] for axis in self._row_axes}
        return elements_of(self._start, self.position, self.velocity, bodies, about, G, merged, rows)

    @property
    def recorded(self) -> tuple[str, ...]:
        """Names of the recorded columns.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.recorded
        ('position', 'velocity')
        """
        return tuple(self._result["columns"])

    @property
    def events(self) -> EventTable:
        """The events that were found.

        Raises
        ------
        visviva.InvalidInput
            If none were asked for.

        Examples
        --------
        >>> import visviva as vv
        >>> scene = vv.problems.kepler(e=0.5).scene
        >>> len(scene.run(t=20.0, events=[vv.events.apsis(1, 0)]).events)
        6
        """
        if "events" not in self._result:
            raise InvalidInput("events", "no events were looked for; run again with events=[...] of visviva.events")
        from visviva._event_descriptions import from_description
        from visviva.events import EventTable

        # Files of before they were kept have none.
        definitions = tuple(map(from_description, self._result.get("looked_for", ())))
        return EventTable._made(self._result["events"], definitions=definitions, names=self._start._names)

    @property
    def collisions(self) -> CollisionTable:
        """The collisions of spheres, each column of shape (K, …).

        Raises
        ------
        visviva.InvalidInput
            If none were asked for.

        Examples
        --------
        >>> import visviva as vv
        >>> balls = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
        >>> vv.Scene(balls).run(t=4.0, collisions="bounce").collisions.t
        array([1.5])
        """
        if "collisions" not in self._result:
            raise InvalidInput(
                "collisions", 'spheres passed through each other; run again with collisions="bounce", "merge" or "stop"'
            )
        from visviva.collision_table import CollisionTable

        return CollisionTable._from_core(self._result["collisions"])

    @property
    def stats(self) -> Stats:
        """What the run cost; of an ensemble, in total.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.problems.figure_eight().scene.run(t=1.0, method="leapfrog", dt=0.01).stats.steps
        100
        """
        return Stats._from_core(self._result["stats"])

    @property
    def plan(self) -> Plan:
        """What ran, what was skipped, and why.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.problems.figure_eight().scene.run(t=1.0, method="leapfrog", dt=0.01).plan.method
        'leapfrog'
        """
        return Plan._from_core(plan_as_dict(self._result["plan"]))

    def _exported(self, columns: str | Sequence[str] | None) -> Columns:
        rows = self._row_axes
        chosen = chosen_columns(columns, self.recorded, COLUMN_AXES)
        of = {name: ((*rows, *COLUMN_AXES[name]), self._column(name)) for name in chosen}
        own: dict[str, NDArray[Any]] = {"time": self.t}
        rigid = self._scene.rigid_bodies
        names = {"body": self._start._names, "rigid_body": rigid.names if rigid is not None else ()}
        for axes, values in of.values():
            for axis, length in zip(axes, values.shape, strict=True):
                if axis in names:
                    own[axis] = labels(names[axis], length)
                elif axis == "copy":
                    own[axis] = np.arange(length)
        return Columns(own, of, {"method": self.stats.method})

    def _run_sheet(self, caption: str, ended: str) -> Sheet:
        span = f", {self.t[0]:g} to {self.t[-1]:g}" if len(self.t) else ""
        cost = self.stats
        rows = [
            ("of", repr(self._scene)),
            ("times", f"{len(self.t)}{span}"),
            *((name, f"array of shape {self._column(name).shape}") for name in self.recorded),
            ("method", cost.method),
            ("steps", f"{cost.steps}, and {cost.rejected} rejected; {cost.evaluations} force evaluations"),
            ("time", f"{cost.seconds:.2g} s, {count(cost.threads, 'thread')}, {cost.simd}"),
            ("ended", ended),
        ]
        return Sheet(caption, rows)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one ``.npz`` file that this and every later version loads.

        Parameters
        ----------
        path : path-like
            The file, exactly as named.

        Raises
        ------
        visviva.InvalidInput
            For what is no path.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile, visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=1.0)
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "run.npz"
        >>> out.save(path)
        >>> bool((vv.load(path).position == out.position).all())
        True
        """
        from visviva.io import save

        save(path, self)


def __dir__() -> list[str]:
    return list(__all__)
