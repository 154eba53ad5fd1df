"""Kinematics and Rutherford's formulas against the catalogue and against numbers computed elsewhere.

Bounds: closed forms of ten operations, a few roundings.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import visviva as vv

GOLDEN = json.loads((Path(__file__).parents[1] / "reference" / "golden.json").read_text(encoding="utf-8"))
CASES = {case["id"]: case for case in GOLDEN}
s = vv.scattering

# Alpha particles on gold, nuclear masses in u, energies in MeV, lengths in fm.
ALPHA, GOLD = 4.001506179, 196.923232301
K = 2 * 79 * 1.43996454844
TARGET = vv.potentials.Coulomb(K)


def relative(beam_energy: float) -> float:
    return beam_energy * GOLD / (ALPHA + GOLD)


@pytest.mark.parametrize("name", ["G8.49-rutherford", "G8.49-rutherford-attractive"])
def test_golden_rutherford(name: str) -> None:
    given, expected = CASES[name]["inputs"], CASES[name]["outputs"]
    potential = vv.potentials.Coulomb(given["k"])
    angle = s.rutherford_angle(potential, energy=given["E"], impact_parameter=given["b"])
    # A few roundings in each formula: measured at most 4e-16.
    assert angle == pytest.approx(expected.get("psi", expected.get("deflection")), rel=1e-15, abs=0)
    closest = s.rutherford_closest_approach(potential, energy=given["E"], impact_parameter=given["b"])
    assert closest == pytest.approx(expected["r_min"], rel=1e-15, abs=0)
    sigma = s.rutherford_cross_section(potential, energy=given["E"], angle=abs(angle))
    assert sigma == pytest.approx(expected["sigma"], rel=2e-15, abs=0)


def test_golden_geiger_marsden() -> None:
    given, expected = CASES["G8.49-geiger-marsden"]["inputs"], CASES["G8.49-geiger-marsden"]["outputs"]
    potential = vv.potentials.Coulomb(expected["k"])
    keywords = {"energy": expected["E_cm_J"], "angle": given["psi"]}
    b = s.rutherford_impact_parameter(potential, **keywords)
    # In SI units all is small, and pytest's own absolute tolerance of 1e-12 would pass anything.
    assert b == pytest.approx(expected["b"], rel=2e-15, abs=0.0)
    sigma = s.rutherford_cross_section(potential, **keywords)
    assert sigma == pytest.approx(expected["sigma_m2_per_sr"], rel=2e-15, abs=0.0)
    assert given["nt"] * np.pi * b**2 == pytest.approx(expected["fraction_back"], rel=1e-14, abs=0)


def test_golden_equal_masses_in_the_laboratory() -> None:
    given = CASES["G8.44-rutherford-equal-mass-lab"]["inputs"]
    expected = CASES["G8.44-rutherford-equal-mass-lab"]["outputs"]
    potential, energy = vv.potentials.Coulomb(2.0 * given["kappa"]), 1.0
    lab = s.rutherford_cross_section(potential, energy=energy, angle=given["theta1"], frame="lab", mass_ratio=1.0)
    recoil = s.rutherford_cross_section(potential, energy=energy, angle=given["theta2"], frame="recoil")
    assert lab == pytest.approx(expected["sigma_lab_projectile"], rel=2e-15, abs=0)
    assert recoil == pytest.approx(expected["sigma_lab_recoil"], rel=2e-15, abs=0)


@pytest.mark.parametrize(
    ("beam_energy", "closest", "fixed", "backward", "fraction"),
    [(7.687, 30.198715, 29.597294, 7.162536, 1.690358e-5), (5.486, 42.314532, 41.471819, 14.062708, 3.318799e-5)],
)
def test_alpha_particles_on_gold(
    beam_energy: float, closest: float, fixed: float, backward: float, fraction: float
) -> None:
    """Half of the last printed digit is the tolerance: 7 to 8 digits."""
    energy = relative(beam_energy)
    assert s.rutherford_closest_approach(TARGET, energy=energy, impact_parameter=0.0) == pytest.approx(
        closest, abs=5.1e-7
    )
    assert s.rutherford_closest_approach(TARGET, energy=beam_energy, impact_parameter=0.0) == pytest.approx(
        fixed, abs=5.1e-7
    )
    barns = np.pi * s.rutherford_impact_parameter(TARGET, energy=energy, angle=np.pi / 2) ** 2 / 100.0
    assert barns == pytest.approx(backward, abs=5.1e-7)
    # 0.4 µm of gold with 5.9e22 atoms per cm³, 1 b = 1e-24 cm².
    assert barns * 1e-24 * 5.9e22 * 0.4e-4 == pytest.approx(fraction, rel=4e-7, abs=0)


def test_laboratory_cross_sections_of_gold() -> None:
    lab = np.radians([15.0, 30.0, 60.0, 90.0, 120.0, 150.0])
    barns = (
        s.rutherford_cross_section(TARGET, energy=relative(7.687), angle=lab, frame="lab", mass_ratio=ALPHA / GOLD)
        / 100.0
    )
    # Seven printed digits.
    assert barns == pytest.approx([1886.224, 122.0106, 8.759546, 2.189547, 0.9728810, 0.6284875], rel=3e-7)
    first, second = s.cm_angle(lab, mass_ratio=ALPHA / GOLD)
    degrees = [15.301333, 30.582139, 61.008329, 91.164338, 121.008329, 150.582139]
    # Six printed decimals, and below seven: half a unit of the last.
    assert np.degrees(first) == pytest.approx(degrees, abs=5.1e-7)
    assert np.isnan(second).all()
    assert 1.0 - s.energy_transfer(np.pi, mass_ratio=ALPHA / GOLD) == pytest.approx(0.9219247, abs=5.1e-8)


def test_heavy_on_light_has_two_branches() -> None:
    first, second = s.cm_angle(np.radians(20.0), mass_ratio=2.0)
    # Printed to 15 digits.
    assert np.degrees([first, second]) == pytest.approx([63.1601777998183, 156.839822200182], rel=2e-14)
    kept = 1.0 - s.energy_transfer(np.array([first, second]), mass_ratio=2.0)
    assert kept == pytest.approx([0.756221246368, 0.146929369738], abs=5.1e-13)
    assert np.isnan(s.cm_angle(np.radians(30.1), mass_ratio=2.0)).all()
    # asin(m₂/m₁), where the angle is stationary.
    largest = s.lab_angle(np.linspace(0.0, np.pi, 100_001), mass_ratio=2.0).max()
    assert largest == pytest.approx(np.pi / 6.0, rel=1e-9, abs=0)


@given(st.floats(1e-3, 1e3), st.floats(0.0, np.pi))
def test_a_projectile_comes_from_the_angle_it_went_to(ratio: float, angle: float) -> None:
    lab = s.lab_angle(angle, mass_ratio=ratio)
    back = np.array(s.cm_angle(lab, mass_ratio=ratio))
    # The angle is stationary at the greatest laboratory angle: an error e there means √e here.
    assert np.nanmin(np.abs(back - angle), initial=np.inf) < 2e-7 or lab >= np.arcsin(min(1.0, 1.0 / ratio)) - 1e-15


@given(st.floats(1e-6, 1e6), st.floats(0.0, np.pi))
def test_momentum_along_and_across_the_beam(ratio: float, angle: float) -> None:
    """m₁√E₁ sin θ₁ = m₂√E₂ sin θ₂ and the same along the beam, in units of the beam's momentum."""
    taken = s.energy_transfer(angle, mass_ratio=ratio)
    mine, theirs = np.sqrt(max(0.0, 1.0 - taken)), np.sqrt(taken / ratio)
    here, there = s.lab_angle(angle, mass_ratio=ratio), s.recoil_angle(angle)
    # 1 − T costs half the digits of √(1 − T) where T → 1: equal masses head-on.
    slack = 4e-16 / max(mine, 1e-8) + 1e-15
    assert abs(mine * np.sin(here) - theirs * np.sin(there)) < slack * (1.0 + theirs)
    assert abs(mine * np.cos(here) + theirs * np.cos(there) - 1.0) < slack * (1.0 + theirs)


