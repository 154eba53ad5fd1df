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
    np.testing.assert_allclose(small.position, [0.0], rtol=0.0, atol=1e-12 * c)
    np.testing.assert_allclose(small.frequencies, [np.sqrt(k / m)], rtol=1e-12, atol=0.0)
    np.testing.assert_allclose(small.modes, [[m**-0.5]], rtol=1e-12, atol=0.0)
    assert small.stable


def test_momenta_at_rest_are_found():
    # Rest is at p = 3, where ∂²H/∂p² = 1 + 3·2².
    system = vv.Hamiltonian(
        lambda q, p, t: (p[0] - 3.0) ** 2 / 2 + (p[0] - 3.0) ** 4 / 4 + 2.0 * q[0] ** 2, ["x"], position=[0.0]
    )
    np.testing.assert_allclose(system.linearize().frequencies, [2.0], rtol=1e-12, atol=0.0)


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
        np.testing.assert_allclose(by_momenta.frequencies, by_velocities.frequencies, rtol=1e-9, atol=0.0)
        np.testing.assert_allclose(normal_modes_by_momenta(system, [0.1, 0.2]).position, 0.0, rtol=0.0, atol=1e-12)


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


@pytest.mark.parametrize("m", [1e-27, 1e-9, 1e9])
def test_equilibria_in_any_units(m):
    """An oscillator was unstable where its momenta were in other units than its places."""
    (found,) = vv.Hamiltonian(lambda q, p, t: p[0] ** 2 / (2 * m) + m * q[0] ** 2 / 2, ["x"]).equilibria(
        near=[[0.1, 0.0]]
    )
    assert found.stable
    np.testing.assert_allclose(found.frequencies, [1.0], rtol=1e-13, atol=0.0)
    c, w = 3e8, 1e7
    proton = vv.Hamiltonian(lambda q, p, t: c * (p[0] ** 2 + (m * c) ** 2) ** 0.5 + m * w**2 * q[0] ** 2 / 2, ["x"])
    for near in ([[1e-3, 0.0]], None):
        (found,) = proton.equilibria(near=near)
        assert found.stable
        np.testing.assert_allclose(found.frequencies, [w], rtol=1e-12, atol=0.0)
    turning = vv.Hamiltonian(
        lambda q, p, t: (
            (p[0] ** 2 + p[1] ** 2) / (2 * m) + 0.3 * (q[0] * p[1] - q[1] * p[0]) + m * (q[0] ** 2 + 2 * q[1] ** 2) / 2
        ),
        ["x", "y"],
    )
    (found,) = turning.equilibria(near=[[0.1, 0.0, 0.0, 0.0]])
    np.testing.assert_allclose(found.position, 0.0, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(found.frequencies, turning.linearize([0.0, 0.0]).frequencies, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("g", [0.1, 1.0, 9.81, 50.0])
def test_a_hill_in_a_turning_frame_has_eigenvalues(g):
    """±√g ± iΩ lie so symmetrically that the iteration that finds them may go round in a circle."""
    for turn in [*np.logspace(-9, 0, 37), 0.3]:

        def lagrangian(q, v, t, turn=turn):
            return ((v[0] - turn * q[1]) ** 2 + (v[1] + turn * q[0]) ** 2 + g * (q[0] ** 2 + q[1] ** 2)) / 2

        hill = vv.Lagrangian(lagrangian, ["x", "y"], position=[0.0, 0.0])
        small = hill.linearize()
        assert not small.stable
        np.testing.assert_allclose(np.abs(small.eigenvalues.real), np.sqrt(g), rtol=1e-7, atol=0.0)


@pytest.mark.parametrize("unit", [1.0, 1e6, 1e12])
def test_frequencies_do_not_hang_on_units(unit):
    """Rounding of the largest entries was that of all: 1e-5 of a frequency, and growth that is none."""
    turning = vv.Lagrangian(
        lambda q, v, t: (
            (v[0] ** 2 + (unit * v[1]) ** 2) / 2
            - (q[0] ** 2 + 2 * (unit * q[1]) ** 2) / 2
            + 0.35 * unit * (q[0] * v[1] - q[1] * v[0])
            - 0.2 * unit * q[0] * q[1]
        ),
        ["x", "y"],
    )
    small = turning.linearize([0.0, 0.0])
    np.testing.assert_allclose(small.frequencies, [0.838662427252541, 1.6693248135443484], rtol=1e-13, atol=0.0)
    assert np.abs(small.eigenvalues.real).max() < 1e-14
    assert small.stable
