"""Golden numbers of `golden.json` for Lagrangians and Hamiltonians (catalogue items 81–95, chapters 5 and 6).

Comparisons are relative to 1e-13, the accuracy the file promises, unless the line says why not.
"""

from typing import Any

import mpmath
import numpy as np
import pytest
from golden_cases import Golden, close

import visviva as vv

golden = Golden()


def accelerations(system: vv.Lagrangian) -> np.ndarray:
    return system._model.rates(np.array([system.t0]), system._start()[None, :], system._values[None, :])[0]


@golden("G3.20-pendulum-speed")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    g, l, angle = given["g"], given["l"], given["theta0"]
    # In Cartesian coordinates, the rod a constraint whose gradient is a unit vector outwards.
    rod = vv.Lagrangian(
        lambda q, v, _, g, l: (v[0] ** 2 + v[1] ** 2) / 2 - g * q[1],
        ["x", "y"],
        parameters={"g": g, "l": l},
        position=[l * np.sin(angle), -l * np.cos(angle)],
        constraints=[lambda q, _v, _t, l, **_: (q[0] ** 2 + q[1] ** 2 - l**2) / (2 * l)],
        consistent="project",
    )
    quarter = float(mpmath.sqrt(l / g) * mpmath.ellipk(mpmath.sin(angle / 2) ** 2))
    out = rod.run(t=quarter)
    close(np.linalg.norm(out.velocity[-1]), expected["v_bottom"])
    close(-out.reactions[-1, 0] / g, expected["tension_over_mg_bottom"])
    pendulum = vv.systems.pendulum(g=g, l=l, position=[angle]).run(t=quarter)
    close(abs(pendulum.velocity[-1, 0]) * l, expected["v_bottom"])


@golden("G5.1-config-curve")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    def run(F0: float, alpha: float, m: float, t: float) -> np.ndarray:
        both = vv.Lagrangian(
            lambda q, v, _, F0, alpha, m: m * (v[0] ** 2 + v[1] ** 2) / 2 + F0 * q[0] - alpha * q[1] ** 2 / 2,
            ["x1", "x2"],
            parameters={"F0": F0, "alpha": alpha, "m": m},
            position=[0.0, given["A"]],
        )
        return both.run(t=t).position[-1]

    point = [given["x1"], expected["x2"]]
    close(run(given["F0"], given["alpha"], given["m"], expected["t"]), point)
    # The same curve s times as steep in √s less time, and for any mass.
    close(run(4 * given["F0"], 4 * given["alpha"], given["m"], expected["t"] / 2), point)
    close(run(given["F0"], given["alpha"], 9 * given["m"], 3 * expected["t"]), point)


@golden("G5.10-pendulum")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    pendulum = vv.systems.pendulum(g=given["g"], l=given["l"], position=[given["theta0"]])
    # Turning points are flat: the angle there is blind to an error of the period, the speed is not.
    out = pendulum.run(t=[given["t"], expected["period"]])
    close(out.position[:, 0], [expected["theta"], given["theta0"]])
    close(out.velocity[1, 0], 0.0, scale=given["g"] * expected["period"])
    # Swings of 1/1000 take longer by 1/16 of its square, 6e-8; what follows is 1e-14.
    small = pendulum.at(position=[1e-3])
    close(small.period(), expected["period_small"] * (1 + 1e-6 / 16))
    out = small.run(t=small.period())
    close(out.position[-1, 0], 1e-3)
    close(out.velocity[-1, 0], 0.0, scale=1e-3, rel=1e-12)
    close(pendulum.period(), expected["period"])


@golden("G5.4-actions")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, F0, omega = given["m"], given["F0"], given["omega"]
    for name, extra in (
        ("S_free", lambda x: 0.0),
        ("S_const_force", lambda x: F0 * x),
        ("S_oscillator", lambda x: -m * omega**2 * x**2 / 2),
    ):
        system = vv.Lagrangian(
            lambda q, v, _, extra=extra: m * v[0] ** 2 / 2 + extra(q[0]), ["x"], position=[given["x0"]]
        )
        thrown = system.boundary_value(given["T"], [given["x1"]])
        found = thrown.action(thrown.run(t=np.linspace(0.0, given["T"], 45)))
        close(found.value, expected[name])
        assert thrown.accessory_problem(thrown.run(t=given["T"])).minimum


@golden("G5.4-second-variation")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    oscillator = vv.systems.oscillator(k=given["m"] * given["omega"] ** 2, m=given["m"])
    rest = np.linspace(0.0, given["T"], 9), np.zeros(9)
    found = oscillator.second_variation(rest, lambda t: np.sin(np.pi * t / given["T"]))
    close(found.value, expected["second_variation"])
    assert not oscillator.accessory_problem(rest).minimum


