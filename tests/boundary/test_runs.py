"""What the gate promises, kept by real runs: interrupts, callbacks, threads."""

import itertools
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import errors

ENDLESS = 1e12
COPIES = 32

SETUP = """
import numpy as np, visviva as vv

def scene(particles):
    generator = np.random.default_rng(1)
    position, velocity = generator.normal(size=(2, particles, 3))
    return vv.Scene(vv.Particles(np.ones(particles), 10 * position, 0.1 * velocity), vv.Gravity(G=1.0, softening=0.1))

def ensemble(particles, copies):
    one = scene(particles)
    factor = np.linspace(0.9, 1.0, copies)[:, None, None]
    return one.ensemble(position=one.particles.position * factor)
"""
namespace: dict[str, Any] = {}
exec(SETUP, namespace)
scene: Callable[..., Any] = namespace["scene"]
ensemble: Callable[..., Any] = namespace["ensemble"]

# An expression of a run that would take for ever, by kind.
RUNS = {
    "fixed steps": 'scene(6).run(np.append(np.arange(100.0), 1e12), method="leapfrog", dt=1e-3, threads={threads})',
    "adaptive steps": 'scene(6).run(np.append(np.arange(100.0), 1e12), method="dop853", threads={threads})',
    "large": 'scene(3000).run(1e12, method="leapfrog", dt=1e-3, threads={threads})',
    "one long step": 'scene(40_000).run(1e12, method="dop853", threads={threads})',
    "batch": 'ensemble(3, 32).run(np.append(np.arange(100.0), 1e12), method="leapfrog", dt=1e-3, threads={threads})',
    "adaptive batch": 'ensemble(3, 32).run(np.append(np.arange(100.0), 1e12), method="dop853", threads={threads})',
}


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("threads", [1, 2])
def test_ctrl_c_keeps_what_was_computed(run: str, threads: int) -> None:
    script = f"""{SETUP}
import os, signal, threading, time
sent = []
def send():
    time.sleep(0.5)
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
scene(2).run(1.0)
threading.Thread(target=send).start()
try:
    {RUNS[run].format(threads=threads)}
except vv.Interrupted as error:
    elapsed = time.perf_counter() - sent[0]
    out = error.trajectory
    print(elapsed, len(out.t), np.isfinite(out.position[..., 0, :, :]).all())
"""
    best = float("inf")
    for _ in range(3):  # another user of the machine may delay one attempt
        done = subprocess.run([sys.executable, "-c", script], check=False, capture_output=True, text=True, timeout=60)
        assert done.stderr == ""
        elapsed, times, begins = done.stdout.split()
        assert begins == "True"
        assert int(times) >= 1
        best = min(best, float(elapsed))
        if best < 0.2:
            break
    assert best < 0.2


def interrupted(delay: float, run: Callable[[], object]) -> vv.Trajectory:
    """Stop a run after ``delay`` seconds, as Ctrl-C does; what it had computed."""

    def handler(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, delay)
        with pytest.raises(errors.Interrupted) as caught:
            run()
    finally:
        signal.signal(signal.SIGALRM, before)
    return caught.value.trajectory


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
@pytest.mark.parametrize("method", ["leapfrog", "kahan_li8", "rk4", "stormer13"])
@pytest.mark.parametrize("delay", [0.1, 0.13])
def test_an_interrupted_run_ends_on_a_whole_step(method: str, delay: float) -> None:
    """A large scene is stopped in the middle of a force evaluation; its last state is still one of the run's."""
    large = scene(3000)
    out = interrupted(delay, lambda: large.run(1e9, method=method, dt=1e-3))
    # On a busy machine not even one step may have been whole; the last state is then the first.
    again = large.run(out.final.t0, method=method, dt=1e-3).final if out.stats.steps else large
    assert out.final.particles.position.tobytes() == again.particles.position.tobytes()
    assert out.final.particles.velocity.tobytes() == again.particles.velocity.tobytes()


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
@pytest.mark.parametrize("delay", np.linspace(0.06, 0.3, 12))
def test_an_interrupted_adaptive_run_says_the_time_of_its_state(delay: float) -> None:
    """Wherever in a step it is stopped: so many steps lead to that time and to that state, to the bit."""
    large = scene(2000)
    times = [0.0, *np.linspace(1e-4, 1e9, 3)]
    out = interrupted(delay, lambda: large.run(times, method="dop853", rtol=1e-10))
    again = large
    if steps := out.stats.steps + out.stats.rejected:
        with pytest.raises(errors.ConvergenceError) as stopped:
            large.run(times, method="dop853", rtol=1e-10, max_steps=steps)
        again = stopped.value.trajectory.final
    assert out.final.t0 == again.t0
    assert out.final.particles.position.tobytes() == again.particles.position.tobytes()


