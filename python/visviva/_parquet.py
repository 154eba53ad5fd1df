"""Results in Parquet files, a group of rows at a time.

The one idea: what a result exports (`visviva._exported.Columns`) are views, and a group of rows is a slice of each, so
that a file of any length is written in the memory of one group.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._packages import needed

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from visviva._exported import Columns

__all__ = ["GROUP_BYTES", "groups", "write"]

# What comes again in many rows.
_REPEATED = ("copy", "time", "body", "status", "rigid_body")
# Of one group of rows.
GROUP_BYTES = 1 << 24


def groups(export: Columns, rows: tuple[str, ...], first: int = 0) -> Iterator[dict[str, NDArray[Any]]]:
    """Flat columns of one group of rows after the other; without a row one empty group, which has the names.

    A position becomes ``position_0_x`` or ``position_Jupiter_x``; a number of the first axis alone, as the status of a
    copy, stands in each of its rows. `first` is added to the numbers of the copies.
    """
    shape = tuple(len(export.labels(axis)) for axis in rows)
    of_first = {name: values for name, (axes, values) in export.of.items() if axes == rows[:1] != rows}
    of_rows = {
        name: ([f"{name}{ending}" for ending in _endings(export, axes[len(rows) :])], values)
        for name, (axes, values) in export.of.items()
        if name not in of_first
    }
    total, width = int(np.prod(shape)), len(rows) + len(of_first) + sum(len(places) for places, _ in of_rows.values())
    size = max(1, GROUP_BYTES // (8 * width))
    for start in range(0, max(total, 1), size):
        place = np.unravel_index(np.arange(start, min(start + size, total)), shape)
        group = {axis: export.labels(axis)[at] for axis, at in zip(rows, place, strict=True)}
        if rows[0] == "copy":
            group["copy"] = group["copy"] + first
        group |= {name: values[place[0]] for name, values in of_first.items()}
        for places, values in of_rows.values():
            # Of these rows alone: as a table of all rows, a part of a wider array would be a copy.
            chosen = values[place].reshape(len(place[0]), len(places))
            group |= {name: np.ascontiguousarray(column) for name, column in zip(places, chosen.T, strict=True)}
        yield group


def _endings(export: Columns, axes: Sequence[str]) -> list[str]:
    endings = [""]
    for axis in axes:
        endings = [f"{ending}_{label}" for ending in endings for label in export.labels(axis)]
    return endings


def write(path: str, tables: Iterator[dict[str, NDArray[Any]]], about: dict[str, Any], what: str) -> None:
    """Write groups of rows as they come.

    The first is made before the file: whatever is refused leaves no file behind.

    Raises
    ------
    visviva.MissingPackage
        If pyarrow is not installed.
    """
    arrow = needed("pyarrow", what, "parquet")
    parquet = needed("pyarrow.parquet", what, "parquet")
    table = arrow.table(next(tables)).replace_schema_metadata({name: str(value) for name, value in about.items()})
    # Dictionaries of numbers that hardly ever come twice would take time and room for nothing.
    keys = [name for name in table.column_names if name in _REPEATED]
    with parquet.ParquetWriter(path, table.schema, use_dictionary=keys) as writer:
        writer.write_table(table)
        for group in tables:
            writer.write_table(arrow.table(group, schema=table.schema))
