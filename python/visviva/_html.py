"""How results and what makes them look in a notebook: one small table each.

The one idea: an object says what there is to see (`Sheet`: texts in rows), and the HTML is written here and nowhere
else, so that every text is escaped: names of bodies come from whoever wrote the file.
"""

from __future__ import annotations

from dataclasses import Field, dataclass, fields
from html import escape
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["Record", "Sheet", "Shown", "as_html", "as_text", "brief_tuple", "briefly", "first_rows"]

# Rows of a long table that are shown; the rest are counted.
_ROWS = 12
# Numbers of an array, and of a tuple, that are shown one by one.
_NUMBERS, _ITEMS = 9, 6
# Characters of a text.
_TEXT = 250


@dataclass(frozen=True)
class Sheet:
    """What a reader sees: a caption, what the columns are, rows of texts.

    Attributes
    ----------
    caption : str
    rows : sequence of sequence of str
        The first text of a row is its name.
    header : sequence of str
        Names of the columns; none if the rows speak for themselves.
    note : str
        What stands below.
    """

    caption: str
    rows: Sequence[Sequence[str]]
    header: Sequence[str] = ()
    note: str = ""


class Shown:
    """Base of what a notebook shows as a table."""

    __slots__ = ()

    def _sheet(self) -> Sheet | str:
        """What there is to see; by default what ``print`` shows."""
        return str(self)

    def _repr_html_(self) -> str:
        return as_html(self._sheet())


class Record(Shown):
    """Base of results that are fields (dataclasses with ``repr=False``): short in words, a row for each in a notebook.

    Few numbers are shown as they are; of more, their shape and their ends.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.scattering.moderation(mass_ratio=np.ones(500)).__repr__()[:75]
    'Moderation(greatest_transfer=<(500,) from 1 to 1>, mean_transfer=<(500,) fr'
    """

    __slots__ = ()

    # What says that it is one.
    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def _told(self) -> list[tuple[str, str]]:
        shown = (field.name for field in fields(self) if field.repr and not field.name.startswith("_"))
        return [(name, briefly(getattr(self, name))) for name in shown]

    def __repr__(self) -> str:
        name, text = type(self).__name__, ", ".join(f"{name}={text}" for name, text in self._told())
        if len(text) > _TEXT:
            # Not within a number.
            text = text[:_TEXT].rpartition(", ")[0] + ", …"
        return f"{name}({text})"

    def _sheet(self) -> Sheet:
        return Sheet(type(self).__name__, self._told())


def briefly(value: object) -> str:
    """A value in one line, however much it holds.

    Examples
    --------
    >>> import numpy as np
    >>> from visviva._html import briefly
    >>> briefly(np.array([1.0, 2.0])), briefly(np.arange(12.0)), briefly(tuple("abcdefgh")), briefly(np.float64(2.0))
    ('array([1., 2.])', '<(12,) from 0 to 11>', '<8: a, b, …>', '2.0')
    """
    if isinstance(value, np.generic):
        return repr(value.item())
    if isinstance(value, np.ndarray) and value.size > _NUMBERS:
        if value.dtype.kind not in "fiu":
            return f"<{value.shape}>"
        known = value[np.isfinite(value)]
        missing = "" if known.size == value.size else f", {value.size - known.size} not finite"
        ends = f" from {known.min():.6g} to {known.max():.6g}" if known.size else ""
        return f"<{value.shape}{ends}{missing}>"
    if isinstance(value, tuple) and any(isinstance(each, np.ndarray) for each in value):
        return f"({', '.join(map(briefly, value))})"
    if isinstance(value, tuple) and len(value) > _ITEMS and not hasattr(value, "_fields"):
        return f"<{len(value)}: {', '.join(str(each) for each in value[:2])}, …>"
    return " ".join(repr(value).split())


def brief_tuple(record: Any) -> str:
    """The ``repr`` of a named tuple, in one line however much its fields hold.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.scattering.CrossSection(np.array([1.0, 2.0]), np.arange(100.0))
    CrossSection(value=array([1., 2.]), error=<(100,) from 0 to 99>)
    """
    named = zip(record._fields, record, strict=True)
    return f"{type(record).__name__}({', '.join(f'{name}={briefly(value)}' for name, value in named)})"


def as_html(sheet: Sheet | str) -> str:
    """A sheet as a table, a text as it is; everything escaped.

    Examples
    --------
    >>> from visviva._html import Sheet, as_html
    >>> as_html("a < b")
    '<pre>a &lt; b</pre>'
    >>> as_html(Sheet("one", [("name", "value")]))
    '<table><caption>one</caption><tbody><tr><th>name</th><td>value</td></tr></tbody></table>'
    """
    if isinstance(sheet, str):
        return f"<pre>{escape(sheet)}</pre>"
    head = "".join(f"<th>{escape(text)}</th>" for text in sheet.header)
    rows = "".join(
        f"<tr><th>{escape(name)}</th>{''.join(f'<td>{escape(text)}</td>' for text in texts)}</tr>"
        for name, *texts in sheet.rows
    )
    made = f"<table><caption>{escape(sheet.caption)}</caption>"
    if head:
        made += f"<thead><tr>{head}</tr></thead>"
    made += f"<tbody>{rows}</tbody></table>"
    return made + (f"<p>{escape(sheet.note)}</p>" if sheet.note else "")


def as_text(sheet: Sheet) -> str:
    """A sheet as lines of text, whose columns stand below each other.

    Examples
    --------
    >>> from visviva._html import Sheet, as_text
    >>> print(as_text(Sheet("two", [("a", "1"), ("long", "2")], ("", "value"))))
    two
          value
    a     1
    long  2
    """
    rows = [row for row in (sheet.header, *sheet.rows) if row]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(f"{text:<{width}}" for text, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return "\n".join([sheet.caption, *lines, *([sheet.note] if sheet.note else [])])


def first_rows(length: int, row: Any) -> tuple[list[tuple[str, ...]], str]:
    """The rows ``row(0)``, ``row(1)``, … as far as they are shown, and a note about the rest.

    Examples
    --------
    >>> from visviva._html import first_rows
    >>> rows, note = first_rows(14, lambda index: (f"{index}",))
    >>> len(rows), note
    (12, 'and 2 more')
    """
    rest = length - _ROWS
    return [row(index) for index in range(min(length, _ROWS))], f"and {rest} more" if rest > 0 else ""
