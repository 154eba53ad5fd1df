"""Forms of rotations: against SciPy, against each other, and at the poles.

A conversion is within 4 ε of the rotation; SciPy's own rounding is as large, hence 8 ε between the two.

Bounds: some EPSILON of unit quaternions; products of three angles have twice that, vectors of size up to 4 and the
rates that are divided by the distance of the pole as much more.
"""

import itertools
import sys

import numpy as np
import pytest
from high_order import angle_between
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

import visviva as vv

EPSILON = np.finfo(float).eps
CONVENTIONS = [
    "".join(axes)
    for letters in ("XYZ", "xyz")
    for axes in itertools.product(letters, repeat=3)
    if axes[0] != axes[1] != axes[2]
]
RANDOM = np.random.default_rng(11)


def quaternions(*shape):
    q = RANDOM.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def test_there_are_24():
    assert len(CONVENTIONS) == 24


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_euler_angles_are_those_of_scipy(convention):
    q = quaternions(1000)
    angles = vv.rigid.euler_angles(q, convention)
    assert np.all(angle_between(vv.rigid.quaternion_from_euler(angles, convention), q) <= 4 * EPSILON)
    assert np.all(angle_between(Rotation.from_euler(convention, angles).as_quat(), q) <= 8 * EPSILON)
    # Near a pole of a random sample (1e-3 off) the angles themselves differ by what that amplifies.
    assert np.allclose(angles, Rotation.from_quat(q).as_euler(convention), rtol=0, atol=1e-11)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_poles(convention):
    two_axes = convention[0] == convention[2]
    poles = (0.0, np.pi) if two_axes else (-np.pi / 2, np.pi / 2)
    for pole, off, first, last in itertools.product(poles, (0.0, 1e-300, 1e-16, 1e-12, 1e-8), (0.3, -2.9), (0.0, 2.5)):
        inside = pole + off if pole == min(poles) else pole - off
        q = vv.rigid.quaternion_from_euler([first, inside, last], convention)
        angles = vv.rigid.euler_angles(q, convention)
        assert angle_between(vv.rigid.quaternion_from_euler(angles, convention), q) <= 4 * EPSILON
        assert np.all(np.abs(angles[[0, 2]]) <= np.pi)
    # At the pole itself the first angle has it all.
    if two_axes:
        angles = vv.rigid.euler_angles(vv.rigid.quaternion_from_euler([0.3, 0.0, 0.5], convention), convention)
        assert angles == pytest.approx([0.8, 0.0, 0.0], abs=4e-16)
        half_turn = "XYZ".index(convention[1].upper())
        q = np.eye(4)[half_turn]
        assert vv.rigid.euler_angles(q, convention) == pytest.approx([0.0, np.pi, 0.0], abs=4e-16)


def test_forms_are_those_of_scipy():
    q = quaternions(4, 250)
    there = Rotation.from_quat(q.reshape(-1, 4))
    matrix = vv.rigid.matrix(q)
    assert matrix.shape == (4, 250, 3, 3)
    assert np.allclose(matrix.reshape(-1, 3, 3), there.as_matrix(), rtol=0, atol=8 * EPSILON)
    assert np.all(angle_between(vv.rigid.quaternion_from_matrix(matrix), q) <= 4 * EPSILON)
    vector = vv.rigid.rotation_vector(q)
    assert np.allclose(vector.reshape(-1, 3), there.as_rotvec(), rtol=0, atol=16 * EPSILON)
    assert np.all(angle_between(vv.rigid.quaternion_from_rotation_vector(vector), q) <= 4 * EPSILON)
    assert np.array_equal(vv.rigid.from_scipy(there), there.as_quat())
    assert np.allclose(vv.rigid.to_scipy(q[0]).as_quat(), q[0], rtol=0, atol=EPSILON)
    v = RANDOM.normal(size=(250, 3))
    turned = vv.rigid.rotate(q, v)
    assert turned.shape == (4, 250, 3)
    assert np.allclose(turned[2], Rotation.from_quat(q[2]).apply(v), rtol=0, atol=64 * EPSILON)
    assert np.allclose(vv.rigid.rotate_back(q, turned), np.broadcast_to(v, (4, 250, 3)), rtol=0, atol=64 * EPSILON)
    product = vv.rigid.quaternion_product(q[0], q[1])
    scipy = Rotation.from_quat(q[0]) * Rotation.from_quat(q[1])
    assert np.all(angle_between(product, scipy.as_quat()) <= 8 * EPSILON)
    assert np.allclose(vv.rigid.rotate(Rotation.from_quat(q[0]), v), turned[0], rtol=0, atol=16 * EPSILON)


