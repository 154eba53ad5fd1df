"""Events that look at how rigid bodies are turned: times of closed forms, of dense rows, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv

#: Spins of a symmetric top about its own axes: ω₁ = 0.3 cos Ωt, with Ω = ω₃ (I₃ − I₁)/I₁ = 2.
TOP = vv.RigidBody(1.0, inertia=np.diag([2.0, 2.0, 3.0]), angular_velocity=[0.3, 0.0, 4.0])
RATE = 2.0
#: Times of zeros: what methods that choose their steps leave of the place of a point and of a phase, 1e-12 a step.
EXACT = 1e-10


def across(t, position, velocity, orientation, angular_velocity):
    return angular_velocity[0, 0]


def crossings(end: float) -> np.ndarray:
    """When cos Ωt is zero."""
    times = (np.arange(40) + 0.5) * np.pi / RATE
    return times[times < abs(end)] * np.sign(end)


METHODS = [
    {},
    {"method": "kahan_li8", "dt": 0.05},
    {"method": "rk4", "dt": 0.005},
    {"method": "dop853", "rtol": 1e-12},
    {"method": "verner98", "rtol": 1e-12},
]


@pytest.mark.parametrize("how", METHODS)
@pytest.mark.parametrize("end", [7.0, -7.0])
def test_the_spin_of_a_free_top_passes_zero_when_the_closed_form_does(how, end):
    out = vv.Scene(TOP).run(t=end, events=[across], **how)
    # What methods are held to; 64 parts of a step (of rk4: 2e-9).
    np.testing.assert_allclose(out.events.t, crossings(end), rtol=0.0, atol=5e-9)


def test_directions_are_those_in_time_and_a_terminal_one_ends_there():
    down = vv.events.function(across, direction=-1)
    up = vv.events.function(across, direction=1, terminal=2)
    out = vv.Scene(TOP).run(t=30.0, events=[down, up])
    times = crossings(30.0)
    np.testing.assert_allclose(out.events.t[out.events.which == 0], times[:3:2], rtol=0.0, atol=EXACT)
    np.testing.assert_allclose(out.events.t[out.events.which == 1], times[1:4:2], rtol=0.0, atol=EXACT)
    assert out.status == vv.Status.STOPPED
    # The spin at the end is what the function was given there, to the rounding of a spin of 1.
    assert abs(out.angular_velocity[-1, 0, 0]) < 1e-14
    assert abs(out.final.t0 - times[3]) < EXACT


def test_a_book_turns_over_when_its_rows_say_so():
    book = vv.RigidBody(1.0, inertia=np.diag([1.0, 2.0, 2.5]), angular_velocity=[0.01, 2.0, 0.0])

    def upright(t, position, velocity, orientation, angular_velocity):
        return vv.rigid.rotate(orientation[0], [0.0, 1.0, 0.0])[1]

    times = np.linspace(0.0, 60.0, 12001)
    out = vv.Scene(book).run(times, events=[upright])
    heights = vv.rigid.rotate(out.orientation[:, 0], [0.0, 1.0, 0.0])[:, 1]
    changes = np.flatnonzero(np.diff(np.sign(heights)))
    assert len(out.events) == len(changes) > 2
    assert ((times[changes] <= out.events.t) & (out.events.t <= times[changes + 1])).all()
    # The rows have the bits of a run without events.
    assert np.array_equal(out.orientation, vv.Scene(book).run(times, method=out.stats.method).orientation)


def test_beside_points_and_other_events_each_gets_what_it_takes():
    scene = vv.Scene(
        [vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]), TOP],
        [vv.UniformField((0.0, 0.0, -1.0))],
    )
    seen = []

    def of_all(t, position, velocity, orientation, angular_velocity):
        seen.append((position.shape, velocity.shape, orientation.shape, angular_velocity.shape))
        return angular_velocity[0, 0]

    def of_points(t, position, velocity):
        return position[0, 2] + 0.5

    out = scene.run(t=4.0, events=[of_all, of_points, vv.events.plane((0, 0, -0.5), (0, 0, 1.0), body=0)])
    assert set(seen) == {((2, 3), (2, 3), (1, 4), (1, 3))}
    for which, expected in ((0, crossings(4.0)), (1, [1.0]), (2, [1.0])):
        np.testing.assert_allclose(out.events.t[out.events.which == which], expected, rtol=0.0, atol=EXACT)


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_have_the_events_that_they_have_alone(threads):
    spins = np.array([[[0.3, 0.0, w]] for w in (3.0, 4.0, 5.0)])
    copies = vv.Scene(TOP).ensemble(angular_velocity=spins)
    out = copies.run(t=7.0, events=[across], threads=threads)
    for member in range(3):
        alone = copies[member].run(t=7.0, events=[across])
        assert np.array_equal(out.events.t[out.events.member == member], alone.events.t)


def test_a_file_keeps_the_name_of_the_function(tmp_path):
    out = vv.Scene(TOP).run(t=3.0, events=[across])
    out.save(tmp_path / "top.npz")
    loaded = vv.load(tmp_path / "top.npz")
    assert np.array_equal(loaded.events.t, out.events.t)
    assert loaded.events.definitions == out.events.definitions
    assert loaded.events.definitions[0].parameters == (("name", "across"),)
    # Nothing of how the function was called is kept beside its name.
    assert out._result["looked_for"][0].keys() == {"kind", "function", "name", "direction", "last"}


def test_without_rigid_bodies_it_is_refused_before_anything_runs():
    with pytest.raises(vv.InvalidInput, match=r"takes orientations too, and the scene has no rigid bodies"):
        vv.problems.kepler(e=0.5).scene.run(t=1.0, events=[across])
    with pytest.raises(vv.InvalidInput, match=r"events: .*position.*velocity"):
        vv.systems.pendulum(position=[1.0]).run(t=1.0, events=[vv.events.function(across)])
    with pytest.raises(vv.InvalidInput, match="called with"):
        vv.events.function(lambda t, position, velocity, orientation: 0.0)


def test_no_turn_is_missed_in_a_step_that_is_long_beside_it():
    # The body stays where it is, so that one step may be the whole run.
    out = vv.Scene(TOP).run(t=1000.0, events=[across])
    times = (np.arange(len(out.events)) + 0.5) * np.pi / RATE
    assert len(out.events) == int(1000.0 * RATE / np.pi + 0.5)
    # 1e-16 of the angle of 6000 rad, times what a spin of 0.3 makes of a phase.
    np.testing.assert_allclose(out.events.t, times, rtol=0.0, atol=1e-11)


def test_turns_that_nobody_could_follow_in_a_step_are_refused():
    with pytest.raises(vv.InvalidInput, match=r"events: .*one step in which a rigid body turns by .* max_step="):
        vv.Scene(TOP).run(t=1e7, events=[across])
    out = vv.Scene(TOP).run(t=1e7, events=[vv.events.function(across, terminal=True)], max_step=1e4)
    assert abs(out.final.t0 - 0.25 * np.pi) < EXACT
