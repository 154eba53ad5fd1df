"""Golden numbers of drag, of oscillators and of charges in crossed fields."""

import math
from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close

import visviva as vv

golden = Golden()


def along(m: float, x: float, v: float, *forces: vv.forces.Force) -> vv.Scene:
    """One body on the z axis, upward."""
    return vv.Scene(vv.Particles([m], [[0.0, 0.0, x]], [[0.0, 0.0, v]]), *forces)


def heights(out: vv.Trajectory) -> tuple[Any, Any]:
    return out.position[:, 0, 2], out.velocity[:, 0, 2]


@golden("G4.24-quadratic-drag")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    drag = vv.drag.quadratic(density=given["rho"], radius=given["a"], drag_coefficient=2 * given["F_R"] / math.pi)
    close(drag.coefficient, expected["k"])
    x, v = heights(along(given["m"], 0.0, given["v0"], drag).run(t=[given["t"]]))
    close([x[0], v[0]], [expected["x"], expected["v"]])
    close(given["m"] / (drag.coefficient * given["v0"]), expected["tau"])


@golden("G4.27-linear-drag")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    drag = vv.drag.stokes(mass=given["m"], radius=given["a"], viscosity=given["mu"])
    close(drag.tau, expected["tau"])
    x, v = heights(along(given["m"], 0.0, given["v0"], drag).run(t=[given["t"], 1.0]))
    close([x[0], v[0], x[1]], [expected["x"], expected["v"], expected["stopping_distance"]])


@golden("G4.29-linear-drag-gravity")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    forces = vv.LinearDrag(given["tau"]), vv.UniformField([0, 0, -given["g"]])
    scene = along(1.0, given["x0"], given["v0"], *forces)
    x, v = heights(scene.run(t=[expected["t_apex"], given["t"], expected["t_return"], 1e3]))
    close(x[:3], [expected["x_apex"], expected["x"], given["x0"]])
    close(v[1:], [expected["v"], expected["v_return"], expected["v_terminal"]])
    throw = vv.drag.throw(speed=given["v0"], g=given["g"], tau=given["tau"])
    close([throw.apex_time, throw.return_time], [expected["t_apex"], expected["t_return"]])
    close(throw.apex_height + given["x0"], expected["x_apex"])
    close([throw.return_speed, throw.terminal_speed], [-expected["v_return"], -expected["v_terminal"]])


def in_air(given: dict[str, Any], v: float) -> vv.Scene:
    return along(1.0, 0.0, v, vv.QuadraticDrag(given["g"] / given["vt"] ** 2), vv.UniformField([0, 0, -given["g"]]))


@golden("G4.28x-quadratic-fall")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    x, v = heights(in_air(given, 0.0).run(t=[given["t"]]))
    close([x[0], v[0]], [expected["y"], expected["v"]])


@golden("G4.28x-quadratic-rise")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    back = expected["t_apex"] + expected["t_descent"]
    x, v = heights(in_air(given, given["v0"]).run(t=[given["t"], expected["t_apex"], back]))
    close(x, [expected["y"], expected["y_apex"], 0.0], scale=expected["y_apex"])
    close(v, [expected["v"], 0.0, expected["v_return"]], scale=given["v0"])
    throw = vv.drag.throw(speed=given["v0"], g=given["g"], terminal_speed=given["vt"])
    close([throw.apex_time, throw.apex_height], [expected["t_apex"], expected["y_apex"]])
    close([throw.return_time, throw.return_speed], [back, -expected["v_return"]])


@golden("G4.28x-quadratic-2d")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    g, c = given["g"], given["c"]
    bodies = vv.Particles([1.0], np.zeros((1, 3)), [[given["vx0"], given["vy0"], 0.0]])
    scene = vv.Scene(bodies, vv.QuadraticDrag(c), vv.UniformField([0, -g, 0]))
    out = scene.run(t=[0.5, expected["t_apex"], 3.0], rtol=1e-13)
    vx, vy = out.velocity[:, 0, 0], out.velocity[:, 0, 1]
    p = vy / vx
    # It is integrated: some hundred steps at 1e-13.
    close(1 / vx**2 + c / g * (p * np.sqrt(1 + p * p) + np.arcsinh(p)), [expected["K"]] * 3, rel=1e-11)
    close(out.position[1, 0, :2], [expected["x_apex"], expected["y_apex"]], rel=1e-11)
    close([vx[1], vy[1]], [expected["vx_apex"], 0.0], rel=1e-11, scale=given["vx0"])


@golden("G4.18x-mixed-drag")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    forces = vv.LinearDrag(given["m"] / given["b"]), vv.QuadraticDrag(given["k"])
    x, v = heights(along(given["m"], 0.0, given["v0"], *forces).run(t=[given["t"], 1e6]))
    close([x[0], v[0], x[1]], [expected["x"], expected["v"], expected["range"]])


@golden("G4.19-crossover")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    sphere = {"density": given["rho"], "radius": given["a"], "viscosity": given["mu"]}
    speed = vv.drag.crossover_speed(**sphere, drag_coefficient=2 / math.pi)
    close([speed, vv.drag.reynolds_number(**sphere, speed=speed)], [expected["v"], expected["R"]])


