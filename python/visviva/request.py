"""What is asked of the core: one frozen request, its way into the core's keywords, and the core's errors into ours.

The one idea: a run option is one field. Its default, its type and its check stand in one line of `PlanRequest` or
`RunRequest`; the signatures of ``run`` and ``plan`` and the keywords of the core are made from the fields.

Kept lean on purpose: a closed form at one time must not pay for the formalities. Whatever can be judged
by the core (signs, ranges, names, order of times) is left to the core.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cache, partial, wraps
from inspect import Parameter, Signature, signature
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar, cast, get_args

import numpy as np

from visviva import _core
from visviva._accuracy import times_may_be_coarse, warn_if_unresolved
from visviva._arrays import float_array, number, whole_number
from visviva._methods_elsewhere import refuse_of_others
from visviva.errors import Interrupted, InvalidInput, _ended_early
from visviva.status import Status

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

    from numpy.typing import ArrayLike

    from visviva.events import Event
    from visviva.integrators import Method
    from visviva.typing import (
        CollisionRule,
        ColumnName,
        EventFunction,
        Executor,
        MethodName,
        Progress,
        TransformationName,
    )

__all__ = [
    "MegnoRequest",
    "PlanRequest",
    "RunRequest",
    "StreamRequest",
    "asked_by",
    "execute",
    "finished",
    "fixed_steps",
]

_Parameters = ParamSpec("_Parameters")
_Request = TypeVar("_Request")
_Result = TypeVar("_Result")
_Self = TypeVar("_Self")
_Check = TypeVar("_Check")


_SEQUENCE = (list, tuple)


def _method(name: str, value: object) -> str:
    if not isinstance(value, str):
        from visviva.integrators import Method

        if isinstance(value, Method):
            return value.name
    else:
        refuse_of_others(name, value)
    return _word(name, value)


def _word(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise InvalidInput(name, f"expected a name, got {type(value).__name__}")
    # Half a surrogate pair is no text to the core; what remains is refused there as an unknown name.
    return value if value.isascii() else value.encode(errors="replace").decode()


def _rule(name: str, value: object) -> str:
    if not isinstance(value, str):
        from visviva.typing import CollisionRule

        raise InvalidInput(name, f"expected one of {', '.join(get_args(CollisionRule))}, got {value!r}")
    return _word(name, value)


def _words(name: str, value: object) -> list[str]:
    if isinstance(value, str):
        return [_word(name, value)]
    if not isinstance(value, Iterable):
        raise InvalidInput(name, f"expected a name or several names, got {value!r}")
    return [_word(name, word) for word in value]


def _tolerances(name: str, value: object) -> tuple[list[float] | None, list[float] | None]:
    """Of positions and of velocities: one number for all bodies, or one for each."""
    if isinstance(value, Mapping):
        kinds = ("position", "velocity")
        if not value or not set(value) <= set(kinds):
            raise InvalidInput(name, f"expected the keys 'position' and 'velocity', or one of them, got {list(value)}")
        given = {kind: _numbers(f"{name}[{kind!r}]", value[kind]) for kind in value}
        return given.get(kinds[0]), given.get(kinds[1])
    both = _numbers(name, value)
    return both, both


def _numbers(name: str, value: object) -> list[float]:
    several = getattr(value, "ndim", int(isinstance(value, _SEQUENCE))) > 0
    return float_array(name, value, (None,)).tolist() if several else [number(name, value)]


def _step(name: str, value: object) -> float:
    if isinstance(value, _SEQUENCE) or getattr(value, "ndim", 0) > 0:
        raise InvalidInput(
            name,
            "expected one number, the length of every step, got several: a symplectic method whose steps change from "
            "one to the next is no symplectic map, and its energy drifts; give one dt and a time_transformation, which "
            "lets steps change in time and keeps the map, or name an adaptive method such as verner98",
        )
    return number(name, value)


def _or_none(check: Callable[[str, object], _Check]) -> Callable[[str, object], _Check | None]:
    return lambda name, value: None if value is None else check(name, value)


def _events(_: str, given: object) -> list[dict[str, Any]]:
    if isinstance(given, tuple | list) and not given:
        return []
    from visviva._event_descriptions import to_core

    return to_core(given)


def _sent_to_core(check: Callable[[str, object], object]) -> dict[str, Any]:
    """For a field that the core is told of, by the field's name, as ``check(name, value)``."""
    return {"check": check}


# The relative tolerance where nothing is said, of a method that somebody has named; `auto` holds steps to less.
_RTOL = 1e-9


@cache
def fixed_steps() -> frozenset[str]:
    """Names of the methods that choose no step."""
    return frozenset(method["name"] for method in _core.methods(rigid=True) if not method["adaptive"])


# What is recorded of points if nothing is said; of rigid bodies how they turn, too.
_RECORDED: tuple[ColumnName, ...] = ("position", "velocity")


