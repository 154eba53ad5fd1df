"""Expressions: from SymPy and from functions, every operation and function, their values, derivatives and trees.

Bounds: 16 to 32 EPSILON are what a function and its derivative may lose to the rounding of its argument, of which one
was seen; trees of random operations cancel, to some ten roundings of terms of size 1; a power n loses n EPSILON.
"""

import operator
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from asking import rates

import visviva as vv

EPSILON = 2.0**-52
x, u = sp.symbols("x u")

# Name, places where it is asked, and how SymPy and NumPy call it.
FUNCTIONS: dict[str, tuple[list[float], Any, Any]] = {
    "sin": ([-3.0, 1e-9, 0.7, 25.0, 1e5], sp.sin, np.sin),
    "cos": ([-3.0, 1e-9, 0.7, 25.0, 1e5], sp.cos, np.cos),
    "tan": ([-1.2, 1e-9, 0.7, 2.5], sp.tan, np.tan),
    "exp": ([-30.0, -1.0, 1e-9, 0.3, 20.0], sp.exp, np.exp),
    "log": ([1e-9, 0.3, 1.0 + 1e-9, 3.0, 1e20], sp.log, np.log),
    "sqrt": ([1e-9, 0.3, 1.0, 3.0, 1e20], sp.sqrt, np.sqrt),
    "sinh": ([-5.0, 1e-9, 0.3, 20.0], sp.sinh, np.sinh),
    "cosh": ([-5.0, 1e-9, 0.3, 20.0], sp.cosh, np.cosh),
    "tanh": ([-300.0, -40.0, -5.0, 1e-9, 0.3, 20.0], sp.tanh, np.tanh),
    "asin": ([-0.9, 1e-9, 0.3, 0.999], sp.asin, np.arcsin),
    "acos": ([-0.9, 1e-9, 0.3, 0.999], sp.acos, np.arccos),
    "atan": ([-9.0, 1e-9, 0.3, 1e9], sp.atan, np.arctan),
    "asinh": ([-9.0, 1e-9, 0.3, 1e9], sp.asinh, np.arcsinh),
    "acosh": ([1.0001, 1.5, 30.0], sp.acosh, np.arccosh),
    "atanh": ([-0.9, 1e-9, 0.3, 0.999], sp.atanh, np.arctanh),
}


def system(potential: Any) -> vv.Lagrangian:
    return vv.Lagrangian(u**2 / 2 - potential, [x], velocities=[u], position=[0.5])


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_and_their_derivatives(name: str) -> None:
    places, symbolic, numeric = FUNCTIONS[name]
    by_symbols = system(symbolic(x))
    by_function = vv.Lagrangian(lambda q, v, _: v[0] ** 2 / 2 - numeric(q[0]), ["x"], position=[0.5])
    for place in places:
        # 1 − tanh² takes as many digits as its place is far out.
        with mpmath.workdps(320):
            exact = mpmath.mpf(place)
            value = sp.lambdify(x, symbolic(x), "mpmath")(exact)
            slope = sp.lambdify(x, symbolic(x).diff(x), "mpmath")(exact)
            bend = sp.lambdify(x, symbolic(x).diff(x, 2), "mpmath")(exact)
        for one in (by_symbols, by_function):
            function = symbolic(x) if one is by_symbols else lambda q, _v, _t: numeric(q[0])
            found = one.at(position=[place]).evaluate(function)[0]
            assert found == pytest.approx(float(value), rel=4 * EPSILON, abs=0.0)
            # Where a slope changes fast, the rounding of the place tells.
            lost = 1.0 + abs(float(bend / slope) * place) if slope else 1.0
            force = -rates(one, 0.0, [place], [0.0])[0]
            assert force == pytest.approx(float(slope), rel=16 * EPSILON * lost, abs=0.0)


@pytest.mark.parametrize("place", [-800.0, -356.0, -19.0, 0.0, 1e-8, 0.6, 5.0, 40.0, 350.0, 711.0, 1e5])
def test_a_wall_of_tanh_is_felt_where_it_is_flat(place: float) -> None:
    """The force is −sech²; 1 − tanh² has none of its digits beyond 19."""
    wall = system(sp.tanh(x)).at(position=[place])
    with mpmath.workdps(800):
        fall = 1 / mpmath.cosh(mpmath.mpf(place)) ** 2
    force = rates(wall, 0.0, [place], [0.0])[0]
    assert force == pytest.approx(-float(fall), rel=2 * EPSILON, abs=5e-324)


