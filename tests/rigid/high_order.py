"""How far rotations are apart; and free rotation by Taylor series in 40 digits, which knows the equations alone."""

from collections.abc import Sequence

import mpmath
import numpy as np
from numpy.typing import ArrayLike, NDArray

ORDER = 40


def angle_between(a: ArrayLike, b: ArrayLike) -> NDArray[np.longdouble]:
    """The angle between rotations, to first order, whatever the signs and lengths of the quaternions."""
    first, second = (np.asarray(q, np.longdouble) for q in (a, b))
    first, second = (q / np.sqrt((q * q).sum(axis=-1, keepdims=True)) for q in (first, second))
    apart = [np.sqrt(((first - sign * second) ** 2).sum(axis=-1)) for sign in (1, -1)]
    return 2 * np.minimum(*apart)


def taylor(
    moments: Sequence[float], spin: Sequence[float], turn: Sequence[float], time: float
) -> tuple[list[float], list[float]]:
    """Angular velocity and quaternion (x, y, z, w) at a time; inputs are the binary64 numbers themselves."""
    with mpmath.workdps(40):
        a, b, c = map(mpmath.mpf, moments)
        factors = ((b - c) / a, (c - a) / b, (a - b) / c)
        state = [mpmath.mpf(part) for part in (*spin, *turn)]
        # The size of the coefficients falls as (|ω| h)ⁿ/n!, faster than by 2 a step here.
        steps = max(1, int(abs(time) * float(mpmath.norm(state[:3])) * 1.2) + 1)
        h = mpmath.mpf(time) / steps
        for _ in range(steps):
            state = _step(factors, state, h)
        return [float(part) for part in state[:3]], [float(part) for part in state[3:]]


def _step(factors: Sequence[mpmath.mpf], state: list[mpmath.mpf], h: mpmath.mpf) -> list[mpmath.mpf]:
    series = [[part] for part in state]
    for n in range(ORDER):

        def times(i: int, j: int, n: int = n) -> mpmath.mpf:
            return mpmath.fdot(series[i][: n + 1], series[j][n::-1])

        yz, zx, xy = times(1, 2), times(2, 0), times(0, 1)
        rates = [factor * product for factor, product in zip(factors, (yz, zx, xy), strict=True)]
        # q̇ = ½ q ω.
        rates += [
            (times(6, 0) + times(4, 2) - times(5, 1)) / 2,
            (times(6, 1) + times(5, 0) - times(3, 2)) / 2,
            (times(6, 2) + times(3, 1) - times(4, 0)) / 2,
            -(times(3, 0) + times(4, 1) + times(5, 2)) / 2,
        ]
        for part, rate in zip(series, rates, strict=True):
            part.append(rate / (n + 1))
    return [sum(term * h**order for order, term in enumerate(part)) for part in series]
