"""How results read when they are printed."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["article", "count", "note_once", "short_repr", "table"]


def count(number: int, one: str, many: str | None = None) -> str:
    """A number and its noun.

    Examples
    --------
    >>> from visviva._text import count
    >>> count(1, "body", "bodies"), count(3, "time")
    ('1 body', '3 times')
    """
    return f"{number} {one if number == 1 else many or one + 's'}"


def article(noun: str) -> str:
    """A noun and its article.

    Examples
    --------
    >>> from visviva._text import article
    >>> article("list"), article("int"), article("EnsembleScene")
    ('a list', 'an int', 'an EnsembleScene')
    """
    return f"{'an' if noun[0] in 'aeiouAEIO' else 'a'} {noun}"  # a UniformField


def note_once(error: BaseException, note: str) -> None:
    """Add a note to an error, if it has not got that from being raised before.

    Examples
    --------
    >>> from visviva._text import note_once
    >>> error = ValueError("no")
    >>> note_once(error, "here"), note_once(error, "here"), error.__notes__
    (None, None, ['here'])
    """
    if note not in getattr(error, "__notes__", ()):
        error.add_note(note)


def table(record: DataclassInstance, leave_out: tuple[str, ...] = ()) -> str:
    """A line for each field but those left out, with the digits that a reader compares.

    Examples
    --------
    >>> import visviva as vv
    >>> print(vv.problems.kepler(e=0.0).scene.invariants())  # doctest: +ELLIPSIS
    total_mass                     1
    center_of_mass                 [0 0 0]
    ...
    """
    rows = [(field.name, getattr(record, field.name)) for field in fields(record) if field.name not in leave_out]
    width = max(len(name) for name, _ in rows) + 2
    return "\n".join(f"{name:<{width}}{_value(value, width)}" for name, value in rows)


def short_repr(record: DataclassInstance) -> str:
    """The name of a record and how many of what it is of, for ``repr``.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.orbits.conic(1.0, 1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])
    Conic(mass=1, 12 more: print shows them)
    """
    first, *rest = fields(record)
    value = getattr(record, first.name)
    shape = np.shape(value)
    first_field = f"{first.name}={value:.9g}" if shape == () else f"{first.name} of shape {shape}"
    return f"{type(record).__name__}({first_field}, {len(rest)} more: print shows them)"


def _value(value: Any, indent: int) -> str:
    array = np.asarray(value, dtype=float) + 0.0  # no -0
    # The numbers of a stack of orbits stand below each other.
    text = np.array2string(array, formatter={"float_kind": lambda x: f"{x:.9g}"}, max_line_width=120 - indent)
    return text.replace("\n", "\n" + " " * indent)
