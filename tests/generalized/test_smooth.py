"""Taylor series of equations with roots, broken powers and inverse functions: right as long as nothing turns sharply,
and stopped where something does."""

from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, vx, vy = sp.symbols("x y vx vy", real=True)


def on_a_line(potential: Any, position: float, velocity: float) -> vv.Lagrangian:
    return vv.Lagrangian(vx**2 / 2 - potential, [x], velocities=[vx], position=[position], velocity=[velocity])


@pytest.mark.parametrize(
    ("potential", "position", "velocity"),
    [
        (sp.sqrt(1 + x**2), 2.0, 0.0),
        ((2 + sp.sin(x)) ** sp.Rational(5, 3), 1.0, 0.5),
        ((1 + x**4) ** sp.Rational(-3, 4), 0.25, 1.0),
        (sp.asin(sp.sin(x) / 2), 0.0, 0.25),
        (sp.acos(x / 8) ** 2, -2.0, 1.0),
        (sp.acosh(2 + x**2), 1.5, 0.0),
    ],
    ids=str,
)
def test_smooth_ones_move_as_by_other_methods(potential: Any, position: float, velocity: float) -> None:
    system = on_a_line(potential, position, velocity)
    by_series, wanted = (system.run(3.0, method=method, rtol=1e-13) for method in ("taylor", "gauss16"))
    # Both are exact but for rounding; motions of a few units on a line hardly magnify it.
    assert np.abs(by_series.position[-1] - wanted.position[-1]).max() < 2e-13
    assert np.abs(by_series.velocity[-1] - wanted.velocity[-1]).max() < 2e-13


@pytest.mark.parametrize("eccentricity", [0.0, 0.5, 0.9, 0.99])
def test_keplers_ellipse_in_cartesian_coordinates_closes(eccentricity: float) -> None:
    lagrangian = (vx**2 + vy**2) / 2 + 1 / sp.sqrt(x**2 + y**2)
    near = 1 - eccentricity
    system = vv.Lagrangian(
        lagrangian,
        [x, y],
        velocities=[vx, vy],
        position=[near, 0.0],
        velocity=[0.0, np.sqrt((1 + eccentricity) / near)],
    )
    period = float(2 * mpmath.pi)
    out = system.run(period, method="taylor", rtol=1e-14)
    # The period is off by three halves of the rounding of the energy, which near the center moves the body fastest.
    speed = float(np.hypot(*system.velocity))
    allowed = 1e-14 * speed / near
    assert np.abs(out.position[-1] - [near, 0.0]).max() < allowed * 3
    assert out.evaluations < 600


def test_a_step_goes_over_no_turn() -> None:
    # |x| as a root, from rest at 1: x = 1 - t²/2 until sqrt(2), where no series goes on.
    system = on_a_line(sp.sqrt(x**2), 1.0, 0.0)
    out = system.run(1.4, method="taylor")
    assert abs(out.position[-1, 0] - (1 - 1.4**2 / 2)) < 1e-15
    with pytest.raises(vv.ConvergenceError):
        system.run(2.0, method="taylor")


@pytest.mark.parametrize("end", [0.9, 2.5])
def test_a_triangle_is_not_taken_for_its_side(end: float) -> None:
    # asin(sin(x)) has the slope 1 until π/2, where the motion from 0.75 is at 1.28, and -1 from there.
    system = vv.Lagrangian(vx**2 / 2 + sp.asin(sp.sin(x)), [x], velocities=[vx], position=[0.75], velocity=[0.0])
    if end < 1.0:
        out = system.run(end, method="taylor")
        assert abs(out.position[-1, 0] - (0.75 + end**2 / 2)) < 1e-15
        return
    with pytest.raises(vv.ConvergenceError):
        system.run(end, method="taylor")


def test_copies_are_held_to_their_own_steps() -> None:
    system = on_a_line(sp.sqrt(x**2 + sp.Rational(1, 10**6)), 1.0, 0.0)
    starts = np.linspace(0.5, 2.0, 21)[:, None]
    together = system.ensemble(position=starts).run(3.0, method="taylor", threads=2)
    for copy, start in enumerate(starts):
        alone = system.at(position=start).run(3.0, method="taylor")
        assert np.array_equal(together.position[copy, -1], alone.position[-1])