@pytest.mark.parametrize("run", ["fixed steps", "adaptive steps", "large", "batch"])
def test_an_exception_of_the_callback_is_raised_again(run: str) -> None:
    stop = ArithmeticError("enough")

    def progress(done: int, total: int) -> None:
        raise stop

    expression = RUNS[run].format(threads=2)[:-1] + ", progress=progress)"
    started = time.monotonic()
    with pytest.raises(ArithmeticError) as caught:
        eval(expression, namespace | {"progress": progress})
    assert caught.value is stop
    assert time.monotonic() - started < 5.0


@pytest.mark.parametrize("method", ["leapfrog", "dop853"])
def test_progress_grows_to_the_total(method: str) -> None:
    calls: list[tuple[int, int]] = []
    scene(300).run(
        2.0,
        method=method,
        dt=1e-3 if method == "leapfrog" else None,
        progress=lambda done, total: calls.append((done, total)),
    )
    assert all(first <= second for first, second in itertools.pairwise(calls))
    done, total = calls[-1]
    assert done == total > 0


def test_the_arrays_belong_to_the_user() -> None:
    """Inputs are copied in: what happens to them later changes nothing; results are plain arrays, read-only."""
    mass, position, velocity = np.ones(2), np.array([[1.0, 0, 0], [-1, 0, 0]]), np.array([[0, 0.5, 0], [0, -0.5, 0]])
    before = vv.Scene(vv.Particles(mass, position, velocity), vv.Gravity(G=1.0))
    first = before.run(1.0, method="rk4", dt=0.1).position
    position[:] = np.nan
    np.testing.assert_array_equal(before.run(1.0, method="rk4", dt=0.1).position, first)
    assert first.flags.c_contiguous
    assert not first.flags.writeable


@pytest.mark.parametrize("layout", [np.asfortranarray, lambda x: x[::-1].copy()[::-1], lambda x: x.astype(">f8"), list])
def test_a_layout_does_not_change_the_bits(layout: Callable[[Any], Any]) -> None:
    generator = np.random.default_rng(2)
    position, velocity = generator.normal(size=(2, 5, 3))
    runs = [
        vv.Scene(vv.Particles(np.ones(5), shape(position), shape(velocity)), vv.Gravity(G=1.0, softening=0.1)).run(
            1.0, method="rk4", dt=0.01
        )
        for shape in (np.array, layout)
    ]
    np.testing.assert_array_equal(runs[0].position, runs[1].position)


@pytest.mark.parametrize("threads", [0, -3, 2**70, True, 1.0, "2"])
def test_a_wrong_number_of_threads_is_refused_by_name(threads: Any) -> None:
    with pytest.raises(errors.InvalidInput) as caught:
        scene(3).run(1.0, threads=threads)
    assert caught.value.argument == "threads"


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_do_not_change_the_bits(threads: int) -> None:
    for make, particles in ((scene, 700), (lambda n: ensemble(n, COPIES), 4)):
        one, more = (
            make(particles).run(0.05, method="dop853", threads=number, record=("position", "energy"))
            for number in (1, threads)
        )
        assert one.position.tobytes() == more.position.tobytes()
        assert one.energy.tobytes() == more.energy.tobytes()
