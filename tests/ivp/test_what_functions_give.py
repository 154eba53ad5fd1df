"""What the functions of an initial value problem may give, and what is refused of them by name."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def decay(t: float, y: np.ndarray) -> np.ndarray:
    return -y


def last(event: Callable[..., Any], terminal: Any) -> Callable[..., Any]:
    event.terminal = terminal  # type: ignore[attr-defined]
    return event


@pytest.mark.parametrize("form", ["objects", "matrix", "column"])
def test_numbers_that_are_objects_are_numbers(form: str) -> None:
    forms: dict[str, Callable[[float, np.ndarray], Any]] = {
        "objects": lambda t, y: np.array([y[1], -y[0]], dtype=object),
        "matrix": lambda t, y: sympy.Matrix([sympy.Float(y[1], 17), sympy.Float(-y[0], 17)]),
        "column": lambda t, y: np.array([[y[1]], [-y[0]]]),
    }
    found = vv.solve_ivp(forms[form], (0, 1), [1.0, 0.0], rtol=1e-9, atol=1e-9)
    plain = vv.solve_ivp(lambda t, y: [y[1], -y[0]], (0, 1), [1.0, 0.0], rtol=1e-9, atol=1e-9)
    assert np.array_equal(found.y, plain.y)


@pytest.mark.parametrize("got", [None, "high", 1j, np.zeros(2)], ids=["None", "str", "complex", "array"])
def test_an_event_gives_one_real_number(got: object) -> None:
    name = type(got).__name__
    with pytest.raises(vv.InvalidInput, match=f"events: expected one real number from an event, got {name}"):
        vv.solve_ivp(decay, (0, 1), [1.0], events=lambda t, y: got)


@pytest.mark.parametrize(
    "got", [np.array([object()]), np.array(["a"]), None, [None]], ids=["object", "str", "None", "list"]
)
def test_a_right_hand_side_gives_real_numbers(got: object) -> None:
    with pytest.raises(vv.InvalidInput, match="fun: expected 1 real numbers as in y0, got"):
        vv.solve_ivp(lambda t, y: got, (0, 1), [1.0])


def test_an_event_that_is_no_number_where_its_sign_changes_is_refused() -> None:
    """It was told as a zero at the end of the hole; a root of a negative number makes one."""

    def hole(t: float, y: np.ndarray) -> float:
        return float(np.sign(t - 0.5)) * math.sqrt(abs(t - 0.5) - 0.1) if abs(t - 0.5) > 0.1 else math.nan

    with pytest.raises(vv.InvalidInput, match="events: expected numbers, but event 0 is not a number at t = 0"):
        vv.solve_ivp(decay, (0, 1), [1.0], max_step=0.3, events=hole)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rtol": [[1e-3]]}, r"rtol: expected a number, or one for each of y0, got an array of shape \(1, 1\)"),
        ({"atol": [[1e-3, 1e-3]]}, "atol: expected a number, or one for each of y0"),
        ({"fun": -1}, "fun: expected the address of void"),
        ({"fun": 2**70}, "fun: expected the address of void"),
        ({"events": last(lambda t, y: 1.0, math.inf)}, "events: The `terminal` attribute must be a bool"),
        ({"events": last(lambda t, y: 1.0, 1e30)}, "events: The `terminal` attribute must be a bool"),
        ({"t_span": (0, math.inf)}, "t_span: expected an end, got inf without an event that ends the run"),
        ({"t_span": (0, -math.inf), "events": [lambda t, y: 1.0]}, "t_span: expected an end, got -inf without"),
    ],
)
def test_refusals(options: dict[str, Any], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message):
        vv.solve_ivp(**{"fun": decay, "t_span": (0, 1), "y0": [1.0], **options})


def test_a_solution_is_not_written_to() -> None:
    solution = vv.solve_ivp(decay, (0, 1), [1.0], dense_output=True).sol
    assert solution is not None
    with pytest.raises(ValueError, match="read-only"):
        solution.ts[0] = 5.0