@golden("G5.4-rotating-hoop")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, R, g, Omega = (given[name] for name in ("m", "R", "g", "Omega"))
    hoop = vv.systems.hoop(m=m, R=R, g=g, Omega=Omega, position=[given["theta"]], velocity=[given["theta_dot"]])
    close(accelerations(hoop)[0], expected["theta_ddot"])
    close(hoop.energy, expected["h"])
    energy = hoop.evaluate(
        lambda q, v, _, m, R, g, Omega: (
            m * R**2 * (v[0] ** 2 + (Omega * np.sin(q[0])) ** 2) / 2 - m * g * R * np.cos(q[0])
        )
    )
    close(energy[0], expected["T_plus_V"])
    close(energy[0] - hoop.energy, m * (R * Omega * np.sin(given["theta"])) ** 2)
    out = hoop.run(t=np.linspace(0.0, 10.0, 101))
    close(out.energy, np.full(101, expected["h"]))
    rest = hoop.at(position=[expected["theta_eq"]], velocity=[0.0])
    close(accelerations(rest)[0], 0.0, scale=g)
    small = rest.at(velocity=[1e-6]).run(t=np.pi / expected["omega_small"])
    # Half an oscillation; what is not linear is 1e-6 of it.
    close(small.velocity[-1, 0], -1e-6, rel=1e-9)
    aloft = hoop.equilibria()[3]
    close([*aloft.position, *aloft.frequencies], [expected["theta_eq"], expected["omega_small"]])
    assert accelerations(hoop.at(position=[1e-9], velocity=[0.0]))[0] > 0.0
    slower = hoop.at(position=[1e-9], velocity=[0.0], parameters={"Omega": expected["Omega_crit"] * (1 - 1e-12)})
    assert accelerations(slower)[0] < 0.0


@golden("G5.4-rotating-rod")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    rod = vv.systems.rod(m=given["m"], Omega=given["Omega"], position=[given["r0"]])
    out = rod.run(t=given["t"])
    close(out.position[-1, 0], expected["r"])
    close(out.velocity[-1, 0], expected["r_dot"])
    close(out.energy, [expected["h"]] * 2)
    kinetic = rod.evaluate(lambda q, v, _, m, Omega: m * (v[0] ** 2 + (q[0] * Omega) ** 2) / 2, trajectory=out)
    close(kinetic[-1, 0], expected["T"])


@golden("G5.14-double-pendulum")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    names = ("g", "l1", "l2", "m1", "m2")
    double = vv.systems.double_pendulum(
        **{name: given[name] for name in names},
        position=[given["th1"], given["th2"]],
        velocity=[given["w1"], given["w2"]],
    )
    values = double.parameters | dict(zip(double.coordinates, double.position, strict=True))
    mass = np.array(double.mass_matrix.subs(values), dtype=float)
    close(mass, expected["M"])
    close(accelerations(double), [expected["th1_ddot"], expected["th2_ddot"]])
    # From rest the accelerations are those of the forces alone.
    close(mass @ accelerations(double.at(velocity=[0.0, 0.0])), expected["Q"])
    close(double.momentum, [expected["p1"], expected["p2"]], scale=1.0)
    close(double.energy, expected["E"])
    close(double.velocity @ mass @ double.velocity / 2, expected["T"])
    close(double.at(velocity=[0.0, 0.0]).energy, expected["V"])


@golden("G5.20-lorentz")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    charge = vv.systems.charged_particle(
        m=given["m"],
        charge=given["e"],
        E=[given["E"], 0.0, 0.0],
        B=[0.0, 0.0, given["B"]],
        position=[given["x0"], given["y0"], 0.0],
        velocity=[given["vx0"], given["vy0"], 0.0],
    )
    period = 2 * np.pi / expected["omega_c"]
    out = charge.run(t=[given["t"], 10 * period])
    close(out.position[0, :2], [expected["x"], expected["y"]])
    close(out.velocity[0, :2], [expected["vx"], expected["vy"]])
    close(out.energy, [expected["energy"]] * 2)
    close((out.position[1, :2] - charge.position[:2]) / (10 * period), expected["v_drift"], scale=0.25)
    # p = m v + e A
    close(charge.momentum[0], given["m"] * given["vx0"] - given["e"] * given["B"] * given["y0"] / 2)


@golden("G5.32-spherical-pendulum")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    spherical = vv.systems.spherical_pendulum(
        **{name: given[name] for name in ("m", "l", "g")},
        position=[given["theta"], 0.0],
        velocity=[0.0, given["phi_dot"]],
    )
    assert spherical.cyclic == ["phi"]
    close(spherical.momentum[1], expected["p_phi"])
    out = spherical.run(t=np.linspace(0.0, 10.0, 101))
    close(out.momentum[:, 1], np.full(101, expected["p_phi"]))
    cone = spherical.at(velocity=[0.0, expected["conical_rate"]])
    close(accelerations(cone)[0], 0.0, scale=given["g"])


