"""Results as they are wanted elsewhere: an xarray Dataset, a pandas DataFrame, a Parquet file.

The one idea: a result says its axes and its columns once (`Columns`); all forms follow from that. The packages are
imported when they are asked for, so that nobody else pays for them.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import Field, dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import numpy as np

from visviva._keywords import known_keywords
from visviva._packages import needed
from visviva._paths import path_text
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from os import PathLike

    from numpy.typing import NDArray
    from pandas import DataFrame
    from xarray import Dataset

__all__ = ["AXES", "ByColumns", "Columns", "Exported", "chosen_columns", "labels"]

Name = TypeVar("Name", bound=str)

# The numbers of a vector and of a quaternion, scalar last.
AXES = {"component": np.array(["x", "y", "z"]), "quaternion": np.array(["x", "y", "z", "w"])}


@dataclass(frozen=True)
class Columns:
    """Named columns over named axes.

    Attributes
    ----------
    axes : mapping of str to ndarray
        The labels along each axis; those of `AXES` need not be given.
    of : mapping of str to (tuple of str, ndarray)
        Of each column its axes and its numbers.
    attributes : mapping of str to object
        What holds for all of it.
    units : mapping of str to str
        Of axes and columns, where they are known; everything else is in the units of the caller.
    """

    axes: Mapping[str, NDArray[Any]]
    of: Mapping[str, tuple[tuple[str, ...], NDArray[Any]]]
    attributes: Mapping[str, Any] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)

    def labels(self, axis: str) -> NDArray[Any]:
        """What stands along an axis."""
        return self.axes[axis] if axis in self.axes else AXES[axis]


@known_keywords
class Exported(Generic[Name]):
    """Base of what can be handed to xarray and pandas, and written to Parquet."""

    __slots__ = ()

    @abstractmethod
    def _exported(self, columns: Name | Sequence[Name] | None) -> Columns:
        """Columns and axes; the first axis of a table is that of its rows."""

    @property
    def _row_axes(self) -> tuple[str, ...]:
        """The leading axes that are rows of a DataFrame: copy and time of an ensemble."""
        return ("time",)

    def to_xarray(self, columns: Name | Sequence[Name] | None = None) -> Dataset:
        """As an ``xarray.Dataset``: a variable for each column, over named axes with their labels.

        Parameters
        ----------
        columns : str or sequence of str, optional
            Which; by default those that were recorded, of results in generalized coordinates and of tables all.

        Returns
        -------
        xarray.Dataset
            Axes are ``time``, ``copy``, ``body`` (names, if the bodies have some), ``component``, ``quaternion``,
            ``coordinate``, ``orbit`` and so on, as far as there are such. Numbers are views of the result's, which are
            read-only, of the shapes that they have there.

        Raises
        ------
        visviva.MissingPackage
            Without the package xarray: ``pip install 'visviva[xarray]'``.
        visviva.InvalidInput
            If a column is unknown, or neither recorded nor to be computed from what is.

        Examples
        --------
        >>> import visviva as vv
        >>> data = vv.datasets.outer_solar_system().scene.run(t=[0.0, 100.0]).to_xarray()
        >>> dict(data.sizes), float(data.position.sel(body="Jupiter", component="x")[0]).__round__(3)
        ({'time': 2, 'body': 6, 'component': 3}, -3.502)
        """
        module = needed("xarray", "to_xarray")
        export = self._exported(columns)
        used = dict.fromkeys(axis for axes, _ in export.of.values() for axis in axes)

        def about(name: str) -> dict[str, str]:
            return {"units": export.units[name]} if name in export.units else {}

        variables = {name: (axes, values, about(name)) for name, (axes, values) in export.of.items()}
        coordinates = {axis: (axis, export.labels(axis), about(axis)) for axis in used}
        made: Dataset = module.Dataset(variables, coordinates, dict(export.attributes))
        return made

    def to_pandas(self, columns: Name | Sequence[Name] | None = None) -> DataFrame:
        """As a ``pandas.DataFrame`` with a row for each time, of elements each orbit, of ensembles each copy and time.

        Parameters
        ----------
        columns : str or sequence of str, optional
            As of `to_xarray`.

        Returns
        -------
        pandas.DataFrame
            Where columns hold several numbers a row, as positions do, labels are tuples:
            ``frame["position"]["Jupiter"]["x"]``, and those of fewer numbers end in empty texts. Rows are those of
            arrays of shape (T, …), or (B, T, …).

        Raises
        ------
        visviva.MissingPackage
            Without the package pandas: ``pip install 'visviva[pandas]'``.
        visviva.InvalidInput
            As `to_xarray`.

        Examples
        --------
        >>> import visviva as vv
        >>> frame = vv.datasets.outer_solar_system().scene.run(t=[0.0, 100.0]).to_pandas("position")
        >>> frame.shape, frame["position"]["Jupiter"]["x"].round(3).tolist()[0]
        ((2, 18), -3.502)
        """
        module = needed("pandas", "to_pandas")
        export = self._exported(columns)
        rows = self._row_axes
        index = (
            module.Index(export.labels(rows[0]), name=rows[0])
            if len(rows) == 1
            else module.MultiIndex.from_product([export.labels(axis) for axis in rows], names=rows)
        )
        keys: list[tuple[Any, ...]] = []
        parts: list[NDArray[Any]] = []
        for name, (axes, values) in export.of.items():
            if axes[: len(rows)] != rows:
                continue  # one number a copy: no row has it
            width = int(np.prod(values.shape[len(rows) :], dtype=int))
            flat = values.reshape(len(index), width)
            parts.extend(flat.T)
            keys.extend((name, *place) for place in _places([export.labels(axis) for axis in axes[len(rows) :]]))
        levels = max(map(len, keys), default=1)
        padded = [(*key, *[""] * (levels - len(key))) for key in keys]
        frame: DataFrame = module.DataFrame(dict(enumerate(parts)), index=index)
        frame.columns = module.MultiIndex.from_tuples(padded) if levels > 1 else [key[0] for key in keys]
        return frame

    def to_parquet(self, path: str | PathLike[str], columns: Name | Sequence[Name] | None = None) -> None:
        """Write a Parquet file with the rows of `to_pandas`, a group of them at a time.

        Beside the result itself it takes the memory of one group of rows (16 MB). `EnsembleScene.run_to_parquet` does
        not hold the result either.

        Parameters
        ----------
        path : path-like
            The file, exactly as named; one that exists is replaced.
        columns : str or sequence of str, optional
            As of `to_xarray`.

        Raises
        ------
        visviva.MissingPackage
            Without the package pyarrow: ``pip install 'visviva[parquet]'``.
        visviva.InvalidInput
            As `to_xarray`, and for what is no path.

        Notes
        -----
        Rows are those of arrays of shape (T, …), or (B, T, …). First come the axes of the rows (``copy``, ``time``),
        then the columns, with a name for each number: ``position_Jupiter_x``, or ``position_0_x`` of bodies without
        names. Of an ensemble every row has the ``status`` of its copy. Method and status are in the metadata of the
        schema.

        Examples
        --------
        >>> import pathlib, tempfile, pyarrow.parquet, visviva as vv
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "planets.parquet"
        >>> vv.datasets.outer_solar_system().scene.run(t=[0.0, 100.0]).to_parquet(path, "position")
        >>> table = pyarrow.parquet.read_table(path, columns=["time", "position_Jupiter_x"])
        >>> table["position_Jupiter_x"].to_numpy().round(3).tolist()[0]
        -3.502
        """
        from visviva._parquet import groups, write

        export = self._exported(columns)
        write(path_text("path", path), groups(export, self._row_axes), dict(export.attributes), "to_parquet")


class ByColumns(Exported[Name]):  # noqa: PLW1641 — it holds arrays, which have no hash
    """Base of tables, of which two are equal if they are of one kind and have the same fields, NaN where NaN is."""

    __slots__ = ()

    # What says that it is a dataclass.
    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_same(getattr(self, each.name), getattr(other, each.name)) for each in fields(self))


def _same(mine: Any, other: Any) -> bool:
    if isinstance(mine, np.ndarray | float):
        return np.array_equal(mine, other, equal_nan=np.asarray(mine).dtype.kind == "f")
    return bool(mine == other)


def _places(axes: Sequence[NDArray[Any]]) -> list[tuple[Any, ...]]:
    """Every place of an array with these labels, the last axis fastest."""
    places: list[tuple[Any, ...]] = [()]
    for labels_ in axes:
        places = [(*place, label) for place in places for label in labels_.tolist()]
    return places


def labels(names: Iterable[str], number: int) -> NDArray[Any]:
    """The names along an axis, or numbers from 0 where there are none."""
    given = list(names)
    return np.array(given) if len(given) == number and number else np.arange(number)


def chosen_columns(given: str | Sequence[str] | None, default: Sequence[str], known: Iterable[str]) -> list[str]:
    """The names of the columns that were asked for.

    Raises
    ------
    visviva.InvalidInput
        For a name that is none of `known`.
    """
    if given is None:
        return list(default)
    known = tuple(known)
    if not isinstance(given, Iterable):
        raise InvalidInput("columns", f"expected a name or several of {', '.join(sorted(known))}, got {given!r}")
    names = [given] if isinstance(given, str) else list(given)
    if not names:
        raise InvalidInput("columns", f"expected one or several of {', '.join(sorted(known))}, got none")
    for name in names:
        if not isinstance(name, str) or name not in known:
            raise InvalidInput("columns", f"there is no column {name!r}; there are {', '.join(sorted(known))}")
    return list(dict.fromkeys(names))
