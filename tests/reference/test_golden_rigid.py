"""Golden numbers of `golden.json` for rigid bodies, through `vv.rigid` (catalogue items 96–111).

Comparisons are relative to 1e-13, the accuracy the file promises, unless the line says why not.
"""

from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close

import visviva as vv

golden = Golden()


@golden("G9.59-euler-angles")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    angles = [given["phi"], given["theta"], given["psi"]]
    rates = [given["phi_dot"], given["theta_dot"], given["psi_dot"]]
    q = vv.rigid.quaternion_from_euler(angles)
    close(q, np.roll(expected["quaternion_body_to_space_wxyz"], -1))
    close(vv.rigid.matrix(q).T, expected["lam"])
    close(vv.rigid.rotate(q, [0.0, 0.0, 1.0]), expected["e3_in_space"])
    close(vv.rigid.angular_velocity_from_euler(angles, rates), expected["omega_body"])
    close(vv.rigid.angular_velocity_from_euler(angles, rates, frame="space"), expected["omega_space"])
    close(vv.rigid.euler_angles(q), angles)
    close(vv.rigid.euler_rates(angles, expected["omega_body"]), rates)


@golden("G9.42-free-symmetric-top")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    a, c = given["A"], given["C"]
    spin = [given["omega_perp"], 0.0, given["omega3"]]
    out = vv.rigid.free_rotation([a, a, c], spin, [0.0, given["t"]])
    path = vv.rigid.polhode([a, a, c], spin)
    assert path.kind == "symmetric"
    close(np.linalg.norm(out.angular_momentum, axis=-1), [expected["L"]] * 2)
    close(path.precession_rate, expected["Omega"])
    close(2 * np.pi / path.period, expected["body_precession"])
    close(out.angular_velocity[1], [expected["w1"], expected["w2"], given["omega3"]])
    close(out.energy, [expected["T"]] * 2)
    # The axis goes round L by Ω t, at the angle of its cone.
    axes = vv.rigid.rotate(out.orientation, [0.0, 0.0, 1.0])
    along = out.angular_momentum[0] / expected["L"]
    close(np.arccos(axes @ along), [expected["cone_angle"]] * 2)
    cones = vv.rigid.cone_angles([a, a, c], spin)
    close([cones.axis, cones.body], [expected["cone_angle"], expected["angle_omega_e3"]])
    turned = vv.rigid.rotate(vv.rigid.quaternion_from_rotation_vector(expected["Omega"] * given["t"] * along), axes[0])
    close(axes[1], turned, scale=1.0)
    velocity = vv.rigid.rotate(out.orientation, out.angular_velocity)
    cosine = (velocity * axes).sum(axis=-1) / np.linalg.norm(velocity, axis=-1)
    close(np.arccos(cosine), [expected["angle_omega_e3"]] * 2)
    # ω = Ω L/|L| + ψ̇ e₃.
    close(((velocity - expected["Omega"] * along) * axes).sum(axis=-1), [expected["psi_dot"]] * 2)


@golden("G9.43-earth-wobble")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    rate = 2 * np.pi / given["day"]
    period = vv.rigid.period([1.0, 1.0, given["C_over_A"]], [1e-6 * rate, 0.0, rate])
    # C − A of the rounded C/A: 1/0.00328 times ε.
    close(period, expected["period_s"])
    close(period / 86400.0, expected["period_days"])


@golden("G9.36-asymmetric-free")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    moments = [given["A"], given["B"], given["C"]]
    out = vv.rigid.free_rotation(moments, given["omega0"], given["t"])
    close(out.angular_velocity, [expected["w1"], expected["w2"], expected["w3"]])
    close(out.energy, expected["T"])
    close(out.angular_momentum @ out.angular_momentum, expected["L2"])
    path = vv.rigid.polhode(moments, given["omega0"])
    close(path.modulus**2, expected["modulus_m"])
    close(path.period, expected["period"])


@golden("G9.36-stability")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    moments, w, small = [given["A"], given["B"], given["C"]], given["w"], 1e-9
    # Oscillations about the outer axes: 2π over the period, to the square of the displacement.
    about = [vv.rigid.period(moments, w * axis + small * (1 - axis)) for axis in np.eye(3)]
    close(2 * np.pi / about[0], expected["freq_about_A"])
    close(2 * np.pi / about[2], expected["freq_about_C"])
    # Away from the middle one: the rate of the hyperbolic functions, and twice the logarithm of the displacement.
    path = vv.rigid.polhode(moments, [0.0, w, 1e-150])
    close(path.rate, expected["growth_rate_about_B"])
    further = vv.rigid.polhode(moments, [0.0, w, 1e-160])
    close((further.flip_time - path.flip_time) / (2 * np.log(1e10)), 1 / expected["growth_rate_about_B"])


