"""Torques on rigid bodies as formulas: against other torques, closed forms, equations of Lagrange and energy.

Bounds: of methods that choose their steps errors of a few of the tolerance, of equal steps those of their order.
"""

import ctypes
import os
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from test_scene_bodies import KEPT, STEPS, errors, made, motor, states

import visviva as vv
from visviva import _core

TURN = np.array([0.3, -0.1, 0.2, 0.9]) / np.sqrt(0.95)
TENSOR = vv.rigid.matrix(TURN) @ np.diag([0.4, 0.7, 0.9]) @ vv.rigid.matrix(TURN).T
#: A body whose principal axes are not the axes that it is described by, nor those of space.
STONE = vv.RigidBody(
    1.0,
    inertia=(TENSOR + TENSOR.T) / 2,
    orientation=[0.1, 0.2, -0.3, np.sqrt(0.86)],
    angular_velocity=[0.5, -1.0, 0.7],
)
FIELD = np.array([0.2, -0.4, 0.9])
HOW: list[dict[str, Any]] = [
    {"rtol": 1e-12},
    {"method": "dop853", "rtol": 1e-12},
    {"method": "verner98", "rtol": 1e-12},
    {"method": "rk4", "dt": 0.002},
]


def magnet(t: Any, q: Any, w: Any, strength: Any = 0.8) -> list[Any]:
    """m × B in space, of a moment along the body's third axis."""
    x, y, z, u = q
    m = [2 * (x * z + y * u), 2 * (y * z - x * u), 1 - 2 * (x * x + y * y)]
    cross = (m[1] * FIELD[2] - m[2] * FIELD[1], m[2] * FIELD[0] - m[0] * FIELD[2], m[0] * FIELD[1] - m[1] * FIELD[0])
    return [strength * part for part in cross]


def motor_formula(t: Any, q: Any, w: Any) -> list[Any]:
    """The same as `motor`."""
    return [0.25 - 0.125 * w[0], 0.5 * t * q[3], 0.5 * q[0] - 0.0625 * t * w[2]]


def assert_close(out: vv.Trajectory, other: vv.Trajectory, bound: float = 1e-10) -> None:
    np.testing.assert_allclose(out.orientation, other.orientation, rtol=0, atol=bound)
    np.testing.assert_allclose(out.angular_velocity, other.angular_velocity, rtol=0, atol=bound)


@pytest.mark.parametrize("how", HOW, ids=str)
@pytest.mark.parametrize("frame", ["space", "body"])
def test_constants_are_an_applied_torque(frame: Any, how: dict[str, Any]) -> None:
    formula = vv.ExpressionTorque(lambda t, q, w, a: (a, -0.5, 0.25), frame=frame, parameters={"a": 0.375})
    applied = vv.AppliedTorque([0.375, -0.5, 0.25], frame=frame)
    assert_close(*(vv.Scene(STONE, load).run(t=[1.0, 3.0], **how) for load in (formula, applied)), bound=1e-11)


@pytest.mark.parametrize("how", HOW, ids=str)
def test_minus_the_angular_velocity_is_drag(how: dict[str, Any]) -> None:
    formula = vv.ExpressionTorque(lambda t, q, w, c: -c * w, frame="body", parameters={"c": 0.3})
    assert_close(*(vv.Scene(STONE, load).run(t=[1.0, 3.0], **how) for load in (formula, vv.RotationalDrag(0.3))))


@pytest.mark.parametrize(
    ("how", "bound"),
    [
        ({}, 1e-10),
        ({"method": "dop853", "rtol": 1e-12}, 1e-10),
        ({"method": "rk4", "dt": 0.005}, 1e-8),
        ({"method": "kahan_li8", "dt": 0.05}, 1e-12),
        ({"method": "leapfrog", "dt": 0.001}, 1e-5),
    ],
    ids=str,
)
@pytest.mark.parametrize("frame", ["space", "body"])
@pytest.mark.parametrize("t0", [0.0, 100.0])
def test_a_drive_about_a_principal_axis(how: dict[str, Any], bound: float, frame: Any, t0: float) -> None:
    """T = A cos νt: the spin is ω₀ + A/(Iν) sin νt, the angle the integral of that."""
    drive = vv.ExpressionTorque(
        lambda t, q, w, size, nu, t0: (0, 0, size * np.cos(nu * (t - t0))),
        frame=frame,
        parameters={"size": 0.8, "nu": 3.0, "t0": t0},
    )
    wheel = vv.RigidBody(1.0, [0.5, 0.6, 0.9], angular_velocity=[0.0, 0.0, 0.4])
    t = np.array([0.5, 1.7, 5.0])
    out = vv.Scene(wheel, drive, t0=t0).run(t=t0 + t, **how)
    spin = 0.4 + 0.8 / (0.9 * 3.0) * np.sin(3.0 * t)
    angle = 0.4 * t + 0.8 / (0.9 * 9.0) * (1.0 - np.cos(3.0 * t))
    np.testing.assert_allclose(out.angular_velocity[:, 0, 2], spin, rtol=0, atol=bound)
    found = np.stack([out.orientation[:, 0, 2], out.orientation[:, 0, 3]])
    np.testing.assert_allclose(found, [np.sin(angle / 2), np.cos(angle / 2)], rtol=0, atol=bound)
    np.testing.assert_array_equal(out.orientation[:, 0, :2], 0.0)


def test_a_motion_that_was_found_without_the_package() -> None:
    """The case of a compiled torque, of two bodies with axes of their own."""
    case = KEPT["compiled_torque"]["case"]
    bodies = made(case).rigid_bodies
    assert bodies is not None
    method, dt, bound = STEPS["compiled_torque"]
    out = vv.Scene(bodies, vv.ExpressionTorque(motor_formula, body=0)).run(t=case["times"], method=method, dt=dt)
    assert max(errors(out, states("compiled_torque")).values()) <= bound


@pytest.mark.parametrize("how", HOW, ids=str)
@pytest.mark.parametrize("held", [False, True])
def test_a_formula_is_what_the_compiled_function_is(how: dict[str, Any], held: bool) -> None:
    more: dict[str, Any] = {"pivot": [0.1, 0.0, -0.3]} if held else {}
    stone = vv.RigidBody(1.0, inertia=STONE.inertia[0], orientation=STONE.orientation[0], **more)
    formula, compiled = vv.ExpressionTorque(motor_formula), vv.CompiledTorque(motor)
    weight = vv.UniformField([0.0, 0.0, -1.0])
    assert_close(*(vv.Scene(stone, weight, load).run(t=[1.0, 3.0], **how) for load in (formula, compiled)), bound=1e-11)


@pytest.mark.parametrize("how", [*HOW, {"method": "kahan_li8", "dt": 0.02}], ids=str)
def test_a_magnet_keeps_its_energy(how: dict[str, Any]) -> None:
    """½ ω·I ω − m·B."""
    out = vv.Scene(STONE, vv.ExpressionTorque(magnet)).run(t=np.linspace(0.0, 10.0, 11), **how)
    axis = vv.rigid.rotate(out.orientation[:, 0], [0.0, 0.0, 1.0])
    spin = out.angular_velocity[:, 0]
    energy = np.einsum("ti,ij,tj->t", spin, STONE.inertia[0], spin) / 2 - 0.8 * axis @ FIELD
    np.testing.assert_allclose(energy, energy[0], rtol=0, atol=1e-9)
    assert np.ptp(axis @ FIELD) > 0.1