@golden("G5.29-atwood")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    machine = vv.systems.atwood(m1=given["m1"], m2=given["m2"], g=given["g"])
    close(accelerations(machine), [expected["acceleration"], -expected["acceleration"]])
    close(machine.run(t=0.3).reactions[:, 0], [-expected["tension"]] * 2)


@golden("G6.3-legendre-quartic")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    quartic = vv.Lagrangian(
        lambda _q, v, _, a: a * v[0] ** 4 / 4,
        ["x"],
        parameters={"a": given["a"]},
        position=[0.0],
        velocity=[given["qdot"]],
    )
    close(quartic.evaluate(lambda _q, v, _, a: a * v[0] ** 4 / 4)[0], expected["L"])
    close(quartic.momentum, [expected["p"]])
    close(quartic.energy, expected["H"])
    transform = quartic.legendre_transform()
    close(transform([0.0], [expected["p"]]), expected["H"])
    close(transform.conjugate([0.0], [expected["p"]]), [given["qdot"]])
    # Involution: of H = (3/4) a^(−1/3) p^(4/3) it returns L.
    back = vv.Hamiltonian(
        lambda _q, p, _, a: 0.75 * a ** (-1 / 3) * (p[0] ** 2) ** (2 / 3), ["x"], parameters={"a": given["a"]}
    ).legendre_transform()
    close(back([0.0], [given["qdot"]]), expected["L"])


@golden("G6.16-oscillator-H")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    oscillator = vv.Hamiltonian(
        lambda q, p, _, m, k: p[0] ** 2 / (2 * m) + k * q[0] ** 2 / 2,
        ["x"],
        parameters={"m": given["m"], "k": given["k"]},
        position=[given["x"]],
        momentum=[given["p"]],
    )
    close(oscillator.energy, expected["H"])
    out = oscillator.run(t=np.linspace(0.0, 2 * np.pi / expected["omega"], 4001))
    close([out.position[-1, 0], out.momentum[-1, 0]], [given["x"], given["p"]])
    close(out.velocity[0, 0], expected["xdot"])
    # Sampled a four-thousandth of a turn apart, the largest of a cosine is missed by 1e-6 at most.
    close([out.position.max(), out.momentum.max()], [expected["semi_axis_x"], expected["semi_axis_p"]], rel=1e-6)
    # ∮ p dx by the trapezoidal rule, which is exact for few waves in a whole turn.
    x, p = out.position[:-1, 0], out.momentum[:-1, 0]
    close((p * out.velocity[:-1, 0]).mean() * 2 * np.pi / expected["omega"], expected["phase_area"])
    assert len(x) == 4000
    double = oscillator.at(parameters={"m": given["m"] / 2, "k": 2 * given["k"]})
    close(double.run(t=np.pi / expected["omega"]).position[-1, 0], given["x"])


@golden("G6.22-constant-force-H")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    m, F = given["m"], given["F"]
    falling = vv.Hamiltonian(
        lambda q, p, _, m, F: p[0] ** 2 / (2 * m) - F * q[0],
        ["x"],
        parameters={"m": m, "F": F},
        position=[given["x0"]],
        momentum=[given["p0"]],
    )
    out = falling.run(t=np.linspace(0.0, given["t"], 11))
    close([out.position[-1, 0], out.momentum[-1, 0]], [expected["x"], expected["p"]])
    close(out.energy, np.full(11, expected["E"]))
    along = (out.momentum[:, 0] ** 2 - given["p0"] ** 2) / (2 * m * F) + given["x0"]
    close(out.position[:, 0], along)
    close(along[-1], expected["x_from_p"])
    turning = falling.run(t=-given["p0"] / F)
    close([turning.position[-1, 0], turning.momentum[-1, 0]], [expected["x_turn"], 0.0], scale=1.0)


@golden("G6.29-driven-H")
def _(given: dict[str, Any], expected: dict[str, Any]) -> None:
    driven = vv.Hamiltonian(
        lambda q, p, t, m, k, f0, Omega: p[0] ** 2 / (2 * m) + k * q[0] ** 2 / 2 - q[0] * f0 * np.cos(Omega * t),
        ["x"],
        parameters={name: given[name] for name in ("m", "k", "f0", "Omega")},
        position=[given["x"]],
        momentum=[given["p"]],
        t0=given["t"],
    )
    assert not driven.autonomous
    close(driven.energy, expected["H"])
    # dH/dt along the motion by differences of eighth order, 1e-2 apart: 1e-16 of the energies over the step.
    h = 1e-2
    weights = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])
    later = driven.run(t=given["t"] + h * np.arange(1, 5)).energy
    before = driven.run(t=given["t"] - h * np.arange(1, 5)).energy
    close(weights @ (later - before) / h, expected["dHdt"], rel=1e-11)


@pytest.mark.parametrize("identifier", golden.checks)
def test_golden(identifier: str) -> None:
    golden.run(identifier)
