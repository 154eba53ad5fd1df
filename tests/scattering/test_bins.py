"""Bins by name, and what a tally says of its counts: expected ones, intervals, UHI, a picture.

Bounds: rings are differences of cosines, of which a hundred rings lose two digits; what is drawn is the number
itself, in other units; a χ² that a right simulation leaves but once in fifty thousand draws, of one seed.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import BEAM, TALLIES, event_by_event, half_distance, law, run, uniforms

p, Bins = vv.potentials, vv.scattering.Bins
LINES = vv.scattering.Spectrum([1.1, 1.5, 4.5], [1.0, 2.0, 1.0])


@pytest.mark.parametrize("name", TALLIES)
def test_named_bins_have_equal_widths_or_ratios(name: str) -> None:
    tally = run(tally={name: Bins.linear(40)})[name]
    assert np.array_equal(tally.edges, run(tally=name, bins=40)[name].edges)
    high = float(tally.edges[-1])
    tally = run(tally=name, bins=Bins.logarithmic(40, high / 1000.0))[name]
    assert (tally.edges[0], tally.edges[-1]) == (high / 1000.0, high)
    # Two rounded edges and a logarithm of 1000^(1/40).
    assert np.diff(np.log(tally.edges)) == pytest.approx(np.log(1000.0) / 40.0, rel=1e-13, abs=0)


@pytest.mark.parametrize("name", ["cm_angle", "lab_angle", "recoil_angle"])
@pytest.mark.parametrize(("low", "high"), [(None, None), (1e-6, 1e-3), (0.5, 1.5)])
def test_rings_have_equal_solid_angles(name: str, low: float | None, high: float | None) -> None:
    edges = run(tally={name: Bins.solid_angle(100, low, high)})[name].edges
    rings = vv._core.solid_angles(edges)
    assert rings == pytest.approx(rings[0], rel=4e-13, abs=0)
    assert low is None or (edges[0], edges[-1]) == (low, high)


@pytest.mark.parametrize("name", TALLIES)
def test_what_is_outside_is_kept(name: str) -> None:
    values = event_by_event(uniforms(BEAM["seed"], 0, 100_000))[name]
    low, high = np.quantile(values, [0.1, 0.7])
    tally = run(tally=name, bins=Bins.logarithmic(13, float(low), float(high)))[name]
    assert tally.counts.tolist() == np.histogram(values, tally.edges)[0].tolist()
    assert (tally.underflow, tally.overflow) == ((values < low).sum(), (values > high).sum())


def test_bins_may_differ_by_quantity() -> None:
    pair = ("cm_angle", "energy")
    asked = {"cm_angle": Bins.solid_angle(7), "energy": [0.0, 1.0, 1.5]}
    result = run(tally=["cm_angle", "lab_angle", pair], bins=asked)
    assert [len(tally.counts) for tally in result.values()] == [7, 180, 7]
    assert result[pair].counts.shape == (7, 2)
    assert result[pair] == run(tally={pair: (Bins.solid_angle(7), [0.0, 1.0, 1.5])})[pair]
    assert np.array_equal(run(bins=[0.5, 1.0, 2.0])["cm_angle"].edges, [0.5, 1.0, 2.0])
    foil = vv.scattering.Foil("gold", 0.4).run(
        "alpha", beam_energy=5e6, n_events=10, seed=1, tally="transmitted_angle", bins=Bins.logarithmic(5, 1e-4, 1.0)
    )
    assert foil["transmitted_angle"].edges[[0, -1]].tolist() == [1e-4, 1.0]


@pytest.mark.parametrize(
    ("argument", "asked"),
    [
        ("energy", {"tally": "energy", "bins": Bins.solid_angle(5)}),
        ("energy", {"tally": {"energy": Bins.linear(5, 0.0, 15.0)}}),
        ("cm_angle", {"bins": Bins.linear(5, 4.0)}),
        ("cm_angle", {"bins": Bins.linear(5, 0.0, 180.0)}),
        ("cm_angle", {"bins": [0.0, 2.0, 1.0]}),
        ("cm_angle", {"bins": [0.0, 1.0, 1.0]}),
        ("cm_angle", {"bins": [-1.0, 1.0]}),
        ("bins", {"bins": {"energy": 5}}),
        ("bins", {"bins": "logarithmic"}),
        ("bins", {"bins": 2.0}),
        ("cm_angle", {"bins": {"cm_angle": 0.5}}),
    ],
)
def test_refusals(argument: str, asked: dict[str, object]) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        run(**asked)
    assert caught.value.argument == argument


@pytest.mark.parametrize(
    ("argument", "make"),
    [
        ("low", lambda: Bins.logarithmic(5, 0.0)),
        ("low", lambda: Bins.logarithmic(5, -1.0, 1.0)),
        ("high", lambda: Bins.linear(5, 1.0, 1.0)),
        ("high", lambda: Bins.linear(5, high=-1.0)),
        ("n", lambda: Bins.linear(0)),
        ("n", lambda: Bins.solid_angle(2**16 + 1)),
        ("bins", Bins),
    ],
)
def test_bins_that_are_none(argument: str, make: object) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        make()
    assert caught.value.argument == argument


@pytest.mark.parametrize("k", [2.0, -2.0])
def test_expected_counts_are_the_areas_that_lead_there(k: float) -> None:
    """Of a Coulomb center each bin's area is known; a bin beyond the disc's edge expects nothing."""
    result = run(k, tally=TALLIES, bins=29)
    for name, tally in result.items():
        inside = tally.reachable == 1.0
        areas = law(tally.edges, name, BEAM["masses"], abs(half_distance(k)), BEAM["beam_energy"])
        expected = areas * tally.n_events / (np.pi * BEAM["b_max"] ** 2)
        # Differences of b² of nearly all of the disc where bins are narrow: 1e-12 of it.
        assert tally.expected()[inside] == pytest.approx(expected[inside], rel=1e-9, abs=1e-7)
        assert tally.expected().sum() == pytest.approx(tally.n_events, rel=1e-14, abs=0)


@pytest.mark.parametrize("potential", [p.LennardJones(1.0, 1.0), p.PowerLaw(-1.0, 4), p.Yukawa(-1.0, 1.0)], ids=repr)
@pytest.mark.parametrize("energy", [1.5, LINES], ids=["one energy", "spectrum"])
def test_counts_are_what_is_expected(potential: vv.potentials.Potential, energy: object) -> None:
    result = vv.scattering.monte_carlo(
        potential, **{**BEAM, "beam_energy": energy}, n_events=4_000_000, tally=["cm_angle", "energy"], bins=40
    )
    for tally in result.values():
        expected = tally.expected()
        assert expected.sum() + tally.captured == pytest.approx(4e6, abs=4.0 * np.sqrt(tally.captured) + 1e-6)
        many = expected > 10.0
        chi2 = ((tally.values() - expected)[many] ** 2 / expected[many]).sum()
        assert 1e-5 < stats.chi2.sf(chi2, many.sum()) < 1.0 - 1e-5


@pytest.mark.parametrize("energy", [1.5, LINES], ids=["one energy", "spectrum"])
def test_two_quantities_together_expect_what_they_count(energy: object) -> None:
    """Each bin by itself, and summed over one axis what is expected of the other quantity alone."""
    pair = ("lab_angle", "recoil_energy")
    result = vv.scattering.monte_carlo(
        p.LennardJones(1.0, 1.0), **{**BEAM, "beam_energy": energy}, n_events=1_000_000, tally=[pair, *pair], bins=12
    )
    joint = result[pair]
    expected = joint.expected()
    assert expected.shape == (12, 12)
    for axis, name in enumerate(pair):
        # Every event is within the range of the other quantity; up to 14 parts are added up, each rounded to 1e-16.
        assert expected.sum(1 - axis) == pytest.approx(result[name].expected(), rel=1e-12, abs=1e-6)
    many = expected > 10.0
    assert many.sum() > 15
    chi2 = ((joint.values() - expected)[many] ** 2 / expected[many]).sum()
    assert 1e-5 < stats.chi2.sf(chi2, many.sum()) < 1.0 - 1e-5
    # What the potential cannot lead to is counted nowhere.
    assert not joint.counts[expected == 0.0].any()


def test_expected_is_the_integral_of_the_cross_section() -> None:
    """Where every impact parameter lies on the disc: dσ/dΩ by quadrature of the deflection, not by the table."""
    potential, edges = p.Yukawa(1.0, 1.0), np.linspace(1.0, 3.0, 9)
    tally = vv.scattering.monte_carlo(potential, **BEAM, n_events=1000, tally={"cm_angle": edges})["cm_angle"]
    node, weight = np.polynomial.legendre.leggauss(16)
    angle = 0.5 * (edges[1:, None] + edges[:-1, None]) + 0.5 * np.diff(edges)[:, None] * node
    value = vv.scattering.cross_section(potential, energy=BEAM["beam_energy"] * 0.8, angle=angle)
    area = (value * 2.0 * np.pi * np.sin(angle) * weight).sum(1) * 0.5 * np.diff(edges)
    # The table is certified to 4e-6 in sin²(ψ/2), and made to 1e-9 of the angles.
    assert tally.expected() == pytest.approx(1000.0 * area / (np.pi * BEAM["b_max"] ** 2), rel=1e-6, abs=0)


def test_intervals_are_the_exact_ones() -> None:
    """Against the quantiles of χ², at every small count and beyond 500, where a series takes over."""
    counts = np.concatenate([np.arange(700), [1000, 12_345, 10**6, 10**12]]).astype(np.uint64)
    low, high = vv.scattering._counts.poisson_interval(counts)
    tail = stats.norm.sf(1.0)
    n = counts.astype(np.float64)
    exact_low = np.where(n > 0, stats.chi2.ppf(tail, 2.0 * np.maximum(n, 0.5)) / 2.0, 0.0)
    exact_high = stats.chi2.isf(tail, 2.0 * n + 2.0) / 2.0
    # The series leaves out 1/n²; SciPy's own quantiles have 1e-13.
    assert low == pytest.approx(exact_low, rel=1e-11, abs=2e-6)
    assert high == pytest.approx(exact_high, rel=1e-11, abs=2e-6)
    few = counts < 500
    assert low[few] == pytest.approx(exact_low[few], rel=1e-12, abs=0)
    assert high[few] == pytest.approx(exact_high[few], rel=1e-12, abs=0)
    assert (low[0], high[0]) == (0.0, pytest.approx(-np.log(tail), rel=1e-14, abs=0))


def test_intervals_hold_the_mean_as_often_as_they_say() -> None:
    """A central interval of a discrete law holds its mean in at least 68.27 % of runs; n ± √n misses it more often."""
    for mean in (0.7, 3.0, 30.0):
        n = np.arange(200)
        low, high = vv.scattering._counts.poisson_interval(n.astype(np.uint64))
        part = stats.poisson.pmf(n, mean)[(low <= mean) & (mean <= high)].sum()
        assert 0.6826 < part < 0.95
    root = np.sqrt(n)
    assert stats.poisson.pmf(n, 0.7)[(n - root <= 0.7) & (n + root >= 0.7)].sum() < 0.5


def test_tallies_speak_uhi() -> None:
    hist = pytest.importorskip("hist")
    pair = ("cm_angle", "energy")
    result = run(tally={"cm_angle": Bins.logarithmic(9, 0.9, 2.0), pair: (5, [0.5, 1.0])})
    tally, joint = result["cm_angle"], result[pair]
    filled = tally.to_hist()
    assert isinstance(filled, hist.Hist)
    assert np.array_equal(filled.values(), tally.values())
    assert np.array_equal(filled.axes[0].edges, tally.edges)
    assert filled.values(flow=True)[[0, -1]].tolist() == [tally.underflow, tally.overflow]
    assert filled.sum(flow=True) == tally.n_events
    both = joint.to_hist()
    assert np.array_equal(both.values(flow=True), joint.flow)
    assert [axis.name for axis in both.axes] == list(pair)
    # Binomial variances, n (1 - n/N).
    share = tally.values() / tally.n_events
    assert tally.variances() == pytest.approx(tally.n_events * share * (1.0 - share), rel=1e-14, abs=0)
    assert joint.values().shape == joint.variances().shape == (5, 1)


def test_a_picture_shows_counts_bands_and_theory() -> None:
    pytest.importorskip("matplotlib")
    tally = run(tally="cm_angle", bins=Bins.solid_angle(30), n_events=300)["cm_angle"]
    axes = tally.plot()
    counted, theory = (patch.get_data() for patch in axes.patches)
    scale = np.pi * tally.b_max**2 / (tally.n_events * vv._core.solid_angles(tally.edges))
    assert counted.values == pytest.approx(tally.values() * scale, rel=1e-14, abs=0)
    assert theory.values == pytest.approx(tally.expected() * scale, rel=1e-14, abs=0)
    assert counted.edges == pytest.approx(np.degrees(tally.edges), rel=1e-14, abs=0)
    band = axes.collections[0].get_paths()[0].vertices[:, 1]
    low, high = (end[tally.expected() > 0.0] for end in tally.poisson_interval())
    scale = scale[tally.expected() > 0.0]
    assert band[np.isfinite(band)].max() == pytest.approx((high * scale).max(), rel=1e-14, abs=0)
    assert band[np.isfinite(band)].min() == pytest.approx((low * scale).min(), rel=1e-14, abs=0)
    assert tally.plot(ax=axes) is axes


def test_an_energy_of_the_beam_that_is_an_edge_counts_as_its_events_do() -> None:
    """Far out a collision takes less than a rounding of the energy, which is then the edge, or the number below it and
    the edge by turns: a stretch of b from 4.706 to 4.728 of the second line."""
    asked: dict[str, Any] = {
        "beam_energy": vv.scattering.Spectrum([0.3, 0.39, 0.6], [1, 2, 0.5]),
        "masses": (4.0, 1.0),
        "b_max": 7.0,
        "seed": 12345,
        "n_events": 200_000,
        "first_event": 17,
    }
    well = vv.potentials.Custom(lambda r: np.exp(-r * r))
    edges = [0.0, 0.3, 0.39, 0.6]
    counted = vv.scattering.monte_carlo(well, tally={"energy": edges}, **asked)["energy"].counts
    energies = vv.scattering.scattering_events(well, **asked)["energy"]
    assert counted.tolist() == np.histogram(energies, edges)[0].tolist()
