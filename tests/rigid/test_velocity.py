"""How the points of a rigid body move: distances stay, the base point is a choice, the axis is where it must be.

Bounds: a sum and a cross product, whose parts cancel.
"""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import visviva as vv

EPSILON = np.finfo(float).eps
numbers = st.floats(-3, 3)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)


@settings(max_examples=200, deadline=None)
@given(vectors, vectors, vectors, vectors)
def test_each_component_is_rounded_once(point, velocity, spin, about):
    found = vv.rigid.velocity_at(point, velocity, spin, about)
    r = [Fraction(float(a)) - Fraction(float(b)) for a, b in zip(point, about, strict=True)]
    w, v = [Fraction(float(part)) for part in spin], [Fraction(float(part)) for part in velocity]
    for at in range(3):
        i, j = (at + 1) % 3, (at + 2) % 3
        exact = v[at] + w[i] * r[j] - w[j] * r[i]
        # Double-double leaves 1e-31 of what is summed, which may cancel; products of subnormal numbers are lost.
        assert abs(Fraction(float(found[at])) - exact) <= abs(exact) * Fraction(0.51 * EPSILON) + Fraction(1e-29)


def test_far_from_the_origin():
    """A base point a million sizes away: the same digits, since differences of places are exact."""
    point, about = np.array([0.5, -0.25, 2.0]), np.array([-1.0, 0.75, 0.125])
    here = vv.rigid.velocity_at(point, [1.0, 2.0, 3.0], [0.3, -0.2, 0.7], about)
    far = 2.0**30 * np.array([1.0, -2.0, 3.0])
    assert np.array_equal(vv.rigid.velocity_at(point + far, [1.0, 2.0, 3.0], [0.3, -0.2, 0.7], about + far), here)


def test_it_is_the_rate_of_a_rotation():
    """Points of a body in free rotation, by central differences: h² of the third derivative, 1e-9 at h = 1e-4."""
    moments, spin, h = [1.0, 2.0, 2.5], [0.3, 0.9, -0.5], 1e-4
    t = np.linspace(0.0, 9.0, 10)
    before, here, after = (vv.rigid.free_rotation(moments, spin, t + shift) for shift in (-h, 0.0, h))
    place = np.array([0.4, -1.1, 0.8])
    r = vv.rigid.rotate(here.orientation, place)
    rate = (vv.rigid.rotate(after.orientation, place) - vv.rigid.rotate(before.orientation, place)) / (2 * h)
    omega = vv.rigid.rotate(here.orientation, here.angular_velocity)
    assert vv.rigid.velocity_at(r, np.zeros(3), omega) == pytest.approx(rate, abs=1e-8)


@settings(max_examples=200, deadline=None)
@given(vectors, vectors.filter(lambda w: np.linalg.norm(w) > 0.1), vectors, vectors)
def test_the_screw_is_the_same_from_every_base_point(velocity, spin, about, other):
    size = 10 * (1 + np.linalg.norm(velocity)) / np.linalg.norm(spin)
    screw = vv.rigid.screw_axis(velocity, spin, about)
    there = vv.rigid.velocity_at(other, velocity, spin, about)
    again = vv.rigid.screw_axis(there, spin, other)
    # Rounding of the velocity, over |ω|.
    assert np.linalg.norm(np.cross(again.point - screw.point, screw.direction)) <= 8 * EPSILON * size
    assert abs(again.pitch - screw.pitch) <= 8 * EPSILON * size
    assert np.linalg.norm(screw.direction) == pytest.approx(1.0, abs=2 * EPSILON)
    assert screw.rate * screw.direction == pytest.approx(spin, abs=4 * EPSILON)
    # On the axis the velocity is along it, and nowhere less.
    on_axis = vv.rigid.velocity_at(screw.point, velocity, spin, about)
    assert on_axis == pytest.approx(screw.speed * screw.direction, abs=8 * EPSILON * size * screw.rate)
    assert np.linalg.norm(there) >= abs(screw.speed) - 8 * EPSILON * size * screw.rate


@pytest.mark.parametrize("by", [2.0**-600, 2.0**-300, 2.0**300, 2.0**600])
def test_units_do_not_matter(by):
    """Powers of two pass through to the bit, also where squares are out of range."""
    velocity, spin = np.array([0.3, -0.8, 0.4]), np.array([0.7, 0.1, -0.2])
    here = vv.rigid.screw_axis(velocity, spin)
    faster = vv.rigid.screw_axis(by * velocity, by * spin)
    assert np.array_equal(faster.point, here.point)
    assert np.array_equal(faster.direction, here.direction)
    assert (faster.rate, faster.speed, faster.pitch) == (by * here.rate, by * here.speed, here.pitch)
    larger = vv.rigid.screw_axis(by * velocity, spin)
    assert np.array_equal(larger.point, by * here.point)
    assert larger.pitch == by * here.pitch


def test_without_rotation_there_is_a_direction():
    found = vv.rigid.screw_axis([0.0, -3.0, 4.0], np.zeros(3), [1.0, 2.0, 3.0])
    assert np.array_equal(found.point, [1.0, 2.0, 3.0])
    assert np.array_equal(found.direction, [0.0, -0.6, 0.8])
    assert (found.rate, found.speed, found.pitch) == (0.0, 5.0, np.inf)


def test_many_at_once():
    rng = np.random.default_rng(3)
    points, velocity, spin = rng.normal(size=(4, 5, 3)), rng.normal(size=(5, 3)), rng.normal(size=(4, 1, 3))
    found = vv.rigid.velocity_at(points, velocity, spin)
    assert found.shape == (4, 5, 3)
    assert found == pytest.approx(velocity + np.cross(spin, points), rel=4e-14, abs=1e-14)
    screws = vv.rigid.screw_axis(velocity, spin)
    assert screws.point.shape == screws.direction.shape == (4, 5, 3)
    assert screws.pitch.shape == (4, 5)
    single = vv.rigid.screw_axis(velocity[2], spin[3, 0])
    assert np.array_equal(single.point, screws.point[3, 2])
    assert vv.rigid.velocity_at(np.zeros((0, 3)), [1, 0, 0], [0, 0, 1]).shape == (0, 3)


@pytest.mark.parametrize(
    ("call", "argument", "words"),
    [
        (lambda: vv.rigid.velocity_at([1, 0], [0, 0, 0], [0, 0, 1]), "point", "shape"),
        (lambda: vv.rigid.velocity_at(np.zeros((2, 3)), np.zeros((3, 3)), [0, 0, 1]), "velocity", "broadcast"),
        (lambda: vv.rigid.velocity_at([1, 0, 0], [0, np.nan, 0], [0, 0, 1]), "velocity", "finite"),
        (lambda: vv.rigid.velocity_at([1e200, 0, 0], [0, 0, 0], [0, 1e200, 0]), "point", "range"),
        (lambda: vv.rigid.screw_axis([0, 0, 0], [0, 0, 0]), "angular_velocity", "at rest"),
        (lambda: vv.rigid.screw_axis([[1, 0, 0], [0, 0, 0]], [0, 0, 0]), "angular_velocity", "entry 1 of 2"),
        (lambda: vv.rigid.screw_axis([1e200, 0, 0], [0, 1e-200, 0]), "angular_velocity", "range"),
    ],
)
def test_bad_input(call, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument
