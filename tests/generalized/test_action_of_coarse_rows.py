"""Of rows that are too far apart to tell a motion the action is as far off as is told: by a run of many more rows.

Polynomials of fifth degree through rows were compared with cubic ones only, which may agree though both are wrong: a
pendulum of two rows three quarters of a turn apart was told 29 times as exact as it was.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

OSCILLATOR = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 2 / 2, ["x"], position=[0.3], velocity=[1.0])
HENON_HEILES = vv.Lagrangian(
    lambda q, v, t: (v[0] ** 2 + v[1] ** 2 - q[0] ** 2 - q[1] ** 2) / 2 - q[0] ** 2 * q[1] + q[1] ** 3 / 3,
    ["x", "y"],
    position=[0.1, 0.2],
    velocity=[0.3, 0.2],
)
KEPLER = vv.Lagrangian(
    lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + 1 / np.sqrt(q[0] ** 2 + q[1] ** 2),
    ["x", "y"],
    position=[1.0, 0.0],
    velocity=[0.0, 1.1],
)
SYSTEMS = {
    "pendulum": (vv.systems.pendulum(position=[2.0]), 1.3),
    "oscillator": (OSCILLATOR, 2 * np.pi),
    "Hénon–Heiles": (HENON_HEILES, 6.0),
    "planet": (KEPLER, 8.6),
}
#: Both runs are held to 1e-12 in each step, from rows at different places: up to a hundred steps between them add up.
ROUNDING = 1e-10


@pytest.mark.parametrize("rows", [2, 3, 4, 5, 8, 33])
@pytest.mark.parametrize("name", SYSTEMS)
def test_the_error_of_an_action_is_no_more_than_told(name: str, rows: int) -> None:
    system, period = SYSTEMS[name]
    for span in period * np.linspace(0.3, 4.0, 12):
        exactly = system.action(system.run(np.linspace(0.0, span, 1001)))
        found = system.action(system.run(np.linspace(0.0, span, rows)))
        assert abs(found.value - exactly.value) <= found.error + exactly.error + ROUNDING * abs(exactly.value)


@pytest.mark.parametrize("span", [15.622, 17.736, 20.906])
def test_far_too_few_rows_are_told_to_be_as_bad_as_they_are(span: float) -> None:
    """No more than the truth and what cubic polynomials make of it."""
    for sign in (1.0, -1.0):
        exactly = OSCILLATOR.action(OSCILLATOR.run(sign * np.linspace(0.0, span, 1001)))
        # ∫ (x'² − x²) dt/2 = x x'/2 between both ends, of which x x' is at most 0.55. Three turns in steps held to
        # 1e-12 are off by some of those, relative to it and, where x x' is next to 0.3, by themselves.
        x, v = (0.3 * np.cos(span) + sign * np.sin(span)), (np.cos(span) - sign * 0.3 * np.sin(span))
        assert exactly.value == pytest.approx((x * v - 0.3) / 2, rel=1e-11, abs=1e-12)
        found = OSCILLATOR.action(OSCILLATOR.run(sign * np.linspace(0.0, span, 3)))
        off = abs(found.value - exactly.value)
        assert off * (1.0 - ROUNDING) <= found.error <= 2.0 * off


@pytest.mark.parametrize("rows", [10, 30, 300])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rows_beside_kinks(rows: int, sign: float) -> None:
    """Of |x| from 1: x = 1 − t²/2 up to √2, so that a quarter of a period has ∫ (v²/2 − x) dt = √2/3 − 2√2/3."""
    system = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 - np.abs(q[0]), ["x"], position=[1.0])
    quarters = 14
    found = system.action(system.run(sign * np.linspace(0.0, quarters * np.sqrt(2.0), rows)))
    wanted = -sign * quarters * np.sqrt(2.0) / 3
    # Steps to 1e-12, each kink met to that.
    assert abs(found.value - wanted) <= found.error + 1e-10


def test_variations_of_few_rows() -> None:
    """The first variation of a motion vanishes, and that of a path through three of its rows within what is told."""
    out = OSCILLATOR.run(np.linspace(0.0, 9.282, 3))

    def vanishing(t: Any) -> Any:
        return np.sin(np.pi * t / 9.282)

    found = OSCILLATOR.first_variation(out, vanishing)
    # Of the motion itself nothing but the tolerance of its run is left.
    assert abs(found.value) <= found.error * (1.0 + ROUNDING)
    # Three rows in one and a half turns tell nothing: what is told to be open is of the order of 1, as |q| and |q̇| are.
    assert found.error > 0.1


def test_rows_that_tell_the_motion_are_judged_as_before() -> None:
    """Of a hundred rows per period cubic polynomials make the most."""
    out = OSCILLATOR.run(np.linspace(0.0, 2 * np.pi, 101))
    found = OSCILLATOR.action(out)
    # By the square of what a cubic of Hermite is off, x (2π/100)⁴/384 = 4e-8 of some ten rates: 1e-13 and rounding.
    assert found.error < 1e-11
