"""Periods along the motion itself where it has kinks, and where most of it is slow: by the steps that a run takes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf, quad

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def of_one(function: Callable[[Any, Any], Any], position: float, momentum: float) -> vv.Hamiltonian:
    """H(x, p)."""
    return vv.Hamiltonian(lambda q, p, t: function(q[0], p[0]), ["x"], position=[position], momentum=[momentum])


def test_two_quarks_on_a_string() -> None:
    """√(1 + p²) + |x|: the momentum falls and rises at rate 1 between ±√(E² − 1)."""
    string = of_one(lambda x, p: np.sqrt(1 + p**2) + np.abs(x), 0.3, 1.0)
    energy = np.sqrt(2.0) + 0.3
    largest = np.sqrt(energy**2 - 1)
    area = float(4 * quad(lambda p: energy - mp.sqrt(1 + p * p), [0, largest]))
    by_velocity = vv.Lagrangian(
        lambda q, v, t: -np.sqrt(1 - v[0] ** 2) - np.abs(q[0]), ["x"], position=[0.3], velocity=[np.sqrt(0.5)]
    )
    for system in (string, by_velocity):
        # The tolerance of steps on either side of each kink.
        assert system.period() == pytest.approx(4 * largest, rel=1e-12, abs=0)
        # Between its steps a method is not as exact as at them, where they end at a kink.
        assert system.action_variable() == pytest.approx(area / (2 * np.pi), rel=1e-11, abs=0)


def test_more_than_quadratic_kinetic_energy_beside_an_absolute_value() -> None:
    """p⁴/4 + p²/2 + |x|: again the momentum goes at rate 1, to where all the energy is kinetic."""
    system = of_one(lambda x, p: p**4 / 4 + p**2 / 2 + np.abs(x), 0.3, 1.0)
    largest = np.sqrt(np.sqrt(1 + 4 * 1.05) - 1)
    assert system.period() == pytest.approx(4 * largest, rel=1e-12, abs=0)


@pytest.mark.parametrize("start", [2.0, 5.0, 6.0, 7.0, 8.0, 10.0])
def test_predators_and_prey_of_every_amplitude(start: float) -> None:
    """e^x − x + e^p − p (Lotka & Volterra): fast rises beside slow declines; refused after 1e5 steps from p = 6 on."""
    system = of_one(lambda x, p: np.exp(x) - x + np.exp(p) - p, 0.0, start)
    with mp.workdps(80):
        energy = 1 + mp.exp(mpf(start)) - start

        def branch(left: Any, which: int) -> Any:
            """The negative (0) or positive (−1) root of e^p − p = left."""
            return -left - mp.lambertw(-mp.exp(-left), which).real

        low, high = branch(energy - 1, 0), branch(energy - 1, -1)

        def slowness(s: Any) -> Any:
            """dt/ds on both ways, x = middle + half tanh(π/2 sinh s) so that the turning points count for nothing."""
            u = mp.pi / 2 * mp.sinh(s)
            x = (low + high) / 2 + (high - low) / 2 * mp.tanh(u)
            left = energy - mp.exp(x) + x
            pace = (high - low) / 2 * mp.pi / 2 * mp.cosh(s) / mp.cosh(u) ** 2
            return pace * (1 / (mp.exp(branch(left, -1)) - 1) - 1 / (mp.exp(branch(left, 0)) - 1))

        def height(s: Any) -> Any:
            """(p₊ − p₋) dx/ds, which adds up to the area."""
            u = mp.pi / 2 * mp.sinh(s)
            x = (low + high) / 2 + (high - low) / 2 * mp.tanh(u)
            left = energy - mp.exp(x) + x
            pace = (high - low) / 2 * mp.pi / 2 * mp.cosh(s) / mp.cosh(u) ** 2
            return pace * (branch(left, -1) - branch(left, 0))

        step = mpf(1) / 64
        expected, area = (float(step * sum(each(k * step) for k in range(-250, 251))) for each in (slowness, height))
    # What a relative 1e-16 of p makes of e^p, at the fastest place.
    assert system.period() == pytest.approx(expected, rel=1e-10, abs=0)
    # The rise lasts a millionth of the period: between two nodes of a quadrature it was missed.
    assert system.action_variable() == pytest.approx(area / (2 * np.pi), rel=1e-9, abs=0)


def test_a_section_takes_the_steps_that_a_run_takes() -> None:
    """Its default was refused where there is an absolute value, and `run` chose another method by itself."""
    bouncing = vv.Hamiltonian(
        lambda q, p, t: (p[0] ** 2 + p[1] ** 2) / 2 + np.abs(q[0]) + q[1] ** 2 / 2,
        ["x", "y"],
        position=[0.5, 0.2],
        momentum=[0.0, 0.3],
    )
    passed = bouncing.poincare("x", 20.0)
    # Of x'' = ∓1 from rest at 1/2 a quarter is one unit of time.
    np.testing.assert_allclose(passed.t, 3.0 + 4.0 * np.arange(len(passed.t)), rtol=1e-10, atol=0)
    assert len(passed.t) == 5
