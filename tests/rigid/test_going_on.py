"""Runs of bodies that torques turn go on from ``final`` to the bits of one run, as those of points do."""

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

TENSOR = [[1.0, 0.1, 0.2], [0.1, 1.2, 0.3], [0.2, 0.3, 1.4]]
TURN = [0.1, 0.2, 0.3, np.sqrt(0.86)]
DOWN = vv.UniformField([0.0, 0.0, -9.8])


def body(**more: Any) -> vv.RigidBodies:
    return vv.RigidBody(1.3, inertia=TENSOR, angular_velocity=[0.3, 1.2, 0.5], orientation=TURN, **more)


SCENES: dict[str, Callable[[], vv.Scene]] = {
    "torque": lambda: vv.Scene(body(), vv.AppliedTorque([0.1, 0.2, 0.3]), DOWN),
    "pivot": lambda: vv.Scene(body(pivot=[0.1, 0.2, -0.5]), DOWN),
    "several": lambda: vv.Scene(
        vv.Particles([1.0, 2.0], [[3.0, 0, 0], [-4.0, 1, 1]], [[0, 0.1, 0], [0, 0, 0.1]]),
        body(),
        vv.RigidBody(1.0, [1.0, 2.0, 2.5], position=[0, 5, 5], angular_velocity=[1, 2, 3]),
        vv.Gravity(G=1.0),
        vv.AttachedSpring(0, [0.1, 0.2, 0.3], 2.0, to=1),
    ),
}
METHODS = ["leapfrog", "leapfrog_dkd", "kahan_li8", "blanes_moan_rkn6_14", "rk4", "moser_veselov8", "rattle", "auto"]


def same(one: vv.Scene, other: vv.Scene) -> bool:
    return one.particles == other.particles and one.rigid_bodies == other.rigid_bodies and one.t0 == other.t0


@pytest.mark.filterwarnings("ignore:.*the energy at the end:visviva.AccuracyWarning")  # bits are asked for, not digits
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", SCENES)
def test_legs_have_the_bits_of_one_run(name: str, method: Any, tmp_path: Path) -> None:
    scene = SCENES[name]()
    how: dict[str, Any] = {"method": method, "dt": 0.1}
    whole = scene.run(t=2.0, **how).final
    plain, pickled, stored = scene, scene, scene
    for t in (0.7, 1.3, 2.0):
        plain = plain.run(t=t, **how).final
        pickled = pickle.loads(pickle.dumps(pickled.run(t=t, **how).final))
        stored.run(t=t, **how).save(tmp_path / "leg.npz")
        loaded = vv.load(tmp_path / "leg.npz")
        assert isinstance(loaded, vv.Trajectory)
        stored = loaded.final
    assert same(plain, whole)
    assert same(pickled, whole)
    assert same(stored, whole)


def test_torques_at_velocities_go_on() -> None:
    scene = vv.Scene(body(), vv.RotationalDrag(0.1), vv.AppliedTorque([0.1, 0.2, 0.3], frame="body"))
    first = scene.run(t=0.7, method="rk4", dt=0.1).final
    assert same(first.run(t=2.0, method="rk4", dt=0.1).final, scene.run(t=2.0, method="rk4", dt=0.1).final)


@pytest.mark.filterwarnings("ignore:.*the energy at the end:visviva.AccuracyWarning")  # bits are asked for, not digits
def test_copies_go_on_and_one_of_them() -> None:
    scene = SCENES["several"]()
    spins = np.random.default_rng(1).normal(size=(11, 2, 3))
    copies, how = scene.ensemble(angular_velocity=spins), {"method": "kahan_li8", "dt": 0.1}
    whole = copies.run(t=2.0, **how)
    half = copies.run(t=0.7, **how).final
    again = half.run(t=2.0, **how)
    for name in ("position", "velocity", "orientation", "angular_velocity"):
        assert np.array_equal(getattr(again, name)[:, -1], getattr(whole, name)[:, -1])
    assert same(half[3].run(t=2.0, **how).final, whole.final[3])
    assert "goes on from node 7" in str(half.plan(t=2.0, **how))


def test_another_step_or_another_scene_begins_anew() -> None:
    half = SCENES["pivot"]().run(t=0.7, method="kahan_li8", dt=0.1).final
    assert "goes on" in str(half.plan(t=2.0, method="kahan_li8", dt=0.1))
    assert "goes on" not in str(half.plan(t=2.0, method="kahan_li8", dt=0.05))
    assert "goes on" not in str(half.plan(t=2.0, method="leapfrog", dt=0.1))
    assert "goes on" not in str(half.shifted(position=[0.0, 0.0, 1.0]).plan(t=2.0, method="kahan_li8", dt=0.1))


def test_the_cost_of_many_copies_is_told() -> None:
    spins = np.random.default_rng(1).normal(size=(100, 1, 3))
    turned = SCENES["torque"]().ensemble(angular_velocity=spins).plan(t=10.0, dt=0.1).cost()
    free = vv.Scene(body()).ensemble(angular_velocity=spins).plan(t=10.0).cost()
    assert turned is not None
    assert turned.steps == 100 * 100
    assert free is not None