@dataclass(frozen=True, kw_only=True)
class PlanRequest:
    """What is asked of a scene. Its fields are the arguments of ``plan``, and of ``run`` too."""

    t: ArrayLike = field(kw_only=False)
    method: MethodName | Method = field(default="auto", metadata=_sent_to_core(_method))
    dt: float | None = field(default=None, metadata=_sent_to_core(_or_none(_step)))
    time_transformation: TransformationName | None = field(default=None, metadata=_sent_to_core(_or_none(_word)))
    rtol: float | None = field(default=None, metadata=_sent_to_core(_or_none(number)))
    atol: ArrayLike | Mapping[str, ArrayLike] | None = field(
        default=None, metadata=_sent_to_core(_or_none(_tolerances))
    )
    max_step: float | None = field(default=None, metadata=_sent_to_core(_or_none(number)))
    max_steps: int | None = field(default=None, metadata=_sent_to_core(_or_none(whole_number)))
    record: ColumnName | Sequence[ColumnName] = field(default=_RECORDED, metadata=_sent_to_core(_words))
    events: Sequence[Event | EventFunction] = field(default=(), metadata=_sent_to_core(_events))
    collisions: CollisionRule | None = field(default=None, metadata=_sent_to_core(_or_none(_rule)))
    restitution: float | None = field(default=None, metadata=_sent_to_core(_or_none(number)))

    def to_core(self, prepared: _core._Scene, names: tuple[str, ...]) -> _core._Request:
        """What ``_core.run`` and ``_core.plan`` both take, of a scene of bodies with these names."""
        t = self.t
        # An array or a sequence is output times; anything else must be one number, and `number` says so.
        end_only = getattr(t, "ndim", int(hasattr(t, "__len__"))) == 0
        asked: dict[str, Any] = {
            **prepared,
            "times": np.array([number("t", t)]) if end_only else float_array("t", t, (None,)),
            "end_only": end_only,
        }
        for name, default, ready, check in _OPTIONS:
            value = getattr(self, name)
            asked[name] = ready if value is default else check(name, value)
        if prepared["rigid"] is not None and self.record is _RECORDED:
            asked["record"] = [*_RECORDED, "orientation", "angular_velocity"]
        asked["rtol_given"] = self.rtol is not None
        if self.rtol is None:
            asked["rtol"] = _RTOL
        elif asked["method"] in fixed_steps():
            raise InvalidInput(
                "rtol",
                f"{asked['method']} has a fixed step, dt, which nothing else changes: expected none, got {self.rtol}; "
                f"leave rtol out and choose dt, or name an adaptive method such as verner98",
            )
        if asked["events"]:
            from visviva._event_descriptions import of_scene

            asked["events"] = of_scene(asked["events"], names, prepared["position"].shape[1])
        return cast("_core._Request", asked)


@dataclass(frozen=True, kw_only=True)
class RunRequest(PlanRequest):
    """What is asked of a scene, and how it is run. Its fields are the arguments of ``run``."""

    threads: int | None = None
    progress: Progress = False
    executor: Executor | None = None
    save_every: float | None = None
    save_to: str | PathLike[str] | None = None


@dataclass(frozen=True, kw_only=True)
class StreamRequest(PlanRequest):
    """What is asked of an ensemble that is written while it runs: the arguments of ``run_to_parquet``."""

    to: str | PathLike[str]
    copies_at_once: int | None = None
    threads: int | None = None
    progress: Progress = False


@dataclass(frozen=True)
class FlowRequest:
    """What is asked of derivatives of a flow: the arguments of ``flow_jacobian``."""

    t: ArrayLike
    method: MethodName | Method = field(default="auto", kw_only=True)
    dt: float | None = field(default=None, kw_only=True)
    rtol: float | None = field(default=None, kw_only=True)
    threads: int | None = field(default=None, kw_only=True)


@dataclass(frozen=True)
class BoundaryRequest:
    """What is asked of motions through two places: the arguments of ``boundary_value``."""

    t: float
    position: ArrayLike
    body: int | str | Sequence[int | str] | None = field(default=None, kw_only=True)
    method: MethodName | Method = field(default="auto", kw_only=True)
    dt: float | None = field(default=None, kw_only=True)
    rtol: float | None = field(default=None, kw_only=True)
    threads: int | None = field(default=None, kw_only=True)


@dataclass(frozen=True)
class MegnoRequest:
    """What is asked of neighboring motions: the arguments of ``megno``."""

    t: ArrayLike
    method: MethodName | Method = field(default="auto", kw_only=True)
    dt: float | None = field(default=None, kw_only=True)
    rtol: float | None = field(default=None, kw_only=True)
    seed: int = field(default=0, kw_only=True)
    threads: int | None = field(default=None, kw_only=True)


