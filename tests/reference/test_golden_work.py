"""Golden numbers of impulse, of work and of action and reaction, and of forces that are given by hand."""

import math
from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close
from numpy.typing import NDArray

import visviva as vv

golden = Golden()


@golden("G2.2-impulse")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """F₀ sin(πt/T) is a cosine that is a quarter of a turn late."""
    m, v0, T = given["m"], given["v0"], given["T"]
    ball = vv.Particles([m], [[0.0, 0.0, 0.0]], [[v0, 0.0, 0.0]])
    pulse = vv.DrivenForce([given["F0"], 0.0, 0.0], frequency=math.pi / T, phase=-math.pi / 2)
    scene = vv.Scene(ball, pulse)
    before = scene.invariants()
    for method in ({}, {"method": "dop853", "rtol": 1e-13}, {"method": "rk4", "dt": T / 1024}):
        after = scene.run(t=T, **method).final.invariants()  # type: ignore[arg-type]
        close(after.momentum[0] - before.momentum[0], expected["impulse"], rel=2e-12 if method else 1e-13)
        close(after.momentum[0] / m, expected["v1"], rel=2e-12 if method else 1e-13)
        # A small difference of two energies of a hundred.
        close(after.kinetic_energy - before.kinetic_energy, expected["dT"], scale=100.0, rel=2e-12 if method else 1e-13)
    # In the limit of a blow the momentum jumps and the place does not.
    short = vv.DrivenForce([given["F0"] * 1e6, 0.0, 0.0], frequency=1e6 * math.pi / T, phase=-math.pi / 2)
    blow = vv.Scene(ball, short).run(t=T / 1e6)
    close(blow.velocity[-1, 0, 0], expected["v1"])
    assert abs(blow.position[-1, 0, 0]) < 40.0 * T / 1e6


@golden("G3.11-weak-third-law")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    forces = np.zeros((2, 2, 3))
    forces[0, 1] = given["G12"]
    forces[1, 0] = np.negative(given["G12"])
    found = vv.audit.third_law([given["r1"], given["r2"]], forces)
    close(found.force, expected["internal_force"])
    close(found.torque, expected["internal_torque"])
    assert (found.weak, found.strong) == (True, False)


@golden("G3.17-work")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """V = k (x² + y²)/2 + c xyz, along a line, by way of a corner, and along a curve; and back again."""
    k, c, start, end = given["k"], given["c"], np.array(given["r1"]), np.array(given["r2"])

    def potential(r: NDArray[np.float64]) -> float:
        return float(k / 2 * (r[0] ** 2 + r[1] ** 2) + c * r[0] * r[1] * r[2])

    def force(r: NDArray[np.float64]) -> NDArray[np.float64]:
        x, y, z = r.T
        return -np.stack([k * x + c * y * z, k * y + c * x * z, c * x * y], axis=-1)

    close([potential(start), potential(end)], [expected["V1"], expected["V2"]])
    corner = np.array([2.0, -1.0, 3.0])

    def curve(s: NDArray[np.float64]) -> NDArray[np.float64]:
        ways = start + s[:, None] * (end - start)
        return ways + np.sin(np.pi * s)[:, None] * [1.0, np.e, -2.0]  # type: ignore[no-any-return]

    close(vv.audit.work(force, [start, end]), expected["W12"])
    close(vv.audit.work(force, [start, corner, end]), expected["W12"], rel=1e-11)
    close(vv.audit.work(force, curve), expected["W12"], rel=1e-11)
    close(vv.audit.work(force, [start, corner, end, start]), 0.0, scale=10.0)
    assert vv.audit.curl(force, [start, corner, end]).conservative


@golden("G8.4-com-continuous")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """Bodies are taken for the places and weights of Gauss and Legendre, whose mean is an integral."""
    radius, half = given["R"], given["half_angle"]
    nodes, weights = np.polynomial.legendre.leggauss(24)

    def center(low: float, high: float, mass: Any, place: Any) -> float:
        """Along the axis of symmetry, of slices of those masses at those places between two values."""
        s = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        zeros = np.zeros_like(s)
        slices = vv.Particles(weights * mass(s), np.stack([zeros, zeros, place(s)], axis=-1))
        return float(slices.center_of_mass()[0][2])

    def up(z: Any) -> Any:
        return z

    def ones(z: Any) -> Any:
        return np.ones_like(z)

    def along(a: Any) -> Any:
        return radius * np.cos(a)

    # A sector is made of triangles from its center, whose own centers lie at two thirds of the way.
    found = {
        "arc": center(-half, half, ones, along),
        "sector": center(-half, half, ones, lambda a: 2 / 3 * along(a)),
        "half_disc": center(-np.pi / 2, np.pi / 2, ones, lambda a: 2 / 3 * along(a)),
        "half_ring": center(-np.pi / 2, np.pi / 2, ones, along),
        "solid_hemisphere": center(0.0, radius, lambda z: radius**2 - z * z, up),
        "hemispherical_shell": center(0.0, radius, ones, up),
        "solid_cone_from_base_unit_height": center(0.0, 1.0, lambda z: (1.0 - z) ** 2, up),
    }
    assert found.keys() == expected.keys()
    for name, value in found.items():
        close(value, expected[name])
    # The center of a bent body may lie beside it.
    assert found["arc"] < radius * np.cos(half) + radius * (1 - np.cos(half))


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
