"""The last row of a run to an end time that an event or a contact ended before it.

The one idea: who asks for the end gets the end that there was, in every column, as of a run that begins there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from visviva import _core

if TYPE_CHECKING:
    from visviva._core import _Request


def ended_at_the_stop(result: dict[str, Any], asked: _Request) -> None:
    """Add the state that ended the run to its result, as its last row."""
    last = result["final"]
    if last["t"][0] == result["t"][-1]:
        return
    there: dict[str, Any] = dict(asked) | {name: last[name] for name in ("mass", "radius") if name in last}
    there |= {"position": last["position"], "velocity": last["velocity"], "t0": float(last["t"][0])}
    if there["rigid"] is not None:
        there["rigid"] = there["rigid"] | {name: last[name] for name in ("orientation", "angular_velocity")}
    # Bodies that are parts of others pull nothing, which those that pass through each other would.
    merges = "merge" if asked["collisions"] == "merge" else None
    there |= {"times": last["t"], "end_only": False, "events": [], "collisions": merges, "restitution": None}
    there |= {"continuation": None}
    row = _core.run(cast("_Request", there), threads=1, progress=None, ensemble=False)
    result["t"] = np.concatenate([result["t"], row["t"]])
    for name, values in result["columns"].items():
        result["columns"][name] = np.concatenate([values, row["columns"][name]], axis=1)