_STOPPED = Status.STOPPED

# Name, default, what the core is told if the default was left, and the check of anything else.
_OPTIONS = tuple(
    (option.name, option.default, option.metadata["check"](option.name, option.default), option.metadata["check"])
    for option in fields(PlanRequest)
    if "check" in option.metadata
)


def asked_by(
    request: Callable[_Parameters, _Request],
) -> Callable[[Callable[[_Self, _Request], _Result]], Callable[Concatenate[_Self, _Parameters], _Result]]:
    """Make a method of a request take the fields of the request as its arguments.

    Help, editors and type checkers see the fields as the method's own signature.

    Examples
    --------
    >>> import inspect, visviva as vv
    >>> list(inspect.signature(vv.Scene.plan).parameters)[:4]
    ['self', 't', 'method', 'dt']
    """

    def decorate(method: Callable[[_Self, _Request], _Result]) -> Callable[Concatenate[_Self, _Parameters], _Result]:
        own = Parameter("self", Parameter.POSITIONAL_OR_KEYWORD)
        asked_for = signature(request).parameters.values()
        shown = Signature([own, *asked_for], return_annotation=signature(method).return_annotation)

        @wraps(method)
        def asked(self: _Self, /, *args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Result:
            try:
                made = request(*args, **kwargs)
            except TypeError:
                shown.bind(self, *args, **kwargs)  # raises, in the words of this method's signature
                raise
            return method(self, made)

        vars(asked)["__signature__"] = shown
        asked.__annotations__ = {parameter.name: parameter.annotation for parameter in asked_for} | {
            "return": shown.return_annotation
        }
        return asked

    return decorate


def execute(
    prepared: _core._Scene,
    request: RunRequest,
    *,
    names: tuple[str, ...],
    ensemble: bool,
    make: Callable[[dict[str, Any]], _Result],
) -> _Result:
    """Run the request and make its result, or raise the core's error with the result attached."""
    if request.executor is not None:
        raise InvalidInput("executor", "one scene is one piece of work; scene.ensemble(...) has parts to send")
    asked = request.to_core(prepared, names)
    threads = None if request.threads is None else whole_number("threads", request.threads)
    run: Callable[..., dict[str, Any]] = partial(_core.run, ensemble=ensemble)
    if request.progress is False:
        result = run(asked, threads=threads, progress=None)
    else:
        from visviva._progress import callback

        shown = _counted(asked, ensemble) if request.progress is True else ()
        with callback(request.progress, *shown) as report:
            result = run(asked, threads=threads, progress=report)
    return finished(result, asked, threads, ensemble=ensemble, make=make)


def _counted(asked: _core._Request, ensemble: bool) -> tuple[str, tuple[float, float] | None]:
    """What progress is shown in, as `callback` takes it: what the core counts, or what that is a share of."""
    if ensemble:
        return "copies", (0.0, float(len(asked["mass"])))
    if _core.plan(asked)["solution"].startswith("closed form"):
        return "times", None
    if asked["dt"] is not None and asked["time_transformation"] is None:
        return "steps", None
    if asked["collisions"] is not None:
        return "", None  # each stretch between collisions is counted as if it were the last
    from visviva._progress import TIME

    return TIME, (float(asked["t0"]), float(asked["times"][-1]))


def finished(
    result: dict[str, Any],
    asked: _core._Request,
    threads: int | None,
    *,
    ensemble: bool,
    make: Callable[[dict[str, Any]], _Result],
) -> _Result:
    """The result of what the core gave, or the core's error with the result attached."""
    if asked["events"]:
        from visviva._event_descriptions import descriptions

        result["looked_for"] = descriptions(asked["events"])
    # As a number of Python: those of NumPy take a tenth of a short run to compare with it.
    if asked["end_only"] and not ensemble and result["status"].item(0) == _STOPPED:
        from visviva._stopped import ended_at_the_stop

        ended_at_the_stop(result, asked)
    made = make(result)
    if asked["rigid"] is not None:
        from visviva._rigid_accuracy import look

        look(result, asked, threads)
        if not cast("Any", made)._scene._turns_freely:
            from visviva._lost_spins import warn_of_lost_spins

            warn_of_lost_spins(asked, ensemble=ensemble)
    warn_if_unresolved(result, asked, ensemble=ensemble)
    if times_may_be_coarse(asked["t0"], asked["times"].item(-1) if asked["times"].size else asked["t0"]):
        from visviva._coarse_times import warn_of_coarse_times

        warn_of_coarse_times(cast("Any", made)._scene, asked)
    error = result["error"]
    if error is not None:
        raise _ended_early(error, made)
    if ensemble and (result["status"] == Status.INTERRUPTED).any():
        raise Interrupted("the ensemble was interrupted", cast("Any", made))
    return made


def __dir__() -> list[str]:
    return list(__all__)
