"""What is conserved, what is not, and by how much: energies, Jacobi's integral, momenta, brackets, work.

Bounds: what is conserved changes by some roundings of its largest term in a step, and by a random walk of them over a
run: 1e-14, and 1e-13 of energies that are differences of larger ones; a difference of order 8 with steps of 0.01 is
off by 1e-13.
"""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from by_symbols import coordinates

import visviva as vv

T = np.linspace(0.0, 50.0, 501)
CONSERVATIVE = [
    "atwood",
    "cart_pendulum",
    "central_force",
    "chain",
    "charged_particle",
    "constant_force",
    "coupled_oscillators",
    "double_pendulum",
    "foucault",
    "henon_heiles",
    "hoop",
    "oscillator",
    "pendulum",
    "spherical_pendulum",
    "spring_pendulum",
    "swinging_atwood",
]


def made(name: str) -> Any:
    return vv.systems.chain(4) if name == "chain" else getattr(vv.systems, name)()


# A random walk of some thousand roundings of the largest term of the energy, which for a wild chain is some times it.
# Of 200 double pendulums near this one half stay within 2e-14, and 99 in a hundred within 1.1e-13.
@pytest.mark.parametrize("name", CONSERVATIVE)
def test_what_is_said_to_be_conserved_is(name: str) -> None:
    system = made(name)
    out = system.run(T)
    changes = out.conservation()
    assert list(changes) == system.conserved
    assert "energy" in changes
    assert max(changes.values()) <= (1.2e-13 if name == "double_pendulum" else 2e-14), changes
    assert out.energy[0] == pytest.approx(system.energy, rel=1e-15, abs=0)
    assert out.momentum[0] == pytest.approx(system.momentum, rel=1e-15, abs=0)


def test_energy_for_a_long_time() -> None:
    """Hénon and Heiles, 5000 units of time: no drift that rounding would not make."""
    energy = vv.systems.henon_heiles().run(np.linspace(0.0, 5000.0, 1001)).energy
    assert np.abs(energy / energy[0] - 1.0).max() <= 3e-14


@pytest.mark.parametrize("dt", [0.5, 0.43])
def test_energies_wander_and_do_not_drift(dt: float) -> None:
    """Nodes, and the step times them and itself, rounded to doubles were a drift of 8e-19 to 5e-18 in every step.

    The mean of 256 walks of 2000 steps is known to 5e-20 of a step.
    """
    random = np.random.default_rng(5)
    many = vv.systems.henon_heiles().ensemble(
        position=np.array([0.1, 0.0]) + 1e-3 * random.normal(size=(256, 2)),
        momentum=np.array([0.0, 0.5]) + 1e-3 * random.normal(size=(256, 2)),
    )
    energy = many.run([0.0, 2000 * dt], method="gauss16", dt=dt).energy
    drift = (energy[:, 1] / energy[:, 0] - 1.0) / 2000
    assert abs(drift.mean()) < 4.0 * drift.std() / 16.0 < 3e-19


def test_cyclic_coordinates() -> None:
    assert vv.systems.spherical_pendulum().cyclic == ["phi"]
    assert vv.systems.cart_pendulum().cyclic == ["x"]
    assert vv.systems.central_force().cyclic == ["phi"]
    assert vv.systems.double_pendulum().cyclic == []
    assert vv.systems.atwood().cyclic == []  # its constraint pushes on both
    (x, y), (vx, vy) = coordinates("x y")
    L = (vx**2 + vy**2) / 2
    assert vv.Lagrangian(L, [x, y]).cyclic == ["x", "y"]
    assert vv.Lagrangian(L - x**2, [x, y]).cyclic == ["y"]
    assert vv.Lagrangian(L, [x, y], forces={x: 1.0}).cyclic == ["y"]
    assert vv.Lagrangian(L, [x, y], forces={x: 0.0}).cyclic == ["x", "y"]
    assert vv.Lagrangian(L, [x, y], dissipation=vy**2).cyclic == ["x"]
    assert vv.Lagrangian(L, [x, y], constraints=[x - 1]).cyclic == ["y"]
    assert vv.Lagrangian(L + y * sp.Symbol("t"), [x, y]).cyclic == ["x"]
    # What cancels is not there: x − x and the square of a sine and a cosine.
    assert vv.Lagrangian(L + sp.sin(x) ** 2 + sp.cos(x) ** 2, [x, y]).cyclic == ["x", "y"]
    p, q = sp.symbols("p q")
    assert vv.Hamiltonian(p**2 / 2, [q], [p]).conserved == ["energy", "momentum of q"]