def test_a_compass_is_a_pendulum_of_lagrange() -> None:
    """I θ'' = −m B sin θ about a principal axis, of the sine of the whole angle out of the quaternion."""
    needle = vv.ExpressionTorque(lambda t, q, w, mb: (0, 0, -2 * mb * q[2] * q[3]), parameters={"mb": 1.7})
    body = vv.RigidBody(1.0, [0.4, 0.5, 0.6], orientation=[0, 0, np.sin(0.6), np.cos(0.6)])
    out = vv.Scene(body, needle).run(t=[1.0, 2.5, 8.0])
    compass = vv.Lagrangian(
        lambda q, v, t, i, mb: i * v[0] ** 2 / 2 + mb * np.cos(q[0]),
        ["theta"],
        position=[1.2],
        velocity=[0.0],
        parameters={"i": 0.6, "mb": 1.7},
    )
    theta = compass.run(t=[1.0, 2.5, 8.0], rtol=1e-12)
    angle = 2 * np.arctan2(out.orientation[:, 0, 2], out.orientation[:, 0, 3])
    np.testing.assert_allclose(angle, theta.position[:, 0], rtol=0, atol=1e-10)
    np.testing.assert_allclose(out.angular_velocity[:, 0, 2], theta.velocity[:, 0], rtol=0, atol=1e-10)


def test_on_every_body_or_on_one() -> None:
    two = [vv.RigidBody(1.0, [0.5, 0.6, 0.9], position=[3.0 * k, 0, 0], name=f"body {k}") for k in (0, 1)]
    push = vv.ExpressionTorque(lambda t, q, w: (0.0, 0.0, t))
    both = vv.Scene(*two, push).run(t=2.0).angular_velocity[-1, :, 2]
    np.testing.assert_allclose(both, 2.0 / 0.9, rtol=1e-12)
    one = vv.ExpressionTorque(lambda t, q, w: (0.0, 0.0, t), "body 1")
    np.testing.assert_allclose(vv.Scene(*two, one).run(t=2.0).angular_velocity[-1, :, 2], [0.0, 2.0 / 0.9], rtol=1e-12)


#: Methods that choose their steps and those that do not, with torques that look at velocities or not.
LOOKING: list[dict[str, Any]] = [{}, {"method": "dop853"}, {"method": "rk4", "dt": 0.05}]
COPIED = [(magnet, how) for how in (*LOOKING, {"method": "kahan_li8", "dt": 0.05})]
COPIED += [
    (lambda t, q, w, strength: (strength * np.sin(t) - w[0], q[1] / strength, np.exp(-w[2])), how) for how in LOOKING
]


@pytest.mark.parametrize(("function", "how"), COPIED)
@pytest.mark.parametrize("frame", ["space", "body"])
def test_copies_have_the_bits_that_they_have_alone(function: Any, how: dict[str, Any], frame: Any) -> None:
    load = vv.ExpressionTorque(function, frame=frame, parameters={"strength": 0.8})
    scene = vv.Scene(STONE, vv.RigidBody(1.0, [1.0, 2.0, 2.5], position=[3.0, 0, 0]), load, vv.RotationalDrag(0.0))
    rng = np.random.default_rng(3)
    copies = scene.ensemble(
        parameters={load: {"strength": rng.uniform(0.5, 2.0, 11)}}, velocity=rng.normal(size=(11, 2, 3))
    )
    runs = [copies.run(t=[0.5, 1.0], threads=threads, **how) for threads in (1, 3)]
    for copy in range(11):
        alone = copies[copy].run(t=[0.5, 1.0], **how)
        for out in runs:
            np.testing.assert_array_equal(out[copy].orientation, alone.orientation)
            np.testing.assert_array_equal(out[copy].angular_velocity, alone.angular_velocity)


