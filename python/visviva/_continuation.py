"""What a scene keeps of the run that ended in it, so that the next one goes on with its very bits.

The one idea: it is a part of what the core is told of a scene, beside masses and states, and nothing that anybody
looks at. Whatever makes another scene of it leaves it behind; the core uses it if method and step are those of the run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from visviva import _core
    from visviva.runnable import Runnable

__all__ = ["SHARED", "attached", "left_behind", "of_copies"]

_Start = TypeVar("_Start", bound="Runnable[Any]")

# What all copies have in common, and what a run says of it.
SHARED = ("form", "method", "dt", "t0")


def left_behind(start: _core._Scene, result: dict[str, Any]) -> _core._Continuation | None:
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
    return {
        "form": shared["form"],
        "method": shared["method"],
        "dt": shared["dt"],
        "t0": shared["t0"],
        "node": int(nodes[0]),
        "position": position,
        "velocity": velocity,
        "held": last["held"],
    }


def of_copies(continuation: _core._Continuation | None, rows: slice) -> _core._Continuation | None:
    """That of some of the copies."""
    if continuation is None:
        return None
    chosen = continuation.copy()
    chosen["position"], chosen["velocity"] = continuation["position"][rows], continuation["velocity"][rows]
    chosen["held"] = continuation["held"][rows]
    return chosen


def attached(scene: _Start, continuation: _core._Continuation | None) -> _Start:
    """The scene, which was just made and is in that state, with it."""
    scene._keywords["continuation"] = continuation
    return scene
