"""The tables of Störmer's multistep methods: series in backward differences, in rational numbers.

With ``x`` the backward difference and ``D = -log(1 - x)`` the step times the derivative, the next node is

    q[n+1] - 2 q[n] + q[n-1] = h^2 (x / D)^2 / (1 - x) a[n],        h v[n] - (q[n] - q[n-1]) = h^2 (D - x) / D^2 a[n].

Both series begin with few differences and go on with second differences and higher; the latter are written as sums
over the second differences of the past.
Source: Hairer, Norsett & Wanner, Solving ODE I, III.10, eqs. 10.7 to 10.11.
"""

from __future__ import annotations

from fractions import Fraction
from math import comb

from mpmath import mpf

Series = list[Fraction]


def product(one: Series, other: Series) -> Series:
    return [sum((one[i] * other[m - i] for i in range(m + 1)), Fraction(0)) for m in range(len(one))]


def inverse(series: Series) -> Series:
    """One over a series that begins with 1."""
    result = [Fraction(1)]
    for m in range(1, len(series)):
        result.append(-sum((series[i] * result[m - i] for i in range(1, m + 1)), Fraction(0)))
    return result


def over_second_differences(series: Series) -> Series:
    """The terms from the second difference on, as weights of second differences of ages 0, 1, 2, ..."""
    rest = series[2:]
    return [
        sum((rest[m] * comb(m, age) for m in range(age, len(rest))), Fraction(0)) * (-1) ** age
        for age in range(len(rest))
    ]


def stormer(order: int) -> dict[str, list[mpf]]:
    powers = range(order)
    logarithm = [Fraction(1, m + 1) for m in powers]
    square = inverse(product(logarithm, logarithm))
    step = product(square, [Fraction(1)] * order)
    velocity = product(square, [Fraction(1, m + 2) for m in powers])
    assert step[:2] == [1, 0]
    table = {
        "SECOND_DIFFERENCES": over_second_differences(step),
        "VELOCITY": [*velocity[:2], *over_second_differences(velocity)],
    }
    return {name: [mpf(x.numerator) / x.denominator for x in values] for name, values in table.items()}
