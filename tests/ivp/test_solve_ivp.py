"""`vv.solve_ivp`: what SciPy's tests do not ask."""

import ctypes
import os
import pickle
import signal
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import _core

FIRST_ORDER = [m for m in vv.methods() if m.coefficients and not (m.symplectic or "stormer" in m.name)]
NAMES = [m.name for m in FIRST_ORDER]
ADAPTIVE = [m.name for m in FIRST_ORDER if m.adaptive]


def how(name: str) -> dict[str, Any]:
    return {"rtol": 1e-9, "atol": 1e-9} if name in ADAPTIVE else {"dt": 1 / 128}


def error(name: str) -> float:
    """What is left of so many times of about 1: 1e-9 of each of some 2000 steps at most; of fixed steps hᵖ of each."""
    order = next(method.order for method in FIRST_ORDER if method.name == name)
    return 1e-6 if name in ADAPTIVE else 10 * 128.0**-order


def oscillator(t: float, y: np.ndarray) -> list[float]:
    return [y[1], -y[0]]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("end", [10.0, -10.0])
def test_every_method_that_takes_first_order_systems(name: str, end: float) -> None:
    out = vv.solve_ivp(oscillator, (0, end), [1, 0], name, dense_output=True, **how(name))
    assert out.success
    assert out.t[-1] == end
    t = np.linspace(0, end, 301)
    exact = np.array([np.cos(t), -np.sin(t)])
    assert out.sol is not None
    assert np.abs(out.sol(t) - exact).max() < error(name)
    assert np.abs(out.y - np.array([np.cos(out.t), -np.sin(out.t)])).max() < error(name)


@pytest.mark.parametrize(("scipy_name", "own"), [("RK23", "bogacki_shampine32"), ("RK45", "dormand_prince54")])
def test_both_names_are_one_method(scipy_name: str, own: str) -> None:
    a, b = (vv.solve_ivp(oscillator, (0, 5), [1, 0], name) for name in (scipy_name, own))
    assert np.array_equal(a.y, b.y)
    assert a.nfev == b.nfev


@pytest.mark.parametrize("method", ["RK23", "RK45", "DOP853"])
@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
def test_equal_tolerances_cost_what_they_cost_in_scipy(method: str, rtol: float) -> None:
    integrate = pytest.importorskip("scipy.integrate")

    def pendulum(t: float, y: np.ndarray) -> list[float]:
        return [y[1], -np.sin(y[0]) - 0.1 * y[1] + np.cos(t)]

    ours, theirs = (
        solve(pendulum, (0, 30), [1.0, 0.0], method=method, rtol=rtol, atol=1e-3 * rtol)
        for solve in (vv.solve_ivp, integrate.solve_ivp)
    )
    # The same formulas and choices, but for the power in the choice of the step, which is rounded to 1.2e-4: on the
    # brink of rejection a step may tip.
    assert ours.nfev == pytest.approx(theirs.nfev, rel=0.03, abs=2 * 12)
    if rtol <= 1e-6:
        assert np.allclose(ours.y[:, -1], theirs.y[:, -1], rtol=0, atol=20 * rtol)


@pytest.mark.parametrize(
    "form",
    [
        lambda values: values,
        tuple,
        np.array,
        lambda values: np.array(values, dtype=np.float32),
        lambda values: np.array(values)[:, np.newaxis],
        lambda values: [np.float64(values[0]), np.array(values[1])],
        lambda values: np.array([values[0], 0.0, values[1], 0.0])[::2],
    ],
)
def test_what_a_function_may_return(form: Callable[[Sequence[float]], Any]) -> None:
    out = vv.solve_ivp(lambda t, y: form([float(y[1]), float(-y[0])]), (0, 1), [1, 0])
    # SciPy's default tolerance is 1e-3 a step; measured 2.4e-5.
    assert out.y[0, -1] == pytest.approx(np.cos(1), abs=1e-4)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (None, "fun: expected 2 real numbers as in y0, got NoneType"),
        ([1.0], "fun: expected 2 real numbers as in y0, got 1"),
        ([1.0, 2.0, 3.0], "fun: expected 2 real numbers as in y0, got 3"),
        (0.0, "fun: expected 2 real numbers as in y0, got 1"),
        (["a", "b"], "fun: expected 2 real numbers as in y0, got list"),
        ([1.0, 2.0j], "fun: expected 2 real numbers as in y0, got complex ones"),
    ],
)
def test_what_a_function_may_not_return(value: object, message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message):
        vv.solve_ivp(lambda t, y: value, (0, 1), [1, 0])


