"""The Monte Carlo: against the law, against NumPy event by event, and against itself divided in every way."""

import itertools
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import visviva as vv

BEAM = {"beam_energy": 1.5, "masses": (1.0, 4.0), "b_max": 3.0, "seed": 20_260_101}
TALLIES = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]


def run(k: float = 2.0, **changes: object) -> vv.scattering.MonteCarlo:
    return vv.scattering.monte_carlo(vv.potentials.Coulomb(k), **{**BEAM, "n_events": 100_000, **changes})


def half_distance(k: float = 2.0) -> float:
    m1, m2 = BEAM["masses"]
    return k / (2.0 * BEAM["beam_energy"] * m2 / (m1 + m2))


def philox(key: tuple[int, int], counter: np.ndarray) -> np.ndarray:
    """Philox 4x32-10 of counters of shape (n, 4), from the paper of Salmon et al."""
    x = counter.astype(np.uint64).T.copy()
    low = np.uint64(0xFFFFFFFF)
    k = list(key)
    for _ in range(10):
        p0, p1 = x[0] * np.uint64(0xD2511F53), x[2] * np.uint64(0xCD9E8D57)
        x = np.stack(
            [(p1 >> np.uint64(32)) ^ x[1] ^ np.uint64(k[0]), p1 & low,
             (p0 >> np.uint64(32)) ^ x[3] ^ np.uint64(k[1]), p0 & low]
        )  # fmt: skip
        k = [(k[0] + 0x9E3779B9) & 0xFFFFFFFF, (k[1] + 0xBB67AE85) & 0xFFFFFFFF]
    return x.T


def uniforms(seed: int, first: int, count: int) -> np.ndarray:
    """The number of each event: half a block, words low and high, its upper 53 bits."""
    events = np.arange(first, first + count, dtype=np.uint64)
    counter = np.zeros((count, 4), np.uint64)
    counter[:, 0], counter[:, 1] = (events >> np.uint64(1)) & np.uint64(0xFFFFFFFF), events >> np.uint64(33)
    words = philox((seed & 0xFFFFFFFF, seed >> 32), counter)
    odd = (events & np.uint64(1)).astype(bool)
    low, high = np.where(odd, words[:, 2], words[:, 0]), np.where(odd, words[:, 3], words[:, 1])
    return ((high << np.uint64(32) | low) >> np.uint64(11)).astype(np.float64) * 2.0**-53


def event_by_event(uniform: np.ndarray, k: float = 2.0) -> dict[str, np.ndarray]:
    m1, m2 = BEAM["masses"]
    b = BEAM["b_max"] * np.sqrt(uniform)
    psi = 2.0 * np.arctan2(abs(half_distance(k)), b)
    taken = BEAM["beam_energy"] * 4.0 * m1 * m2 / (m1 + m2) ** 2 * np.sin(psi / 2.0) ** 2
    return {
        "cm_angle": psi,
        "lab_angle": np.arctan2(np.sin(psi), m1 / m2 + np.cos(psi)),
        "recoil_angle": (np.pi - psi) / 2.0,
        "energy": BEAM["beam_energy"] - taken,
        "recoil_energy": taken,
        "impact_parameter": b,
    }


def test_numpy_philox_gives_the_known_answers() -> None:
    digits = np.array([[0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344]])
    assert philox((0xA4093822, 0x299F31D0), digits)[0].tolist() == [0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1]


@pytest.mark.parametrize(("first", "seed"), [(0, 1), (12_345, 2**63 + 12_345), (2**40 + 1, 7)])
@pytest.mark.parametrize("k", [2.0, -2.0])
def test_counts_are_those_of_numpy(first: int, seed: int, k: float) -> None:
    """Every event in its bin. NumPy's sines differ in the last bits, so the one chance for a difference
    is an event within 1e-15 of an edge: none in these runs."""
    result = run(k, tally=TALLIES, first_event=first, seed=seed)
    values = event_by_event(uniforms(seed, first, 100_000), k)
    for name in TALLIES:
        tally = result[name]
        expected, _ = np.histogram(values[name], tally.edges)
        assert tally.counts.tolist() == expected.tolist(), name
        assert (tally.underflow, tally.overflow) == (0, 0)


