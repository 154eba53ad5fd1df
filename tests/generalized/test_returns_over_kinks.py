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


@pytest.mark.parametrize("start", [1.0, 2.0])
@pytest.mark.parametrize("k", [10.0, 3e3, 1e4, 1e6])
def test_a_kink_right_beside_a_steep_wall(k: float, start: float) -> None:
    """p²/2 + |x| + exp(−k x): from k = 1e4 on it turns back closer to the kink than numbers beside 1 differ."""
    system = of_one(lambda x, p: p**2 / 2 + np.abs(x) + np.exp(-k * x), start, 0.0)
    with mp.workdps(40):
        top = mpf(start)
        energy, low = top + mp.exp(-k * top), mpf(0)
        for _ in range(60):
            low = -mp.log(energy + low if low < 0 else energy - low) / k

        # By the square root of the distance from a turning point, from which what is left of the energy is counted.
        def near(u: Any) -> Any:
            d = u * u
            fall = d if low + d < 0 else abs(low) - low - d
            return 2 * u / mp.sqrt(2 * (fall - mp.exp(-k * low) * mp.expm1(-k * d)))

        def far(u: Any) -> Any:
            return 2 * u / mp.sqrt(2 * (u * u - mp.exp(-k * top) * mp.expm1(k * u * u)))

        middle = min(80 / mpf(k), top / 2)
        cuts = sorted({mpf(0), mp.sqrt(max(-low, 0)), mp.sqrt(middle / 8 - low), mp.sqrt(middle - low)})
        expected = float(2 * (quad(near, cuts) + quad(far, [0, mp.sqrt(top - middle)])))
    for form in (system, system.lagrangian()):
        # The tolerance of steps on either side of the kink.
        assert form.period() == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    "potential", [lambda x: -1 / np.abs(x), lambda x: np.sqrt(np.abs(x)), lambda x: np.log(np.abs(x))]
)
def test_an_infinite_force_is_refused_whatever_is_tried(potential: Callable[[Any], Any]) -> None:
    system = of_one(lambda x, p: p**2 / 2 + potential(x), 1.0, 0.0)
    for asked in (system.period, system.action_variable, system.lagrangian().period):
        with pytest.raises(vv.errors.InvalidInput, match="the slope of its energy is no finite number"):
            asked()
