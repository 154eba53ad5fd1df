"""Rigid bodies of a scene as values: what the core is given, other frames and units, and what is refused.

Bounds: products of a rotation with numbers of size 1, some EPSILON; energies and momenta are sums of a few of these.
"""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import visviva as vv

EPSILON = np.finfo(float).eps
FREE = [np.nan] * 3
TURN = Rotation.from_rotvec([0.3, -1.1, 0.7])


def pair() -> vv.RigidBodies:
    return vv.RigidBodies(
        mass=[2.0, 15.0],
        moments=[[1.0, 2.0, 2.5], [0.25, 0.5, 0.25]],
        position=[[1.0, 2.0, 3.0], [0.0, 0.0, -1.0]],
        velocity=[[0.5, 0.0, -0.5], [0.0, 0.0, 0.0]],
        orientation=[[0.0, 0.0, 0.0, 1.0], TURN.as_quat()],
        angular_velocity=[[0.1, 5.0, 0.1], [1.0, 150.0, -4.0]],
        pivot=[FREE, [0.0, -1.0, 0.0]],
        names=["brick", "top"],
    )


def oblique() -> vv.RigidBodies:
    """A body whose tensor is not diagonal, about a fixed point off its axes."""
    tensor = TURN.as_matrix() @ np.diag([1.0, 2.0, 2.5]) @ TURN.as_matrix().T
    tensor = (tensor + tensor.T) / 2
    spin = [0.3, -0.4, 0.5]
    return vv.RigidBody(
        3.0, inertia=tensor, orientation=[0.5, 0.5, -0.5, 0.5], angular_velocity=spin, pivot=[0.1, 0.7, -0.2]
    )


def steiner(tensor, mass, arm):
    return tensor + mass * (np.dot(arm, arm) * np.eye(3) - np.outer(arm, arm))


def test_a_body_with_diagonal_moments_keeps_its_axes() -> None:
    bodies = pair()
    np.testing.assert_array_equal(bodies.axes, [[0, 0, 0, 1], [0, 0, 0, 1]])
    # About the fixed point of Brüls and Cardona's top, exactly: 15 · 1² on both axes across.
    np.testing.assert_array_equal(bodies.principal_moments, [[1.0, 2.0, 2.5], [15.25, 0.5, 15.25]])
    np.testing.assert_array_equal(bodies.center, [[0, 0, 0], [0, 1, 0]])
    np.testing.assert_array_equal(bodies.pivoted, [False, True])
    diagonal = vv.RigidBody(1.0, inertia=np.diag([3.0, 1.0, 2.5]))
    np.testing.assert_array_equal(diagonal.principal_moments, [[3.0, 1.0, 2.5]])
    np.testing.assert_array_equal(diagonal.axes, [[0, 0, 0, 1]])


def test_principal_axes_give_back_the_tensor_about_the_fixed_point() -> None:
    body = oblique()
    assert body.inertia is not None
    assert body.pivot is not None
    turn = Rotation.from_quat(body.axes[0]).as_matrix()
    back = turn @ np.diag(body.principal_moments[0]) @ turn.T
    expected = steiner(body.inertia[0], 3.0, body.pivot[0])
    # Products of rotation matrices round to a few ε of the largest entry.
    np.testing.assert_allclose(back, expected, rtol=0, atol=16 * EPSILON * np.abs(expected).max())
    np.testing.assert_allclose(turn @ body.center[0], -body.pivot[0], rtol=0, atol=8 * EPSILON)


def test_the_velocity_of_a_body_with_a_fixed_point_follows_from_its_spin() -> None:
    body = oblique()
    assert body.pivot is not None
    turn = Rotation.from_quat(body.orientation[0])
    follows = turn.apply(np.cross(body.angular_velocity[0], -body.pivot[0]))
    np.testing.assert_allclose(body.velocity[0], follows, rtol=0, atol=8 * EPSILON)
    np.testing.assert_allclose(body.fixed_point[0], turn.apply(body.pivot[0].copy()), rtol=0, atol=8 * EPSILON)
    # What a run returns can be given back.
    again = vv.RigidBody(
        3.0,
        inertia=body.inertia[0],
        velocity=body.velocity[0] * (1 + 1e-12),
        orientation=body.orientation[0],
        angular_velocity=body.angular_velocity[0],
        pivot=body.pivot[0],
    )
    np.testing.assert_array_equal(again.velocity, body.velocity)
    with pytest.raises(vv.InvalidInput, match=r"velocity: expected 0 .* follows from its spin"):
        vv.RigidBody(1.0, [1.0, 1.0, 1.0], velocity=[0, 0, 1e-300], pivot=[0, 0, 1])
    with pytest.raises(vv.InvalidInput, match=r"velocity.*that of top"):
        pair()._changed(velocity=[[0, 0, 0], [1, 0, 0]])


