"""What impact parameters beyond the disc lead to: a bin is told as known only where none of them does.

A rainbow or orbits beyond the disc, too narrow for a coarse look, were missed: cross sections were too small by half.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import _core
from visviva.scattering._beyond import beyond, less_what_is_beyond

p = vv.potentials
ARGON = p.LennardJones(1.0, 1.0)
MASSES = (1.0, 4.0)
PAIR = ("cm_angle", "recoil_energy")
#: Midpoints of impact parameters up to 6, where ψ is 1e-3 at 0.25 and less at more.
B, STEP = (np.arange(200_000) + 0.5) * 3e-5, 3e-5


def run(energy: Any, b_max: float, tally: Any, **other: Any) -> vv.scattering.MonteCarlo:
    asked = {"potential": ARGON, "beam_energy": energy, "masses": MASSES, "n_events": 100_000, "seed": 1} | other
    return vv.scattering.monte_carlo(b_max=b_max, tally=tally, **asked)


def folded(energy: float) -> np.ndarray:
    """|ψ| in [0, π] at all impact parameters."""
    psi = vv.scattering.deflection_angle(ARGON, energy=0.8 * energy, impact_parameter=B)
    return np.abs((psi + np.pi) % (2.0 * np.pi) - np.pi)


def of_angle(name: str, angle: np.ndarray, energy: float) -> np.ndarray:
    """A quantity of elastic collisions of masses 1 and 4 by the angle in the center-of-mass frame."""
    lost = 16.0 / 25.0 * np.sin(0.5 * angle) ** 2
    return {
        "cm_angle": angle,
        "lab_angle": np.arctan2(np.sin(angle), np.cos(angle) + 0.25),
        "recoil_angle": 0.5 * (np.pi - angle),
        "energy": energy * (1.0 - lost),
        "recoil_energy": energy * lost,
    }[name]


QUANTITIES = ("cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy")


@pytest.mark.parametrize(
    ("energy", "inside", "outside"),
    # At 1.0 projectiles circle at b = 1.75, at 0.25 at 2.2; at 1.05 the rainbow of 1.73 is beyond π; at 3.0 that of
    # 1.42 is 0.92, so that what turns by more is known by a smaller disc, too.
    [(1.0, 1.0, 2.0), (0.25, 1.0, 3.0), (0.9, 0.5, 1.9), (1.05, 1.0, 1.9), (3.0, 1.0, 1.6)],
)
def test_bins_that_are_told_are_those_of_all_impact_parameters(energy: float, inside: float, outside: float) -> None:
    angles = folded(energy)
    for b_max, rainbow_is_beyond in ((inside, True), (outside, False)):
        result = run(energy, b_max, dict.fromkeys(QUANTITIES, 8) | {PAIR: (8, 8)})
        known = {}
        for name in QUANTITIES:
            tally = result[name]
            area = np.histogram(of_angle(name, angles, energy), bins=tally.edges, weights=2.0 * np.pi * B * STEP)[0]
            value, error = tally.cross_section()
            known[name] = np.isfinite(value)
            assert (known[name] == (tally.reachable == 1.0)).all()
            # Five standard deviations of some 200 bins, one in 10⁴; the quadrature is known to a few steps at edges.
            off = np.abs(value * tally._measure() - area)
            assert (off <= 5.0 * error * tally._measure() + 1e-3 * area)[known[name]].all()
            # Where nothing is scattered to at all, no energy below E (m₂ − m₁)²/(m₁ + m₂)², the disc knows that.
            assert known[name][area > 0.0].any() == (not rainbow_is_beyond or energy == 3.0)
        joint = result[PAIR]
        value, error = joint.cross_section()
        pairs = [of_angle(name, angles, energy) for name in PAIR]
        area = np.histogram2d(*pairs, bins=joint.edges, weights=2.0 * np.pi * B * STEP)[0]
        told = np.isfinite(value)
        assert (told == (known[PAIR[0]][:, None] | known[PAIR[1]])).all()
        size = result[PAIR[0]]._measure()[:, None] * result[PAIR[1]]._measure()
        assert (np.abs(value * size - area) <= 5.0 * error * size + 1e-3 * area)[told].all()


def test_the_smallest_angle_is_that_of_the_rainbow_beyond() -> None:
    """Of ψ(b) at its minimum, which is looked for here on a grid of 1e-5: known to 1e-9 of ψ."""
    b = np.linspace(1.3, 1.5, 20_001)
    greatest = np.abs(vv.scattering.deflection_angle(ARGON, energy=2.4, impact_parameter=b)).max()
    ((energy, found),) = beyond(run(3.0, 1.0, "cm_angle").beam).items()
    assert energy == 3.0
    assert found == pytest.approx(greatest, rel=3e-9, abs=0.0)
    # On a grid of 1e-8 about it ψ is known to 1e-14, and what is told is 1e-9 more, lest it be less.
    least = b[np.abs(vv.scattering.deflection_angle(ARGON, energy=2.4, impact_parameter=b)).argmax()]
    near = np.linspace(least - 1e-5, least + 1e-5, 2001)
    exact = np.abs(vv.scattering.deflection_angle(ARGON, energy=2.4, impact_parameter=near)).max()
    assert found / exact - 1.0 == pytest.approx(1e-9, rel=0.01, abs=0.0)
    # What turns by more is known by the disc, but for a cell of its table: a twentieth of the angle.
    low, high = run(3.0, 1.2, "cm_angle", n_events=10)["cm_angle"].covered
    assert (greatest <= low <= 1.05 * greatest, high) == (True, np.pi)
    # Twenty radii of the disc out, too.
    for b_max in (1.0, 0.1):
        circling = run(1.0, b_max, "cm_angle")
        assert circling.smallest_angle == np.pi
        assert beyond(circling.beam) == {1.0: np.pi}
        assert circling["cm_angle"].covered == (0.0, 0.0)


@pytest.mark.parametrize(
    ("potential", "b_max"),
    [
        (p.Coulomb(1.0), 1.0),
        (p.Coulomb(-1.0), 1.0),
        (p.Yukawa(1.0, 1.0), 0.7),
        (p.ScreenedCoulomb(1.0, 1.0, "zbl"), 2.0),
        (p.HardSphere(1.0), 0.5),
        (p.HardSphere(1.0), 1.0),
        (ARGON, 3.0),
    ],
)
def test_where_angles_fall_beyond_the_disc_nothing_changes(potential: Any, b_max: float) -> None:
    result = run(1.0, b_max, QUANTITIES, potential=potential, n_events=10)
    assert beyond(result.beam) == {}
    from visviva.scattering._beam import described

    asked = [[(tally.name, tally.edges)] for tally in result.tallies]
    told = _core.monte_carlo(
        beam=described(result.beam), n_events=1, seed=0, first_event=0, tallies=asked, threads=1, progress=None
    )[4]
    for tally, (reachable, covered) in zip(result.tallies, (column[4] for column in told), strict=True):
        assert tally.reachable.tobytes() == reachable.tobytes()
        assert tally.covered == covered


def test_a_disc_whose_edge_turns_back_and_farther_hides_none_beyond_it() -> None:
    """ψ at the edge is below −π, as it is on both sides of what circles, beyond it."""
    b = np.linspace(1.6, 1.8, 20_001)
    psi = vv.scattering.deflection_angle(ARGON, energy=0.8, impact_parameter=b)
    edge = b[np.argmax(psi < -1.1 * np.pi)]
    assert psi[np.argmax(b > edge) :].min() < -2.0 * np.pi
    assert beyond(run(1.0, float(edge), "cm_angle", n_events=10).beam) == {}


def test_of_several_energies_what_one_hides_is_not_told() -> None:
    """A rainbow of the second energy, orbits of the first, a disc that ends between and beyond both."""
    lines = vv.scattering.Spectrum([1.0, 3.0], [0.5, 0.5])
    inside, outside = (run(lines, b_max, "cm_angle", bins=8)["cm_angle"] for b_max in (1.0, 2.0))
    assert (inside.reachable == 0.0).all()
    assert outside.reachable.tolist() == [0.0, *[1.0] * 7]
    area = sum(
        0.5 * np.histogram(folded(energy), bins=outside.edges, weights=2.0 * np.pi * B * STEP)[0]
        for energy in lines.energy
    )
    value, error = outside.cross_section()
    # Five standard deviations of seven bins.
    assert (np.abs(value - area / outside._measure()) <= 5.0 * error)[1:].all()


def test_of_a_spread_of_energies_the_greatest_rainbow_is_that_of_the_slowest() -> None:
    # Uniform: the ends are energies of events. ψ of a rainbow grows as the energy falls.
    spread = vv.scattering.Spread.uniform(0.1)
    result = run(3.0, 1.0, ["cm_angle", "recoil_energy"], energy_spread=spread, n_events=1000, bins=64)
    ((_, found),) = beyond(result.beam).items()
    b = np.linspace(1.3, 1.6, 20_001)
    greatest = np.abs(vv.scattering.deflection_angle(ARGON, energy=0.8 * 2.9, impact_parameter=b)).max()
    assert found == pytest.approx(greatest, rel=3e-9, abs=0.0)
    for tally in result.tallies:
        least = greatest if tally.name == "cm_angle" else of_angle("recoil_energy", greatest, 3.1)
        assert (tally.reachable[tally.edges[:-1] < least] == 0.0).all()
        assert tally.reachable[-1] == 1.0


def test_of_a_gaussian_the_slowest_is_six_deviations_down() -> None:
    result = run(3.0, 1.2, "cm_angle", energy_spread=0.05, n_events=1000, bins=64)
    ((_, found),) = beyond(result.beam).items()
    b = np.linspace(1.3, 1.6, 20_001)
    greatest = np.abs(vv.scattering.deflection_angle(ARGON, energy=0.8 * 2.7, impact_parameter=b)).max()
    assert found == pytest.approx(greatest, rel=3e-9, abs=0.0)
    # What all energies of the beam know is what the slowest does, but for a cell of a table: a twentieth of the angle.
    low, high = result["cm_angle"].covered
    assert (greatest <= low <= 1.05 * greatest, high) == (True, np.pi)


@pytest.mark.parametrize("masses", [(1.0, 4.0), (3.0, 2.0)])
@pytest.mark.parametrize("b_max", [0.8, 1.2])
@pytest.mark.parametrize(
    ("spread", "reach"),
    # A Gaussian ends at six standard deviations.
    [(None, 0.0), (vv.scattering.Spread.uniform(0.1), 0.1), (vv.scattering.Spread.gaussian(0.05), 0.3)],
)
def test_what_an_angle_hides_is_all_up_to_it(
    masses: tuple[float, float], b_max: float, spread: Any, reach: float
) -> None:
    """Up to an angle χ nothing is known, nor up to a recoil of Λ E sin²(χ/2), of the greatest of the energies E."""
    energy, names = 3.0, ("cm_angle", "recoil_energy")
    result = run(energy, b_max, names, masses=masses, energy_spread=spread, n_events=10, bins=64)
    axes = [(name, result[name].edges) for name in names]
    for angle in (0.5, 1.5):
        recoil = 4.0 * masses[0] * masses[1] / sum(masses) ** 2 * (energy + reach) * np.sin(0.5 * angle) ** 2

        def left(low: float, high: float, angle: float = angle) -> Any:
            told = [(np.full(64, 0.25), (low, high)) for _ in names]
            return less_what_is_beyond(result.beam, axes, told, {energy: angle})

        ends = ((angle, np.pi), (recoil, energy + reach))
        for (parts, (low, high)), (_, edges), (least, most) in zip(left(0.0, 100.0), axes, ends, strict=True):
            # A tangent, its inverse, and some products.
            assert low == pytest.approx(least, rel=2e-15, abs=0.0)
            assert high == pytest.approx(most, rel=2e-15, abs=0.0)
            # Where both know something, of the disc what there was.
            assert parts.tolist() == np.where(edges[:-1] >= least, 0.25, 0.0).tolist()
        lows = [reached[1][0] for reached in left(0.0, 100.0)]
        # What was known less far, or not so low, stays that; and what then is nothing is told as that.
        assert [reached[1] for reached in left(2.0, 2.5)] == [(2.0, 2.5)] * 2
        assert [reached[1] for reached in left(0.0, min(lows))] == [(0.0, 0.0)] * 2


def test_of_a_spread_that_has_no_tables_orbits_beyond_the_disc_are_known() -> None:
    """Every energy of this one orbits, beyond b = 1.9: by direct quadrature, and to any angle."""
    atom = vv.potentials.LennardJones(1.0, 1.0)
    of: dict[str, Any] = {"beam_energy": 0.5, "masses": (1.0, 1e6), "b_max": 1.9, "n_events": 100, "seed": 1}
    beam = vv.scattering.monte_carlo(atom, energy_spread=0.02, **of).beam
    assert beam.tables == ()
    assert beyond(beam) == {0.5: np.pi}


def test_what_earlier_versions_counted_goes_on() -> None:
    """The smallest angle follows from the rest of a beam: one that was told otherwise is no other beam."""
    from dataclasses import replace

    one = run(1.0, 1.0, "cm_angle", n_events=100)
    assert one.beam == replace(one.beam, smallest_angle=2.2)
