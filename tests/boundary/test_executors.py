"""Ensembles run by executors: the bits of the run without one, whoever is lost on the way."""

import multiprocessing
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

CASES: dict[str, Callable[[], tuple[vv.EnsembleScene, dict[str, Any]]]] = {}


def case(made: Callable[[], tuple[vv.EnsembleScene, dict[str, Any]]]) -> None:
    CASES[made.__name__.replace("_", " ")] = made


def eights(number: int = 37) -> vv.EnsembleScene:
    scene = vv.problems.figure_eight().scene
    return scene.ensemble(position=scene.particles.position * np.linspace(0.95, 1.05, number)[:, None, None])


@case
def adaptive() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    return eights(), {"t": [0.0, 1.0, 2.0], "record": ["position", "velocity", "energy"]}


@case
def that_goes_on() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    first = eights().run(t=1.0, method="stormer13", dt=0.01).final
    return first, {"t": 2.0, "method": "stormer13", "dt": 0.01}


@case
def events_some_of_which_end_it() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    scene = vv.problems.kepler(e=0.5).scene
    copies = scene.ensemble(velocity=scene.particles.velocity * np.linspace(0.7, 1.3, 40)[:, None, None])
    near = vv.events.distance(0, 1, below=0.5, terminal=True)
    level = vv.events.expression(lambda t, position, velocity: position[0, 1] - position[1, 1])
    return copies, {"t": 20.0, "events": [vv.events.apsis(0, 1), level, near], "method": "leapfrog", "dt": 0.01}


@case
def all_of_a_part_are_stopped() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    scene = vv.Scene(vv.Particles([1.0], [[0.0, 0, 0]], [[1.0, 0, 0]]), vv.Harmonic(k=1.0))
    speeds = np.repeat([0.1, 1.0], [16, 16])[:, None, None] * scene.particles.velocity
    wall = vv.events.plane([0.5, 0, 0], [1.0, 0, 0], terminal=True)
    return scene.ensemble(velocity=speeds), {"t": 3.0, "events": [wall], "method": "leapfrog", "dt": 0.1}


@case
def failures() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    scene = vv.Scene(
        vv.Particles([1.0, 1.0], [[0, 0, 0], [1.0, 0, 0]]), vv.Gravity(G=1.0), vv.UniformField([0, 0, 0.1])
    )
    sideways = np.zeros((20, 2, 3))
    sideways[::3, 1, 1] = 0.5
    return scene.ensemble(velocity=sideways), {"t": 5.0, "method": "dop853"}


@case
def parameters_of_their_own() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    spring = vv.Harmonic(k=1.0)
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], names=["bob"]), spring, vv.UniformField([0, 0, -1.0]))
    copies = scene.ensemble(parameters={spring: {"k": np.linspace(1.0, 4.0, 25)}})
    return copies, {"t": [1.0, 2.0], "method": "dop853"}


