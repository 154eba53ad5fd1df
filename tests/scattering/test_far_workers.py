"""Workers that get what they need in a message, where arrays begin at any byte: the counts are those made here."""

from __future__ import annotations

import pickle
from concurrent.futures import Executor, Future
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable


def shipped(what: Any) -> Any:
    """As a message brings it: buffers out of band, each one byte off."""
    buffers: list[pickle.PickleBuffer] = []
    head = pickle.dumps(what, protocol=5, buffer_callback=buffers.append)
    off = []
    for buffer in buffers:
        raw = bytearray(1) + bytearray(buffer.raw())
        off.append(memoryview(raw)[1:].toreadonly())
    return pickle.loads(head, buffers=off)


class Far(Executor):
    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            there, arguments, named = shipped((function, arguments, named))
            future.set_result(shipped(there(*arguments, **named)))
        except BaseException as error:
            future.set_exception(error)
        return future


def test_arrays_are_shipped_unaligned() -> None:
    assert not shipped(np.linspace(0.0, 1.0, 1000)).flags.aligned


R = np.geomspace(0.3, 8.0, 300)
POTENTIALS = {
    "closed": vv.potentials.Coulomb(1.0),
    "formula": vv.potentials.LennardJones(1.0, 1.0),
    "table": vv.potentials.Tabulated(R, 1 / R - 1 / 8.0),
}
EDGES = np.linspace(0.0, np.pi, 500)


@pytest.mark.parametrize("potential", POTENTIALS)
def test_edges_and_tables_are_counted_as_here(potential: str) -> None:
    how: dict[str, Any] = {"beam_energy": 1.5, "masses": (1.0, 4.0), "b_max": 2.0, "seed": 3, "n_events": 20_000}
    for tally in ({"cm_angle": EDGES}, {("lab_angle", "cm_angle"): (EDGES[::10], EDGES[::10])}):
        here = vv.scattering.monte_carlo(POTENTIALS[potential], tally=tally, **how)
        assert vv.scattering.monte_carlo(POTENTIALS[potential], tally=tally, executor=Far(), **how) == here


def test_ensembles_run_as_here() -> None:
    scene = vv.problems.figure_eight().scene
    copies = scene.ensemble(position=scene.particles.position * np.linspace(0.95, 1.05, 300)[:, None, None])
    here, there = (copies.run([1.0, 2.0], **where) for where in ({}, {"executor": Far()}))
    np.testing.assert_array_equal(here.position, there.position)
