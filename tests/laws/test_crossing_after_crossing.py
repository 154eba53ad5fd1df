"""Runs to the next crossing, one after another from `final`, see each crossing once: as one run through all of them.

Bounds: legs begin anew and take steps of their own, each held to 1e-10; over a few turns times agree to 1e-6.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

LEGS = 8
PAIR = vv.Particles([1.0, 2.0], [[1.0, 0.0, 0.0], [-0.5, 0.0, 0.0]], [[0.0, 1.2, 0.1], [0.0, -0.6, 0.0]])
APART = vv.Particles([1.0, 2.0], [[2.4, 0.1, -2.0], [0.3, -0.2, 2.2]], [[0.2, 0.0, 0.2], [0.3, 0.4, -0.3]])
SCENES = {
    "coupled": vv.Scene(PAIR, vv.Gravity(1.0), vv.Harmonic(0.5)),
    "late": vv.Scene(PAIR, vv.Gravity(1.0), vv.Harmonic(0.5), t0=3.7),
    "apart": vv.Scene(APART, vv.Harmonic(1.0)),
    "apart under drag": vv.Scene(APART, vv.Harmonic(1.0), vv.LinearDrag(500.0)),
}


def separation(_t: float, x: Any, _v: Any) -> float:
    return float(np.linalg.norm(x[0] - x[1]) - 1.6)


def of_one_coordinate(_t: float, x: Any, _v: Any) -> float:
    return float(x[0, 0] - 0.3)


def of_velocities(_t: float, x: Any, v: Any) -> float:
    return float(v[0, 0] * x[1, 0] - 0.03)


def event(kind: object, direction: int, *, terminal: bool) -> Any:
    if kind == "distance":
        return vv.events.distance(0, 1, below=1.6, direction=direction, terminal=terminal)
    return vv.events.function(kind, direction=direction, terminal=terminal)


def legs(scene: vv.Scene, kind: object, direction: int, end: float, how: dict[str, Any]) -> list[vv.Trajectory]:
    """Runs to each crossing in turn, as many as `LEGS`."""
    found = []
    while len(found) < LEGS:
        out = scene.run(t=end, events=[event(kind, direction, terminal=True)], **how)
        if out.status is not vv.Status.STOPPED:
            break
        found.append(out)
        scene = out.final
    return found


@pytest.mark.parametrize("kind", ["distance", separation, of_one_coordinate, of_velocities])
@pytest.mark.parametrize("direction", [-1, 0, 1])
@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "leapfrog"])
@pytest.mark.parametrize("name", list(SCENES))
def test_each_crossing_is_found_once(name: str, method: str, direction: int, kind: object) -> None:
    scene = SCENES[name]
    if name == "apart under drag" and method == "leapfrog":
        pytest.skip("leapfrog takes no velocities")
    how: dict[str, Any] = {"method": method} | ({"dt": 2.0**-7} if method == "leapfrog" else {"rtol": 1e-10})
    for back in (False, True):
        if back and name == "apart under drag":
            continue
        end = scene.t0 + (-40.0 if back else 40.0)
        whole = scene.run(t=end, events=[event(kind, direction, terminal=False)], **how).events.t
        found = legs(scene, kind, direction, end, how)
        times = [out.final.t0 for out in found]
        bound = 1e-2 if method == "leapfrog" else 1e-6  # shadow steps of legs begin elsewhere: dt² over some turns
        np.testing.assert_allclose(times, whole[: len(times)], rtol=0, atol=bound)
        assert len(times) == min(LEGS, len(whole))


@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("kind", ["distance", separation, "energy"])
def test_the_state_in_final_is_that_of_the_table(kind: object, rtol: float) -> None:
    """Also of bodies each of which has steps of its own, where the event is looked for on steps of both."""
    scene = vv.Scene(APART, vv.Harmonic(1.0), vv.LinearDrag(50.0))
    level = 0.98 * scene.invariants().energy
    asked = vv.events.energy(level, terminal=True) if kind == "energy" else event(kind, 0, terminal=True)
    for threads in (1, 3):
        out = scene.run(t=30.0, events=[asked], rtol=rtol, method="verner98", threads=threads)
        assert out.status is vv.Status.STOPPED
        np.testing.assert_array_equal(out.final.particles.position, out.events.position[-1])
        np.testing.assert_array_equal(out.final.particles.velocity, out.events.velocity[-1])
        np.testing.assert_array_equal(out.position[-1], out.events.position[-1])
        copies = scene.ensemble(velocity=np.stack([APART.velocity, 1.1 * APART.velocity]))
        of_copy = copies.run(t=30.0, events=[asked], rtol=rtol, method="verner98", threads=threads)[0]
        np.testing.assert_array_equal(of_copy.final.particles.position, out.final.particles.position)


def whole_and_legs(scene: vv.Scene, made: Any, end: float, **how: Any) -> tuple[list[float], list[float]]:
    """The times of an event in one run, and of the runs to it one after another."""
    whole = scene.run(t=end, events=[made(False)], **how).events.t.tolist()
    found: list[float] = []
    while len(found) < 30:
        out = scene.run(t=end, events=[made(True)], **how)
        if out.status is not vv.Status.STOPPED:
            break
        found.append(out.final.t0)
        scene = out.final
    return whole, found


def pair_at(offset: float, *forces: Any) -> vv.Scene:
    places = [[offset + 1.0, 0.0, 0.0], [offset - 0.5, 0.0, 0.0]]
    bodies = vv.Particles([1.0, 2.0], places, [[0.0, 1.2, 0.1], [0.0, -0.6, 0.0]])
    return vv.Scene(bodies, vv.Gravity(1.0), vv.Harmonic(0.5, center=(offset, 0.0, 0.0)), *forces)


@pytest.mark.parametrize("offset", [30.0, 1e3, 1e6, 1e9])
@pytest.mark.parametrize("how", [{"rtol": 1e-10}, {"method": "kahan_li8", "dt": 2.0**-6}])
@pytest.mark.parametrize(
    "made",
    [
        lambda terminal: vv.events.distance(0, 1, below=1.6, direction=0, terminal=terminal),
        lambda terminal: vv.events.apsis(0, 1, terminal=terminal),
    ],
)
def test_far_from_the_origin_final_has_fewer_digits_than_the_run(made: Any, how: dict[str, Any], offset: float) -> None:
    """The state is told in numbers of which the last is 1e-16 of the offset; times agree to that over the speeds."""
    whole, found = whole_and_legs(pair_at(offset), made, 12.0, **how)
    np.testing.assert_allclose(found, whole, rtol=0, atol=1e-6 + 1e-13 * offset)


@pytest.mark.parametrize("offset", [0.0, 30.0])
@pytest.mark.parametrize("rtol", [1e-6, 1e-10])
def test_an_energy_that_drag_takes_is_passed_once(offset: float, rtol: float) -> None:
    scene = pair_at(offset, vv.LinearDrag(300.0))
    level = 0.99 * scene.invariants().energy
    made = lambda terminal: vv.events.energy(level, terminal=terminal)  # noqa: E731
    whole, found = whole_and_legs(scene, made, 12.0, method="dop853", rtol=rtol)
    assert len(whole) == len(found) == 1


@pytest.mark.parametrize("how", [{}, {"method": "kahan_li8", "dt": 2.0**-6}, {"method": "rk4", "dt": 2.0**-6}])
def test_a_function_with_a_triple_zero(how: dict[str, Any]) -> None:
    made = lambda terminal: vv.events.function(lambda _t, x, _v: float(x[0, 0] - 0.3) ** 3, terminal=terminal)  # noqa: E731
    whole, found = whole_and_legs(pair_at(0.0), made, 12.0, **how)
    # A cube is zero to rounding over 1e-5 of the place.
    np.testing.assert_allclose(found, whole, rtol=0, atol=1e-4)


@pytest.mark.parametrize("how", [{}, {"method": "dop853"}, {"method": "kahan_li8", "dt": 2.0**-6}])
@pytest.mark.parametrize("first", ["plane", "function", "distance"])
def test_another_event_at_that_time_is_told_in_one_of_the_two_runs(first: str, how: dict[str, Any]) -> None:
    """Beside an event that ends a leg another one, of the same zero: the whole run has it as often as its legs."""

    def events(terminal: bool) -> list[Any]:
        if first == "distance":
            near = vv.events.distance(0, 1, below=1.6, direction=0, terminal=terminal)
            return [near, vv.events.function(lambda _t, x, _v: float(np.linalg.norm(x[0] - x[1]) - 1.6))]
        other = vv.events.function(lambda _t, x, _v: -7.3 * float(x[0, 0] - 0.3))
        if first == "plane":
            return [vv.events.plane([0.3, 0.0, 0.0], [1.0, 0.0, 0.0], body=0, terminal=terminal), other]
        return [vv.events.function(of_one_coordinate, terminal=terminal), other]

    scene = pair_at(0.0)
    whole = scene.run(t=12.0, events=events(False), **how).events
    counts = np.zeros(2, dtype=int)
    for _ in range(20):
        out = scene.run(t=12.0, events=events(True), **how)
        counts += [np.count_nonzero(out.events.which == which) for which in (0, 1)]
        if out.status is not vv.Status.STOPPED:
            break
        scene = out.final
    assert counts.tolist() == [np.count_nonzero(whole.which == which) for which in (0, 1)]


def test_bodies_that_the_event_does_not_look_at_are_where_their_own_steps_lead() -> None:
    """Two of three bodies that nothing couples come to a distance; the third is where it is alone at that time."""
    places, speeds = [*APART.position.tolist(), [5.0, 1.0, 0.0]], [*APART.velocity.tolist(), [0.0, 0.3, 0.1]]
    scene = vv.Scene(vv.Particles([1.0, 2.0, 1.0], places, speeds), vv.Harmonic(1.0), vv.LinearDrag(50.0))
    asked = [vv.events.distance(0, 1, below=1.6, terminal=True)]
    out = scene.run(t=30.0, events=asked, method="verner98", rtol=1e-7)
    assert out.status is vv.Status.STOPPED
    third = vv.Scene(vv.Particles([1.0], places[2:], speeds[2:]), vv.Harmonic(1.0), vv.LinearDrag(50.0))
    alone = third.run(t=out.final.t0, method="verner98", rtol=1e-7)
    np.testing.assert_array_equal(out.final.particles.position[2], alone.position[-1, 0])
