"""Equilibria where lengths, curvatures or masses differ by many powers of ten: each is told, once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def forms(potential: Callable[[Any], Any], field: float = 0.0) -> tuple[vv.Lagrangian, vv.Hamiltonian]:
    """L = v²/2 + b (x v_y − y v_x)/2 − V and the same by momenta p_x = v_x − b y/2, p_y = v_y + b x/2."""

    def function(q: Any, p: Any, t: Any) -> Any:
        return ((p[0] + field / 2 * q[1]) ** 2 + (p[1] - field / 2 * q[0]) ** 2) / 2 + potential(q)

    return (
        vv.Lagrangian(
            lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + field / 2 * (q[0] * v[1] - q[1] * v[0]) - potential(q),
            ["x", "y"],
        ),
        vv.Hamiltonian(function, ["x", "y"]),
    )


@pytest.mark.parametrize("mu", [1e-9, 1e-10, 1e-11, 1e-12])
@pytest.mark.parametrize("names", [["x", "y"], ["x", "y", "z"]])
def test_along_the_orbit_of_a_very_light_body_only_lagranges_points_count(mu: float, names: list[str]) -> None:
    """At 1e-10 a Lagrangian told 604 places along the orbit, where forces are 1e-10 of what they are the sums of."""

    def function(q: Any, v: Any, t: Any) -> Any:
        def distance(x: float) -> Any:
            return np.sqrt((q[0] - x) ** 2 + sum(each**2 for each in q[1:]))

        turning = q[0] * v[1] - q[1] * v[0] + (q[0] ** 2 + q[1] ** 2) / 2
        attraction = (1 - mu) / distance(-mu) + mu / distance(1 - mu)
        return sum(each**2 for each in v) / 2 + turning + attraction

    found = vv.Lagrangian(function, names).equilibria()
    off_axis = [each for each in found if abs(each.position[1]) > 0.1]
    triangular = np.array([[0.5 - mu, -np.sqrt(0.75)], [0.5 - mu, np.sqrt(0.75)]])
    # Forces tell the angle along the orbit by 1e-16 of what they are the sums of, in mu.
    np.testing.assert_allclose(
        sorted([each.position[:2].tolist() for each in off_axis], key=lambda place: place[1]),
        triangular,
        rtol=0,
        atol=64 * 2.2e-16 / mu,
    )
    assert all(each.stable for each in off_axis)
    on_axis = [each for each in found if abs(each.position[1]) <= 0.1]
    # The one opposite to the light body, at −1 − 5 mu/12; those beside it at 1 ∓ (mu/3)^(1/3) may be missed.
    opposite = min(on_axis, key=lambda each: float(each.position[0]))
    np.testing.assert_allclose(opposite.position[0], -1 - 5 * mu / 12, rtol=1e-14, atol=0)
    assert not any(each.stable for each in on_axis)
    assert len(on_axis) <= 3


@pytest.mark.parametrize("length", [1e-9, 1e-6, 1e-3, 1.0, 1e3])
def test_the_only_minimum_of_a_curved_valley(length: float) -> None:
    """H. H. Rosenbrock's: at 1e-6 a Lagrangian told 16 further places, a million lengths along the valley."""

    def potential(q: Any) -> Any:
        return (1 - q[0] / length) ** 2 + 100 * (q[1] / length - (q[0] / length) ** 2) ** 2

    for form in forms(potential):
        (one,) = form.equilibria()
        # Newton's method is as exact as forces of a condition of 2500 leave it.
        np.testing.assert_allclose(one.position / length, [1.0, 1.0], rtol=1e-12, atol=0)
        # ∂²V is [[802, −400], [−400, 200]] there, in lengths.
        squares = np.linalg.eigvalsh([[802.0, -400.0], [-400.0, 200.0]])
        np.testing.assert_allclose((one.frequencies * length) ** 2, squares, rtol=1e-10, atol=0)


@pytest.mark.parametrize("radius", [1e-9, 1e-6, 1e-4, 1e4, 1e9])
def test_a_ring_of_any_size_is_seen(radius: float) -> None:
    """V = (r² − a²)²/4a²: a Lagrangian of 1e-6 told the hill in its middle only."""

    def potential(q: Any) -> Any:
        return (q[0] ** 2 + q[1] ** 2 - radius**2) ** 2 / (4 * radius**2)

    for form in forms(potential):
        found = form.equilibria()
        hill = [each for each in found if np.hypot(*each.position) < 0.5 * radius]
        ring = [each for each in found if np.hypot(*each.position) >= 0.5 * radius]
        assert [each.stable for each in hill] == [False]
        assert 3 <= len(ring) <= 100
        # All around it, each as exact as forces that vanish beside r³ leave it.
        angles = np.sort([np.arctan2(*each.position) for each in ring])
        assert np.ptp(angles) > np.pi
        np.testing.assert_allclose([np.hypot(*each.position) for each in ring], radius, rtol=1e-12, atol=0)
        assert all(each.stable for each in ring)
        # Across the ring V″ is 2.
        np.testing.assert_allclose([each.frequencies[-1] for each in ring], np.sqrt(2.0), rtol=1e-10, atol=0)


@pytest.mark.parametrize("width", [1e-12, 1e-9, 1e-3])
@pytest.mark.parametrize("field", [1.0, 1e6])
def test_small_wells_in_a_strong_field(width: float, field: float) -> None:
    """V = (x² − a²)²/4a² + y²/2: momenta of rest, b a/2, add forces of b² a/4, 1e11 of those of the wells."""

    def potential(q: Any) -> Any:
        return (q[0] ** 2 - width**2) ** 2 / (4 * width**2) + q[1] ** 2 / 2

    for form in forms(potential, field):
        found = form.equilibria()
        np.testing.assert_allclose(
            [each.position / width for each in found], [[-1, 0], [0, 0], [1, 0]], rtol=1e-12, atol=1e-12
        )
        assert [each.stable for each in found] == [True, False, True]
        np.testing.assert_allclose(
            [each.momentum / (field * width / 2) for each in found], [[0, -1], [0, 0], [0, 1]], rtol=1e-12, atol=1e-12
        )