SCRIPT = """
import hashlib, numpy as np, visviva as vv
for dt in (None, 0.05):
    formula = lambda t, q, w, k: (k * np.sin(t) - w[0], q[1] / k, np.exp(-w[2]))
    load = vv.ExpressionTorque(formula, parameters={"k": 0.8})
    stone = vv.RigidBody(1.0, inertia=[[0.4, 0.1, 0], [0.1, 0.5, 0], [0, 0, 0.6]], angular_velocity=[0.1, 0.5, 0.3])
    copies = vv.Scene(stone, load).ensemble(parameters={"ExpressionTorque": {"k": np.linspace(0.5, 2.0, 11)}})
    out = copies.run(t=[0.5, 1.0], dt=dt)
    print(hashlib.sha256(out.orientation.tobytes() + out.angular_velocity.tobytes()).hexdigest())
"""


@pytest.mark.skipif(len(_core.info()["simd_available"]) < 2, reason="one tier only")
def test_every_tier_has_the_same_bits() -> None:
    found = set()
    for tier in _core.info()["simd_available"]:
        environment = {**os.environ, "VISVIVA_SIMD": tier}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True
        )
        found.add(done.stdout)
    assert len(found) == 1


MIRROR = np.diag([1.0, -1.0, 1.0])
QUARTER = vv.rigid.matrix([0.3, 0.5, -0.1, np.sqrt(0.65)])


@pytest.mark.parametrize("frame", ["space", "body"])
@pytest.mark.parametrize("matrix", [QUARTER, MIRROR], ids=["turned", "mirrored"])
def test_rotated_scenes_move_as_the_rotated_motion(frame: Any, matrix: np.ndarray) -> None:
    scene = vv.Scene(STONE, vv.ExpressionTorque(motor_formula, frame=frame))
    here, there = scene.run(t=[1.0, 3.0], rtol=1e-12), scene.rotated(matrix).run(t=[1.0, 3.0], rtol=1e-12)
    np.testing.assert_allclose(there.angular_velocity, here.angular_velocity, rtol=0, atol=1e-10)
    seen = [vv.rigid.matrix(out.orientation) for out in (here, there)]
    np.testing.assert_allclose(seen[1], np.linalg.det(matrix) * matrix @ seen[0], rtol=0, atol=1e-10)
    # Twice is the turn by both.
    again = scene.rotated(matrix).rotated(QUARTER).run(t=[1.0, 3.0], rtol=1e-12)
    np.testing.assert_allclose(again.angular_velocity, here.angular_velocity, rtol=0, atol=1e-10)


def test_rescaled_scenes_move_as_the_rescaled_motion() -> None:
    scene = vv.Scene(STONE, vv.ExpressionTorque(motor_formula), t0=0.5)
    other = scene.rescaled(length=1e3, mass=0.1, time=60.0)
    here, there = scene.run(t=[1.0, 3.0], rtol=1e-12), other.run(t=[60.0, 180.0], rtol=1e-12)
    np.testing.assert_allclose(there.angular_velocity * 60.0, here.angular_velocity, rtol=0, atol=1e-10)
    np.testing.assert_allclose(there.orientation, here.orientation, rtol=0, atol=1e-10)


def test_a_formula_of_orientations_runs_back() -> None:
    torque = vv.ExpressionTorque(magnet)
    assert torque.reversed() == torque
    out = vv.Scene(STONE, torque).run(t=[2.0], method="kahan_li8", dt=0.01)
    back = out.final.run(t=0.0, method="kahan_li8", dt=0.01)
    np.testing.assert_allclose(back.orientation[-1], STONE.orientation, rtol=0, atol=1e-13)
    for looking in (lambda t, q, w: (t, 0, 0), lambda t, q, w: (0, w[0], 0)):
        with pytest.raises(vv.InvalidInput, match="forces: ExpressionTorque cannot be reversed"):
            vv.ExpressionTorque(looking).reversed()


CHOSEN: list[dict[str, Any]] = [
    {},
    {"method": "dop853"},
    {"method": "verner98", "rtol": 1e-8},
    {"method": "tsitouras54"},
]


