"""Steps beside an `ExpressionForce`: as long as they are without one, unless it may hide something from them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

BODY = vv.Particles([1.0], [[1.0, 0.2, 0.1]], [[0.0, 0.5, 0.1]])

#: What tells of itself from afar: a step sees it, or sees that there is nothing.
PLAIN = {
    "line": lambda r, v, t: 0.1 * r[0],
    "quartic": lambda r, v, t: r[0] ** 4 + r[1] ** 2 * r[2] ** 2,
    "point": lambda r, v, t: -1.0 / (r[0] ** 2 + r[1] ** 2 + r[2] ** 2) ** 0.5,
    "logarithm": lambda r, v, t: 0.5 * np.log(1.0 + r[0] ** 2 + 2.0 * r[1] ** 2),
    "waves": lambda r, v, t: np.sin(3.0 * r[0]) * np.cos(r[1]),
    "slow change": lambda r, v, t: (1.0 + t**2) * r[0] ** 2,
}
#: What may be nothing at two neighboring stages, and much between them.
NARROW = {
    "bump": lambda r, v, t: np.exp(-(r[0] ** 2)),
    "wall": lambda r, v, t: np.tanh(r[0]),
    "corner": lambda r, v, t: abs(r[0]),
    "flat bottom": lambda r, v, t: (abs(r[0]) - r[0]) ** 3,
    "drive": lambda r, v, t: r[0] * np.cos(t),
    "steep pulse": lambda r, v, t: r[0] / (1.0 + t**8),
    "crests": lambda r, v, t: np.cos(r[0]) ** 40,
}


def beside(potential: Any, *forces: vv.forces.Force) -> vv.Scene:
    return vv.Scene(BODY, vv.ExpressionForce(potential=potential), *forces)


@pytest.mark.parametrize("name", PLAIN)
def test_what_tells_of_itself_leaves_steps_as_long_as_they_are(name: str) -> None:
    scene = beside(PLAIN[name])
    assert "longest step" not in str(scene.plan(t=0.5))
    # Half a radian of motions whose rates are about 1: a step of the eighth order is as long as that, or a few.
    assert scene.run(t=0.5).stats.steps < 20


@pytest.mark.parametrize("name", NARROW)
def test_what_may_hide_is_looked_for_in_many_steps(name: str) -> None:
    scene = beside(NARROW[name])
    assert "longest step" in str(scene.plan(t=0.5))
    assert scene.run(t=0.5).stats.steps >= 128


def test_two_expressions_of_which_one_may_hide() -> None:
    assert "longest step" in str(beside(PLAIN["line"], vv.ExpressionForce(potential=NARROW["bump"])).plan(t=0.5))


def test_a_smooth_force_does_not_multiply_the_steps_of_gravity() -> None:
    """A short run of fifty bodies took 128 steps for 1."""
    rng = np.random.default_rng(0)
    bodies = vv.Particles(np.full(50, 0.02), rng.normal(size=(50, 3)), 0.3 * rng.normal(size=(50, 3)))
    drag = vv.ExpressionForce(acceleration=lambda r, v, t: (-0.1 * v[0], -0.1 * v[1], -0.1 * v[2]))
    gravity = vv.Gravity(1.0, softening=0.05)
    without, beside_it = vv.Scene(bodies, gravity).run(t=1e-3), vv.Scene(bodies, gravity, drag).run(t=1e-3)
    assert beside_it.stats.steps <= 2 * without.stats.steps
    # v (1 − 1e-4) but for the square of that; places change by less, and so do the pulls.
    change = (beside_it.velocity - without.velocity)[-1]
    np.testing.assert_allclose(change, -1e-4 * without.velocity[-1], rtol=0, atol=5e-8)
