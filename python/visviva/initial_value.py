"""Initial value problems of any function, asked and answered as SciPy's ``solve_ivp`` does; the core solves them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from visviva import _core
from visviva._arrays import float_array, number
from visviva._compiled import compiled
from visviva._keywords import check_call, known_keywords
from visviva._ode_result import OdeResult, OdeSolution
from visviva.errors import Interrupted, InvalidInput, WrongArguments

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.typing import CompiledFunction, SolverName

__all__ = ["OdeResult", "OdeSolution", "solve_ivp"]

Function: TypeAlias = Callable[..., "ArrayLike"]

_SMALLEST_RTOL = 100 * 2.0**-52
#: Zeros of an event that are counted.
_COUNTABLE = 2**63
#: Roundings of the time in the shortest step, as in SciPy.
_ROUNDINGS = 10.0
#: Made once: a union of types takes longer to make than to ask.
_REAL, _ROW = float | np.floating, np.ndarray | list | tuple


@known_keywords
def solve_ivp(
    fun: Function | CompiledFunction,
    t_span: Sequence[float],
    y0: ArrayLike,
    method: SolverName | type = "RK45",
    t_eval: ArrayLike | None = None,
    dense_output: bool = False,
    events: Function | Sequence[Function] | None = None,
    vectorized: bool = False,
    args: Sequence[object] | NDArray[np.float64] | None = None,
    *,
    rtol: ArrayLike | None = None,
    atol: ArrayLike | None = None,
    first_step: float | None = None,
    max_step: float = math.inf,
    dt: float | None = None,
    min_step: object = None,
    jac: object = None,
    jac_sparsity: object = None,
    lband: object = None,
    uband: object = None,
) -> OdeResult:
    """Solve ``y' = f(t, y)`` from ``y(t0) = y0``.

    Arguments and result are those of ``scipy.integrate.solve_ivp``, and so are the norm of the error, the first step
    and the limits of the steps: equal tolerances lead to about equal steps.

    Parameters
    ----------
    fun : callable, int or LowLevelCallable
        The right-hand side: a function of Python ``fun(t, y, *args)`` of a float and an array of n numbers that
        returns n numbers, or a compiled function ``void f(double t, const double *y, double *rate, void *data)``, with
        or without the last: a ``@cfunc`` of numba or its address, a function of ctypes, a ``scipy.LowLevelCallable``. A
        compiled function runs without the GIL, and must be what it says: a wrong signature or address ends the process.
    t_span : (t0, tf)
        Where to start and to end, in the units of the problem. The end may be smaller, or infinite if an event ends the
        run.
    y0 : array_like, shape (n,)
        The state at t0, real numbers.
    method : str, optional
        ``"RK45"`` (= ``"dormand_prince54"``), ``"RK23"`` (= ``"bogacki_shampine32"``), ``"DOP853"`` (= ``"dop853"``),
        or the name of any explicit Runge-Kutta method of `visviva.methods`.
    t_eval : array_like, shape (T,), optional
        Times of the output, in the order of `t_span`. They do not steer: values between steps are interpolated.
    dense_output : bool, optional
        Whether the result gets ``sol``, the solution as a function of time.
    events : callable or sequence of callables, optional
        Functions ``event(t, y, *args)`` whose zeros are looked for where the sign changes from step to step, and
        located to round-off on the interpolant. ``event.terminal`` = True ends the run at the first zero, a number at
        that one; ``event.direction`` > 0 takes zeros on the way up only, < 0 on the way down only.
    vectorized : bool, optional
        Whether `fun` takes and returns states as columns (n, 1).
    args : tuple or array, optional
        Further arguments of `fun` and the events; for a compiled function an array of float64 of shape (k,), its
        ``data``.
    rtol, atol : float or array_like, shape (n,), optional
        The estimated error of each number in a step is kept to ``atol + rtol*abs(y)``, in the root mean square.
        By default 1e-3 and 1e-6, as SciPy's.
    first_step, max_step : float, optional
        The first step, and the longest.
    dt : float, optional
        The step of a method without step control, such as ``"rk4"``, and required by it; the last step ends at tf.
        Such a method takes none of the four before.
    min_step, jac, jac_sparsity, lband, uband : optional
        Arguments of SciPy's implicit methods; they have no effect, and a `UserWarning` says so.

    Returns
    -------
    OdeResult
        With ``t, y, sol, t_events, y_events, nfev, njev, nlu, status, message, success``.

    Raises
    ------
    visviva.InvalidInput
        By name, before anything runs: complex states, implicit methods, times out of order, and so on.
    visviva.Interrupted
        After Ctrl-C; ``trajectory`` holds what was computed.
    BaseException
        An exception of `fun` or of an event, the same object.

    References
    ----------
    E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), II.4 to II.6.

    Examples
    --------
    A stone that is thrown upwards, until it is back:

    >>> import numpy as np, visviva as vv
    >>> def height(t, y):
    ...     return y[0]
    >>> height.terminal, height.direction = True, -1
    >>> stone = vv.solve_ivp(lambda t, y: [y[1], -9.81], (0.0, 100.0), [0.0, 20.0], events=height)
    >>> bool(abs(stone.t[-1] - 2 * 20.0 / 9.81) < 1e-12), stone.message
    (True, 'A termination event occurred.')

    Lorenz's equations, at given times:

    >>> def lorenz(t, y, sigma, rho, beta):
    ...     return [sigma * (y[1] - y[0]), y[0] * (rho - y[2]) - y[1], y[0] * y[1] - beta * y[2]]
    >>> out = vv.solve_ivp(
    ...     lorenz, (0, 1), [1, 1, 1], "DOP853", t_eval=np.linspace(0, 1, 5), args=(10, 28, 8 / 3), rtol=1e-9, atol=1e-9
    ... )
    >>> out.y.shape, bool(abs(out.y[0, -1] + 9.378) < 1e-3)
    ((3, 5), True)
    """
    if not (min_step is jac is jac_sparsity is lband is uband is None):
        _warn_of_what_has_no_effect(
            {"min_step": min_step, "jac": jac, "jac_sparsity": jac_sparsity, "lband": lband, "uband": uband}
        )
    native = compiled(fun, args)
    if native is None and not callable(fun):
        raise InvalidInput("fun", f"expected a function f(t, y) or a compiled one, got {type(fun).__name__}")
    if native is not None and vectorized:
        raise InvalidInput("vectorized", "expected False for a compiled function, got True; leave vectorized out")
    span = _span(t_span)
    first = None if first_step is None else number("first_step", first_step)
    longest = None if max_step is None or (_endless(max_step) and max_step > 0.0) else number("max_step", max_step)
    if first is not None and longest is not None and 0.0 < longest < first <= abs(span[1] - span[0]):
        first = longest
    watched = _events(events)
    state = _state(y0)
    if state.size and math.isinf(span[1]) and all(last is None for _, _, last in watched):
        raise InvalidInput(
            "t_span", f"expected an end, got {span[1]:g} without an event that ends the run; give one, or set terminal"
        )
    asked: _core._Problem = {
        "method": _method(method),
        "span": span,
        "y0": state,
        "rtol": _relative(rtol),
        "atol": None if atol is None else _tolerance("atol", atol),
        "first_step": first,
        "max_step": longest,
        "dt": None if dt is None else _fixed_step(dt, span),
        "t_eval": None if t_eval is None else float_array("t_eval", t_eval, (None,)),
        "dense_output": _flag("dense_output", dense_output),
        "events": watched,
        "args": [] if native is not None or args is None else _unpacked(args),
        "vectorized": _flag("vectorized", vectorized),
        "compiled": None if native is None else native.where,
    }
    try:
        found = _core.solve_ivp(fun, asked)
    except TypeError:
        # Looked at only here: a signature costs as much as a run of a compiled function.
        _check_calls(fun if native is None else None, watched, asked["args"])
        raise
    result = _result(found, asked, looked_for=events is not None)
    if found["interrupted"]:
        raise Interrupted("the run was interrupted", result) from found["cause"]
    return result


def _result(found: _core._Solved, asked: _core._Problem, *, looked_for: bool) -> OdeResult:
    t, y = found["t"], found["y"].T
    # As SciPy has it, so that `if not result.t` goes on working: a run that ended before the first output has lists.
    nothing: Any = []
    early = asked["t_eval"] is not None and not t.size
    extension = found["extension"]
    zeros = found["zeros"] if looked_for else None
    # By position, in the order of the fields: their names cost as much as a hundred evaluations of a compiled function.
    return OdeResult(
        nothing if early else t,
        nothing if early else y,
        None if extension is None else OdeSolution(extension[0], extension),
        None if zeros is None else [times for times, _ in zeros],
        # An event without zeros has no states at all, as in SciPy.
        None if zeros is None else [states if times.size else np.empty(0) for times, states in zeros],
        found["nfev"],
        0,
        0,
        found["status"],
        found["message"],
        found["status"] >= 0,
    )


def _warn_of_what_has_no_effect(given: dict[str, object]) -> None:
    names = [f"`{name}`" for name, value in given.items() if value is not None]
    if names:
        warnings.warn(f"The following arguments have no effect for a chosen solver: {', '.join(names)}.", stacklevel=4)


def _method(method: object) -> str:
    if isinstance(method, type):
        # SciPy takes its classes too; they have the names. What others do is theirs alone.
        if not method.__module__.startswith("scipy.integrate."):
            raise InvalidInput(
                "method",
                f"expected a name, got the class {method.__qualname__}; scipy.integrate.solve_ivp runs solvers",
            )
        return method.__name__
    name = method
    if not isinstance(name, str):
        raise InvalidInput("method", f"expected a name, got {type(method).__name__}")
    return name if name.isascii() else name.encode(errors="replace").decode()


def _span(t_span: object) -> tuple[float, float]:
    times = list(t_span) if isinstance(t_span, Iterable) else []
    if len(times) != 2:
        raise InvalidInput("t_span", f"expected two times (t0, tf), got {t_span!r}")
    t0, end = times
    endless = _endless(end)
    start, last = number("t_span", t0), float(end) if endless else number("t_span", end)
    if not endless and math.isinf(last - start):
        raise InvalidInput("t_span", f"expected times that are less than 1.8e308 apart, got {start:g} and {last:g}")
    return start, last


def _endless(value: object) -> bool:
    return isinstance(value, _REAL) and math.isinf(value)


def _flag(name: str, value: object) -> bool:
    """Give what counts as true or false, as SciPy does; of an array neither is told."""
    try:
        return bool(value)
    except ValueError:
        raise InvalidInput(name, f"expected True or False, got an array of shape {np.asarray(value).shape}") from None


def _fixed_step(dt: object, span: tuple[float, float]) -> float:
    """Give a step, of ten roundings of the time at least: shorter ones would be others than was asked."""
    step = number("dt", dt)
    farthest = max((time for time in span if math.isfinite(time)), key=abs)
    if farthest + step != farthest and 0.0 < step < _ROUNDINGS * math.ulp(farthest):
        raise InvalidInput(
            "dt",
            f"expected a step of at least {_ROUNDINGS * math.ulp(farthest):.3g}, ten roundings of the time "
            f"{farthest:g}, got {step:g}; count time from the start of the run",
        )
    return step


def _state(y0: object) -> NDArray[np.float64]:
    array = np.asarray(y0)
    if array.dtype.kind == "c":
        raise InvalidInput(
            "y0",
            "expected real numbers, got complex ones; give real and imaginary parts as 2n numbers, "
            "y0 = [*y.real, *y.imag], or use scipy.integrate.solve_ivp",
        )
    if array.dtype == np.float64 and array.ndim == 1 and isinstance(y0, _ROW):
        # The core judges whether they are finite.
        as_it_is = array.flags.c_contiguous and array.flags.aligned
        return array if as_it_is else np.require(array, requirements=["C_CONTIGUOUS", "ALIGNED"])
    return float_array("y0", y0, (None,))


def _tolerance(name: str, value: object) -> list[float]:
    if type(value) is float and math.isfinite(value):
        return [value]
    array = float_array(name, value, None)
    if array.ndim > 1:
        raise InvalidInput(name, f"expected a number, or one for each of y0, got an array of shape {array.shape}")
    values: list[float] = np.atleast_1d(array).tolist()
    return values


def _relative(rtol: object) -> list[float] | None:
    if rtol is None:
        return None
    values = _tolerance("rtol", rtol)
    if any(value < _SMALLEST_RTOL for value in values):
        warnings.warn(
            f"At least one element of `rtol` is too small. Setting `rtol = np.maximum(rtol, {_SMALLEST_RTOL})`.",
            stacklevel=4,
        )
        values = [max(value, _SMALLEST_RTOL) for value in values]
    return values


def _unpacked(args: object) -> list[Any]:
    if not isinstance(args, Iterable):
        raise WrongArguments(
            "args", f"Supplied 'args' cannot be unpacked. Please supply `args` as a tuple (e.g. `args=({args},)`)"
        )
    return list(args)


def _events(events: Any) -> list[tuple[Function, float, int | None]]:
    if events is None:
        return []
    several = list(events) if not callable(events) and isinstance(events, Iterable) else [events]
    return [(event, _direction(event), _last(event)) for event in several]


def _check_calls(fun: Any, watched: list[tuple[Function, float, int | None]], args: list[Any]) -> None:
    """Refuse functions that do not take what they were called with; what they raise themselves is theirs."""
    places = ["t", "y", *(f"args[{index}]" for index in range(len(args)))]
    for argument, function in [("fun", fun), *(("events", event) for event, _, _ in watched)]:
        if function is not None:
            check_call(argument, function, places)


def _direction(event: Function) -> float:
    if not callable(event):
        raise InvalidInput("events", f"expected functions event(t, y), got {type(event).__name__}")
    return number("events", getattr(event, "direction", 0))


def _last(event: Function) -> int | None:
    """Give the number of the zero that ends the run; None if none does."""
    terminal = getattr(event, "terminal", None)
    if terminal is None or terminal == 0:
        return None
    if isinstance(terminal, bool | np.bool_):
        return 1
    numeric = isinstance(terminal, int | float | np.integer | np.floating)
    if numeric and 0 < terminal < _COUNTABLE and int(terminal) == terminal:
        return int(terminal)
    raise InvalidInput(
        "events", f"The `terminal` attribute must be a bool or a positive whole number, got {terminal!r}"
    )


def __dir__() -> list[str]:
    return list(__all__)
