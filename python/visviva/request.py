"""What is asked of the core: one place that turns arguments into the core's keywords, and its errors into ours.

Kept lean on purpose: a closed form at one time must not pay for the formalities. Whatever can be judged
by the core (signs, ranges, names, order of times) is left to the core.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from visviva import _core
from visviva._accuracy import judge
from visviva._arrays import float_array, number, whole_number
from visviva.errors import CloseEncounter, ConvergenceError, Interrupted, InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from visviva._progress import Progress

_INTERRUPTED = 3  # Status.INTERRUPTED; this room is below the one that names it
_Result = TypeVar("_Result")


def keywords(
    prepared: _core._Scene,
    t: ArrayLike,
    method: str,
    dt: float | None,
    rtol: float,
    atol: float | None,
    max_step: float | None,
    max_steps: int | None,
    record: Sequence[str],
    events: Sequence[object],
) -> _core._Request:
    """What ``_core.run`` and ``_core.plan`` both take."""
    if events:
        raise InvalidInput("events", "events are not offered yet; leave events=() and look at the recorded columns")
    # An array or a sequence is output times; anything else must be one number, and `number` says so.
    end_only = getattr(t, "ndim", int(hasattr(t, "__len__"))) == 0
    return {
        **prepared,
        "times": np.array([number("t", t)]) if end_only else float_array("t", t, (None,)),
        "end_only": end_only,
        "method": _word("method", method),
        "dt": None if dt is None else number("dt", dt),
        "rtol": number("rtol", rtol),
        "atol": None if atol is None else number("atol", atol),
        "max_step": None if max_step is None else number("max_step", max_step),
        "max_steps": None if max_steps is None else whole_number("max_steps", max_steps),
        "record": _words("record", record),
    }


def execute(
    request: _core._Request,
    threads: int | None,
    progress: Progress,
    *,
    ensemble: bool,
    make: Callable[[dict[str, Any]], _Result],
) -> _Result:
    """Run the request and make its result, or raise the core's error with the result attached."""
    count = None if threads is None else whole_number("threads", threads)
    if progress is False:
        result = _core.run(request, threads=count, progress=None, ensemble=ensemble)
    else:
        from visviva._progress import callback

        with callback(progress) as report:
            result = _core.run(request, threads=count, progress=report, ensemble=ensemble)
    made = make(result)
    if request["dt"] is not None:
        judge(result, ensemble=ensemble)
    error = result["error"]
    if error is not None:
        raise _exception(error, made)
    if ensemble and (result["status"] == _INTERRUPTED).any():
        raise Interrupted("the ensemble was interrupted", made)
    return made


def _exception(error: dict[str, Any], trajectory: object) -> BaseException:
    if error["kind"] == "close_encounter":
        first, second = error["bodies"]
        return CloseEncounter(error["time"], (first, second), error["distance"], trajectory)
    if error["kind"] == "interrupted":
        return Interrupted(error["message"], trajectory)
    return ConvergenceError(error["message"], error["time"], trajectory)


def _word(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise InvalidInput(name, f"expected a name, got {type(value).__name__}")
    # Half a surrogate pair is no text to the core; what remains is refused there as an unknown name.
    return value if value.isascii() else value.encode(errors="replace").decode()


def _words(name: str, value: object) -> list[str]:
    if isinstance(value, str):
        return [_word(name, value)]
    if not isinstance(value, Iterable):
        raise InvalidInput(name, f"expected a name or several names, got {value!r}")
    return [_word(name, word) for word in value]
