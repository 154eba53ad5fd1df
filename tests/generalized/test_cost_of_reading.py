"""What Python takes to read an expression of SymPy, counted by calls: SymPy, which is slow, does no arithmetic."""

import numpy as np
import pytest
import sympy as sp
from calls import python_calls

import visviva as vv
from visviva.generalized._nodes import Nodes
from visviva.generalized._symbolic import Symbols


def free_bodies(count: int) -> tuple[sp.Expr, list[sp.Expr]]:
    """So many that move by themselves."""
    places = [vv.coordinate(f"x{i}") for i in range(count)]
    return sum(place.diff(vv.time) ** 2 for place in places), places


def calls_of(count: int) -> int:
    L, places = free_bodies(count)
    vv.Lagrangian(L, places)  # what is imported once, and what SymPy keeps
    return python_calls(lambda: vv.Lagrangian(L, places))


def test_coordinates_are_not_compared_with_each_other() -> None:
    """Twice as many cost twice as much; comparisons of all with all made it 3.5 times."""
    assert calls_of(80) < 2.2 * calls_of(40)


@pytest.mark.parametrize(
    "numbers", [[sp.Float(k + 0.1) for k in range(200)], [sp.Rational(2 * k + 1, 2) for k in range(200)]]
)
def test_a_number_is_not_evaluated_as_an_expression_is(numbers: list[sp.Expr]) -> None:
    """That took more than a hundred calls; its hash, conversion and node take less than forty."""
    x = sp.Symbol("x")
    trees = [x**number for number in numbers]
    known = Symbols(Nodes(), [x], [], [])
    assert python_calls(lambda: [known.node("L", tree) for tree in trees]) < 60 * len(trees)


@pytest.mark.parametrize(
    "number",
    [2, -3, 2**53 - 1, 0.1, -9.81, 5e-324, 1.7976931348623157e308, sp.Rational(1, 2), sp.Rational(-7, 8)],
)
def test_a_number_that_float64_holds_has_its_value(number: object) -> None:
    nodes = Nodes()
    place = Symbols(nodes, [sp.Symbol("x")], [], []).node("L", sp.sympify(number))
    np.testing.assert_equal(nodes.all[place], ("constant", [], float(number)))  # type: ignore[arg-type]


@pytest.mark.parametrize("number", [sp.oo, -sp.oo, sp.nan, sp.Float("1e400"), sp.Integer(10) ** 400])
def test_what_is_no_number_of_float64_is_refused(number: sp.Expr) -> None:
    with pytest.raises(vv.InvalidInput, match="expected finite real numbers"):
        Symbols(Nodes(), [sp.Symbol("x")], [], []).node("L", number)


@pytest.mark.parametrize(
    ("velocities", "wrong"),
    [("x v", "x"), ("v v", "v"), ("g v", "g"), ("t v", "t")],
    ids=["place", "own", "parameter", "time"],
)
def test_a_velocity_that_is_something_else_is_refused(velocities: str, wrong: str) -> None:
    x, y, g = sp.symbols("x y g")
    with pytest.raises(vv.InvalidInput, match=f"velocities: {wrong} is something else, too"):
        vv.Lagrangian(x * y, [x, y], velocities=sp.symbols(velocities), parameters={g: 1.0})
