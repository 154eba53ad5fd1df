"""How the copies of an ensemble ended, counted: those that failed and those that Ctrl-C kept from their end are two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["endings", "interrupted_and_failed"]


def interrupted_and_failed(status: NDArray[np.integer]) -> tuple[int, int]:
    """How many of statuses (B,) are interrupted, and how many are failures."""
    interrupted = int(np.count_nonzero(status == Status.INTERRUPTED))
    whole = int(np.count_nonzero(np.isin(status, (Status.OK, Status.STOPPED))))
    return interrupted, len(status) - whole - interrupted


def endings(status: NDArray[np.integer]) -> str:
    """How many of statuses (B,) failed, and of a run that was interrupted how many finished and how many did not.

    Examples
    --------
    >>> import numpy as np
    >>> from visviva._endings import endings
    >>> endings(np.array([0, 5, 2])), endings(np.array([0, 5, 2, 3]))
    ('1 failed', '2 finished, 1 failed, 1 interrupted')
    """
    interrupted, failed = interrupted_and_failed(status)
    if not interrupted:
        return f"{failed} failed"
    return f"{len(status) - failed - interrupted} finished, {failed} failed, {interrupted} interrupted"


def __dir__() -> list[str]:
    return list(__all__)