def test_read_only_results_go_to_scipy():
    """What is given may be read-only; what SciPy is asked to turn may not be, which is what the documentation says."""
    bodies = vv.RigidBodies([1.0], [[1.0, 2.0, 2.5]], position=[[1.0, 0, 0]], angular_velocity=[[0.1, 1.0, 0.0]])
    out = vv.Scene(bodies).run(t=[0.0, 5.0, 10.0])
    assert not out.orientation.flags.writeable
    theirs = vv.rigid.to_scipy(out.orientation[:, 0])
    assert np.allclose(theirs.as_quat(), out.orientation[:, 0], rtol=0, atol=EPSILON)
    ours = vv.rigid.rotate(out.orientation[:, 0], out.position[:, 0])
    assert np.allclose(theirs.apply(out.position[:, 0].copy()), ours, rtol=0, atol=8 * EPSILON)


def test_leading_axes():
    q, v = quaternions(), RANDOM.normal(size=(5, 2, 3))
    assert vv.rigid.rotate(q, v).shape == (5, 2, 3)
    assert vv.rigid.rotate(quaternions(2), v).shape == (5, 2, 3)
    assert vv.rigid.rotate(quaternions(5, 1), v).shape == (5, 2, 3)
    assert vv.rigid.rotate(q, v[0, 0]).shape == (3,)
    assert np.array_equal(vv.rigid.rotate(np.tile(q, (5, 2, 1)), v), vv.rigid.rotate(q, v))
    assert vv.rigid.rotate(quaternions(0), v[0, 0]).shape == (0, 3)
    assert vv.rigid.rotate(q, np.zeros((0, 3))).shape == (0, 3)
    assert vv.rigid.matrix(quaternions(0)).shape == (0, 3, 3)
    assert vv.rigid.euler_angles(quaternions(3, 1)).shape == (3, 1, 3)
    many = quaternions(10)
    assert np.array_equal(vv.rigid.matrix(many[::2]), vv.rigid.matrix(many)[::2])
    assert np.array_equal(vv.rigid.matrix(np.asfortranarray(many)), vv.rigid.matrix(many))
    with pytest.raises(vv.InvalidInput, match="broadcast") as caught:
        vv.rigid.rotate(quaternions(3), v)
    assert caught.value.argument == "vector"


angles = st.floats(-3.0, 3.0)


@given(st.tuples(angles, angles, angles), st.tuples(angles, angles, angles), st.sampled_from(CONVENTIONS))
def test_rates(position, rates, convention):
    omega = {
        frame: vv.rigid.angular_velocity_from_euler(position, rates, frame=frame, convention=convention)
        for frame in ("body", "space")
    }
    q = vv.rigid.quaternion_from_euler(position, convention)
    assert np.allclose(vv.rigid.rotate(q, omega["body"]), omega["space"], rtol=0, atol=1e-14)
    pole = np.sin(position[1]) if convention[0] == convention[2] else np.cos(position[1])
    if abs(pole) > 1e-6:
        for frame, vector in omega.items():
            back = vv.rigid.euler_rates(position, vector, frame=frame, convention=convention)
            assert np.allclose(back, rates, rtol=0, atol=1e-14 / abs(pole))


def test_small_rotations_keep_their_digits():
    for size in (1e-9, 1e-100, 1e-300):
        v = np.array([1.0, -2.0, 3.0]) * size
        back = vv.rigid.rotation_vector(vv.rigid.quaternion_from_rotation_vector(v))
        assert np.allclose(back, v, rtol=4 * EPSILON, atol=0)


