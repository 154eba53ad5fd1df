"""Energies and units many powers of ten from one: powers scale exactly, and what is screened is Coulomb's near by."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

import visviva as vv
from visviva.potentials import Custom, PowerLaw, Yukawa

S = vv.scattering
ENERGIES = (1e-150, 1e-100, 1e-30, 1e30, 1e100, 1e150)


def inverse_fourth(r: object, c: float) -> object:
    return -c / r**4


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("n", [2.01, 2.5, 3.0, 4.0, 6.0])
def test_captures_scale_with_the_energy(n: float, energy: float) -> None:
    """None was captured beyond a window of distances, and what cannot be told was told as a number."""
    potential = PowerLaw(-3.0, n)
    scale = energy ** (2.0 / n)
    # As many roundings as the power of the energy has.
    captured = S.capture_cross_section(potential, energy=energy)
    assert captured * scale == pytest.approx(S.capture_cross_section(potential, energy=1.0), rel=2e-13, abs=0.0)
    # The barrier is at rⁿ = k(n − 2)/2E, and b² = r² n/(n − 2).
    exact = np.pi * (n / (n - 2.0)) * (3.0 * (n - 2.0) / 2.0 / energy) ** (2.0 / n)
    assert captured == pytest.approx(exact, rel=1e-12, abs=0.0)
    for angle in (0.3, 1.0, 2.5):
        here = S.cross_section(potential, energy=energy, angle=angle) * scale
        assert here == pytest.approx(S.cross_section(potential, energy=1.0, angle=angle), rel=1e-10, abs=0.0)
    with pytest.raises(vv.InvalidInput, match="captures nothing"):
        S.transport_cross_section(potential, energy=energy)


@pytest.mark.parametrize("energy", [1e-100, 1.0, 1e100])
def test_langevin_of_a_formula(energy: float) -> None:
    """π b² = 2π √(c/E) of −c/r⁴."""
    formula = Custom(inverse_fourth, parameters={"c": 3.0})
    exact = 2.0 * np.pi * np.sqrt(3.0 / energy)
    assert S.capture_cross_section(formula, energy=energy) == pytest.approx(exact, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("n", [1.01, 1.1, 1.5, 3.0, 7.0])
def test_cross_sections_of_powers_scale_with_the_energy(n: float, energy: float) -> None:
    """k/r^1.5 had a cross section of 9e12 for 1.02, and none at all where all of it was beyond the window."""
    potential, scale = PowerLaw(1.0, n), energy ** (2.0 / n)
    for find in (
        lambda e: S.transport_cross_section(potential, energy=e),
        lambda e: S.cross_section(potential, energy=e, angle=1.0),
        lambda e: S.total_cross_section(potential, energy=e, theta_min=1.0),
    ):
        # 1e-10 is what integrals are held to.
        assert find(energy) * scale == pytest.approx(find(1.0), rel=1e-10, abs=0.0)


@pytest.mark.parametrize("energy", ENERGIES)
@pytest.mark.parametrize("n", [1.01, 1.5, 3.0, 7.0])
def test_deflections_of_powers_scale_with_the_energy(n: float, energy: float) -> None:
    """Derivatives were a quarter off at 1e-120, where that of the force is no number, and delays were cut short."""
    length = energy ** (-1.0 / n)
    b = np.array([1e-6, 0.3, 1.0, 10.0, 1e5])
    # Each pair by itself, whichever others there are.
    here = S.deflect(
        PowerLaw(1.0, n), energy=[energy, 1.0] * 5, impact_parameter=np.repeat(b, 2) * np.tile([length, 1.0], 5)
    )
    there = S.deflect(PowerLaw(1.0, n), energy=1.0, impact_parameter=b)
    # As the length is rounded: its power of the energy has 500 times the last digit.
    near = {"rtol": 1e-11, "atol": 0.0}
    assert np.allclose(here.angle[::2], there.angle, **near)
    assert np.array_equal(here.angle[1::2], there.angle)
    assert np.allclose(here.derivative[::2] * length, there.derivative, **near)
    assert np.allclose(here.closest_approach[::2] / length, there.closest_approach, **near)
    assert np.allclose(here.path_delay[::2] / length, there.path_delay, rtol=1e-9, atol=0.0)


@pytest.mark.parametrize("unit", [1e-150, 1e-100, 1e100, 1e150])
def test_units_of_energy_change_nothing(unit: float) -> None:
    for n in (2.5, 4.0):
        captured = S.capture_cross_section(PowerLaw(-3.0 * unit, n), energy=unit)
        assert captured == pytest.approx(S.capture_cross_section(PowerLaw(-3.0, n), energy=1.0), rel=1e-13, abs=0.0)
    transport = S.transport_cross_section(PowerLaw(unit, 3.0), energy=unit)
    assert transport == pytest.approx(S.transport_cross_section(PowerLaw(1.0, 3.0), energy=1.0), rel=1e-10, abs=0.0)
    mean = S.collision_integral(PowerLaw(unit, 3.0), temperature=unit, diameter=1.0)
    assert mean == pytest.approx(
        S.collision_integral(PowerLaw(1.0, 3.0), temperature=1.0, diameter=1.0), rel=1e-9, abs=0.0
    )


def screened(energy: float) -> float:
    """The transport cross section of e^{-r}/r, times E²: Rutherford's within 1e-7, small angles ψ = K₁(b)/E beyond."""
    with mpmath.workdps(40):
        e, between = mpmath.mpf(energy), mpmath.mpf("1e-7")
        near = mpmath.pi / 2 * mpmath.log(1 + 4 * e**2 * between**2)
        k = [mpmath.besselk(order, between) for order in range(3)]
        return float(near - mpmath.pi * between**2 / 2 * (k[1] ** 2 - k[0] * k[2]))