@case
def collisions() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    balls = vv.Particles([1.0, 2.0], [[-2.0, 0, 0], [2.0, 0.1, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    scene = vv.Scene(balls)
    speeds = balls.velocity * np.linspace(0.1, 1.0, 30)[:, None, None]
    return scene.ensemble(velocity=speeds), {"t": 4.0, "collisions": "merge"}


@case
def rigid_bodies() -> tuple[vv.EnsembleScene, dict[str, Any]]:
    body = vv.RigidBodies([1.0], moments=[[1.0, 2.0, 3.0]], angular_velocity=[[0.1, 1.0, 0.1]], names=["handle"])
    spins = np.array([[0.1, 1.0, 0.1]]) * np.linspace(0.5, 1.0, 20)[:, None, None]
    return vv.Scene(body).ensemble(angular_velocity=spins), {"t": [0.0, 5.0, 10.0]}


def same(here: Any, there: Any, name: str = "result") -> None:
    """Every number that a run gave, to the bit; but what it cost in time and who did it."""
    if isinstance(here, dict):
        assert here.keys() == there.keys(), name
        for key in here.keys() - {"seconds", "threads", "plan"}:
            same(here[key], there[key], f"{name}/{key}")
    else:
        assert np.asarray(here).dtype == np.asarray(there).dtype, name
        assert np.array_equal(here, there, equal_nan=np.asarray(here).dtype.kind == "f"), name


@pytest.fixture(scope="module")
def pool() -> Iterator[Executor]:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        yield executor


@pytest.mark.filterwarnings("ignore:.*:visviva.AccuracyWarning")
@pytest.mark.parametrize("name", CASES)
def test_the_bits_are_those_of_the_run_without(name: str, pool: Executor) -> None:
    copies, how = CASES[name]()
    here, there = copies.run(**how), copies.run(**how, executor=pool)
    same(here._result, there._result)
    assert there.plan.solution == here.plan.solution
    if not here.status.any():
        then = how["t"] + 1.0 if isinstance(how["t"], float) else how["t"][-1] + 1.0
        more = {key: value for key, value in how.items() if key in ("method", "dt")}
        same(here.final.run(t=then, **more)._result, there.final.run(t=then, **more)._result)


def test_progress_counts_copies() -> None:
    told: list[tuple[int, int]] = []
    with ThreadPoolExecutor(2) as threads:
        eights().run(t=1.0, executor=threads, progress=lambda done, total: told.append((done, total)))
    assert [total for _, total in told] == [37] * len(told)
    assert [done for done, _ in told] == sorted({done for done, _ in told})
    assert told[-1] == (37, 37)


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
def test_a_worker_that_is_killed_changes_nothing() -> None:
    copies = eights(300)
    how: dict[str, Any] = {"t": 30.0, "method": "leapfrog", "dt": 1e-4}
    killed: list[int] = []
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:

        def kill(done: int, total: int) -> None:
            if not killed:
                killed.append(done)
                os.kill(next(iter(executor._processes)), signal.SIGKILL)

        there = copies.run(**how, executor=executor, progress=kill)
        with pytest.raises(RuntimeError):  # it is really gone
            executor.submit(int).result()
        # A pool that is gone from the start does nothing: all is done here.
        again = copies[:20].run(**how, executor=executor)
    assert 0 < killed[0] < 300
    here = copies.run(**how)
    same(here._result, there._result)
    same(here[:20].position, again.position)


class Stopping(Executor):
    """Does what it is given at once, until Ctrl-C comes in the place of a part."""

    def __init__(self, parts: int) -> None:
        self.left = parts

    def submit(self, work: Any, /, *part: Any, **_: Any) -> Any:
        future: Future[Any] = Future()
        self.left -= 1
        if self.left < 0:
            future.set_exception(KeyboardInterrupt())
        else:
            future.set_result(work(*part))
        return future


@pytest.mark.parametrize("parts", [0, 2])
def test_what_came_home_before_ctrl_c_is_there(parts: int) -> None:
    copies = eights(40)
    with pytest.raises(vv.Interrupted, match=f"after {8 * parts} of 40 copies") as stopped:
        copies.run(t=1.0, executor=Stopping(parts))
    done = stopped.value.trajectory
    if parts:
        same(copies[: 8 * parts].run(t=1.0).position, done.position)
    else:
        assert done is None


def test_what_cannot_be_sent_is_refused_by_name() -> None:
    with ThreadPoolExecutor(1) as threads:
        with pytest.raises(vv.InvalidInput, match=r"executor: expected a concurrent\.futures\.Executor"):
            eights().run(t=1.0, executor="two")
        with pytest.raises(vv.InvalidInput, match=r"executor: expected a concurrent\.futures\.Executor"):
            eights().run(t=1.0, executor=ThreadPoolExecutor)
        with pytest.raises(vv.InvalidInput, match="executor: one scene is one piece of work"):
            vv.problems.figure_eight().scene.run(t=1.0, executor=threads)
        with pytest.raises(vv.InvalidInput, match="executor: events that are functions of your own"):
            eights().run(t=1.0, executor=threads, events=[lambda t, position, velocity: position[0, 0]])
        with pytest.raises(vv.InvalidInput, match="threads"):
            eights().run(t=1.0, executor=threads, threads=0)
        with pytest.raises(vv.InvalidInput, match="method"):
            eights().run(t=1.0, executor=threads, method="leapfrogg")


def test_a_copy_that_is_refused_is_named_as_without() -> None:
    places = np.tile([[-2.0, 0, 0], [2.0, 0, 0]], (20, 1, 1))
    places[13, 1, 0] = -1.5  # overlaps, in the second part
    balls = vv.Particles([1.0, 1.0], places[0], radius=0.5)
    copies = vv.Scene(balls).ensemble(position=places)
    messages = []
    with ThreadPoolExecutor(1) as threads:
        for executor in (None, threads):
            with pytest.raises(vv.InvalidInput) as refused:
                copies.run(t=1.0, collisions="bounce", executor=executor)
            messages.append(str(refused.value))
    assert messages[0] == messages[1]


PROGRAM = """
import numpy as np, visviva as vv

def main():
    from dask.distributed import Client, LocalCluster

    {copies}
    here = copies.run(t=[1.0, 2.0])
    with LocalCluster(2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        there = copies.run(t=[1.0, 2.0], executor=client)
    print((here.position == there.position).all())

if __name__ == "__main__":
    main()
"""


OF_SCENES = """
    scene = vv.problems.figure_eight().scene
    copies = scene.ensemble(position=scene.particles.position * np.linspace(0.95, 1.05, 50)[:, None, None])
"""
IN_GENERALIZED_COORDINATES = """
    copies = vv.systems.pendulum(position=[0.5]).ensemble(parameters={"l": np.linspace(0.5, 2.0, 50)})
"""


@pytest.mark.parametrize("copies", [OF_SCENES, IN_GENERALIZED_COORDINATES], ids=["scenes", "generalized coordinates"])
def test_a_dask_client_is_an_executor(tmp_path: Path, copies: str) -> None:
    pytest.importorskip("distributed")
    program = tmp_path / "program.py"
    program.write_text(PROGRAM.replace("{copies}", copies.strip()))
    done = subprocess.run([sys.executable, program], capture_output=True, text=True, timeout=300, check=False)
    assert done.stdout.strip() == "True", done.stderr
