"""Events where they are wanted: strata of the impact parameter change no mean, and no bit hangs on who runs them."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import uniforms

p, S = vv.potentials, vv.scattering
BEAM = {"beam_energy": 1.5, "masses": (1.0, 4.0), "b_max": 3.0, "seed": 20_260_101}
STRATA = S.Strata([0.0, 1e-3, 0.1, 1.0, 3.0], [1.0, 2.0, 2.0, 1.0])
ALL = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]
PAIR = ("lab_angle", "energy")
POTENTIALS = [
    p.Coulomb(2.0),
    p.Coulomb(-1.0),
    p.Yukawa(1.0, 1.0),
    p.HardSphere(1.0),
    p.LennardJones(1.0, 1.0),  # a rainbow
    p.PowerLaw(-1.0, 4.0),  # captures
]
BEAMS = [
    {},
    {"beam_energy": S.Spectrum([1.5, 4.5], [1.0, 2.0])},
    {"divergence": 0.02},
    {"masses": (4.0, 1.0)},
]


def run(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> S.MonteCarlo:
    return S.monte_carlo(potential, **{**BEAM, "n_events": 40_000, "importance": STRATA, **changes})


def listed(potential: object = p.Yukawa(1.0, 1.0), **changes: object) -> dict[str, np.ndarray]:
    return S.scattering_events(potential, **{**BEAM, "n_events": 40_000, "importance": STRATA, **changes})


def test_the_draw_is_mapped_ring_by_ring() -> None:
    """b of every event once more in NumPy, from draw number 0; weights from the boundaries as whole numbers."""
    first, n = 2**33 + 7, 5000
    events = listed(first_event=first, n_events=n)
    u = uniforms(BEAM["seed"], first, n)
    starts = np.array([round(part * 2**53) for part in (0.0, 1 / 6, 3 / 6, 5 / 6, 1.0)], dtype=np.uint64)
    ring = np.searchsorted(starts, (u * 2.0**53).astype(np.uint64), side="right") - 1
    part = (u * 2.0**53 - starts[ring].astype(float)) / np.diff(starts)[ring]
    squares = np.array(STRATA.edges) ** 2
    b = np.sqrt(squares[ring] + np.diff(squares)[ring] * part)
    assert events["impact_parameter"] == pytest.approx(b, rel=1e-14, abs=0)
    exact = [
        (Fraction(b) ** 2 - Fraction(a) ** 2) / 9 * 2**53 / (int(end) - int(start))
        for a, b, start, end in zip(STRATA.edges, STRATA.edges[1:], starts, starts[1:], strict=False)
    ]
    assert STRATA.weights == pytest.approx([float(weight) for weight in exact], rel=1e-15, abs=0)
    assert (events["weight"] == STRATA.weights[ring]).all()


def test_no_other_number_of_an_event_changes() -> None:
    how = {"beam_energy": BEAMS[1]["beam_energy"], "energy_spread": 0.05, "divergence": 0.02}
    weighted, plain = listed(**how), listed(**how, importance=None)
    assert list(weighted) == ["event", "component", "weight", *list(plain)[2:]]
    for name in ("event", "component", "beam_energy", "incidence"):
        assert (weighted[name] == plain[name]).all(), name


def test_one_ring_is_the_run_without() -> None:
    one, plain = run(tally=[*ALL, PAIR], importance=S.Strata([0.0, 3.0])), run(tally=[*ALL, PAIR], importance=None)
    for name in plain:
        assert (one[name].counts == plain[name].counts).all()
        assert (one[name].values() == plain[name].values()).all()
        # n − n²/N in the one, n (1 − n/N) in the other.
        assert one[name].variances() == pytest.approx(plain[name].variances(), rel=1e-14, abs=0)


@pytest.mark.parametrize("beam", BEAMS, ids=repr)
@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_every_event_is_counted_in_its_bin_and_stratum(potential: object, beam: dict[str, object]) -> None:
    """Whether looked up or followed: the counts of each stratum are those of the events that have its weight."""
    first = 2**33 + 5
    result = run(potential, first_event=first, tally=[*ALL, PAIR], bins=37, **beam)
    events = listed(potential, first_event=first, **beam)
    for ring, weight in enumerate(STRATA.weights):
        mine = events["weight"] == weight
        for name in ALL:
            tally = result[name]
            values = events[name][mine]
            here = np.histogram(values, tally.edges)[0]
            assert tally.by_stratum[ring, 1:-2].tolist() == here.tolist(), (name, ring)
            assert tally.by_stratum[ring, -1] == np.isnan(values).sum()
        table = result[PAIR].by_stratum[ring, :-1].reshape(39, 39)[1:-1, 1:-1]
        assert (table == np.histogram2d(events["lab_angle"][mine], events["energy"][mine], result[PAIR].edges)[0]).all()
    for tally in result.tallies:
        assert tally.by_stratum.sum() == 40_000
    one = result["cm_angle"]
    assert (one.by_stratum.sum(0)[1:-2] == one.counts).all()
    assert one.by_stratum[:, -1].sum() == one.captured
    bins = np.digitize(events["cm_angle"], one.edges)  # NaN is beyond all
    weights = np.bincount(bins, events["weight"], minlength=39)[1:-1]
    assert one.values() == pytest.approx(weights[:37], rel=1e-11, abs=0)  # sums of up to 40 000 numbers


@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_means_are_those_without(potential: object) -> None:
    """`expected` is the same function of the same disc, of 2⁵³ draws in other places: equal as far as the pieces of a
    table meet, which are refined to 1e-9 of the angles."""
    for beam in ({}, BEAMS[1], BEAMS[3]):
        weighted, plain = (run(potential, bins=20, n_events=200_000, **beam, importance=i) for i in (STRATA, None))
        mean, before = weighted["cm_angle"].expected(), plain["cm_angle"].expected()
        assert mean == pytest.approx(before, rel=1e-8, abs=1e-9)
        # Five of its own standard deviations, of a seed that is fixed, in every bin of which enough was counted.
        tally = weighted["cm_angle"]
        known = tally.counts > 30
        off = (tally.values() - mean)[known] / np.sqrt(tally.variances()[known] + 1e-300)
        assert known.any()
        assert np.abs(off).max() < 5.0, off


def test_variances_are_those_of_many_runs() -> None:
    """400 runs: the spread of the values is what `variances` says on the average, to 4 of its own errors."""
    edges = np.radians([10.0, 40.0, 90.0, 150.0, 180.0])
    runs = [run(p.Coulomb(2.0), n_events=500, seed=seed, tally={"cm_angle": edges})["cm_angle"] for seed in range(400)]
    values, told = np.array([r.values() for r in runs]), np.array([r.variances() for r in runs])
    ratio = values.var(axis=0, ddof=1) / told.mean(axis=0)
    assert np.abs(ratio - 1.0).max() < 4.0 * np.sqrt(2.0 / 399.0), ratio
    off = (values.mean(axis=0) - runs[0].expected()) / np.sqrt(told.mean(axis=0) / 400)
    assert np.abs(off).max() < 4.0


def test_backscattering_to_a_thousandth() -> None:
    """Rutherford past 90°: πκ², of a disc 10⁵ times as large. Without strata it would take 10¹¹ events."""
    kappa = 2.0 / (2.0 * 1.5 * 0.8)
    for seed in (1, 2, 3):
        halves, forced = {"cm_angle": [0.0, np.pi / 2.0, np.pi]}, S.LargeAngles(np.pi / 2.0)
        out = run(p.Coulomb(2.0), b_max=316.0 * kappa, seed=seed, n_events=1_500_000, tally=halves, importance=forced)
        value, error = out["cm_angle"].cross_section()
        value, error = 2.0 * np.pi * value[1], 2.0 * np.pi * error[1]
        # Half of the events go there: √(½ / (½ · 1.5e6)) = 8.2e-4 of the value; without strata 1/√(1.5e6 · 1e-5).
        assert error < 1e-3 * value
        assert abs(value - np.pi * kappa**2) < 3.0 * error
        plain = 316.0**2 * (np.pi * kappa**2) ** 2 / 1_500_000
        assert error**2 < 1e-4 * plain


def test_the_gold_foil_of_single_collisions() -> None:
    """The reference number: 0.4 µm of gold, 7.687 MeV, past 90° in the center-of-mass frame: nuclei on an area that
    has as many as the foil has on it, πb² = 1/(n t) for each."""
    per_area = 0.059 * 4000.0  # 5.9e22 to a cubic centimeter: in Å⁻³, and of 4000 Å
    strength = 2.0 * 79.0 * 14.3996454844  # eV Å
    for seed in (1, 2, 3):
        out = S.monte_carlo(
            p.Coulomb(strength), beam_energy=7.687e6, masses=(4.001506179, 196.923232301), seed=seed,
            b_max=1.0 / np.sqrt(np.pi * per_area), n_events=1_500_000, importance=S.LargeAngles(np.pi / 2.0),
            tally={"cm_angle": [0.0, np.pi / 2.0, np.pi]})  # fmt: skip
        tally = out["cm_angle"]
        value, error = tally.values()[1] / out.n_events, np.sqrt(tally.variances()[1]) / out.n_events
        assert error < 1e-3 * value
        assert abs(value - 1.690358e-5) < 3.0 * error, (seed, value, error)


def test_a_stratum_of_a_disc_of_atoms() -> None:
    """1e-40 of the disc: near head-on the deflection is π − 2b/κ, and b keeps its digits."""
    kappa = 2.0 / (2.0 * 1.5 * 0.8)
    events = listed(p.Coulomb(2.0), importance=S.Strata([0.0, 3e-20, 3.0]), n_events=1000)
    inner = events["weight"] < 1e-30
    b = events["impact_parameter"][inner]
    assert 400 < inner.sum() < 600
    assert b.max() < 3e-20
    assert len(set(b)) == inner.sum()
    # The recoil angle is (π − ψ)/2 = atan(b/κ): relative precision at the end where π − ψ vanishes.
    assert events["recoil_angle"][inner] == pytest.approx(b / kappa, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("beam", BEAMS[:3], ids=repr)
def test_bits_hang_on_nothing(beam: dict[str, object], tmp_path: Path) -> None:
    how = {**beam, "tally": ["cm_angle", PAIR], "bins": 30}
    whole = run(**how, threads=1)
    for threads in (2, 3):
        assert run(**how, threads=threads) == whole
    pieces = run(**how, n_events=11) + run(**how, first_event=11, n_events=29_989)
    assert pieces.resume(10_000) == whole
    with ThreadPoolExecutor(2) as pool:
        assert run(**how, executor=pool) == whole
    whole.save(tmp_path / "counts.npz")
    again = S.MonteCarlo.load(tmp_path / "counts.npz")
    assert again == whole
    assert again.beam.importance == STRATA
    assert (again["cm_angle"].values() == whole["cm_angle"].values()).all()
    assert not whole["cm_angle"].by_stratum.flags.writeable
    assert whole != run(**how, importance=None)


def test_bits_do_not_hang_on_the_processor() -> None:
    code = """if True:
        import hashlib, visviva as vv
        S, digest = vv.scattering, hashlib.sha256()
        for potential in (vv.potentials.Coulomb(2.0), vv.potentials.LennardJones(1.0, 1.0)):
            for importance in (S.LargeAngles(1.0), S.Strata.logarithmic(20, 1e-9, 3.0)):
                run = S.monte_carlo(potential, beam_energy=1.5, masses=(1.0, 4.0), b_max=3.0, n_events=20_000, seed=5,
                    bins=40, importance=importance, divergence=0.01, tally=["lab_angle", "energy"])
                for name in run:
                    digest.update(run[name].by_stratum.tobytes() + run[name].values().tobytes())
        print(digest.hexdigest())
    """
    told = [
        subprocess.run(
            [sys.executable, "-c", code], env={**os.environ, **extra}, check=True, capture_output=True, timeout=120
        ).stdout
        for extra in ({}, {"VISVIVA_SIMD": "portable", "VISVIVA_THREADS": "1"})
    ]
    assert told[0] == told[1]


def test_results_of_other_strata_do_not_add() -> None:
    mine = run(n_events=100)
    for other in (None, S.Strata([0.0, 1.0, 3.0])):
        with pytest.raises(vv.errors.InvalidInput, match="importance") as refused:
            mine + run(n_events=100, first_event=100, importance=other)
        assert refused.value.argument == "other"


def test_large_angles_take_every_branch_and_energy() -> None:
    """Beyond the boundary nothing is deflected as far, at any energy; within it some is."""
    for potential in POTENTIALS:
        for beam in ({}, BEAMS[1], {"energy_spread": 0.01}):
            events = listed(potential, importance=S.LargeAngles(0.7, 0.3), **beam)
            inner = events["weight"] == events["weight"][events["impact_parameter"].argmin()]
            assert abs(inner.mean() - 0.3) < 0.012  # five standard deviations
            assert not (events["cm_angle"][~inner] > 0.7 + 1e-6).any()
            assert (~(events["cm_angle"][inner] < 0.7)).any()


def test_weights_go_into_tables_and_histograms() -> None:
    result = run(tally=["cm_angle", PAIR], bins=12)
    for name in ("cm_angle", PAIR):
        tally = result[name]
        data = pytest.importorskip("xarray") and tally.to_xarray()
        assert (data["values"].to_numpy() == tally.values()).all()
        assert (data["variances"].to_numpy() == tally.variances()).all()
        filled = pytest.importorskip("hist") and tally.to_hist()
        assert (filled.values() == tally.values()).all()
        # Every event is somewhere: the weights of all, under- and overflow too.
        weights = STRATA.weights
        total = sum(weight * count for weight, count in zip(weights, tally.by_stratum.sum(1).tolist(), strict=True))
        assert filled.sum(flow=True).value == pytest.approx(total, rel=1e-13, abs=0)
        assert (filled.variances() >= tally.variances()).all()
    frame = pytest.importorskip("pandas") and result["cm_angle"].to_pandas()
    assert list(frame) == ["counts", "reachable", "values", "variances"]
    assert (result[PAIR].to_pandas().to_numpy() == result[PAIR].values()).all()


def test_events_go_into_a_file(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    listed(n_events=100, to=tmp_path / "events.parquet")
    assert (
        parquet.read_table(tmp_path / "events.parquet")["weight"].to_numpy().tolist()
        == listed(n_events=100)["weight"].tolist()
    )


def test_intervals_of_counts_are_not_those_of_weights() -> None:
    with pytest.raises(vv.errors.InvalidInput, match="variances"):
        run()["cm_angle"].poisson_interval()


def test_pictures_show_weighted_counts() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    axes = run(bins=20)["cm_angle"].plot()
    assert "one standard deviation" in [text.get_text() for text in axes.get_legend().get_texts()]


@pytest.mark.parametrize(
    ("changes", "argument", "words"),
    [
        ({"importance": 0.5}, "importance", "Strata, LargeAngles or None"),
        ({"importance": S.Strata([0.0, 1.0])}, "importance", "b_max = 3.0"),
        ({"spot": 1.0}, "importance", "spot"),
        ({"importance": S.LargeAngles(1e-3)}, "importance", "greater angle"),
        ({"potential": p.Plummer(0.1, 1.0), "importance": S.LargeAngles(2.0)}, "importance", "no deflection"),
        ({"importance": S.LargeAngles(1.0), "beam_energy": -1.0}, "beam_energy", "positive"),
        ({"importance": S.LargeAngles(1.0), "masses": (1.0, 0.0)}, "masses", "positive"),
        (
            {"importance": S.Strata.logarithmic(1000, 1e-6, 3.0), "tally": [PAIR], "bins": 200},
            "importance",
            r"1000 strata of 40805 bins",
        ),
    ],
)
def test_what_cannot_be_is_refused_by_name(changes: dict[str, object], argument: str, words: str) -> None:
    with pytest.raises(vv.errors.InvalidInput, match=words) as refused:
        run(**changes)
    assert refused.value.argument == argument


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda: S.Strata([0.1, 1.0]), "edges"),
        (lambda: S.Strata([0.0, 2.0, 1.0]), "edges"),
        (lambda: S.Strata([0.0]), "edges"),
        (lambda: S.Strata([0.0, np.nan]), "edges"),
        (lambda: S.Strata([0.0, 1.0, 2.0], [1.0, 0.0]), "fractions"),
        (lambda: S.Strata([0.0, 1.0, 2.0], [1.0, 1e-7]), "fractions"),
        (lambda: S.Strata([0.0, 1.0, 2.0], [1.0]), "fractions"),
        (lambda: S.Strata.logarithmic(1, 0.1, 1.0), "n"),
        (lambda: S.Strata.logarithmic(5, 1.0, 1.0), "smallest"),
        (lambda: S.LargeAngles(90.0), "smallest_angle"),
        (lambda: S.LargeAngles(1.0, 1.0), "fraction"),
        (lambda: S.LargeAngles(1.0, 1e-7), "fraction"),
    ],
)
def test_what_are_no_strata_is_refused(make: object, argument: str) -> None:
    with pytest.raises(vv.errors.InvalidInput) as refused:
        make()
    assert refused.value.argument == argument
