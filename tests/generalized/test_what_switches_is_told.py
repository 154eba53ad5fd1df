"""What refusals of functions that switch tell to write, taken at their word: it is what it replaces.

Sums and halves of numbers of size 1 are rounded to 4e-16 each; motions are those of dop853 at 1e-12 past corners, at
which its steps begin anew, some of its tolerances each.
"""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

X, Y = np.random.default_rng(20_261_130).normal(size=(2, 200))
q, p = sp.symbols("q p")
x = vv.coordinate("x")
#: By their names what is refused, of two numbers, and what it is.
OF_NUMPY: dict[str, Callable[[Any, Any], Any]] = {
    "maximum": np.maximum,
    "fmax": np.fmax,
    "minimum": np.minimum,
    "fmin": np.fmin,
    "sign": lambda a, _: np.sign(a),
    "heaviside": lambda a, _: np.heaviside(a, 0.5),
}
OF_SYMPY: dict[str, tuple[Callable[[Any, Any], Any], str]] = {
    "Max": (sp.Max, "maximum"),
    "Min": (sp.Min, "minimum"),
    "sign": (lambda a, _: sp.sign(a), "sign"),
    "Heaviside": (lambda a, _: sp.Heaviside(a), "heaviside"),
}
#: What is refused of whom: equations of motion, and what is asked of a state.
ASKED: dict[str, Callable[[Any], Any]] = {
    "motion": lambda f: vv.Lagrangian(lambda q, v, t: v @ v - f(q[0], q[1]), ["x", "y"]),
    "force": lambda f: vv.ExpressionForce(force=lambda r, v, t: [f(r[0], r[1]), 0, 0]),
    "noether": lambda f: FREE.noether({"x": lambda q, v, t: f(q[0], q[1])}),
    "evaluate": lambda f: FREE.evaluate(lambda q, v, t: f(q[0], q[1])),
}
FREE = vv.Lagrangian(lambda q, v, t: v @ v / 2, ["x", "y"], position=[0.5, -0.25])
OSCILLATOR = vv.Hamiltonian(p**2 / 2 + q**2 / 2, q=[q], p=[p])
#: Two laws, below 0.25 and above it, that have one value there.
A = 0.25


def below(r: Any) -> Any:
    return r**2


def above(r: Any) -> Any:
    return A**2 + 3.0 * (r - A)


def told(refused: Callable[[], Any]) -> str:
    with pytest.raises(vv.InvalidInput) as error:
        refused()
    return error.value.message


def formula(message: str) -> str:
    """What is to be written."""
    found = re.search(r"write ([^,]*), ", message)
    assert found
    return found[1]


def valued(text: str, **names: Any) -> Any:
    return eval(text, {"np": np, "abs": np.abs, "Abs": np.abs, "tanh": np.tanh, **names})


@pytest.mark.parametrize("asked", ASKED)
@pytest.mark.parametrize("name", OF_NUMPY)
def test_what_is_told_of_numpys_functions_is_the_same(name: str, asked: str) -> None:
    written = formula(told(lambda: ASKED[asked](OF_NUMPY[name])))
    np.testing.assert_allclose(valued(written, x=X, y=Y), OF_NUMPY[name](X, Y), rtol=0, atol=2e-15)
    # And taken where the other was refused.
    ASKED[asked](lambda a, b: eval(written, {"x": a, "y": b}))


@pytest.mark.parametrize("name", OF_SYMPY)
def test_what_is_told_of_sympys_functions_is_the_same(name: str) -> None:
    function, same = OF_SYMPY[name]
    messages = [
        told(lambda: vv.Hamiltonian(p**2 / 2 + function(q, p), q=[q], p=[p])),
        told(lambda: OSCILLATOR.poisson(q, p * function(q, p))),
        told(lambda: OSCILLATOR.is_canonical([sp.Abs(q), p * function(q, p)])),
        told(lambda: OSCILLATOR.evaluate(function(q, p))),
    ]
    for message in messages:
        written = formula(message)
        np.testing.assert_allclose(valued(written, x=X, y=Y), OF_NUMPY[same](X, Y), rtol=0, atol=2e-15)
    assert "inside a step" in messages[0]
    for message in messages[1:]:
        assert "step" not in message
        assert "run" not in message
        assert "ask of each part by itself" in message


