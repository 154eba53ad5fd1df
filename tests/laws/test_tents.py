"""Tents: walls written with absolute values, which are nothing on either side and have a corner on top.

To both looks about them they look as if they were not there. Whoever chooses steps finds them by the sign that an
absolute value's argument changes twice; equal steps end before them, by name.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy

import visviva as vv

PLACE, HEIGHT = 5.03, 5.0
METHODS = ("auto", "dop853", "tsitouras54", "verner98", "dormand_prince54")
WIDTHS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)
BODY = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])


def tent(x: Any, width: Any) -> Any:
    """HEIGHT on top, with straight flanks, and nothing beyond them: the larger of 1 − |u| and 0."""
    beside = 1 - abs(x - PLACE) / width
    return 0.5 * HEIGHT * (beside + abs(beside))


def back(width: float, end: float) -> float:
    """Where a body of unit velocity is after it turned on the flank, for 2 width/HEIGHT."""
    foot = PLACE - width
    return foot - (end - foot - 2.0 * width / HEIGHT)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("width", WIDTHS)
def test_a_body_turns_back_at_a_tent_however_thin(width: float, method: str) -> None:
    scene = vv.Scene(BODY, vv.ExpressionForce(potential=lambda r, v, t: tent(r[0], width)))
    out = scene.run(10.0, method=method, rtol=1e-9)
    # At the foot the force jumps from 0 to 5/width: of the tolerance of a step there, for the five that are left.
    assert out.velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=2e-6)
    assert out.position[-1, 0, 0] == pytest.approx(back(width, 10.0), rel=0.0, abs=1e-5)


@pytest.mark.parametrize("method", ["rk4", "leapfrog", "leapfrog_dkd", "kahan_li8", "midpoint"])
@pytest.mark.parametrize("width", [1e-3, 1e-6])
def test_equal_steps_end_before_one(width: float, method: str) -> None:
    scene = vv.Scene(BODY, vv.ExpressionForce(potential=lambda r, v, t: tent(r[0], width)))
    with pytest.raises(vv.ConvergenceError, match="narrower than the step") as error:
        scene.run(10.0, method=method, dt=0.05)
    assert error.value.trajectory is not None
    assert error.value.trajectory.final.t0 == pytest.approx(5.0, rel=0.0, abs=1e-12)


@pytest.mark.parametrize("method", ["rk4", "leapfrog", "leapfrog_dkd", "kahan_li8", "midpoint"])
def test_and_tell_of_one_that_a_single_look_falls_on(method: str) -> None:
    scene = vv.Scene(BODY, vv.ExpressionForce(potential=lambda r, v, t: tent(r[0], 1e-2)))
    with pytest.raises((vv.ConvergenceError, vv.AccuracyWarning), match=r"narrower than the step|does not resolve"):
        scene.run(10.0, method=method, dt=0.05)


def test_copies_turn_back_as_each_does_alone() -> None:
    force = vv.ExpressionForce(potential=lambda r, v, t, w: tent(r[0], w), parameters={"w": 1.0})
    many = vv.Scene(BODY, force).ensemble(parameters={force: {"w": np.geomspace(1e-5, 1e-1, 11)}})
    out = many.run(10.0, method="dop853", rtol=1e-9)
    for copy in range(11):
        alone = many[copy].run(10.0, method="dop853", rtol=1e-9)
        assert np.array_equal(alone.position, out.position[copy])
        assert alone.velocity[-1, 0, 0] == pytest.approx(-1.0, rel=0.0, abs=2e-6)


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6])
def test_so_do_systems_in_generalized_coordinates(width: float) -> None:
    x, y, p, q = sympy.symbols("x y p q")
    function = (p**2 + q**2) / 2 - tent(x, width) - y**2 / 2
    system = vv.Lagrangian(function, [x, y], velocities=[p, q], position=[0.0, 1.0], velocity=[1.0, 0.0])
    out = system.run(10.0, method="dop853", rtol=1e-9)
    assert out.velocity[-1, 0] == pytest.approx(-1.0, rel=0.0, abs=2e-6)
    # The other coordinate swings as if nothing had been there.
    assert out.position[-1, 1] == pytest.approx(np.cos(10.0), rel=0.0, abs=1e-6)


def test_a_pulse_that_is_a_tent_gives_its_impulse() -> None:
    for width in (1e-1, 1e-3, 1e-5):
        force = vv.ExpressionForce(
            force=lambda r, v, t, w=width: (tent(t, w) / w, 0.0 * t, 0.0 * t),
        )
        out = vv.Scene(BODY, force).run(10.0, method="dop853", rtol=1e-9)
        # The area of a triangle.
        assert out.velocity[-1, 0, 0] == pytest.approx(1.0 + HEIGHT, rel=0.0, abs=2e-6)


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98"])
def test_one_corner_is_no_tent_and_costs_no_more_than_its_error(method: str) -> None:
    # |x|, whose both sides are seen: to and fro under a force of 1, four times √2 in a period of 4 √2 from rest at 1.
    scene = vv.Scene(
        vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]),
        vv.ExpressionForce(potential=lambda r, v, t: abs(r[0])),
    )
    out = scene.run(8.0 * np.sqrt(2.0), method=method, rtol=1e-9)
    # Each corner costs what a step's tolerance leaves of a jump of the force by 2.
    assert out.position[-1, 0, 0] == pytest.approx(1.0, rel=0.0, abs=1e-5)


@pytest.mark.parametrize("method", ["leapfrog", "leapfrog_dkd", "rk4"])
def test_equal_steps_go_over_a_stair_as_over_one_corner(method: str) -> None:
    # |x| + |x - 0.005|: between its corners, half a step apart, the force is nothing, and on either side it is 2.
    scene = vv.Scene(
        vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]),
        vv.ExpressionForce(potential=lambda r, v, t: abs(r[0]) + abs(r[0] - 0.005)),
    )
    out = scene.run(20.0, method=method, dt=0.01)
    # Each of twenty passages loses a step's share of the force.
    assert abs(out.energy[-1] - out.energy[0]) < 20 * 0.02
