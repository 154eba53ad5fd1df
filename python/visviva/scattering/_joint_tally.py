"""The integer histogram of two quantities of a beam's events together."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva._made_by import made_by
from visviva._packages import needed
from visviva.errors import InvalidInput
from visviva.scattering._beam import described
from visviva.scattering._beyond import beyond, less_what_is_beyond
from visviva.scattering._counts import plot_joint
from visviva.scattering._exported import OfStrata, intervals
from visviva.scattering._tally import CrossSection, area_of_events, measure, told
from visviva.scattering._weights import added_strata, read_only, same, variances

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray
    from pandas import DataFrame

    from visviva.scattering._beam import Beam
    from visviva.typing import TallyName

__all__ = ["JointTally"]


@known_keywords
@dataclass(frozen=True, eq=False, repr=False)
class JointTally(OfStrata, Record):  # noqa: PLW1641 — as Tally
    """A histogram of two quantities together.

    Units: energies and lengths are those of the potential, masses in one unit, any; angles in radians.

    Attributes
    ----------
    name : tuple of str
        The quantities.
    edges : tuple of ndarray, shapes (B₁ + 1,) and (B₂ + 1,)
        Strictly increasing, of each quantity.
    flow : ndarray of uint64, shape (B₁ + 2, B₂ + 2)
        Events: along each axis below the first edge, the bins, and above the last edge.
    captured : int
        Events that fell into the center.
    beam : Beam
        What was scattered by what.
    events : tuple
        Which events: sorted (seed, first, end) with end excluded.
    by_stratum : ndarray of uint64, shape (S, (B₁ + 2)·(B₂ + 2) + 1), or None
        With `importance` the events of each stratum: those of ``flow``, row by row, and captured.

    References
    ----------
    F. James, *Statistical Methods in Experimental Physics*, 2nd ed. (2006), ch. 4 (binomial and multinomial counts).

    Examples
    --------
    >>> import visviva as vv
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.HardSphere(1.0), tally=[("lab_angle", "energy")], bins=10,
    ...     beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
    >>> run["lab_angle", "energy"].counts.shape
    (10, 10)
    """

    name: tuple[TallyName, TallyName]
    edges: tuple[NDArray[np.float64], ...]
    flow: NDArray[np.uint64]
    captured: int
    beam: Beam
    events: tuple[tuple[int, int, int], ...]
    by_stratum: NDArray[np.uint64] | None = None

    def __post_init__(self) -> None:
        arrays = {"flow": self.flow} | ({} if self.by_stratum is None else {"by_stratum": self.by_stratum})
        each = {name: (array, np.ndarray) for name, array in arrays.items()}
        made_by(self, "visviva.scattering.monte_carlo", edges=(self.edges, tuple), **each)
        read_only(*self.edges, self.flow, self.by_stratum)

    @property
    def counts(self) -> NDArray[np.uint64]:
        """Events in the bins, shape (B₁, B₂), numbers without dimension."""
        return self.flow[1:-1, 1:-1]

    def values(self) -> NDArray[np.float64]:
        """Counts as float64, exact up to 2⁵³; with `importance` Σ w n over the strata, w their weights.

        Returns
        -------
        ndarray, shape (B₁, B₂)
            Without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), tally=[("lab_angle", "energy")], bins=10,
        ...     beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> float(run["lab_angle", "energy"].values().sum())
        1000.0
        """
        return self._whole_weighted(1)[self._inner]

    def variances(self) -> NDArray[np.float64]:
        """Variances of the values, as those of `Tally.variances`.

        Returns
        -------
        ndarray, shape (B₁, B₂)
            Without dimension.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), tally=[("lab_angle", "energy")], bins=10,
        ...     beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run["lab_angle", "energy"].variances().shape
        (10, 10)
        """
        return variances(self.values(), self._whole_weighted(2)[self._inner], self.n_events)

    @property
    def reachable(self) -> NDArray[np.float64]:
        """Of each bin the part whose impact parameters all lie on the disc, shape (B₁, B₂), without dimension.

        A place is reached if either of its two values is: 1 of a bin of which either axis is reached whole, between 0
        and 1 where the edge of the disc cuts both. `Tally.reachable` tells that of one quantity, and what branches of
        the deflection function beyond the disc do to it.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> pair = ("cm_angle", "impact_parameter")
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.Coulomb(1.0), tally={pair: (np.radians([0, 20, 180]), [0.0, 1.0, 2.0])},
        ...     beam_energy=1.0, masses=(1.0, 1e9), b_max=2.0, n_events=1000, seed=1)
        >>> run[pair].reachable
        array([[1., 1.],
               [1., 1.]])
        """
        first, second = self._parts(whole=False)
        return first + second - first * second

    def _parts(self, *, whole: bool) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Of the bins along each axis the part that is reached, or the part of which a cross section is told."""
        # One event: what is reached hangs on the beam and the edges alone.
        axes = list(self._axes())
        single: list[list[tuple[str, Any]]] = [[axis] for axis in axes]
        columns = _core.monte_carlo(
            beam=described(self.beam), n_events=1, seed=0, first_event=0, tallies=single, threads=1, progress=None
        )[4]
        reached = [(np.zeros(0), (0.0, 0.0)) if column[4] is None else column[4] for column in columns]
        parts = [part for part, _ in less_what_is_beyond(self.beam, axes, reached, beyond(self.beam))]
        if whole:
            parts = [told(name, part, self.beam) for name, part in zip(self.name, parts, strict=True)]
        return parts[0][:, None], parts[1][None, :]

    def cross_section(self) -> CrossSection:
        """Differential cross section of both quantities together, averaged over each bin as far as it is reachable.

        As `Tally.cross_section`. Of one energy two quantities lie on a curve: bins beside it are 0, and what bins on it
        tell goes with their size. A bin of which either quantity is reached whole has all its events, also where the
        other is not.

        Returns
        -------
        CrossSection
            (value, error): counts / n_events · π b_max², per steradian for each angle, else per unit of the quantity;
            shape (B₁, B₂), in the units of b_max². Times the solid angles (or widths) of one axis and summed over it,
            it is that of the other where all is reached.

        Raises
        ------
        InvalidInput
            For a beam with a spot, which does not fill the disc evenly.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> pair = ("cm_angle", "recoil_energy")
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), tally={pair: (vv.scattering.Bins.solid_angle(2), 2)},
        ...     beam_energy=1.0, masses=(1.0, 1.0), b_max=1.0, n_events=100_000, seed=1)
        >>> value, error = run[pair].cross_section()
        >>> bool(abs(value[1, 1] - 0.5) < 4 * error[1, 1])  # R²/4 per steradian, all of it above half of the energy
        True
        """
        first, second = self._parts(whole=True)
        widths = measure(self.name[0], self.edges[0])[:, None] * measure(self.name[1], self.edges[1])[None, :]
        scale = area_of_events(self.beam, self.n_events, widths, first + second - first * second)
        return CrossSection(self.values() * scale, np.sqrt(self.variances()) * scale)

    def to_pandas(self) -> DataFrame:
        """As a ``pandas.DataFrame`` of `values`: rows are bins of the first quantity, columns of the second.

        Returns
        -------
        pandas.DataFrame
            Bins are intervals, closed on the left.

        Raises
        ------
        MissingPackage
            Without the package pandas: ``pip install 'visviva[pandas]'``.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), bins=10,
        ...     tally=[("lab_angle", "energy")], beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run["lab_angle", "energy"].to_pandas().shape
        (10, 10)
        """
        rows, columns = map(intervals, self.name, self.edges)
        values = self.counts if self.by_stratum is None else self.values()
        frame: DataFrame = needed("pandas", "to_pandas").DataFrame(values, index=rows, columns=columns)
        frame.attrs.update(self._about())
        return frame

    def _axes(self) -> tuple[tuple[str, NDArray[np.float64]], ...]:
        return tuple(zip(self.name, self.edges, strict=True))

    def _whole(self) -> NDArray[np.uint64]:
        return self.flow

    def _columns(self) -> dict[str, NDArray[Any]]:
        return {"reachable": self.reachable} | super()._columns()

    def _about(self) -> dict[str, int]:
        return {"captured": self.captured, "n_events": self.n_events}

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the events of each bin as its color, on a logarithmic scale where they differ much.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure, ``.figure`` of what is returned.

        Returns
        -------
        matplotlib.axes.Axes
            Bins without an event are left white.

        Raises
        ------
        InvalidInput
            If matplotlib is not installed.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), bins=10,
        ...     tally=[("lab_angle", "energy")], beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> run["lab_angle", "energy"].plot().get_ylabel()
        'energy afterwards'
        """
        return plot_joint(self, ax)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, JointTally):
            return NotImplemented
        numbers = ("name", "captured", "beam", "events")
        return (
            all(getattr(self, name) == getattr(other, name) for name in numbers)
            and all(np.array_equal(a, b) for a, b in zip(self.edges, other.edges, strict=True))
            and np.array_equal(self.flow, other.flow)
            and same(self.by_stratum, other.by_stratum)
        )

    def __add__(self, other: JointTally) -> JointTally:
        if not isinstance(other, JointTally):
            return NotImplemented
        if self.name != other.name or not all(map(np.array_equal, self.edges, other.edges)):
            raise InvalidInput("other", f"expected a tally of {self.name} with the same edges, got one of {other.name}")
        return replace(
            self,
            flow=self.flow + other.flow,
            captured=self.captured + other.captured,
            events=self._merged_events(other),
            by_stratum=added_strata(self.by_stratum, other.by_stratum),
        )