@pytest.mark.parametrize(
    ("argument", "call"),
    [
        ("cm_angle", lambda: s.lab_angle(-0.1, mass_ratio=1.0)),
        ("cm_angle", lambda: s.recoil_angle([0.0, 4.0])),
        ("mass_ratio", lambda: s.lab_angle(0.1, mass_ratio=0.0)),
        ("lab_angle", lambda: s.cm_angle(np.nan, mass_ratio=1.0)),
        ("energy", lambda: s.rutherford_angle(TARGET, energy=0.0, impact_parameter=1.0)),
        ("impact_parameter", lambda: s.rutherford_angle(TARGET, energy=1.0, impact_parameter=-1.0)),
        ("potential", lambda: s.rutherford_angle(None, energy=1.0, impact_parameter=1.0)),
        ("frame", lambda: s.rutherford_cross_section(TARGET, energy=1.0, angle=1.0, frame="zm")),
        ("mass_ratio", lambda: s.rutherford_cross_section(TARGET, energy=1.0, angle=1.0, frame="lab")),
        ("angle", lambda: s.rutherford_cross_section(TARGET, energy=1.0, angle=2.0, frame="recoil")),
    ],
)
def test_refusals(argument: str, call: object) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        call()  # type: ignore[operator]
    assert caught.value.argument == argument


def test_geiger_and_marsden() -> None:
    data = vv.datasets.geiger_marsden_1913()
    exact = 1.0 / np.sin(np.radians(data.angle) / 2.0) ** 4
    # The paper prints 1/sin⁴ rounded, in places by a few units of its fourth digit.
    assert data.inverse_sin4 == pytest.approx(exact, rel=1.5e-3, abs=0)
    products = {"silver": (18.6, 30.6), "gold": (27.5, 39.5)}
    for comparison in data.compare():
        counts = getattr(data, comparison.metal)
        low, high = products[comparison.metal]
        # The printed products N·sin⁴(φ/2) differ by up to 0.2 from those of unrounded sines.
        assert (counts / exact).min() == pytest.approx(low, abs=0.2)
        assert (counts / exact).max() == pytest.approx(high, abs=0.2)
        assert np.log(comparison.ratio).sum() == pytest.approx(0.0, abs=1e-14)
        assert comparison.ratio.max() / comparison.ratio.min() < 1.7
        assert comparison.metal in str(comparison)
    with pytest.raises(ValueError, match="read-only"):
        data.gold[0] = 0.0
