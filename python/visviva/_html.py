"""How results and what makes them look in a notebook: one small table each.

The one idea: an object says what there is to see (`Sheet`: texts in rows), and the HTML is written here and nowhere
else, so that every text is escaped: names of bodies come from whoever wrote the file.
"""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["Sheet", "Shown", "as_html", "first_rows"]

# Rows of a long table that are shown; the rest are counted.
_ROWS = 12


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
