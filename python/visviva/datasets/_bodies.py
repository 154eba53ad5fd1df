"""What data sets of bodies have in common: numbers, their source, and the particles and the scene they make."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from visviva._html import Sheet, Shown
from visviva._text import count
from visviva.forces import Gravity
from visviva.particles import Particles
from visviva.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Bodies", "columns", "read_only"]


@dataclass(frozen=True, eq=False, repr=False)
class Bodies(Shown):
    """Named bodies that attract each other, as somebody published them."""

    names: tuple[str, ...]
    mass: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    G: float
    epoch: str
    source: str

    def __repr__(self) -> str:
        first, last = self.names[0], self.names[-1]
        return f"{type(self).__name__}({count(len(self.names), 'body', 'bodies')}: {first}, …, {last}; {self.epoch})"

    def _sheet(self) -> Sheet:
        bodies = self.particles._sheet()
        return replace(bodies, caption=f"{type(self).__name__}, {self.epoch}, G = {self.G:.10g}", note=self.source)

    @property
    def particles(self) -> Particles:
        """The bodies, with their names.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.datasets.outer_solar_system().particles
        Particles(6 bodies: Sun, Jupiter, Saturn, Uranus, Neptune, Pluto)
        """
        return Particles(self.mass, self.position, self.velocity, self.names)

    @property
    def scene(self) -> Scene:
        """The bodies under their gravity, as the arrays have them, positions of shape (6, 3) or (9, 3).

        Examples
        --------
        >>> import visviva as vv
        >>> len(vv.datasets.outer_solar_system().scene.particles)
        6
        """
        return Scene(self.particles, Gravity(self.G))


def columns(
    mass: object, position: object, velocity: object
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Read-only arrays of all bodies."""
    return read_only(mass), read_only(position), read_only(velocity)


def read_only(values: object) -> NDArray[np.float64]:
    """Numbers as an array that nobody can change."""
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array
