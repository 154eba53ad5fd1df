"""Cross sections of two quantities together: Rutherford's law on its curve, sums over an axis, the edge of the disc."""

import sys
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import half_distance, run

PAIR = ("cm_angle", "recoil_energy")
# Of masses 1 and 4 at 1.5: the greatest energy transfer 4 m₁m₂/(m₁+m₂)² E, and T = T_max sin²(ψ/2).
MOST = 16.0 / 25.0 * 1.5
ANGLES = np.radians([30.0, 45.0, 70.0, 110.0, 180.0])
ENERGIES = MOST * np.array([0.05, 0.1, 0.2, 0.5, 0.8, 1.0])


def rutherford(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Area of the impact parameters that are deflected between two angles: πκ²(cot² − cot²)."""
    outer = np.where(high > low, 1.0 / np.tan(0.5 * low) ** 2 - 1.0 / np.tan(0.5 * np.maximum(high, low)) ** 2, 0.0)
    return np.pi * half_distance() ** 2 * outer


def test_follows_rutherford_along_the_curve_of_angle_and_energy():
    tally = run(tally={PAIR: (ANGLES, ENERGIES)}, n_events=1_000_000)[PAIR]
    value, error = tally.cross_section()
    curve = 2.0 * np.arcsin(np.sqrt(ENERGIES / MOST))
    low = np.maximum(ANGLES[:-1, None], curve[None, :-1])
    high = np.minimum(ANGLES[1:, None], curve[None, 1:])
    cell = 2.0 * np.pi * -np.diff(np.cos(ANGLES))[:, None] * np.diff(ENERGIES)[None, :]
    exact = rutherford(low, high) / cell
    inside = exact > 0.0
    # b_max = 3 leads to 31°, T/T_max = 0.072: only where the first bins of both meet something may be missing.
    reached = tally.reachable == 1.0
    assert reached.tolist() == [[False, True, True, True, True], *[[True] * 5] * 3]
    np.testing.assert_array_equal(value[~inside & reached], 0.0)
    # Five standard deviations of one cell in 20: one seed in 1e5.
    assert np.all(np.abs(value - exact)[inside & reached] < 5.0 * error[inside & reached])
    assert np.count_nonzero(inside & reached) == 7


@pytest.mark.parametrize("axis", [0, 1])
def test_summed_over_an_axis_it_is_that_of_the_other_quantity(axis):
    # From where the disc ends on; all of the range of the other.
    edges = (np.radians([45.0, 60.0, 100.0, 180.0]), MOST * np.array([0.2, 0.4, 0.7, 1.0]))
    whole = (np.linspace(0.0, np.pi, 7), np.linspace(0.0, MOST, 7))
    pair_edges = (edges[0], whole[1]) if axis == 1 else (whole[0], edges[1])
    result = run(tally={PAIR: pair_edges, PAIR[1 - axis]: edges[1 - axis]})
    value = result[PAIR].cross_section().value
    widths = (2.0 * np.pi * -np.diff(np.cos(whole[0])), np.diff(whole[1]))[axis]
    # Rows and columns of which nothing is reached together hold nothing; those bins are not told.
    summed = np.nansum(value * (widths[:, None] if axis == 0 else widths[None, :]), axis=axis)
    single = result[PAIR[1 - axis]].cross_section().value
    # The same counts: a few roundings.
    np.testing.assert_allclose(summed, single, rtol=1e-13, atol=0.0)


def test_a_bin_that_the_edge_of_the_disc_cuts_is_averaged_over_what_is_reached():
    ends = 2.0 * np.arctan(half_distance() / 3.0)
    far = np.array([0.2, 0.5]) * ends
    cut, low = np.array([far[1], 1.2 * ends]), MOST * np.sin(0.5 * ends) ** 2
    edges = (np.concatenate([far, cut[1:]]), np.array([0.1, 0.6, 1.3]) * low)
    tally = run(tally={PAIR: edges}, n_events=200_000)[PAIR]
    part = tally.reachable
    reached = (np.cos(ends) - np.cos(cut[1])) / (np.cos(cut[0]) - np.cos(cut[1]))
    above = 0.3 / 0.7
    # Roundings of differences of cosines.
    np.testing.assert_allclose(part, [[0.0, above], [reached, reached + above - reached * above]], rtol=1e-13, atol=0.0)
    value, error = tally.cross_section()
    assert np.isnan(value[0, 0])
    assert np.isnan(error[0, 0])
    # All of the curve there, from the edge of the disc to where the first of both bins ends, is in one cell.
    high = min(cut[1], 2.0 * np.arcsin(np.sqrt(edges[1][2] / MOST)))
    size = 2.0 * np.pi * (np.cos(cut[0]) - np.cos(cut[1])) * np.diff(edges[1])[1] * part[1, 1]
    # Five standard deviations: one seed in a million.
    assert abs(value[1, 1] - rutherford(ends, high) / size) < 5.0 * error[1, 1]


def test_a_heavy_projectile_is_told_by_the_energy_that_parts_its_two_branches():
    pair = ("lab_angle", "energy")
    heavy = {"masses": (4.0, 1.0), "n_events": 1000}
    most = float(np.arcsin(0.25))
    tally = run(**heavy, tally={pair: (np.array([0.0, 0.9, 1.0]) * most, 4)})[pair]
    single = run(**heavy, tally={"lab_angle": np.array([0.0, 0.9, 1.0]) * most})["lab_angle"]
    assert 0.0 <= single.reachable[0] < 1.0
    assert np.isnan(single.cross_section().value[0])
    # Forward scattering of both frames shares that bin; of the slow projectiles all are on the disc.
    value = tally.cross_section().value
    assert np.isfinite(value[0, :3]).all()


def test_importance_leaves_it_where_it_was_and_a_spot_has_none():
    asked = {PAIR: (ANGLES, ENERGIES)}
    plain = run(tally=asked)[PAIR].cross_section()
    forced = run(tally=asked, importance=vv.scattering.LargeAngles(np.radians(110.0)))[PAIR].cross_section()
    known = (plain.error > 0.0) & (forced.error > 0.0)
    pull = (plain.value - forced.value)[known] / np.hypot(plain.error, forced.error)[known]
    # Five standard deviations of one of seven cells.
    assert np.all(np.abs(pull) < 5.0)
    assert forced.error[3, 4] < 0.6 * plain.error[3, 4]
    with pytest.raises(vv.InvalidInput, match="spot: expected a beam that fills the disc evenly"):
        run(tally=asked, spot=1.0, n_events=10)[PAIR].cross_section()


@pytest.mark.parametrize("name", ["beam_energy", "incidence", "deflection"])
def test_a_column_of_events_that_is_no_tally_is_refused_with_what_to_do(name):
    for tally in (name, [(name, "cm_angle")]):
        with pytest.raises(vv.InvalidInput, match=rf"tally: '{name}' is a column of scattering_events") as caught:
            run(tally=tally, energy_spread=0.1, n_events=10)
        assert "numpy.histogram" in str(caught.value)
