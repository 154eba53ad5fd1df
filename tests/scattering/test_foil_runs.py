"""Runs of foils: bits that depend on nothing but the seed, the draws as written down, interrupts and progress.

Bounds: a logarithm and a root of the same draw, 1e-14.
"""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import philox

S = vv.scattering


ASKED = {"beam_energy": 1e5, "seed": 7, "tally": {"lab_angle": 60, "transmitted_energy": 50, "stopped_depth": 20}}


@pytest.mark.parametrize("forced", [None, 0.4])
def test_same_bits_for_any_threads_and_pieces(forced):
    foil = S.Foil("water", 0.2, minimum_angle=3e-3)
    whole = foil.run("proton", n_events=4501, threads=1, forced_angle=forced, **ASKED)
    for threads in (2, 3):
        assert foil.run("proton", n_events=4501, threads=threads, forced_angle=forced, **ASKED) == whole
    pieces = [
        foil.run("proton", n_events=count, first_event=first, forced_angle=forced, **ASKED)
        for first, count in ((3000, 1501), (0, 7), (7, 2993))
    ]
    assert sum(pieces) == whole
    assert whole.next_event == 4501
    assert pickle.loads(pickle.dumps(whole)) == whole
    with pytest.raises(vv.InvalidInput, match="event 0 of seed 7 is in both"):
        whole + pieces[1]
    with pytest.raises(vv.InvalidInput, match=f"^other: expected the same forced_angle, {forced}, got 0.7"):
        whole + foil.run("proton", n_events=5, first_event=9000, forced_angle=0.7, **ASKED)


def test_same_bits_on_every_tier():
    code = (
        "import visviva as vv\n"
        "foil = vv.scattering.Foil('water', 0.5, minimum_angle=1e-3)\n"
        "out = foil.run('proton', beam_energy=1e5, n_events=300, seed=7)\n"
        "print([tally.sums.tolist() for tally in out.tallies])"
    )
    found = {
        tier: subprocess.run(
            [sys.executable, "-c", code], env=os.environ | {"VISVIVA_SIMD": tier}, capture_output=True, check=True
        ).stdout
        for tier in ("portable", "avx2")
    }
    assert len(set(found.values())) == 1


def test_the_first_counts_stay_what_they_are():
    """Draws and streams are a promise: these numbers were published with this seed."""
    foil = S.Foil("gold", 0.05, potential="coulomb", stopping="none", minimum_angle=5e-3)
    out = foil.run("alpha", beam_energy=1e6, n_events=200, seed=1, tally={"transmitted_angle": [0, 0.1, 0.2, 0.4, 3]})
    assert out["transmitted_angle"].sums[:, 0].tolist() == KNOWN
    assert foil.history("alpha", beam_energy=1e6, seed=1)["impact_parameter"][:2].tolist() == KNOWN_RADII


KNOWN = [0, 184, 14, 2, 0, 0]


KNOWN_RADII = [0.4411421340072406, 0.2455261046848209]


