"""A steep wall met after a long free way: no coefficient and no stage at the start of a step tells of it."""

import numpy as np
import pytest

import visviva as vv

T = np.array([10.0, 29.0, 31.0, 60.0])


def wall(steepness: float, velocity: float = -1.0) -> vv.Scene:
    """V = exp(−k x), met from x = 30."""
    body = vv.Particles(mass=[1.0], position=[[30.0, 0.0, 0.0]], velocity=[[velocity, 0.0, 0.0]])
    return vv.Scene(body, vv.ExpressionForce(potential=lambda r, v, t: np.exp(-steepness * r[0])))


def reflected(steepness: float) -> np.ndarray:
    """x = (2/k) ln(√2 cosh(k (t − t₀)/2)), of energy ½; the time at the wall is t₀ = 30 + ln 2/k."""
    phase = np.abs(steepness * (T - 30.0 - np.log(2.0) / steepness) / 2.0)
    return 2.0 / steepness * (phase + np.log1p(np.exp(-2.0 * phase)) - np.log(2.0) / 2.0)


@pytest.mark.parametrize("steepness", [1.0, 20.0, 500.0])
@pytest.mark.parametrize("rtol", [1e-6, 1e-10, 1e-12])
@pytest.mark.parametrize("method", ["dop853", "verner98", "taylor"])
def test_a_steep_wall_reflects_a_body(method: str, rtol: float, steepness: float) -> None:
    out = wall(steepness).run(T, method=method, rtol=rtol)
    # The velocity errs by some tens of rtol, and thirty units of time follow.
    np.testing.assert_allclose(out.position[:, 0, 0], reflected(steepness), atol=1e3 * rtol)


def test_copies_are_reflected_as_they_are_alone() -> None:
    speeds = [-1.0, -0.5, -2.0, -0.9, -1.1, -3.0, -1.3, -0.7, -1.7]
    many = wall(20.0).ensemble(velocity=[[[speed, 0.0, 0.0]] for speed in speeds]).run(T, method="taylor")
    assert not many.status.any()
    for index, speed in enumerate(speeds):
        alone = wall(20.0, speed).run(T, method="taylor")
        np.testing.assert_array_equal(many.position[index], alone.position)
