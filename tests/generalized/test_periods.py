"""Periods in units of any size, and what stands still."""

from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x = vv.coordinate("x")
EPSILON = 2.0**-52


def moving(potential: Any, place: float, speed: float = 0.0) -> vv.Lagrangian:
    return vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - potential, [x], position=[place], velocity=[speed])


@pytest.mark.parametrize("place", [1e-100, 1e-20, 1e-10, 1e10])
def test_a_small_swing_is_none_the_less_one(place: float) -> None:
    """Nothing is measured against 1: 8 ε as for a swing of 1."""
    assert vv.systems.oscillator(k=1.0, m=1.0, position=[place]).period() == pytest.approx(2 * np.pi, rel=8 * EPSILON)
    if place < 1.0:
        pushed = vv.systems.oscillator(k=1.0, m=1.0, position=[0.0], velocity=[place])
        assert pushed.period() == pytest.approx(2 * np.pi, rel=8 * EPSILON)
        assert vv.systems.pendulum(g=1.0, position=[place]).period() == pytest.approx(2 * np.pi, rel=8 * EPSILON)


def test_the_period_of_a_quartic_in_other_units() -> None:
    """x⁴/4 from 1, and with lengths of 1e-30."""
    wanted = moving(x**4 / 4, 1.0).period()
    assert wanted == pytest.approx(float(4 * mpmath.sqrt(2) * mpmath.ellipk(-1)), rel=1e-14)
    assert moving(x**4 / 4 * sp.Float(1e60), 1e-30).period() == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize(
    ("potential", "place"),
    [(x**2 / 2, 0.0), (sp.cos(x), 0.0), (x**4 / 4 - x**2 / 2, 1.0), (-sp.cos(x - 0.7), 0.7), (sp.cos(x), np.pi)],
)
def test_what_stands_still_is_refused_as_that(potential: Any, place: float) -> None:
    with pytest.raises(vv.InvalidInput, match="stands still"):
        moving(potential, place).period()
