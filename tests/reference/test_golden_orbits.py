"""Golden numbers of `golden.json` for Kepler orbits, through `vv.orbits` (catalogue items 36–39, 47, 115).

Comparisons are relative to 1e-13, the accuracy the file promises, unless the line says why not.
"""

from typing import Any

import numpy as np
import pytest
from golden_cases import Golden, close

import visviva as vv

golden = Golden()


def spatial(plane: list[float]) -> list[float]:
    return [*plane, 0.0]


@golden("G7.20-kepler-ellipse")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    r, v = spatial(given["r"]), spatial(given["v"])
    conic = vv.orbits.conic(given["m"], given["gamma"], r, v)
    again = vv.orbits.conic_from_constants(
        given["m"], given["gamma"], angular_momentum=expected["l"], energy=expected["E"]
    )
    for found in (conic, again):
        close(found.angular_momentum, expected["l"])
        close(found.energy, expected["E"])
        close(found.eccentricity, expected["e"])
        close(found.semi_major_axis, expected["a"])
        close(found.semi_minor_axis, expected["b"])
        close(found.semi_latus_rectum, expected["semi_latus"])
        close(found.r_min, expected["r_min"])
        close(found.r_max, expected["r_max"])
        close(found.period, expected["period"])
        close(found.areal_rate, expected["areal_rate"])
        assert np.isnan(found.turning_angle)
    mu = given["gamma"] / given["m"]
    elements = vv.orbits.elements(mu, r, v)
    close(elements.argument_of_pericenter, expected["apsis_angle"])
    lenz = elements.laplace_runge_lenz
    close(np.arctan2(lenz[1], lenz[0]), expected["apsis_angle"])
    close(np.hypot(lenz[0], lenz[1]), mu * expected["e"])
    position, _ = vv.orbits.state(
        mu, pericenter=conic.r_min, eccentricity=conic.eccentricity, true_anomaly=given["theta"]
    )
    close(np.linalg.norm(position), expected["r_at_theta_from_periapsis"])
    position, velocity = vv.orbits.propagate(mu, r, v, given["t"])
    # y crosses zero nearby: to 1e-13 of r.
    close(position[:2], [expected["x_t"], expected["y_t"]], scale=0.58)
    close(velocity[:2], [expected["vx_t"], expected["vy_t"]])


@golden("G7.8-kepler-equation")
@golden("G7.8-kepler-equation-near-parabolic")
@golden("G7.8-kepler-equation-circle")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    e = given["e"]
    anomaly = vv.orbits.eccentric_from_mean(given["M"], e)
    close(anomaly, expected["E"])
    close(vv.orbits.mean_from_eccentric(anomaly, e), given["M"])
    nu = vv.orbits.true_from_eccentric(anomaly, e)
    close(nu, expected["nu"])
    close(vv.orbits.eccentric_from_true(nu, e), expected["E"])
    position, _ = vv.orbits.state(1.0, pericenter=1.0 - e, eccentricity=e, true_anomaly=nu)
    close(np.linalg.norm(position), expected["r_over_a"])


@golden("G7.20-kepler-hyperbola")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    r, v = spatial(given["r"]), spatial(given["v"])
    found = vv.orbits.conic(given["m"], given["gamma"], r, v)
    close(found.angular_momentum, expected["l"])
    close(found.energy, expected["E"])
    close(found.eccentricity, expected["e"])
    close(found.semi_major_axis, expected["a"])
    close(found.semi_minor_axis, expected["b"])
    close(found.angular_momentum / found.semi_minor_axis / given["m"], expected["v_inf"])
    close(found.turning_angle, expected["deflection"])
    close((found.turning_angle + np.pi) / 2, expected["theta_asymptote"])
    assert np.isinf([found.r_max, found.period]).all()
    position, _ = vv.orbits.propagate(given["gamma"] / given["m"], r, v, given["t"])
    close(position[:2], [expected["x_t"], expected["y_t"]])
    close(np.linalg.norm(position), expected["r_t"])


@golden("G7.20-kepler-parabola")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    mu, q = given["gamma"] / given["m"], given["q"]
    d = vv.orbits.parabolic_from_mean(np.sqrt(mu / (2 * q**3)) * given["t"])
    close(vv.orbits.true_from_parabolic(d), expected["nu"])
    r, v = vv.orbits.state(mu, pericenter=q, eccentricity=1.0)
    conic = vv.orbits.conic(given["m"], given["gamma"], r, v)
    close(conic.angular_momentum, expected["l"])
    close(conic.semi_latus_rectum, 2 * q)
    assert conic.energy == expected["E"]
    assert np.isinf([conic.semi_major_axis, conic.semi_minor_axis, conic.r_max]).all()
    position, velocity = vv.orbits.propagate(mu, r, v, given["t"])
    close(position[:2], [expected["x"], expected["y"]])
    close(np.linalg.norm(position), expected["r"])
    close(np.linalg.norm(velocity), expected["speed"])
    later = vv.orbits.elements(mu, position, velocity)
    close(later.true_anomaly, expected["nu"])
    close(later.time_since_pericenter, given["t"])


@golden("G7.25-repulsive")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    found = vv.orbits.conic_from_constants(
        given["m"],
        -given["gamma"],
        angular_momentum=given["m"] * given["u"] * given["p"],
        energy=0.5 * given["m"] * given["u"] ** 2,
    )
    close(found.angular_momentum, expected["l"])
    close(found.energy, expected["E"])
    close(found.eccentricity, expected["e"])
    close(found.r_min, expected["r_min"])
    close(found.semi_minor_axis, given["p"])
    close(found.turning_angle, expected["deflection"])
    close((np.pi - found.turning_angle) / 2, expected["theta_asymptote"])
    # The same orbit, from its state at the turning point.
    q = expected["r_min"]
    there = vv.orbits.conic(given["m"], -given["gamma"], [q, 0, 0], [0, expected["l"] / q / given["m"], 0])
    close(there.energy, expected["E"])
    close(there.eccentricity, expected["e"])
    with pytest.raises(vv.InvalidInput, match="energy"):
        vv.orbits.conic_from_constants(given["m"], -given["gamma"], angular_momentum=1.0, energy=0.0)


