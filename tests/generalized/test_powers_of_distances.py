"""Odd powers of distances and speeds where these are zero: the forces are zero there, and not 0/0.

Bounds: runs at rtol = 1e-12; a closed form to some roundings, 1e-14.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
vx, vy = x.diff(vv.time), y.diff(vv.time)
k = sp.Symbol("k")


@pytest.mark.parametrize("power", [3, 5, sp.Rational(3, 2) * 2, sp.Rational(7, 2) * 2])
@pytest.mark.parametrize("strength", [1, k], ids=["number", "parameter"])
def test_from_the_middle_of_an_odd_power(power: sp.Expr, strength: sp.Expr) -> None:
    """V = |x|ⁿ at energy 1/2: the run starts where the distance is zero, and keeps its energy."""
    given = {"parameters": {k: 1.0}} if strength == k else {}
    system = vv.Lagrangian(vx**2 / 2 - strength * sp.Abs(x) ** power, [x], position=[0.0], velocity=[1.0], **given)
    out = system.run([0.0, 1.0, 7.0])
    assert out.position[1, 0] > 0.0
    # The third derivative jumps in the middle (n = 3): what steps across it leave.
    np.testing.assert_allclose(out.energy, 0.5, rtol=0.0, atol=1e-9)


def test_from_the_middle_of_a_distance_in_the_plane() -> None:
    """(x² + y²)^(3/2) from the center goes along a line, as |x|³ does."""
    plane = vv.Lagrangian(
        (vx**2 + vy**2) / 2 - (x**2 + y**2) ** sp.Rational(3, 2), [x, y], position=[0.0, 0.0], velocity=[1.0, 0.0]
    ).run(2.0)
    line = vv.Lagrangian(vx**2 / 2 - sp.Abs(x) ** 3, [x], position=[0.0], velocity=[1.0]).run(2.0)
    np.testing.assert_allclose(plane.position[-1], [line.position[-1, 0], 0.0], rtol=0, atol=1e-12)


def test_what_brakes_by_the_square_of_the_speed_lets_go_from_rest() -> None:
    """Rayleigh's k|v|³/3 under a constant force: v = tanh(t √k)/√k, from rest."""
    system = vv.Lagrangian(
        vx**2 / 2 + x,
        [x],
        dissipation=k * sp.Abs(vx) ** 3 / 3,
        parameters={k: 0.25},
        position=[0.0],
        velocity=[0.0],
    )
    out = system.run([1.0, 4.0])
    np.testing.assert_allclose(out.velocity[:, 0], np.tanh(0.5 * np.array([1.0, 4.0])) / 0.5, rtol=1e-12)


def test_a_root_squared_is_what_it_is_of() -> None:
    """√s √s needs no root: an oscillator written by its distance starts in the middle."""
    written = vv.Lagrangian(vx**2 / 2 - sp.Abs(x) ** 2 / 2, [x], position=[0.0], velocity=[1.0]).run(2.0)
    assert written.position[-1, 0] == pytest.approx(np.sin(2.0), abs=1e-14)
