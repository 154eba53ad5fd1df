"""`Scene.with_state` of rigid bodies: what is held stays where it is, and what follows from a spin follows it."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

DOWN = vv.UniformField([0.0, 0.0, -9.81])
TURN = vv.rigid.quaternion_from_rotation_vector([1.0, 0.3, -0.2])
FREE = [np.nan] * 3


def hung() -> vv.Scene:
    """A particle, a body with a fixed point and a free one, all of them moving."""
    bodies = vv.RigidBodies(
        [2.0, 1.0],
        [[1.0, 1.2, 1.5], [0.4, 0.5, 0.6]],
        position=[[0.1, 0.2, 0.3], [3.0, 0.0, 0.0]],
        velocity=[[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
        angular_velocity=[[1.0, 0.2, 0.0], [0.0, 0.0, 1.0]],
        pivot=[[0.0, 0.2, 0.1], FREE],
        names=["brick", "ball"],
    )
    return vv.Scene(vv.Particles([1.0], [[9.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]], names=["stone"]), bodies, DOWN)


def rigid(scene: vv.Scene) -> vv.RigidBodies:
    assert scene.rigid_bodies is not None
    return scene.rigid_bodies


def test_a_turned_body_hangs_from_the_same_point() -> None:
    scene = hung()
    turned = scene.with_state(orientation=[TURN, TURN])
    np.testing.assert_allclose(rigid(turned).fixed_point[0], rigid(scene).fixed_point[0], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(turned.particles.position[[0, 2]], scene.particles.position[[0, 2]])
    np.testing.assert_array_equal(turned.particles.velocity[[0, 2]], scene.particles.velocity[[0, 2]])
    # The velocity of its center is ω × arm, in space.
    arm = turned.particles.position[1] - rigid(turned).fixed_point[0]
    spin = vv.rigid.rotate(TURN, rigid(scene).angular_velocity[0])
    np.testing.assert_allclose(turned.particles.velocity[1], np.cross(spin, arm), rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    "given",
    [
        {"orientation": [TURN, TURN]},
        {"angular_velocity": [[2.0, 0.0, -1.0], [0.0, 1.0, 0.0]]},
        {"orientation": [TURN, TURN], "angular_velocity": [[2.0, 0.0, -1.0], [0.0, 1.0, 0.0]]},
    ],
)
def test_it_is_the_scene_that_a_copy_of_an_ensemble_has(given: dict[str, Any]) -> None:
    # From a state in the middle of a motion, too, as a run leaves it.
    for scene in (hung(), hung().run(t=0.3, method="kahan_li8", dt=0.01).final):
        copy = scene.ensemble(**{name: [value] for name, value in given.items()})[0]
        assert scene.with_state(**given) == copy


def test_another_place_takes_the_held_point_along() -> None:
    scene = hung()
    moved = scene.with_state(position=scene.particles.position + np.array([0.0, 0.0, 5.0]))
    np.testing.assert_allclose(rigid(moved).fixed_point[0], rigid(scene).fixed_point[0] + [0, 0, 5.0], rtol=1e-15)
    np.testing.assert_array_equal(moved.particles.velocity, scene.particles.velocity)


def test_what_does_not_follow_or_is_not_there_is_refused() -> None:
    scene = hung()
    other = scene.particles.velocity + np.array([0.0, 0.1, 0.0])
    with pytest.raises(vv.InvalidInput, match=r"^velocity: .*brick"):
        scene.with_state(velocity=other, angular_velocity=[[2.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    points = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]]))
    for name, value in (("orientation", [TURN]), ("angular_velocity", [[1.0, 0.0, 0.0]])):
        given: dict[str, Any] = {name: value}
        with pytest.raises(vv.InvalidInput, match=rf"^{name}: .*no rigid bodies"):
            points.with_state(**given)
