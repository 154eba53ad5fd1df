"""Events that cannot be looked for are refused by name."""

from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import events


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ([events.apsis(2, 0)], r"events\[0\]: expected bodies from 0 to 1, got 2"),
        ([3], r"events\[0\] = 3"),
        (3, "expected a list of events, got int"),
        ("apsis", "events"),
    ],
)
def test_what_cannot_be_looked_for_is_refused(given: Any, message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message):
        vv.problems.kepler(e=0.3).scene.run(t=1.0, events=given)


def test_events_refuse_by_name() -> None:
    cases: list[tuple[str, Any]] = [
        ("below", lambda: events.distance(0, 1, below=0.0)),
        ("second", lambda: events.distance(0, 0, below=1.0)),
        ("first", lambda: events.distance(-1, 0, below=1.0)),
        ("normal", lambda: events.plane([0, 0, 0], [0, 0, 0])),
        ("point", lambda: events.plane([0, 0, np.nan], [0, 0, 1])),
        ("about", lambda: events.apsis(1, 1)),
        ("terminal", lambda: events.apsis(1, 0, terminal=-1)),
        ("direction", lambda: events.apsis(1, 0, direction="up")),  # type: ignore[arg-type]
        ("direction", lambda: events.plane([0, 0, 0], [0, 0, 1], direction=2)),  # type: ignore[arg-type]
        ("direction", lambda: events.distance(0, 1, below=1.0, direction=-0.5)),  # type: ignore[arg-type]
        ("direction", lambda: events.energy(1.0, direction=3)),  # type: ignore[arg-type]
        ("value", lambda: events.energy(np.inf)),
        ("call", lambda: events.function(3)),  # type: ignore[arg-type]
    ]
    for argument, call in cases:
        with pytest.raises(vv.InvalidInput) as refused:
            call()
        assert refused.value.argument == argument
    with pytest.raises(vv.InvalidInput, match="no events were looked for"):
        _ = vv.problems.kepler(e=0.3).scene.run(t=1.0).events


def test_a_direction_is_said_with_what_it_may_be() -> None:
    with pytest.raises(vv.InvalidInput, match=r"direction: expected 1 for upwards, -1 for downwards or 0 .*, got 2"):
        events.plane([0, 0, 0], [0, 0, 1], direction=2)  # type: ignore[arg-type]


def test_the_sign_of_a_functions_own_direction_counts_as_in_scipy() -> None:
    def height(t: float, position: Any, velocity: Any) -> float:
        return float(position[1, 1])

    scene = vv.problems.kepler(e=0.3).scene
    one = scene.run(t=10.0, events=[events.function(height, direction=-1)]).events
    height.direction = -2.5  # type: ignore[attr-defined]
    other = scene.run(t=10.0, events=[height]).events
    assert len(one) > 0
    assert np.array_equal(one.t, other.t)
