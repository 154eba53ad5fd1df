"""Plain functions of Python: what arrays of coordinates do, and what is refused by name."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import visviva as vv

Function = Callable[[Any, Any, Any], Any]
PLACE, SPEED = np.array([0.3, 0.4]), np.array([0.1, 0.2])
CENTER = np.array([1.0, 2.0])
MASS = np.array([[2.0, 0.5], [0.5, 1.0]])

MEANT: dict[str, Function] = {
    "@": lambda q, v, t: v @ v / 2 - q @ q / 2,
    "**": lambda q, v, t: (v**2).sum() / 2 - np.sum(q**2) / 2,
    "array": lambda q, v, t: v @ v / 2 - (q - CENTER) @ (q - CENTER) / 2,
    "coordinate * array": lambda q, v, t: v @ (q[0] * v) / 2 + np.dot(v, v) / 2,
    "coordinate + array": lambda q, v, t: v @ v / 2 - ((q[0] + q) @ (q[1] - q) + (1.0 / q).sum() + (q / q[0])[1]),
    "matrix": lambda q, v, t: v @ MASS @ v / 2 - np.cos(q).sum(),
    "norm": lambda q, v, t: v @ v / 2 - np.linalg.norm(q),
    "cbrt": lambda q, v, t: v @ v / 2 - np.cbrt(-q[0]) - np.cbrt(q).sum(),
    "exp2": lambda q, v, t: v @ v / 2 - np.exp2(q[0]),
    "near one": lambda q, v, t: v @ v / 2 - np.expm1(q[0]) - np.log1p(q[1]),
    "logarithms": lambda q, v, t: v @ v / 2 - np.log2(q[0]) - np.log10(q[1]),
    "degrees": lambda q, v, t: v @ v / 2 - np.deg2rad(q[0]) - np.radians(q[1]) - np.rad2deg(q[1]) - np.degrees(q[0]),
    "hypot": lambda q, v, t: v @ v / 2 - np.hypot(q[0], q[1]) - np.hypot(3.0, q[0]) - np.hypot(q[0], 2.0),
    "array of none": lambda q, v, t: np.asarray(v @ v / 2),
}


@pytest.mark.parametrize("name", MEANT)
def test_a_function_of_arrays_is_what_numpy_makes_of_it(name: str) -> None:
    """Energy v ∂L/∂v − L, for an L of the second degree in v: L(v) + L(−v) − 2 L(0) is twice the kinetic energy."""
    f = MEANT[name]
    energy = (f(PLACE, SPEED, 0.0) + f(PLACE, -SPEED, 0.0)) / 2 - 2 * f(PLACE, 0 * SPEED, 0.0)
    system = vv.Lagrangian(f, ["x", "y"], position=PLACE, velocity=SPEED)
    # A dozen roundings of numbers up to 23 (degrees).
    assert system.energy == pytest.approx(energy, abs=1e-14, rel=1e-14)


@pytest.mark.parametrize("function", [np.expm1, np.log1p])
@pytest.mark.parametrize("x", [1e-300, 1e-17, 1e-8, 0.3, 1.0, 40.0, 300.0])
def test_what_cancels_beside_one_keeps_its_digits(function: Callable[[Any], Any], x: float) -> None:
    written = vv.potentials.Custom(function)
    # Two elementary functions and three operations, each good to an ulp or two.
    assert float(written.value(x)) == pytest.approx(float(function(x)), rel=4e-15, abs=0.0)
    assert float(vv.potentials.Custom(lambda r: function(-r)).value(x / 301.0)) == pytest.approx(
        float(function(-x / 301.0)), rel=4e-15, abs=0.0
    )


def test_motion_in_a_valley_of_cube_roots_is_that_of_quadrature() -> None:
    """V = x⁴ᐟ³ = x·cbrt(x), smooth off 0: T = 4/√2·∫₀¹ dx/√(1 − x⁴ᐟ³) = 4/√2·(3/4)·B(3/4, 1/2)."""
    from math import gamma, pi, sqrt

    period = 4 / sqrt(2) * 0.75 * gamma(0.75) * sqrt(pi) / gamma(1.25)
    valley = vv.Lagrangian(lambda q, v, t: v @ v / 2 - q[0] * np.cbrt(q[0]), ["x"], position=[1.0])
    out = valley.run([period / 2, period])
    # The force is continuous but not smooth at 0: dop853 (rtol 1e-12) makes its steps small there.
    np.testing.assert_allclose(out["x"], [-1.0, 1.0], rtol=0, atol=1e-9)


REFUSED: dict[str, tuple[Function, str]] = {
    "//": (lambda q, v, t: v @ v - q[0] // 2, "x // y leaps"),
    "%": (lambda q, v, t: v @ v - q[0] % 2, "x % y leaps"),
    "number %": (lambda q, v, t: v @ v - 2 % q[0], "x % y leaps"),
    "array %": (lambda q, v, t: v @ v - (q % 2).sum(), "x % y leaps"),
    "mod": (lambda q, v, t: v @ v - np.mod(q[0], 2), "x % y leaps"),
    "divmod": (lambda q, v, t: divmod(q[0], 2)[0], "divmod"),
    "heaviside": (lambda q, v, t: v @ v - np.heaviside(q[0], 0), "/ 2, which steps follow"),
    "heaviside of an array": (lambda q, v, t: v @ v - np.heaviside(q, 0).sum(), "tanh"),
    "sign": (lambda q, v, t: v @ v - np.sign(q[0]), "np.tanh(x / width), which steps follow"),
    "nextafter": (lambda q, v, t: v @ v - np.nextafter(q[0], 1), "Functions that the core knows: sin"),
    "copysign": (lambda q, v, t: v @ v - np.copysign(1, q[0]), "Functions that the core knows: sin"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_leaps_or_is_not_known_is_refused_by_name(name: str) -> None:
    f, cure = REFUSED[name]
    with pytest.raises(vv.InvalidInput) as refused:
        vv.Lagrangian(f, ["x", "y"])
    assert refused.value.argument == "L"
    assert cure in refused.value.message


def test_errors_of_ones_own_are_ones_own() -> None:
    def wrong(q: Any, v: Any, t: Any) -> Any:
        return v @ v + len(3)  # type: ignore[arg-type]

    with pytest.raises(TypeError, match="no len") as raised:
        vv.Lagrangian(wrong, ["x"])
    assert not isinstance(raised.value, vv.Error)


def test_functions_of_floats_are_those_of_numbers() -> None:
    for of_floats, of_numbers in ((np.fabs, np.abs), (lambda x: np.float_power(x, 3.0), lambda x: x**3)):
        one, other = (
            vv.Lagrangian(lambda q, v, t, f=f: v[0] ** 2 / 2 - f(q[0]), ["x"], position=[1.0]).run(1.0)
            for f in (of_floats, of_numbers)
        )
        assert np.array_equal(one.position, other.position)
