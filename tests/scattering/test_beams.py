"""Beams whose projectiles differ in energy, direction and place: their laws, closure, and that nothing asked for beside
changes an event.

Bounds: a χ² that a right simulation leaves but once in fifty thousand draws, of one seed.
"""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from kept_files import parts, written
from scipy import stats

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import philox

p, Spread = vv.potentials, vv.scattering.Spread
BEAM = {"beam_energy": 1.5, "masses": (1.0, 4.0), "b_max": 3.0, "seed": 20_260_101}
LINES = vv.scattering.Spectrum([1.5, 4.5], [1.0, 2.0])
ALL = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]
EVERYTHING = {"energy_spread": 0.05, "divergence": 0.02, "spot": 1.2}
POTENTIALS = [
    p.Coulomb(2.0),
    p.Coulomb(-1.0),
    p.Yukawa(1.0, 1.0),
    p.HardSphere(1.0),
    p.ScreenedCoulomb(1.0, 1.0, "zbl"),
]


def run(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> vv.scattering.MonteCarlo:
    return vv.scattering.monte_carlo(potential, **{**BEAM, "n_events": 30_000, **changes})


def listed(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> dict[str, np.ndarray]:
    return vv.scattering.scattering_events(potential, **{**BEAM, "n_events": 30_000, **changes})


def uniforms(seed: int, first: int, count: int, number: int) -> np.ndarray:
    """Draw `number` of each event, in NumPy: what `philox.rs` and `draws.rs` promise."""
    events = np.arange(first, first + count, dtype=np.uint64)
    counter = np.zeros((count, 4), np.uint64)
    counter[:, 0], counter[:, 1] = (events >> np.uint64(1)) & np.uint64(0xFFFFFFFF), events >> np.uint64(33)
    counter[:, 2] = number
    words = philox((seed & 0xFFFFFFFF, seed >> 32), counter)
    odd = (events & np.uint64(1)).astype(bool)
    low, high = np.where(odd, words[:, 2], words[:, 0]), np.where(odd, words[:, 3], words[:, 1])
    return ((high << np.uint64(32) | low) >> np.uint64(11)).astype(np.float64) * 2.0**-53


def test_each_number_is_for_one_thing() -> None:
    """Every draw of an event once more in NumPy, by the formulas that are promised."""
    first, n = 2**33 + 7, 2000
    u = [uniforms(BEAM["seed"], first, n, number) for number in range(6)]
    events = listed(p.Coulomb(2.0), beam_energy=LINES, first_event=first, n_events=n, **EVERYTHING)
    within = -np.expm1(-18.0)
    line = (u[1] >= 1.0 / 3.0).astype(int)
    energy = np.array(LINES.energy)[line] + 0.05 * np.sqrt(-2.0 * np.log1p(-u[2] * within)) * np.cos(2.0 * np.pi * u[3])
    tilt = 0.02 * np.sqrt(-2.0 * np.log1p(-u[4] * within))
    half = 0.5 * (3.0 / 1.2) ** 2
    b = 3.0 * np.sqrt(-np.log1p(u[0] * np.expm1(-half)) / half)
    assert (events["component"] == line).all()
    # Logarithms and cosines of NumPy and of visviva differ in their last bits; ln(1 − u) of small u in more.
    for name, value in (("beam_energy", energy), ("incidence", tilt), ("impact_parameter", b)):
        assert events[name] == pytest.approx(value, rel=1e-12, abs=1e-14), name
    # Directions as vectors: the incoming one in the plane of the axis, the plane of scattering by the azimuth.
    e = energy * 0.8
    psi = 2.0 * np.arctan2(2.0 / (2.0 * e), b)
    for name, sign, angle in (
        ("lab_angle", 1.0, np.arctan2(np.sin(psi), 0.25 + np.cos(psi))),
        ("recoil_angle", -1.0, (np.pi - psi) / 2.0),
    ):
        incoming = np.stack([np.sin(tilt), np.zeros(n), np.cos(tilt)], 1)
        ahead = np.stack([np.cos(tilt), np.zeros(n), -np.sin(tilt)], 1)
        aside = np.array([0.0, 1.0, 0.0])
        azimuth = 2.0 * np.pi * u[5][:, None]
        across = sign * (np.cos(azimuth) * ahead + np.sin(azimuth) * aside)
        out = np.cos(angle)[:, None] * incoming + np.sin(angle)[:, None] * across
        expected = np.arctan2(np.hypot(out[:, 0], out[:, 1]), out[:, 2])
        assert np.abs(events[name] - expected).max() < 1e-13


def test_what_is_asked_for_beside_changes_no_number() -> None:
    plain = listed(beam_energy=LINES)
    tilted = listed(beam_energy=LINES, divergence=0.02)
    for name in ("component", "beam_energy", "deflection", "cm_angle", "energy", "recoil_energy", "impact_parameter"):
        assert (plain[name] == tilted[name]).all(), name
    spread = listed(beam_energy=LINES, energy_spread=0.05)
    assert (plain["component"] == spread["component"]).all()
    assert (plain["impact_parameter"] == spread["impact_parameter"]).all()
    both = listed(beam_energy=LINES, energy_spread=0.05, divergence=0.02)
    for name in ("beam_energy", "deflection", "energy"):
        assert (spread[name] == both[name]).all(), name
    assert (both["incidence"] == tilted["incidence"]).all()
    whole = listed(beam_energy=LINES, **EVERYTHING)
    for name in ("beam_energy", "incidence"):
        assert (both[name] == whole[name]).all(), name


@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
@pytest.mark.parametrize("beam", [EVERYTHING, {"spot": 0.7}, {"divergence": Spread.uniform(0.3)}], ids=repr)
def test_every_event_is_counted_in_its_bin(potential: vv.potentials.Potential, beam: dict[str, object]) -> None:
    first, pair = 2**33 + 5, ("lab_angle", "energy")
    result = run(potential, first_event=first, tally=[*ALL, pair], bins=37, **beam)
    events = listed(potential, first_event=first, **beam)
    for name in ALL:
        tally = result[name]
        assert tally.counts.tolist() == np.histogram(events[name], tally.edges)[0].tolist(), name
        assert (tally.underflow, tally.overflow, tally.captured) == (0, 0, 0)
    expected = np.histogram2d(events["lab_angle"], events["energy"], result[pair].edges)[0]
    assert (result[pair].counts == expected).all()


@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_a_spot_has_its_head_on_events_behind(potential: vv.potentials.Potential) -> None:
    """The first draw of a spot is b = 0, whose angle is π, not −π: what begins and ends below an edge would all be."""
    edges = np.array([0.7, 1.4, np.pi])
    tally = run(potential, spot=1.2, tally="lab_angle", bins=edges)["lab_angle"]
    angle = listed(potential, spot=1.2)["lab_angle"]
    assert tally.counts.tolist() == np.histogram(angle, edges)[0].tolist()
    assert (tally.underflow, tally.overflow) == ((angle < edges[0]).sum(), 0)
    assert tally.counts.sum() > 0


@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_deflections_are_those_of_direct_quadrature_at_each_energy(potential: vv.potentials.Potential) -> None:
    """Certified to 4e-6 in sin²(ψ/2), with the energy of every event its own; and energy is kept to round-off."""
    events = listed(potential, n_events=3000, energy_spread=0.1, divergence=0.1)
    direct = vv.scattering.deflect(
        potential, energy=events["beam_energy"] * 0.8, impact_parameter=events["impact_parameter"]
    )
    off = np.sin(events["deflection"] / 2.0) ** 2 - np.sin(direct.angle / 2.0) ** 2
    assert np.abs(off).max() < 4e-6
    assert np.abs(events["energy"] + events["recoil_energy"] - events["beam_energy"]).max() < 2e-15


def test_spreads_have_their_laws() -> None:
    n = 200_000
    for spread, law in (
        (0.05, stats.norm(1.5, 0.05)),
        (Spread.uniform(0.2), stats.uniform(1.3, 0.4)),
    ):
        energy = listed(p.Coulomb(1.0), n_events=n, energy_spread=spread)["beam_energy"]
        assert stats.kstest(energy, law.cdf).pvalue > 1e-4
    tilt = listed(p.Coulomb(1.0), n_events=n, divergence=0.03)["incidence"]
    assert stats.kstest(tilt, stats.rayleigh(scale=0.03).cdf).pvalue > 1e-4
    tilt = listed(p.Coulomb(1.0), n_events=n, divergence=Spread.uniform(1.0))["incidence"]
    assert stats.kstest((1.0 - np.cos(tilt)) / (1.0 - np.cos(1.0)), "uniform").pvalue > 1e-4
    b = listed(p.Coulomb(1.0), n_events=n, spot=1.2)["impact_parameter"]
    part = np.expm1(-0.5 * (b / 1.2) ** 2) / np.expm1(-0.5 * (3.0 / 1.2) ** 2)
    assert stats.kstest(part, "uniform").pvalue > 1e-4
    assert b.max() <= 3.0
    # A spot much wider than the disc fills it evenly.
    wide, disc = (listed(p.Coulomb(1.0), n_events=1000, **more) for more in ({"spot": 3000.0}, {}))
    assert wide["impact_parameter"] == pytest.approx(disc["impact_parameter"], rel=1e-6, abs=0)


def test_an_isotropic_scatterer_stays_isotropic_in_a_diverging_beam() -> None:
    """Hard spheres on a heavy target scatter alike into all directions, wherever they come from."""
    tally = run(
        p.HardSphere(1.0), masses=(1.0, 1e12), b_max=1.0, n_events=1_000_000, divergence=0.2,
        tally="lab_angle", bins=vv.scattering.Bins.solid_angle(50),
    )["lab_angle"]  # fmt: skip
    chi2 = ((tally.values() - 20_000.0) ** 2 / 20_000.0).sum()
    assert 1e-5 < stats.chi2.sf(chi2, 49) < 1.0 - 1e-5


def test_a_spot_expects_what_it_counts() -> None:
    tally = run(p.LennardJones(1.0, 1.0), n_events=1_000_000, spot=1.0, bins=40)["cm_angle"]
    expected = tally.expected()
    many = expected > 10.0
    chi2 = ((tally.values() - expected)[many] ** 2 / expected[many]).sum()
    assert 1e-5 < stats.chi2.sf(chi2, many.sum()) < 1.0 - 1e-5
    with pytest.raises(vv.InvalidInput, match="evenly"):
        tally.cross_section()


def test_a_narrow_spread_has_the_cross_section_of_the_middle() -> None:
    tally = run(p.Coulomb(1.0), n_events=1_000_000, energy_spread=1e-3, tally={"cm_angle": np.linspace(0.5, 3.0, 9)})
    value, error = tally["cm_angle"].cross_section()
    law = run(p.Coulomb(1.0), tally={"cm_angle": np.linspace(0.5, 3.0, 9)})["cm_angle"]
    rings = vv._core.solid_angles(law.edges)
    assert (np.abs(value - law.expected() / law.n_events * np.pi * 9.0 / rings) < 4.5 * error).all()
    # A bin that the disc's edge cuts holds events of the higher energies from beyond what is covered.
    wide = run(p.Coulomb(1.0), energy_spread=0.1)["cm_angle"]
    assert set(wide.reachable.tolist()) == {0.0, 1.0}
    assert wide.counts[: int((wide.reachable == 0.0).sum())].any()
    smeared = run(p.Coulomb(1.0), divergence=0.01, tally="lab_angle")["lab_angle"]
    assert np.isnan(smeared.cross_section().value).all()
    with pytest.raises(vv.InvalidInput, match="divergence"):
        smeared.expected()


def test_every_partition_thread_and_worker_gives_the_same(tmp_path: Path) -> None:
    asked = {"tally": ["cm_angle", ("lab_angle", "energy")], "n_events": 1_200_001, "bins": 60, **EVERYTHING}
    whole = run(threads=1, **asked)
    assert all(run(threads=threads, **asked) == whole for threads in (2, 3))
    pieces = run(**{**asked, "n_events": 7})
    for more in (1, 600_000, 599_993):
        pieces = pieces.resume(more)
    assert pieces == whole
    with ThreadPoolExecutor(2) as pool:
        assert run(executor=pool, **asked) == whole
    whole.save(tmp_path / "counts.npz")
    again = vv.scattering.MonteCarlo.load(tmp_path / "counts.npz")
    assert again == whole
    assert again.beam.energy_spread == Spread.gaussian(0.05)
    with pytest.raises(vv.InvalidInput, match="divergence"):
        _ = whole + run(**{**asked, "divergence": 0.03}, first_event=1_200_001)


@pytest.mark.parametrize("simd", vv._core.info()["simd_available"])
def test_every_tier_gives_the_same(simd: str, tmp_path: Path) -> None:
    program = (
        "import visviva as vv, sys\n"
        "vv.scattering.monte_carlo(vv.potentials.Yukawa(1.0, 1.0), beam_energy=1.5, masses=(1.0, 4.0), b_max=3.0, "
        "seed=9, n_events=30_001, tally=['lab_angle', 'energy'], energy_spread=0.05, divergence=0.02, spot=1.2)"
        ".save(sys.argv[1])"
    )
    environment = {**os.environ, "VISVIVA_SIMD": simd}
    subprocess.run([sys.executable, "-c", program, tmp_path / "a.npz"], env=environment, check=True)
    here = run(seed=9, n_events=30_001, tally=["lab_angle", "energy"], **EVERYTHING)
    assert vv.scattering.MonteCarlo.load(tmp_path / "a.npz") == here


def test_files_of_the_first_version_load(tmp_path: Path) -> None:
    """They know no spread, no divergence and no spot."""
    result = run(p.Coulomb(1.0))
    result.save(tmp_path / "counts.npz")
    header, arrays = parts(tmp_path / "counts.npz")
    for name in ("energy_spread", "divergence", "spot"):
        del header[name]
    header["version"] = 1
    written(tmp_path / "first.npz", header, arrays)
    assert vv.scattering.MonteCarlo.load(tmp_path / "first.npz") == result


@pytest.mark.parametrize(
    ("argument", "changes"),
    [
        ("energy_spread", {"energy_spread": 0.0}),
        ("energy_spread", {"energy_spread": np.nan}),
        ("energy_spread", {"energy_spread": 0.25}),  # six of them reach 0
        ("energy_spread", {"energy_spread": Spread.uniform(1.5)}),
        ("divergence", {"divergence": -0.1}),
        ("divergence", {"divergence": 0.3}),
        ("divergence", {"divergence": Spread.uniform(2.0)}),
        ("divergence", {"divergence": "wide"}),
        ("spot", {"spot": 0.0}),
        ("spot", {"spot": 1e9}),
        ("energy", {"tally": {"energy": [0.0, 2.0]}, "energy_spread": 0.05}),
        ("recoil_angle", {"tally": {"recoil_angle": [0.0, 2.0]}}),
        ("spread", {"energy_spread": Spread}),
    ],
)
def test_refusals(argument: str, changes: dict[str, object]) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        run(**changes) if argument != "spread" else Spread()
    assert caught.value.argument == argument


def test_several_energies_are_a_spectrum() -> None:
    for several in ([1.0, 2.0], np.array([1.0, 2.0])):
        with pytest.raises(vv.InvalidInput, match=r"beam_energy: expected one number, or a Spectrum\(energy, weight\)"):
            vv.scattering.monte_carlo(
                vv.potentials.HardSphere(1.0),
                beam_energy=several,
                masses=(1.0, 4.0),
                b_max=1.0,
                n_events=10,
                seed=1,  # type: ignore[arg-type]
            )


def test_several_potentials_are_one_formula() -> None:
    several = [vv.potentials.Coulomb(1.0), vv.potentials.PowerLaw(1.0, 4.0)]
    with pytest.raises(vv.InvalidInput, match=r"their sum is one formula: vv.potentials.Custom\(lambda r"):
        vv.scattering.deflect(several, energy=1.0, impact_parameter=1.0)  # type: ignore[arg-type]
