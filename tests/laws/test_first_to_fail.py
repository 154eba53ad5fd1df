"""Massless bodies are followed apart: where one of them ends a run, what is told is of that time, whoever it is."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv

METHODS = ["verner98", "dop853", "taylor", "dormand_prince54"]
#: From rest at a distance d a body falls onto a unit mass in π √(d³/8).
FALL = np.pi / np.sqrt(8.0)


def falling(distances: list[float]) -> vv.Scene:
    """A unit mass at rest and massless bodies at rest about it."""
    angle = 2.4 * np.arange(len(distances))
    around = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1) * np.array(distances)[:, None]
    return vv.Scene(vv.Particles([1.0, *np.zeros(len(distances))], np.vstack([np.zeros(3), around])), vv.Gravity(1.0))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("distances", [[2.0, 1.0], [1.0, 2.0], [3.0, 2.0, 1.0, 1.5]])
def test_the_bodies_told_are_those_that_met_first(method: str, distances: list[float]) -> None:
    """Those of the lowest number that met at any time were told, at the time of the first."""
    with pytest.raises(vv.CloseEncounter) as refusal:
        falling(distances).run(t=50.0, method=method)
    first = 1 + distances.index(min(distances))
    assert refusal.value.bodies == (0, first)
    # A step falls to zero where rounding of the place does, some 1e-9 before the fall ends.
    np.testing.assert_allclose(refusal.value.time, FALL * min(distances) ** 1.5, rtol=1e-4, atol=0)
    position = refusal.value.trajectory.final.particles.position
    apart = np.linalg.norm(position[1:] - position[0], axis=1)
    assert apart.argmin() == first - 1
    assert apart.min() < 1e-5
    assert refusal.value.distance < 1e-5


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("events", [1, 2])
def test_no_event_is_told_of_after_the_end(method: str, events: int) -> None:
    """Body 1 passes 0.5 at 2.96, long after body 2 has ended the run; it was in the table, with states of 1 alone."""
    looked_for = [vv.events.distance(0, body, below=0.5) for body in (1, 2)][:events]
    scene = falling([2.0, 1.0])
    with pytest.raises(vv.CloseEncounter) as refusal:
        scene.run(t=[0.0, 0.5, 1.0, 2.0, 3.0], method=method, events=looked_for)
    passed = refusal.value.trajectory.events.t
    # Body 2 itself passes 0.5 before.
    assert len(passed) == events - 1
    assert np.all(passed < FALL)
    outs = scene.ensemble(position=[scene.particles.position, 1.01 * scene.particles.position]).run(
        t=[0.0, 0.5, 1.0, 2.0, 3.0], method=method, events=looked_for
    )
    assert len(outs.events.t) == 2 * (events - 1)
    assert list(outs.status) == [vv.Status.CLOSE_ENCOUNTER] * 2


def test_a_terminal_event_after_the_end_does_not_count() -> None:
    event = vv.events.distance(0, 1, below=0.5, terminal=True)
    with pytest.raises(vv.CloseEncounter) as refusal:
        falling([2.0, 1.0]).run(t=5.0, method="verner98", events=[event])
    assert refusal.value.bodies == (0, 2)
    assert len(refusal.value.trajectory.events.t) == 0
    # The other way around it is the event that ends the run.
    run = falling([1.0, 2.0]).run(t=5.0, method="verner98", events=[event])
    assert run.status == vv.Status.STOPPED
    assert run.final.t0 == run.events.t[0] < FALL


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("apart", [1e-12, 1e-9, 1e-7, 1e-5])
def test_bodies_that_fall_in_at_nearly_one_time(method: str, apart: float) -> None:
    """On the steps that bring them together one may end before the other: all that was run was thrown away then."""
    scene = falling([1.0, 1.0 + apart, 1.0 - 0.3 * apart])
    for times in (3.0, [0.0, 0.5, 1.0, 3.0]):
        with pytest.raises(vv.CloseEncounter) as refusal:
            scene.run(t=times, method=method)
        # Also where the steps of one ended a little sooner.
        np.testing.assert_allclose(refusal.value.time, FALL, rtol=1e-4, atol=0)
        final = refusal.value.trajectory.final
        assert final.t0 == refusal.value.time
        assert np.isfinite(final.particles.position).all()
        # Those that are nearest to the center are where the law of energy has them, as well as 1e-9 of a fall tell.
        distance, speed = (
            np.linalg.norm(each[1:] - each[0], axis=1) for each in (final.particles.position, final.particles.velocity)
        )
        np.testing.assert_allclose(speed**2 / 2 * distance, 1.0 - distance, rtol=0, atol=1e-3)
