"""The motion of one body of a run: views of its rows of the columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva._arrays import whole_number
from visviva._html import Sheet, Shown, briefly
from visviva._keywords import frozen, known_keywords
from visviva._made_by import made_by
from visviva._names import body_label
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from visviva.body_turning import BodyTurning
    from visviva.orbits import Elements
    from visviva.recorded import Recorded

__all__ = ["BodyMotion"]


@known_keywords
@frozen
class BodyMotion(Shown):
    """The motion of one body. Made by indexing a run with a name, or by ``out.body``.

    Units: those of the scene; angles in radians.

    Attributes
    ----------
    index : int
        Which body of the scene it is.
    name : str
        Its name; ``"body 3"`` where the particles have none.
    t : ndarray, shape (T,)

    Arrays are views of the run's, read-only, with a leading axis B of an ensemble.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.datasets.outer_solar_system().scene.run(t=[0.0, 1000.0], method="dop853")
    >>> out["Jupiter"]
    BodyMotion('Jupiter', 2 times)
    >>> out["Jupiter"].elements(about="Sun").eccentricity.round(3).tolist()
    [0.048, 0.048]
    """

    __slots__ = ("_run", "index", "name", "t")

    index: int
    name: str
    t: NDArray[np.float64]
    _run: Recorded

    def __init__(self, run: Recorded, index: int) -> None:
        from visviva.recorded import Recorded

        made_by(self, "out.body(name) of a run", run=(run, Recorded))
        index = whole_number("index", index, 0, run._start._keywords["mass"].shape[-1] - 1)
        for attribute, value in {
            "_run": run,
            "index": index,
            "name": body_label(index, run._start._names),
            "t": run.t,
        }.items():
            object.__setattr__(self, attribute, value)

    def __repr__(self) -> str:
        return f"BodyMotion({self.name!r}, {len(self.t)} times)"

    def _sheet(self) -> Sheet:
        run, place = self._run, self.index
        span = f", {self.t[0]:g} to {self.t[-1]:g}" if len(self.t) else ""
        rows = [("of", repr(run)), ("body", f"number {place}"), ("mass", briefly(self.mass))]
        return Sheet(f"Motion of {self.name}", [*rows, ("times", f"{len(self.t)}{span}")])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._run, self.index)

    @property
    def mass(self) -> NDArray[np.float64]:
        """Its mass at the start, in the units of the scene: a number, shape (), or of an ensemble shape (B,).

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.body(1).mass.item()
        0.5
        """
        mass: NDArray[np.float64] = self._run._start._keywords["mass"][..., self.index]
        return mass if self._run._start._is_ensemble else mass[0]

    @property
    def position(self) -> NDArray[np.float64]:
        """Positions, shape (T, 3), or (B, T, 3), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.body(1).position.shape
        (2, 3)
        """
        return self._run.position[..., self.index, :]

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities, shape (T, 3), or (B, T, 3), in the units of the scene.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.body(1).velocity.shape
        (2, 3)
        """
        return self._run.velocity[..., self.index, :]

    @property
    def orientation(self) -> NDArray[np.float64]:
        """Of a rigid body: quaternions (x, y, z, w) from the body to space, shape (T, 4), or (B, T, 4).

        Without dimension.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out["book"].orientation.shape
        (6, 4)
        """
        return self._run.orientation[..., self._place, :]

    @property
    def angular_velocity(self) -> NDArray[np.float64]:
        """Of a rigid body: along its axes, shape (T, 3), or (B, T, 3), in radians per time of the scene.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out["book"].angular_velocity[0]
        array([0.1, 1. , 0. ])
        """
        return self._run.angular_velocity[..., self._place, :]

    @property
    def turning(self) -> BodyTurning:
        """Of a rigid body: angular momentum, energy, and pictures, along its principal axes.

        Arrays have a first axis T; moments have shape (3,).

        Raises
        ------
        visviva.InvalidInput
            If it is a particle, or the run is that of an ensemble.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> book = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name="book")
        >>> out = vv.Scene(book).run(t=np.linspace(0.0, 5.0, 6))
        >>> out["book"].turning.moments
        array([1. , 2. , 2.5])
        """
        from visviva.body_turning import BodyTurning

        return BodyTurning(self)

    @property
    def _place(self) -> int:
        """Its place among the rigid bodies."""
        scene = self._run._scene
        particles = len(scene.particles) - (0 if scene.rigid_bodies is None else len(scene.rigid_bodies))
        if self.index < particles:
            raise InvalidInput("body", f"expected a rigid body, but {self.name} is a particle")
        return self.index - particles

    def elements(self, *, about: str | int = 0, G: float | None = None) -> Elements:
        """Its osculating elements at the output times, as of `Trajectory.elements`.

        Parameters
        ----------
        about : str or int, optional
            What it orbits: a body, ``"jacobi"`` or ``"center_of_mass"``.
        G : float, optional
            The gravitational constant in the units of the scene; by default that of the scene's `Gravity`.

        Returns
        -------
        Elements
            Arrays of shape (T,), or (B, T), in the units of the scene; angles in radians.

        Raises
        ------
        visviva.InvalidInput
            As of `Trajectory.elements`.

        References
        ----------
        Murray & Dermott, *Solar System Dynamics* (1999), § 2.8; § 9.7 for Jacobi coordinates.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.problems.kepler(e=0.5).scene.run(t=[0.0, 1.0])
        >>> out.body(1).elements(about=0).eccentricity.round(12).tolist()
        [0.5, 0.5]
        """
        return self._run.elements(self.index, about=about, G=G)


def __dir__() -> list[str]:
    return list(__all__)
