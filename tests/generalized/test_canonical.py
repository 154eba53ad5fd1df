"""Transformations that are canonical, those that are not, and by how much.

Bounds: entries of Poisson brackets are sums of some ten products, 1e-14 of the largest number.
"""

from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

ONE = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"], position=[0.7], momentum=[0.4])
TWO = vv.Hamiltonian(
    lambda q, p, t, a: (p[0] ** 2 + p[1] ** 2) / 2, ["x", "y"], parameters={"a": 0.6}, position=[0.9, 0.5]
)

CANONICAL: dict[str, tuple[vv.Hamiltonian, Any, bool]] = {
    "identity": (ONE, lambda q, p, t: [q[0], p[0]], True),
    "exchange": (ONE, lambda q, p, t: [p[0], -q[0]], True),
    "scaling": (ONE, lambda q, p, t: [3.0 * q[0], p[0] / 3.0], False),
    "action and angle": (ONE, lambda q, p, t: [np.arctan2(q[0], p[0]), (q[0] ** 2 + p[0] ** 2) / 2], False),
    "kick": (ONE, lambda q, p, t: [q[0], p[0] - np.sin(q[0]) * t], True),
    "leapfrog": (
        ONE,
        lambda q, p, t: [q[0] + t * (p[0] - t * np.sin(q[0])), p[0] - t * np.sin(q[0])],
        False,
    ),
    "free motion": (TWO, lambda q, p, t, a: [q[0] + t * p[0], q[1] + t * p[1], p[0], p[1]], True),
    "rotation": (
        TWO,
        lambda q, p, t, a: [
            *(np.cos(a) * u[0] - np.sin(a) * u[1] if k == 0 else np.sin(a) * u[0] + np.cos(a) * u[1]
              for u in (q, p) for k in (0, 1)),
        ],
        False,
    ),
    "polar": (
        TWO,
        lambda q, p, t, a: [
            np.sqrt(q[0] ** 2 + q[1] ** 2),
            np.arctan2(q[1], q[0]),
            (q[0] * p[0] + q[1] * p[1]) / np.sqrt(q[0] ** 2 + q[1] ** 2),
            q[0] * p[1] - q[1] * p[0],
        ],
        False,
    ),
    "gauge": (TWO, lambda q, p, t, a: [q[0], q[1], p[0] - a * q[1], p[1] - a * q[0]], True),
}  # fmt: skip


@pytest.mark.parametrize("name", CANONICAL)
def test_canonical(name: str) -> None:
    system, transformation, by_graph = CANONICAL[name]
    found = system.is_canonical(transformation)
    assert found
    assert found.residual <= 1e-14
    assert np.abs(found.matrix).max() <= 1e-9  # polar coordinates near the origin: entries of 1e4
    if by_graph:
        assert found.proved
        assert found.residual == 0.0


NOT: dict[str, tuple[vv.Hamiltonian, Any, Any]] = {
    "twice": (ONE, lambda q, p, t: [2 * q[0], p[0]], [[0, 1], [-1, 0]]),
    "reflection": (ONE, lambda q, p, t: [q[0], -p[0]], [[0, -2], [2, 0]]),
    "order": (TWO, lambda q, p, t, a: [q[1], q[0], p[0], p[1]], None),
    "wrong gauge": (
        TWO,
        lambda q, p, t, a: [q[0], q[1], p[0] - a * q[1], p[1] + a * q[0]],
        # Lagrange's bracket [x, y] = ∂P_x/∂y − ∂P_y/∂x = −2a.
        [[0, -1.2, 0, 0], [1.2, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]],
    ),
    "Euler's method": (ONE, lambda q, p, t: [q[0] + 0.1 * p[0], p[0] - 0.1 * q[0]], [[0, 0.01], [-0.01, 0]]),
}


@pytest.mark.parametrize("name", NOT)
def test_not_canonical(name: str) -> None:
    system, transformation, matrix = NOT[name]
    found = system.is_canonical(transformation)
    assert not found
    assert not found.proved
    assert found.residual > 1e-3
    if matrix is not None:
        assert found.matrix == pytest.approx(np.array(matrix, dtype=float), abs=1e-14)


def test_expressions_of_sympy() -> None:
    q, p, k = sp.symbols("q p k")
    H = vv.Hamiltonian(p**2 / 2 + k * q**2 / 2, [q], [p], parameters={k: 4.0})
    root = sp.sqrt(sp.sqrt(k))
    assert H.is_canonical([q * root, p / root])
    assert not H.is_canonical([q * root, p * root])
    assert H.is_canonical([sp.log(sp.sin(p) / q), q * sp.cot(p)])  # Goldstein, exercise 9.6


REFUSED = [
    (
        lambda: ONE.is_canonical([1]),
        "expected Q and P of .'x'.: 2 expressions, or a function that gives them all, got 1",
    ),
    (lambda: ONE.is_canonical(lambda q, p, t: [q[0]]), "got 1 of the function"),
    (lambda: ONE.is_canonical(lambda q, p, t: q[0]), "got Expression of the function"),
    (lambda: ONE.is_canonical(3.0), "got float"),
    (lambda: ONE.is_canonical(lambda q, p, t: [np.sqrt(q[0] - 50), p[0]]), "too few states"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_refused(call: Any, words: str) -> None:
    with pytest.raises(vv.errors.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == "transformation"
