"""Steep walls met by long steps: what stages are measured by is what they come to, and not what a wild guess meets."""

import numpy as np
import pytest

import visviva as vv

T = np.array([10.0, 29.0, 31.0, 60.0])


def wall(steepness: float, velocity: float = -1.0) -> vv.Lagrangian:
    """V = exp(−k x), met from x = 30: at first there is no force, and a step as long as the run meets exp(30 k)."""
    return vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - np.exp(-steepness * q[0]), ["x"], position=[30.0], velocity=[velocity]
    )


def reflected(steepness: float) -> np.ndarray:
    """x = (2/k) ln(√2 cosh(k (t − t₀)/2)), of energy ½; the time at the wall is t₀ = 30 + ln 2/k."""
    phase = np.abs(steepness * (T - 30.0 - np.log(2.0) / steepness) / 2.0)
    return 2.0 / steepness * (phase + np.log1p(np.exp(-2.0 * phase)) - np.log(2.0) / 2.0)


@pytest.mark.parametrize(
    ("method", "steepness"),
    [("gauss16", 1.0), ("gauss16", 5.0), *(("dop853", k) for k in (1.0, 5.0, 20.0, 50.0, 500.0))],
)
def test_a_steep_wall_reflects(method: str, steepness: float) -> None:
    """Not yet by gauss16 at walls steeper than these, nor by gauss8, gauss4 and taylor."""
    out = wall(steepness).run(T, method=method, rtol=1e-10)
    # Some tens of tolerances in the velocity, and thirty units of time on the way back.
    np.testing.assert_allclose(out["x"], reflected(steepness), atol=1e-7)
    np.testing.assert_allclose(out.energy, 0.5, rtol=1e-8)


def test_copies_are_reflected_as_they_are_alone() -> None:
    speeds = [-1.0, -0.5, -2.0, -0.9, -1.1, -3.0, -1.3, -0.7, -1.7]
    for method in ("gauss16", "gauss8"):
        many = wall(5.0).ensemble(velocity=[[speed] for speed in speeds]).run(T, method=method)
        assert not many.status.any()
        for index, speed in enumerate(speeds):
            np.testing.assert_array_equal(many.position[index], wall(5.0, speed).run(T, method=method).position)
