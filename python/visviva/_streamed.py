"""An ensemble that is written while it runs: some copies at a time, each part gone when it stands in the file.

The one idea: a copy has the bits that it has alone, so that parts may be run one after the other and of any length.
"""

from __future__ import annotations

from operator import ge, lt
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._accuracy import warn_if_unresolved
from visviva._arrays import whole_number
from visviva._lost_spins import warn_of_lost_spins
from visviva._parquet import GROUP_BYTES, groups, write
from visviva._paths import path_text
from visviva._progress import callback
from visviva._rigid_accuracy import look
from visviva.errors import Interrupted
from visviva.status import Status

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from visviva.ensemble import EnsembleScene
    from visviva.request import StreamRequest
    from visviva.typing import Report

__all__ = ["run_streamed"]

# Copies that go side by side through the lanes.
_LANES = 8


def run_streamed(copies: EnsembleScene, request: StreamRequest) -> NDArray[np.int8]:
    """Run copies into the file, and say how each ended.

    Raises
    ------
    visviva.Interrupted
        After Ctrl-C.
    """
    path = path_text("to", request.to)
    asked = request.to_core(copies._keywords, copies._names)
    threads = None if request.threads is None else whole_number("threads", request.threads, 1, 1024)
    plan = _core.plan(asked)  # refuses by the number of a copy what a part would count anew
    if request.copies_at_once is None:
        numbers = (len(asked["times"]) + asked["end_only"]) * copies.position[0].size * max(1, len(asked["record"]))
        size = max(1, 2 * GROUP_BYTES // (8 * _LANES * numbers)) * _LANES
    else:
        size = whole_number("copies_at_once", request.copies_at_once, 1)
    status = np.full(len(copies), Status.INTERRUPTED, dtype=np.int8)
    worst: dict[str, Any] = {}

    def parts(report: Report | None) -> Iterator[dict[str, NDArray[Any]]]:
        for start in range(0, len(copies), size):
            part = copies[start : start + size]

            def told(done: int, total: int, first: int = start, number: int = len(part)) -> None:
                if report is not None:
                    report(first + number * done // max(total, 1), len(copies))

            own = request.to_core(part._keywords, part._names)
            result = _core.run(own, threads=threads, progress=None if report is None else told, ensemble=True)
            ended = result["status"]
            # The one error of a whole ensemble; it is told of a part, too, that came to its end.
            if result["error"] is not None or (ended == Status.INTERRUPTED).any():
                raise KeyboardInterrupt
            if own["rigid"] is not None:
                look(result, own, threads)
            _keep_worst(worst, result, start)
            made = part._finished(result)
            yield from groups(made._exported(None), made._row_axes, start)
            # What stands in the file is what has a status.
            status[start : start + len(part)] = ended

    with callback(request.progress, "copies") as report:
        try:
            write(path, parts(report), {"method": plan["method"]}, "run_to_parquet")
        except KeyboardInterrupt as stopped:
            done = int((status != Status.INTERRUPTED).sum())
            where = f", which {path!r} holds" if done else ""
            raise Interrupted(f"interrupted after {done} of {len(copies)} copies{where}") from stopped
    warn_if_unresolved(worst, asked, ensemble=True)
    if not copies.scene._turns_freely:
        warn_of_lost_spins(asked, ensemble=True)
    return status


def _keep_worst(worst: dict[str, Any], result: dict[str, Any], start: int) -> None:
    """What is to be warned of, under the number that the copy has in the whole."""
    if "dt_beyond" in result:
        worst["dt_beyond"] = result["dt_beyond"]
    # Which number of each tells how bad it is: of steps in a turn few are bad. Of equals the core has these.
    for name, place, worse in (("energy_error", 1, ge), ("too_long", 2, lt), ("unresolved", 2, ge)):
        if name in result:
            copy, *rest = result[name]
            if name not in worst or worse(result[name][place], worst[name][place]):
                worst[name] = (copy + start, *rest)
