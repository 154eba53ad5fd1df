"""Channels of a Monte Carlo: momentum and energy of every event, the parts of all, thresholds, and bits that depend on
nothing.

Bounds: angles to the roundings of their tangents, and next to 0 to those of numbers of size 1; expected counts are
areas of the disc, each to what finds its borders, 1e-9, and of all together to the rounding of their sum.
"""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from kept_files import parts, written

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))

from coulomb_beam import uniforms

p, s = vv.potentials, vv.scattering
Channel, Spread = s.Channel, s.Spread
BEAM = {"beam_energy": 3.0, "masses": (1.0, 4.0), "b_max": 2.0, "seed": 20_261_124}
LINES = s.Spectrum([3.0, 4.5], [1.0, 2.0])
ALL = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]
# Excited, released, and with other bodies going away; what is left of 1, 0.25, is elastic.
CHANNELS = (
    Channel(q_value=-1.5, probability=0.25),
    Channel(q_value=0.75, probability=0.3, products=(2.0, 3.0)),
    Channel(q_value=-0.4, probability=0.2, products=(3.5, 1.5)),
)
PRODUCTS = np.array([(1.0, 4.0), (1.0, 4.0), (2.0, 3.0), (3.5, 1.5)])
Q = np.array([0.0, -1.5, 0.75, -0.4])
BEAMS = {
    "one energy": {},
    "lines": {"beam_energy": LINES},
    "spread": {"beam_energy": LINES, "energy_spread": 0.05},
    "uniform spread and spot": {"energy_spread": Spread.uniform(0.3), "spot": 0.7},
    "importance": {"beam_energy": LINES, "importance": s.Strata([0.0, 0.5, 2.0], [3.0, 1.0])},
    "heavy": {"masses": (4.0, 1.0), "beam_energy": 15.0},
}
POTENTIALS = [p.Coulomb(2.0), p.Coulomb(-1.0), p.Yukawa(1.0, 1.0), p.LennardJones(1.0, 1.0)]


