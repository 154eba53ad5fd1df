"""Stability of H = √(1 + (p − A)²) + V where V is 1e-12 beside the b²/4 of momenta, against 80 digits.

The reference takes the eigenvalues of J ∂²H by mpmath, with derivatives of H of its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

    Potential = Callable[[Any, Any], Any]

WEAK = 1e-12
POTENTIALS: dict[str, Potential] = {
    "weak saddle beside a well": lambda x, y: y * y - WEAK * x * x,
    "weak well beside a well": lambda x, y: y * y + WEAK * x * x,
    "weak saddle by itself": lambda x, y: WEAK * (y * y - x * x),
    "weak well by itself": lambda x, y: WEAK * (x * x + 2 * y * y),
    "weak hill by itself": lambda x, y: -WEAK * (x * x + 2 * y * y),
    "weak well beside a hill": lambda x, y: WEAK * x * x - y * y,
    "weak hill beside a hill": lambda x, y: -WEAK * x * x - y * y,
    "turned saddle": lambda x, y: (x + y) * (x + y) - WEAK * (x - y) * (x - y),
    "saddle between wells": lambda x, y: y * y - WEAK * x * x + x**4,
    "saddle of coupling alone": lambda x, y: WEAK * x * y,
}
FIELDS = [1e3, -1e3, 1e5, 1e6, -1e6, 1e8, -1e8]


def square_root(u: Any, w: Any, m: Any) -> Any:
    return m.sqrt(1 + u * u + w * w)


def hyperbolic(u: Any, w: Any, m: Any) -> Any:
    return m.cosh(u) + m.cosh(w)


def told(potential: Potential, b: float, kinetic: Callable[..., Any] = square_root, at: float = 0.0) -> bool | None:
    def function(q: Any, p: Any, t: Any) -> Any:
        return kinetic(p[0] + b / 2 * q[1], p[1] - b / 2 * q[0], np) + potential(q[0] - at, q[1] + at)

    (found,) = vv.Hamiltonian(function, ["x", "y"]).equilibria(near=[[at, -at, b / 2 * at, b / 2 * at]])
    return found.stable


def is_stable(potential: Potential, b: float, kinetic: Callable[..., Any]) -> bool:
    """Whether no eigenvalue has a real part beyond what 80 digits leave: those that grow have 1e-20 at the least."""
    with mpmath.workdps(80):

        def energy(*state: Any) -> Any:
            x, y, px, py = state
            return kinetic(px + mpmath.mpf(b) / 2 * y, py - mpmath.mpf(b) / 2 * x, mpmath) + potential(x, y)

        second = mpmath.matrix(4, 4)
        for i in range(4):
            for j in range(4):
                orders = [int(k == i) + int(k == j) for k in range(4)]
                second[i, j] = mpmath.diff(energy, (0, 0, 0, 0), tuple(orders))
        rates = mpmath.matrix(4, 4)
        for j in range(4):
            for i in range(2):
                rates[i, j], rates[2 + i, j] = second[2 + i, j], -second[i, j]
        values = mpmath.eig(rates, left=False, right=False)
        return bool(max(mpmath.re(value) for value in values) < mpmath.mpf("1e-24"))


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize("name", POTENTIALS)
def test_what_the_linear_equations_of_80_digits_tell(name: str, b: float) -> None:
    """Saddles of 1e-12 were told as stable in any field: digits of momenta were taken for those of the stiffness."""
    assert told(POTENTIALS[name], b) is is_stable(POTENTIALS[name], b, square_root)


@pytest.mark.parametrize("b", [1e3, -1e6])
@pytest.mark.parametrize("name", POTENTIALS)
def test_momenta_that_grow_beyond_numbers_some_way_off(name: str, b: float) -> None:
    """cosh(p − A) has no number far away: the search for an energy that falls ended in an error of linear algebra."""
    assert told(POTENTIALS[name], b, hyperbolic) is is_stable(POTENTIALS[name], b, hyperbolic)


@pytest.mark.parametrize("b", [1e3, -1e6])
@pytest.mark.parametrize("name", POTENTIALS)
def test_away_from_zero_it_is_the_same(name: str, b: float) -> None:
    """Forces at (1, −1) have but the digits of the place: 1e-12 is told, and so is its sign."""
    potential = POTENTIALS[name]
    assert told(potential, b, at=1.0) is is_stable(potential, b, square_root)


@pytest.mark.parametrize("b", [1e3, -1e6])
@pytest.mark.parametrize("name", POTENTIALS)
def test_what_rounding_hides_is_not_told_as_stable(name: str, b: float) -> None:
    """Multiplied out, b² x²/4 has an error of b² 1e-17, above 1e-12: no arithmetic of doubles can tell its sign."""

    def function(q: Any, p: Any, t: Any) -> Any:
        turned = b * (p[0] * q[1] - p[1] * q[0]) + b * b / 4 * (q[0] ** 2 + q[1] ** 2)
        return np.sqrt(1 + p[0] ** 2 + p[1] ** 2 + turned) + POTENTIALS[name](*q)

    (found,) = vv.Hamiltonian(function, ["x", "y"]).equilibria(near=np.zeros((1, 4)))
    assert found.stable is None or found.stable is False is is_stable(POTENTIALS[name], b, square_root)


@pytest.mark.parametrize("b", [0.1, 1.0, -10.0])
def test_where_rounding_is_less_than_the_forces_it_is_told(b: float) -> None:
    """Multiplied out, too, while b² 1e-16 is little beside the well."""

    def function(q: Any, p: Any, t: Any) -> Any:
        turned = b * (p[0] * q[1] - p[1] * q[0]) + b * b / 4 * (q[0] ** 2 + q[1] ** 2)
        return np.sqrt(1 + p[0] ** 2 + p[1] ** 2 + turned) + q[0] ** 4 + q[1] ** 2

    (found,) = vv.Hamiltonian(function, ["x", "y"]).equilibria(near=np.zeros((1, 4)))
    assert found.stable is True
