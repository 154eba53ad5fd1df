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
