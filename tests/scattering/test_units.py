"""Cross sections of potentials without a length of their own, in units of any size.

Bounds: closed forms of a few operations of numbers of any size.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

import visviva as vv

s = vv.scattering
V = vv.potentials


def test_a_flyby_of_the_sun_in_si_units() -> None:
    """Rutherford's formulas with κ = GM/v²: 1.5e11 m, an impact parameter of which octaves about 1 m know nothing."""
    GM, v = 1.32712440018e20, 3e4
    energy, kappa = v * v / 2, GM / (v * v)
    sun = V.Coulomb(-GM)
    assert s.cross_section(sun, energy=energy, angle=1.0) == pytest.approx(
        (kappa / 2) ** 2 / np.sin(0.5) ** 4, rel=1e-14, abs=0
    )
    assert s.impact_parameter(sun, energy=energy, angle=1.0) == pytest.approx([kappa / np.tan(0.5)], rel=1e-14, abs=0)
    beyond = s.total_cross_section(sun, energy=energy, theta_min=1.0)
    assert beyond == pytest.approx(np.pi * (kappa / np.tan(0.5)) ** 2, rel=1e-14, abs=0)


@pytest.mark.parametrize("energy", [1e-10, 1e-100, 1e100])
def test_rutherford_at_any_energy(energy: float) -> None:
    found = s.cross_section(V.Coulomb(1.0), energy=energy, angle=1.0)
    # pytest's own absolute tolerance of 1e-12 would pass whatever is as small as at 1e100.
    assert found == pytest.approx((0.25 / energy) ** 2 / np.sin(0.5) ** 4, rel=1e-13, abs=0.0)


@pytest.mark.parametrize("length", [3e-10, 1e9, 1e12])
@pytest.mark.parametrize(("n", "sign"), [(2, 1), (3, 1), (4, 1), (6, 1), (2, -1), (3, -1), (4, -1), (6, -1)])
def test_power_laws_scale_with_their_length(n: int, sign: int, length: float) -> None:
    """k/rⁿ at energy E knows the length (k/E)^(1/n) only: cross sections go with its square."""
    angles = [0.1, 1.0]
    of_one = s.cross_section(V.PowerLaw(float(sign), float(n)), energy=1.0, angle=angles)
    found = s.cross_section(V.PowerLaw(sign * length**n, float(n)), energy=1.0, angle=angles)
    # kⁿ as it is rounded.
    assert found / length**2 == pytest.approx(of_one, rel=1e-12, abs=0)
    if sign > 0 and n != 2:
        transport = s.transport_cross_section(V.PowerLaw(length**n, float(n)), energy=1.0, order=1)
        of_one = s.transport_cross_section(V.PowerLaw(1.0, float(n)), energy=1.0, order=1)
        # Quadratures on the same points, scaled: measured 4.4e-16.
        assert transport / length**2 == pytest.approx(of_one, rel=1e-14, abs=0)


@pytest.mark.parametrize("theta", [1e-3, 0.1, 1.0, 3.0])
def test_all_turns_around_an_inverse_square_count(theta: float) -> None:
    """−C/r²: infinitely many branches ever nearer to the edge, of which float64 tells the last no longer apart.

    The sum of b/(sin θ |dψ/db|), b² = (C/E) q²/(q² − 1), q = 1 + |ψ|/π, to 25 digits by summing every turn.
    """
    C, E = 3.0, 0.7
    found = s.cross_section(V.PowerLaw(-C, 2.0), energy=E, angle=theta)
    with mp.workdps(25):

        def part(psi: mp.mpf) -> mp.mpf:
            q = 1 + psi / mp.pi
            return mp.mpf(C) / mp.mpf(E) * q / (mp.pi * (q * q - 1) ** 2)

        turns = mp.nsum(lambda n: part(2 * mp.pi * n + theta) + part(2 * mp.pi * (n + 1) - theta), [0, mp.inf])
        expected = float(turns / mp.sin(theta))
    assert found == pytest.approx(expected, rel=2e-15, abs=0)
    b = s.impact_parameter(V.PowerLaw(-C, 2.0), energy=E, angle=theta)
    assert (np.diff(b) > 0.0).all()
    assert b[0] == pytest.approx(np.sqrt(C / E), rel=1e-10, abs=0)
    folded = np.abs(
        (s.deflection_angle(V.PowerLaw(-C, 2.0), energy=E, impact_parameter=b[-100:]) + np.pi) % (2 * np.pi)
    )
    # ψ = 300 of a b that is rounded: ψ³/π² times 2⁻⁵³.
    np.testing.assert_allclose(np.abs(folded - np.pi), theta, rtol=0, atol=2e-9)


def test_a_hard_sphere_of_any_size() -> None:
    """dσ/dΩ = R²/4 in all directions."""
    for radius in (1e-15, 1.0, 1e12):
        found = s.cross_section(V.HardSphere(radius), energy=1.0, angle=[0.1, 1.0, 3.0])
        assert found == pytest.approx(radius**2 / 4, rel=1e-14, abs=0.0)
