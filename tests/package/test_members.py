"""Members of an ensemble and of its run, one by one: what they are, that nobody can change them, and what they cost."""

import pickle
from typing import Any

import numpy as np
import pytest
from calls import python_calls

import visviva as vv

BODIES = vv.Particles(
    [1.0, 1e-3, 0.0],
    [[0, 0, 0], [1.0, 0, 0], [0, 2.0, 0]],
    [[0, 0, 0], [0, 0.9, 0], [-0.7, 0, 0]],
    names=["S", "a", "b"],
)
SCENE = vv.Scene(BODIES, vv.Gravity(1.0), vv.UniformField([0.0, 0.0, 0.1]), t0=2.0)
RNG = np.random.default_rng(5)
COUNT = 40
OWN: list[dict[str, Any]] = [
    {"position": BODIES.position + 1e-2 * RNG.normal(size=(COUNT, 3, 3))},
    {"mass": BODIES.mass * RNG.uniform(1.0, 2.0, (COUNT, 1)), "radius": np.tile([0.0, 1e-3], 60).reshape(COUNT, 3)},
    {"parameters": {"Gravity": {"G": np.repeat(np.linspace(1.0, 1.1, COUNT // 2), 2)}}},
]
EVENTS = [vv.events.apsis("a", "S"), vv.events.distance("b", "S", below=1.9)]


@pytest.mark.parametrize("own", OWN, ids=["states", "bodies", "forces"])
def test_a_member_is_the_scene_that_is_made_by_itself(own: dict[str, Any]) -> None:
    copies = SCENE.ensemble(**own)
    for copy in (0, 7, COUNT - 1):
        scene = copies[copy]
        arrays = {name: getattr(copies, name)[copy] for name in ("mass", "position", "velocity", "radius")}
        alone = vv.Scene(vv.Particles(**arrays, names=BODIES.names), *copies.forces[copy], t0=2.0)
        assert (scene, repr(scene), hash(scene)) == (alone, repr(alone), hash(alone))
        assert pickle.loads(pickle.dumps(scene)) == alone
        assert np.array_equal(scene.run(t=5.0).position, alone.run(t=5.0).position)
        for name, array in arrays.items():
            kept = getattr(scene.particles, name)
            # Its own: a member that is kept does not keep the whole ensemble.
            assert not np.shares_memory(kept, array)
            with pytest.raises(ValueError, match="read-only"):
                kept[0] = 1.0


@pytest.mark.parametrize(
    "chosen",
    [slice(3, 4), slice(None), slice(5, 30), slice(30, 5), slice(30, 5, -1), slice(None, None, 7), slice(-3, None)],
)
def test_tables_of_some_are_those_lines_of_all(chosen: slice) -> None:
    out = SCENE.ensemble(**OWN[0]).run(t=20.0, events=EVENTS, method="dop853")
    table, some = out.events, out[chosen].events if range(COUNT)[chosen] else None
    assert len(table) > 3 * COUNT
    numbered = range(COUNT)[chosen]
    expected = [np.flatnonzero(table.member == copy) for copy in numbered]
    for number, (copy, lines) in enumerate(zip(numbered, expected, strict=True)):
        assert some is not None
        here = some.member == number
        for name in ("t", "which", "position", "velocity"):
            assert np.array_equal(getattr(some, name)[here], getattr(table, name)[lines], equal_nan=True)
            assert np.array_equal(getattr(out[copy].events, name), getattr(table, name)[lines], equal_nan=True)
        assert not out[copy].events.member.any()
    assert some is None or len(some) == sum(map(len, expected))


def test_what_a_member_cost_is_its_own() -> None:
    out = SCENE.ensemble(**OWN[0]).run(t=20.0, method="dop853")
    for copy in (0, COUNT - 1):
        for name, each in out.per_trajectory.items():
            cost = getattr(out[copy].stats, name)
            assert cost == each[copy]
            assert type(cost) is int
    assert out[4:9].stats.steps == sum(out[copy].stats.steps for copy in range(4, 9))


def test_a_member_costs_some_calls_and_a_part_of_all_no_more() -> None:
    out = SCENE.ensemble(**OWN[2]).run(t=20.0, events=EVENTS, method="dop853")
    _ = out[0]
    # 41 (there were 92).
    assert python_calls(lambda: [out[copy] for copy in range(COUNT)]) < 60 * COUNT
    # Sets of forces are told one by one: 1 for each.
    assert python_calls(lambda: out[:]) - python_calls(lambda: out[: COUNT // 2]) <= COUNT // 2
