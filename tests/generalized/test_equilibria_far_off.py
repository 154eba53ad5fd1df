"""Equilibria in coordinates that are no angles: the same in any unit of length, where the system starts near them."""

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize("length", [1.0, 2.8, 2.95, 5.0, 1e3])
def test_a_spring_pendulum_hangs(length: float) -> None:
    """At r = l + m g/k, and upright at l − m g/k."""
    system = vv.systems.spring_pendulum(m=1.0, k=40.0, l=length, g=9.81, position=[1.1 * length, 0.5])
    for each in (system, system.hamiltonian()):
        stable = [found.position for found in each.equilibria() if found.stable]
        np.testing.assert_allclose(stable, [[length + 9.81 / 40.0, 0.0]], rtol=1e-12, atol=1e-12)
        upright = [found.position for found in each.equilibria() if not found.stable]
        places = [[length - 9.81 / 40.0, sign * np.pi] for sign in (-1.0, 1.0)]
        np.testing.assert_allclose(upright, places, rtol=1e-12, atol=1e-12)


def test_angles_are_told_within_a_turn() -> None:
    """However far the system starts: 0, ±π, not once more for each turn."""
    for start in (0.5, 7.0, 100.0):
        places = [found.position[0] for found in vv.systems.pendulum(position=[start]).equilibria()]
        np.testing.assert_allclose(places, [-np.pi, 0.0, np.pi], rtol=1e-12, atol=1e-12)


def test_a_spring_is_no_angle() -> None:
    """Its stiffness is the same a turn farther, its force is not."""
    spring = vv.Lagrangian(lambda q, v, t: 0.5 * v[0] ** 2 - 20.0 * (q[0] - 5.0) ** 2, ["x"], position=[5.5])
    for each in (spring, spring.hamiltonian()):
        (found,) = each.equilibria()
        np.testing.assert_allclose(found.position, [5.0], rtol=1e-12, atol=0.0)
