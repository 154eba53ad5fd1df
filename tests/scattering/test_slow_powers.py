"""Transport cross sections of what falls hardly faster than 1/r: most of them lies farther out than any interval."""

import math

import numpy as np
import pytest

import visviva as vv

s = vv.scattering
V = vv.potentials


def by_hand(potential: vv.potentials.Potential, energy: float, power: float, strength: float, order: int) -> float:
    """∫ over ln b by Gauss and Legendre, and what is beyond by its leading term: ψ = c k/(E bⁿ)."""
    x, weights = np.polynomial.legendre.leggauss(20)
    ends = np.linspace(-12.0, 40.0, 131)
    half = 0.5 * np.diff(ends)[:, None]
    b = np.exp(half * x + 0.5 * (ends[1:] + ends[:-1])[:, None])
    angle = s.deflection_angle(potential, energy=energy, impact_parameter=b)
    cosine = np.cos(angle)
    turned = 2.0 * np.sin(0.5 * angle) ** 2 * (1.0 if order == 1 else 1.0 + cosine)
    inner = 2.0 * math.pi * float((half * weights * turned * b * b).sum())
    c = math.sqrt(math.pi) * math.gamma(0.5 * (power + 1.0)) / math.gamma(0.5 * power) * strength / energy
    last = math.exp(ends[-1])
    return inner + math.pi * order * c * c * last ** (2.0 - 2.0 * power) / (2.0 * power - 2.0)


@pytest.mark.parametrize("power", [1.001, 1.01, 1.05, 1.1, 1.2, 1.5])
@pytest.mark.parametrize("order", [1, 2])
def test_powers_against_their_leading_term(power: float, order: int) -> None:
    found = s.transport_cross_section(V.PowerLaw(1.0, power), energy=0.7, order=order)
    # At e⁻¹², where the sum by hand begins, all turn back: e⁻²⁴ of area; the tail's next term is e⁻⁴⁰ of it.
    assert found == pytest.approx(by_hand(V.PowerLaw(1.0, power), 0.7, power, 1.0, order), rel=3e-9, abs=0.0)


@pytest.mark.parametrize("power", [1.001, 1.01, 1.1, 1.5, 3.0])
def test_powers_have_no_energy_of_their_own(power: float) -> None:
    """Q goes as E^(−2/n) over any decades."""
    energies = np.array([1e-9, 1e-3, 1.0, 1e5])
    found = s.transport_cross_section(V.PowerLaw(1.0, power), energy=energies) * energies ** (2.0 / power)
    # Rounding of n − 1 in the tail: 1e-13 of it at 1.001.
    np.testing.assert_allclose(found, found[2], rtol=2e-9, atol=0.0)


def test_a_well_before_a_slow_power() -> None:
    n, m = 12.0, 1.05
    strength = -n / (n - m) * (n / m) ** (m / (n - m))
    found = s.transport_cross_section(V.Mie(1.0, 1.0, n, m), energy=10.0)
    assert found == pytest.approx(by_hand(V.Mie(1.0, 1.0, n, m), 10.0, m, strength, 1), rel=1e-8, abs=0.0)


@pytest.mark.parametrize("power", [1.02, 1.1, 1.5, 2.0, 3.0, 6.0])
@pytest.mark.parametrize("orders", [(1, 1), (2, 2), (1, 3)])
def test_means_of_powers_over_all_energies(power: float, orders: tuple[int, int]) -> None:
    """Q ∝ E^(−2/n), so that ∫ Q e^(−x) x^(s+1) dx is Q(T) Γ(s + 2 − 2/n): much of it at slow collisions."""
    order, s_ = orders
    found = s.collision_integral(V.PowerLaw(1.0, power), temperature=1.0, diameter=1.0, orders=orders)
    cross_section = s.transport_cross_section(V.PowerLaw(1.0, power), energy=1.0, order=order)
    sphere = math.pi * (1.0 - (1.0 + (-1.0) ** order) / (2.0 * (1.0 + order)))
    expected = cross_section / sphere * math.gamma(s_ + 2.0 - 2.0 / power) / math.factorial(s_ + 1)
    # The mean is to 1e-9, its cross sections to 3e-9.
    assert found == pytest.approx(expected, rel=1e-8, abs=0.0)


@pytest.mark.parametrize("temperature", [1e2, 1e4, 1e6])
def test_means_of_a_screened_charge_at_high_temperature(temperature: float) -> None:
    """Q grows nearly as 1/E² towards slow collisions: over ln E by Gauss and Legendre, down to 1e-14 T."""
    well = V.Yukawa(1.0, 1.0)
    x, weights = np.polynomial.legendre.leggauss(16)
    ends = np.linspace(-32.0, 4.2, 38)
    half = 0.5 * np.diff(ends)[:, None]
    logarithm = half * x + 0.5 * (ends[1:] + ends[:-1])[:, None]
    share = np.exp(logarithm)
    q = s.transport_cross_section(well, energy=temperature * share)
    expected = float((half * weights * q * share**3 * np.exp(-share)).sum()) / (2.0 * math.pi)
    found = s.collision_integral(well, temperature=temperature, diameter=1.0)
    assert found == pytest.approx(expected, rel=1e-7, abs=0.0)
