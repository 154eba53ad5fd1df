"""Small motions of Hamiltonians whose velocities are no linear expressions of momenta."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv
from visviva.generalized._motions_by_momenta import linearization_by_momenta, normal_modes_by_momenta


@pytest.mark.parametrize("c", [1e-3, 1.0, 3e8])
def test_a_slow_relativistic_oscillator_is_the_usual_one(c):
    m, k = 1.7, 2.3
    system = vv.Hamiltonian(
        lambda q, p, t: (m**2 * c**4 + p[0] ** 2 * c**2) ** 0.5 + k * q[0] ** 2 / 2, ["x"], position=[0.1 * c]
    )
    small = system.normal_modes()
    np.testing.assert_allclose(small.position, [0.0], atol=1e-12 * c)
    np.testing.assert_allclose(small.frequencies, [np.sqrt(k / m)], rtol=1e-12)
    np.testing.assert_allclose(small.modes, [[m**-0.5]], rtol=1e-12)
    assert small.stable


def test_momenta_at_rest_are_found():
    # Rest is at p = 3, where ∂²H/∂p² = 1 + 3·2².
    system = vv.Hamiltonian(
        lambda q, p, t: (p[0] - 3.0) ** 2 / 2 + (p[0] - 3.0) ** 4 / 4 + 2.0 * q[0] ** 2, ["x"], position=[0.0]
    )
    np.testing.assert_allclose(system.linearize().frequencies, [2.0], rtol=1e-12)


def test_one_that_is_quadratic_has_the_motions_of_its_lagrangian():
    rng = np.random.default_rng(5)
    for _ in range(10):
        a = rng.normal(size=(4, 4))
        second = a @ a.T

        def energy(q, p, t, second=second):
            state = [*q, *p]
            return sum(second[i, j] * state[i] * state[j] for i in range(4) for j in range(4)) / 2

        system = vv.Hamiltonian(energy, ["x", "y"], position=[0.0, 0.0])
        by_velocities, by_momenta = system.linearize(), linearization_by_momenta(system, None)
        for name in ("mass", "damping", "stiffness"):
            expected = getattr(by_velocities, name)
            # The inverse of ∂²H/∂p² loses what its condition says.
            size = np.abs(expected).max() * np.linalg.cond(second[2:, 2:])
            np.testing.assert_allclose(getattr(by_momenta, name), expected, rtol=0.0, atol=1e-13 * size)
        np.testing.assert_allclose(by_momenta.frequencies, by_velocities.frequencies, rtol=1e-9)
        np.testing.assert_allclose(normal_modes_by_momenta(system, [0.1, 0.2]).position, 0.0, atol=1e-12)


def test_small_motions_are_those_of_a_run():
    system = vv.Hamiltonian(
        lambda q, p, t: (
            (1.0 + p[0] ** 2) ** 0.5 + np.cosh(p[1] - 0.3 * p[0]) - np.cos(q[0]) - np.cos(q[1] - 0.5 * q[0])
        ),
        ["x", "y"],
        position=[0.1, 0.2],
    )
    small = system.normal_modes()
    t = np.linspace(0.0, 10.0, 11)
    way = np.array([1e-5, -2e-5])
    run = system.at(position=way, momentum=np.zeros(2)).run(t).position
    # Amplitudes of 2e-5 change periods by 1e-10.
    np.testing.assert_allclose(run, small.at(t, way, np.zeros(2)), rtol=0.0, atol=1e-13)


def test_what_has_no_small_motions_is_refused_by_name():
    quartic = vv.Hamiltonian(lambda q, p, t: p[0] ** 4 / 4 + q[0] ** 2, ["x"], position=[0.0])
    with pytest.raises(vv.InvalidInput, match="singular"):
        quartic.linearize()
    relativistic = vv.Hamiltonian(lambda q, p, t: (1.0 + p[0] ** 2) ** 0.5 + q[0] ** 2, ["x"])
    with pytest.raises(vv.InvalidInput, match="a force of -1 of 'x'"):
        relativistic.linearize(at=[0.5])
    driven = vv.Hamiltonian(lambda q, p, t: (1.0 + p[0] ** 2) ** 0.5 + q[0] ** 2 * np.cos(t), ["x"], position=[0.0])
    with pytest.raises(vv.InvalidInput, match="do not depend on the time"):
        driven.linearize()
    with pytest.raises(vv.InvalidInput, match="position"):
        relativistic.linearize()
