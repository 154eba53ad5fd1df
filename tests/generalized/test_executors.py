"""Ensembles in generalized coordinates by executors: the bits of the run without one, whoever is lost on the way."""

import multiprocessing
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva.generalized import GeneralizedEnsemble


def pendulums(number: int = 37) -> GeneralizedEnsemble:
    return vv.systems.pendulum(position=[0.5]).ensemble(parameters={"l": np.linspace(0.5, 2.0, number)})


def oscillators() -> GeneralizedEnsemble:
    made = vv.Hamiltonian(
        lambda q, p, t: p[0] ** 2 / 2 + q[0] ** 4 / 4, q=["x"], p=["p"], position=[1.0], momentum=[0.0]
    )
    return made.ensemble(position=np.linspace(0.5, 1.5, 19)[:, None])


def bead() -> GeneralizedEnsemble:
    """On a circle, by a constraint and its reaction."""
    made = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - 9.81 * q[1],
        coordinates=["x", "y"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1.0],
        position=[1.0, 0.0],
    )
    angles = np.linspace(0.1, 1.2, 18)
    return made.ensemble(position=np.stack([np.cos(angles), np.sin(angles)], axis=1))


def falling() -> GeneralizedEnsemble:
    """Some fall into the center, where the force has no value."""
    made = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + 1.0 / q[0], coordinates=["r"], position=[1.0])
    return made.ensemble(position=np.linspace(0.5, 9.0, 21)[:, None])


CASES: dict[str, tuple[Callable[[], GeneralizedEnsemble], dict[str, Any]]] = {
    "auto": (pendulums, {"t": [0.5, 1.0, 2.0]}),
    "taylor": (pendulums, {"t": 2.0, "method": "taylor"}),
    "gauss": (pendulums, {"t": 2.0, "method": "gauss8", "dt": 0.05}),
    "events some of which end it": (
        pendulums,
        {"t": np.linspace(0.1, 2.0, 9), "events": [vv.events.coordinate("theta", terminal=2), vv.events.energy(-5.0)]},
    ),
    "Hamiltonian": (oscillators, {"t": 3.0, "method": "dop853", "max_step": 0.1}),
    "constraints": (bead, {"t": [0.2, 0.4], "rtol": 1e-8}),
    "failures": (falling, {"t": 3.0}),
}


def same(here: dict[str, Any], there: dict[str, Any]) -> None:
    assert here.keys() == there.keys()
    for name, value in here.items():
        assert type(value) is type(there[name]), name
        if isinstance(value, np.ndarray):
            assert value.dtype == there[name].dtype, name
            assert np.array_equal(value, there[name], equal_nan=True), name
        else:
            assert repr(value) == repr(there[name]), name


@pytest.fixture(scope="module")
def pool() -> Iterator[Executor]:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        yield executor


@pytest.mark.parametrize("name", CASES)
def test_the_bits_are_those_of_the_run_without(name: str, pool: Executor) -> None:
    made, how = CASES[name]
    copies = made()
    here, there = copies.run(**how), copies.run(**how, executor=pool)
    same(here._result, there._result)
    assert np.array_equal(here.position, there.position, equal_nan=True)
    assert here.status.tolist() == there.status.tolist()
    with ThreadPoolExecutor(2) as threads:
        same(here._result, copies.run(**how, executor=threads, threads=2)._result)
    if name == "failures":
        assert 0 < np.count_nonzero(here.status) < len(here)
    if "events" in how:
        assert there.events.t.tolist() == here.events.t.tolist() != []


def test_progress_counts_copies_and_files_are_those_of_the_run_without(tmp_path: Path) -> None:
    told: list[tuple[float, float]] = []
    with ThreadPoolExecutor(2) as threads:
        there = pendulums().run(t=1.0, executor=threads, progress=lambda *done: told.append(done))
    assert told == [(8, 37), (16, 37), (24, 37), (37, 37)]
    there.save(tmp_path / "run.npz")
    assert np.array_equal(vv.load(tmp_path / "run.npz").position, pendulums().run(t=1.0).position)


class Odd(Executor):
    """Does what it is given at once, but for a part that is lost with its worker, or for which Ctrl-C comes."""

    def __init__(self, left: int, then: BaseException) -> None:
        self.left, self.then = left, then

    def submit(self, work: Any, /, *part: Any, **_: Any) -> Any:
        future: Future[Any] = Future()
        self.left -= 1
        if self.left == -1:
            future.set_exception(self.then)
        else:
            future.set_result(work(*part))
        return future


@pytest.mark.parametrize("lost", [0, 2])
def test_what_a_lost_worker_had_is_done_again(lost: int) -> None:
    executor = Odd(lost, BrokenExecutor("gone"))
    same(pendulums().run(t=1.0)._result, pendulums().run(t=1.0, executor=executor)._result)
    assert executor.left < 0


@pytest.mark.parametrize("parts", [0, 2])
def test_what_came_home_before_ctrl_c_is_there(parts: int) -> None:
    with pytest.raises(vv.Interrupted, match=f"after {8 * parts} of 37 copies") as stopped:
        pendulums().run(t=1.0, executor=Odd(parts, KeyboardInterrupt()))
    done = stopped.value.trajectory
    if parts:
        assert np.array_equal(done.position, pendulums().run(t=1.0).position[: 8 * parts])
        assert done[3].system.parameters == pendulums()[3].parameters
    else:
        assert done is None


def test_what_cannot_be_sent_is_refused_by_name() -> None:
    nobody = Odd(-1000, ValueError())
    for how, told in (
        ({"executor": "two"}, r"^executor: expected a concurrent\.futures\.Executor"),
        ({"events": vv.events.function(lambda t, q, v: q[0])}, "^executor: events that are functions of your own"),
        ({"threads": 0}, "^threads: "),
        ({"method": "taylr"}, "^method: "),
    ):
        with pytest.raises(vv.InvalidInput, match=told):
            pendulums().run(t=1.0, **{"executor": nobody, **how})
    assert nobody.left == -1000
