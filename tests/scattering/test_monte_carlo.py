"""The Monte Carlo: against NumPy event by event, and against itself divided in every way."""

import itertools
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kept_files import the_old_file_stays

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import BEAM, TALLIES, event_by_event, philox, run, uniforms


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


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = vv.scattering.monte_carlo(
        vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=10, seed=1
    )
    the_old_file_stays(tmp_path / "counts.npz", result, result, monkeypatch)