@pytest.mark.parametrize("how", CHOSEN, ids=str)
@pytest.mark.parametrize("frame", ["space", "body"])
@pytest.mark.parametrize("width", [1e-2, 1e-5])
def test_a_pulse_is_not_passed_over(how: dict[str, Any], frame: Any, width: float) -> None:
    """A kick of ∫ T dt = √π A w in a run of a thousand; other copies have it elsewhere, or none."""
    pulse = vv.ExpressionTorque(
        lambda t, q, w, size, at, width: (0, 0, size * np.exp(-(((t - at) / width) ** 2))),
        frame=frame,
        parameters={"size": 1.0 / width, "at": 437.0, "width": width},
    )
    wheel = vv.RigidBody(1.0, [0.5, 0.6, 0.9])
    kick = np.sqrt(np.pi) / 0.9
    out = vv.Scene(wheel, pulse).run(t=1000.0, **how)
    assert out.angular_velocity[-1, 0, 2] == pytest.approx(kick, rel=1e-6, abs=0.0)
    at = np.array([3.0, 437.0, 800.0, 2000.0])
    copies = vv.Scene(wheel, pulse).ensemble(parameters={pulse: {"at": at}}).run(t=1000.0, **how)
    assert copies.angular_velocity[:, -1, 0, 2] == pytest.approx(np.where(at < 1000.0, kick, 0.0), rel=1e-6, abs=0.0)
    np.testing.assert_array_equal(copies[1].angular_velocity, out.angular_velocity)


@pytest.mark.parametrize("how", CHOSEN[:2], ids=str)
def test_a_narrow_bump_of_the_orientation_is_not_passed_over(how: dict[str, Any]) -> None:
    """Its work at each passage is ∫ A exp(−(tan ½θ / w)²) dθ, which for a narrow one is 2 √π A w."""
    bump = vv.ExpressionTorque(
        lambda t, q, w, width: (0, 0, np.exp(-((q[2] / (width * q[3])) ** 2)) / width), parameters={"width": 1e-4}
    )
    start = vv.rigid.quaternion_from_rotation_vector([0.0, 0.0, -1.0])
    wheel = vv.RigidBody(1.0, [0.5, 0.6, 0.9], orientation=start, angular_velocity=[0.0, 0.0, 2.0])
    out = vv.Scene(wheel, bump).run(t=1.0, **how)
    gained = 0.9 * (out.angular_velocity[-1, 0, 2] ** 2 - 4.0) / 2
    assert gained == pytest.approx(2 * np.sqrt(np.pi), rel=1e-6, abs=0.0)


def test_what_is_no_number_ends_a_run() -> None:
    lost = vv.Scene(STONE, vv.ExpressionTorque(lambda t, q, w: (0, 0, np.sqrt(1.0 - t))))
    with pytest.raises(vv.Error):
        lost.run(t=3.0)


def test_methods_that_take_none_say_so() -> None:
    looking, still = (vv.Scene(STONE, vv.ExpressionTorque(each)) for each in (motor_formula, magnet))
    with pytest.raises(vv.InvalidInput, match=r"method: got kahan_li8, .*; ExpressionTorque looks at velocities"):
        looking.run(t=1.0, method="kahan_li8", dt=0.1)
    assert looking.run(t=1.0, dt=0.01).plan.method == "rk4"
    assert still.run(t=1.0, dt=0.01).plan.method == "kahan_li8"
    for scene in (looking, still):
        assert scene.plan(t=1.0).method == "verner98"
        assert "torques turn 1 rigid body" in str(scene.plan(t=1.0))
        with pytest.raises(
            vv.InvalidInput, match=r"method: taylor needs .* and ExpressionTorque has none; use verner98"
        ):
            scene.run(t=1.0, method="taylor")


def test_compiled_functions_go_elsewhere() -> None:
    for compiled in (motor, ctypes.cast(motor, ctypes.c_void_p).value):
        with pytest.raises(vv.InvalidInput, match=r"function: expected a function f\(t, .*vv\.CompiledTorque"):
            vv.ExpressionTorque(compiled)
