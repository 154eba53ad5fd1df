"""The Monte Carlo on any potential, of several energies, of two quantities, elsewhere, in pieces, and from a file."""

import os
import pickle
import signal
import subprocess
import sys
import threading
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

p = vv.potentials
BEAM = {"beam_energy": 1.5, "masses": (1.0, 4.0), "b_max": 3.0, "seed": 20_260_101}
LINES = vv.scattering.Spectrum([1.1, 1.5, 4.5], [1.0, 2.0, 1.0])
ALL = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]


def run(potential: object = p.LennardJones(1.0, 1.0), **changes: object) -> vv.scattering.MonteCarlo:
    return vv.scattering.monte_carlo(potential, **{**BEAM, "n_events": 100_000, **changes})


def listed(potential: object = p.LennardJones(1.0, 1.0), **changes: object) -> dict[str, np.ndarray]:
    return vv.scattering.scattering_events(potential, **{**BEAM, "n_events": 20_000, **changes})


POTENTIALS = [
    p.Yukawa(1.0, 1.0),
    p.LennardJones(1.0, 1.0),
    p.LennardJones(4.0, 1.0),  # below the energy up to which it orbits
    p.PowerLaw(-1.0, 4),  # captures
    p.HardSphere(1.0),
    p.SquareWell(1.0, 1.0),
    p.ScreenedCoulomb(1.0, 1.0, "zbl"),
    p.Plummer(1.0, 1.0),
    p.Coulomb(-1.0),
]


@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_events_are_those_of_direct_quadrature(potential: vv.potentials.Potential) -> None:
    """ψ of each event against `deflect`, and what follows from it. The table is certified to 4e-6 in sin²(ψ/2)."""
    events = listed(potential, n_events=3000)
    m1, m2 = BEAM["masses"]
    energy = BEAM["beam_energy"]
    direct = vv.scattering.deflect(
        potential, energy=energy * m2 / (m1 + m2), impact_parameter=events["impact_parameter"]
    )
    captured = direct.status == vv.scattering.DeflectionStatus.CAPTURED
    assert (np.isnan(events["deflection"]) == captured).all()
    psi, out = events["deflection"][~captured], direct.angle[~captured]
    assert np.abs(np.sin(psi / 2.0) ** 2 - np.sin(out / 2.0) ** 2).max() < 4e-6
    # Small angles keep their digits, but where the angle passes through 0.
    assert np.abs(psi - out).max() < 1e-5
    cm = events["cm_angle"][~captured]
    assert np.abs(np.cos(cm) - np.cos(psi)).max() < 1e-14
    # Momentum along and across the beam, and energy, to round-off of angles near π.
    speed, recoil = (np.sqrt(2.0 * events[name][~captured] / m) for name, m in (("energy", m1), ("recoil_energy", m2)))
    lab, other = events["lab_angle"][~captured], events["recoil_angle"][~captured]
    start = np.sqrt(2.0 * energy / m1)
    assert np.abs(m1 * speed * np.cos(lab) + m2 * recoil * np.cos(other) - m1 * start).max() < 1e-14 * m2
    assert np.abs(m1 * speed * np.sin(lab) - m2 * recoil * np.sin(other)).max() < 1e-14 * m2
    assert np.abs(events["energy"][~captured] + events["recoil_energy"][~captured] - energy).max() < 2e-15


@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
@pytest.mark.parametrize("energy", [1.5, LINES], ids=["one energy", "spectrum"])
def test_every_event_is_counted_in_its_bin(potential: vv.potentials.Potential, energy: object) -> None:
    first = 2**33 + 5
    pair = ("lab_angle", "energy")
    result = run(potential, n_events=20_000, beam_energy=energy, first_event=first, tally=[*ALL, pair], bins=37)
    events = listed(potential, beam_energy=energy, first_event=first)
    captured = int(np.isnan(events["deflection"]).sum())
    for name in ALL:
        tally = result[name]
        assert tally.counts.tolist() == np.histogram(events[name], tally.edges)[0].tolist(), name
        lost = captured if name != "impact_parameter" else 0
        assert (tally.underflow, tally.overflow, tally.captured) == (0, 0, lost)
    joint = result[pair]
    expected = np.histogram2d(events["lab_angle"], events["energy"], joint.edges)[0]
    assert (joint.counts == expected).all()
    assert (joint.flow.sum() + joint.captured, joint.captured) == (20_000, captured)
    assert (joint.counts.sum(1) == result["lab_angle"].counts).all()


