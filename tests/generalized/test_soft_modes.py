"""A soft mode beside a stiff one: what linear equations keep of it where the sum of two stiffnesses is rounded.

V = A (x - y)²/2 + B (x + y)²/2 of unit masses: x + y turns with ω² = 2B, which A + B in float64 may hold no digit of.
"""

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
A, B = sp.symbols("A B")


def rate(q: sp.Expr) -> sp.Expr:
    return q.diff(vv.time)


def two(stiff: float, soft: float, told: bool) -> vv.Lagrangian:
    lagrangian = (rate(x) ** 2 + rate(y) ** 2) / 2 - A * (x - y) ** 2 / 2 - B * (x + y) ** 2 / 2
    start = {"position": [1.0, 0.5], "velocity": [0.0, 1e-3]}
    if told:
        return vv.Lagrangian(lagrangian.subs({A: sp.Float(stiff), B: sp.Float(soft)}), [x, y], **start)
    return vv.Lagrangian(lagrangian, [x, y], parameters={A: stiff, B: soft}, **start)


def exact(stiff: float, soft: float, t: float) -> tuple[float, float, float]:
    """x, y, and the size of both with what a rounding of the time turns them by."""
    with mp.workdps(40):
        slow, fast, t = mp.sqrt(2 * mp.mpf(soft)), mp.sqrt(2 * mp.mpf(stiff)), mp.mpf(t)
        together = mp.mpf("1.5") * mp.cos(slow * t) + mp.mpf(1e-3) / slow * mp.sin(slow * t)
        apart = mp.mpf("0.5") * mp.cos(fast * t) - mp.mpf(1e-3) / fast * mp.sin(fast * t)
        size = abs(together) + 1.5 + 1e-3 / slow + (mp.mpf("0.5") + 1e-3 / fast) * (1 + fast * t)
        return float((together + apart) / 2), float((together - apart) / 2), float(size)


@pytest.mark.parametrize("told", [True, False])
@pytest.mark.parametrize(("stiff", "soft"), [(1e3, 1e-3), (1e4, 1e-4), (1e6, 1e-6), (1e8, 1e-8), (0.1, 0.3)])
def test_the_soft_mode_keeps_its_digits(stiff: float, soft: float, told: bool) -> None:
    system = two(stiff, soft, told)
    assert system.plan(t=1.0).method == "matrix_exponential"
    for t in (1.0, 1.0 / np.sqrt(2.0 * soft)):
        found = system.run(t).position[-1]
        first, second, size = exact(stiff, soft, t)
        # Some roundings of the state.
        assert np.abs(found - [first, second]).max() <= 4e-16 * size


def test_free_bodies_on_springs_do_not_drift() -> None:
    """Three bodies in a row, on springs the sum of whose stiffnesses is rounded: their center stays where it is."""
    z = vv.coordinate("z")
    first, second = 0.1, 0.7
    energy = first * (x - y) ** 2 / 2 + second * (y - z) ** 2 / 2
    system = vv.Lagrangian(
        (rate(x) ** 2 + rate(y) ** 2 + rate(z) ** 2) / 2 - energy, [x, y, z], position=[1.0, 0.25, -1.25]
    )
    out = system.run(np.linspace(0.0, 1e6, 11))
    assert system.plan(t=1e6).method == "matrix_exponential"
    assert np.abs(out.position.sum(axis=1)).max() < 1e-15