def test_states_that_a_function_keeps_stay_what_they_were() -> None:
    kept: list[np.ndarray] = []
    copies: list[np.ndarray] = []

    def fun(t: float, y: np.ndarray) -> np.ndarray:
        kept.append(y)
        copies.append(y.copy())
        return -y

    vv.solve_ivp(fun, (0, 1), [1.0, 2.0])
    assert all(np.array_equal(a, b) for a, b in zip(kept, copies, strict=True))
    assert len({id(y) for y in kept}) == len(kept)


def test_a_function_that_writes_into_its_argument_changes_nothing_else() -> None:
    def fun(t: float, y: np.ndarray) -> np.ndarray:
        y *= -1.0
        return y

    plain = vv.solve_ivp(lambda t, y: -y, (0, 1), [1.0])
    assert np.array_equal(vv.solve_ivp(fun, (0, 1), [1.0]).y, plain.y)


class Odd(Exception):
    pass


@pytest.mark.parametrize("where", ["fun", "event", "start"])
def test_an_exception_comes_out_as_the_same_object(where: str) -> None:
    odd = Odd("here")

    def fun(t: float, y: np.ndarray) -> np.ndarray:
        if where == "start" or (where == "fun" and t > 0.5):
            raise odd
        return -y

    def event(t: float, y: np.ndarray) -> float:
        if where == "event" and t > 0.5:
            raise odd
        return 1.0

    with pytest.raises(Odd) as caught:
        vv.solve_ivp(fun, (0, 1), [1.0], events=event)
    assert caught.value is odd


@pytest.mark.parametrize("kind", ["python", "compiled"])
def test_ctrl_c_gives_what_was_computed(kind: str) -> None:
    def fun(t: float, y: np.ndarray) -> list[float]:
        return [y[1], -y[0]]

    given = fun if kind == "python" else with_numba()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(vv.Interrupted) as caught:
        vv.solve_ivp(given, (0, 1e12), [1.0, 0.0], t_eval=np.arange(1e6), rtol=1e-6)
    # Within 0.2 s, and as much again for a busy machine.
    assert time.monotonic() - start < 0.3 + 0.4
    out = caught.value.trajectory
    assert isinstance(out, vv.OdeResult)
    assert not out.success
    assert out.t.size > 100
    # A tolerance of 1e-6 for each of a hundred steps; measured 4.4e-5.
    assert np.allclose(out.y[0, :100], np.cos(out.t[:100]), rtol=0.0, atol=2e-4)


# Compiled functions ---------------------------------------------------------------------------------------------------

POINTER = ctypes.POINTER(ctypes.c_double)
PLAIN = ctypes.CFUNCTYPE(None, ctypes.c_double, POINTER, POINTER)
WITH_DATA = ctypes.CFUNCTYPE(None, ctypes.c_double, POINTER, POINTER, POINTER)


def _oscillator(t: float, y: Any, rate: Any) -> None:
    rate[0], rate[1] = y[1], -y[0]


def _with_frequency(t: float, y: Any, rate: Any, data: Any) -> None:
    rate[0], rate[1] = y[1], -(data[0] ** 2) * y[0]


def with_numba() -> Any:
    """A function that is compiled in truth: one of ctypes that calls Python would swallow a Ctrl-C that comes there."""
    numba = pytest.importorskip("numba")
    kind = numba.types.void(numba.float64, numba.types.CPointer(numba.float64), numba.types.CPointer(numba.float64))
    return numba.cfunc(kind)(_oscillator)


def test_a_function_of_numba() -> None:
    out = vv.solve_ivp(with_numba(), (0, 10), [1, 0])
    assert np.array_equal(out.y, vv.solve_ivp(oscillator, (0, 10), [1, 0]).y)


# Functions of C that call Python: no speed, but the way of every compiled function.
COMPILED = PLAIN(_oscillator)
COMPILED_WITH_DATA = WITH_DATA(_with_frequency)


@pytest.mark.parametrize("name", NAMES)
def test_a_compiled_function_gives_the_bits_of_the_same_in_python(name: str) -> None:
    events = {"events": lambda t, y: y[0], "dense_output": True}
    python = vv.solve_ivp(oscillator, (0, 10), [1, 0], name, **events, **how(name))
    address = ctypes.cast(COMPILED, ctypes.c_void_p).value
    for fun in (COMPILED, address):
        out = vv.solve_ivp(fun, (0, 10), [1, 0], name, **events, **how(name))
        assert np.array_equal(out.y, python.y)
        assert np.array_equal(out.t_events[0], python.t_events[0])
        assert np.array_equal(out.sol(np.linspace(0, 10, 77)), python.sol(np.linspace(0, 10, 77)))
        assert out.nfev == python.nfev


