"""Tables of results are equal if all their numbers are: when loaded, pickled, or made again."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

BALLS = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
# At rest apart from the center: radial motion, which has no plane, so that its angles are NaN.
FALLS = np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])


def collided(speed: float) -> vv.Trajectory:
    events = [vv.events.function(lambda t, position, velocity: np.sin(3.0 * t)), vv.events.distance(0, 1, below=2.0)]
    balls = vv.Particles(BALLS.mass, BALLS.position, speed * BALLS.velocity, radius=0.5)
    return vv.Scene(balls).run(
        t=4.0, collisions="bounce", events=events
    )  # fmt: skip


@pytest.mark.parametrize("table", ["collisions", "events"])
def test_what_is_loaded_is_what_was_saved(tmp_path: Path, table: str) -> None:
    out = collided(1.0)
    out.save(tmp_path / "run.npz")
    found = getattr(out, table)
    assert len(found) > 0
    assert getattr(vv.load(tmp_path / "run.npz"), table) == found
    assert pickle.loads(pickle.dumps(found)) == found
    assert found[:0] != found
    assert getattr(collided(1.0), table) == found != getattr(collided(0.5), table)
    assert found != out.t.tolist()
    with pytest.raises(TypeError, match="unhashable"):
        hash(found)


def test_events_of_generalized_coordinates(tmp_path: Path) -> None:
    swing = vv.systems.pendulum(position=[0.5])
    out = swing.run(5.0, events=["theta", vv.events.expression(lambda q, v, t, **parameters: v[0])])
    out.save(tmp_path / "run.npz")
    assert len(out.events) > 2
    assert vv.load(tmp_path / "run.npz").events == out.events
    assert out.events != out.events.of(0)
    # The very same places and times, but it was looked for both ways, and upwards alone.
    half = [swing.run(1.0, events=[vv.events.coordinate("theta", direction=sign)]).events for sign in (-1, 0)]
    assert half[0].t.tolist() == half[1].t.tolist() != []
    assert half[0] != half[1]


def test_bodies_that_are_not_known_at_an_event_are_equal() -> None:
    """Non-interacting bodies are integrated apart, and NaN at the event of another."""
    flies = vv.Scene(vv.Particles([1.0, 1.0], [[1.0, 0, 0], [0, 3.0, 0]], [[-1.0, 0, 0], [0, 0, 0]]))
    table, again = (flies.run(2.0, events=[vv.events.plane([0, 0, 0], [1.0, 0, 0], body=0)]).events for _ in range(2))
    assert np.isnan(table.position[0, 1]).all()
    assert table == again


@pytest.mark.parametrize("place", [FALLS, FALLS[0]])
def test_elements_of_orbits(place: np.ndarray) -> None:
    found, again = (vv.orbits.elements(1.0, place, np.zeros(3)) for _ in range(2))
    assert np.isnan(found.inclination).all()
    assert found == again
    assert found != vv.orbits.elements(2.0, place, np.zeros(3))
    assert found != vv.orbits.elements(1.0, FALLS[:1], np.zeros(3))
