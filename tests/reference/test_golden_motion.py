"""Golden numbers of the motion of one body and of a body about a center."""

from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close
from numpy.typing import NDArray

import visviva as vv

golden = Golden()


def one_body(r: list[float], v: list[float], *forces: vv.forces.Force, mass: float = 1.0) -> vv.Scene:
    return vv.Scene(vv.Particles([mass], [[*r, 0.0, 0.0][:3]], [[*v, 0.0, 0.0][:3]]), *forces)


def attracted(given: dict[str, Any]) -> vv.Scene:
    return one_body(given["r"], given["v"], vv.CentralField(vv.potentials.Coulomb(-given["gamma"])), mass=given["m"])


def size(vector: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(vector))


@golden("G1.3-galilei")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    bodies = vv.Particles([1.0, 1.0], np.zeros((2, 3)), [[given["v_red"], 0, 0], [given["v_blue"], 0, 0]])
    seen = vv.Scene(bodies).in_frame(velocity=[given["v_friend"], 0.0, 0.0]).particles.velocity[:, 0]
    close(seen, [expected["v_red_in_friend"], expected["v_blue_in_friend"]])


@golden("G2.4-mass-ratio")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """The third law of the n-body force: masses of this ratio accelerate each other in this ratio."""
    masses = [given["m1"], expected["m2"]]
    first, second = vv.Scene(vv.Particles(masses, [[0, 0, 0], [1.7, 0, 0]]), vv.Gravity(3.0)).acceleration()[:, 0]
    close(first / second, given["a1"] / given["a2"])


@golden("G3.2-L-K")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """Unit mass, so that v = p and the uniform field g = F."""
    here = one_body(given["r"], given["p"], vv.UniformField(given["F"])).invariants()
    close(here.angular_momentum, expected["L"])
    close(here.torque, expected["K"])
    close(size(here.angular_momentum), expected["L_norm"])
    close(expected["L_norm"] / size(np.array(given["r"])), expected["p_t_norm"])
    close(expected["L_norm"] / size(np.array(given["p"])), expected["r_perp_norm"])


@golden("G3.2-offcentre-circle")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """The circle is an orbit of γ/r with γ = m ω² R³; a quarter of a turn and more, from Kepler's solution."""
    m, radius, omega = given["m"], given["R"], given["omega"]
    field = vv.CentralField(vv.potentials.Coulomb(-m * omega**2 * radius**3))
    scene = one_body([radius, 0.0], [0.0, omega * radius], field, mass=m)
    later = scene.run(t=given["t"]).final
    # The phase ω t = 2.1 is good to a few roundings of the rate: 1e-13.
    about = later.invariants(about=[given["d"], 0.0, 0.0])
    close(about.angular_momentum[2], expected["L_z"])
    close(about.torque[2], expected["K_z"])
    close(later.invariants().angular_momentum[2], expected["L_z_centre"])


@golden("G4.13-constant-force")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = one_body([given["x0"]], [given["v0"]], vv.UniformField([given["a0"], 0.0, 0.0]))
    for method in ({}, {"method": "leapfrog", "dt": 0.3}, {"method": "rk4", "dt": 0.3}):
        out = scene.run(t=given["t"], **method)  # type: ignore[arg-type]
        close(out.position[-1, 0, 0], expected["x"])
        close(out.velocity[-1, 0, 0], expected["v"])
    vertex = scene.run(t=expected["t_vertex"])
    close(vertex.position[-1, 0, 0], expected["x_vertex"])
    close(vertex.velocity[-1, 0, 0], 0.0, scale=given["v0"])


@golden("G4.17-trajectory")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    start, velocity = [given["x0"], given["y0"]], [given["vx0"], given["vy0"]]
    scene = one_body(start, velocity, vv.UniformField([0.0, given["a0"], 0.0]))
    times = [(given["x"] - given["x0"]) / given["vx0"], expected["t_apex"], expected["t_ground"]]
    (x, y), apex, ground = scene.run(t=times).position[:, 0, :2]
    close(x, given["x"])
    close(y, expected["y"])
    close(apex[1], expected["y_apex"])
    close(ground[0], expected["x_ground"])
    close(ground[1], 0.0, scale=expected["y_apex"])
    # The path is the parabola y = c2 x² + c1 x + c0 all along.
    path = scene.run(t=np.linspace(0.0, 2.0, 9)).position[:, 0]
    parabola = (expected["c2"] * path[:, 0] + expected["c1"]) * path[:, 0] + expected["c0"]
    close(path[:, 1], parabola, scale=20.0)


@golden("G7.20-kepler-ellipse")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = attracted(given)
    here = scene.invariants()
    close(here.energy, expected["E"])
    close(here.angular_momentum[2], expected["l"])
    close(here.angular_momentum[2] / (2.0 * given["m"]), expected["areal_rate"])
    out = scene.run(t=given["t"])
    # The orbit is of size 1 and y(t) crosses zero.
    close(out.position[-1, 0, :2], [expected["x_t"], expected["y_t"]], scale=1.0)
    close(out.velocity[-1, 0, :2], [expected["vx_t"], expected["vy_t"]], scale=1.0)
    close(scene.run(t=expected["period"]).position[-1, 0, :2], given["r"], scale=1.0, rel=5e-13)
    radii = np.linalg.norm(scene.run(t=np.linspace(0.0, expected["period"], 4001)).position[:, 0], axis=1)
    # Between samples the extreme is missed by (Δt)² / 8 · r'' < (1.2e-3)² / 8 · 4.
    assert expected["r_min"] * (1 - 1e-14) <= radii.min() <= expected["r_min"] + 1e-6
    assert expected["r_max"] * (1 + 1e-14) >= radii.max() >= expected["r_max"] - 1e-6