@pytest.mark.parametrize(
    ("symbolic", "place"),
    [
        (sp.cot(x), 0.7),
        (sp.sec(x), 0.7),
        (sp.csc(x), 0.7),
        (sp.coth(x), 0.7),
        (sp.sech(x), 0.7),
        (sp.csch(x), 0.7),
        (sp.Abs(x), -0.7),
        (x**7, -1.3),
        (x**-3, -1.3),
        (x ** sp.Rational(5, 2), 1.3),
        (x ** sp.Rational(-1, 3), 1.3),
        (x**sp.pi, 1.3),
        (2**x, 1.3),
        ((1 + x**2) ** sp.sin(x), 0.4),
        (sp.Rational(1, 3) * x + sp.Float("0.1") * x**2 + sp.E - sp.GoldenRatio * x, 0.4),
        (sp.exp(-x) * sp.log(x) / sp.sqrt(1 + x), 0.4),
    ],
)
def test_what_sympy_writes_otherwise(symbolic: Any, place: float) -> None:
    one = system(symbolic)
    slope = sp.sign(x) if symbolic == sp.Abs(x) else symbolic.diff(x)
    value, slope = (each.xreplace({x: sp.Float(place, 40)}).evalf(30) for each in (symbolic, slope))
    assert one.at(position=[place]).evaluate(symbolic)[0] == pytest.approx(float(value), rel=32 * EPSILON, abs=0)
    assert -rates(one, 0.0, [place], [0.0])[0] == pytest.approx(float(slope), rel=16 * EPSILON, abs=0)


@pytest.mark.parametrize("size", [1e-300, 1e-9, 1.0, 1e200])
@pytest.mark.parametrize("angle", [-3.1415926, -3.0, -2.4, -1.6, -1e-9, 1e-300, 0.3, 0.9, 1.5707963, 2.2, 3.1415926])
def test_angles_of_points(angle: float, size: float) -> None:
    """In all directions, next to the axes too, where quotients and differences lose digits."""
    y = sp.Symbol("y")
    place = [size * np.cos(angle), size * np.sin(angle)]
    one = vv.Lagrangian(
        sp.Symbol("u") ** 2 / 2 + sp.Symbol("w") ** 2 / 2 - sp.atan2(y, x),
        [x, y],
        velocities=[sp.Symbol("u"), sp.Symbol("w")],
        position=place,
    )
    true = mpmath.atan2(mpmath.mpf(place[1]), mpmath.mpf(place[0]))
    assert one.evaluate(sp.atan2(y, x))[0] == pytest.approx(float(true), rel=2 * EPSILON, abs=0)
    if 1e-100 < size < 1e100:
        # The force is that of the angle: (y, -x)/(x² + y²).
        square = mpmath.mpf(place[0]) ** 2 + mpmath.mpf(place[1]) ** 2
        force = [float(place[1] / square), float(-place[0] / square)]
        assert rates(one, 0.0, place, [0.0, 0.0])[:2] == pytest.approx(force, rel=8 * EPSILON, abs=0)


def test_numpy_and_sympy_record_the_same_angles() -> None:
    place, values = [-0.8], {"a": 1e-6}
    one = vv.Lagrangian(lambda q, v, t, a: v[0] ** 2 / 2, ["x"], parameters=values, position=place)
    assert one.evaluate(lambda q, v, t, a: np.arctan2(a, q[0]))[0] == np.arctan2(1e-6, -0.8)
    assert one.evaluate(lambda q, v, t, a: np.arctan2(q[0], 2.0))[0] == pytest.approx(
        np.arctan2(-0.8, 2.0), rel=1e-15, abs=0
    )
    assert one.evaluate(lambda q, v, t, a: np.arctan2(2.0, q[0]))[0] == pytest.approx(
        np.arctan2(2.0, -0.8), rel=1e-15, abs=0
    )


def test_python_operators_record_what_they_do() -> None:
    values = {"a": 1.7, "b": -0.6}
    both = vv.Lagrangian(
        lambda q, v, _, a, b: (v[0] ** 2 + v[1] ** 2) / 2, ["x", "y"], parameters=values, position=[0.3, 2.5]
    )
    cases: list[Any] = [
        lambda q, p: q[0] + q[1],
        lambda q, p: 2 + q[0] - 3.5,
        lambda q, p: 3.5 - q[0],
        lambda q, p: q[0] - q[1] - p["a"],
        lambda q, p: -q[0] * 4 * q[1],
        lambda q, p: +q[0] / 3,
        lambda q, p: 3 / q[1] / q[0],
        lambda q, p: q[1] ** 3 + q[1] ** -2 + q[1] ** 0.5 + q[1] ** 2.3,
        lambda q, p: q[1] ** p["a"] + 2 ** q[0] + q[1] ** q[0],
        lambda q, p: abs(-q[1]) + abs(p["b"] * q[0]),
        lambda q, p: np.float64(2.5) * q[0] + np.int64(3) / q[1] - np.float32(0.5),
        lambda q, p: q[0] * np.float64(2.5) + q[1] / np.int64(3),
        lambda q, p: np.sqrt(q[0]) * np.exp(q[1]) + np.log(q[1]),
        lambda q, p: np.dot(np.array([q[0], q[1]]), np.array([1.5, -2.0])) + np.sum(np.array(q) ** 2),
        lambda q, p: np.hypot(3.0, 4.0) * q[0],
        lambda q, p: np.sin(p["a"]) * 2 + p["b"],
        lambda q, p: 3.25,
        lambda q, p: np.pi,
        lambda q, p: True * q[0],
    ]
    for case in cases:
        found = both.evaluate(lambda q, v, _, a, b, case=case: case(q, {"a": a, "b": b}))[0]
        wanted = case([0.3, 2.5], values)
        assert found == pytest.approx(float(wanted), rel=16 * EPSILON, abs=0), cases.index(case)


