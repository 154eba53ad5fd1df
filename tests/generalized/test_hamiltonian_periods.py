"""Periods, actions and normal modes of Hamiltonians, against closed forms.

Bounds: EXACT is twice the largest error of these quadratures, of an action whose parts nearly cancel.
"""

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest

import visviva as vv

EXACT = 1e-13


def moving(H: Callable[..., Any], q: float, p: float) -> vv.Hamiltonian:
    return vv.Hamiltonian(H, ["x"], position=[q], momentum=[p])


def relativistic(q: Any, p: Any, t: Any) -> Any:
    return np.sqrt(1.0 + p[0] ** 2) + q[0] ** 2 / 2


def quartic(q: Any, p: Any, t: Any) -> Any:
    return p[0] ** 4 / 4 + q[0] ** 4 / 4


def squared(q: Any, p: Any, t: Any) -> Any:
    return (p[0] ** 2 + q[0] ** 2) ** 2 / 4


def shifted(q: Any, p: Any, t: Any) -> Any:
    """A pendulum with a momentum that is not m q̇."""
    return (p[0] - np.sin(q[0]) - 0.5) ** 2 / 2 - np.cos(q[0])


@pytest.mark.parametrize("place", [0.1, 2.0, 2.9, 3.1])
def test_a_pendulum_by_elliptic_functions(place: float) -> None:
    found = vv.systems.pendulum(g=1.0, position=[place]).hamiltonian()
    m = mpmath.sin(mpmath.mpf(place) / 2) ** 2
    assert found.period() == pytest.approx(float(4 * mpmath.ellipk(m)), rel=EXACT, abs=0)
    action = 8 / mpmath.pi * (mpmath.ellipe(m) - (1 - m) * mpmath.ellipk(m))
    assert found.action_variable() == pytest.approx(float(action), rel=EXACT, abs=0)


@pytest.mark.parametrize("size", [1e-8, 1.0, 1e6])
def test_a_function_of_an_oscillator(size: float) -> None:
    """H = I² has the frequency 2 I."""
    found, action = moving(squared, size, 0.3 * size), 1.09 * size**2 / 2
    assert found.period() == pytest.approx(np.pi / action, rel=EXACT, abs=0)
    assert found.action_variable() == pytest.approx(action, rel=EXACT, abs=0)


@pytest.mark.parametrize("amplitude", [0.01, 2.0, 20.0, 200.0])
def test_a_relativistic_oscillator(amplitude: float) -> None:
    """√(1 + p²) + q²/2: at q = a sin s, p² = u (u + 2) with u = a² cos² s / 2."""

    def integral(integrand: Callable[[Any, Any], Any]) -> float:
        def at(s: Any) -> Any:
            u = (amplitude * mpmath.cos(s)) ** 2 / 2
            return integrand(s, u)

        parts = [mpmath.pi / 2 * (1 - mpmath.mpf(2) ** -k) for k in range(16)] + [mpmath.pi / 2]
        return float(4 * mpmath.quad(at, parts))

    found = moving(relativistic, amplitude, 0.0)
    period = integral(lambda s, u: mpmath.sqrt(2) * (1 + u) / mpmath.sqrt(u + 2))
    area = integral(lambda s, u: amplitude * mpmath.cos(s) * mpmath.sqrt(u * (u + 2)))
    assert found.period() == pytest.approx(period, rel=EXACT, abs=0)
    assert found.action_variable() == pytest.approx(area / (2 * np.pi), rel=EXACT, abs=0)


@pytest.mark.parametrize(("q", "p"), [(1.0, 0.0), (0.0, 1.0), (0.2, 0.9), (-0.5, -0.3), (30.0, -10.0)])
def test_quartic_in_place_and_momentum(q: float, p: float) -> None:
    """q⁴ + p⁴ = 4 E encloses 4 Γ(5/4)² / Γ(3/2) √(4 E), whose derivative is the period."""
    area = float(4 * mpmath.gamma(1.25) ** 2 / mpmath.gamma(1.5))
    root = np.sqrt(q**4 + p**4)
    found = moving(quartic, q, p)
    assert found.period() == pytest.approx(2 * area / root, rel=EXACT, abs=0)
    assert found.action_variable() == pytest.approx(area * root / (2 * np.pi), rel=EXACT, abs=0)


def test_the_radial_motion_of_kepler() -> None:
    radial = vv.Hamiltonian(
        lambda q, p, t: p[0] ** 2 / 2 + 0.32 / q[0] ** 2 - 1 / q[0], ["r"], position=[1.0], momentum=[0.1]
    )
    root = np.sqrt(-2 * radial.energy)
    assert radial.period() == pytest.approx(2 * np.pi / root**3, rel=EXACT, abs=0)
    assert radial.action_variable() == pytest.approx(1 / root - 0.8, abs=EXACT)