def test_a_compiled_function_gets_its_data() -> None:
    out = vv.solve_ivp(COMPILED_WITH_DATA, (0, 1), [1, 0], args=np.array([2.0]), rtol=1e-9, atol=1e-9)
    # Some steps of 1e-9; measured 2e-10.
    assert out.y[0, -1] == pytest.approx(np.cos(2.0), abs=2e-9)


def test_a_low_level_callable() -> None:
    scipy = pytest.importorskip("scipy")
    plain = scipy.LowLevelCallable(COMPILED)
    # The default tolerance is 1e-3, and 1e-6 below: measured 2.4e-5 and 9.1e-9.
    assert vv.solve_ivp(plain, (0, 1), [1, 0]).y[0, -1] == pytest.approx(np.cos(1.0), abs=1e-4)
    frequency = (ctypes.c_double * 1)(2.0)
    with_data = scipy.LowLevelCallable(COMPILED_WITH_DATA, ctypes.cast(frequency, ctypes.c_void_p))
    out = vv.solve_ivp(with_data, (0, 1), [1, 0], rtol=1e-6)
    assert out.y[0, -1] == pytest.approx(np.cos(2.0), abs=1e-7)
    with pytest.raises(vv.InvalidInput, match=r"args: .*user_data"):
        vv.solve_ivp(with_data, (0, 1), [1, 0], args=np.array([2.0]))


def test_compiled_functions_of_other_signatures_are_refused() -> None:
    other = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(lambda t: t)
    with pytest.raises(vv.InvalidInput, match="fun: expected a compiled function void f"):
        vv.solve_ivp(other, (0, 1), [1])
    with pytest.raises(vv.InvalidInput, match="args: expected none"):
        vv.solve_ivp(COMPILED, (0, 1), [1, 0], args=np.array([1.0]))
    with pytest.raises(vv.InvalidInput, match="vectorized"):
        vv.solve_ivp(COMPILED, (0, 1), [1, 0], vectorized=True)
    with pytest.raises(vv.InvalidInput, match="fun: expected the address"):
        vv.solve_ivp(0, (0, 1), [1, 0])


def test_a_compiled_function_runs_without_the_gil() -> None:
    done = threading.Event()
    count = 0

    def counter() -> None:
        nonlocal count
        while not done.is_set():
            count += 1

    thread = threading.Thread(target=counter)
    thread.start()
    # The function itself is Python's here and takes the GIL for each call; that the others run at all shows that it is
    # given back.
    vv.solve_ivp(COMPILED, (0, 20), [1, 0], rtol=1e-8)
    done.set()
    thread.join()
    assert count > 0


# Arguments ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "Radau"}, r"method: Radau is implicit.*scipy.*RK23, RK45, DOP853"),
        ({"method": "LSODA"}, "method: LSODA is implicit"),
        ({"method": "RK54"}, "method: expected one of RK23.*did you mean"),
        ({"method": "leapfrog"}, r"method: leapfrog takes equations q'' = a\(q\) alone"),
        ({"method": 45}, "method: expected a name, got int"),
        ({"y0": [1j]}, r"y0: expected real numbers, got complex ones; give real and imaginary"),
        ({"y0": [[1.0]]}, "y0: expected an array with one axis"),
        ({"t_span": (0, np.nan)}, "t_span"),
        ({"t_span": 3.0}, r"t_span: expected two times \(t0, tf\), got 3.0"),
        ({"t_eval": [0.2, 0.1]}, "t_eval: expected times in the order of t_span, got 0.2 before 0.1"),
        ({"t_eval": [0.2, 3.0]}, r"t_eval: expected times within t_span = \(0.0, 1.0\), got 3.0"),
        ({"atol": -1.0}, "atol: expected tolerances that are not negative, got -1.0"),
        ({"atol": [1e-3, 1e-3]}, "atol: expected one number or 1 as in y0, got 2"),
        ({"rtol": "small"}, "rtol: expected real numbers"),
        ({"max_step": 0.0}, "max_step: expected a positive number, got 0.0"),
        ({"first_step": 2.0}, "first_step: expected at most 1.0"),
        ({"dt": 0.1}, "dt: dormand_prince54 chooses its own steps"),
        ({"method": "rk4"}, "dt: expected a step"),
        ({"method": "rk4", "dt": 0.1, "rtol": 1e-3}, "rtol: rk4 has a fixed step, dt; leave rtol out"),
        ({"method": "rk4", "dt": 1e-30}, "dt: expected a step that moves the time"),
        ({"fun": 3.5}, "fun: expected a function"),
        ({"events": 3}, r"events: expected functions event\(t, y\), got int"),
        ({"events": [3]}, r"events: expected functions event\(t, y\), got int"),
        ({"rtoll": 1e-3}, "rtoll: .*did you mean 'rtol'"),
    ],
)
def test_refusals_by_name(options: dict[str, Any], message: str) -> None:
    given = {"fun": lambda t, y: -y, "t_span": (0, 1), "y0": [1.0], **options}
    with pytest.raises((vv.InvalidInput, TypeError), match=message):
        vv.solve_ivp(**given)


