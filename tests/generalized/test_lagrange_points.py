"""Lagrange's five points of the restricted problem of three bodies, however light the lighter one is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import findroot, mp, mpf

import visviva as vv


def squares(q: Any, x: float) -> Any:
    """The square of the distance from a place on the axis."""
    return (q[0] - x) ** 2 + sum(other**2 for other in q[1:])


def potential(q: Any, mu: Any) -> Any:
    """That of both bodies."""
    return -(1 - mu) / squares(q, -mu) ** 0.5 - mu / squares(q, 1 - mu) ** 0.5


def by_velocities(names: list[str], mu: float) -> vv.Lagrangian:
    def function(q: Any, v: Any, t: float, mu: float) -> Any:
        turning = q[0] * v[1] - q[1] * v[0] + (q[0] ** 2 + q[1] ** 2) / 2
        return sum(each**2 for each in v) / 2 + turning - potential(q, mu)

    return vv.Lagrangian(function, names, parameters={"mu": mu}, position=np.full(len(names), 0.3))


def by_momenta(names: list[str], mu: float, *, placed: bool = True) -> vv.Hamiltonian:
    def function(q: Any, p: Any, t: float, mu: float) -> Any:
        return sum(each**2 for each in p) / 2 + q[1] * p[0] - q[0] * p[1] + potential(q, mu)

    start = np.full(len(names), 0.3)
    placed_at = {"position": start, "momentum": 0.0 * start} if placed else {}
    return vv.Hamiltonian(function, names, parameters={"mu": mu}, **placed_at)


def collinear(mu: float) -> list[float]:
    """Those on the axis, with 30 digits."""
    with mp.workdps(30):
        m = mpf(mu)

        def force(x: Any) -> Any:
            return x - (1 - m) * (x + m) / abs(x + m) ** 3 - m * (x + m - 1) / abs(x + m - 1) ** 3

        near = (m / 3) ** (mpf(1) / 3)
        starts = [
            (-1 - m, -mpf("0.6")),
            (1 - m - 1.2 * near, 1 - m - 0.5 * near),
            (1 - m + 0.6 * near, 1 - m + 1.4 * near),
        ]
        return [float(findroot(force, start, solver="anderson", tol=1e-25)) for start in starts]


@pytest.mark.parametrize("mu", [0.3, 0.1, 0.012150585, 0.01, 9.5e-4, 3e-6])
@pytest.mark.parametrize("names", [["x", "y"], ["x", "y", "z"]])
@pytest.mark.parametrize("of", [by_velocities, by_momenta])
def test_all_five_are_found(of: Any, names: list[str], mu: float) -> None:
    found = of(names, mu).equilibria()
    assert len(found) == 5
    triangular = np.array([[0.5 - mu, -np.sqrt(0.75)], [0.5 - mu, np.sqrt(0.75)]])
    on_axis = np.array([each.position[0] for each in found if abs(each.position[1]) < 0.1])
    # Newton's method is as exact as forces that vanish beside terms of 1/r³ leave it.
    np.testing.assert_allclose(np.sort(on_axis), sorted(collinear(mu)), rtol=0, atol=1e-12)
    off_axis = np.array([each.position[:2] for each in found if abs(each.position[1]) > 0.1])
    off_axis = off_axis[np.argsort(off_axis[:, 1])]
    np.testing.assert_allclose(off_axis, triangular, rtol=0, atol=1e-10)
    for each in found:
        # G. Gascheau (1843): the triangular ones are stable below mu = 0.0385; the others never are.
        assert each.stable == (abs(each.position[1]) > 0.1 and mu < 0.0385)
        np.testing.assert_allclose(each.momentum[:2], [-each.position[1], each.position[0]], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("names", "mu", "placed"),
    [(names, mu, True) for names in (["x", "y"], ["x", "y", "z"]) for mu in (3e-7, 6.6e-8, 1e-8)]
    + [(["x", "y"], mu, False) for mu in (3e-7, 1e-8, 1e-10, 1e-12)],
)
def test_beside_a_light_body_no_other_place_counts(names: list[str], mu: float, placed: bool) -> None:
    """All along its orbit forces are 1e-7 of what they are the sums of, and slow motions as stable as fast ones.

    Of a system without a start the search begins at zero, too, which is next to the heavy body.
    """
    found = by_momenta(names, mu, placed=placed).equilibria()
    expected = [[x, 0.0] for x in collinear(mu)] + [[0.5 - mu, y] for y in (-np.sqrt(0.75), np.sqrt(0.75))]
    nearest = [int(np.abs(np.array(expected) - each.position[:2]).max(axis=1).argmin()) for each in found]
    assert len(set(nearest)) == len(nearest)
    # The one beyond the light body may be missed, those of triangles and the one opposite to it may not.
    assert {0, 3, 4} <= set(nearest)
    for each, place in zip(found, nearest, strict=True):
        # Forces tell the angle along the orbit by 1e-16 of what they are the sums of, in mu.
        np.testing.assert_allclose(each.position[:2], expected[place], rtol=0, atol=64 * 2.2e-16 / mu)
        assert each.stable == (place >= 3)
        if place >= 3:
            # ω⁴ − ω² + 27 mu (1 − mu)/4 = 0; roundings of terms of 1 change an ω² of 27 mu/4 by so many parts.
            product = 27 * mu * (1 - mu)
            expected_frequency = np.sqrt(product / (2 * (1 + np.sqrt(1 - product))))
            rounding = max(1e-6, 32 * 2.2e-16 / mu)
            np.testing.assert_allclose(each.frequencies[0], expected_frequency, rtol=rounding, atol=0)
