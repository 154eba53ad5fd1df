"""Channels whose probability hangs on the energy: which one an event goes through, thresholds, and what is expected."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import chi2

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))

from coulomb_beam import uniforms

p, s = vv.potentials, vv.scattering
Channel, Spread = s.Channel, s.Spread
BEAM = {"masses": (1.0, 4.0), "b_max": 2.0, "seed": 20_261_125}
ALL = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]
# From its threshold, 1.875, on; and one that fades away, more often near the center.
RISING = Channel(-1.5, 0.5, excitation_function=([1.875, 3.0, 5.0], [0.0, 0.4, 1.0]))
FADING = Channel(0.75, ([0.0, 1.5], [0.5, 0.1]), (2.0, 3.0), excitation_function=([1.0, 4.0], [1.0, 0.2]))
LINES = s.Spectrum([1.5, 3.0, 4.5], [1.0, 1.0, 2.0])
BEAMS = {
    "one energy": {"beam_energy": 3.0},
    "lines": {"beam_energy": LINES},
    "spread over the threshold": {"beam_energy": 2.0, "energy_spread": Spread.uniform(0.5)},
    "lines with spread and spot": {"beam_energy": LINES, "energy_spread": 0.05, "spot": 0.7},
    "importance": {"beam_energy": LINES, "importance": s.Strata([0.0, 0.5, 2.0], [3.0, 1.0])},
}


def run(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> s.MonteCarlo:
    return s.monte_carlo(potential, **{**BEAM, "n_events": 30_000, **changes})


def listed(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> dict[str, np.ndarray]:
    return s.scattering_events(potential, **{**BEAM, "n_events": 30_000, **changes})


@pytest.mark.parametrize("beam", BEAMS.values(), ids=BEAMS)
def test_the_channel_of_an_event_is_that_of_its_energy(beam: dict[str, object]) -> None:
    first, n = 2**33 + 7, 20_000
    asked = {"channels": (RISING, FADING), "first_event": first, "n_events": n, **beam}
    events = listed(**asked)
    u, energy, b = uniforms(BEAM["seed"], first, n, draw=6), events["beam_energy"], events["impact_parameter"]
    rising = 0.5 * np.interp(energy, *RISING.excitation_function)
    fading = np.interp(energy, *FADING.excitation_function) * np.interp(b, *FADING.probability)
    expected = np.where(u < rising, 1, np.where(u < rising + fading, 2, 0))
    # Next to the border NumPy may round to the other side.
    clear = (np.abs(u - rising) > 1e-12) & (np.abs(u - rising - fading) > 1e-12)
    assert (events["channel"] == expected)[clear].all()
    assert {0, 1, 2} == set(events["channel"].tolist())
    assert energy[events["channel"] == 1].min() > 1.875
    q = np.array([0.0, -1.5, 0.75])[events["channel"]]
    size = events["energy"] + events["recoil_energy"] + energy
    assert (np.abs(events["energy"] + events["recoil_energy"] - energy - q) < 8e-16 * size).all()
    result = run(tally=[*ALL, ("lab_angle", "energy")], bins=29, **asked)
    for name in ALL:
        tally = result[name]
        assert tally.counts.tolist() == np.histogram(events[name], tally.edges)[0].tolist(), name
        assert (tally.underflow, tally.overflow) == (0, 0), name
    assert run(tally=[*ALL, ("lab_angle", "energy")], bins=29, threads=3, **asked) == result


@pytest.mark.parametrize("beam", [BEAMS["one energy"], BEAMS["lines"], BEAMS["importance"]], ids=repr)
@pytest.mark.parametrize("potential", [p.Coulomb(2.0), p.Yukawa(1.0, 1.0)], ids=repr)
def test_expected_counts_are_those_of_each_line(potential: p.Potential, beam: dict[str, object]) -> None:
    """χ² with p above 1e-4 for each of twelve runs' quantities: by chance one set of seeds in a hundred would fail."""
    other = Channel(0.75, 0.3, (2.0, 3.0), excitation_function=FADING.excitation_function)
    result = run(potential, channels=(RISING, other), tally=ALL, bins=15, n_events=200_000, **beam)
    for name in ALL:
        tally = result[name]
        expected = tally.expected()
        assert expected.sum() == pytest.approx(result.n_events, rel=1e-9, abs=0)
        variances = expected if tally.by_stratum is None else tally.variances()
        many = (expected > 20.0) & (tally.counts > 20)
        statistic = ((tally.values() - expected)[many] ** 2 / variances[many]).sum()
        assert chi2.sf(statistic, many.sum()) > 1e-4, name


def test_one_energy_is_the_constant_that_it_makes() -> None:
    """Bits of the channel whose probability is told as a number, on the fast path."""
    told = Channel(-1.5, 0.5 * 0.4)
    rising = run(channels=RISING, beam_energy=3.0, tally=ALL, bins=29)
    for of_energy, constant in zip(
        rising.tallies, run(channels=told, beam_energy=3.0, tally=ALL, bins=29).tallies, strict=True
    ):
        assert (of_energy.counts == constant.counts).all()
        assert (of_energy.expected() == constant.expected()).all()


def test_below_its_threshold_a_channel_is_none() -> None:
    closed = run(channels=RISING, beam_energy=1.5, tally=ALL, bins=29)
    elastic = run(beam_energy=1.5, tally=ALL, bins=29)
    for tally, other in zip(closed.tallies, elastic.tallies, strict=True):
        assert (tally.counts == other.counts).all()
        assert (tally.edges == other.edges).all()
        assert tally.covered == other.covered


def test_what_a_spread_leaves_unknown_is_refused_and_files_keep_the_rest(tmp_path: Path) -> None:
    result = run(channels=(RISING, FADING), tally=ALL, bins=10, **BEAMS["spread over the threshold"])
    with pytest.raises(vv.errors.InvalidInput) as refused:
        result["energy"].expected()
    assert refused.value.argument == "energy_spread"
    result.save(tmp_path / "counts.npz")
    loaded = s.MonteCarlo.load(tmp_path / "counts.npz")
    assert loaded == result
    assert loaded.beam.channels == (RISING, FADING)
    assert loaded.resume(1000) == result.resume(1000)
