"""Steps beside an `ExpressionForce`: as long as they are without one, unless it may hide something from them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

BODY = vv.Particles([1.0], [[1.0, 0.2, 0.1]], [[0.0, 0.5, 0.1]])

#: Polynomials of low degree and standing waves: as long as a step sees them to be.
PLAIN = {
    "line": lambda r, v, t: 0.1 * r[0],
    "quartic": lambda r, v, t: r[0] ** 4 + r[1] ** 2 * r[2] ** 2,
    "waves": lambda r, v, t: np.sin(3.0 * r[0]) * np.cos(r[1]),
    "slow change": lambda r, v, t: (1.0 + t**2) * r[0] ** 2,
    # Its phase is followed.
    "drive": lambda r, v, t: r[0] * np.cos(t),
}
#: What may be nothing at two neighboring stages, and much between them.
NARROW = {
    "bump": lambda r, v, t: np.exp(-(r[0] ** 2)),
    "wall": lambda r, v, t: np.tanh(r[0]),
    "corner": lambda r, v, t: abs(r[0]),
    "flat bottom": lambda r, v, t: (abs(r[0]) - r[0]) ** 3,
    "running wave": lambda r, v, t: np.cos(r[0] - t),
    "steep pulse": lambda r, v, t: r[0] / (1.0 + t**8),
    "gentle pulse": lambda r, v, t: r[0] / (1.0 + t**2),
    "crests": lambda r, v, t: np.cos(r[0]) ** 40,
    "point": lambda r, v, t: -1.0 / (r[0] ** 2 + r[1] ** 2 + r[2] ** 2) ** 0.5,
    "logarithm": lambda r, v, t: 0.5 * np.log(1.0 + r[0] ** 2 + 2.0 * r[1] ** 2),
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


@pytest.mark.parametrize("method", ["auto", "taylor", "dop853", "verner98", "tsitouras54"])
@pytest.mark.parametrize("frequency", [0.3, 7.0, 300.0, 3e3])
def test_a_drive_that_is_weak_beside_the_rest_is_felt(frequency: float, method: str) -> None:
    """A fast circle, and a drive across it of a part of a million or less, which no error of a step tells."""
    amplitude = 1e-6 * frequency
    drive = vv.ExpressionForce(
        acceleration=lambda r, v, t, a, w: (0.0, 0.0, a * np.cos(w * t + 0.3)),
        parameters={"a": amplitude, "w": frequency},
    )
    body = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    out = vv.Scene(body, vv.Harmonic(1.0), drive).run(t=2.0, method=method, rtol=1e-9)
    # z̈ = −z + a cos(wt + 0.3), from rest.
    w, t, phase = frequency, 2.0, 0.3
    gain = amplitude / (1.0 - w * w)
    free = gain * (np.cos(w * t + phase) - np.cos(phase) * np.cos(t) + w * np.sin(phase) * np.sin(t))
    # Of the tolerance of each step, which are some thousand at most and do not add up.
    allowed = 1e-11 * out.stats.steps
    assert allowed < 0.1 * abs(free)
    assert out.position[-1, 0, 2] == pytest.approx(free, rel=0.0, abs=allowed)
    assert out.position[-1, 0, 0] == pytest.approx(np.cos(2.0), rel=0.0, abs=1e-8)


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


def switched(u: Any, width: float = 1e-6) -> Any:
    return 0.5 * (1.0 + u / np.sqrt(u * u + width * width))


@pytest.mark.parametrize("how", [{}, {"method": "dop853"}, {"rtol": 1e-9}])
@pytest.mark.parametrize("on", ["time", "place"])
def test_switches_of_roots_are_felt(on: str, how: dict[str, Any]) -> None:
    """Both sides fall off as nothing one unit away: thrust for one unit of 20, which longer steps went over."""

    def thrust(r: Any, v: Any, t: Any) -> Any:
        u = t if on == "time" else r[0]
        return switched(u - 13.0) - switched(u - 14.0), 0.0 * t, 0.0 * t

    start = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]])
    out = vv.Scene(start, vv.ExpressionForce(acceleration=thrust)).run(t=20.0, **how)
    # Speeds 1, then 1 + (t − 13), then 2 for six units; in space v² grows by 2 over one unit of length.
    fast = np.sqrt(3.0)
    expected = 13.0 + 1.5 + 2.0 * 6.0 if on == "time" else 14.0 + fast * (7.0 - (fast - 1.0))
    assert out.position[-1, 0, 0] == pytest.approx(expected, rel=0, abs=1e-5)
