"""Poles of coordinates passed closely: rates rise by many powers of ten and fall again, within a short time."""

import numpy as np
import pytest

import visviva as vv

T = np.linspace(0.0, 20.0, 41)
G = 9.81


def spherical(turning: float) -> vv.Lagrangian:
    return vv.systems.spherical_pendulum(g=G, position=[1.0, 0.0], velocity=[0.0, turning])


def in_space(turning: float) -> vv.Lagrangian:
    """The same in x, y, z, which have no pole."""
    return vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - G * q[2],
        ["x", "y", "z"],
        position=[np.sin(1.0), 0.0, -np.cos(1.0)],
        velocity=[0.0, np.sin(1.0) * turning, 0.0],
        constraints=[lambda q, v, t: q @ q - 1],
    )


def off(out: vv.generalized.GeneralizedTrajectory, turning: float) -> float:
    true = in_space(turning).run(T)
    x, y = np.sin(out["theta"]) * np.cos(out["phi"]), np.sin(out["theta"]) * np.sin(out["phi"])
    return float(max(abs(x - true["x"]).max(), abs(y - true["y"]).max()))


@pytest.mark.parametrize("turning", [1e-2, 1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12])
@pytest.mark.parametrize("method", ["gauss16", "gauss8", "taylor", "dop853"])
def test_a_pole_passed_closely_is_right_or_a_named_failure(method: str, turning: float) -> None:
    """θ comes to about `turning`, where φ' is 1/turning and φ goes by π: once 1e-12 of the time long."""
    try:
        out = spherical(turning).run(T, method=method)
    except vv.ConvergenceError as error:
        named = "the step fell below what can be told from the time" in str(error)
        if turning <= 1e-10 and method != "taylor" and named:
            return
        raise
    # Some hundred steps of rtol 1e-12 and of its own order; dop853 has its relative tolerance of each number.
    assert off(out, turning) < {"gauss16": 1e-11, "gauss8": 1e-8, "taylor": 2e-12, "dop853": 2e-11}[method]


def test_copies_side_by_side_pass_poles_as_they_do_alone() -> None:
    rates = [1e-3, 1e-5, 1e-6, 1e-7, 1e-2, 1.0, 1e-4, 1e-8, 3e-6]
    for method in ("gauss16", "gauss8"):
        many = spherical(1.0).ensemble(velocity=[[0.0, rate] for rate in rates]).run(T, method=method)
        for index, rate in enumerate(rates):
            np.testing.assert_array_equal(many.position[index], spherical(rate).run(T, method=method).position)


def test_readings_do_not_know_of_each_other() -> None:
    """A state between nodes is that of a shadow step, whatever else was read before it."""
    alone = spherical(1e-5).run([T[13], T[-1]])
    np.testing.assert_array_equal(alone.position[0], spherical(1e-5).run(T).position[13])
