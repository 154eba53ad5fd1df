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
