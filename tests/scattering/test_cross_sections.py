"""Counts and cross sections against Rutherford's law, and where the disc of impact parameters ends."""

import sys
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import BEAM, TALLIES, half_distance, law, run


@pytest.mark.parametrize("masses", [(1.0, 4.0), (1.0, 1.0), (4.0, 1.0), (1.0, 1e12), (1e6, 1.0)])
def test_counts_follow_rutherfords_law(masses: tuple[float, float]) -> None:
    """P(|ψ| > ψ₀) = (b(ψ₀)/b_max)² in the center-of-mass frame, in 60 bins of equal probability.

    The seed is fixed; χ² of 59 degrees of freedom exceeds 116 once in 10⁵ seeds, and falls below 24 as rarely.
    """
    energy = 1.5 * masses[1] / (masses[0] + masses[1])
    potential = vv.potentials.Coulomb(2.0 * energy)  # κ = 1 whatever the masses
    share = np.linspace(0.0, 1.0, 61)
    angles = np.sort(vv.scattering.rutherford_angle(potential, energy=energy, impact_parameter=3.0 * np.sqrt(share)))
    n = 3_000_000
    result = vv.scattering.monte_carlo(
        potential, beam_energy=1.5, masses=masses, b_max=3.0, n_events=n, seed=3, tally={"cm_angle": angles}
    )
    tally = result["cm_angle"]
    # At most the head-on edge and the smallest angle can lose an event to rounding.
    assert tally.underflow + tally.overflow <= 1
    chi2 = ((tally.values() - n / 60) ** 2 / (n / 60)).sum()
    assert 24.0 < chi2 < 116.0


def test_laboratory_cross_section_has_both_branches() -> None:
    """Heavy on light: counts per solid angle against the closed form at the middle of narrow bins."""
    potential, n = vv.potentials.Coulomb(2.0), 20_000_000
    edges = np.linspace(0.15, 0.35, 41)
    tally = vv.scattering.monte_carlo(
        potential, beam_energy=3.0, masses=(2.0, 1.0), b_max=10.0, n_events=n, seed=5, tally={"lab_angle": edges}
    )["lab_angle"]
    value, error = tally.cross_section()
    # Simpson's rule over each bin, weighted with sin θ: its error is far below the counts'.
    points = np.stack([edges[:-1], (edges[:-1] + edges[1:]) / 2.0, edges[1:]])
    density = np.sin(points) * vv.scattering.rutherford_cross_section(
        potential, energy=1.0, angle=points, frame="lab", mass_ratio=2.0
    )
    law = (density * np.array([[1.0], [4.0], [1.0]])).sum(0) / 6.0 * np.diff(edges) / -np.diff(np.cos(edges))
    pulls = (value - law) / error
    # 40 degrees of freedom, as above: 1e-5 on either side.
    assert 12.0 < (pulls**2).sum() < 90.0


def test_a_known_fraction_passes_ninety_degrees() -> None:
    n = 10_000_000
    tally = run(n_events=n, tally={"cm_angle": [0.0, np.pi / 2.0, np.pi]})["cm_angle"]
    expected = (half_distance() / BEAM["b_max"]) ** 2
    sigma = np.sqrt(n * expected * (1.0 - expected))
    assert abs(tally.values()[1] - n * expected) < 4.0 * sigma


@pytest.mark.parametrize("masses", [(1.0, 4.0), (1.0, 1.0), (1.0, 1e3)])
@pytest.mark.parametrize("name", TALLIES)
def test_cross_sections_of_cut_bins_are_those_of_their_reachable_part(name: str, masses: tuple[float, float]) -> None:
    """Every bin that is reached agrees with Rutherford's law over what is reached of it, within five standard
    deviations of its count (one in 10⁶ of some 150 bins here; the seed is fixed); bins beyond are NaN."""
    energy = 1.5
    kappa = 2.0 / (2.0 * energy * masses[1] / sum(masses))
    result = run(masses=masses, b_max=6.0 * kappa, n_events=400_000, tally={name: 24})
    tally = result[name]
    value, error = tally.cross_section()
    low, high = tally.covered
    inside = np.clip(tally.edges, low, high)
    measure = -2.0 * np.pi * np.diff(np.cos(inside)) if name.endswith("angle") else np.diff(inside)
    reached = tally.reachable > 0.0
    expected = law(inside, name, masses, kappa, energy)
    assert np.isnan(value[~reached]).all()
    assert (tally.counts[~reached] == 0).all()
    wanted = expected[reached] / measure[reached]
    # Where nothing is scattered to, nothing is counted and both are 0; a count of 0 has no error of its own.
    least = np.pi * tally.b_max**2 / tally.n_events / measure[reached]
    assert (np.abs(value[reached] - wanted) <= 5.0 * np.maximum(error[reached], least) + 1e-9 * wanted).all()
    cut = (tally.reachable > 0.0) & (tally.reachable < 1.0 - 1e-9)
    assert cut.sum() <= 1
    if name == "cm_angle":
        assert low == result.smallest_angle == pytest.approx(2.0 * np.arctan(1.0 / 6.0), rel=1e-15, abs=0)


