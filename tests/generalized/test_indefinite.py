"""Lagrangians whose form of the velocities is indefinite: accelerations need a search for pivots.

L = ẋẏ − y sin x makes x a pendulum and y what a neighboring pendulum differs by: y'' = −y cos x. Terms f(x, t) ẋ²
change the equation of y alone, and let the first pivot be anything, zero among it.

Bounds: energies and momenta are sums of some products, 1e-15 to 1e-14 of them; runs to ten to a hundred times what
they were seen to part by, as two equations that are coupled amplify their roundings.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

END = 5.0
START: dict[str, Any] = {"position": [1.0, 0.0], "velocity": [0.0, 1.0]}


def swings(q: Any, v: Any, _: Any) -> Any:
    return v[0] * v[1] - q[1] * np.sin(q[0])


def turning(q: Any, v: Any, t: Any) -> Any:
    """Its first pivot, sin x, vanishes whenever the pendulum hangs."""
    return swings(q, v, t) + 0.5 * np.sin(q[0]) * v[0] ** 2


def pendulum(theta: float) -> vv.GeneralizedTrajectory:
    alone = vv.Lagrangian(lambda q, v, _: 0.5 * v[0] ** 2 + np.cos(q[0]), ["x"], position=[theta])
    return alone.run(t=END, rtol=1e-14)


METHODS: list[tuple[str, dict[str, Any], float]] = [
    # What a method is off by at this tolerance, or this step.
    ("gauss16", {}, 1e-12),
    ("gauss8", {"dt": 0.01}, 1e-12),
    ("dop853", {"rtol": 1e-13}, 1e-11),
    ("taylor", {}, 1e-12),
    ("rk4", {"dt": 1e-3}, 1e-11),
    ("variational_lobatto8", {"dt": 0.02}, 1e-10),
]


@pytest.mark.parametrize(("method", "how", "allowed"), METHODS, ids=[method for method, *_ in METHODS])
@pytest.mark.parametrize("function", [swings, turning])
def test_the_first_coordinate_is_a_pendulum(function: Any, method: str, how: dict[str, Any], allowed: float) -> None:
    out = vv.Lagrangian(function, ["x", "y"], **START).run(t=END, method=method, **how)
    whole = pendulum(1.0)
    assert abs(out.position[-1, 0] - whole.position[-1, 0]) < allowed
    assert abs(out.velocity[-1, 0] - whole.velocity[-1, 0]) < allowed


def test_the_second_is_what_a_neighboring_pendulum_differs_by() -> None:
    """By y(0) = 1, ẏ(0) = 0: the derivative of the end by the first angle."""
    out = vv.Lagrangian(swings, ["x", "y"], position=[1.0, 1.0]).run(t=END)
    h = 1e-3
    ends = [pendulum(1.0 + k * h).position[-1, 0] for k in (-2, -1, 1, 2)]
    slope = (8.0 * (ends[2] - ends[1]) - (ends[3] - ends[0])) / (12.0 * h)
    # The difference errs by h⁴ = 1e-12 times a fifth derivative of some units, and by 1e-14 over h.
    assert out.position[-1, 1] == pytest.approx(slope, abs=1e-10)


def test_bateman_s_oscillator_is_damped() -> None:
    """H. Bateman, Physical Review 38 (1931) 815: linear, solved at once and by steps."""
    gamma, k = 0.2, 1.0

    def dual(q: Any, v: Any, _: Any) -> Any:
        return v[0] * v[1] + 0.5 * gamma * (q[0] * v[1] - v[0] * q[1]) - k * q[0] * q[1]

    system = vv.Lagrangian(dual, ["x", "y"], position=[1.0, 0.0])
    rate = np.sqrt(k - gamma**2 / 4.0)
    closed = np.exp(-gamma * END / 2.0) * (np.cos(rate * END) + gamma / (2.0 * rate) * np.sin(rate * END))
    for method in ("auto", "gauss16", "dop853"):
        assert system.run(t=END, method=method).position[-1, 0] == pytest.approx(closed, abs=1e-11), method


def test_energy_stays_where_the_first_pivot_vanishes_again_and_again() -> None:
    system = vv.Lagrangian(turning, ["x", "y"], **START)
    energy = system.run(t=np.linspace(0.0, 30.0, 101)).energy
    # y grows to some tens, and with it the terms of the energy.
    assert abs(energy - energy[0]).max() < 1e-11


@pytest.mark.parametrize("method", ["gauss8", "gauss16", "taylor", "dop853"])
def test_copies_have_the_bits_that_each_has_alone(method: str) -> None:
    starts = np.random.default_rng(2).uniform(-1.0, 1.0, (11, 2))
    # One that begins where the first pivot is zero.
    starts[3, 0] = 0.0
    system = vv.Lagrangian(turning, ["x", "y"], **START)
    together = system.ensemble(position=starts).run(t=END, method=method, threads=2)
    for place, start in enumerate(starts):
        alone = vv.Lagrangian(turning, ["x", "y"], position=start, velocity=START["velocity"])
        assert np.array_equal(together[place].position[-1], alone.run(t=END, method=method).position[-1])


def test_what_has_no_inverse_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="singular"):
        vv.Lagrangian(lambda q, v, _: (v[0] + v[1]) ** 2 / 2.0 - q[0] ** 2 * q[1], ["x", "y"], position=[1.0, 1.0]).run(
            t=1.0
        )


def test_hamiltonians_of_indefinite_forms() -> None:
    """In null coordinates L = v_x v_y − x y has H = p_x p_y + x y; a form that determines no velocities is refused."""
    null = vv.Lagrangian(
        lambda q, v, t: v[0] * v[1] - q[0] * q[1], ["x", "y"], position=[1.0, 2.0], velocity=[0.3, 0.5]
    )
    H = null.hamiltonian()
    assert H.energy == pytest.approx(0.15 + 2.0, rel=1e-15, abs=0)
    assert H.energy == pytest.approx(null.energy, rel=1e-15, abs=0)
    assert H.run(2.0).position[-1] == pytest.approx(null.run(2.0).position[-1], rel=1e-14, abs=0)
    # Three coordinates, the middle pivot of which vanishes after the first.
    three = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 + v[0] * v[1] + v[1] ** 2 / 2 + (2 + q[0]) * v[1] * v[2] - q[2] ** 2,
        ["x", "y", "z"],
        position=[1.0, 2.0, 0.3],
        velocity=[0.1, 0.2, 0.3],
    )
    assert three.hamiltonian().energy == pytest.approx(three.energy, rel=1e-14, abs=0)
    assert three.hamiltonian().momentum == pytest.approx(three.momentum, rel=1e-15, abs=0)
    degenerate = vv.Lagrangian(lambda q, v, t: (v[0] + v[1]) ** 2 / 2 - q[0] ** 2, ["x", "y"], position=[1.0, 2.0])
    with pytest.raises(vv.InvalidInput, match="degenerate"):
        degenerate.hamiltonian()


@pytest.mark.parametrize("place", [0.0, 1e-12, 0.7, -2.0])
def test_hamiltonians_keep_their_digits_where_an_entry_of_the_mass_matrix_vanishes(place: float) -> None:
    """M = [[x, 1], [1, 1]] is regular at x = 0 (det = x − 1), where its first pivot is not: H there is p M⁻¹ p / 2."""
    lagrangian = vv.Lagrangian(
        lambda q, v, t: q[0] * v[0] ** 2 / 2 + v[0] * v[1] + v[1] ** 2 / 2 - q[1],
        ["x", "y"],
        position=[place, 0.5],
        velocity=[0.3, -0.4],
    )
    mass = np.array([[place, 1.0], [1.0, 1.0]])
    momentum = mass @ [0.3, -0.4]
    # Some roundings, divided by a determinant of 1.
    energy = momentum @ np.linalg.solve(mass, momentum) / 2 + 0.5
    assert lagrangian.hamiltonian().energy == pytest.approx(energy, abs=1e-14)


def test_three_coordinates_whose_first_entry_vanishes() -> None:
    def function(q: Any, v: Any, t: Any) -> Any:
        mass = np.array([[q[0], 1.0, 0.0], [1.0, 2.0, 0.5], [0.0, 0.5, q[1]]], dtype=object)
        return v @ mass @ v / 2

    velocity = np.array([0.3, -0.4, 0.2])
    lagrangian = vv.Lagrangian(function, ["x", "y", "z"], position=[0.0, 0.3, 0.0], velocity=velocity)
    mass = np.array([[0.0, 1.0, 0.0], [1.0, 2.0, 0.5], [0.0, 0.5, 0.3]])
    assert lagrangian.hamiltonian().energy == pytest.approx(velocity @ mass @ velocity / 2, abs=1e-14)
