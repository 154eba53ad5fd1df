"""The collisions of a run, as a table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._exported import ByColumns, Columns, chosen_columns
from visviva._html import Sheet, Shown, first_rows
from visviva._keywords import known_keywords
from visviva._text import count
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn

    from numpy.typing import ArrayLike, NDArray

    from visviva.typing import CollisionColumnName

__all__ = ["CollisionTable"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class CollisionTable(ByColumns["CollisionColumnName"], Shown):
    """The collisions of spheres in a run, in the order of the motion; of an ensemble, copy after copy.

    Units: those of the scene.

    Attributes
    ----------
    t : ndarray, shape (K,)
    first, second : ndarray of int64, shape (K,)
        The two bodies, ``first < second``.
    speed : ndarray, shape (K,)
        How fast they approached along the line of their centers; 0 of spheres that only graze each other.
    position : ndarray, shape (K, 3)
        Where they touched.
    energy_lost : ndarray, shape (K,)
        The kinetic energy that was lost: ½μ·speed²·(1 − restitution²) of a bounce, ½μ·(relative speed)² of a merger.
        The potential energy that two bodies had of each other goes with a merger, too, and is not in it.
    survivor : ndarray of int64, shape (K,)
        The body that is left of both, if they merged, else -1.
    member : ndarray of int64, shape (K,)
        The copy of an ensemble; 0 of a single run.

    Indexing with a slice or an array gives a smaller table. Tables are equal if all their columns are.

    References
    ----------
    M. P. Allen & D. J. Tildesley, *Computer Simulation of Liquids* (1987), § 3.6.1 (hard spheres).

    Examples
    --------
    >>> import visviva as vv
    >>> balls = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    >>> table = vv.Scene(balls).run(t=4.0, collisions="bounce").collisions
    >>> table.t.round(12).tolist(), table.speed.tolist(), table.position.tolist()
    ([1.5], [2.0], [[0.0, 0.0, 0.0]])
    """

    t: NDArray[np.float64]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    speed: NDArray[np.float64]
    position: NDArray[np.float64]
    energy_lost: NDArray[np.float64]
    survivor: NDArray[np.int64]
    member: NDArray[np.int64]

    _row_axes = ("collision",)

    @classmethod
    def _from_core(cls, found: dict[str, NDArray[Any]]) -> CollisionTable:
        for array in found.values():
            array.setflags(write=False)
        return cls(**found)

    def _exported(self, columns: CollisionColumnName | Sequence[CollisionColumnName] | None) -> Columns:
        names = chosen_columns(columns, self.__slots__, self.__slots__)
        of = {name: (("collision", *["component"] * (name == "position")), getattr(self, name)) for name in names}
        return Columns({"collision": np.arange(len(self))}, of)

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"CollisionTable({count(len(self), 'collision')})"

    def _sheet(self) -> Sheet:
        columns = (self.t, self.first, self.second, self.speed, self.energy_lost, self.survivor, self.member)
        rows, note = first_rows(len(self), lambda at: (str(at), *(f"{column[at]:.6g}" for column in columns)))
        header = ("", "t", "first", "second", "speed", "energy lost", "survivor", "copy")
        return Sheet(f"Collisions: {len(self)}", rows, header, note)

    def __getitem__(self, chosen: slice | ArrayLike) -> CollisionTable:
        if not isinstance(chosen, slice) and np.ndim(chosen) == 0:
            raise InvalidInput("index", f"expected a slice or an array, got {chosen!r}; use its columns, table.t[i]")
        return CollisionTable._from_core({name: getattr(self, name)[chosen] for name in self.__slots__})

    def __iter__(self) -> NoReturn:
        raise TypeError("a CollisionTable is read by its columns: t, first, second, speed, position, energy_lost, …")


def __dir__() -> list[str]:
    return list(__all__)