def test_draws_are_where_they_are_written_down():
    """Draw 4 is the way to the first collision, 5 its b², of event/2 in stream 1: against NumPy's own cipher."""
    foil = S.Foil("gold", 0.4, potential="coulomb", stopping="none", minimum_angle=5e-3)
    seed = 2**63 + 12_345
    path, radius = [], []
    for event in (2**34 + 6, 2**34 + 7):
        way = foil.history("alpha", beam_energy=1e6, seed=seed, event=event)
        counters = np.array([[(event // 2) & 0xFFFFFFFF, event // 2 >> 32, draw, 1] for draw in (4, 5)])
        words = philox((seed & 0xFFFFFFFF, seed >> 32), counters)[:, 2 * (event % 2) :].astype(np.uint64)
        uniform = ((words[:, 1] << np.uint64(32) | words[:, 0]) >> np.uint64(11)) / 2.0**53
        path.append(way["path"][0] / -np.log1p(-uniform[0]))
        radius.append(way["impact_parameter"][0] / np.sqrt(uniform[1]))
    assert path[0] == pytest.approx(path[1], rel=1e-14, abs=0)
    assert radius[0] == pytest.approx(radius[1], rel=1e-14, abs=0)
    # The disc holds what turns by the minimum angle, and little more: a cell of energies is 6 %, and 3 % are beside.
    kappa = 2 * 79 * 14.399645478 / (2 * 1e6 / (1 + 4.001506179127 / 196.96657))
    assert 1.0 < radius[0] / (kappa / np.tan(2.5e-3)) < 1.1
    # And the mean way is that of it.
    number = foil.material.number_density
    assert path[0] * 1e4 == pytest.approx(1.0 / (number * np.pi * radius[0] ** 2), rel=1e-14, abs=0)


@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_keeps_what_is_counted(threads):
    foil = S.Foil("gold", 0.4)
    asked = {"beam_energy": 7.687e6, "n_events": 40_000, "seed": 1, "tally": "transmitted_angle"}
    seen = []

    def stop(done, _):
        seen.append(done)
        if done > 15_000:
            raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted) as caught:
        foil.run("alpha", progress=stop, threads=threads, **asked)
    part = caught.value.result
    assert 0 < part.n_events < 40_000
    if threads == 1:  # of several a chunk of each is lost, and what others do while one waits for its turn
        assert part.n_events >= seen[-1]
    again = foil.run("alpha", **(asked | {"n_events": part.n_events}))
    assert again == part


def test_progress_reaches_the_end():
    seen = []
    foil = S.Foil("gold", 0.1, minimum_angle=1e-3)
    foil.run("alpha", beam_energy=1e6, n_events=3000, seed=1, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (3000, 3000)
    assert all(total == 3000 and done <= total for done, total in seen)


@pytest.mark.parametrize("forced", [None, 0.4])
def test_histograms_go_to_hist_xarray_and_pandas(forced):
    """The numbers of the tally itself; with what is outside they are all ions, whose weights add up to the fraction."""
    hist, pandas = pytest.importorskip("hist"), pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    foil = S.Foil("water", 0.2, minimum_angle=3e-3)
    out = foil.run("proton", n_events=2000, forced_angle=forced, **(ASKED | {"tally": {"transmitted_angle": [0.1, 1]}}))
    tally = out["transmitted_angle"]
    assert min(tally.underflow + tally.overflow, tally.counts.sum()) > 0
    filled, data, frame = tally.to_hist(), tally.to_xarray(), tally.to_pandas()
    assert isinstance(filled, hist.Hist)
    assert (filled.axes[0].name, filled.axes[0].edges.tolist()) == ("transmitted_angle", [0.1, 1.0])
    assert (data["transmitted_angle"].units, data.attrs) == ("rad", frame.attrs)
    assert frame.attrs == {"underflow": tally.underflow, "overflow": tally.overflow, "n_events": 2000}
    assert frame.index.equals(pandas.IntervalIndex.from_breaks([0.1, 1.0], closed="left", name="transmitted_angle"))
    for name in ["counts"] if forced is None else ["counts", "values", "variances"]:
        told = getattr(tally, name)
        told = told if name == "counts" else told()
        assert data[name].values.tolist() == frame[name].tolist() == told.tolist()
    assert len(frame.columns) == len(data) == (1 if forced is None else 3)
    assert (filled.values() == tally.values()).all()
    sums = filled.values(flow=True)
    # Three numbers are added up, in another order: a rounding of each sum, and one of the fraction times 2000.
    assert sums.sum() == pytest.approx(out.fraction("transmitted").value * 2000, rel=1e-15, abs=0)
    if forced is None:
        assert sums.tolist() == [tally.underflow, *tally.counts.tolist(), tally.overflow]
    else:
        # Those of a tally are less (Σ w)²/N, as the number of ions is fixed. Two thirds of the larger term are left, so
        # that the roundings of a square, a quotient and two differences stay below ten units in the last place of it.
        less = tally.values() ** 2 / 2000
        assert filled.variances() - less == pytest.approx(tally.variances(), rel=1e-14, abs=0)
