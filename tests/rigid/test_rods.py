"""Rods, whose moment about their own axis is 0: they do not turn about it, whatever acts on them.

Their direction u obeys u̇ = v, I v̇ = (τ − (τ·u)u) × u − I v² u: the torque across them turns them, that along them is
taken up. Bounds: those of the methods' tolerances, 1e-12 a step for some tens of steps; equal steps to their order.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import visviva as vv

SPIN, TORQUE = np.array([0.0, 0.3, 0.4]), np.array([0.1, 0.2, 0.5])


def direction(time: float, drag: float = 0.0) -> np.ndarray:
    """Where the rod of moment 1 points that began along x."""

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        u, v = y[:3], y[3:]
        torque = TORQUE - (TORQUE @ u) * u - drag * np.cross(u, v)
        return np.concatenate([v, np.cross(torque, u) - (v @ v) * u])

    start = np.array([1.0, 0.0, 0.0])
    y = np.concatenate([start, np.cross(SPIN, start)])
    return solve_ivp(rates, (0.0, time), y, method="DOP853", rtol=1e-13, atol=1e-14).y[:3, -1]


def points(run: vv.Trajectory) -> np.ndarray:
    return vv.rigid.rotate(run.orientation[-1, 0], np.array([1.0, 0.0, 0.0]))


METHODS: list[tuple[str, dict[str, Any], float]] = [
    ("auto", {}, 1e-8),
    ("dop853", {"rtol": 1e-12}, 2e-11),
    ("verner98", {"rtol": 1e-12}, 2e-11),
    ("tsitouras54", {"rtol": 1e-10}, 1e-8),
    ("rk4", {"dt": 0.01}, 1e-8),
    ("leapfrog", {"dt": 1e-3}, 1e-6),
    ("yoshida8", {"dt": 0.02}, 1e-9),
]


@pytest.mark.parametrize(("method", "options", "bound"), METHODS)
def test_a_torque_in_space_turns_a_rod_across_itself(method: str, options: dict[str, Any], bound: float) -> None:
    """What it has along the rod was gathered as a spin that nobody saw, bent the motion, and was lost at the end."""
    scene = vv.Scene(vv.RigidBody(1.0, [0.0, 1.0, 1.0], angular_velocity=SPIN), vv.AppliedTorque(TORQUE))
    whole = scene.run(t=[0.0, 3.0], method=method, **options)
    np.testing.assert_allclose(points(whole), direction(3.0), rtol=0, atol=bound)
    assert whole.angular_velocity[-1, 0, 0] == 0.0
    half = scene.run(t=[0.0, 1.5], method=method, **options)
    halves = half.final.run(t=[1.5, 3.0], method=method, **options)
    np.testing.assert_allclose(points(halves), direction(3.0), rtol=0, atol=bound)
    back = whole.final.run(t=[3.0, 0.0], method=method, **options)
    np.testing.assert_allclose(back.angular_velocity[-1, 0], SPIN, rtol=0, atol=2 * bound)


def test_a_rod_on_a_pivot_and_with_drag() -> None:
    free = vv.Scene(
        vv.RigidBody(1.0, [0.0, 1.0, 1.0], angular_velocity=SPIN), [vv.AppliedTorque(TORQUE), vv.RotationalDrag(0.2)]
    )
    run = free.run(t=[0.0, 3.0], method="dop853", rtol=1e-12)
    np.testing.assert_allclose(points(run), direction(3.0, 0.2), rtol=0, atol=2e-11)
    # Held at a point of its axis half a length from its center: the moment about it is 3/4 + 1/4.
    held = vv.RigidBody(1.0, [0.0, 0.75, 0.75], angular_velocity=SPIN, pivot=[-0.5, 0.0, 0.0])
    run = vv.Scene(held, vv.AppliedTorque(TORQUE)).run(t=[0.0, 3.0], method="dop853", rtol=1e-12)
    np.testing.assert_allclose(points(run), direction(3.0), rtol=0, atol=2e-11)


def test_copies_of_rods_have_the_bits_of_one() -> None:
    scene = vv.Scene(vv.RigidBody(1.0, [0.0, 1.0, 1.0], angular_velocity=SPIN), vv.AppliedTorque(TORQUE))
    spins = np.array([[[0.0, 0.1 * k, 0.4]] for k in range(9)])
    every = scene.ensemble(angular_velocity=spins).run(t=[0.0, 3.0], method="dop853")
    for copy, spin in enumerate(spins):
        body = vv.RigidBody(1.0, [0.0, 1.0, 1.0], angular_velocity=spin[0])
        alone = vv.Scene(body, vv.AppliedTorque(TORQUE)).run(t=[0.0, 3.0], method="dop853")
        assert (every.orientation[copy] == alone.orientation).all()


@pytest.mark.parametrize("seed", range(8))
def test_a_rod_that_leans_takes_a_spin_across_it(seed: int) -> None:
    """Three of four were taken as a body, and refused when it ran: rounding had left a spin about the rod."""
    random = np.random.default_rng(seed)
    along = random.normal(size=3)
    along /= np.linalg.norm(along)
    spin = random.normal(size=3)
    spin -= (spin @ along) * along
    body = vv.RigidBody(1.0, inertia=1.3 * (np.eye(3) - np.outer(along, along)), angular_velocity=spin)
    for scene in (vv.Scene(body), vv.Scene(body, vv.RotationalDrag(0.0))):
        out = scene.run(t=1.0)
        turned = vv.rigid.rotate(out.orientation[-1, 0], along)
        angle = np.linalg.norm(spin)
        expected = along * np.cos(angle) + np.cross(spin / angle, along) * np.sin(angle)
        np.testing.assert_allclose(turned, expected, rtol=0, atol=1e-12)