def test_broken_symmetry_drifts_and_the_expressions_know() -> None:
    (x, y), (vx, vy) = coordinates("x y")
    eps = sp.Symbol("eps")
    L = (vx**2 + vy**2) / 2 - (x**2 + y**2) / 2 - eps * x
    how = {"position": [1.0, 0.0], "velocity": [0.2, 0.7]}
    whole = vv.Lagrangian(L, [x, y], parameters={eps: 0.0}, **how)
    spin = x * vy - y * vx
    turning = whole.evaluate(spin, trajectory=whole.run(T))
    assert np.ptp(turning) <= 1e-14
    broken = whole.at(parameters={eps: 0.1})
    assert np.ptp(broken.evaluate(spin, trajectory=broken.run(T))) > 0.05
    # Galilei: M R − P t of two bodies that push each other.
    (a, b), (va, vb) = coordinates("a b")
    pair = vv.Lagrangian(va**2 + vb**2 / 2 - (a - b) ** 2, [a, b], position=[0.0, 1.0], velocity=[1.0, -0.5])
    out = pair.run(T)
    boost = pair.evaluate(2 * a + b - (2 * va + vb) * sp.Symbol("t"), trajectory=out)
    assert np.ptp(boost) <= 1e-12
    assert pair.cyclic == []


@pytest.mark.parametrize("Omega", [2.0, 4.0, 6.0])
def test_the_hoops_energy_exceeds_jacobis_integral(Omega: float) -> None:
    hoop = vv.systems.hoop(m=2.0, R=0.5, Omega=Omega, position=[1.0])
    out = hoop.run(T)
    energy = hoop.evaluate(
        lambda q, v, _, g, m, R, Omega: (
            m * R**2 * (v[0] ** 2 + (Omega * np.sin(q[0])) ** 2) / 2 - m * g * R * np.cos(q[0])
        ),
        trajectory=out,
    )[:, 0]
    excess = 2.0 * (0.5 * Omega * np.sin(out["theta"])) ** 2
    assert np.abs(energy - out.energy - excess).max() <= 1e-13 * np.abs(energy).max()
    assert np.ptp(out.energy) <= 1e-13 * np.abs(energy).max()
    assert np.ptp(energy) > 0.01


def test_dissipation_takes_twice_rayleighs_function() -> None:
    """A damped oscillator against its closed form; of two coupled ones, the energy against what is lost."""
    (x,), (v,) = coordinates("x")
    c = sp.Symbol("c")
    damped = vv.Lagrangian(
        v**2 / 2 - 2 * x**2, [x], parameters={c: 0.3}, dissipation=c * v**2 / 2, position=[1.0], velocity=[0.5]
    )
    assert damped.conserved == []
    out = damped.run(np.linspace(0.0, 20.0, 101))
    rate, turn = 0.15, np.sqrt(4.0 - 0.15**2)
    wanted = np.exp(-rate * out.t) * (np.cos(turn * out.t) + (0.5 + rate) / turn * np.sin(turn * out.t))
    assert np.abs(out.position[:, 0] - wanted).max() <= 1e-14
    (a, b), (va, vb) = coordinates("a b")
    lost = (va - vb) ** 2 / 10 + va**4 * sp.cos(b) ** 2 / 20
    two = vv.Lagrangian((va**2 + vb**2) / 2 - a**2 - (a - b) ** 2, [a, b], dissipation=lost, position=[1.0, 0.0])
    times = np.linspace(0.0, 4.0, 4001)
    out = two.run(times)
    # R is of the second and the fourth degree: the power is −(2 R₂ + 4 R₄).
    power = two.evaluate((va - vb) ** 2 / 5 + va**4 * sp.cos(b) ** 2 / 5, trajectory=out)[:, 0]
    simpson = np.ones(4001)
    simpson[1:-1:2], simpson[2:-1:2] = 4.0, 2.0
    assert out.energy[0] - out.energy[-1] == pytest.approx(simpson @ power / 3000.0, rel=1e-11, abs=0)


def test_a_driven_and_damped_oscillator_by_its_closed_form() -> None:
    (x,), (v,) = coordinates("x")
    t = sp.Symbol("t")
    driven = vv.Lagrangian(
        v**2 / 2 - 2 * x**2, [x], forces={x: 3 * sp.cos(1.5 * t)}, dissipation=v**2 / 10, position=[0.0]
    )
    out = driven.run(np.linspace(0.0, 200.0, 401))
    steady = 3.0 / (4.0 - 1.5**2 + 0.2j * 1.5)
    rate = -0.1 + 1j * np.sqrt(4.0 - 0.01)
    # Re(s e^{iωt}) + Re(a e^{λt}), from rest.
    first, second = -steady.real, -(1.5j * steady).real
    a = first + 1j * (first * rate.real - second) / rate.imag
    wanted = (steady * np.exp(1.5j * out.t) + a * np.exp(rate * out.t)).real
    assert np.abs(out.position[:, 0] - wanted).max() <= 1e-12
    # As part of the Lagrangian it is the same.
    inside = vv.Lagrangian(v**2 / 2 - 2 * x**2 + 3 * x * sp.cos(1.5 * t), [x], dissipation=v**2 / 10, position=[0.0])
    assert np.abs(inside.run(out.t).position - out.position).max() <= 1e-12