@golden("G7.13-circular")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, gamma = given["m"], given["gamma"]
    found = vv.orbits.conic_from_constants(m, gamma, angular_momentum=given["l"], energy=expected["E"])
    close(found.semi_latus_rectum, expected["r0"])
    close(2 * np.pi / found.period, expected["theta_dot"])
    # The rounding of E and l alone makes e of order √ε.
    assert found.eccentricity < 3e-8
    r, v = vv.orbits.state(gamma / m, pericenter=expected["r0"], eccentricity=0.0)
    circle = vv.orbits.conic(m, gamma, r, v)
    close(circle.angular_momentum, given["l"])
    close(circle.energy, expected["E"])
    close(circle.eccentricity, 0.0, scale=1.0)
    # A small radial oscillation about it has the period of the orbit: from pericenter to pericenter.
    ellipse = vv.orbits.elements(gamma / m, r, v * (1 + 1e-6))
    later, _ = vv.orbits.propagate(gamma / m, r, v * (1 + 1e-6), ellipse.period)
    close(np.linalg.norm(later), ellipse.pericenter)
    assert abs(2 * np.pi / ellipse.period / expected["radial_omega"] - 1) < 4e-6


@golden("G7.2-earth-orbit")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    mu, a, e, m = given["GM"], given["a"], given["e"], given["m"]
    close(vv.orbits.period(mu, a), expected["period"])
    r, v = vv.orbits.state(mu, pericenter=a * (1 - e), eccentricity=e, true_anomaly=[0.0, np.pi])
    close(np.linalg.norm(v, axis=-1), [expected["v_perihelion"], expected["v_aphelion"]])
    found = vv.orbits.conic(m, mu * m, r, v)
    close(found.angular_momentum, [expected["l"]] * 2)
    close(found.energy, [expected["E"]] * 2)
    close(found.eccentricity, [e, e], scale=1.0)


@golden("G7-unit-mass")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m = given["m"]
    found = vv.orbits.conic_from_constants(m, given["gamma"], angular_momentum=given["l"], energy=given["E"])
    unit = vv.orbits.conic_from_constants(
        1.0, expected["gamma_unit"], angular_momentum=expected["L_unit"], energy=expected["E_unit"]
    )
    close(found.eccentricity, expected["e"])
    close(unit.eccentricity, expected["e_unit"])
    close([found.semi_major_axis, unit.semi_major_axis], [expected["a"]] * 2)
    close([given["gamma"] / m, given["l"] / m, given["E"] / m], [unit.strength, unit.angular_momentum, unit.energy])
    close(found.period, unit.period)
    close(found.semi_minor_axis, unit.semi_minor_axis)


@golden("G7.11-radial-infall")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    mu, radius = given["gamma"] / given["m"], given["R"]
    times = vv.orbits.free_fall_time(mu, radius, [0.0, radius / 2])
    close(times, [expected["t_fall"], expected["t_half_radius"]])
    close(vv.orbits.period(mu, radius / 2) / 2, expected["t_fall"])
    position, _ = vv.orbits.propagate(mu, [radius, 0, 0], [0, 0, 0], expected["t_half_radius"])
    close(position, [radius / 2, 0, 0])


@golden("G8.29-two-body-period")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m1, m2, a = given["m1"], given["m2"], given["a"]
    mu = given["G"] * (m1 + m2)
    close(vv.orbits.period(mu, a), expected["period"])
    r, v = vv.orbits.state(mu, pericenter=a, eccentricity=0.0)
    close(vv.orbits.conic(expected["mu"], given["G"] * m1 * m2, r, v).energy, expected["E_rel"])
    # The distances from the center of mass, after a third of a turn in a scene of both bodies.
    share = m2 / (m1 + m2)
    bodies = vv.Particles([m1, m2], [-share * r, (1 - share) * r], [-share * v, (1 - share) * v])
    later = vv.Scene(bodies, vv.Gravity(given["G"])).run(t=expected["period"] / 3).position[-1]
    close(np.linalg.norm(later, axis=-1), [expected["d1"], expected["d2"]])


@golden("G8.35-two-body-state")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    r, v = (np.array([given[name + "1"], given[name + "2"]]) for name in "rv")
    m = np.array([given["m1"], given["m2"]])
    mu = given["G"] * m.sum()
    elements = vv.orbits.elements(mu, r[1] - r[0], v[1] - v[0])
    close(elements.semi_major_axis, expected["a"])
    close(elements.eccentricity, expected["e"])
    close(elements.period, expected["period"])
    relative, rate = vv.orbits.propagate(mu, r[1] - r[0], v[1] - v[0], given["t"])
    center, drift = (m @ r + given["t"] * (m @ v)) / m.sum(), m @ v / m.sum()
    share = np.array([[-m[1]], [m[0]]]) / m.sum()
    wanted = [[expected[name + "1"], expected[name + "2"]] for name in "rv"]
    close(center + share * relative, wanted[0])
    close(drift + share * rate, wanted[1], scale=1.0)
    out = vv.Scene(vv.Particles(m, r, v), vv.Gravity(given["G"])).run(t=given["t"])
    close(out.position[-1], wanted[0])
    close(out.velocity[-1], wanted[1], scale=1.0)


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