def test_time_and_velocities_are_there() -> None:
    one = vv.Lagrangian(
        lambda q, v, t, k: v[0] ** 2 / 2 - k * t * q[0], ["x"], parameters={"k": 2.0}, position=[3.0], velocity=[5.0]
    )
    assert list(one.at(t0=7.0).evaluate(lambda q, v, t, k: t, lambda q, v, t, k: v[0] * q[0] + k)) == [7.0, 17.0]
    out = one.run([1.0, 2.0])
    along = one.evaluate(lambda q, v, t, k: t * q[0], lambda q, v, t, k: v[0], trajectory=out)
    assert np.array_equal(along, np.stack([out.t * out.position[:, 0], out.velocity[:, 0]], axis=1))
    t = sp.Symbol("t")
    assert vv.Lagrangian(u**2 / 2, [x], velocities=[u], position=[1.0], t0=4.0).evaluate(vv.time**2, t + u)[0] == 16.0
    assert vv.time == t
    assert (vv.time + 1, 2 * vv.time, 1 - vv.time, -vv.time, vv.time / 2, 2**vv.time) == (
        t + 1,
        2 * t,
        1 - t,
        -t,
        t / 2,
        2**t,
    )


@pytest.mark.parametrize("seed", range(20))
def test_random_trees_come_back(seed: int) -> None:
    """To the core and back: what is shown has the value of what was given, and so has its value in lanes."""
    random = np.random.default_rng([17, seed])
    k = sp.Symbol("k")
    leaves = [x, u, k, sp.Symbol("t"), sp.Integer(2), sp.Rational(1, 3), sp.Float(0.7)]

    def tree(depth: int) -> Any:
        if depth == 0 or random.uniform() < 0.1:
            return leaves[random.integers(len(leaves))]
        a, b = tree(depth - 1), tree(depth - 1)
        kind = random.integers(9)
        if kind < 3:
            return [operator.add, operator.sub, operator.mul][kind](a, b)
        return [
            lambda: a / (2 + b**2),
            lambda: sp.sin(a),
            lambda: sp.exp(-(a**2) / 4),
            lambda: sp.sqrt(1 + a**2),
            lambda: sp.atan(a) * b,
            lambda: sp.log(2 + a**2) - sp.tanh(b),
        ][kind - 3]()

    expression = tree(5)
    one = vv.Lagrangian(u**2 / 2 + expression * 0 + expression, [x], velocities=[u], parameters={k: 0.9})
    (shown,) = one._shown("function")
    for _ in range(3):
        at = {x: random.normal(), u: random.normal(), k: 0.9, sp.Symbol("t"): random.normal()}
        exact = {symbol: sp.Float(value, 40) for symbol, value in at.items()}
        value = float((u**2 / 2 + expression).xreplace(exact).evalf(30))
        assert float(shown.xreplace(exact).evalf(30)) == pytest.approx(value, rel=4e-15, abs=4e-15)
        state = one.at(position=[at[x]], velocity=[at[u]], t0=at[sp.Symbol("t")])
        assert state.evaluate(expression + u**2 / 2)[0] == pytest.approx(value, rel=1e-14, abs=1e-14)


@pytest.mark.parametrize("power", [3, 50, 64, 65, 100, 101, 1000])
def test_whole_powers_are_known_below_zero(power: int) -> None:
    """Beyond 64 they were exponentials of logarithms, and NaN there."""
    system = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - q[0] ** power, ["x"], position=[-0.999])
    exact = (-0.999) ** power
    assert abs(system.energy - exact) <= power * np.finfo(float).eps * abs(exact)


def test_the_time_is_compared_as_its_symbol_is() -> None:
    t = sp.Symbol("t")
    assert ((vv.time > 1), (vv.time >= 1), (vv.time < 1), (vv.time <= 1)) == ((t > 1), (t >= 1), (t < 1), (t <= 1))