def custom_yukawa(r: object, k: float) -> object:
    return k * np.exp(-r) / r


@pytest.mark.parametrize("energy", [1e15, 1e18, 1e20, 1e24, 1e30])
def test_transport_of_screened_charges_that_nearly_meet(energy: float) -> None:
    """All within 1e-17 of the screening length was left out: 5 % at 1e18, 29 % at 1e24.

    Rutherford's formula neglects the screening within 1e-7, a part of 1e-7 of an angle that small angles know better;
    the logarithm of both is ln(E) wide, and what is neglected 1e-14 of it. Small angles end where E b > 1e7.
    """
    for potential in (Yukawa(1.0, 1.0), Yukawa(-1.0, 1.0), Custom(custom_yukawa, parameters={"k": 1.0})):
        found = S.transport_cross_section(potential, energy=energy) * energy**2
        assert found == pytest.approx(screened(energy), rel=1e-10, abs=0.0)
    # S = γ E Q/2 of equal masses, γ = 1 and half of the beam's energy relative.
    stopping = S.nuclear_stopping(Yukawa(1.0, 1.0), beam_energy=2.0 * energy, masses=(1.0, 1.0)) * energy
    assert stopping == pytest.approx(screened(energy), rel=1e-10, abs=0.0)


def test_collision_integrals_of_hot_screened_charges() -> None:
    """T² Ω grows by ½ ln 1e6 over six decades: it stood still."""
    cold, hot = (S.collision_integral(Yukawa(1.0, 1.0), temperature=t, diameter=1.0) * t**2 for t in (1e12, 1e18))
    assert hot - cold == pytest.approx(0.5 * np.log(1e6), rel=1e-9, abs=0.0)


@pytest.mark.parametrize("energy", [1e30, 1e40, 1e60])
def test_rutherford_within_a_screening_length(energy: float) -> None:
    found = S.cross_section(Yukawa(1.0, 1.0), energy=energy, angle=1.0) * energy**2
    assert found == pytest.approx(1.0 / (16.0 * np.sin(0.5) ** 4), rel=1e-10, abs=0.0)
    total = S.total_cross_section(Yukawa(1.0, 1.0), energy=energy, theta_min=1.0) * energy**2
    assert total == pytest.approx(0.25 * np.pi / np.tan(0.5) ** 2, rel=1e-10, abs=0.0)


# At n = 0.05 and 1e-30 all turn at 1e600, which is no number.
@pytest.mark.parametrize(
    ("n", "energy"), [(n, energy) for n in (0.05, 0.2, 0.5) for energy in (1e-10, 1.0, 1e30, 1e100)]
)
def test_weak_powers_have_a_number_wherever_they_act(n: float, energy: float) -> None:
    """Their length at that energy may be no number, and then they are taken where they are.

    Small angles are ψ = (k/E) b⁻ⁿ √π Γ((n + 1)/2)/Γ(n/2), and next to it terms of its own size.
    """
    found = S.deflect(PowerLaw(1.0, n), energy=energy, impact_parameter=1.0)
    assert np.isfinite(found.angle)
    if energy >= 1e30:
        small = float(mpmath.sqrt(mpmath.pi) * mpmath.gamma((n + 1.0) / 2.0) / mpmath.gamma(n / 2.0)) / energy
        assert found.angle == pytest.approx(small, rel=1e-9, abs=0.0)


