"""Tallies for xarray and pandas: bins as intervals, counts as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva._exported import needed

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray
    from pandas import IntervalIndex
    from xarray import Dataset

__all__ = ["dataset", "intervals"]


def intervals(name: str, edges: NDArray[np.float64]) -> IntervalIndex:
    """The bins as an index, closed on the left.

    Raises
    ------
    ImportError
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
    ImportError
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
