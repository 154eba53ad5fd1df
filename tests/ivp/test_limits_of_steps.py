"""Steps that are bounded as was asked, results that are asked like SciPy's, and methods of others."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv


def pulse(t: float, y: np.ndarray) -> list[float]:
    """One hundred for a hundredth: 1 in all."""
    return [100.0 if 0.25 < t < 0.26 else 0.0]


def test_no_step_is_longer_than_the_longest_also_the_first() -> None:
    """A first step of 0.9 would pass over the pulse; ends of the pulse inside of steps cost 2 × 0.1."""
    found = vv.solve_ivp(pulse, (0.0, 1.0), [0.0], max_step=1e-3, first_step=0.9)
    # Some roundings of the time.
    assert np.diff(found.t).max() <= 1e-3 * (1.0 + 1e-12)
    assert found.y[0, -1] == pytest.approx(1.0, abs=0.2)
    back = vv.solve_ivp(lambda t, y: -y, (1.0, 0.0), [1.0], max_step=0.01, first_step=0.5)
    assert np.diff(back.t).min() >= -0.01 * (1.0 + 1e-12)
    with pytest.raises(vv.InvalidInput, match="first_step"):
        vv.solve_ivp(pulse, (0.0, 1.0), [0.0], max_step=1e-3, first_step=2.0)


@pytest.mark.parametrize(("span", "dt"), [((1.7e9, 1.7e9 + 1e-3), 1e-6), ((1e15, 1e15 + 1.0), 0.13)])
def test_a_step_that_the_time_rounds_is_refused(span: tuple[float, float], dt: float) -> None:
    """Steps of ten roundings were taken in its place: 420 for 1000."""
    with pytest.raises(vv.InvalidInput, match=r"roundings of the time|moves the time"):
        vv.solve_ivp(lambda t, y: -y, span, [1.0], "euler", dt=dt)


def test_times_further_apart_than_numbers_go_are_refused() -> None:
    """The way between them is infinite, and no step ended it."""
    with pytest.raises(vv.InvalidInput, match="apart"):
        vv.solve_ivp(lambda t, y: -y, (-1e308, 1e308), [1.0])


def test_a_result_is_asked_like_a_dictionary() -> None:
    """As SciPy's is one."""
    found = vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0])
    assert "y" in found
    assert "x" not in found
    assert list(found) == found.keys()
    assert len(found) == len(found.values()) == 11
    assert dict(found.items())["t"] is found.t
    assert found.get("status") == 0
    assert found.get("nothing", 3) == 3


def test_a_solver_of_the_users_own_is_refused() -> None:
    """By its name alone it would be taken for SciPy's, and not run."""
    integrate = pytest.importorskip("scipy.integrate")

    class RK45(integrate.RK45):  # type: ignore[name-defined, misc]
        """Another solver of that name."""

    with pytest.raises(vv.InvalidInput, match=r"the class .*RK45; scipy.integrate.solve_ivp runs"):
        vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], RK45)
    assert vv.solve_ivp(lambda t, y: -y, (0.0, 1.0), [1.0], integrate.RK45).success


@pytest.mark.parametrize("t0", [0.0, 2.46e6, -7.5e8, 1.7e9])
@pytest.mark.parametrize("method", ["DOP853", "RK45"])
def test_times_far_from_zero_cost_no_digits(t0: float, method: str) -> None:
    """In seconds since 1970 half a rounding is 1e-7: nodes, outputs, events and the solution are at their own times."""
    rate = 2 * np.pi
    outputs = t0 + np.arange(41) * 0.25

    def turns(t: float, y: np.ndarray) -> list[float]:
        return [rate * y[1], -rate * y[0]]

    def asked(**more: object) -> vv.OdeResult:
        return vv.solve_ivp(turns, (t0, t0 + 10.0), [0.0, 1.0], method, rtol=1e-10, atol=1e-11, **more)

    # What a turn of rtol 1e-10 comes to after ten turns, with what RK45's interpolant adds.
    off = 2e-8
    at_times, nodes = asked(t_eval=outputs), asked(dense_output=True, events=lambda t, y: y[0] - 0.3)
    assert np.abs(at_times.y[0] - np.sin(rate * (outputs - t0))).max() < off
    assert np.abs(nodes.y[0] - np.sin(rate * (nodes.t - t0))).max() < off
    assert nodes.sol is not None
    assert np.abs(nodes.sol(outputs)[0] - np.sin(rate * (outputs - t0))).max() < off
    assert nodes.t_events is not None
    assert nodes.y_events is not None
    # An event's time is a number; what moves in half its rounding is the state's.
    assert np.abs(nodes.y_events[0][:, 0] - 0.3).max() < rate * np.spacing(abs(t0)) + off
    assert len(nodes.t_events[0]) == 20