@given(fraction=st.floats(-3.0, 4.0), size=st.floats(-12.0, 0.0))
def test_slerp_is_a_steady_turn(fraction: float, size: float) -> None:
    start = vv.rigid.quaternion_from_rotation_vector([0.3, -1.0, 0.4])
    turn = 10.0**size * np.array([0.6, -0.48, 0.64]) * 3.1
    end = vv.rigid.quaternion_product(start, vv.rigid.quaternion_from_rotation_vector(turn))
    for sign in (1.0, -1.0):  # a quaternion and its opposite are one orientation
        between = vv.rigid.slerp(start, sign * end, fraction)
        exact = vv.rigid.quaternion_product(start, vv.rigid.quaternion_from_rotation_vector(fraction * turn))
        # The rounding of the ends, as far as the fraction carries it.
        assert np.abs(between - exact).max() < 4 * EPSILON * (2.0 + abs(fraction))


def test_slerp_broadcasts_and_agrees_with_scipy() -> None:
    ends = Rotation.random(2, random_state=3)
    fractions = np.linspace(0.0, 1.0, 7)
    ours = vv.rigid.slerp(ends[0], ends[1], fractions)
    theirs = Slerp([0.0, 1.0], ends)(fractions)
    assert (theirs.inv() * vv.rigid.to_scipy(ours)).magnitude().max() < 1e-15
    grid = vv.rigid.slerp(ours[:, None], ours[None], 0.5)
    assert grid.shape == (7, 7, 4)
    for i, j in ((0, 6), (3, 1), (2, 2)):
        assert (grid[i, j] == vv.rigid.slerp(ours[i], ours[j], 0.5)).all()
    with pytest.raises(vv.InvalidInput, match=r"end: expected axes that broadcast with \(7,\) of start, got \(2,\)"):
        vv.rigid.slerp(ours, ours[:2], 0.5)
    with pytest.raises(vv.InvalidInput, match=r"fraction: expected axes that broadcast with \(7,\) of start and end"):
        vv.rigid.slerp(ours, ours, [0.5, 0.6])


@pytest.mark.parametrize(
    ("call", "argument", "words"),
    [
        (lambda: vv.rigid.matrix([0, 0, 0, 0]), "quaternion", "zero is no rotation"),
        (lambda: vv.rigid.matrix([[0, 0, 0, 1], [0, 0, 0, 2]]), "quaternion", r"length 2.0; .*\(entry 1 of 2\)"),
        (lambda: vv.rigid.matrix([0, 0, 1]), "quaternion", r"expected shape \(…, 4\), got \(3,\)"),
        (lambda: vv.rigid.quaternion_product([0, 0, 0, 1], [0, 0, 0, 1.1]), "b", "length 1 within 1e-6"),
        (lambda: vv.rigid.rotate([0, 0, 0, 1], 1.0), "vector", "shape"),
        (lambda: vv.rigid.rotate([0, 0, 0, np.nan], [1, 0, 0]), "quaternion", "finite"),
        (lambda: vv.rigid.quaternion_from_matrix(np.diag([1, 1, -1])), "matrix", "a reflection"),
        (lambda: vv.rigid.quaternion_from_matrix(2 * np.eye(3)), "matrix", "off by 3.0"),
        (lambda: vv.rigid.euler_angles([0, 0, 0, 1], "ZZX"), "convention", "no two neighbours alike"),
        (lambda: vv.rigid.euler_angles([0, 0, 0, 1], 3), "convention", "three letters"),
        (lambda: vv.rigid.euler_angles([0, 0, 0, 1], "\ud800"), "convention", "three of X, Y, Z"),
        (lambda: vv.rigid.euler_rates([0, 0, 0], [1, 0, 0]), "angles", "off the pole"),
        (lambda: vv.rigid.euler_rates([0, 1, 0], [1, 0, 0], frame="bdy"), "frame", "did you mean 'body'"),
        (lambda: vv.rigid.from_scipy([0, 0, 0, 1]), "rotation", "got list"),
    ],
)
def test_bad_input(call, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument


def test_nearly_unit_quaternions_are_taken():
    q = np.array([0.6, 0.0, 0.0, 0.8])
    assert np.allclose(vv.rigid.rotate(q * (1 + 9e-7), [0, 1, 0]), vv.rigid.rotate(q, [0, 1, 0]), rtol=0, atol=4e-16)


def test_what_makes_a_rotation_of_scipy_says_what_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.spatial.transform", None)
    with pytest.raises(
        ImportError, match=r"^to_scipy: the package scipy is not installed: pip install 'visviva\[scipy\]'$"
    ):
        vv.rigid.to_scipy([0.0, 0.0, 0.0, 1.0])
