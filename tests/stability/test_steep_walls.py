"""A steep wall met after a long free way: neither the stages of a step nor a series at its start tell of it."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import visviva as vv

T = np.array([10.0, 29.0, 31.0, 60.0])
RTOL = [1e-6, 1e-10, 1e-12]


def generalized(steepness: float, velocity: float = -1.0) -> vv.Lagrangian:
    """V = exp(−k x), met from x = 30: at first there is no force, and a step as long as the run meets exp(30 k)."""
    return vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - np.exp(-steepness * q[0]), ["x"], position=[30.0], velocity=[velocity]
    )


def body(steepness: float, velocity: float = -1.0) -> vv.Scene:
    """The same wall before a body."""
    particle = vv.Particles(mass=[1.0], position=[[30.0, 0.0, 0.0]], velocity=[[velocity, 0.0, 0.0]])
    return vv.Scene(particle, vv.ExpressionForce(potential=lambda r, v, t: np.exp(-steepness * r[0])))


def reflected(steepness: float) -> np.ndarray:
    """x = (2/k) ln(√2 cosh(k (t − t₀)/2)), of energy ½; the time at the wall is t₀ = 30 + ln 2/k."""
    phase = np.abs(steepness * (T - 30.0 - np.log(2.0) / steepness) / 2.0)
    return 2.0 / steepness * (phase + np.log1p(np.exp(-2.0 * phase)) - np.log(2.0) / 2.0)


def allowed(method: str, rtol: float) -> float:
    """The error in x: that of the velocity, some tens of rtol, thirty units of time later.

    Steps of the lower orders are as long as an oscillation of one frequency allows; a wall has many."""
    if method == "gauss4":
        return {1e-6: 2e-2, 1e-10: 2e-4, 1e-12: 5e-6}[rtol]
    if method == "gauss8":
        return {1e-6: 2e-4, 1e-10: 1e-4, 1e-12: 5e-7}[rtol]
    return 1e3 * rtol


@pytest.mark.parametrize("steepness", [1.0, 5.0, 20.0, 50.0, 500.0])
@pytest.mark.parametrize("rtol", RTOL)
@pytest.mark.parametrize("method", ["dop853", "taylor", "gauss16", "gauss8", "gauss4"])
def test_a_steep_wall_reflects_a_coordinate(method: str, rtol: float, steepness: float) -> None:
    out = generalized(steepness).run(T, method=method, rtol=rtol)
    np.testing.assert_allclose(out["x"], reflected(steepness), rtol=0, atol=allowed(method, rtol))
    np.testing.assert_allclose(out.energy, 0.5, rtol=0, atol=allowed(method, rtol) / 15.0)


@pytest.mark.parametrize("steepness", [1.0, 20.0, 500.0])
@pytest.mark.parametrize("rtol", RTOL)
@pytest.mark.parametrize("method", ["dop853", "verner98", "taylor"])
def test_a_steep_wall_reflects_a_body(method: str, rtol: float, steepness: float) -> None:
    out = body(steepness).run(T, method=method, rtol=rtol)
    np.testing.assert_allclose(out.position[:, 0, 0], reflected(steepness), rtol=0, atol=allowed(method, rtol))


def by_a_root(q: Any, v: Any, t: Any) -> Any:
    """Of the distance from a line: a root in an expression may turn sharply, and does not here."""
    return np.exp(-20.0 * np.sqrt(q[0] ** 2 + 0.0 * t))


@pytest.mark.parametrize("rtol", RTOL)
def test_a_wall_about_a_line_is_met_by_series_that_may_turn_sharply(rtol: float) -> None:
    """V = exp(−k |x|), which no step may go over."""
    system = vv.Lagrangian(lambda q, v, t: v @ v / 2 - by_a_root(q, v, t), ["x"], position=[30.0], velocity=[-1.0])
    particle = vv.Particles(mass=[1.0], position=[[30.0, 0.0, 0.0]], velocity=[[-1.0, 0.0, 0.0]])
    scene = vv.Scene(particle, vv.ExpressionForce(potential=by_a_root))
    np.testing.assert_allclose(system.run(T, method="taylor", rtol=rtol)["x"], reflected(20.0), rtol=0, atol=1e3 * rtol)
    x = scene.run(T, method="taylor", rtol=rtol).position[:, 0, 0]
    np.testing.assert_allclose(x, reflected(20.0), rtol=0, atol=1e3 * rtol)


@pytest.mark.parametrize("method", ["taylor", "gauss16", "gauss8"])
def test_a_wall_met_by_held_steps_reflects(method: str) -> None:
    """Where steps have long been held no stage feels the wall before one is in it: an oscillator between walls.

    V = x²/2 + exp(100 (x − 1)) against `dop853`, which sees the wall by its error."""
    system = vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - q @ q / 2 - np.exp(100.0 * (q[0] - 1.0)), ["x"], position=[0.0], velocity=[1.2]
    )
    exact = system.run(np.arange(1.0, 11.0), method="dop853", rtol=1e-13)
    out = system.run(np.arange(1.0, 11.0), method=method, rtol=1e-10)
    # Ten units of time with some three reflections, by 1e-10 each and what gauss8 adds.
    np.testing.assert_allclose(out["x"], exact["x"], rtol=0, atol=1e-5 if method == "gauss8" else 1e-7)


@pytest.mark.parametrize(
    ("wall", "method"), [(generalized, m) for m in ("gauss16", "gauss8", "taylor")] + [(body, "taylor")]
)
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_are_reflected_as_they_are_alone(wall: Callable[..., Any], method: str, threads: int) -> None:
    speeds = np.array([-1.0, -0.5, -2.0, -0.9, -1.1, -3.0, -1.3, -0.7, -1.7])
    velocity = speeds[:, None, None] * np.array([[1.0, 0.0, 0.0]]) if wall is body else speeds[:, None]
    many = wall(5.0).ensemble(velocity=velocity).run(T, method=method, threads=threads)
    assert not many.status.any()
    for index, speed in enumerate(speeds):
        np.testing.assert_array_equal(many.position[index], wall(5.0, speed).run(T, method=method).position)