@golden("G4.29-projectile-2d-linear")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    bodies = vv.Particles([0.0], np.zeros((1, 3)), [[given["vx0"], given["vy0"], 0.0]])
    scene = vv.Scene(bodies, vv.LinearDrag(given["tau"]), vv.UniformField([0, -given["g"], 0]))
    throw = vv.drag.throw(speed=given["vy0"], g=given["g"], tau=given["tau"])
    close([throw.return_time, throw.apex_height], [expected["t_flight"], expected["y_apex"]])
    landed = scene.run(t=throw.return_time).position[-1, 0, :2]
    close(landed, [expected["range"], 0.0], scale=expected["range"])


@golden("G4.35-oscillator")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = along(given["m"], given["x0"], given["v0"], vv.Harmonic(given["k"]))
    turn = expected["phi"] / expected["omega"]
    out = scene.run(t=[given["t"]])
    x, v = heights(out)
    close([x[-1], v[-1]], [expected["x"], expected["v"]])
    close(out.energy, [expected["E"]] * len(x))
    # It turns at φ/ω, with the amplitude A; and repeats after a period.
    back = scene.run(t=[turn])
    close(heights(back)[0][-1], expected["A"])
    close(heights(back)[1][-1], 0.0, scale=abs(given["v0"]))
    close(heights(scene.run(t=[expected["period"]]))[0][-1], given["x0"], scale=expected["A"])
    close(abs(complex(expected["A1_re"], expected["A1_im"])), expected["A"] / 2)


def damped(given: dict[str, Any], expected: dict[str, Any]) -> None:
    forces = vv.Harmonic(given["omega0"] ** 2), vv.LinearDrag(1 / (2 * given["gamma"]))
    close(heights(along(1.0, given["x0"], given["v0"], *forces).run(t=[given["t"]]))[0][0], expected["x"])


@golden("G4.4-damped-under")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    damped(given, expected)


@golden("G4.4-damped-critical")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    damped(given, expected)


@golden("G4.4-damped-over")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    damped(given, expected)


@golden("G4.4-driven")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """From t = 300 on e⁻⁴⁵ is left of the start; the amplitude is largest at the resonance."""

    def steady(frequency: float) -> tuple[Any, Any]:
        drive = vv.DrivenForce([0.0, 0.0, given["f"]], frequency)
        scene = along(1.0, 0.0, 0.0, vv.Harmonic(given["omega0"] ** 2), vv.LinearDrag(0.5 / given["gamma"]), drive)
        t = 300.0 + np.linspace(0.0, 2.0, 7)
        return t, heights(scene.run(t=t))[0]

    t, x = steady(given["Omega"])
    size = expected["amplitude"]
    close(x, size * np.cos(given["Omega"] * t - expected["phase_lag"]), scale=size, rel=1e-12)

    def amplitude(frequency: float) -> float:
        t, x = steady(frequency)
        waves = np.stack([np.cos(frequency * t), np.sin(frequency * t)], axis=1)
        return float(np.linalg.norm(np.linalg.lstsq(waves, x, rcond=None)[0]))

    best, near = amplitude(expected["omega_res"]), 1e-4
    assert best > max(amplitude(expected["omega_res"] - near), amplitude(expected["omega_res"] + near))


@golden("G6.16-oscillator-H")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, k = given["m"], given["k"]
    scene = along(m, given["x"], given["p"] / m, vv.Harmonic(k))
    close(scene.invariants().energy, expected["H"])
    close(scene.acceleration()[0, 2] * m, expected["pdot"])
    close(given["p"] / m, expected["xdot"])
    quarter = math.pi / (2 * expected["omega"])
    x, v = heights(scene.run(t=np.linspace(0, 4 * quarter, 4001)))
    # Sampled a thousandth of a quarter apart, the largest of a cosine is missed by 1e-6 at most.
    close([x.max(), m * v.max()], [expected["semi_axis_x"], expected["semi_axis_p"]], rel=1e-6)
    close(2 * math.pi * expected["H"] / expected["omega"], expected["phase_area"])


@golden("G5.20-lorentz")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    charge = vv.Particles([given["m"]], [[given["x0"], given["y0"], 0.0]], [[given["vx0"], given["vy0"], 0.0]])
    electric = vv.UniformElectricField([given["E"], 0, 0], given["e"])
    scene = vv.Scene(charge, electric, vv.UniformMagneticField([0, 0, given["B"]], given["e"]))
    period = 2 * math.pi / expected["omega_c"]
    out = scene.run(t=[given["t"], 10 * period])
    close(out.position[0, 0, :2], [expected["x"], expected["y"]])
    close(out.velocity[0, 0, :2], [expected["vx"], expected["vy"]])
    close(out.energy, [expected["energy"]] * 2)
    drift = (out.position[1, 0] - charge.position[0]) / (10 * period)
    close(drift[:2], expected["v_drift"], scale=0.25)


@golden("G7.14-isotropic-oscillator")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    far, near, period = expected["r_max"], expected["r_min"], expected["radial_period"]
    scene = vv.Scene(
        vv.Particles([given["m"]], [[far, 0, 0]], [[0, given["l"] / (given["m"] * far), 0]]), vv.Harmonic(given["k"])
    )
    close(scene.invariants().energy, given["E"])
    # From the far side to the near one in half a radial period, over the apsidal angle of a right angle.
    out = scene.run(t=[period / 2, period]).position[:, 0, :2]
    close(out, [[near * math.cos(expected["apsidal_angle"]), near], [-far, 0.0]], scale=far)


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