def test_a_hard_sphere_scatters_into_all_directions_alike() -> None:
    """dσ/dΩ = R²/4; half of the disc of √2 R misses."""
    n = 10_000_000
    result = run(
        p.HardSphere(1.0), n_events=n, b_max=np.sqrt(2.0), tally={"cm_angle": np.arccos(np.linspace(1, -1, 51))}
    )
    counts = result["cm_angle"].values()
    hit = np.concatenate([[counts[0] - n / 2.0], counts[1:]])
    chi2 = ((hit - n / 100.0) ** 2 / (n / 100.0))[1:].sum()
    assert 18.0 < chi2 < 100.0  # 49 degrees of freedom: 1e-5 on either side


def test_langevin_capture() -> None:
    """σ = 2π√(C/E); of a disc of radius 3 at C = 1, E = 1.2."""
    n = 10_000_000
    tally = run(p.PowerLaw(-1.0, 4), n_events=n)["cm_angle"]
    part = 2.0 * np.sqrt(1.0 / 1.2) / 9.0
    assert abs(tally.captured - n * part) < 4.0 * np.sqrt(n * part * (1.0 - part))


def test_every_partition_thread_and_worker_gives_the_same() -> None:
    asked = {"beam_energy": LINES, "tally": ["cm_angle", ("lab_angle", "energy")], "n_events": 5_000_001, "bins": 60}
    whole = run(threads=1, **asked)
    assert all(run(threads=threads, **asked) == whole for threads in (2, 3))
    pieces = run(**{**asked, "n_events": 7})
    for more in (1, 2_000_000, 2_999_993):
        pieces = pieces.resume(more)
    assert pieces == whole
    with ThreadPoolExecutor(3) as pool:
        seen: list[tuple[int, int]] = []
        assert run(executor=pool, progress=lambda *done: seen.append(done), **asked) == whole
        assert seen[-1] == (5_000_001, 5_000_001)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        assert run(executor=pool, **asked) == whole


@pytest.mark.parametrize("simd", vv._core.info()["simd_available"])
def test_every_tier_gives_the_same(simd: str, tmp_path: Path) -> None:
    program = (
        "import visviva as vv, sys; s = vv.scattering; p = vv.potentials\n"
        "for i, potential in enumerate((p.LennardJones(4.0, 1.0), p.ScreenedCoulomb(1.0, 1.0, 'zbl'))):\n"
        "    lines = s.Spectrum([1.1, 1.5, 4.5], [1.0, 2.0, 1.0])\n"
        "    s.monte_carlo(potential, beam_energy=lines, masses=(1.0, 4.0), b_max=3.0, seed=9, "
        "n_events=300_001, tally=['lab_angle', ('energy', 'cm_angle')]).save(f'{sys.argv[1]}/{i}.npz')\n"
    )
    subprocess.run([sys.executable, "-c", program, tmp_path], env={**os.environ, "VISVIVA_SIMD": simd}, check=True)
    for i, potential in enumerate((p.LennardJones(4.0, 1.0), p.ScreenedCoulomb(1.0, 1.0, "zbl"))):
        here = run(potential, beam_energy=LINES, seed=9, n_events=300_001, tally=["lab_angle", ("energy", "cm_angle")])
        assert vv.scattering.MonteCarlo.load(tmp_path / f"{i}.npz") == here


class Dying(Executor):
    """Every second of its workers dies."""

    def __init__(self) -> None:
        self.number = 0

    def submit(self, function, /, *arguments, **keywords):  # type: ignore[no-untyped-def]
        self.number += 1
        future: Future[object] = Future()
        if self.number % 2:
            future.set_exception(BrokenProcessPool("gone"))
        else:
            future.set_result(function(*arguments, **keywords))
        return future


def test_what_a_lost_worker_had_is_counted_again() -> None:
    assert run(n_events=5_000_000, executor=Dying()) == run(n_events=5_000_000)


def test_results_are_kept_in_files_and_go_on(tmp_path: Path) -> None:
    result = run(beam_energy=LINES, tally=["cm_angle", ("lab_angle", "energy")])
    result.save(tmp_path / "counts.npz")
    again = vv.scattering.MonteCarlo.load(tmp_path / "counts.npz")
    assert again == result == pickle.loads(pickle.dumps(result))
    assert again.resume(5) == run(beam_energy=LINES, tally=["cm_angle", ("lab_angle", "energy")], n_events=100_005)
    for damage in (b"nothing", (tmp_path / "counts.npz").read_bytes()[:2000]):
        (tmp_path / "bad.npz").write_bytes(damage)
        with pytest.raises(vv.InvalidInput, match="path"):
            vv.scattering.MonteCarlo.load(tmp_path / "bad.npz")


