"""Energies that just reach the top of a hill at the center, which one can pass: what turns there within impact
parameters that no octave of the potential's length comes near.

References: what is left on the top, E = V(0)(1 + d), is the only energy there, so that all within scales as a power of
d, and cross sections of what passes by go on through d = 0 as through any energy.
"""

import numpy as np
import pytest
import sympy as sp

import visviva as vv

S, P = vv.scattering, vv.potentials
R = sp.Symbol("r", positive=True)
CONES = {
    "soft sphere 4": P.SoftSphere(1.0, 1.0, 4.0),
    "soft sphere 2.5": P.SoftSphere(1.0, 1.0, 2.5),
    "soft sphere 12": P.SoftSphere(1.0, 1.0, 12.0),
    "exponential": P.Custom(sp.exp(-R)),
}
ROUND = {"Gaussian": P.Custom(sp.exp(-(R**2))), "Plummer": P.Plummer(1.0, 1.0)}
HILLS = CONES | ROUND
#: Of 1e-9 and below cross sections were 0, of 0 rainbows many.
LEFT = [1e-9, 1e-10, 1e-12, 1e-15, 2.0**-52, 0.0, -(2.0**-53), -1e-12]


@pytest.mark.parametrize("left", LEFT)
@pytest.mark.parametrize("hill", HILLS.values(), ids=HILLS)
def test_cross_sections_go_on_through_the_top(hill: P.Potential, left: float) -> None:
    """Of outer branches; what passes over the top adds areas of d³ at most, from the mean of both sides.

    Between energies 2e-5 apart their curvature is 1e-9 of them.
    """

    def beside(of: object) -> float:
        return 0.5 * (of(1.0 + 1e-5) + of(1.0 - 1e-5))  # type: ignore[operator]

    def differential(energy: float) -> float:
        return float(S.cross_section(hill, energy=energy, angle=0.3))

    def total(energy: float) -> float:
        return S.total_cross_section(hill, energy=energy, theta_min=0.1)

    assert differential(1.0 + left) == pytest.approx(beside(differential), rel=2e-8 + 10.0 * abs(left), abs=0.0)
    assert total(1.0 + left) == pytest.approx(beside(total), rel=2e-8 + 10.0 * abs(left), abs=0.0)


@pytest.mark.parametrize("hill", HILLS.values(), ids=HILLS)
def test_a_top_that_is_just_passed_has_one_rainbow(hill: P.Potential) -> None:
    for left in (1e-4, 1e-8, 1e-10, 1e-12):
        assert len(S.rainbows(hill, energy=1.0 + left)) == 1
        branches = S.impact_parameter(hill, energy=1.0 + left, angle=0.3)
        assert branches.shape == (2,)
        # Where the angle is told to be that, by what rounding of V leaves of E - V(0): 2e-16 of 1e-12, some times.
        angles = S.deflection_angle(hill, energy=1.0 + left, impact_parameter=branches)
        assert angles == pytest.approx([0.3, 0.3], rel=1e-12 + 1e-15 / left, abs=0.0)


@pytest.mark.parametrize("hill", HILLS.values(), ids=HILLS)
def test_what_passes_over_the_top_scales_with_what_is_left(hill: P.Potential) -> None:
    """V = V(0)(1 - c rⁿ): lengths as d^(1/n), speeds as d^(1/2), so that b goes as their product."""
    power = 1.5 if any(hill is cone for cone in CONES.values()) else 1.0
    far, near = (S.impact_parameter(hill, energy=1.0 + left, angle=0.3)[0] for left in (1e-8, 1e-10))
    # The next power of r is 1e-8 or, of a round top, 1e-4 squared of the first; of V, a dozen factors each rounded by
    # 2e-16, 3e-5 of d = 1e-10 are left, measured 8e-5 of b.
    assert far / near == pytest.approx(100.0**power, rel=3e-4, abs=0.0)


@pytest.mark.parametrize("hill", CONES.values(), ids=CONES)
def test_the_rainbow_of_a_cone_scales_with_what_is_left(hill: P.Potential) -> None:
    """What the top takes from ψ goes as d/r, the next term of V as r: they are equal at r as d^(1/2), b as r^(3/2)."""
    far, near = (S.rainbows(hill, energy=1.0 + left)[0].impact_parameter for left in (1e-8, 1e-10))
    # A maximum that is flat, of samples off by 1e-11: it is where they tell to some per cent.
    assert far / near == pytest.approx(100.0**0.75, rel=0.03, abs=0.0)


@pytest.mark.parametrize("hill", HILLS.values(), ids=HILLS)
def test_at_the_top_angles_fall_from_a_limit(hill: P.Potential) -> None:
    """ψ → π/3 of a cone, π/2 of a round top: no rainbow, and nothing goes farther."""
    assert S.rainbows(hill, energy=1.0) == ()
    assert S.glories(hill, energy=1.0) == ()
    limit = np.pi / (3.0 if any(hill is cone for cone in CONES.values()) else 2.0)
    # Within an impact parameter of 1e-12 rounding of V may turn them by more than that: an area of some 1e-24.
    within, beyond, more = S.cross_section(hill, energy=1.0, angle=[0.9 * limit, 1.01 * limit, 2.0])
    assert within > 0.0
    assert beyond == pytest.approx(0.0, abs=1e-20)
    assert more == 0.0
    assert S.impact_parameter(hill, energy=1.0, angle=0.9 * limit).shape == (1,)


def test_head_on_over_a_round_top() -> None:
    """Over V = 1 - r² the way is a hyperbola, r_p cosh ωt + (v₀/ω) sinh ωt with ω² = 2, v₀² = 2d and r_p v₀ = b √2:

    ψ = 2 atan(ω r_p/v₀) = 2b/d.
    """
    gauss = HILLS["Gaussian"]
    for left in (1e-7, 1e-8, 1e-10):
        slope = float(S.deflect(gauss, energy=1.0 + left, impact_parameter=0.0).derivative)
        assert slope == pytest.approx(2.0 / left, rel=3.0 * left + 1e-15 / left, abs=0.0)
