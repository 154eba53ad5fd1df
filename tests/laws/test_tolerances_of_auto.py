"""What `auto` holds its steps to where nobody says: small errors of the whole run, in steps that rounding allows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

X, Y, T = sp.symbols("x y t")


def ball(x: float, *forces: Any, t0: float = 0.0) -> vv.Scene:
    return vv.Scene(vv.Particles([1.0], [[x, 0.0, 0.0]], [[0.0, 0.3, 0.0]]), *forces, t0=t0)


def test_the_planets_after_a_century() -> None:
    """To 1e-7 AU; steps held to 1e-9 are off by 6e-5."""
    scene = vv.datasets.solar_system().scene
    end = scene.t0 + 36525.0
    exact = scene.run(end, method="stormer13", dt=0.4).position[-1]
    plan = scene.plan(end)
    assert ("relative tolerance", "1e-12") in [row[:2] for row in plan.rows]
    off = [float(np.abs(scene.run(end, **how).position[-1] - exact).max()) for how in ({}, {"rtol": 1e-9})]
    assert off[0] < 1.5e-7
    assert 1e-5 < off[1] < 2e-4


@pytest.mark.parametrize("far", [0.0, 1e3, 1e5, 1e7, 1e8])
def test_formulas_far_from_the_origin_take_the_steps_of_others(far: float) -> None:
    """Places there have fewer digits than the tolerance, which made steps of nothing: millions for some hundred."""
    spring = vv.ExpressionForce(force=[-(X - far), -Y, 0])
    out = ball(far + 1.0, spring).run(100.0)
    assert out.stats.steps < 800
    expected = [far + np.cos(100.0), 0.3 * np.sin(100.0)]
    # What rounding of places makes of an oscillator in 100 units of time, and 1e-9 of steps that are 1e-12 off.
    np.testing.assert_allclose(out.position[-1, 0, :2], expected, rtol=0, atol=1e-9 + 100 * np.spacing(far))


@pytest.mark.parametrize("t0", [0.0, 1e3, 1e5, 1e8])
@pytest.mark.filterwarnings("ignore:times near:visviva.AccuracyWarning")
def test_formulas_long_after_the_time_zero_do_so_too(t0: float) -> None:
    drive = vv.ExpressionForce(force=[-X + sp.cos(3 * (T - t0)), -Y, 0])
    out = ball(1.0, drive, t0=t0).run(t0 + 100.0)
    assert out.stats.steps < 1500
    # x'' + x = cos 3t from rest at 1: 9/8 cos t − 1/8 cos 3t.
    expected = 1.125 * np.cos(100.0) - 0.125 * np.cos(300.0)
    assert out.position[-1, 0, 0] == pytest.approx(expected, rel=0, abs=1e-9 + 100 * np.spacing(t0))


def test_what_is_asked_for_is_held_to() -> None:
    """A tolerance that is given, and that of a method that is named, are those of the steps."""
    scene = vv.problems.figure_eight().scene
    steps = {rtol: scene.run(20.0, rtol=rtol).stats.steps for rtol in (1e-9, 1e-12)}
    assert scene.run(20.0).stats.steps == steps[1e-12] > steps[1e-9]
    named = {rtol: scene.run(20.0, method="dop853", rtol=rtol).stats.steps for rtol in (1e-9, 1e-12)}
    assert scene.run(20.0, method="dop853").stats.steps == named[1e-9] < named[1e-12]