def test_forces_that_no_potential_has_do_work() -> None:
    """A force that turns: F = k (−y, x) adds the energy ∫F·v, here by the growth of a spiral."""
    k = 0.3
    spiral = vv.Lagrangian(
        lambda q, v, _: (v[0] ** 2 + v[1] ** 2) / 2 - (q[0] ** 2 + q[1] ** 2) / 2,
        ["x", "y"],
        forces={"x": lambda q, _v, _t: -k * q[1], "y": lambda q, _v, _t: k * q[0]},
        position=[1.0, 0.0],
    )
    out = spiral.run(np.linspace(0.0, 10.0, 101))
    # z'' = (−1 + ik) z
    root = np.sqrt(complex(-1.0, k))
    z = np.cosh(root * out.t)
    assert np.abs(out.position - np.stack([z.real, z.imag], axis=1)).max() <= 1e-13 * np.abs(z).max()
    hamiltonian = vv.Hamiltonian(
        lambda q, p, _: (p[0] ** 2 + p[1] ** 2 + q[0] ** 2 + q[1] ** 2) / 2,
        ["x", "y"],
        forces={"x": lambda q, _p, _t: -k * q[1], "y": lambda q, _p, _t: k * q[0]},
        position=[1.0, 0.0],
    )
    assert np.abs(hamiltonian.run(out.t).position - out.position).max() <= 1e-13 * np.abs(z).max()
    assert hamiltonian.conserved == []


def test_brackets_of_the_angular_momentum() -> None:
    q, p = sp.symbols("x y z"), sp.symbols("px py pz")
    m = sp.Symbol("m")
    free = vv.Hamiltonian(sum(u**2 for u in p) / (2 * m) - 1 / sp.sqrt(sum(u**2 for u in q)), q, p, parameters={m: 1.0})
    x, y, z = q
    px, py, pz = p
    spin = [y * pz - z * py, z * px - x * pz, x * py - y * px]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        assert sp.expand(free.poisson(spin[i], spin[j]) - spin[k]) == 0
        assert sp.expand(free.poisson(spin[j], spin[i]) + spin[k]) == 0
        assert free.poisson(spin[i], spin[i]) == 0
        assert sp.simplify(free.poisson(spin[i], sum(u**2 for u in p))) == 0
        assert free.poisson(q[i], p[i]) == 1
        assert free.poisson(q[i], p[j]) == 0
    # {f, H} is the rate of f, and Jacobi's identity.
    f, g, h = x**2 * py, sp.sin(x) * pz + y, px * z**3
    circle = [free.poisson(a, free.poisson(b, c)) for a, b, c in ((f, g, h), (g, h, f), (h, f, g))]
    assert sp.simplify(sum(circle)) == 0


def test_a_bracket_with_h_is_the_rate_along_a_motion() -> None:
    q, p = sp.symbols("x y"), sp.symbols("px py")
    H = (p[0] ** 2 + p[1] ** 2) / 2 + (q[0] ** 2 + q[1] ** 2) / 2 + q[0] ** 2 * q[1] - q[1] ** 3 / 3
    system = vv.Hamiltonian(H, q, p, position=[0.1, 0.0], momentum=[0.0, 0.5])
    f = q[0] * p[1] ** 2 + sp.cos(q[1])
    rate = system.poisson(f, H)
    h = 1e-2
    out = system.run(5.0 + h * np.arange(-4, 5))
    values = system.evaluate(f, rate, trajectory=out)
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
    assert weights @ values[:, 0] / h == pytest.approx(values[4, 1], rel=1e-12, abs=0)


def test_velocities_of_a_hamiltonian_are_rates_and_momenta_of_a_lagrangian_too() -> None:
    double = vv.systems.double_pendulum(position=[0.5, 0.3], velocity=[0.4, -0.2])
    out = double.run(T[:50])
    mass = np.array(
        [np.array(double.mass_matrix.subs(double.parameters | {"theta1": a, "theta2": b}), dtype=float)
         for a, b in out.position]
    )  # fmt: skip
    assert np.abs(np.einsum("tij,tj->ti", mass, out.velocity) - out.momentum).max() <= 1e-13
    H = vv.Hamiltonian(lambda q, p, _: p[0] ** 2 / 4 + q[0] ** 2, ["x"], position=[1.0], momentum=[0.3]).run(T[:50])
    assert np.array_equal(H.velocity, H.momentum / 2)