def test_ctrl_c_keeps_what_came_before_too() -> None:
    before = run(n_events=1000)
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(vv.Interrupted) as caught:
            before.resume(10**11)
    finally:
        signal.signal(signal.SIGINT, previous)
    kept = caught.value.result
    assert kept.events == ((BEAM["seed"], 0, kept.next_event),)
    assert kept == run(n_events=kept.n_events)


def test_bins_that_the_disc_does_not_cover_have_no_cross_section() -> None:
    """Lennard-Jones inside its well: a small angle comes from within the disc, at the glory, and from beyond."""
    tally = run(b_max=1.3)["cm_angle"]
    value, _ = tally.cross_section()
    assert (np.isnan(value) == (tally.reachable < 1.0)).all()
    assert tally.covered[0] > 0.5
    assert set(tally.reachable.tolist()) == {0.0, 1.0}


@pytest.mark.parametrize("masses", [(1.0, 4.0), (1.0, 1.0), (4.0, 1.0)])
@pytest.mark.parametrize("radius", [1e-15, 1.0, 2.3])
def test_a_disc_as_wide_as_a_hard_sphere_knows_all_of_it(radius: float, masses: tuple[float, float]) -> None:
    """b_max = R: all that is scattered comes, and nothing else: R²/4 in every bin, the forward one too."""
    asked = {"beam_energy": 1.0, "masses": masses, "n_events": 400_000, "seed": 5, "bins": 6}
    tally = vv.scattering.monte_carlo(
        p.HardSphere(radius), b_max=radius, tally=["cm_angle", "lab_angle", "energy", "impact_parameter"], **asked
    )
    value, error = tally["cm_angle"].cross_section()
    assert (np.abs(value - 0.25 * radius**2) < 4.5 * error).all()
    assert (tally["cm_angle"].reachable == 1.0).all()
    for name in ("lab_angle", "energy", "impact_parameter"):
        one = tally[name]
        measure = vv._core.solid_angles(one.edges) if name == "lab_angle" else np.diff(one.edges)
        # Nuclei are 1e-30: pytest's own absolute tolerance of 1e-12 would pass anything.
        assert (one.cross_section().value * measure).sum() == pytest.approx(np.pi * radius**2, rel=1e-12, abs=0.0)
    # A wider one counts what flies by as well: that is no cross section.
    wide = vv.scattering.monte_carlo(p.HardSphere(radius), b_max=2.0 * radius, tally="cm_angle", **asked)
    assert np.isnan(wide["cm_angle"].cross_section().value).tolist() == [True, *[False] * 5]


def test_tables_are_known_by_their_hash() -> None:
    assert run(p.Coulomb(1.0)).beam.tables == ()
    tables = run(beam_energy=LINES).beam.tables
    assert len(set(tables)) == 3
    with pytest.raises(vv.InvalidInput, match="beam_energy"):
        _ = run(beam_energy=LINES) + run(first_event=100_000)


@pytest.mark.parametrize(
    ("argument", "changes"),
    [
        ("potential", {"potential": p.Morse}),
        ("potential", {"potential": p.Tabulated([1.0, 2.0, 3.0, 4.0], [4.0, 3.0, 2.0, 1.0])}),
        ("tally", {"tally": [("energy", "energy")]}),
        ("tally", {"tally": [("energy", "lab_angle", "cm_angle")]}),
        ("tally", {"tally": {("energy", "lab_angle"): 5}}),
        ("lab_angle", {"tally": {("energy", "lab_angle"): (5, [0.3, 0.2])}}),
        ("tally", {"tally": [("energy", "recoil_energy")], "bins": 2**16}),
        ("executor", {"executor": 3}),
        ("beam_energy", {"beam_energy": None}),
        ("b_max", {"b_max": np.inf}),
    ],
)
def test_refusals(argument: str, changes: dict[str, object]) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        run(**changes)
    assert caught.value.argument == argument


@pytest.mark.parametrize(("energy", "weight"), [([1.0], [1.0, 2.0]), ([], []), ([-1.0], [1.0]), ([1.0], [np.nan])])
def test_spectra_that_are_none(energy: list[float], weight: list[float]) -> None:
    with pytest.raises(vv.InvalidInput):
        vv.scattering.Spectrum(energy, weight)
