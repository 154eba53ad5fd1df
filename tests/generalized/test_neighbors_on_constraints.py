"""Neighbors of motions on constraints: those of the same motion in free coordinates."""

from __future__ import annotations

import numpy as np
import pytest
from rolling import MASS, RADIUS, STIFFNESS, cylinder_on_a_spring

import visviva as vv
from visviva.generalized._neighbors import flow_jacobian

G = 9.81


def in_a_plane(angle: float, rate: float) -> vv.Lagrangian:
    """A pendulum of length 1."""
    return vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - G * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1.0],
        position=[np.sin(angle), -np.cos(angle)],
        velocity=[rate * np.cos(angle), rate * np.sin(angle)],
        consistent="project",
    )


def chart(angle: float, rate: float) -> np.ndarray:
    """Derivatives of (x, y, ẋ, ẏ) by (θ, θ̇)."""
    s, c = np.sin(angle), np.cos(angle)
    return np.array([[c, 0.0], [s, 0.0], [-rate * s, c], [rate * c, s]])


def of_two_rods(position: np.ndarray, velocity: np.ndarray) -> vv.Lagrangian:
    """The double pendulum with masses and rods of 1, in x and y, from its angles."""
    (s, c), v = (np.sin(position), np.cos(position)), np.asarray(velocity)
    steps, rates = np.stack([s, -c], axis=1), np.stack([c * v, s * v], axis=1)
    return vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 - G * (q[1] + q[3]),
        ["x1", "y1", "x2", "y2"],
        constraints=[
            lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1.0,
            lambda q, v, t: (q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - 1.0,
        ],
        position=steps.cumsum(axis=0).ravel(),
        velocity=rates.cumsum(axis=0).ravel(),
        consistent="project",
    )


@pytest.mark.parametrize(("angle", "rate"), [(1.0, 0.0), (2.5, 1.0), (0.3, 7.0)])
@pytest.mark.parametrize("t", [0.1, 3.0, 20.0, -3.0])
def test_the_derivatives_of_a_flow_are_those_of_the_angle(angle, rate, t):
    free = vv.systems.pendulum(g=G, l=1.0, position=[angle], velocity=[rate])
    end = free.run(t)
    by_angle = free.flow_jacobian(t)
    first, last = chart(angle, rate), chart(end.position[-1, 0], end.velocity[-1, 0])
    expected = last @ by_angle
    found = in_a_plane(angle, rate).flow_jacobian(t)
    # What both runs lose in so many turns, at 1e-12 a step.
    np.testing.assert_allclose(found @ first, expected, rtol=0.0, atol=1e-10 * max(1.0, np.abs(expected).max()))
    assert np.linalg.matrix_rank(found, tol=1e-9) == 2


@pytest.mark.parametrize("t", [20.0, 300.0])
def test_rounding_across_constraints_is_taken_out(t):
    """Of the state, which would leave the circle by 1e-12 and more, and of its neighbors."""
    system = in_a_plane(2.0, 0.0)
    (x, y, vx, vy), found = flow_jacobian(system, t)
    assert abs(x**2 + y**2 - 1.0) < 1e-15
    assert abs(x * vx + y * vy) < 1e-14
    across = np.array([[x, y, 0.0, 0.0], [vx, vy, x, y]])
    np.testing.assert_allclose(across @ found, 0.0, rtol=0.0, atol=1e-14 * np.abs(found).max())


@pytest.mark.parametrize(("length", "rate"), [(1e10, 1e-12), (1e-10, 1e16)])
def test_units_of_places_and_velocities_have_nothing_to_do_with_it(length, rate):
    """A planet on a circle in SI: projected with places beside velocities it lost all digits."""

    def circling(u: float, w: float) -> vv.Lagrangian:
        return vv.Lagrangian(
            lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - (w * u) ** 2 * (q[1] / u),
            ["x", "y"],
            constraints=[lambda q, v, t: (q[0] ** 2 + q[1] ** 2) / u**2 - 1.0],
            position=[0.0, -u],
            velocity=[3.0 * u * w, 0.0],
        )

    unit = np.array([length, length, length * rate, length * rate])
    found = circling(length, rate).flow_jacobian(3.0 / rate) * unit / unit[:, None]
    np.testing.assert_allclose(found, circling(1.0, 1.0).flow_jacobian(3.0), rtol=0.0, atol=1e-9)


