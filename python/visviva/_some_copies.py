"""What is asked of some of the copies of an ensemble."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva import _core

__all__ = ["of_copies"]

_OF_COPIES = ("mass", "position", "velocity")
_OF_RIGID_BODIES = ("moments", "axes", "center", "orientation", "angular_velocity")
"""What is each copy's own."""


def of_copies(asked: _core._Request, copies: slice | NDArray[np.intp]) -> _core._Request:
    """What is asked of some copies, without where an earlier run left them."""
    request: Any = dict(asked)
    for name in _OF_COPIES:
        request[name] = request[name][copies]
    if asked["radius"] is not None:
        request["radius"] = asked["radius"][copies]
    if asked["rigid"] is not None:
        own: Any = asked["rigid"]
        request["rigid"] = own | {name: own[name][copies] for name in _OF_RIGID_BODIES}
        if own["own_loads"] is not None:
            request["rigid"]["loads"], request["rigid"]["own_loads"] = _sets_of(own["own_loads"], copies)
    if asked["own_forces"] is not None:
        request["forces"], request["own_forces"] = _sets_of(asked["own_forces"], copies)
    request["continuation"] = None
    return cast("_core._Request", request)


def _sets_of(own: tuple[list[Any], list[int]], copies: slice | NDArray[np.intp]) -> tuple[Any, Any]:
    """What the first of some copies has, and what each has if they differ.

    A set that none of them has is none of theirs, and what is planned of all is planned of the first.
    """
    sets, which = own
    chosen = np.asarray(which)[copies]
    used, of_copy = np.unique(chosen, return_inverse=True)
    return sets[chosen[0]], ([sets[each] for each in used], of_copy.tolist()) if len(used) > 1 else None