def test_rods_have_a_moment_of_zero() -> None:
    straight = vv.RigidBody(1.0, [0.0, 2.0, 2.0], angular_velocity=[0.0, 1.0, 3.0])
    assert straight.principal_moments[0, 0] == 0.0
    tensor = vv.rigid.rotate_tensor(np.diag([0.0, 2.0, 2.0]), TURN.as_quat())
    across = TURN.apply([0.0, 1.0, 3.0])
    leaning = vv.RigidBody(1.0, inertia=tensor, angular_velocity=across)
    assert leaning.principal_moments[0, 0] == 0.0  # not what rounding leaves of it
    for body in ({"moments": [0.0, 2.0, 2.0]}, {"inertia": tensor}):
        with pytest.raises(vv.InvalidInput, match="angular_velocity: expected no spin about the axis of a rod"):
            vv.RigidBody(1.0, **body, angular_velocity=[0.1, 1.0, 3.0])
    # A thin body that is none: 1e6 times as long as wide.
    assert vv.RigidBody(1.0, [1e-12, 2.0, 2.0], angular_velocity=[1.0, 0, 0]).principal_moments[0, 0] == 1e-12


def test_the_core_is_given_contiguous_arrays() -> None:
    given = pair()._core_arguments()
    shapes = {
        "mass": (2,),
        "position": (2, 3),
        "velocity": (2, 3),
        "moments": (2, 3),
        "axes": (2, 4),
        "center": (2, 3),
        "pivoted": (2,),
        "orientation": (2, 4),
        "angular_velocity": (2, 3),
    }
    assert {name: array.shape for name, array in given.items()} == shapes
    for name, array in given.items():
        assert array.flags.c_contiguous, name
        assert not array.flags.writeable, name
        assert array.dtype == (np.bool_ if name == "pivoted" else np.float64), name


def test_bodies_are_values() -> None:
    bodies = pair()
    for same in (pair(), pickle.loads(pickle.dumps(bodies)), copy.deepcopy(bodies), bodies[[0, 1]], bodies[:]):
        assert same == bodies
        assert hash(same) == hash(bodies)
        np.testing.assert_array_equal(same.principal_moments, bodies.principal_moments)
    assert bodies["top"] == bodies[1]
    assert [len(body) for body in bodies] == [1, 1]
    assert bodies[0].pivot is None  # a free body alone has none
    assert bodies != bodies[::-1]
    assert bodies != replace(bodies, mass=[2.0, 16.0])
    assert bodies != replace(bodies, pivot=[[0.0, 0.0, 0.0], [0.0, -1.0, 0.0]], velocity=None)
    assert bodies != vv.Particles([1.0], [[0, 0, 0]])
    assert bodies.index("top") == 1
    assert repr(bodies) == "RigidBodies(2 bodies, 1 of them about a fixed point: brick, top)"
    assert len(bodies[[]]) == 0
    with pytest.raises(vv.FrozenAttribute):
        bodies.mass = np.ones(2)  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        bodies.position[0, 0] = 1.0
    given = np.array([2.0])
    body = vv.RigidBodies(given, [[1.0, 1.0, 1.0]])
    given[0] = 7.0
    assert body.mass[0] == 2.0
    ball = {"mass": [1.0], "moments": [[1.0, 1.0, 1.0]]}
    assert vv.RigidBodies(**ball, pivot=[FREE]) == vv.RigidBodies(**ball)
    assert vv.RigidBodies(**ball, orientation=Rotation.from_rotvec([[0, 0, np.pi]])).orientation[0, 2] == 1.0
    assert vv.RigidBody(1.0, [1.0, 1.0, 1.0], orientation=TURN) == vv.RigidBody(
        1.0, [1.0] * 3, orientation=TURN.as_quat()
    )
    near = vv.RigidBody(1.0, [1.0, 1.0, 1.0], orientation=[0.0, 0.0, 0.0, 1.0 + 5e-7])
    np.testing.assert_array_equal(near.orientation, [[0, 0, 0, 1]])


def momenta(bodies: vv.RigidBodies) -> tuple[np.ndarray, float]:
    """Angular momentum about the origin and kinetic energy, by the tensors in space."""
    total, energy = np.zeros(3), 0.0
    for k in range(len(bodies)):
        if bodies.inertia is not None:
            tensor = bodies.inertia[k]
        else:
            assert bodies.moments is not None
            tensor = np.diag(bodies.moments[k])
        spin = bodies.angular_velocity[k]
        own = Rotation.from_quat(bodies.orientation[k]).apply(tensor @ spin)
        total = total + own + bodies.mass[k] * np.cross(bodies.position[k], bodies.velocity[k])
        energy += 0.5 * spin @ tensor @ spin + 0.5 * bodies.mass[k] * bodies.velocity[k] @ bodies.velocity[k]
    return total, energy


