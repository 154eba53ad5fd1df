"""The cones of a free symmetric body: against vectors in 40 digits, in any order, size and spin.

Bounds: two angles that are added, a rounding each.
"""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import visviva as vv

EPSILON = np.finfo(float).eps
POSITIVE = st.floats(-12.0, 12.0).map(lambda power: 10.0**power)


def between(a: list[mpmath.mpf], b: list[mpmath.mpf]) -> mpmath.mpf:
    """The angle between two vectors, to the digits that are worked with."""
    size = mpmath.sqrt(sum(x * x for x in a)) * mpmath.sqrt(sum(x * x for x in b))
    cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    return mpmath.atan2(
        mpmath.sqrt(sum(x * x for x in cross)) / size, sum(x * y for x, y in zip(a, b, strict=True)) / size
    )


@given(
    ratio=st.sampled_from([1e-6, 0.3, 1.0 - 1e-12, 1.0 + 1e-12, 1.4, 2.0]),
    across=POSITIVE,
    along=POSITIVE,
    sign=st.sampled_from([1.0, -1.0]),
    order=st.permutations([0, 1, 2]),
)
def test_they_are_the_angles_between_the_vectors(
    ratio: float, across: float, along: float, sign: float, order: list[int]
) -> None:
    moments, spin = np.array([1.0, 1.0, ratio])[order], np.array([0.6 * across, 0.8 * across, sign * along])[order]
    found = vv.rigid.cone_angles(moments, spin)
    with mpmath.workdps(60):
        axis = [mpmath.mpf(float(at == 2)) * sign for at in order]
        omega = [mpmath.mpf(float(x)) for x in spin]
        momentum = [mpmath.mpf(float(m)) * w for m, w in zip(moments, omega, strict=True)]
        exact = between(omega, axis), between(omega, momentum), between(momentum, axis)
        # A handful of rounded operations each; nothing is subtracted but the moments, which is exact or nearly so.
        for own, other in zip(found, exact, strict=True):
            assert abs(own - other) <= 8 * EPSILON * other


@pytest.mark.parametrize("power", [-600, 600])
def test_units_do_not_matter(power: int) -> None:
    unit = 2.0**power
    here = vv.rigid.cone_angles([1.0, 1.0, 1.5], [0.3, 0.4, 2.0])
    assert vv.rigid.cone_angles([unit, unit, 1.5 * unit], [0.3, 0.4, 2.0]) == here
    assert vv.rigid.cone_angles([1.0, 1.0, 1.5], [0.3 * unit, 0.4 * unit, 2.0 * unit]) == here


def test_a_long_body_rolls_outside_a_flat_one_about() -> None:
    long, flat = (vv.rigid.cone_angles([1.0, 1.0, third], [1.0, 0.0, 1.0]) for third in (0.5, 1.5))
    assert long.axis == pytest.approx(long.body + long.space, rel=4 * EPSILON, abs=0)
    assert flat.body == pytest.approx(flat.axis + flat.space, rel=4 * EPSILON, abs=0)