def test_differences_between_runs_are_the_derivatives():
    """Of a bead on a moving ring that turns and grows, with drag: nothing is conserved."""

    def ring(angle: float, rate: float) -> vv.Lagrangian:
        return vv.Lagrangian(
            lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - G * q[1],
            ["x", "y"],
            constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - (1.0 + 0.2 * np.sin(t)) ** 2],
            dissipation=lambda q, v, t: 0.1 * (v[0] ** 2 + v[1] ** 2),
            position=[np.sin(angle), -np.cos(angle)],
            velocity=[rate * np.cos(angle) + 0.2 * np.sin(angle), rate * np.sin(angle) - 0.2 * np.cos(angle)],
            consistent="project",
        )

    def state(angle: float, rate: float) -> np.ndarray:
        end = ring(angle, rate).run(2.0)
        return np.concatenate([end.position[-1], end.velocity[-1]])

    angle, rate, h = 0.7, 1.3, 1e-4
    found = ring(angle, rate).flow_jacobian(2.0)
    s, c = np.sin(angle), np.cos(angle)
    by_angle = np.array([c, s, -rate * s + 0.2 * c, rate * c + 0.2 * s])
    by_rate = np.array([0.0, 0.0, c, s])
    for way, step in ((by_angle, np.array([h, 0.0])), (by_rate, np.array([0.0, h]))):
        difference = (state(*(np.array([angle, rate]) + step)) - state(*(np.array([angle, rate]) - step))) / (2.0 * h)
        # Central differences are off by h² times third derivatives.
        np.testing.assert_allclose(found @ way, difference, rtol=0.0, atol=1e-6)


def test_exponents_of_two_rods_are_those_of_their_angles():
    """In another norm: a bounded logarithm over the time."""
    angles = [2.0, 2.5]
    free = vv.systems.double_pendulum(m1=1.0, m2=1.0, l1=1.0, l2=1.0, g=G, position=angles, velocity=[0.0, 0.0])
    bound = of_two_rods(np.array(angles), np.zeros(2))
    for t in (6.0, 12.0):
        found, expected = bound.lyapunov_exponents(t), free.lyapunov_exponents(t)
        assert found.shape == (4,)
        assert np.abs(found - expected).max() < 5.0 / t
        assert expected[0] > 5.0 / t


def test_at_the_top_exponents_are_the_eigenvalues():
    upright = in_a_plane(np.pi, 0.0)
    wanted = np.sqrt(G) * np.array([1.0, -1.0])
    near, far = (upright.lyapunov_exponents(t) for t in (2.0, 4.0))
    # Twice the time, twice the sum less what the turn of the frame was.
    assert np.abs(2.0 * far - near - wanted).max() < 1e-4
    assert np.abs(in_a_plane(0.0, 0.0).lyapunov_exponents(100.0)).max() < 0.03


def test_what_rolls_has_neighbors_that_roll():
    """x is tied to φ by a constraint of velocities: of four numbers of a state three are free."""
    rolling, radius = cylinder_on_a_spring(0.3, 0.1), RADIUS
    t, omega = 1.7, np.sqrt(STIFFNESS / (1.5 * MASS))
    found = rolling.flow_jacobian(t)
    c, s = np.cos(omega * t), np.sin(omega * t)
    np.testing.assert_allclose(
        found @ [1.0, 0.0, 0.0, 0.0], [c, (c - 1.0) / radius, -omega * s, -omega * s / radius], rtol=0.0, atol=1e-12
    )
    np.testing.assert_allclose(found @ [0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], rtol=0.0, atol=1e-12)
    along = np.array([0.0, 0.0, 1.0, 1.0 / radius])
    np.testing.assert_allclose(found @ along, [s / omega, s / omega / radius, c, c / radius], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(found @ [0.0, 0.0, 1.0 / radius, -1.0], 0.0, rtol=0.0, atol=1e-12)
    assert rolling.lyapunov_exponents(10.0).shape == (3,)
