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
        ("value", lambda: events.energy(np.inf)),
        ("call", lambda: events.function(3)),  # type: ignore[arg-type]
    ]
    for argument, call in cases:
        with pytest.raises(vv.InvalidInput) as refused:
            call()
        assert refused.value.argument == argument
    with pytest.raises(vv.InvalidInput, match="no events were looked for"):
        _ = vv.problems.kepler(e=0.3).scene.run(t=1.0).events