@golden("G7.20-kepler-hyperbola")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = attracted(given)
    close(scene.invariants().energy, expected["E"])
    close(scene.invariants().angular_momentum[2], expected["l"])
    final = scene.run(t=given["t"]).position[-1, 0]
    close(final[:2], [expected["x_t"], expected["y_t"]])
    close(size(final), expected["r_t"])
    # Far out the speed is v∞ (1 + γ/(2 E r)) and turns no more: 1e-9 at r = 1e9, squared in the direction.
    away, before = scene.run(t=1e9).velocity[-1, 0], scene.run(t=-1e9).velocity[-1, 0]
    close(size(away), expected["v_inf"], rel=2e-9)
    turn = np.arctan2(np.cross(before, away)[2], before @ away)
    close(turn, expected["deflection"], rel=5e-9)


@golden("G7.20-kepler-parabola")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    speed = np.sqrt(2.0 * given["gamma"] / (given["m"] * given["q"]))
    scene = attracted(given | {"r": [given["q"], 0.0], "v": [0.0, speed]})
    out = scene.run(t=given["t"])
    close(scene.invariants().angular_momentum[2], expected["l"])
    close(out.position[-1, 0, :2], [expected["x"], expected["y"]])
    close(size(out.position[-1, 0]), expected["r"])
    close(size(out.velocity[-1, 0]), expected["speed"])


@golden("G7.25-repulsive")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """From far away at the impact parameter p towards the repelling center, and far away again."""
    far, u, gamma = 1e9, given["u"], given["gamma"]
    speed = np.sqrt(u * u - 2.0 * gamma / (given["m"] * far))
    lever = given["p"] * u / speed
    scene = one_body([-far, lever], [speed, 0.0], vv.CentralField(vv.potentials.Coulomb(gamma)), mass=given["m"])
    # 1e-9 of everything happens beyond r = 1e9.
    close(abs(scene.invariants().angular_momentum[2]), expected["l"], rel=1e-8)
    close(scene.invariants().energy, expected["E"], rel=1e-8)
    away = scene.run(t=2.0 * far / u).velocity[-1, 0]
    close(np.arctan2(away[1], away[0]), expected["deflection"], rel=1e-8)


@golden("G7.13-circular")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = attracted(given | {"r": [expected["r0"], 0.0], "v": [0.0, given["l"] / (given["m"] * expected["r0"])]})
    close(scene.invariants().energy, expected["E"])
    out = scene.run(t=np.linspace(0.0, 1.5, 7))
    close(np.linalg.norm(out.position[:, 0], axis=1), np.full(7, expected["r0"]))
    angle = np.unwrap(np.arctan2(out.position[:, 0, 1], out.position[:, 0, 0]))
    close(angle, expected["theta_dot"] * out.t, scale=1.0, rel=5e-13)


@golden("G7.2-earth-orbit")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    a, e, m = given["a"], given["e"], given["m"]
    scene = attracted({"gamma": given["GM"] * m, "m": m, "r": [a * (1 - e), 0.0], "v": [0.0, expected["v_perihelion"]]})
    close(scene.invariants().energy, expected["E"])
    close(scene.invariants().angular_momentum[2], expected["l"])
    half = scene.run(t=expected["period"] / 2)
    close(half.position[-1, 0, 0], -a * (1 + e))
    close(half.velocity[-1, 0, 1], -expected["v_aphelion"])


@golden("G7-unit-mass")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    """Dividing γ, l, E by m leaves the orbit: start both at pericenter and compare."""
    a, e = expected["a"], expected["e"]
    r = a * (1 - e)
    with_mass = attracted({"gamma": given["gamma"], "m": given["m"], "r": [r], "v": [0.0, given["l"] / given["m"] / r]})
    unit = attracted({"gamma": expected["gamma_unit"], "m": 1.0, "r": [r], "v": [0.0, expected["L_unit"] / r]})
    close(with_mass.invariants().energy, given["E"])
    close(unit.invariants().energy, expected["E_unit"])
    times = [0.5, 3.0, 10.0]
    close(unit.run(t=times).position, with_mass.run(t=times).position, scale=a, rel=2e-12)


@golden("G7.11-radial-infall")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    scene = attracted(given | {"r": [given["R"]], "v": [0.0]})
    half = scene.run(t=expected["t_half_radius"]).position[-1, 0]
    close(half, [given["R"] / 2, 0.0, 0.0], scale=given["R"])
    # r ~ (t_fall − t)^(2/3) near the end: at 1e-6 before it, r = (9/2)^(1/3) (1e-6)^(2/3) to first order.
    near = scene.run(t=expected["t_fall"] - 1e-6).position[-1, 0, 0]
    close(near, 4.5 ** (1 / 3) * 1e-4, rel=1e-4)


@golden("G6.22-constant-force-H")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, force, start = given["m"], given["F"], given["p0"] / given["m"]
    scene = one_body([given["x0"]], [start], vv.UniformField([force / m, 0.0, 0.0]), mass=m)
    out = scene.run(t=[given["t"], -start * m / force])  # the turn comes later
    close(out.position[:, 0, 0], [expected["x"], expected["x_turn"]])
    close(out.momentum[0, 0], expected["p"])
    # V = −F x from the origin; x as a function of p is the parabola of constant H.
    close(out.energy, [expected["E"]] * 2)
    close((expected["p"] ** 2 / (2 * m) - scene.invariants().energy) / force, expected["x_from_p"])


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
