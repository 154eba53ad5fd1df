"""The histogram of one quantity of ions and a foil.

The one idea: of each bin it keeps whole numbers, how many events and the sums of their weights and squares in units, so
that histograms add up bit for bit; parts of all ions and their errors follow when they are read.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

import numpy as np

from visviva._html import Record, brief_tuple
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva.errors import InvalidInput
from visviva.scattering._counts import plot_foil
from visviva.scattering._exported import OfOneQuantity
from visviva.scattering._weights import read_only

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from visviva.typing import FoilTallyName

_T = TypeVar("_T", float, "NDArray[np.float64]")

__all__ = ["FoilTally", "Fraction", "summed"]


@known_keywords
class Fraction(NamedTuple, Generic[_T]):
    """A part of all ions, and its standard error.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
    >>> part = out.fraction("transmitted")
    >>> round(part.value * 1000) == out.transmitted, bool(part.error < 0.02)
    (True, True)
    """

    value: _T
    """As a part of the events."""
    error: _T
    """One standard deviation."""

    def __repr__(self: Fraction[Any]) -> str:
        return brief_tuple(self)


def summed(sums: NDArray[np.uint64], units: tuple[float, float], n_events: int) -> tuple[Any, Any]:
    """The sum of the weights of all events, and its variance."""
    weight, square = sums[..., 1] * units[0], sums[..., 2] * units[1]
    return weight, np.maximum(square - weight**2 / n_events, 0.0)


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class FoilTally(OfOneQuantity, Record):  # noqa: PLW1641 — it holds arrays, which have no hash
    """A histogram of one quantity. Bin i holds ``edges[i] ≤ x < edges[i+1]``; the last one also its end.

    Attributes
    ----------
    name : str
        The quantity.
    edges : ndarray, shape (B + 1,)
        Strictly increasing; radians, eV or µm.
    sums : ndarray of uint64, shape (B + 2, 3)
        Below the edges, of each bin, and above: events, weights and their squares, the last two in `units`.
    units : tuple of float
        Of weights and of squares; 1 where nothing is forced.
    n_events : int
        Of the run.

    References
    ----------
    F. James, *Statistical Methods in Experimental Physics*, 2nd ed. (2006), ch. 4 (binomial and multinomial counts).

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
    >>> tally = out["transmitted_angle"]
    >>> int(tally.counts.sum()) <= out.transmitted
    True
    """

    name: FoilTallyName
    edges: NDArray[np.float64]
    sums: NDArray[np.uint64]
    units: tuple[float, float]
    n_events: int

    def __post_init__(self) -> None:
        arrays = {"edges": self.edges, "sums": self.sums}
        made_by(self, "a run of a Foil", **{name: (array, np.ndarray) for name, array in arrays.items()})
        read_only(*arrays.values())

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # a pickle does not keep that arrays are read-only

    @property
    def counts(self) -> NDArray[np.uint64]:
        """Events per bin, shape (B,), numbers without dimension."""
        return self.sums[1:-1, 0]

    @property
    def underflow(self) -> int:
        """Events below the first edge.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> out["transmitted_angle"].underflow
        0
        """
        return int(self.sums[0, 0])

    @property
    def overflow(self) -> int:
        """Events above the last edge.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> out["transmitted_angle"].overflow
        0
        """
        return int(self.sums[-1, 0])

    def values(self) -> NDArray[np.float64]:
        """Number of ions in each bin: counts, or with a forced collision the sums of their weights.

        Returns
        -------
        ndarray, shape (B,)
            Without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> tally = out["transmitted_angle"]
        >>> bool((tally.values() == tally.counts).all())
        True
        """
        return np.asarray(summed(self.sums[1:-1], self.units, self.n_events)[0])

    def variances(self) -> NDArray[np.float64]:
        """Variances of `values`: the number of events is fixed.

        Returns
        -------
        ndarray, shape (B,)
            Without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> out["transmitted_angle"].variances().shape == out["transmitted_angle"].counts.shape
        True
        """
        return np.asarray(summed(self.sums[1:-1], self.units, self.n_events)[1])

    def fraction(self) -> Fraction[NDArray[np.float64]]:
        """The fraction of all incident ions that each bin holds, with its standard error.

        Returns
        -------
        Fraction
            Of arrays, shape (B,), without dimension: the part in each bin and its standard error.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> part = out["transmitted_angle"].fraction()
        >>> bool((part.value == out["transmitted_angle"].counts / 1000).all())
        True
        """
        return Fraction(self.values() / self.n_events, np.sqrt(self.variances()) / self.n_events)

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the histogram, with a band of one standard error.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure, ``.figure`` of what is returned.

        Returns
        -------
        matplotlib.axes.Axes
            On a logarithmic scale for angles; it ends with the bins that have counted something.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> out = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=1000, seed=1)
        >>> out["transmitted_energy"].plot().get_xlabel()
        'energy of transmitted ions [eV]'
        """
        return plot_foil(self, ax)

    def _axes(self) -> tuple[tuple[str, NDArray[np.float64]], ...]:
        return ((self.name, self.edges),)

    def _whole(self) -> NDArray[np.uint64]:
        return self.sums[:, 0]

    def _whole_weighted(self, power: int) -> NDArray[np.float64]:
        return np.asarray(self.sums[:, power] * self.units[power - 1])

    @property
    def _is_weighted(self) -> bool:
        return self.units != (1.0, 1.0)

    def _about(self) -> dict[str, int]:
        return {name: getattr(self, name) for name in ("underflow", "overflow", "n_events")}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FoilTally):
            return NotImplemented
        same = (self.name, self.units, self.n_events) == (other.name, other.units, other.n_events)
        return same and np.array_equal(self.edges, other.edges) and np.array_equal(self.sums, other.sums)

    def _joined(self, other: FoilTally) -> FoilTally:
        """Of both; that no event is in both is the result's to see."""
        if self.units != other.units or not np.array_equal(self.edges, other.edges):
            raise InvalidInput("other", f"expected {self.name} with the same edges")
        return replace(self, sums=self.sums + other.sums, n_events=self.n_events + other.n_events)
