"""Events of copies that share lanes: each copy has those that it has alone, and pays for them what it pays alone."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import events

COPIES = 13
METHODS: list[dict[str, Any]] = [
    {"method": "auto"},
    {"method": "gauss8", "rtol": 1e-10},
    {"method": "gauss4", "dt": 0.01},
    {"method": "dop853"},
    {"method": "verner98", "rtol": 1e-11},
    {"method": "bogacki_shampine32", "rtol": 1e-6},
    {"method": "taylor"},
    {"method": "rk4", "dt": 0.013},
]
each_method = pytest.mark.parametrize("how", METHODS, ids=lambda how: how["method"])


def pendulums() -> Any:
    """From small swings to turns."""
    starts = np.linspace(0.3, 3.0, COPIES)[:, None]
    return vv.systems.pendulum().ensemble(position=starts, parameters={"l": np.linspace(0.5, 1.5, COPIES)})


def double_pendulums() -> Any:
    starts = np.array([1.0, 0.5]) + 0.3 * np.random.default_rng(2).normal(size=(COPIES, 2))
    return vv.systems.double_pendulum().ensemble(position=starts)


def compare(ensemble: Any, looked_for: list[Any], span: Any, how: dict[str, Any]) -> Any:
    for threads in (1, 3):
        out = ensemble.run(span, events=looked_for, threads=threads, **how)
        for copy in range(COPIES):
            alone = ensemble[copy].run(span, events=looked_for, **how)
            own = out[copy]
            assert own.status == alone.status
            assert own.final.t0 == alone.final.t0
            np.testing.assert_array_equal(own.final.position, alone.final.position)
            np.testing.assert_array_equal(own.position, alone.position)
            assert out.steps[copy] == alone.steps
            assert out.evaluations[copy] == alone.evaluations
            for column in ("which", "t", "position", "velocity"):
                np.testing.assert_array_equal(getattr(own.events, column), getattr(alone.events, column))
    return out


@each_method
@pytest.mark.parametrize("backward", [False, True])
def test_zeros_of_expressions_and_ends_of_runs(backward: bool, how: dict[str, Any]) -> None:
    above = events.expression(lambda q, v, t, l, **_: l * v[0] - 0.3 * np.sin(t), direction=-1)
    looked_for = ["theta", above, events.coordinate("theta", 2.5, terminal=3)]
    out = compare(pendulums(), looked_for, np.linspace(0.0, -6.0 if backward else 6.0, 9), how)
    assert (out.status == vv.Status.STOPPED).any()
    assert (out.status == vv.Status.OK).any()
    assert len(out.events) > 3 * COPIES


@each_method
def test_of_two_coordinates_without_outputs_on_the_way(how: dict[str, Any]) -> None:
    system = double_pendulums()
    looked_for = [events.coordinate(system.system.coordinates[1], 0.4), events.coordinate(system.system.coordinates[0])]
    assert len(compare(system, looked_for, 4.0, how).events) > COPIES


@each_method
def test_what_never_happens_changes_nothing(how: dict[str, Any]) -> None:
    ensemble, times = pendulums(), np.linspace(0.0, 3.0, 4)
    watched = ensemble.run(times, events=[events.coordinate("theta", 50.0)], **how)
    assert len(watched.events) == 0
    np.testing.assert_array_equal(watched.position, ensemble.run(times, **how).position)


def test_copies_share_lanes_beside_events() -> None:
    """Each by itself took four times as long as without events, six by DOP853."""
    starts = np.array([1.0, 0.5]) + 0.01 * np.random.default_rng(0).normal(size=(128, 2))
    system = vv.systems.double_pendulum(position=[1.0, 0.5])
    ensemble = system.ensemble(position=starts)
    never = [events.coordinate(system.coordinates[0], 50.0)]

    def fastest(looked_for: list[Any]) -> float:
        def once() -> float:
            begun = time.perf_counter()
            ensemble.run(5.0, method="dop853", events=looked_for, threads=1)
            return time.perf_counter() - begun

        return min(once() for _ in range(5))

    assert fastest(never) < 3.0 * fastest([])
