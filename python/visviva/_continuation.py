"""What a scene keeps of the run that ended in it, so that the next one goes on with its very bits.

The one idea: it is a part of what the core is told of a scene, beside masses and states, and nothing that anybody
looks at. Whatever makes another scene of it leaves it behind; the core uses it if method and step are those of the run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva import _core
    from visviva.runnable import Runnable

__all__ = ["ARRAYS", "SHARED", "continuation_after", "continuation_of_copies", "turning", "with_continuation"]

_Start = TypeVar("_Start", bound="Runnable[Any]")

# What all copies have in common, and what a run says of it.
SHARED = ("form", "method", "dt", "t0")
# What each copy has of its own.
ARRAYS = ("position", "velocity", "orientation", "angular_velocity", "held")


def continuation_after(start: _core._Scene, result: dict[str, Any]) -> _core._Continuation | None:
    """What the run of `start` left behind; None if its copies did not end on one node."""
    shared, last = result.get("continuation"), result["final"]
    if shared is None:
        return None
    nodes = last["node"]
    if nodes[0] == 0 or (nodes != nodes[0]).any():
        return None
    # A run that goes on with another keeps where that one began.
    before = start["continuation"] if shared["goes_on"] else None
    begun: Any = start if before is None else before
    position, velocity = (last.get(f"begun_{name}", begun[name]) for name in ("position", "velocity"))
    turned = turning(begun if before is not None else start["rigid"], len(position))
    kept: Any = {name: shared[name] for name in SHARED} | {"node": int(nodes[0]), "position": position}
    kept |= {"velocity": velocity, **turned, "held": last["held"]}
    continuation: _core._Continuation = kept
    return continuation


def turning(begun: Any, copies: int) -> dict[str, Any]:
    """How the rigid bodies of so many copies were turned and turning, of which there may be none."""
    widths = {"orientation": 4, "angular_velocity": 3}
    return {name: np.zeros((copies, 0, width)) if begun is None else begun[name] for name, width in widths.items()}


def continuation_of_copies(
    continuation: _core._Continuation | None, rows: slice | NDArray[np.intp]
) -> _core._Continuation | None:
    """That of some of the copies."""
    if continuation is None:
        return None
    arrays: Any = continuation
    chosen: Any = continuation.copy()
    for name in ARRAYS:
        chosen[name] = arrays[name][rows]
    kept: _core._Continuation = chosen
    return kept


def with_continuation(scene: _Start, continuation: _core._Continuation | None) -> _Start:
    """The scene, which was just made and is in that state, with it."""
    scene._keywords["continuation"] = continuation
    return scene