@golden("G9.9-rigid-velocity")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    start = (given["v_A"], given["omega"], given["r_A"])
    velocity = vv.rigid.velocity_at(given["r_P"], *start)
    close(velocity, expected["v_P"])
    apart = np.array(given["r_P"]) - given["r_A"]
    close(apart @ (velocity - given["v_A"]), expected["rigidity"], scale=1.0)
    # From the other point the field is the same, and so is the screw.
    close(vv.rigid.velocity_at(given["r_A"], velocity, given["omega"], given["r_P"]), given["v_A"])
    here, there = vv.rigid.screw_axis(*start), vv.rigid.screw_axis(velocity, given["omega"], given["r_P"])
    close(there.pitch, here.pitch)
    close(there.speed, here.speed)
    close(np.cross(there.point - here.point, here.direction), np.zeros(3), scale=1.0)


@golden("G9.14-inertia-tensor")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    masses, places = np.array(given["m"]), np.array(given["r"])
    tensor = vv.rigid.inertia_tensor(masses, places)
    close(tensor, expected["I"])
    close(tensor @ given["omega"], expected["L"])
    close(0.5 * np.dot(given["omega"], tensor @ given["omega"]), expected["T"])
    close(vv.rigid.principal_axes(tensor).moments, expected["principal_moments"])
    body = vv.rigid.particles(masses, places)
    close(body.tensor, expected["I_cm"])
    # The particles' center of mass comes to a of the new origin.
    close(vv.rigid.parallel_axis(body.tensor, body.mass, given["a"]), expected["J_shifted"])


@golden("G9.29-cube-corner")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    s = given["s"]
    cube = vv.rigid.box(given["M"], s, s, s).moved([s / 2, s / 2, s / 2])
    tensor = cube.about([0.0, 0.0, 0.0])
    close(tensor.diagonal(), [expected["I_diag"]] * 3)
    close([tensor[0, 1], tensor[1, 2], tensor[2, 0]], [expected["I_off"]] * 3)
    close(vv.rigid.principal_axes(tensor).moments, expected["principal"])


@golden("G9.14-solids")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, a, b, c = (given[name] for name in "Mabc")
    radius, inner, h = given["R"], given["r"], given["h"]

    def pair(body: vv.rigid.MassProperties, low: float = 0.0) -> list[float]:
        tensor = body.about([0.0, 0.0, low])
        return [tensor[0, 0], tensor[2, 2]]

    close(vv.rigid.box(m, a, b, c).tensor.diagonal(), expected["cuboid"])
    close(vv.rigid.ellipsoid(m, a, b, c).tensor.diagonal(), expected["solid_ellipsoid_semiaxes_abc"])
    close(pair(vv.rigid.sphere(m, radius)), [expected["solid_sphere"]] * 2)
    close(pair(vv.rigid.sphere(m, radius, inner_radius=radius)), [expected["shell"]] * 2)
    close(pair(vv.rigid.cylinder(m, radius, h)), expected["solid_cylinder"])
    close(pair(vv.rigid.cylinder(m, radius, h, inner_radius=inner))[1], expected["hollow_cylinder_axis"])
    close(pair(vv.rigid.cone(m, radius, h), 0.75 * h), expected["solid_cone_apex"])
    close(pair(vv.rigid.cone(m, radius, h)), expected["solid_cone_cm"])
    close(pair(vv.rigid.rod(m, h))[0], expected["rod_centre_length_h"])
    close(pair(vv.rigid.rod(m, h), h / 2)[0], expected["rod_end_length_h"])
    close(pair(vv.rigid.disc(m, radius)), expected["disc"])
    close(pair(vv.rigid.disc(m, radius, inner_radius=radius)), expected["ring"])
    close(pair(vv.rigid.torus(m, radius, inner)), expected["torus_major_R_minor_r"])
    close(pair(vv.rigid.hemisphere(m, radius)), expected["solid_hemisphere_cm"])


def heavy_top(given: dict[str, Any]) -> vv.rigid.HeavyTop:
    if "MgR" in given:
        return vv.rigid.HeavyTop(given["A"], given["C"], given["MgR"], 1.0, 1.0)
    return vv.rigid.HeavyTop(given["A"], given["C"], given["M"], given["g"], given["R"])


@golden("G9.48-weak-torque")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    # The limit A Ω ≪ C ω₃: of a top that is light across its axis, the slow precession at the horizontal.
    top = vv.rigid.HeavyTop(given["C"], given["C"], given["M"], given["g"], given["R"])
    slow = top.steady_precession(np.pi / 2, given["omega3"]).slow
    close(top.weak_torque_precession(given["omega3"]), expected["Omega"])
    close(slow, expected["Omega"])
    close(2 * np.pi / slow, expected["period"])
    close(slow * given["C"] * given["omega3"], expected["torque_horizontal_max"])


