"""Bodies that torques turn, by Taylor series: alone under their weight, and beside all else that may act."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drawn_bodies import drawn_case
from test_scene_bodies import KEPT, errors, made, scene_of, states

import visviva as vv

DOWN = vv.UniformField([0.0, 0.0, -9.81])
# Of Brüls and Cardona's top at t = 2, to 16 digits (benches/python/rigid_scene.py).
CENTER = [-0.1504168227456418, -0.7241655916368957, -0.6730222695604441]
COLUMNS = ("position", "velocity", "orientation", "angular_velocity")
MOTOR = vv.AppliedTorque([0.1, 0.02, 0.3], frame="body")


def written(case: dict[str, Any]) -> bool:
    """Whether all that acts has a series."""
    return all(kind != "CompiledTorque" for kind, _ in case["forces"])


def held(**changes: Any) -> vv.RigidBodies:
    """A body of three moments, held beside its center."""
    given = {"moments": [0.5, 0.7, 0.9], "pivot": [-0.2, -0.3, -0.5], "angular_velocity": [0.5, 1.0, 1.5]} | changes
    return vv.RigidBody(1.0, position=[0.2, 0.3, 0.5], **given)


def bruls_cardona() -> vv.Scene:
    spins, inertia = [0.0, 150.0, -4.61538], np.diag([0.234375, 0.46875, 0.234375])
    body = vv.RigidBody(15.0, inertia=inertia, position=[0, 1, 0], angular_velocity=spins, pivot=[0, -1, 0])
    return vv.Scene(body, DOWN)


def kovalevskaya() -> vv.Scene:
    """Moments 2 : 2 : 1 about the point that is held, the center across the third axis."""
    center = np.array([0.5, 0.0, 0.0])
    inertia = np.diag([2.0, 2.0, 1.0]) - 0.25 * np.diag([0.0, 1.0, 1.0])
    body = vv.RigidBody(1.0, inertia=inertia, position=center, pivot=-center, angular_velocity=[0.3, 0.9, 0.7])
    return vv.Scene(body, vv.UniformField([0.0, 0.0, -1.0]))


@pytest.mark.parametrize("name", [name for name in KEPT if written(KEPT[name]["case"])])
def test_motions_found_elsewhere(name: str) -> None:
    out = scene_of(name).run(t=KEPT[name]["case"]["times"], method="taylor", rtol=2.5e-14)
    # Rounding of some hundred steps; the top turns by 300 rad, with some ε of each.
    bound = 5e-13 if name == "bruls_cardona_top" else 2e-14
    assert max(errors(out, states(name)).values()) <= bound, errors(out, states(name))
    np.testing.assert_allclose(np.linalg.norm(out.orientation, axis=-1), 1.0, rtol=0, atol=4 * np.finfo(float).eps)


@pytest.mark.parametrize("seed", [seed for seed in range(40) if written(drawn_case(seed)[0])])
def test_whatever_acts_is_in_the_series(seed: int) -> None:
    scene = made(drawn_case(seed)[0])
    found = scene.run(t=[0.7], method="taylor", rtol=1e-12)
    other = scene.run(t=[0.7], method="verner98", rtol=1e-13)
    for name in COLUMNS:
        size = max(1.0, float(np.abs(getattr(other, name)).max()))
        # Of tolerances of 1e-12 and 1e-13 of each of some ten steps; measured 2e-12 in 200 scenes.
        np.testing.assert_allclose(getattr(found, name), getattr(other, name), rtol=0.0, atol=2e-11 * size)


SCENES: dict[str, vv.Scene] = {
    "top": kovalevskaya(),
    "motor": vv.Scene(held(pivot=None), MOTOR, DOWN),
    "held motor": vv.Scene(held(), MOTOR, MOTOR, DOWN),
    "ball": vv.Scene(held(moments=[0.5, 0.5, 0.5]), DOWN),
    "rod": vv.Scene(
        held(moments=[0.5, 0.5, 0.0], angular_velocity=[0.5, 1.0, 0.0], pivot=[0.0, 0.0, -0.5]),
        vv.AppliedTorque([0.1, 0.02, 0.0], frame="body"),
        DOWN,
    ),
    "torque in space": vv.Scene(held(), vv.AppliedTorque([0.1, 0.02, 0.3]), DOWN),
    "drag": vv.Scene(held(), vv.RotationalDrag(0.1), DOWN),
    "held in a well": vv.Scene(held(), DOWN, vv.Harmonic(2.0)),
    "held and braked": vv.Scene(held(), DOWN, vv.LinearDrag(tau=5.0)),
    "held charge": vv.Scene(held(), DOWN, vv.UniformMagneticField([0.0, 0.0, 1.0], charge=0.7)),
    "held in a formula": vv.Scene(held(), vv.Harmonic(1.0), vv.ExpressionForce(potential=lambda r, v, t: r[0] ** 4)),
    "springs": vv.Scene(
        held(),
        vv.AttachedSpring(0, [0.3, 0.1, 0.2], 3.0, length=1.0, damping=0.2, anchor=[4.0, 0.0, 0.0]),
        vv.AttachedSpring(0, [0.0, 0.0, 0.0], 2.0, anchor=[0.0, 3.0, 0.0]),
    ),
    "planet and moon": vv.Scene(
        vv.Particles([1.0, 0.0], [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0]], [[0.0, 0.5, 0.0], [0.0, 0.0, 0.2]]),
        held(),
        vv.Gravity(0.3),
    ),
    "a point on a damped spring": vv.Scene(
        vv.Particles([1.0], [[2.0, 0.5, 0.0]], [[0.0, 0.5, 0.25]]),
        held(),
        vv.Spring(0, 1, k=2.0, length=1.0),
        vv.Damper(0, 1, c=0.3),
        DOWN,
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_motion_is_that_of_another_method(name: str) -> None:
    t = np.linspace(0.0, 5.0, 8)
    found = SCENES[name].run(t=t, method="taylor", rtol=1e-13)
    other = SCENES[name].run(t=t, method="verner98", rtol=1e-13)
    for column in COLUMNS:
        # Of a tolerance of 1e-13 of each of fifty steps, and a method of order 8 between its steps: measured 5e-11.
        np.testing.assert_allclose(getattr(found, column), getattr(other, column), rtol=0.0, atol=5e-10)
    np.testing.assert_allclose(found.position[-1], other.position[-1], rtol=0.0, atol=2e-12)


@pytest.mark.parametrize("name", SCENES)
def test_a_copy_is_what_it_is_alone(name: str) -> None:
    """In a register for each number, as with all numbers side by side in one."""
    scene = SCENES[name]
    rng = np.random.default_rng(3)
    spins = np.array(scene.rigid_bodies.angular_velocity) * rng.uniform(0.5, 1.5, (11, 1, 3))
    # One that begins at rest, and one about one axis.
    spins[3], spins[7, :, 1:] = 0.0, 0.0
    copies = scene.ensemble(angular_velocity=spins)
    asked: dict[str, Any] = {"t": np.linspace(0.0, 3.0, 4), "method": "taylor", "rtol": 1e-11}
    together = copies.run(threads=1, **asked)
    others = copies.run(threads=3, **asked)
    for column in COLUMNS:
        assert np.array_equal(getattr(together, column), getattr(others, column)), column
        for copy in (0, 3, 7, 10):
            alone = copies[copy].run(**asked)
            assert np.array_equal(getattr(alone, column), getattr(together, column)[copy]), (column, copy)


def test_copies_of_other_shapes_are_what_they_are_alone() -> None:
    """Where a component of the center is zero in some of them, and one is a rod."""
    moments = [[0.5, 0.7, 0.9], [0.5, 0.5, 0.5], [0.5, 0.5, 0.0], [0.4, 0.5, 0.9]]
    for loads in ([vv.AppliedTorque([0.1, 0.02, 0.0], frame="body")], [vv.RotationalDrag(0.1)]):
        scene = vv.Scene(vv.RigidBody(1.0, moments[0], angular_velocity=[0.5, 0.3, 0.0]), *loads, DOWN)
        copies = scene.ensemble(moments=np.array(moments)[:, None, :])
        together = copies.run(t=2.0, method="taylor")
        for copy in range(4):
            alone = copies[copy].run(t=2.0, method="taylor")
            for column in COLUMNS:
                assert np.array_equal(getattr(alone, column), getattr(together, column)[copy]), (column, copy)


@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_tops_take_them_by_themselves(rtol: float) -> None:
    out = bruls_cardona().run(t=2.0, rtol=rtol)
    assert out.plan.method == "taylor"
    # Held to 1e-13 a step, whatever is asked: 48 turns in a hundred steps.
    np.testing.assert_allclose(out.position[-1, 0], CENTER, rtol=0.0, atol=2e-13)
    for scene in (SCENES["motor"], SCENES["held motor"]):
        assert scene.plan(t=1.0).method == "taylor"
    for scene in (SCENES["drag"], SCENES["springs"], SCENES["planet and moon"], SCENES["torque in space"]):
        assert scene.plan(t=1.0).method == "verner98"


def test_kovalevskayas_constant() -> None:
    """|(ω₁ + iω₂)² − (γ₁ + iγ₂) mgl/I₃|², with γ the vertical along the axes (Acta Math. 12 (1889) 177)."""
    out = kovalevskaya().run(t=np.linspace(0.0, 1000.0, 301))
    x, y, z, w = np.moveaxis(out.orientation[:, 0], -1, 0)
    vertical = 2.0 * (x * z - w * y) + 2.0j * (y * z + w * x)
    spin = out.angular_velocity[:, 0, 0] + 1.0j * out.angular_velocity[:, 0, 1]
    constant = np.abs(spin**2 - 0.5 * vertical) ** 2
    # Some 2500 steps of 1e-13 each.
    np.testing.assert_allclose(constant, constant[0], rtol=1e-11, atol=0.0)


def test_functions_of_the_caller_have_none() -> None:
    name = next(name for name in KEPT if not written(KEPT[name]["case"]))
    with pytest.raises(vv.InvalidInput, match=r"method: taylor needs .* every torque, and CompiledTorque has none"):
        scene_of(name).run(t=1.0, method="taylor")


def test_there_and_back() -> None:
    for name in ("top", "held in a well", "planet and moon"):
        start = SCENES[name].run(t=[0.0, 1.0], method="taylor")
        back = SCENES[name].run(t=5.0, method="taylor", rtol=1e-13).final.run(t=0.0, method="taylor", rtol=1e-13)
        # Places and turns of size 1: up to 65 steps there and back, of 1e-13 each at the most (they come to 1e-14).
        np.testing.assert_allclose(back.position[-1], start.position[0], rtol=0.0, atol=1e-11)
        np.testing.assert_allclose(back.orientation[-1], start.orientation[0], rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("name", ["top", "held in a well", "planet and moon"])
def test_a_run_that_was_kept_is_it_and_goes_on_as_it_does(name: str, tmp_path: Path) -> None:
    out = SCENES[name].run(t=np.linspace(0.0, 2.0, 5), method="taylor")
    on = out.final.run(t=[2.5, 4.0], method="taylor")
    out.save(tmp_path / "run.npz")
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.Trajectory)
    assert loaded.plan == out.plan
    assert loaded.plan.method == "taylor"
    assert loaded.stats.steps == out.stats.steps
    assert loaded.scene == out.scene
    again = loaded.final.run(t=[2.5, 4.0], method="taylor")
    for found, expected in ((loaded, out), (again, on), (loaded.scene.run(t=out.t, method="taylor"), out)):
        assert found.recorded == expected.recorded
        for column in ("t", *expected.recorded, "energy"):
            assert np.array_equal(getattr(found, column), getattr(expected, column)), column
