"""Where a motion passes through a section: the result of ``poincare``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva._exported import Columns, Exported, chosen_columns
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.typing import SectionColumnName

__all__ = ["PoincareSection"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PoincareSection(Record, Exported["SectionColumnName"]):
    """Where a motion passes through a section.

    Units: those of the system.

    Attributes
    ----------
    t : ndarray, shape (C,)
    position, momentum : ndarray, shape (C, n)
    coordinates : tuple of str

    `to_xarray`, `to_pandas` and `to_parquet` hand it over as a table with a row for each passage.

    References
    ----------
    M. Hénon, Physica D 5 (1982) 412.

    Examples
    --------
    >>> import sympy as sp, visviva as vv
    >>> section = vv.systems.henon_heiles().poincare("x", t=100.0)
    >>> section.position.shape[1], float(abs(section.position[:, 0]).max()) < 1e-13
    (2, True)
    >>> section.to_pandas()["position", "y"].shape == section.t.shape
    True
    """

    t: NDArray[np.float64]
    position: NDArray[np.float64]
    momentum: NDArray[np.float64]
    coordinates: tuple[str, ...]

    _row_axes = ("event",)

    def _exported(self, columns: SectionColumnName | Sequence[SectionColumnName] | None) -> Columns:
        known: list[SectionColumnName] = ["t", "position", "momentum"]
        of = {
            name: (("event", *["coordinate"][: getattr(self, name).ndim - 1]), getattr(self, name))
            for name in chosen_columns(columns, known, known)
        }
        return Columns({"event": np.arange(len(self)), "coordinate": np.array(self.coordinates)}, of)

    def __len__(self) -> int:
        return len(self.t)

    def plot(self, name: str | None = None, *, ax: Axes | None = None) -> Axes:
        """Draw the points of a coordinate and its momentum.

        Parameters
        ----------
        name : str, optional
            The coordinate; the last if not given.
        ax : matplotlib.axes.Axes, optional
            Where; a new one if not given.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        InvalidInput
            For a coordinate that is not there, what are no axes, or if matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.systems.henon_heiles().poincare("x", t=50.0).plot("y").get_xlabel()
        'y'
        """
        from visviva.plot import axes_or_new

        name = self.coordinates[-1] if name is None else name
        if not isinstance(name, str) or name not in self.coordinates:
            raise InvalidInput("name", f"there is no coordinate {name!r}; there are {list(self.coordinates)}")
        index = self.coordinates.index(name)
        ax = axes_or_new(ax)
        ax.plot(self.position[:, index], self.momentum[:, index], ".", markersize=2)
        ax.set_xlabel(name)
        ax.set_ylabel(f"momentum of {name}")
        return ax
