"""Results as values: they keep what they are, add up, refuse what does not fit, and survive a Ctrl-C.

Bounds: a product and a difference, 1e-14.
"""

import os
import pickle
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

sys.path.insert(0, str(Path(__file__).parent))
from coulomb_beam import BEAM, run


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
    assert tally.variances() == pytest.approx(100_000 * share * (1.0 - share), rel=1e-14, abs=0)
    assert copy == result
    assert result != run(tally=["cm_angle", "energy"], bins=20, seed=1)
    with pytest.raises(ValueError, match="read-only"):
        copy["energy"].counts[0] = 0
    # All that is counted is the disc: Σ dσ/dΩ ΔΩ = π b_max², ΔΩ that part of each bin that is reached.
    value, _ = tally.cross_section()
    total = np.nansum(value * -2.0 * np.pi * np.diff(np.cos(tally.edges)) * tally.reachable)
    assert total == pytest.approx(np.pi * BEAM["b_max"] ** 2, rel=1e-12, abs=0)


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
        ("lab_angle", {"tally": {"lab_angle": [10, 20, 45, 90]}}),
        ("recoil_angle", {"tally": {"recoil_angle": [0.0, 2.0]}}),
        ("energy", {"tally": {"energy": [0.0, 1500.0]}}),
        ("recoil_energy", {"tally": {"recoil_energy": [-1.0, 1.0]}}),
        ("lab_angle", {"tally": {"lab_angle": 0}}),
        ("lab_angle", {"tally": {"lab_angle": 50.0}}),
        ("lab_angle", {"tally": {"lab_angle": True}}),
        ("masses", {"masses": (1e-300, 1e300)}),
        ("masses", {"masses": (1e300, 1e-300)}),
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


def test_numbers_of_bins_may_differ_by_tally() -> None:
    result = run(tally={"lab_angle": 50, "energy": np.int64(7), "cm_angle": [0.5, 1.0]})
    assert [len(tally.counts) for tally in result.values()] == [50, 7, 1]
    assert result["lab_angle"] == run(tally="lab_angle", bins=50)["lab_angle"]


def test_degrees_are_refused_with_the_cure() -> None:
    with pytest.raises(vv.InvalidInput, match=r"np\.radians"):
        run(tally={"cm_angle": [0, 45, 90]})


def test_tallies_add_with_the_guards_of_results() -> None:
    one, two, three = run(), run(first_event=100_000), run(first_event=200_000)
    assert sum([one, two, three]) == run(n_events=300_000)
    assert sum(result["cm_angle"] for result in (three, one, two)) == run(n_events=300_000)["cm_angle"]
    with pytest.raises(vv.InvalidInput, match="in both"):
        _ = one["cm_angle"] + one["cm_angle"]
    for changes in ({"k": 3.0}, {"beam_energy": 2.0}, {"masses": (1.0, 5.0)}, {"b_max": 4.0}):
        other = run(**changes, first_event=100_000, tally={"cm_angle": one["cm_angle"].edges})
        with pytest.raises(vv.InvalidInput, match="potential" if "k" in changes else next(iter(changes))):
            _ = one["cm_angle"] + other["cm_angle"]
    with pytest.raises(vv.InvalidInput, match="edges"):
        _ = one["cm_angle"] + run(bins=10, first_event=100_000)["cm_angle"]
    with pytest.raises(TypeError):
        _ = 1 + one
    assert one["cm_angle"].events == one.events
    assert (one + three).next_event == 300_000
    assert one.next_event == 100_000
    with pytest.raises(vv.InvalidInput, match="one seed"):
        _ = (one + run(seed=1)).next_event


def test_other_potentials_and_double_counting_are_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="potential"):
        vv.scattering.monte_carlo(None, **BEAM, n_events=1)
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


def test_ctrl_c_keeps_what_was_counted() -> None:
    """SIGINT by the system's own clock; the kept result and the run of the rest are the whole, to the bit."""
    n = 10**11
    beam = {"tally": {"cm_angle": 30, "lab_angle": 20}, "first_event": 5}
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(vv.Interrupted) as caught:
            run(n_events=n, threads=2, **beam)
    finally:
        signal.signal(signal.SIGINT, previous)
    kept = caught.value.result
    assert ".result" in str(caught.value)
    assert kept.events == ((BEAM["seed"], 5, kept.next_event),)
    assert 0 < kept.n_events < n
    assert kept == run(n_events=kept.n_events, **beam)
    rest = run(n_events=12_345, **{**beam, "first_event": kept.next_event})
    assert kept + rest == run(n_events=kept.n_events + 12_345, **beam)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.result == kept
    assert str(again) == str(caught.value)


def test_a_callback_may_stop_the_run_and_keep_it() -> None:
    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted) as caught:
        run(n_events=10**11, progress=stop)
    kept = caught.value.result
    assert kept == run(n_events=kept.next_event)


def test_many_edges_are_interruptible() -> None:
    """Six tallies of 65536 bins take a second of bisection before the first event."""
    code = """
import signal, time, visviva as vv
def stop(*_):
    raise KeyboardInterrupt
signal.signal(signal.SIGALRM, stop)
beam = dict(beam_energy=1.0, masses=(3.0, 1.0), b_max=3.0, n_events=1, seed=1,
            tally=["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"])
vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), bins=10, **beam)
signal.setitimer(signal.ITIMER_REAL, 0.05)
asked = time.perf_counter() + 0.05
try:
    vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), bins=65536, **beam)
except BaseException as error:
    print(type(error).__name__, getattr(error, "result", None), time.perf_counter() - asked)
else:
    print("ended")
"""
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    if out == ["ended"]:
        pytest.skip("the edges were ready before the signal")
    assert out[:2] == ["Interrupted", "None"]
    # The monitor looks every 50 ms; the rest is for a busy machine. It took up to 1.1 s.
    assert float(out[2]) < 0.5


def test_progress_is_reported_and_can_stop_the_run() -> None:
    seen: list[tuple[int, int]] = []
    run(progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (100_000, 100_000)

    def stop(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        run(n_events=10**12, progress=stop)


def test_impact_parameters_beyond_the_beam_are_refused() -> None:
    """They would count nothing without a word."""
    with pytest.raises(vv.InvalidInput, match=r"\[0, b_max\] = \[0, 3.0\].*edge 2 is 4.0"):
        vv.scattering.monte_carlo(
            vv.potentials.Coulomb(1.0),
            beam_energy=1.0,
            masses=(1.0, 1.0),
            b_max=3.0,
            n_events=10,
            seed=1,
            tally={"impact_parameter": [0.0, 2.0, 4.0]},
        )
