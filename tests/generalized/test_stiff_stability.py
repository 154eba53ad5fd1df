"""Stability is told rightly where soft and stiff motions are side by side, and where a place may be left at no cost.

Bounds: a root and a quotient, 1e-15.
"""

import numpy as np
import pytest

import visviva as vv


def springs(*stiffness: float, damping: float = 0.0) -> vv.Lagrangian:
    names = [f"x{index}" for index in range(len(stiffness))]
    return vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - np.array(stiffness) @ q**2 / 2,
        names,
        dissipation=lambda q, v, t: damping * (v @ v) / 2,
        position=[0.0] * len(stiffness),
    )


@pytest.mark.parametrize("stiff", [1.0, 1e8, 1e16, 1e30])
@pytest.mark.parametrize("damping", [0.0, 1e-2])
def test_a_stiff_spring_hides_no_growing_motion(stiff: float, damping: float) -> None:
    """Uncoupled motions: one grows if its own square is negative (with damping, too: Thomson & Tait)."""
    assert not springs(-1e-3, 1.0, stiff, damping=damping).linearize().stable
    assert springs(1e-3, 1.0, stiff, damping=damping).linearize().stable
    assert not springs(1.0, stiff, damping=-1e-2).linearize().stable


@pytest.mark.parametrize("stiff", [1e6, 1e12, 1e17])
def test_an_inverted_pendulum_beside_a_stiff_spring_falls(stiff: float) -> None:
    system = vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - 9.81 * np.cos(q[0]) - stiff * q[1] ** 2 / 2, ["theta", "z"], position=[0.0, 0.0]
    )
    assert not system.linearize().stable
    if stiff < 1e9:  # beyond, Newton's method takes the soft direction for one without forces
        assert [each.stable for each in system.equilibria(near=[[0.01, 0.0]])] == [False]
    assert system.linearize(at=[np.pi, 0.0]).stable


@pytest.mark.parametrize(("soft", "stable"), [(-1e-3, False), (1e-3, True), (0.0, True)])
def test_a_stiff_pair_on_a_hill_or_in_a_valley(soft: float, stable: bool) -> None:
    """K = [[k + s, −k], [−k, k]] is positive semidefinite where s ≥ 0: its determinant is k s."""
    pair = vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - 1e9 * (q[0] - q[1]) ** 2 / 2 - soft * q[0] ** 2 / 2, ["a", "b"], position=[0.0, 0.0]
    )
    assert pair.linearize().stable is stable


@pytest.mark.parametrize("angle", [0.1, 0.7, 2.0, 3.0])
def test_what_rounding_makes_of_a_level_direction_is_no_growth(angle: float) -> None:
    """Around a hat's brim nothing pushes: there K is 0 but for the digits of the place."""
    hat = vv.Lagrangian(
        lambda q, v, t: v @ v / 2 - (q @ q - 1) ** 2 / 4, ["x", "y"], position=[np.cos(angle), np.sin(angle)]
    )
    assert hat.linearize().stable


@pytest.mark.parametrize(("k", "m"), [(0.1 + 0.2, 0.3), (0.3, 0.1 + 0.2)])
def test_stiffnesses_that_cancel_but_for_rounding_are_level(k: float, m: float) -> None:
    system = vv.Lagrangian(
        lambda q, v, t, k, m: v @ v / 2 - (k - m) * q[0] ** 2 / 2 - q[1] ** 2 / 2,
        ["x", "y"],
        parameters={"k": k, "m": m},
        position=[0.0, 0.0],
    )
    assert system.linearize().stable


@pytest.mark.parametrize(("turning", "stable"), [(2.0, True), (0.9, False)])
def test_gyroscopic_forces_hold_on_a_hill(turning: float, stable: bool) -> None:
    """On a round hill of square −1 a turning of more than 1 holds: λ⁴ + (4 w² − 2) λ² + 1 = 0."""
    system = vv.Lagrangian(
        lambda q, v, t: v @ v / 2 + turning * (q[0] * v[1] - q[1] * v[0]) + q @ q / 2, ["x", "y"], position=[0.0, 0.0]
    )
    assert system.linearize().stable is stable


def test_saddles_and_no_forces_at_all() -> None:
    saddle = vv.Lagrangian(lambda q, v, t: v @ v / 2 - q[0] * q[1], ["x", "y"], position=[0.0, 0.0])
    free = vv.Lagrangian(lambda q, v, t: v @ v / 2, ["x", "y"], position=[0.0, 0.0])
    assert not saddle.linearize().stable
    assert free.linearize().stable


def test_what_is_compiled_once_is_told_parameters_and_places_each_time() -> None:
    """ω = √(g/l) at the bottom, for each of three g of one model."""
    pendulum = vv.systems.pendulum(g=1.0, l=2.0)
    for g in (1.0, 4.0, 9.81):
        small = pendulum.at(parameters={"g": g}).linearize(at=[0.0])
        assert small.frequencies[0] == pytest.approx((g / 2.0) ** 0.5, rel=1e-15, abs=0)
        assert [each.stable for each in pendulum.at(parameters={"g": g}).equilibria()] == [False, True, False]


@pytest.mark.parametrize("soft", [1e-4, 1e-7, 1e-9, -1e-7])
def test_soft_directions_beside_gyroscopic_terms_are_not_level(soft: float) -> None:
    """K² has the square of the condition of K: its small numbers are no zeros."""
    turning = vv.Lagrangian(
        lambda q, v, t: (
            (v[0] ** 2 + v[1] ** 2) / 2
            - (np.sign(soft) * q[0] ** 2 + soft * q[1] ** 2) / 2
            + 2.5 * (q[0] * v[1] - q[1] * v[0])
        ),
        ["x", "y"],
        position=[0.0, 0.0],
    )
    assert turning.linearize().stable
