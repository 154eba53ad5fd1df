"""Tolerances in words: a refusal names a method that the scene can be run with, and plans print no rounding digits."""

import re

import pytest

import visviva as vv

POINT = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
BODY = vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 2.0, 0.0])
PAIR = vv.Particles([1.0, 1e-3], [[0.0, 0, 0], [1.0, 0, 0]], [[0, 0, 0], [0, 1.0, 0]])

SCENES = {
    "positions": (vv.Scene(POINT, vv.Harmonic(1.0)), "kahan_li8"),
    "time": (vv.Scene(POINT, vv.DrivenForce([1.0, 0.0, 0.0], 2.0)), "kahan_li8"),
    "magnetic field": (vv.Scene(POINT, vv.UniformMagneticField([0.0, 0.0, 1.0])), "boris4"),
    "drag": (vv.Scene(POINT, vv.LinearDrag(tau=3.0)), "rk4"),
    "drag in a field": (vv.Scene(POINT, vv.UniformMagneticField([0.0, 0.0, 1.0]), vv.LinearDrag(tau=3.0)), "rk4"),
    "relativity": (vv.Scene(PAIR, vv.Gravity(G=1.0), vv.PostNewtonian(0, G=1.0, c=100.0)), "rk4"),
    "a body": (vv.Scene(BODY, vv.AppliedTorque([0.0, 0.0, 1.0])), "kahan_li8"),
    "a body in a field": (vv.Scene(BODY, vv.UniformMagneticField([0.0, 0.0, 1.0])), "rk4"),
    "a body that is slowed": (vv.Scene(BODY, vv.RotationalDrag(0.1)), "rk4"),
    "a damped spring": (
        vv.Scene(BODY, vv.AttachedSpring(0, [0.0, 0.0, 1.0], stiffness=1.0, damping=1.0, anchor=[0.0, 0.0, 3.0])),
        "rk4",
    ),
}


@pytest.mark.parametrize(("scene", "method"), SCENES.values(), ids=SCENES)
def test_a_tolerance_that_is_too_small_is_answered_with_a_method_for_the_forces(scene: vv.Scene, method: str) -> None:
    with pytest.raises(vv.InvalidInput, match=r"^rtol: expected 2\.3e-14 ") as refused:
        scene.run(t=0.25, rtol=1e-14)
    named = re.search(r"a smaller error needs a fixed-step method such as (\w+)$", str(refused.value))
    assert named
    assert named[1] == method
    assert scene.run(t=0.25, method=named[1], dt=0.0625).status == vv.Status.OK  # type: ignore[arg-type]


@pytest.mark.parametrize(("rtol", "told"), [(1e-6, "1e-9"), (2e-7, "2e-10"), (1e-4, "1e-7"), (2.5e-6, "2.5e-9")])
def test_plans_print_no_rounding_of_a_tolerance(rtol: float, told: str) -> None:
    """Steps of bodies are held to a thousandth of rtol, whose last digit is none that anybody has given."""
    plan = vv.Scene(BODY, vv.RotationalDrag(0.1)).plan(t=1.0, rtol=rtol)
    assert ("relative tolerance", told) in [row[:2] for row in plan.rows]
