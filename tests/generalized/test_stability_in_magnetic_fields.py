"""Stability beside gyroscopic terms: both forms tell it by the energy at rest, in which these have no part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import visviva as vv

if TYPE_CHECKING:
    from collections.abc import Callable

    Potential = Callable[[Any], Any]

NAMES = ["x", "y", "z"]
FIELDS = [1e-6, 0.1, 1.0, 10.0, 1e6]


def in_a_field(potential: Potential, b: float, count: int = 2) -> vv.Lagrangian:
    """L = v²/2 + b (x v_y − y v_x)/2 − V(q)."""
    return vv.Lagrangian(
        lambda q, v, t: sum(each**2 for each in v) / 2 + b / 2 * (q[0] * v[1] - q[1] * v[0]) - potential(q),
        NAMES[:count],
    )


def by_momenta(potential: Potential, b: float, count: int = 2) -> vv.Hamiltonian:
    """The same by momenta p_x = v_x − b y/2, p_y = v_y + b x/2."""

    def function(q: Any, p: Any, t: Any) -> Any:
        turned = [p[0] + b / 2 * q[1], p[1] - b / 2 * q[0], *p[2:]]
        return sum(each**2 for each in turned) / 2 + potential(q)

    return vv.Hamiltonian(function, NAMES[:count])


def are_stable(potential: Potential, b: float, count: int = 2) -> list[bool]:
    """What the forms tell of zero."""
    forms = (in_a_field(potential, b, count), by_momenta(potential, b, count))
    found = [form.equilibria(near=np.zeros((1, k * count))) for k, form in enumerate(forms, start=1)]
    assert [len(each) for each in found] == [1, 1]
    return [each[0].stable for each in found]


def valley(fourth: float, third: float = 0.0, second: float = 0.0) -> Potential:
    return lambda q: q[1] ** 2 + second * q[0] ** 2 + third * q[0] ** 3 + fourth * q[0] ** 4


MINIMA = {
    "valley that rises": valley(1.0),
    "valley that rises little": valley(0.0, second=1e-12),
    "level valley": valley(0.0),
    "fourth order": lambda q: q[0] ** 4 + q[1] ** 4,
    "as r⁴": lambda q: (q[0] ** 2 + q[1] ** 2) ** 2,
    "curved valley": lambda q: (q[1] - q[0] ** 2) ** 2 + q[0] ** 6,
}
FALLING = {
    "valley that falls": valley(-1.0),
    "valley that falls on one side": valley(0.0, third=1.0),
    "valley that falls little": valley(0.0, second=-1e-12),
    "hill of fourth order": lambda q: -(q[0] ** 4) - q[1] ** 4,
    "as -r⁴": lambda q: -((q[0] ** 2 + q[1] ** 2) ** 2),
    "saddle of fourth order": lambda q: q[0] ** 4 - q[1] ** 4,
    "Peano's surface": lambda q: (q[1] - q[0] ** 2) * (q[1] - 3 * q[0] ** 2),
}


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize("name", MINIMA)
def test_minima_are_stable_in_any_field(name: str, b: float) -> None:
    """Lagrange and Dirichlet: a magnetic force does no work."""
    assert are_stable(MINIMA[name], b) == [True, True]


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize("name", FALLING)
def test_what_falls_is_not_taken_to_be_held(name: str, b: float) -> None:
    assert are_stable(FALLING[name], b) == [False, False]


@pytest.mark.parametrize("b", [0.1, 1.0, 10.0])
def test_a_curved_valley_that_falls(b: float) -> None:
    assert are_stable(lambda q: (q[1] - q[0] ** 2) ** 2 - q[0] ** 6, b) == [False, False]


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize(("part", "stable"), [(0.25, True), (1 - 1e-6, True), (1.0, False), (1 + 1e-3, False)])
def test_a_hill_is_held_by_a_field_of_more_than_twice_its_root(b: float, part: float, stable: bool) -> None:
    """Of x″ = k x: λ² + i b λ − k has real frequencies for b² ≥ 4 k; equal ones, which b² = 4 k makes, grow as t."""
    k = part * b * b / 4
    assert are_stable(lambda q: -k * (q[0] ** 2 + q[1] ** 2) / 2, b) == [stable, stable]
    assert in_a_field(lambda q: -k * (q[0] ** 2 + q[1] ** 2) / 2, b).linearize(at=[0.0, 0.0]).stable is stable


@pytest.mark.parametrize("b", FIELDS)
@pytest.mark.parametrize(("power", "sign", "stable"), [(2, 1, True), (2, -1, False), (4, 1, True), (4, -1, False)])
def test_a_hill_that_is_held_beside_what_is_along_the_field(b: float, power: int, sign: int, stable: bool) -> None:
    k = b * b / 16
    assert are_stable(lambda q: -k * (q[0] ** 2 + q[1] ** 2) / 2 + sign * k * q[2] ** power, b, 3) == [stable, stable]


@pytest.mark.parametrize("b", FIELDS)
def test_a_saddle_is_held_by_no_field(b: float) -> None:
    """Kelvin, Tait and Chetaev: an odd number of directions in which the energy falls."""
    assert are_stable(lambda q: b * b * (q[0] ** 2 - q[1] ** 2), b) == [False, False]


@pytest.mark.parametrize("b", [0.5, 3.0])
def test_equal_frequencies_with_modes_of_their_own_are_stable(b: float) -> None:
    """Two hills, each with its field, in coordinates that mix both: every frequency is there twice."""
    k, turn = b * b / 16, np.linalg.qr(np.random.default_rng(5).normal(size=(4, 4)))[0]

    def lagrangian(q: Any, v: Any, t: Any) -> Any:
        x, rates = ([sum(turn[i, j] * each[j] for j in range(4)) for i in range(4)] for each in (q, v))
        field = sum(x[i] * rates[i + 1] - x[i + 1] * rates[i] for i in (0, 2))
        return sum(each**2 for each in rates) / 2 + b / 2 * field + k * sum(each**2 for each in x) / 2

    small = vv.Lagrangian(lagrangian, ["a", "b", "c", "d"]).linearize(at=np.zeros(4))
    assert small.stable
    # ω² − b ω + b²/16 = 0 has the roots b (1 ± √3/2)/2; rounding of the matrices is some 1e-15 of the larger.
    roots = b * (1 + np.array([-1, -1, 1, 1]) * np.sqrt(0.75)) / 2
    np.testing.assert_allclose(small.frequencies, roots, rtol=1e-12, atol=0)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("b", [None, 1e-3, 1.0, 1e3])
def test_at_any_size_away_from_zero(size: float, b: float | None) -> None:
    """Valleys beside zero, of lengths and fields of any size."""
    for potential, stable in [(valley(1.0), True), (valley(-1.0), False), (FALLING["Peano's surface"], False)]:

        def moved(q: Any, of: Potential = potential) -> Any:
            return size * size * of([q[0] / size - 1, q[1] / size + 1])

        place = size * np.array([1.0, -1.0])
        momentum = (b or 0.0) / 2 * size * np.array([1.0, 1.0])
        (one,) = in_a_field(moved, b or 0.0).equilibria(near=[place])
        (other,) = by_momenta(moved, b or 0.0).equilibria(near=[np.concatenate([place, momentum])])
        assert (one.stable, other.stable) == (stable, stable)
