"""Where a run ended that did not reach its end: one goes on from there, and nothing of it is lost."""

import os
import signal
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva.generalized import GeneralizedTrajectory

# Adaptive and equal steps, of nodes, of points between them, and of series.
METHODS: list[tuple[str, dict[str, float]]] = [
    ("gauss8", {}),
    ("gauss16", {}),
    ("taylor", {}),
    ("dop853", {}),
    ("verner98", {}),
    ("rk4", {"dt": 1e-3}),
    ("yoshida6", {"dt": 1e-3}),
]
END = 20.0


def flow() -> vv.Hamiltonian:
    return vv.systems.henon_heiles(position=[0.1, 0.2], momentum=[0.3, 0.1])


def cut_short(system: Any, steps: int, method: str, how: dict[str, float]) -> GeneralizedTrajectory:
    with pytest.raises(vv.ConvergenceError) as caught:
        system.run(END, method=method, max_steps=steps, **how)
    out = caught.value.trajectory
    assert isinstance(out, GeneralizedTrajectory)
    assert out.status is vv.Status.TOO_MANY_STEPS
    return out


@pytest.mark.parametrize(("method", "how"), METHODS)
def test_a_run_with_too_many_steps_ends_where_its_last_step_did(method: str, how: dict[str, float]) -> None:
    out = cut_short(flow(), 12, method, how)
    assert out.steps == 12
    assert out.t.tolist() == [0.0]
    # Twelve steps of it, or of the longest at most.
    assert 0.0 < out.final.t0 <= 12.0 * out.longest_step * (1.0 + 1e-12)
    whole = flow().run([0.0, out.final.t0, END], method=method, **how)
    state = np.concatenate([out.final.position, out.final.momentum])
    there = np.concatenate([whole.position[1], whole.momentum[1]])
    # Where the steps end the same bits; of a time between steps as well as it is read there.
    np.testing.assert_allclose(state, there, rtol=0.0, atol=1e-10)
    on = out.final.run([out.final.t0, END], method=method, **how)
    np.testing.assert_allclose(on.position[-1], whole.position[-1], rtol=0.0, atol=2e-9)


@pytest.mark.parametrize(("method", "how"), METHODS)
def test_copies_end_where_each_does_alone(method: str, how: dict[str, float]) -> None:
    starts = np.linspace(0.05, 0.3, 11)
    copies = flow().ensemble(position=np.stack([starts, 0.1 + 0 * starts], axis=1))
    for threads in (1, 3):
        out = copies.run([0.0, END], method=method, max_steps=9, threads=threads, **how)
        assert (out.status == vv.Status.TOO_MANY_STEPS).all()
        for member in range(len(starts)):
            alone = cut_short(copies[member], 9, method, how)
            assert out[member].final.t0 == alone.final.t0
            assert np.array_equal(out[member].final.position, alone.final.position)
            assert np.array_equal(out[member].final.momentum, alone.final.momentum)


def test_a_run_that_is_whole_ends_with_its_last_row() -> None:
    out = flow().run(np.linspace(0.0, 3.0, 7))
    assert out.final.t0 == 3.0
    assert np.array_equal(out.final.position, out.position[-1])


def test_where_it_ended_is_in_the_file(tmp_path: Path) -> None:
    out = cut_short(flow(), 12, "taylor", {})
    out.save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert isinstance(again, GeneralizedTrajectory)
    assert again.final.t0 == out.final.t0
    assert np.array_equal(again.final.position, out.final.position)


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
def test_ctrl_c_keeps_the_last_step() -> None:
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt) as caught:
            flow().run(1e7)
    finally:
        timer.join()
    out = caught.value.trajectory  # type: ignore[attr-defined]
    assert len(out.t) == 1
    # Millions of steps a second or hundreds on a loaded machine: it has come some way, and its energy with it.
    assert out.final.t0 > 1.0
    assert abs(float(out.final.energy) - float(flow().energy)) < 1e-12


@pytest.mark.parametrize("method", ["auto", "dop853", "rk4"])
@pytest.mark.parametrize("t0", [1e6, -1e9, 1e12])
def test_times_far_from_zero_cost_no_digits(method: str, t0: float) -> None:
    """Rows between the ends were as far off as a time has no digits: 1.5e-7 at 1e9, where all times are exact."""
    times = np.array([0.0, 1.0, 2.5, 2.5, 5.25, 10.0])
    pendulum = vv.systems.pendulum(position=[2.0], velocity=[1.0])
    how = {"method": method} | ({"dt": 0.125} if method == "rk4" else {})
    passes = [vv.events.coordinate("theta", 0.3, direction=1)]
    here, there = (each.run(times + each.t0, events=passes, **how) for each in (pendulum, pendulum.at(t0=t0)))
    np.testing.assert_array_equal(there.position, here.position)
    np.testing.assert_array_equal(there.t, times + t0)
    assert len(there.events) == len(here.events) > 0
    np.testing.assert_allclose(there.events.t - t0, here.events.t, rtol=0.0, atol=np.spacing(abs(t0)))
    # Of what knows the time there is no such thing.
    moving = vv.systems.moving_pivot(position=[0.1])
    assert not np.array_equal(moving.at(t0=1e6).run(1e6 + times).position, moving.run(times).position)
