"""Elements of many orbits as tables: a row for each orbit, under what the orbits are told apart by.

The one idea: elements that come of a run know its times and its bodies; all others are counted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._exported import ByColumns, Columns, chosen_columns

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from visviva.typing import ElementName

__all__ = ["OfOrbits"]

# What follows from the fields, and can be asked for by name.
FURTHER = ("longitude_of_ascending_node", "longitude_of_pericenter", "mean_longitude")
# Of these every value is an angle; the other anomalies are none of a parabola and a hyperbola.
ANGLES = (
    *("inclination", "node", "argument_of_pericenter", "true_anomaly", "turning_angle"),
    *("longitude_of_ascending_node", "longitude_of_pericenter"),
)


class OfOrbits(ByColumns["ElementName"]):
    """Base of what has one value, or one vector, for each of several orbits."""

    __slots__ = ("_axes",)

    _axes: Mapping[str, NDArray[Any]]
    mu: NDArray[np.float64]

    def _along(self, axes: Mapping[str, NDArray[Any]]) -> None:
        """Say what stands along the axes of the orbits."""
        object.__setattr__(self, "_axes", dict(axes))

    def _labels(self) -> Mapping[str, NDArray[Any]]:
        """The axes of the orbits, of which there is at least one: a single orbit is a row, too."""
        known = getattr(self, "_axes", {})
        shape = np.shape(self.mu) or (1,)
        if known:
            return known
        names = ("orbit",) if len(shape) == 1 else tuple(f"orbit_{axis}" for axis in range(len(shape)))
        return {name: np.arange(length) for name, length in zip(names, shape, strict=True)}

    @property
    def _row_axes(self) -> tuple[str, ...]:
        return tuple(self._labels())

    def _exported(self, columns: ElementName | Sequence[ElementName] | None) -> Columns:
        axes = self._labels()
        shape = tuple(map(len, axes.values()))
        own = tuple(type(self).__slots__)
        of: dict[str, tuple[tuple[str, ...], NDArray[Any]]] = {}
        for name in chosen_columns(columns, own, (*own, *FURTHER)):
            values = np.asarray(getattr(self, name))
            vector = values.ndim > np.ndim(self.mu)
            of[name] = ((*axes, *(("component",) if vector else ())), values.reshape(shape + (3,) * vector))
        return Columns(axes, of, units=dict.fromkeys((name for name in of if name in ANGLES), "rad"))