def test_a_rotation_has_the_action_of_all_of_its_momentum() -> None:
    """∫ (q̇ + sin q + 1/2) dq over a turn: the part that is linear in the velocity counts, of a Lagrangian too."""
    rotating = moving(shifted, 0.0, 3.0)
    energy = 2.5**2 / 2 - 1.0
    m = 2 / (energy + 1)
    period = float(2 * mpmath.sqrt(m) * mpmath.ellipk(m))
    action = float(2 * mpmath.sqrt(2 * (energy + 1)) * mpmath.ellipe(m) / mpmath.pi)
    for turn in (2 * np.pi, -2 * np.pi):
        assert rotating.period(turn=turn) == pytest.approx(period, rel=EXACT, abs=0)
        for system in (rotating, rotating.lagrangian()):
            assert system.action_variable(turn=turn) == pytest.approx(action + 0.5, rel=EXACT, abs=0)
    back = rotating.at(momentum=[-2.0])
    assert back.action_variable(turn=2 * np.pi) == pytest.approx(action - 0.5, rel=EXACT, abs=0)


def test_a_rotation_that_is_not_quadratic() -> None:
    """√(1 + p²) − cos q: p² = (E + cos q)² − 1."""
    rotating = moving(lambda q, p, t: np.sqrt(1 + p[0] ** 2) - np.cos(q[0]), 0.0, 4.0)
    energy = mpmath.sqrt(17) - 1

    def rapid(q: Any) -> Any:
        return mpmath.sqrt((energy + mpmath.cos(q)) ** 2 - 1)

    parts = [mpmath.pi * k / 4 for k in range(9)]
    period = mpmath.quad(lambda q: (energy + mpmath.cos(q)) / rapid(q), parts)
    for turn in (2 * np.pi, -2 * np.pi):
        assert rotating.period(turn=turn) == pytest.approx(float(period), rel=EXACT, abs=0)
        action = float(mpmath.quad(rapid, parts) / (2 * mpmath.pi))
        assert rotating.action_variable(turn=turn) == pytest.approx(action, rel=EXACT, abs=0)


def test_what_has_no_period_is_refused() -> None:
    free = moving(lambda q, p, t: np.sqrt(1 + p[0] ** 2), 0.0, 1.0)
    with pytest.raises(vv.InvalidInput, match="does not come back"):
        free.period()
    with pytest.raises(vv.InvalidInput, match="stands still"):
        moving(relativistic, 0.0, 0.0).period()
    swing = moving(lambda q, p, t: np.sqrt(1 + p[0] ** 2) - np.cos(q[0]), 1.0, 0.0)
    with pytest.raises(vv.InvalidInput, match="turns back"):
        swing.period(turn=2 * np.pi)
    with pytest.raises(vv.InvalidInput, match="after a turn"):
        swing.at(position=[0.0], momentum=[0.5]).period(turn=2 * np.pi)
    over = swing.at(position=[0.0], momentum=[4.0])
    with pytest.raises(vv.InvalidInput, match="energy does not repeat"):
        over.period(turn=3.0)
    with pytest.raises(vv.InvalidInput, match=r"turn=2π"):
        over.period()
    with pytest.raises(vv.InvalidInput, match="separatrix"):
        swing.at(position=[0.0], momentum=[np.sqrt(8.0)]).period()
    with pytest.raises(vv.InvalidInput, match="one coordinate"):
        vv.systems.henon_heiles().period()
    with pytest.raises(vv.InvalidInput, match="energy to be conserved") as refused:
        moving(lambda q, p, t: p[0] ** 4 + t * q[0] ** 2, 1.0, 0.0).period()
    assert refused.value.argument == "H"
    with pytest.raises(vv.InvalidInput, match="got 0"):
        moving(relativistic, 1.0, 0.0).period(turn=0.0)


def test_normal_modes_are_those_of_the_lagrangian() -> None:
    coupled = vv.systems.coupled_oscillators()
    of_hamiltonian = coupled.hamiltonian()
    np.testing.assert_allclose(
        of_hamiltonian.normal_modes([0.0, 0.0]).frequencies, coupled.normal_modes([0.0, 0.0]).frequencies, rtol=1e-14
    )
    assert of_hamiltonian.linearize([0.0, 0.0]).stable
    assert moving(relativistic, 0.0, 0.0).normal_modes().stable


@pytest.mark.parametrize("start", [1.5, np.pi / 2, 1.5707963, 1.6])
def test_a_start_at_an_inflection_has_a_period_like_others(start: float) -> None:
    """Where V'' vanishes there is no time in it: "on a separatrix" was said at π/2."""
    hamiltonian = vv.Hamiltonian(lambda q, p, t: (1.0 + p[0] ** 2) ** 0.5 - np.cos(q[0]), ["x"], position=[start])
    period = hamiltonian.period()
    # It comes back to 1e-12 of itself.
    np.testing.assert_allclose(hamiltonian.run(period).position[-1], [start], rtol=1e-10)
    assert 9.3 < period < 9.9