def test_the_bin_that_the_disc_cuts_is_not_biased() -> None:
    """Degrees 0 to 25 in steps of 5, the smallest deflection at 12.05°: it was 0.44 of the law in the cut bin."""
    kappa = 200.0 * np.tan(np.radians(12.05) / 2.0)
    result = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(2.0 * kappa), beam_energy=1.0, masses=(1.0, 1e300), b_max=200.0, n_events=1_000_000,
        seed=4, tally={"cm_angle": np.radians([0.0, 5.0, 10.0, 15.0, 20.0, 25.0])},
    )  # fmt: skip
    tally = result["cm_angle"]
    assert np.degrees(result.smallest_angle) == pytest.approx(12.05, rel=1e-14, abs=0)
    assert tally.reachable[[0, 1]].tolist() == [0.0, 0.0]
    assert 0.5 < tally.reachable[2] < 0.7
    assert tally.reachable[[3, 4]].tolist() == [1.0, 1.0]
    value, error = tally.cross_section()
    assert np.isnan(value[:2]).all()
    edges = np.maximum(tally.edges, result.smallest_angle)[2:]
    wanted = law(edges, "cm_angle", (1.0, 1e300), kappa, 1.0) / (-2.0 * np.pi * np.diff(np.cos(edges)))
    assert (np.abs(value[2:] - wanted) < 5.0 * error[2:]).all()


def test_heavy_projectiles_are_known_where_both_branches_are() -> None:
    beam = {"masses": (2.0, 1.0), "beam_energy": 3.0, "seed": 5, "n_events": 1_000_000}
    potential = vv.potentials.Coulomb(2.0)  # κ = 1
    edges = np.linspace(0.0, 0.6, 31)
    tally = vv.scattering.monte_carlo(potential, b_max=10.0, tally={"lab_angle": edges}, **beam)["lab_angle"]
    least = float(vv.scattering.lab_angle(2.0 * np.arctan(0.1), mass_ratio=2.0))
    assert tally.covered[0] == pytest.approx(least, rel=1e-14, abs=0)
    value, _ = tally.cross_section()
    known = edges[:-1] >= least
    assert (np.isnan(value) == ~known).all()
    assert ((tally.reachable == 1.0) == known).all()
    # Beyond asin(m₂/m₁) = 30° nothing goes: known, and zero.
    assert (value[edges[:-1] > np.pi / 6.0] == 0.0).all()
    # A disc that ends before the greatest angle's impact parameter sees one branch only.
    narrow = vv.scattering.monte_carlo(potential, b_max=0.3, tally={"lab_angle": edges}, **beam)["lab_angle"]
    assert narrow.covered[0] == pytest.approx(np.pi / 6.0, rel=1e-14, abs=0)
    assert np.isnan(narrow.cross_section().value[edges[1:] <= np.pi / 6.0]).all()
    assert narrow.counts.sum() == 1_000_000


def test_what_is_captured_too_seldom_to_count_refuses_no_mean() -> None:
    """Of an exp-6 potential what is faster than its barrier falls into the center: 1e-15 of collisions at T = 10."""
    potential = vv.potentials.Buckingham(1e5, 12.0, 2.0)
    for temperature in (9.0, 10.0):
        found = float(vv.scattering.collision_integral(potential, temperature=temperature, diameter=1.0))
        # On from 0.46489412 at T = 8, where it falls as the power −0.2987 of T.
        assert found == pytest.approx(0.46489412 * (temperature / 8.0) ** -0.2987, rel=5e-3, abs=0.0)


@pytest.mark.parametrize(
    "potential",
    [vv.potentials.LennardJones(1.3, 0.8), vv.potentials.PowerLaw(1.0, 6.0), vv.potentials.ScreenedCoulomb(2.0, 0.5)],
    ids=["well", "power", "screened"],
)
def test_temperatures_share_cross_sections_and_change_nothing(potential: vv.potentials.Potential) -> None:
    """Each has the bits that it has alone, in any order, by any threads."""
    ask, how = vv.scattering.collision_integral, {"orders": (2, 2), "diameter": 0.7}
    alone = [ask(potential, temperature=t, threads=n, **how) for t, n in ((3.0, 1), (0.9, 3))]
    np.testing.assert_array_equal(ask(potential, temperature=[3.0, 0.9, 3.0], **how), [*alone, alone[0]])
    np.testing.assert_array_equal(ask(potential, temperature=[0.9, 3.0], **how), alone[::-1])
