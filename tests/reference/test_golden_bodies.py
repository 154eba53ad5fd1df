"""Golden numbers of several bodies and their center of mass."""

from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close
from numpy.typing import NDArray

import visviva as vv
from visviva.particles import weighted_mean

golden = Golden()


def size(vector: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(vector))


@golden("G8.1-weighted-mean")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    close(weighted_mean(np.array(given["x"]), np.array(given["w"])), expected["mean"])
    close(weighted_mean(np.array(given["x"]), np.ones(len(given["x"]))), expected["unweighted"])


@golden("G8.55-konig")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = vv.Scene(vv.Particles(given["m"], given["r"], given["v"]))
    here = scene.invariants()
    close(here.center_of_mass, expected["R"])
    close(here.momentum, expected["P"])
    close(here.angular_momentum, expected["L_O"])
    close(scene.invariants(about=given["a"]).angular_momentum, expected["L_A"])
    close(scene.invariants(about="center_of_mass").angular_momentum, expected["L_G"])
    close(here.spin, expected["L_G"])
    close(here.kinetic_energy, expected["T"])
    close(here.center_of_mass_kinetic_energy, expected["T_cm"])
    close(here.internal_kinetic_energy, expected["T_internal"])
    assert here.potential_energy == 0.0


@golden("G8.29-two-body-period")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m1, m2 = given["m1"], given["m2"]
    speed = 2 * np.pi / expected["period"]
    bodies = vv.Particles(
        [m1, m2],
        [[-expected["d1"], 0, 0], [expected["d2"], 0, 0]],
        [[0, -expected["d1"] * speed, 0], [0, expected["d2"] * speed, 0]],
    )
    scene = vv.Scene(bodies, vv.Gravity(given["G"]))
    close(m1 * m2 / (m1 + m2), expected["mu"])
    close(scene.invariants().energy, expected["E_rel"])
    close(scene.run(t=expected["period"]).position[-1], bodies.position, scale=given["a"], rel=5e-13)


@golden("G8.35-two-body-state")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    bodies = vv.Particles([given["m1"], given["m2"]], [given["r1"], given["r2"]], [given["v1"], given["v2"]])
    scene = vv.Scene(bodies, vv.Gravity(given["G"]))
    out = scene.run(t=given["t"])
    # Velocities are of size 2 along the relative orbit.
    close(out.position[-1], [expected["r1"], expected["r2"]], scale=1.0, rel=5e-13)
    close(out.velocity[-1], [expected["v1"], expected["v2"]], scale=2.0, rel=5e-13)
    # The center of mass moves uniformly, whatever the two do about it.
    assert out.conservation().center_of_mass.max < 1e-15
    start = scene.center_of_mass_frame()
    back = start.run(t=expected["period"]).position[-1]
    close(back, start.particles.position, scale=1.0, rel=5e-13)


@golden("G8.7-lagrange-triangle")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    problem = vv.problems.lagrange_triangle(given["m"], given["side"])
    here = problem.scene.invariants()
    close(problem.t_end, expected["period"])
    close([here.potential_energy, here.kinetic_energy], [expected["V"], expected["T"]])
    close(here.energy, expected["E"])
    close(size(here.angular_momentum), expected["L"])
    accelerations = problem.scene.acceleration()
    close(accelerations, -(expected["omega"] ** 2) * problem.scene.particles.position, scale=1.0)


@golden("G8.60-figure-eight")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    x, y = given["r1"]
    vx, vy = given["v3"]
    bodies = vv.Particles(given["m"], [[x, y, 0], [-x, -y, 0], [0, 0, 0]], [[-vx / 2, -vy / 2, 0]] * 2 + [[vx, vy, 0]])
    here = vv.Scene(bodies, vv.Gravity(given["G"])).invariants()
    close(here.kinetic_energy, expected["T"])
    close(here.potential_energy, expected["V"])
    close(here.energy, expected["E"])
    close(here.angular_momentum[2], expected["L_z"], scale=1.0)
    close(here.momentum[:2], expected["P"], scale=1.0)


@golden("G8.6-nbody-forces")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = vv.Scene(vv.Particles(given["m"], given["r"]), vv.Gravity(given["G"], softening=given["eps"]))
    acceleration = scene.acceleration()
    here = scene.invariants()
    close(acceleration, expected["a"])
    close(here.potential_energy, expected["V"])
    close(here.virial, expected["V"])
    mass = np.array(given["m"])[:, None]
    # The third law, to the rounding of four forces of size 1.
    assert np.abs((mass * acceleration).sum(axis=0)).max() < 1e-15
    assert np.abs(here.torque).max() < 2e-15


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
