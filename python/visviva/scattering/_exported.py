"""Tallies for hist, xarray and pandas: bins as intervals, counts as they are.

The one idea: a tally says its axes, its counts and what is told beside them once; the forms follow from that.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

from visviva import _core
from visviva._keywords import known_keywords
from visviva._packages import needed
from visviva.scattering._beam import described
from visviva.scattering._of_events import OfEvents
from visviva.scattering._weights import weighted_counts

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from boost_histogram.storage import Storage
    from hist import Hist
    from numpy.typing import NDArray
    from pandas import DataFrame, IntervalIndex
    from xarray import Dataset

__all__ = ["ExportedTally", "OfOneQuantity", "OfStrata", "dataset", "intervals"]


@known_keywords
class ExportedTally:
    """Base of tallies, whatever their number of axes and however their events are weighted."""

    @abstractmethod
    def values(self) -> NDArray[np.float64]:
        """The sum of the weights in each bin."""

    @abstractmethod
    def variances(self) -> NDArray[np.float64]:
        """Of `values`."""

    @abstractmethod
    def _axes(self) -> tuple[tuple[str, NDArray[np.float64]], ...]:
        """Each quantity and the edges of its bins."""

    @abstractmethod
    def _whole(self) -> NDArray[np.uint64]:
        """The events along each axis below the first edge, in the bins, and above the last edge."""

    @abstractmethod
    def _whole_weighted(self, power: int) -> NDArray[np.float64]:
        """Σ w n of the places of `_whole`, or Σ w² n of power 2."""

    @property
    @abstractmethod
    def _is_weighted(self) -> bool:
        """Whether events differ in weight."""

    @abstractmethod
    def _about(self) -> dict[str, int]:
        """What is told beside the bins."""

    def _columns(self) -> dict[str, NDArray[Any]]:
        """What is told of each bin."""
        weighted = {"values": self.values(), "variances": self.variances()} if self._is_weighted else {}
        return {"counts": self._whole()[self._inner], **weighted}

    @property
    def _inner(self) -> tuple[slice, ...]:
        """Of `_whole` the bins."""
        return (slice(1, -1),) * len(self._axes())

    def to_hist(self) -> Hist[Storage]:
        """The counts as a ``hist.Hist`` with an axis for each quantity, with underflow and overflow.

        Where events differ in weight, by `importance` or a forced collision, its storage is ``Weight``, with the
        variances Σ w² n.

        Returns
        -------
        hist.Hist
            Of one axis, or two; counts without dimension.

        Raises
        ------
        MissingPackage
            Without the package hist.

        Examples
        --------
        >>> from importlib.util import find_spec
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), bins=10, tally="cm_angle",
        ...     beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> hist = run["cm_angle"].to_hist() if find_spec("hist") else None
        >>> run = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), bins=10, tally=[("lab_angle", "energy")],
        ...     beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> hist = run["lab_angle", "energy"].to_hist() if find_spec("hist") else None
        """
        hist = needed("hist", "to_hist")
        axes = [hist.axis.Variable(edges, name=name) for name, edges in self._axes()]
        filled: Hist[Storage] = hist.Hist(
            *axes, storage=hist.storage.Weight() if self._is_weighted else hist.storage.Int64()
        )
        view: Any = filled.view(flow=True)
        if self._is_weighted:
            view.value, view.variance = self._whole_weighted(1), self._whole_weighted(2)
        else:
            view[...] = self._whole()
        return filled

    def to_xarray(self) -> Dataset:
        """As an ``xarray.Dataset`` of ``counts`` over the middles of the bins, with an axis for each quantity.

        Of a beam there is ``reachable``, too, and where events differ in weight, by `importance` or a
        forced collision, there are ``values`` and ``variances``.

        Returns
        -------
        xarray.Dataset
            The ends of the bins are the coordinates ``<name>_low`` and ``<name>_high``; what is outside of them and
            what was captured are attributes. Angles are in radians. Each column has shape (B,), or (B₁, B₂).

        Raises
        ------
        MissingPackage
            Without the package xarray: ``pip install 'visviva[xarray]'``.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> data = run["cm_angle"].to_xarray()
        >>> int(data["counts"].sum()), data["cm_angle"].units
        (1000, 'rad')
        >>> run = vv.scattering.monte_carlo(vv.potentials.HardSphere(1.0), bins=10,
        ...     tally=[("lab_angle", "energy")], beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> dict(run["lab_angle", "energy"].to_xarray().sizes)
        {'lab_angle': 10, 'energy': 10}
        """
        return dataset(dict(self._axes()), self._columns(), self._about())


@known_keywords
class OfOneQuantity(ExportedTally):
    """Base of tallies of one axis, whose bins are the rows of a table."""

    def to_pandas(self) -> DataFrame:
        """As a ``pandas.DataFrame``: a row for each bin, the columns those of `to_xarray`.

        Returns
        -------
        pandas.DataFrame
            Its index are the bins as intervals, closed on the left (the last bin has its end, too). Each column has
            shape (B,). What is outside of the bins and what was captured is in ``frame.attrs``.

        Raises
        ------
        MissingPackage
            Without the package pandas: ``pip install 'visviva[pandas]'``.

        Examples
        --------
        >>> import visviva as vv
        >>> run = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1)
        >>> frame = run["cm_angle"].to_pandas()
        >>> frame.shape, int(frame["counts"].sum())
        ((180, 2), 1000)
        """
        ((name, edges),) = self._axes()
        index = intervals(name, edges)
        frame: DataFrame = needed("pandas", "to_pandas").DataFrame(self._columns(), index=index)
        frame.attrs.update(self._about())
        return frame


@known_keywords
class OfStrata(OfEvents, ExportedTally):
    """Base of tallies of a beam, of which `importance` weights the strata."""

    by_stratum: NDArray[np.uint64] | None

    @property
    def _is_weighted(self) -> bool:
        return self.by_stratum is not None

    def _whole_weighted(self, power: int) -> NDArray[np.float64]:
        return weighted_counts(self, power, self._whole())

    def expected(self) -> NDArray[np.float64]:
        """What ``values()`` are on the average, by the deflection function: of each bin the area of its places.

        Found from the function by which events are counted (of V = k/r the closed form, of any other potential its
        certified table), all branches and energies together.

        Returns
        -------
        ndarray, shape (B,) or (B₁, B₂)
            Numbers without dimension. Of two quantities together the sum over a whole axis is what is expected of the
            other one.

        Raises
        ------
        InvalidInput
            With an energy spread, of an angle that a divergence smears, and of what channels differ in if their
            probabilities depend on the impact parameter: no area of impact parameters tells those.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> tally = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1,
        ...     tally={"cm_angle": vv.scattering.Bins.solid_angle(4)})["cm_angle"]
        >>> tally.expected().round(6)
        array([250., 250., 250., 250.])
        >>> pair = ("cm_angle", "recoil_energy")
        >>> tally = vv.scattering.monte_carlo(
        ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1,
        ...     tally={pair: (vv.scattering.Bins.solid_angle(4), 2)})[pair]
        >>> tally.expected().round(6)
        array([[250.,   0.],
               [250.,   0.],
               [  0., 250.],
               [  0., 250.]])
        """
        parts = _core.monte_carlo_expected(beam=described(self.beam), tallies=[list(self._axes())])
        whole = parts[0][:-1].reshape([len(edges) + 1 for _, edges in self._axes()])
        return whole[self._inner] * self.n_events


def intervals(name: str, edges: NDArray[np.float64]) -> IntervalIndex:
    """The bins as an index, closed on the left.

    Raises
    ------
    MissingPackage
        Without the package pandas.
    """
    index: IntervalIndex = needed("pandas", "to_pandas").IntervalIndex.from_breaks(edges, closed="left", name=name)
    return index


def dataset(
    edges: Mapping[str, NDArray[np.float64]], columns: Mapping[str, NDArray[Any]], told: Mapping[str, Any]
) -> Dataset:
    """Columns over the middles of bins, with the ends of the bins beside them.

    Raises
    ------
    MissingPackage
        Without the package xarray.
    """
    module = needed("xarray", "to_xarray")
    coordinates: dict[str, Any] = {}
    for name, ends in edges.items():
        units = {"units": "rad"} if name.endswith("angle") else {}
        for label, values in (
            (name, (ends[1:] + ends[:-1]) / 2),
            (f"{name}_low", ends[:-1]),
            (f"{name}_high", ends[1:]),
        ):
            coordinates[label] = (name, values, units)
    variables = {name: (tuple(edges), values) for name, values in columns.items()}
    made: Dataset = module.Dataset(variables, coordinates, dict(told))
    return made