@pytest.mark.parametrize(("strength", "n", "energy"), [(-1e-12, 0.3, 1.0), (-1e-10, 0.5, 1.0), (-1.0, 1.2, 1e24)])
def test_faint_attraction_far_beyond_where_it_is_the_energy(strength: float, n: float, energy: float) -> None:
    """To first order ψ = k/(E bⁿ) √π Γ((n+1)/2)/Γ(n/2) (Landau & Lifshitz, § 20); the next is |V|/E of it."""
    b = np.array([0.5, 1.0, 2.0, 1e3])
    found = S.deflect(PowerLaw(strength, n), energy=energy, impact_parameter=b)
    expected = strength / energy * b**-n * np.sqrt(np.pi) * math.gamma(0.5 * (n + 1.0)) / math.gamma(0.5 * n)
    assert np.allclose(found.angle, expected, rtol=1e-9, atol=0.0)
    assert np.allclose(found.closest_approach, b, rtol=1e-9, atol=0.0)
    middle = S.impact_parameter(PowerLaw(strength, n), energy=energy, angle=abs(expected[1]))
    assert middle == pytest.approx([1.0], rel=1e-8, abs=0.0)


@pytest.mark.parametrize("n", [0.3, 0.5, 0.9, 1.5])
def test_angles_beside_a_center_that_attracts_slowly_only_rise(n: float) -> None:
    """From −πn/(2 − n) on, by no more than its rounding where b is tiny: of that nothing is a rainbow."""
    assert S.rainbows(PowerLaw(-1.0, n), energy=1.0) == ()
    b = np.logspace(-26.0, -6.0, 11)
    slopes = S.deflect(PowerLaw(-1.0, n), energy=1.0, impact_parameter=b).derivative
    assert (slopes > 0.0).all()
    screened = Custom(lambda r: -np.exp(-r) / r**n)
    assert S.deflect(screened, energy=1.0, impact_parameter=0.0).derivative > 0.0


@pytest.mark.parametrize(("n", "b"), [(0.5, 1e-12), (0.5, 1e-20), (0.9, 1e-9), (0.9, 1e-18)])
def test_slopes_beside_a_center_that_attracts_slowly(n: float, b: float) -> None:
    """Against differences of the angle to fifty digits; by four powers of b, whose rest is 1e-7."""
    with mpmath.workdps(60):
        wide, narrow = (beside_center(mpmath.mpf(n), b * (1 + mpmath.mpf(part))) for part in ("1e-12", "-1e-12"))
        slope = (wide - narrow) / (2 * mpmath.mpf("1e-12") * b)
    found = S.deflect(PowerLaw(-1.0, n), energy=1.0, impact_parameter=b).derivative
    assert found == pytest.approx(float(slope), rel=1e-6, abs=0.0)


@pytest.mark.parametrize("energy", [0.05, 1.0, 10.0])
@pytest.mark.parametrize("n", [1.75, 1.9])
def test_quotients_whose_second_derivatives_leave_the_range_are_powers(n: float, energy: float) -> None:
    """1/rⁿ is differentiated by (rⁿ)³, which is below all numbers where r⁻ⁿ is not: angles of 1e59 came of that."""
    b = np.array([0.1, 1e-2, 1e-3, 1e-5, 1e-9, 1e-12])
    quotient, power = (
        S.deflect(potential, energy=energy, impact_parameter=b)
        for potential in (Custom(lambda r: -1.0 / r**n), PowerLaw(-1.0, n))
    )
    assert np.allclose(quotient.angle, power.angle, rtol=1e-11, atol=0.0)
    assert np.allclose(quotient.closest_approach, power.closest_approach, rtol=1e-11, atol=0.0)


def beside_center(n: mpmath.mpf, b: mpmath.mpf) -> mpmath.mpf:
    """ψ of −1/rⁿ at E = 1, by r = r₀/sin φ."""
    low, high = mpmath.mpf(0), b
    for _ in range(320):
        middle = (low + high) / 2
        low, high = (middle, high) if middle * middle + middle ** (2 - n) < b * b else (low, middle)
    share, pull = (b / high) ** 2, high**-n

    def part(phi: mpmath.mpf) -> mpmath.mpf:
        sine, cosine = mpmath.sin(phi), mpmath.cos(phi)
        return cosine / mpmath.sqrt(1 - share * sine**2 + pull * sine**n)

    outer = mpmath.quad(part, [0, mpmath.pi / 8, mpmath.pi / 4])
    inner = mpmath.quad(part, [mpmath.pi / 4, mpmath.pi / 2], method="gauss-legendre")
    return mpmath.pi - 2 * mpmath.sqrt(share) * (outer + inner)