@golden("G9.55-steady-precession")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    top = heavy_top(given)
    slow, fast = top.steady_precession(given["alpha"], given["omega3"])
    close([slow, fast], [expected["Omega_slow"], expected["Omega_fast"]])
    close(top.least_spin(given["alpha"]), expected["omega3_min"])
    frequencies = top.nutation_frequency(given["alpha"], given["omega3"])
    close(frequencies, [expected["nutation_omega_slow"], expected["nutation_omega_fast"]])
    close(fast + slow, expected["approx_fast"])
    # Small nutations about the fast one have that period, to the square of the displacement.
    psi_dot = given["omega3"] - fast * np.cos(given["alpha"])
    small = top.nutation(given["alpha"], theta_dot=1e-6, phi_dot=fast, psi_dot=psi_dot)
    assert abs(2 * np.pi / small.period / expected["nutation_omega_fast"] - 1) < 1e-12


@golden("G9.55-steady-precession-horizontal")
@golden("G9.55-steady-precession-hanging")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    slow, fast = heavy_top(given).steady_precession(given["alpha"], given["omega3"])
    close(slow, expected["Omega_slow"])
    if "Omega_fast" in expected:
        close(fast, expected["Omega_fast"])
    else:
        # cos of the binary64 number nearest to π/2 is 6e-17.
        assert fast > 1e17


@golden("G9.71-nutation-cusp")
@golden("G9.71-nutation-loop")
@golden("G9.71-nutation-wavy")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    rates = {name: given[name + "0"] for name in ("theta_dot", "phi_dot", "psi_dot")}
    found = heavy_top(given).nutation(given["theta0"], **rates)
    close(found.roots, expected["u_roots"])
    close(found.turning, expected["u_star"])
    close([found.theta_min, found.theta_max], [expected["theta_min"], expected["theta_max"]])
    close(found.period, expected["nutation_period"])
    assert found.kind == {"wavy": "wave"}.get(expected["kind"], expected["kind"])


@golden("G9.78-heavy-top")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    top = heavy_top(given)
    start = {"theta": given["theta0"]} | {name: given[name + "0"] for name in ("theta_dot", "phi_dot", "psi_dot")}
    nutation = top.nutation(**start)
    close(nutation.roots, expected["u_roots"])
    close([nutation.theta_min, nutation.theta_max], [expected["theta_min"], expected["theta_max"]])
    close(nutation.period, expected["nutation_period"])
    close(nutation.turning, expected["u_turn_phi_dot"])
    assert (nutation.kind == "loop") is expected["loops"]
    found = top.solve([given["t"], nutation.period], **start)
    close(found.theta[0], expected["theta_t"])
    close(found.phi[1], expected["phi_advance_per_nutation"])
    sine, cosine = np.sin(found.theta), np.cos(found.theta)
    momenta = top.momenta(start["theta"], psi_dot=start["psi_dot"], phi_dot=start["phi_dot"])
    close(momenta, [expected["p_phi"], expected["p_psi"]])
    ends = top.effective_potential([nutation.theta_min, nutation.theta_max], **momenta._asdict())
    close(ends, [expected["E_prime"]] * 2)
    p_psi = given["C"] * (found.psi_dot + found.phi_dot * cosine)
    close(p_psi, [expected["p_psi"]] * 2)
    close(given["A"] * found.phi_dot * sine**2 + p_psi * cosine, [expected["p_phi"]] * 2)
    kinetic = given["A"] * (found.theta_dot**2 + (found.phi_dot * sine) ** 2) / 2
    close(kinetic + given["MgR"] * cosine, [expected["E_prime"]] * 2)


@golden("G9.32-physical-pendulum")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    rod = vv.rigid.rod(given["M"], given["l"])
    across = vv.rigid.parallel_axis(rod.tensor, given["M"], [0.0, 0.0, given["l"] / 2])[0, 0]
    close(across, expected["I_pivot"])
    # A rod has no moment along itself; the motion without spin does not ask for it.
    top = vv.rigid.HeavyTop(across, 1e-3, given["M"], given["g"], given["l"] / 2)
    close(across / (given["M"] * given["l"] / 2), expected["equivalent_length"])
    # At 1e-7 of the vertical the period is that of small swings to 1e-15; one nutation is half a swing.
    swing = np.pi - 1e-7
    close(np.pi / top.nutation(swing, psi_dot=0.0).period, expected["omega_small"])
    t = np.linspace(0.0, 3.0, 7)
    found = top.solve(t, theta=swing, psi_dot=0.0)
    # Angles near π are rounded to 4e-16.
    assert np.abs(found.axis[:, 1] + (np.pi - swing) * np.cos(expected["omega_small"] * t)).max() <= 1e-15


@golden("G9.79-sleeping-top")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    top = heavy_top(given)
    close(top.sleeping_threshold, expected["omega3_crit"])
    # Above it the axis stays near the vertical, below it does not.
    for factor, stays in ((1.01, True), (0.99, False)):
        found = top.nutation(1e-6, psi_dot=factor * expected["omega3_crit"])
        assert (found.theta_max < 1e-4) is stays


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