def run(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> s.MonteCarlo:
    return s.monte_carlo(potential, **{**BEAM, "n_events": 30_000, "channels": CHANNELS, **changes})


def listed(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> dict[str, np.ndarray]:
    return s.scattering_events(potential, **{**BEAM, "n_events": 30_000, "channels": CHANNELS, **changes})


def masses_after(events: dict[str, np.ndarray], masses: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    products = PRODUCTS.copy()
    products[:2] = masses
    return products[events["channel"], 0], products[events["channel"], 1]


@pytest.mark.parametrize("beam", BEAMS.values(), ids=BEAMS)
@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_momentum_and_energy_close_for_every_event(potential: p.Potential, beam: dict[str, object]) -> None:
    masses = beam.get("masses", BEAM["masses"])
    events = listed(potential, **beam)
    before, after, recoil = events["beam_energy"], events["energy"], events["recoil_energy"]
    assert set(events["channel"].tolist()) == {0, 1, 2, 3}
    # Some seven roundings of 1.1e-16 in each of two energies; measured 4.6e-16.
    scale = before + after + recoil
    assert (np.abs(after + recoil - before - Q[events["channel"]]) < 8e-16 * scale).all()
    third, fourth = masses_after(events, masses)
    momenta = [np.sqrt(2.0 * m * e) for m, e in ((masses[0], before), (third, after), (fourth, recoil))]
    along = momenta[1] * np.cos(events["lab_angle"]) + momenta[2] * np.cos(events["recoil_angle"])
    across = momenta[1] * np.sin(events["lab_angle"]) - momenta[2] * np.sin(events["recoil_angle"])
    # As many, and the square roots; measured 3e-16.
    size = momenta[0] + momenta[1] + momenta[2]
    assert (np.abs(along - momenta[0]) < 1e-15 * size).all()
    assert (np.abs(across) < 1e-15 * size).all()


@pytest.mark.parametrize("beam", BEAMS.values(), ids=BEAMS)
def test_events_agree_with_the_kinematics(beam: dict[str, object]) -> None:
    masses = beam.get("masses", BEAM["masses"])
    events = listed(**{**beam, "n_events": 2000})
    for channel in range(4):
        which = events["channel"] == channel
        products = tuple(PRODUCTS[channel] / masses[1]) if channel > 1 else None
        asked = {
            "mass_ratio": masses[0] / masses[1],
            "q_value": Q[channel],
            "beam_energy": events["beam_energy"][which],
            "products": products,
        }
        psi = events["cm_angle"][which]
        assert events["lab_angle"][which] == pytest.approx(s.lab_angle(psi, **asked), rel=1e-13, abs=1e-15)
        assert events["recoil_angle"][which] == pytest.approx(s.recoil_angle(psi, **asked), rel=1e-13, abs=1e-15)


@pytest.mark.parametrize("beam", BEAMS.values(), ids=BEAMS)
@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_every_event_is_counted_in_its_bin(potential: p.Potential, beam: dict[str, object]) -> None:
    first, pairs = 2**33 + 5, [("lab_angle", "energy"), ("recoil_angle", "recoil_energy")]
    result = run(potential, first_event=first, tally=[*ALL, *pairs], bins=37, **beam)
    events = listed(potential, first_event=first, **beam)
    for name in ALL:
        tally = result[name]
        assert tally.counts.tolist() == np.histogram(events[name], tally.edges)[0].tolist(), name
        assert (tally.underflow, tally.overflow, tally.captured) == (0, 0, 0)
    for pair in pairs:
        expected = np.histogram2d(events[pair[0]], events[pair[1]], result[pair].edges)[0]
        assert (result[pair].counts == expected).all()
    # One at a time, too: where nothing is counted that channels differ in, their draw is not looked at.
    for name in ("cm_angle", "impact_parameter"):
        alone = run(potential, first_event=first, tally=name, bins=37, **beam)
        assert (alone[name].counts == result[name].counts).all()


def test_channels_are_draw_6_in_the_order_given() -> None:
    first, n = 2**33 + 7, 5000
    u = uniforms(BEAM["seed"], first, n, draw=6)
    expected = np.array([1, 2, 3, 0])[np.searchsorted([0.25, 0.25 + 0.3, 0.25 + 0.3 + 0.2], u, side="right")]
    found = listed(first_event=first, n_events=n)
    assert (found["channel"] == expected).all()
    # Neither a channel more at the end nor any other thing that is asked for changes an event of those before.
    fewer = listed(first_event=first, n_events=n, channels=CHANNELS[:2])
    kept = expected != 3
    assert (fewer["channel"][kept] == expected[kept]).all()
    assert (fewer["channel"][~kept] == 0).all()
    for name in ALL:
        assert (fewer[name][kept] == found[name][kept]).all(), name
    plain = listed(first_event=first, n_events=n, channels=())
    assert "channel" not in plain
    for name in ("cm_angle", "deflection", "impact_parameter", "beam_energy"):
        assert (plain[name] == found[name]).all(), name
    for name in ALL:
        assert (plain[name][expected == 0] == found[name][expected == 0]).all(), name
    beside = listed(first_event=first, n_events=n, energy_spread=0.05, divergence=0.02, spot=1.0)
    assert (beside["channel"] == expected).all()


def test_an_elastic_channel_is_no_channel() -> None:
    """Q = 0 with masses unchanged, and what can never happen: the very bits of the run without."""
    plain = run(tally=ALL, channels=None)
    for channels in (Channel(0.0, 0.3), [Channel(-1.5, 0.0)], [Channel(0.0, 0.5), Channel(0.0, 0.5, (1.0, 4.0))]):
        other = run(tally=ALL, channels=channels)
        for name in ALL:
            assert (other[name].counts == plain[name].counts).all(), name


def test_parts_are_the_probabilities() -> None:
    n = 400_000
    channel = listed(p.Coulomb(1.0), n_events=n)["channel"]
    for number, part in enumerate((0.25, 0.25, 0.3, 0.2)):
        # Four standard deviations.
        assert abs((channel == number).mean() - part) < 4.0 * np.sqrt(part * (1.0 - part) / n)
    certain = listed(p.Coulomb(1.0), channels=[Channel(-1.0, 0.1)] * 10)["channel"]
    assert certain.min() == 1
    assert certain.max() == 10


@pytest.mark.parametrize("beam", [BEAMS["one energy"], BEAMS["lines"], BEAMS["importance"], BEAMS["heavy"]], ids=repr)
@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_expected_counts(potential: p.Potential, beam: dict[str, object]) -> None:
    """χ² over all bins of all quantities: five standard deviations of it, so that 96 of them pass by chance."""
    result = run(potential, tally=ALL, bins=15, n_events=200_000, **beam)
    for name in ALL:
        tally = result[name]
        expected, variances = tally.expected(), tally.variances()
        many = tally.counts > 20
        assert (np.abs(tally.values() - expected)[~many] <= 60.0).all()
        if tally.by_stratum is None:
            many &= expected > 20.0
            variances = expected * (1.0 - expected / result.n_events)
        chi2 = ((tally.values() - expected)[many] ** 2 / np.maximum(variances[many], 1e-300)).sum()
        freedom = int(many.sum())
        assert chi2 < freedom + 5.0 * np.sqrt(2.0 * freedom) + 10.0, (name, chi2, freedom)
        assert expected.sum() == pytest.approx(result.n_events, rel=1e-14, abs=0)


def test_hard_sphere_energies_of_an_excited_target_are_even() -> None:
    """σ dΩ even on the sphere, so the energy E₃ = V² + w² + 2Vw cos ψ is even between (V - w)² and (V + w)²."""
    e, q = 3.0, -1.5
    result = run(p.HardSphere(1.0), b_max=1.0, n_events=400_000, channels=Channel(q, 1.0), tally={"energy": 60})
    tally = result["energy"]
    v, w = np.sqrt(e) / 5.0, np.sqrt(4.0 * (e * 0.8 + q) / 5.0)
    low, high = (v - w) ** 2, (v + w) ** 2
    assert tally.edges[-1] == pytest.approx(high, rel=1e-15, abs=0)
    width = np.clip(np.minimum(tally.edges[1:], high) - np.maximum(tally.edges[:-1], low), 0.0, None)
    even = width / (high - low) * result.n_events
    assert tally.expected() == pytest.approx(even, rel=1e-9, abs=1e-9)
    some = even > 0.0
    assert (tally.counts[~some] == 0).all()
    chi2 = ((tally.counts - even)[some] ** 2 / even[some]).sum()
    assert chi2 < some.sum() + 4.0 * np.sqrt(2.0 * some.sum())


def test_at_the_threshold_both_go_ahead_together() -> None:
    threshold = float(s.threshold_energy(mass_ratio=0.25, q_value=-1.0))
    assert threshold == 1.25
    events = listed(p.Coulomb(1.0), beam_energy=threshold, channels=Channel(-1.0, 1.0), n_events=1000)
    assert (events["lab_angle"] == 0.0).all()
    assert (events["recoil_angle"] == 0.0).all()
    # The speed of the frame: E m₁m₃/M².
    assert events["energy"] == pytest.approx(np.full(1000, 1.25 / 25.0), rel=1e-15, abs=0)
    assert events["recoil_energy"] == pytest.approx(np.full(1000, 1.25 * 4.0 / 25.0), rel=1e-15, abs=0)


VARYING = (Channel(-1.5, ([0.0, 0.5, 1.5], [0.8, 0.6, 0.0])), Channel(0.75, 0.2, (2.0, 3.0)))


@pytest.mark.parametrize("beam", BEAMS.values(), ids=BEAMS)
def test_probabilities_may_hang_on_the_impact_parameter(beam: dict[str, object]) -> None:
    first, n = 2**33 + 7, 20_000
    asked = {"channels": VARYING, "first_event": first, "n_events": n, **beam}
    events = listed(**asked)
    u, b = uniforms(BEAM["seed"], first, n, draw=6), events["impact_parameter"]
    part = np.interp(b, *VARYING[0].probability)
    expected = np.where(u < part, 1, np.where(u < part + 0.2, 2, 0))
    # Next to the border NumPy may round to the other side.
    clear = (np.abs(u - part) > 1e-12) & (np.abs(u - part - 0.2) > 1e-12)
    assert (events["channel"] == expected)[clear].all()
    assert {0, 1, 2} == set(events["channel"].tolist())
    q = np.array([0.0, -1.5, 0.75])[events["channel"]]
    size = events["energy"] + events["recoil_energy"] + events["beam_energy"]
    assert (np.abs(events["energy"] + events["recoil_energy"] - events["beam_energy"] - q) < 8e-16 * size).all()
    result = run(tally=[*ALL, ("lab_angle", "energy")], bins=29, **asked)
    for name in ALL:
        assert result[name].counts.tolist() == np.histogram(events[name], result[name].edges)[0].tolist(), name
    assert run(tally=[*ALL, ("lab_angle", "energy")], bins=29, threads=3, **asked) == result
    # Of what channels do not touch: as without them, also where one draw tells all.
    for name in ("cm_angle", "impact_parameter"):
        assert (run(tally=name, bins=29, **asked)[name].counts == result[name].counts).all()


def test_an_even_table_is_a_number() -> None:
    flat = [Channel(c.q_value, ([0.3, 1.0], [c.probability] * 2), c.products) for c in CHANNELS]
    even, constant = listed(channels=flat), listed()
    for name, values in constant.items():
        assert (even[name] == values).all(), name
    with pytest.raises(vv.errors.InvalidInput, match="impact parameter 1") as refused:
        run(channels=[Channel(-1.5, ([0.0, 1.0], [0.2, 0.9])), Channel(0.75, 0.2)])
    assert refused.value.argument == "channels"


def test_what_is_expected_of_varying_channels(tmp_path: Path) -> None:
    result = run(channels=VARYING, tally=ALL, bins=10)
    for name in ("cm_angle", "impact_parameter"):
        assert np.abs(result[name].expected() - result[name].counts).max() < 5.0 * np.sqrt(30_000 / 4)
    with pytest.raises(vv.errors.InvalidInput) as refused:
        result["energy"].expected()
    assert refused.value.argument == "channels"
    result.save(tmp_path / "counts.npz")
    assert s.MonteCarlo.load(tmp_path / "counts.npz") == result
    pytest.importorskip("matplotlib")
    result["energy"].plot()


@pytest.mark.parametrize("beam", [{"beam_energy": LINES}, {"energy_spread": 0.05, "divergence": 0.02}], ids=repr)
def test_bits_depend_on_nothing(beam: dict[str, object]) -> None:
    n = 1_500_001
    tallies = {"tally": [*ALL, ("lab_angle", "energy")], "bins": 23, "n_events": n, **beam}
    whole = run(p.Coulomb(1.0), threads=1, **tallies)
    for threads in (2, 3):
        assert run(p.Coulomb(1.0), threads=threads, **tallies) == whole
    with ThreadPoolExecutor(2) as pool:
        assert run(p.Coulomb(1.0), executor=pool, **tallies) == whole
    part = run(p.Coulomb(1.0), **{**tallies, "n_events": 700_003})
    assert part.resume(n - 700_003) == whole
    rest = run(p.Coulomb(1.0), **{**tallies, "n_events": n - 700_003, "first_event": 700_003})
    assert rest + part == whole


_TIER = """
import json, sys, visviva as vv
C = vv.scattering.Channel
run = vv.scattering.monte_carlo(vv.potentials.Yukawa(1.0, 1.0), beam_energy=vv.scattering.Spectrum([3.0, 4.5], [1, 2]),
    masses=(1.0, 4.0), b_max=2.0, seed=3, n_events=100_000, bins=50, energy_spread=eval(sys.argv[1]),
    tally=["lab_angle", "recoil_angle", "energy", "recoil_energy"],
    channels=[C(-1.5, 0.25), C(0.75, 0.3, (2.0, 3.0))])
print(json.dumps([tally.counts.tolist() for tally in run.tallies]))
"""


@pytest.mark.parametrize("spread", ["None", "0.05"])
def test_tiers_give_the_same_bits(spread: str) -> None:
    found = []
    for tier in ("portable", "avx2"):
        environment = {**os.environ, "VISVIVA_SIMD": tier}
        done = subprocess.run([sys.executable, "-c", _TIER, spread], capture_output=True, env=environment, check=True)
        found.append(json.loads(done.stdout))
    assert found[0] == found[1]


def test_files_keep_channels_and_older_ones_are_read(tmp_path: Path) -> None:
    result, plain = run(tally=[*ALL, ("lab_angle", "energy")]), run(channels=None, tally=ALL)
    for each in (result, plain):
        each.save(tmp_path / "counts.npz")
        loaded = s.MonteCarlo.load(tmp_path / "counts.npz")
        assert loaded == each
        assert loaded.beam.channels == each.beam.channels
        assert loaded.resume(1000) == each.resume(1000)
    # A file of version 3, which knew no channels.
    header, arrays = parts(tmp_path / "counts.npz")
    del header["channels"]
    header["version"] = 3
    written(tmp_path / "old.npz", header, arrays)
    assert s.MonteCarlo.load(tmp_path / "old.npz") == plain


def test_results_of_other_channels_do_not_add() -> None:
    with pytest.raises(vv.errors.InvalidInput, match="channels"):
        run() + run(channels=CHANNELS[:2], first_event=30_000)


def test_edges_go_as_far_as_any_channel() -> None:
    result = run(tally=ALL, bins=10)
    assert result["recoil_angle"].edges[-1] == np.pi
    # (V + w)² of the released energy: of the products (2, 3), at E = 3.
    relative = 3.0 * 0.8 + 0.75
    high = (np.sqrt(2.0 * 3.0) / 5.0 + np.sqrt(3.0 * relative / 5.0)) ** 2
    # Of (3.5, 1.5) and of the elastic one: (√(3.5·3) + √(1.5·2))²/25, 3.
    assert result["energy"].edges[-1] == pytest.approx(max(high, 3.0), rel=1e-15, abs=0)
    assert run(tally={"energy": [0.0, 3.4]})["energy"].counts.sum() > 0
    with pytest.raises(vv.errors.InvalidInput, match="the greatest energy"):
        run(tally={"energy": [0.0, 5.0]})
    slow = run(channels=Channel(-1.5, 0.5), tally={"recoil_angle": 10})
    assert slow["recoil_angle"].edges[-1] == np.pi / 2
    with pytest.raises(vv.errors.InvalidInput, match="recoil_angle"):
        run(channels=Channel(-1.5, 0.5), tally={"recoil_angle": [0.0, 2.0]})


@pytest.mark.parametrize("beam", [BEAMS["one energy"], BEAMS["lines"], BEAMS["spread"], BEAMS["heavy"]], ids=repr)
def test_what_a_wider_disc_adds_is_in_no_covered_bin(beam: dict[str, object]) -> None:
    """A cross section of a bin that is covered does not change with the disc: events beyond lead to no such value."""
    potential = p.Coulomb(2.0)
    narrow = run(potential, tally=ALL, bins=40, **beam)
    wide = {**beam, "b_max": 20.0, "n_events": 300_000}
    events = listed(potential, **wide)
    beyond = events["impact_parameter"] > BEAM["b_max"]
    assert beyond.sum() > 200_000
    some = 0
    for name in ALL:
        tally = narrow[name]
        low, high = tally.covered
        inside = (events[name][beyond] > low * (1 + 1e-14)) & (events[name][beyond] < high * (1 - 1e-14))
        if name != "impact_parameter":
            assert not inside.any(), name
        counts = np.histogram(events[name][beyond], tally.edges)[0]
        assert (counts[tally.reachable == 1.0] == 0).all(), name
        some += int((tally.reachable == 1.0).sum())
    assert some > 40


def test_a_cross_section_of_channels_is_that_of_all() -> None:
    """Laboratory angles of an excited target: dσ/dΩ of each channel by its Jacobian, by its probability."""
    e, q, part = 3.0, -1.0, 0.4
    edges = np.radians([90.0, 100.0, 120.0, 150.0, 180.0])
    result = run(p.Coulomb(1.0), n_events=2_000_000, channels=Channel(q, part), tally={"lab_angle": edges})
    value, error = result["lab_angle"].cross_section()
    kappa = 1.0 / (2.0 * e * 0.8)

    def area(angle: float, q_value: float) -> float:
        psi = s.cm_angle(angle, mass_ratio=0.25, q_value=q_value, beam_energy=e)[0]
        return float(np.pi * (kappa / np.tan(psi / 2.0)) ** 2)

    for index, (low, high) in enumerate(pairwise(edges)):
        sigma = sum(w * (area(low, each) - area(high, each)) for each, w in ((0.0, 1.0 - part), (q, part)))
        omega = 2.0 * np.pi * (np.cos(low) - np.cos(high))
        assert abs(value[index] - sigma / omega) < 4.0 * error[index]


@pytest.mark.parametrize("products", [(1.5, 4.0), (0.5, 3.0), (2.0, 3.0)])
def test_products_of_another_mass_keep_the_balance_of_the_laboratory(products: tuple[float, float]) -> None:
    """T₃ + T₄ = E + Q and m₁v = m₃v₃ + m₄v₄: their relative motion has E + Q − E m₁/(m₃ + m₄), whatever their sum."""
    energy, q, (m1, _) = BEAM["beam_energy"], 0.75, BEAM["masses"]
    events = listed(channels=[Channel(q, 1.0, products)], n_events=1000)
    momenta = [
        np.sqrt(2.0 * mass * events[name]) * np.stack([np.cos(events[angle]), sign * np.sin(events[angle])])
        for mass, name, angle, sign in (
            (products[0], "energy", "lab_angle", 1.0),
            (products[1], "recoil_energy", "recoil_angle", -1.0),
        )
    ]
    brought = np.sqrt(2.0 * m1 * energy)
    # Angles as in the other balances: the roundings of their tangents.
    np.testing.assert_allclose(sum(momenta), [[brought], [0.0]] * np.ones(1000), rtol=0, atol=1e-12)
    np.testing.assert_allclose(events["energy"] + events["recoil_energy"], energy + q, rtol=1e-14, atol=0)
    apart = momenta[0] / products[0] - momenta[1] / products[1]
    reduced = products[0] * products[1] / sum(products)
    left = energy + q - energy * m1 / sum(products)
    np.testing.assert_allclose(reduced * (apart**2).sum(axis=0) / 2.0, left, rtol=1e-12, atol=0)