ROTATION = Rotation.from_rotvec([0.4, 0.9, -0.2]).as_matrix()


@pytest.mark.parametrize("matrix", [ROTATION, -ROTATION, np.diag([1.0, -1.0, 1.0])])
@pytest.mark.parametrize("bodies", [pair(), oblique()], ids=["pair", "oblique"])
def test_turned_and_mirrored_bodies_have_turned_and_mirrored_momenta(
    bodies: vv.RigidBodies, matrix: np.ndarray
) -> None:
    (before, energy), turned = momenta(bodies), bodies.rotated(matrix)
    after, same = momenta(turned)
    assert same == pytest.approx(energy, rel=1e-14, abs=0)
    # Angular momentum is axial; a few products of 16 digits.
    np.testing.assert_allclose(after, np.linalg.det(matrix) * matrix @ before, rtol=0, atol=1e-12)
    np.testing.assert_allclose(turned.fixed_point, bodies.fixed_point @ matrix.T, rtol=0, atol=1e-14)
    np.testing.assert_allclose(turned.velocity, bodies.velocity @ matrix.T, rtol=0, atol=1e-12)
    np.testing.assert_allclose(turned.principal_moments, bodies.principal_moments, rtol=1e-14)


def test_other_frames_and_units() -> None:
    bodies = pair()
    back = bodies.reversed()
    np.testing.assert_array_equal(back.angular_velocity, -bodies.angular_velocity)
    np.testing.assert_array_equal(back.velocity, -bodies.velocity)
    moved = bodies.shifted(np.array([1.0, 2.0, 4.0]), np.zeros(3))
    np.testing.assert_array_equal(moved.position, bodies.position + np.array([1.0, 2.0, 4.0]))
    with pytest.raises(vv.InvalidInput, match="velocity: the fixed point of top would move"):
        bodies.shifted(np.zeros(3), np.ones(3))
    np.testing.assert_array_equal(bodies[0].shifted(np.zeros(3), np.ones(3)).velocity, [[1.5, 1.0, 0.5]])
    changed = bodies.rescaled(length=4.0, mass=2.0, time=8.0)
    np.testing.assert_array_equal(changed.principal_moments, 32.0 * bodies.principal_moments)
    np.testing.assert_array_equal(changed.velocity, 0.5 * bodies.velocity)
    np.testing.assert_array_equal(changed.fixed_point, 4.0 * bodies.fixed_point)
    assert momenta(changed)[1] == pytest.approx(2.0 * 4.0**2 / 8.0**2 * momenta(bodies)[1], rel=1e-14, abs=0)
    assert changed.rescaled(length=1 / 4, mass=1 / 2, time=1 / 8) == bodies
    with pytest.raises(vv.InvalidInput, match="moments: expected units in which it stays within float64"):
        bodies.rescaled(length=1e-200)


GOOD = {"mass": [1.0, 1.0], "moments": [[1.0, 2.0, 2.5], [1.0, 1.0, 1.0]]}
TENSOR = np.diag([1.0, 2.0, 2.5])


