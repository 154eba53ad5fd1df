"""Golden numbers of single steps of the integration methods, on an oscillator and in a magnetic field."""

import math
from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close

import visviva as vv

golden = Golden()


def oscillator(given: dict[str, Any]) -> vv.Scene:
    bodies = vv.Particles([1.0], [[given["x0"], 0.0, 0.0]], [[given["v0"], 0.0, 0.0]])
    return vv.Scene(bodies, vv.Harmonic(given["omega"] ** 2))


def line(out: vv.Trajectory) -> tuple[Any, Any]:
    return out.position[:, 0, 0], out.velocity[:, 0, 0]


@golden("GI-verlet-oscillator")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    h, n = given["h"], given["n"]
    x, v = line(oscillator(given).run(t=[h, n * h], method="leapfrog", dt=h))
    close([x[1], v[1]], [expected["x_n"], expected["v_n"]])
    close(math.acos(x[0] / given["x0"]), expected["phase_per_step"])
    close(math.acos(x[0] / given["x0"]) / h, expected["omega_eff"])
    close(0.5 * v**2 + 0.5 * (1 - h * h / 4) * x**2, [expected["H_mod"]] * 2)


@golden("GI-rk4-oscillator")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    h, n = given["h"], given["n"]
    out = oscillator(given).run(t=[0, n * h], method="rk4", dt=h)
    x, v = line(out)
    close([x[1], v[1]], [expected["x_n"], expected["v_n"]])
    close(out.energy[1] / out.energy[0], expected["energy_ratio"])


@golden("GI-euler-oscillator")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """The energy grows by 1 + (ωh)² in every step, of which the run warns."""
    h, n = given["h"], given["n"]
    with pytest.warns(vv.AccuracyWarning, match="energy at the end"):
        out = oscillator(given).run(t=h * np.arange(n + 1), method="euler", dt=h)
    x, v = line(out)
    close([x[-1], v[-1]], [expected["x_n"], expected["v_n"]])
    close(out.energy[-1] / out.energy[0], expected["energy_ratio"])
    close(out.energy[1:] / out.energy[:-1], np.full(n, 1 + (given["omega"] * h) ** 2))


@golden("GI-yoshida4")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """Drifts w₁, w₀, w₁ between kicks of half of what stands beside them."""
    (method,) = (method for method in vv.methods() if method.name == "yoshida4")
    assert method.order == given["order"]
    w1, w0 = expected["w1"], expected["w0"]
    close(method.coefficients["drifts"], [w1, w0, w1], rel=2e-16)
    close(method.coefficients["kicks"], [w1 / 2, (w0 + w1) / 2, (w0 + w1) / 2, w1 / 2], rel=1e-15)
    close(2 * method.coefficients["drifts"][0] ** 3 + method.coefficients["drifts"][1] ** 3, 0.0, scale=5.0, rel=1e-15)


@golden("GI-boris-angle")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """The golden angle is that of Boris' own rotation, by a tangent: 2 arctan(ωh/2). Ours is turned exactly, by ωh."""
    h, rate = given["h"], given["qB_over_m"]
    scene = vv.Scene(
        vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.25]]), vv.UniformMagneticField([0.0, 0.0, rate])
    )
    v = scene.run(t=h * np.arange(9), method="boris", dt=h).velocity[:, 0]
    turned = -np.diff(np.unwrap(np.arctan2(v[:, 1], v[:, 0])))
    close(turned, np.full(8, rate * h), rel=1e-15)
    close(np.linalg.norm(v, axis=1), np.full(9, math.hypot(1.0, 0.25)), rel=1e-15)
    close(2 * math.atan(turned[0] / 2), expected["angle_per_step"], rel=1e-15)
    assert turned[0] - expected["angle_per_step"] > 0.07


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
