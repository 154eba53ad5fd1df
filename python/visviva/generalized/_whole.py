"""Runs that answer another question than where a motion goes: derivatives of a flow, sections, periods.

The one idea: part of such a run answers nothing, so it is whole, or an exception says what ended it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva.errors import ConvergenceError, Interrupted

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["whole"]


def whole(result: Mapping[str, Any], what: str) -> None:
    """Refuse what came of a run that did not reach its end.

    Raises
    ------
    Interrupted
        After Ctrl-C.
    ConvergenceError
        Of what failed.
    """
    if result["interrupted"]:
        raise Interrupted(f"the {what} was interrupted")
    if result["failures"][0] is not None:
        raise ConvergenceError(result["failures"][0], result["reached"][0])
