"""Lyapunov's exponents where they are known, and what the norm has to do with them.

Bounds: a sum of exponents is the logarithm of a determinant over the time, of which the motion's growth of e⁷
amplifies the rounding.
"""

import numpy as np
import pytest

import visviva as vv


def test_the_upright_double_pendulum() -> None:
    """An unstable equilibrium: the real parts of its eigenvalues, ±√(2 ± √2) for equal rods and masses.

    The frame turns to the directions that grow, once: some ln of a number of order 1 over the time.
    """
    upright = vv.systems.double_pendulum(
        m1=1.0, m2=1.0, l1=1.0, l2=1.0, g=1.0, position=[np.pi, np.pi], velocity=[0.0, 0.0]
    )
    wanted = np.array([np.sqrt(2 + np.sqrt(2)), np.sqrt(2 - np.sqrt(2))])
    wanted = np.concatenate([wanted, -wanted[::-1]])
    for system in (upright, upright.hamiltonian()):
        # The start is π but for its last digit, which grows as exp(1.85 t).
        near, far = (system.lyapunov_exponents(t) for t in (6.0, 12.0))
        assert np.abs(far - wanted).max() < 2.0 / 12.0
        # Twice the time, twice the sum less what the turn was.
        assert np.abs(2.0 * far - near - wanted).max() < 1e-4


def test_hanging_there_are_none() -> None:
    hanging = vv.systems.double_pendulum(position=[0.0, 0.0], velocity=[0.0, 0.0])
    assert np.abs(hanging.lyapunov_exponents(400.0)).max() < 2.0 / 400.0


def test_exponents_add_up_to_what_the_mass_matrix_changes() -> None:
    """Liouville: dq dp is kept, and dq dq̇ is that over det M, m₂ l₁² l₂² (m₁ + m₂ sin²(θ₁ − θ₂)) here."""
    double = vv.systems.double_pendulum(m1=1.0, m2=2.0, position=[2.0, 2.5], velocity=[0.0, 0.0])
    t = 7.0
    of_momenta, of_velocities = double.hamiltonian().lyapunov_exponents(t), double.lyapunov_exponents(t)
    assert abs(of_momenta.sum()) < 1e-12
    masses = [1.0 + 2.0 * np.sin(place[0] - place[1]) ** 2 for place in (double.position, double.run(t).position[-1])]
    assert of_velocities.sum() == pytest.approx(np.log(masses[0] / masses[1]) / t, abs=4e-11)
    assert abs(of_velocities.sum()) > 1e-3


def test_velocities_and_momenta_tend_to_the_same() -> None:
    """Half of the state by another matrix: exponents differ by a bounded logarithm over the time."""
    double = vv.systems.double_pendulum(position=[0.6, 0.9], velocity=[0.0, 0.0])
    for t in (50.0, 400.0):
        apart = double.lyapunov_exponents(t)[0] - double.hamiltonian().lyapunov_exponents(t)[0]
        assert abs(apart) < 2.5 / t


def test_henon_and_heiles() -> None:
    """At E = 1/8 there are both: an island of exponent 0, and a sea whose exponent settles between these bounds."""

    def from_a_place(y: float) -> vv.Hamiltonian:
        speed = np.sqrt(0.25 - y**2 + 2 * y**3 / 3)
        return vv.systems.henon_heiles().at(position=[0.0, y], momentum=[speed, 0.0])

    chaotic = from_a_place(-0.25).lyapunov_exponents(5000.0, interval=1.0)
    assert 0.035 < chaotic[0] < 0.055
    assert np.abs(chaotic[1:3]).max() < 0.003
    assert chaotic[0] + chaotic[3] == pytest.approx(0.0, abs=0.001)
    assert abs(from_a_place(0.1).lyapunov_exponents(5000.0)[0]) < 0.0025


WALLS = {
    "exp": np.exp,
    "Morse": lambda x: (1.0 - np.exp(-x)) ** 2,
    "Gauss": lambda x: -np.exp(-x * x),
    "tanh": lambda x: np.tanh(3.0 * x) ** 2,
    "cosh": np.cosh,
    "narrow": lambda x: x * x / 2.0 + 0.01 / np.cosh(40.0 * (x - 1.0)) ** 2,
}


@pytest.mark.parametrize("wall", WALLS)
def test_in_a_potential_with_functions_that_may_be_narrow(wall: str) -> None:
    """What steps are watched for reads the derivatives' whole state: Φ carries the rates along, and keeps areas."""
    system = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / 2.0 + WALLS[wall](q[0]), ["x"], position=[0.8], momentum=[0.3])
    t = 2.5
    flow = system.flow_jacobian(t)
    out = system.run([0.0, t], rtol=1e-13)

    def rates(k: int) -> list[float]:
        # −dV/dx by a difference of four places, to some 1e-12.
        x, h = out.position[k, 0], 1e-3
        v = [WALLS[wall](x + i * h) for i in (-2, -1, 1, 2)]
        return [out.momentum[k, 0], -(v[0] - 8.0 * v[1] + 8.0 * v[2] - v[3]) / (12.0 * h)]

    # The fifth derivative of the narrow one is 0.01 × 40⁵, times h⁴/30.
    within = 1e-6 if wall == "narrow" else 1e-10
    assert flow @ rates(0) == pytest.approx(rates(1), rel=0, abs=within)
    assert np.linalg.det(flow) == pytest.approx(1.0, rel=0, abs=1e-10)
    assert abs(system.lyapunov_exponents(t).sum()) < 1e-10


def test_a_drive_that_may_be_faster_than_a_step() -> None:
    """x'' = −x + cos 40 t: the derivatives are a turn of the plane, whatever drives it."""
    driven = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 - q[0] ** 2) / 2.0 + q[0] * np.cos(40.0 * t), ["x"], position=[0.8], velocity=[0.3]
    )
    c, s = np.cos(2.5), np.sin(2.5)
    assert driven.flow_jacobian(2.5) == pytest.approx(np.array([[c, s], [-s, c]]), rel=0, abs=1e-12)


@pytest.mark.parametrize("angle", [np.pi / 2, np.pi / 2 - 1e-3, 1.5])
def test_units_are_those_of_the_motion_and_not_of_its_start(angle: float) -> None:
    """At a right angle the force of a pendulum has no slope: in units of that instant neighbors part by e⁸ at once."""
    swing = vv.systems.pendulum(position=[angle])
    assert np.abs(swing.lyapunov_exponents(300.0)).max() < 2 * np.log(300.0) / 300.0