@pytest.mark.parametrize("symbols", [False, True])
@pytest.mark.parametrize("asked", ["motion", "question", "distance"])
def test_two_laws_that_meet_are_written_as_one(asked: str, symbols: bool) -> None:
    piecewise: Any
    if symbols:
        R = sp.Symbol("r") if asked == "distance" else q
        piecewise = sp.Piecewise((below(R), R < A), (above(R), True))
    refused: dict[tuple[str, bool], Callable[[], Any]] = {
        ("motion", True): lambda: vv.Hamiltonian(p**2 / 2 + piecewise, q=[q], p=[p]),
        ("question", True): lambda: OSCILLATOR.evaluate(piecewise),
        ("distance", True): lambda: vv.potentials.Custom(piecewise),
        ("motion", False): lambda: vv.Lagrangian(
            lambda q, v, t: v @ v - np.where(q[0] < A, below(q[0]), above(q[0])), ["x"]
        ),
        ("question", False): lambda: FREE.evaluate(lambda q, v, t: below(q[0]) if q[0] < A else above(q[0])),
        ("distance", False): lambda: vv.potentials.Custom(lambda r: np.where(r < A, below(r), above(r))),
    }
    message = told(refused[asked, symbols])
    assert "write f(s) + g(l) - g(a)" in message
    variable = "r" if asked == "distance" else "x"
    s, l_ = (
        valued(found[1], a=A, **{variable: X})
        for found in (
            re.search(rf"smaller of {variable} and a, (.*?), and l", message),
            re.search(r"l the larger, (\(.*?\) ?/ ?2)", message),
        )
        if found
    )
    expected = np.where(X < A, below(X), above(X))
    np.testing.assert_allclose(below(s) + above(l_) - above(A), expected, rtol=0, atol=4e-15)
    if asked != "question":
        blend = re.search(r"f \+ \(g - f\) ?\* ?\(1 \+ (np\.)?tanh\(\(\w - a\) ?/ ?width\)\) ?/ ?2", message)
        assert blend
        near = valued(blend[0], f=below(X), g=above(X), a=A, width=1e-3, **{variable: X})
        far = np.abs(X - A) > 0.02  # tanh of 20 is 1 to round-off
        np.testing.assert_allclose(near[far], expected[far], rtol=0, atol=4e-15)
    assert ("dop853" in message) == (asked == "motion")


def test_a_function_of_python_is_told_what_the_larger_of_two_is() -> None:
    message = told(lambda: FREE.evaluate(lambda q, v, t: max(q[0], q[1])))
    found = re.search(r"max\(x, y\) is (.*?);", message)
    assert found
    np.testing.assert_allclose(valued(found[1], x=X, y=Y), np.maximum(X, Y), rtol=0, atol=2e-15)


def test_a_spring_of_two_stiffnesses_is_that_of_two_halves() -> None:
    """Half a swing on each side: π/√2 where max(x, 0) adds its own, and π elsewhere."""
    valley = vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - x**2 / 2 - (x + sp.Abs(x)) ** 2 / 8, [x], position=[1.0])
    period = np.pi * (1.0 + np.sqrt(0.5))
    out = valley.run([0.0, 10.0 * period], method="dop853")
    # Twenty corners at some tolerances of 1e-12 each; a place at rest is flat in time.
    np.testing.assert_allclose(out["x"], [1.0, 1.0], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("valley", "period"),
    [(lambda r: ((r + abs(r)) / 2) ** 2 / 2 + r**2 / 2, np.pi * (1 + np.sqrt(0.5))), (abs, 32**0.5)],
)
def test_a_corner_costs_what_it_is_told_to(valley: Callable[[Any], Any], period: float) -> None:
    """Ten to forty steps of dop853 at each; equal steps keep no order there: halving them gains less than 16."""
    system = vv.Lagrangian(lambda q, v, t: v @ v / 2 - valley(q[0]), ["x"], position=[1.0])
    assert "takes ten to forty steps of dop853" in told(
        lambda: vv.Lagrangian(lambda q, v, t: np.maximum(q[0], 0.0), ["x"])
    )
    span = 10.0 * period
    corners = 20
    steps = system.run(span, method="dop853").stats.steps
    between = corners * 12  # of half a swing, that has none
    assert 10 * corners <= steps <= 40 * corners + between
    errors = [np.ptp(system.run(np.linspace(0, span, 101), method="rk4", dt=dt).energy) for dt in (0.02, 0.01)]
    assert errors[0] / errors[1] < 10.0


def test_an_event_that_switches_is_two_or_one_of_numbers() -> None:
    event = vv.events.expression(lambda q, v, t: np.maximum(q[0], q[1]))
    message = told(lambda: FREE.run(1.0, events=[event]))
    assert "ask of each part by itself" in message
    assert "vv.events.function" in message
