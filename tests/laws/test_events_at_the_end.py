"""Events where a run ends: each is told once, by the run that ends there or by the one that goes on.

A start that is zero, for all that is known of it, is none (`test_flights_from_the_ground.py`): an end is one.
"""

from pathlib import Path

import numpy as np
import pytest

import visviva as vv

PERIOD = 2.0 * np.pi
METHODS = [{"method": "verner98"}, {"method": "dop853"}, {"method": "taylor"}, {"method": "tsitouras54"}]
FIXED = [{"method": "rk4", "dt": PERIOD / 1000}, {"method": "kahan_li8", "dt": PERIOD / 100}]


@pytest.mark.parametrize("how", [{}, *METHODS, *FIXED], ids=repr)
@pytest.mark.parametrize("e", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("from_pericenter", [True, False])
def test_periods_one_after_another(how: dict[str, object], e: float, from_pericenter: bool) -> None:
    """Ten runs of a period each, from an apsis to it: what a run in one piece tells, each in one of them.

    That is 20 apsides, or 19 where the method comes too late to the last.
    """
    if "dt" in how and e == 0.9:
        pytest.skip("equal steps are too long for it")
    scene = vv.problems.kepler(e=e).scene
    if not from_pericenter:
        scene = scene.run(t=0.5 * PERIOD, rtol=1e-13).final
        scene = vv.Scene(scene.particles, *scene.forces)
    found: list[float] = []
    whole = scene.run(t=10.0 * PERIOD, events=[vv.events.apsis(1, 0)], **how).events.t  # type: ignore[arg-type]
    for period in range(10):
        out = scene.run(t=(period + 1) * PERIOD, events=[vv.events.apsis(1, 0)], **how)  # type: ignore[arg-type]
        found += out.events.t.tolist()
        scene = out.final
    # The end of all may be told by one of them, where errors of both differ.
    assert len(found) in (19, 20)
    np.testing.assert_allclose(found[:19], whole[:19], rtol=0.0, atol=1e-4)


@pytest.mark.parametrize("terminal", [False, 2])
@pytest.mark.parametrize("every", [0.5 * PERIOD, PERIOD])
@pytest.mark.parametrize("how", [*METHODS, *FIXED], ids=repr)
def test_saved_runs_lose_none(how: dict[str, object], every: float, terminal: bool | int, tmp_path: Path) -> None:
    scene = vv.problems.kepler(e=0.5).scene
    events = [vv.events.apsis(1, 0, direction=1, terminal=terminal)]
    whole = scene.run(t=5.5 * PERIOD, events=events, **how)  # type: ignore[arg-type]
    saved = scene.run(t=5.5 * PERIOD, events=events, save_every=every, save_to=tmp_path / "run", **how)  # type: ignore[arg-type]
    assert saved.status == whole.status
    np.testing.assert_allclose(saved.events.t, whole.events.t, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize(
    "how", [{"method": "rk4", "dt": 0.01}, {"method": "verner98"}, {"method": "leapfrog", "dt": 0.01}]
)
def test_planes_at_the_seam_of_two_runs(how: dict[str, object]) -> None:
    """A free body comes to a plane where one run ends, but for rounding: exactly one of both tells it."""
    for seed in range(100):
        x, v = np.random.default_rng(seed).normal(size=(2, 3))
        scene = vv.Scene(vv.Particles([1.0], [x], [v]), vv.Harmonic(k=1e-30))
        events = [vv.events.plane(x + 0.1 * v, v)]
        first = scene.run(t=0.1, events=events, **how)  # type: ignore[arg-type]
        second = first.final.run(t=0.35, events=events, **how)  # type: ignore[arg-type]
        assert len(first.events) + len(second.events) == 1
        for found in (first.events, second.events):
            np.testing.assert_allclose(found.t, 0.1, rtol=1e-12, atol=0.0)


def test_what_rests_or_turns_before_it_comes_there_is_not_told() -> None:
    """A body on the ground, one that stops short of it by more than rounding, and a circle, which has no apsides."""
    ground = vv.events.plane([0, 0, 0], [0, 0, 1.0])
    resting = vv.Scene(vv.Particles([1.0], [[0, 0, 0.0]], [[1.0, 0, 0]]), vv.LinearDrag(tau=1e9))
    assert len(resting.run(t=3.0, events=[ground], method="verner98").events) == 0
    thrown = vv.Scene(vv.Particles([1.0], [[0, 0, -0.5 - 1e-12]], [[0, 0, 1.0]]), vv.UniformField([0, 0, -1.0]))
    assert len(thrown.run(t=1.0, events=[ground], method="verner98").events) == 0
    circle = vv.problems.kepler(e=0.0).scene
    for end in (PERIOD, 0.5 * PERIOD, 7.3):
        assert len(circle.run(t=end, events=[vv.events.apsis(1, 0)], method="verner98").events) == 0


@pytest.mark.parametrize("direction", [-1, 1])
def test_directions_count_at_the_end_too(direction: int) -> None:
    """Down to the ground at t = 1 to the last digit; a run to that time ends there, and it is no way up."""
    falling = vv.Scene(vv.Particles([1.0], [[0, 0, 0.5]], [[0, 0, 0.0]]), vv.UniformField([0, 0, -1.0]))
    out = falling.run(t=1.0, events=[vv.events.plane([0, 0, 0], [0, 0, 1.0], direction=direction)], method="verner98")
    assert len(out.events) == (1 if direction < 0 else 0)
