"""States within steps of Gauss's methods: as good as those at their ends, the same whatever else is read, and cheap."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy

import visviva as vv

X, Y, U, V, P, R, A = sympy.symbols("x y u v p r a")
LAGRANGIANS = {
    "conserved": (U**2 + V**2) / 2 - (X**2 + Y**2) / 2 - A * X**2 * Y + Y**3 / 3,
    "driven": (U**2 + V**2) / 2 - (X**2 + Y**4) / 2 + A * X * sympy.cos(3 * vv.time) + X * Y * sympy.sin(vv.time) / 3,
    "of velocities": (U**2 + V**2) * (1 + X**2) / 2 + A * (X * V - Y * U) - Y**2 - X**4,
}
RELATIVISTIC = sympy.sqrt(1 + P**2 + R**2) * (1 + A * (X**2 + Y**2) / 2)
KINDS = [*LAGRANGIANS, "relativistic"]


def system(kind: str, position: Any, second: Any, a: float) -> Any:
    if kind == "relativistic":
        return vv.Hamiltonian(RELATIVISTIC, q=[X, Y], p=[P, R], position=position, momentum=second, parameters={"a": a})
    return vv.Lagrangian(
        LAGRANGIANS[kind], [X, Y], velocities=[U, V], position=position, velocity=second, parameters={"a": a}
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("how", "bound"),
    # Rounding of states of order 1/2, in fifty steps; and what those methods err by, at that tolerance or step.
    [
        ({"method": "gauss16"}, 3e-15),
        ({"method": "gauss8", "rtol": 1e-9}, 1e-8),
        ({"method": "gauss4", "dt": 0.05}, 2e-6),
    ],
    ids=["gauss16", "gauss8", "gauss4"],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_copies_read_what_they_read_alone(kind: str, how: dict[str, Any], bound: float, sign: float) -> None:
    rng = np.random.default_rng(3)
    position, second = rng.uniform(-0.3, 0.3, (2, 11, 2))
    a, t = rng.uniform(0.5, 1.0, 11), sign * np.sort(rng.uniform(0.0, 10.0, 37))
    name = "momentum" if kind == "relativistic" else "velocity"
    copies = system(kind, position[0], second[0], 0.5).ensemble(
        position=position, parameters={"a": a}, **{name: second}
    )
    many = copies.run(t=t, threads=2, **how)
    for index in range(11):
        one = system(kind, position[index], second[index], float(a[index]))
        alone = one.run(t=t, **how)
        np.testing.assert_array_equal(many[index].position, alone.position)
        assert many[index].evaluations == alone.evaluations
    fine = one.run(t=t, method="taylor", rtol=1e-14)
    np.testing.assert_allclose(alone.position, fine.position, rtol=0.0, atol=bound)
    few = one.run(t=t[[17, -1]], **how)
    np.testing.assert_array_equal(few.position, alone.position[[17, -1]])


@pytest.mark.parametrize("kind", KINDS)
def test_many_readings_cost_no_evaluations_but_once_a_step(kind: str) -> None:
    one = system(kind, [0.1, 0.2], [0.3, 0.1], 1.0)
    end, many = one.run(40.0), one.run(t=np.linspace(0.0, 40.0, 4001))
    assert many.steps == end.steps
    # Of stages and of as many places more, a few times.
    assert many.evaluations - end.evaluations <= 12 * end.steps