@pytest.mark.parametrize(
    ("changes", "argument", "words"),
    [
        ({"mass": [1.0, 0.0]}, "mass", r"expected positive masses, but mass\[1\] is 0.0"),
        ({"mass": [1.0, -1.0]}, "mass", r"mass\[1\] is -1.0"),
        ({"mass": [1.0, np.nan]}, "mass", r"mass\[1\] is nan"),
        ({"mass": [1.0]}, "moments", r"expected shape \(K, 3\) with K = 1 as in mass, got \(2, 3\)"),
        ({"mass": 1.0}, "mass", r"expected shape \(K,\)"),
        ({"moments": None}, "moments", "expected one of moments and inertia, got neither"),
        ({"inertia": [TENSOR, TENSOR]}, "moments", "expected one of moments and inertia, got both"),
        (
            {"moments": [[1.0, 2.0, 2.5], [1.0, 1.0, 2.25]]},
            "moments",
            r"but moments\[2\] = 2.25 is larger by 0.25 \(body 1\)",
        ),
        ({"moments": [[1.0, 2.0, 2.5], [1.0, 1.0, -1.0]]}, "moments", r"moments\[2\] is -1.0 \(body 1\)"),
        ({"moments": [[1.0, 2.0, 2.5], [0.0, 0.0, 0.0]]}, "moments", r"zeros.*\(body 1\)"),
        ({"moments": [[1.0, 2.0, 2.5], [1.0, np.inf, 1.0]]}, "moments", r"moments\[1, 1\] is inf"),
        (
            {"moments": None, "inertia": [TENSOR, TENSOR + np.diag([0, 0, 1.0])]},
            "inertia",
            r"is larger by 0.5 \(in order of size\) \(body 1\)",
        ),
        (
            {"moments": None, "inertia": [TENSOR, TENSOR + np.eye(3, k=1)]},
            "inertia",
            r"symmetric tensor, but inertia\[0, 1\] = 1.0 and inertia\[1, 0\] = 0.0 \(body 1\)",
        ),
        ({"moments": None, "inertia": [TENSOR, np.zeros((3, 3))]}, "inertia", "zeros: a point has no orientation"),
        ({"moments": None, "inertia": TENSOR}, "inertia", r"expected shape \(K, 3, 3\)"),
        ({"orientation": [[0, 0, 0, 1], [0, 0, 0, 0]]}, "orientation", r"zero is no rotation \(body 1\)"),
        ({"orientation": [[0, 0, 0, 1], [0, 0, 0, 1 + 2e-6]]}, "orientation", "of length 1 within 1e-6"),
        ({"orientation": [[0, 0, 0, 1]]}, "orientation", r"expected shape \(K, 4\) with K = 2"),
        ({"position": [[0, 0, 0]]}, "position", "K = 2 as in mass"),
        ({"velocity": [[0, 0, np.nan], [0, 0, 0]]}, "velocity", r"velocity\[0, 2\] is nan"),
        ({"angular_velocity": np.zeros((3, 2))}, "angular_velocity", r"expected shape \(K, 3\)"),
        ({"pivot": [FREE, [0, 0, np.nan]]}, "pivot", r"pivot\[1, 2\] is nan"),
        ({"pivot": [FREE, [0, 0, np.inf]]}, "pivot", r"pivot\[1, 2\] is inf"),
        ({"pivot": [[0, 0, 1]]}, "pivot", r"expected shape \(K, 3\) with K = 2"),
        ({"pivot": [FREE]}, "pivot", r"expected shape \(K, 3\) with K = 2"),
        ({"pivot": [FREE, FREE, FREE]}, "pivot", r"expected shape \(K, 3\) with K = 2"),
        ({"pivot": [FREE, [1e200, 0, 0]]}, "pivot", r"moments about it within float64 \(body 1\)"),
        ({"pivot": [FREE, [1e9, 0, 0]], "angular_velocity": [[0, 0, 0], [0, 1e300, 0]]}, "pivot", "whose speed"),
        ({"names": ["a"]}, "names", "expected 2 names"),
        ({"names": ["a", "a"]}, "names", "'a' twice"),
    ],
)
def test_what_is_no_body_is_refused_by_name(changes: dict, argument: str, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.RigidBodies(**{**GOOD, **changes})
    assert caught.value.argument == argument


def test_one_body_is_refused_by_its_own_shapes() -> None:
    for changes, words in (
        ({"moments": [[1.0, 1.0, 1.0]]}, r"moments: expected shape \(3,\)"),
        ({"mass": [1.0]}, "mass: expected one real number"),
        ({"mass": 0.0}, "mass: expected a positive mass"),
        ({"moments": [1.0, 1.0, 2.5]}, r"moments\[2\] = 2.5 is larger by 0.5$"),
        ({"pivot": FREE}, r"pivot\[0\] is nan"),
        ({"position": [[0, 0, 0]]}, r"position: expected shape \(3,\)"),
        ({"name": ""}, "name: expected a text that is not empty"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            vv.RigidBody(**{"mass": 1.0, "moments": [1.0, 1.0, 1.0], **changes})


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(-1, 1), min_size=12, max_size=12),
    st.floats(1e-3, 1e3),
    st.lists(st.floats(-3, 3), min_size=3, max_size=3),
)
def test_any_points_make_a_body_whose_energy_is_that_of_the_points(places, scale, spin) -> None:
    """A body of six points, turning about one of space: energy and center as the points themselves have them."""
    points = scale * np.vstack([np.reshape(places, (4, 3)), [[1, 0, 0], [0, 1, 0]]])
    solid = vv.rigid.particles(np.arange(1.0, 7.0), points)
    pivot = -solid.center  # the origin of the points
    tensor = solid.tensor
    body = vv.RigidBody(solid.mass, inertia=tensor, angular_velocity=spin, pivot=pivot)
    velocities = np.cross(spin, points)
    energy = 0.5 * np.arange(1.0, 7.0) @ (velocities**2).sum(axis=1)
    along = vv.rigid.rotate_back(body.axes, body.angular_velocity)[0]
    # Each term is rounded by a few ε of the largest.
    size = solid.mass * scale**2 * (np.dot(spin, spin) + 1e-300) * 10
    assert 0.5 * body.principal_moments[0] @ along**2 == pytest.approx(energy, abs=64 * EPSILON * size)
