"""Functions of one's own among the events, of which nothing is known but their values.

Bounds: zeros of a harmonic motion to some roundings of their times.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from event_scenes import kepler

import visviva as vv
from visviva._event_descriptions import descriptions, from_description, of_scene, to_core


@pytest.mark.parametrize("method", ["dop853", "verner98"])
def test_functions_are_sampled_where_a_free_body_takes_few_steps(method: str) -> None:
    """sin of the time, 14 zeros in a run of a handful of steps: half were between the places that were looked at."""
    free = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]), vv.LinearDrag(1e9))
    wave = [lambda t, position, velocity: float(np.sin(t))]
    out = free.run(45.0, method=method, events=wave)
    assert out.stats.steps < 45
    np.testing.assert_allclose(out.events.t, np.pi * np.arange(1, 15), rtol=1e-14)


@pytest.mark.parametrize("how", [{"method": "dop853"}, {"method": "leapfrog", "dt": 0.01}])
def test_a_function_that_is_never_a_number_is_told(how: dict[str, Any]) -> None:
    scene = kepler()
    lost = [lambda t, x, v: float(x[1, 0]), lambda t, x, v: float("nan")]
    with pytest.warns(vv.AccuracyWarning, match=r"events\[1\] gave NaN whenever it was asked"):
        scene.run(1.0, events=lost, **how)
    # One that is a number somewhere may have zeros there.
    with warnings.catch_warnings():
        warnings.simplefilter("error", vv.AccuracyWarning)
        scene.run(1.0, events=[lambda t, x, v: float("nan") if t < 0.5 else 1.0], **how)


def test_of_events_a_result_keeps_what_tells_of_them_and_of_a_function_its_name_alone() -> None:
    """So that it can be written to a file: not whether it looks at rigid bodies, which only a run of it needs."""

    def height(t: float, position: Any, velocity: Any) -> float:
        return float(position[0, 2])

    kept = descriptions(to_core([height, vv.events.energy(0.5, direction=-1, terminal=True)]))
    name = "test_of_events_a_result_keeps_what_tells_of_them_and_of_a_function_its_name_alone.<locals>.height"
    assert kept == [
        {"kind": "function", "function": None, "name": name, "direction": 0.0, "last": None},
        {"kind": "energy", "value": 0.5, "direction": -1.0, "last": 1},
    ]
    assert from_description(kept[1]) == vv.events.energy(0.5, direction=-1, terminal=True)
    assert dict(from_description(kept[0]).parameters) == {"name": name}


def test_names_of_bodies_are_resolved_where_an_event_has_some() -> None:
    """And no others: an event without bodies, or with indices, is told to the core as it came."""
    given = to_core([vv.events.energy(0.5), vv.events.distance("Sun", 2, below=1.0), vv.events.apsis(1, "Sun")])
    there = of_scene(given, ("Sun", "Earth", "Mars"), 3)
    assert there[0] == given[0]
    assert (there[1]["first"], there[1]["second"], there[1]["distance"]) == (0, 2, 1.0)
    assert (there[2]["body"], there[2]["about"]) == (1, 0)
    with pytest.raises(vv.InvalidInput, match="second: expected two bodies, got 0 twice"):
        of_scene(to_core([vv.events.distance("Sun", 0, below=1.0)]), ("Sun", "Earth"), 2)


@pytest.mark.parametrize("call", [lambda r, v, t: v[0, 0], lambda position, velocity, time: position[0, 0]])
def test_the_order_of_forces_is_refused(call: Any) -> None:
    """Where the place was taken for the time, no event was found, and nothing said."""
    scene = vv.Scene(vv.Particles([1.0], [[-3.0, 0.0, 0.0]], [[1.0, 0.5, 0.0]]), vv.UniformField([-0.5, 0.0, -1.0]))
    with pytest.raises(vv.InvalidInput, match=r"in this order, got f\("):
        scene.run(t=10.0, events=[call])
    assert scene.run(t=10.0, events=[lambda t, r, v: v[0, 0]]).events.t == pytest.approx([2.0], rel=1e-12, abs=0.0)