def test_uneven_edges_underflow_and_overflow() -> None:
    edges = [0.9, 1.0, 1.5, 3.0]
    tally = run(tally={"cm_angle": edges})["cm_angle"]
    angles = event_by_event(uniforms(BEAM["seed"], 0, 100_000))["cm_angle"]
    assert tally.counts.tolist() == np.histogram(angles, edges)[0].tolist()
    assert (tally.underflow, tally.overflow) == ((angles < 0.9).sum(), (angles > 3.0).sum())


@pytest.mark.parametrize("masses", [(1.0, 4.0), (1.0, 1.0), (4.0, 1.0), (1.0, 1e12), (1e6, 1.0)])
def test_counts_follow_rutherfords_law(masses: tuple[float, float]) -> None:
    """P(|ψ| > ψ₀) = (b(ψ₀)/b_max)² in the centre-of-mass frame, in 60 bins of equal probability.

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


def test_every_partition_gives_the_same_counts() -> None:
    whole = run(n_events=3_000_001, tally=TALLIES, threads=1)
    for threads in (2, 3):
        other = run(n_events=3_000_001, tally=TALLIES, threads=threads)
        assert all((whole[name].counts == other[name].counts).all() for name in TALLIES)
    cuts = [0, 1, 1000, 1_500_001, 3_000_001]
    parts = [run(n_events=end - start, first_event=start, tally=TALLIES) for start, end in itertools.pairwise(cuts)]
    total = parts[2] + parts[0] + parts[3] + parts[1]
    assert total.events == whole.events
    assert all((whole[name].counts == total[name].counts).all() for name in TALLIES)


@pytest.mark.parametrize("simd", vv._core.info()["simd_available"])
def test_every_tier_gives_the_same_counts(simd: str) -> None:
    program = (
        "import visviva as vv; r = vv.scattering.monte_carlo(vv.potentials.Coulomb(2.0), beam_energy=1.5, "
        "masses=(1.0, 4.0), b_max=3.0, seed=9, n_events=500_001, first_event=77, tally=['lab_angle', 'energy']); "
        "print(vv._core.info()['simd'], r['lab_angle'].counts.tolist(), r['energy'].counts.tolist(), "
        "[e.hex() for e in r['energy'].edges])"
    )
    environment = {**os.environ, "VISVIVA_SIMD": simd}
    printed = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, check=True).stdout
    here = run(seed=9, n_events=500_001, first_event=77, tally=["lab_angle", "energy"])
    numbers = f"{here['lab_angle'].counts.tolist()} {here['energy'].counts.tolist()} "
    edges = f"{[float(edge).hex() for edge in here['energy'].edges]}"
    assert printed.decode().strip() == f"{simd} {numbers}{edges}"


@settings(max_examples=25)
@given(st.integers(1, 20_000), st.integers(0, 2**62), st.data())
def test_ranges_of_events_add(count: int, first: int, data: st.DataObject) -> None:
    cut = data.draw(st.integers(0, count - 1))
    whole = run(n_events=count, first_event=first)
    parts = run(n_events=count - cut, first_event=first + cut)
    if cut:
        parts = parts + run(n_events=cut, first_event=first)
    assert (whole["cm_angle"].counts == parts["cm_angle"].counts).all()
    assert whole.n_events == parts.n_events == whole["cm_angle"].n_events


@pytest.mark.parametrize("masses", [(1.0, 1e300), (1e-300, 1.0), (1.0, 1.0), (1e5, 1.0), (1e200, 1e200)])
@pytest.mark.parametrize("k", [1e-3, -1e-3, 1e3])
def test_extreme_masses_and_potentials_lose_no_event(masses: tuple[float, float], k: float) -> None:
    result = run(k, masses=masses, tally=TALLIES, n_events=10_000)
    for tally in result.values():
        assert int(tally.counts.sum()) == 10_000
        assert np.isfinite(tally.edges).all()


def test_a_result_keeps_what_it_is() -> None:
    result = run(tally=["cm_angle", "energy"], bins=20)
    copy = pickle.loads(pickle.dumps(result))
    assert list(copy) == ["cm_angle", "energy"]
    assert len(copy["energy"].edges) == 21
    assert (copy["cm_angle"].counts == result["cm_angle"].counts).all()
    assert copy.events == result.events == ((BEAM["seed"], 0, 100_000),)
    assert "100000 events" in repr(result)
    assert result["cm_angle"].counts.dtype == np.uint64
    tally = result["cm_angle"]
    share = tally.values() / 100_000
    assert tally.variances() == pytest.approx(100_000 * share * (1.0 - share), rel=1e-14)
    # All that is counted is the disc: Σ dσ/dΩ ΔΩ = π b_max².
    value, _ = tally.cross_section()
    total = (value * -2.0 * np.pi * np.diff(np.cos(tally.edges))).sum()
    assert total == pytest.approx(np.pi * BEAM["b_max"] ** 2, rel=1e-12)


@pytest.mark.parametrize(
    ("argument", "changes"),
    [
        ("beam_energy", {"beam_energy": 0.0}),
        ("beam_energy", {"beam_energy": np.nan}),
        ("beam_energy", {"beam_energy": 1e-308}),
        ("masses", {"masses": (1.0, -1.0)}),
        ("masses", {"masses": 1.0}),
        ("b_max", {"b_max": -1.0}),
        ("b_max", {"b_max": 1e200}),
        ("n_events", {"n_events": 0}),
        ("n_events", {"n_events": 1e6}),
        ("n_events", {"n_events": 2**64}),
        ("seed", {"seed": -1}),
        ("seed", {"seed": None}),
        ("first_event", {"first_event": -1}),
        ("tally", {"tally": "angle"}),
        ("tally", {"tally": []}),
        ("tally", {"tally": 3}),
        ("tally", {"tally": ["energy", "energy"]}),
        ("cm_angle", {"tally": {"cm_angle": [1.0]}}),
        ("cm_angle", {"tally": {"cm_angle": [1.0, 1.0]}}),
        ("cm_angle", {"tally": {"cm_angle": [1.0, np.inf]}}),
        ("bins", {"bins": 0}),
        ("bins", {"bins": True}),
        ("threads", {"threads": 0}),
        ("progress", {"progress": 1}),
    ],
)
def test_refusals(argument: str, changes: dict[str, object]) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        run(**changes)
    expected = "b_max" if changes == {"beam_energy": 1e-308} else argument
    assert caught.value.argument == expected


def test_other_potentials_and_double_counting_are_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="potential"):
        vv.scattering.monte_carlo(vv.potentials.Yukawa(1.0, 1.0), **BEAM, n_events=1)
    with pytest.raises(vv.InvalidInput, match="potential"):
        run(0.0)
    with pytest.raises(vv.InvalidInput, match="in both"):
        _ = run() + run(first_event=99_999)
    with pytest.raises(vv.InvalidInput, match="b_max"):
        _ = run() + run(b_max=2.0, first_event=100_000)
    with pytest.raises(vv.InvalidInput, match="edges"):
        _ = run() + run(bins=10, first_event=100_000)
    with pytest.raises(KeyError, match="cm_angle"):
        run()["energy"]


def test_progress_is_reported_and_can_stop_the_run() -> None:
    seen: list[tuple[int, int]] = []
    run(progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (100_000, 100_000)

    def stop(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        run(n_events=10**12, progress=stop)
