"""What a problem is: a scene, how far to run it, and where its bodies must be then."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva._html import Record, Sheet, Shown
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.scene import Scene
from visviva.trajectory import Trajectory

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Problem", "Reference", "reference", "rows"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Reference(Record):
    """Where bodies are at a time.

    Units: those of the problem's scene.

    Attributes
    ----------
    t : float
    bodies : tuple of int
        Which bodies the rows are.
    position : ndarray, shape (len(bodies), 3)

    Examples
    --------
    >>> import visviva as vv
    >>> where = vv.problems.figure_eight().references[-1]
    >>> where.bodies, where.position.shape
    ((0, 1, 2), (3, 3))
    """

    t: float
    bodies: tuple[int, ...]
    position: NDArray[np.float64]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class Problem(Shown):
    """A scene, how far to run it, and what must come out.

    Units: those of the problem's scene.

    Attributes
    ----------
    name, summary : str
    scene : Scene
    t_end : float
        The usual end; a reference is given there.
    references : tuple of Reference
    conditioning : tuple of (float, float)
        (t, factor): a relative change of the input by ε moves a body by about factor · ε at time t
        (largest of a dozen random changes, unless the problem says how it is known).
    source : str

    Examples
    --------
    >>> import visviva as vv
    >>> problem = vv.problems.figure_eight()
    >>> problem.error(problem.scene.run(t=problem.t_end, rtol=1e-12)) < 1e-9
    True
    """

    name: str
    summary: str
    scene: Scene
    t_end: float
    references: tuple[Reference, ...]
    conditioning: tuple[tuple[float, float], ...]
    source: str

    def __repr__(self) -> str:
        return f"Problem({self.name!r}: {self.summary}; to t = {self.t_end:g})"

    def _sheet(self) -> Sheet:
        rows = [("what", self.summary), ("scene", repr(self.scene)), ("end", f"t = {self.t_end:g}")]
        return Sheet(f"Problem: {self.name}", [*rows, ("source", self.source)])

    def error(self, final: Scene | Trajectory) -> float:
        """Largest distance of a body from its reference position at the time of `final`.

        Units: those of the problem's scene.

        Parameters
        ----------
        final : Scene or Trajectory
            A state at the time of one of the references; of a trajectory, the last.

        Returns
        -------
        float
            A length; of a problem without dimension a number.

        Raises
        ------
        visviva.InvalidInput
            If there is no reference at that time.

        Examples
        --------
        >>> import visviva as vv
        >>> problem = vv.problems.kepler(e=0.9)
        >>> problem.error(problem.scene.run(t=problem.t_end)) < 1e-13
        True
        """
        if not isinstance(final, Scene | Trajectory):
            raise InvalidInput("final", f"expected a Scene or a Trajectory, got {type(final).__name__}")
        state = final if isinstance(final, Scene) else final.final
        for reference in self.references:
            if reference.t == state.t0:
                distances = state.particles.position[list(reference.bodies)] - reference.position
                return float(np.linalg.norm(distances, axis=1).max())
        times = ", ".join(repr(reference.t) for reference in self.references)
        raise InvalidInput("final", f"{self.name} has references at t = {times}, got a state at t = {state.t0!r}")


def reference(t: float, position: ArrayLike) -> Reference:
    """All bodies at a time."""
    states = rows(position)
    return Reference(t, tuple(range(len(states))), states)


def rows(position: ArrayLike) -> NDArray[np.float64]:
    """Positions that nobody can write to."""
    states = np.array(position, dtype=float)
    states.flags.writeable = False
    return states
