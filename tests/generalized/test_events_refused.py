"""Events that runs in generalized coordinates, or scenes, cannot look for."""

from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv
from visviva import events

PENDULUM = vv.systems.pendulum(position=[1.0])
KEPLER = vv.problems.kepler(e=0.3).scene


def speed(_q: Any, v: Any, _t: Any, **_parameters: Any) -> Any:
    return v[0]


def branching(q: Any, v: Any, t: Any, **_: Any) -> Any:
    return 1.0 if q[0] > 0.0 else -1.0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("phi", r"events\[0\]: there is no coordinate 'phi'; there are \['theta'\]"),
        ([events.coordinate("thet")], r"there is no coordinate 'thet'.*theta"),
        ([events.apsis(0, 1)], r"events\[0\]: apsis is of bodies in a scene; in generalized coordinates there are"),
        (["theta", events.distance(0, 1, below=1.0)], r"events\[1\]: distance is of bodies in a scene"),
        ([events.plane([0, 0, 0], [0, 0, 1])], r"events\[0\]: plane is of bodies"),
        (3, "expected a list of events, got int"),
        ([3], r"got events\[0\] = 3"),
        ([branching], r"events\[0\]: an expression has no truth value.*vv.events.function takes a function"),
        ([lambda q: q[0]], r"events\[0\]: the function is called with \(position, velocity, t, g=, l="),
        ([sp.Symbol("mu")], r"events\[0\]: free symbol 'mu' has no value"),
    ],
)
def test_what_cannot_be_looked_for_is_refused(given: Any, message: str) -> None:
    for call in (PENDULUM.run, PENDULUM.plan, PENDULUM.ensemble(position=[[1.0]]).run):
        with pytest.raises(vv.InvalidInput, match=message) as refused:
            call(1.0, events=given)
        assert refused.value.argument == "events"


def test_scenes_refuse_what_is_of_generalized_coordinates() -> None:
    with pytest.raises(vv.InvalidInput, match="coordinate is of runs in generalized coordinates; of bodies"):
        KEPLER.run(1.0, events=[events.coordinate("theta")])
    with pytest.raises(vv.InvalidInput, match="expected one number of the function, got ndarray"):
        KEPLER.run(1.0, events=[events.expression(speed)])
    cases: list[tuple[str, Any]] = [
        ("name", lambda: events.coordinate(3)),
        ("value", lambda: events.coordinate("q", np.nan)),
        ("direction", lambda: events.coordinate("q", direction="up")),  # type: ignore[arg-type]
        ("terminal", lambda: events.expression(speed, terminal=-1)),
        ("expression", lambda: events.expression(3)),
        ("expression", lambda: events.expression("q - 1")),
    ]
    for argument, call in cases:
        with pytest.raises(vv.InvalidInput) as refused:
            call()
        assert refused.value.argument == argument