def test_arguments_of_implicit_methods_have_no_effect_and_say_so() -> None:
    with pytest.warns(UserWarning, match="no effect for a chosen solver: `min_step`, `lband`"):
        vv.solve_ivp(lambda t, y: -y, (0, 1), [1.0], min_step=1e-3, lband=1)


@pytest.mark.parametrize("name", NAMES)
def test_further_arguments_events_and_columns(name: str) -> None:
    def fun(t: float, y: np.ndarray, omega: float, damping: float) -> np.ndarray:
        assert y.shape == (2, 1)
        return np.array([omega * y[1], -omega * y[0]]) * damping

    def zero(t: float, y: np.ndarray, omega: float, damping: float) -> float:
        assert y.shape == (2,)
        return float(y[0] * damping)

    zero.terminal = 3  # type: ignore[attr-defined]
    zero.direction = -1  # type: ignore[attr-defined]
    out = vv.solve_ivp(fun, (0, 100), [1.0, 0.0], name, vectorized=True, args=(2.0, 1.0), events=zero, **how(name))
    assert out.status == 1
    exact = np.array([np.pi / 4, np.pi / 4 + np.pi, np.pi / 4 + 2 * np.pi])
    assert out.t_events is not None
    assert np.allclose(out.t_events[0], exact, rtol=0, atol=error(name))
    assert out.t[-1] == out.t_events[0][-1]
    assert np.abs(out.y_events[0][:, 0]).max() < 4e-15  # round-off of numbers of size 1


def test_a_zero_at_a_node_counts_once() -> None:
    out = vv.solve_ivp(lambda t, y: [1.0], (0, 4), [-2.0], "rk4", dt=1.0, events=lambda t, y: y[0])
    assert out.t_events is not None
    assert np.array_equal(out.t_events[0], [2.0])


def test_events_and_outputs_cost_no_more_evaluations_than_the_interpolant() -> None:
    plain = vv.solve_ivp(oscillator, (0, 20), [1, 0])
    watched = vv.solve_ivp(oscillator, (0, 20), [1, 0], events=lambda t, y: y[0], t_eval=np.linspace(0, 20, 50))
    assert watched.nfev == plain.nfev
    assert plain.nfev % 6 == 2  # two for the start, then six and not seven for each step
    assert vv.solve_ivp(oscillator, (0, 20), [1, 0], "RK23").nfev % 3 == 2


def test_results_behave_like_scipys() -> None:
    out = vv.solve_ivp(oscillator, (0, 3), [1, 0], dense_output=True)
    assert out["t"] is out.t
    assert set(dict(out)) == {
        "t", "y", "sol", "t_events", "y_events", "nfev", "njev", "nlu", "status", "message", "success",
    }  # fmt: skip
    assert out.t_events is None
    again = pickle.loads(pickle.dumps(out))
    assert np.array_equal(again.sol([0.5, 1.5]), out.sol([0.5, 1.5]))
    assert out.sol(0.5).shape == (2,)
    assert out.sol([0.5]).shape == (2, 1)
    assert (out.sol.t_min, out.sol.t_max) == (0.0, 3.0)
    with pytest.raises(vv.InvalidInput, match="t: expected one time"):
        out.sol([[0.5]])


def test_a_run_that_cannot_go_on_says_so_and_gives_what_it_has() -> None:
    with np.errstate(over="ignore"):
        out = vv.solve_ivp(lambda t, y: y**2, (0, 2), [1.0], rtol=1e-8)
    assert out.status == -1
    assert not out.success
    assert "step size is less than spacing" in out.message
    # The pole of y' = y² at a tolerance of 1e-8: measured 1.3e-7 beyond it.
    assert out.t[-1] == pytest.approx(1.0, abs=5e-7)
    assert np.isfinite(out.y).all()
    with np.errstate(over="ignore", invalid="ignore"):
        growing = vv.solve_ivp(lambda t, y: y**2, (0, 9), [1.0], "rk4", dt=0.5)
    assert growing.status == -1
    assert "infinite" in growing.message
    assert np.isfinite(growing.y).all()


def test_the_core_refuses_arrays_that_do_not_belong_together() -> None:
    empty = np.empty(0)
    with pytest.raises(vv.InternalError):
        _core.interpolate((empty, empty, empty, empty), np.array([1.0]))


def test_no_event_in_a_list_gives_lists_as_scipy_does() -> None:
    found = vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], events=[])
    assert found.t_events == []
    assert found.y_events == []
    assert vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0]).t_events is None
