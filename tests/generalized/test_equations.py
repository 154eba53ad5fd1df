"""Equations of motion: those that SymPy derives, in 30 digits; Newton's, for a Lagrangian in Cartesian coordinates.

Bounds: random expressions lose by cancellation what their largest terms are above their sums: two EPSILON were seen
of 1 + the largest, ten times that is allowed; of equations with constraints, EPSILON times the condition of their
matrix, of which a third was seen.
"""

from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from asking import rates

import visviva as vv

EPSILON = 2.0**-52
Q, V = sp.symbols("x:3"), sp.symbols("u:3")
K = sp.Symbol("k")
t = sp.Symbol("t")


def drawn(random: np.random.Generator, variables: tuple[Any, ...], terms: int = 4) -> Any:
    """A random smooth expression of some variables."""

    def factor() -> Any:
        x = variables[random.integers(len(variables))]
        y = variables[random.integers(len(variables))]
        c = sp.Rational(int(random.integers(1, 9)), 4)
        kinds = (
            sp.sin(c * x + y),
            sp.cos(x - c * y),
            sp.exp(-(x**2) / 2),
            x * y + c,
            x**3,
            1 / (c + x**2 + y**2),
            sp.sqrt(c + x**2),
            (c + y**2) ** sp.Rational(-3, 2),
        )
        return kinds[random.integers(len(kinds))]

    return sum(sp.Rational(int(random.integers(-8, 9)), 3) * factor() * factor() for _ in range(terms))


def exact(expression: Any, values: dict[Any, float]) -> Any:
    return expression.xreplace({symbol: sp.Float(value, 40) for symbol, value in values.items()}).evalf(35)


def states(random: np.random.Generator, count: int) -> list[dict[Any, float]]:
    return [{symbol: float(random.normal()) for symbol in (*Q, *V, t)} | {K: 1.25} for _ in range(count)]


def compare(system: Any, mass: Any, right: Any, at: dict[Any, float]) -> None:
    """M q̈ = r: numbers against 35 digits. What rounding does to M and r comes back by the condition of M."""
    M = mpmath.matrix([[exact(entry, at) for entry in row] for row in mass.tolist()])
    r = mpmath.matrix([exact(entry, at) for entry in right])
    wanted = np.array([float(number) for number in mpmath.lu_solve(M, r)])
    found = rates(system, at[t], [at[q] for q in Q], [at[v] for v in V])
    numbers = np.array(M.tolist(), dtype=float)
    # Terms of r are at most some hundred times as large as r itself here.
    scale = 100.0 * (1.0 + np.abs(np.array(r.tolist(), dtype=float)).max()) * np.linalg.norm(np.linalg.inv(numbers), 2)
    assert np.abs(found - wanted).max() <= 16 * EPSILON * scale * np.linalg.cond(numbers), (found, wanted)


@pytest.mark.parametrize("seed", range(12))
def test_a_cartesian_lagrangian_is_newtons_second_law(seed: int) -> None:
    random = np.random.default_rng([5, seed])
    masses = random.uniform(0.5, 3.0, 3)
    potential = drawn(random, Q, 6)
    L = sum(m * v**2 for m, v in zip(masses, V, strict=True)) / 2 - potential
    system = vv.Lagrangian(L, Q, velocities=V)
    for at in states(random, 4):
        forces = [-exact(potential.diff(q), at) for q in Q]
        found = rates(system, 0.0, [at[q] for q in Q], [at[v] for v in V])
        wanted = np.array([float(force / m) for force, m in zip(forces, masses, strict=True)])
        assert np.abs(found - wanted).max() <= 20 * EPSILON * (1.0 + np.abs(wanted).max())


@pytest.mark.parametrize("seed", range(12))
def test_euler_and_lagrange_as_sympy_derives_them(seed: int) -> None:
    """Any mass matrix, potentials of velocity and time, forces and dissipation."""
    random = np.random.default_rng([7, seed])
    A = sp.Matrix(3, 3, lambda i, j: (3 if i == j else 0) + drawn(random, Q, 1) / 8)
    v = sp.Matrix(V)
    L = ((A * v).T * (A * v))[0] / 2 + sum(drawn(random, (*Q, t), 1) * u for u in V) - K * drawn(random, (*Q, t), 3)
    if seed % 3 == 0:
        L += (V[0] ** 2 + V[1] ** 2) ** 2 / 16
    forces = {Q[0]: drawn(random, (*Q, *V, t), 1), Q[2]: K * V[1]}
    dissipation = drawn(random, V, 1) + V[0] ** 2
    system = vv.Lagrangian(L, Q, velocities=V, parameters={K: 1.25}, forces=forces, dissipation=dissipation)
    momenta = [L.diff(u) for u in V]
    mass = sp.Matrix([[p.diff(u) for u in V] for p in momenta])
    right = [
        L.diff(q) - p.diff(t) - sum(p.diff(x) * u for x, u in zip(Q, V, strict=True))
        + forces.get(q, 0) - dissipation.diff(velocity)
        for q, velocity, p in zip(Q, V, momenta, strict=True)
    ]  # fmt: skip
    for at in states(random, 3):
        compare(system, mass, right, at)
        state = vv.Lagrangian.at(system, position=[at[q] for q in Q], velocity=[at[v] for v in V], t0=at[t])
        wanted = np.array([float(exact(p, at)) for p in momenta])
        assert np.abs(state.momentum - wanted).max() <= 20 * EPSILON * (1 + np.abs(wanted).max())
        energy = float(exact(sum(u * p for u, p in zip(V, momenta, strict=True)) - L, at))
        assert abs(state.energy - energy) <= 20 * EPSILON * (10 + abs(energy))


@pytest.mark.parametrize("seed", range(8))
def test_hamiltons_equations_as_sympy_derives_them(seed: int) -> None:
    random = np.random.default_rng([11, seed])
    H = drawn(random, (*Q, *V, t), 4) + K * drawn(random, (*Q, *V), 2)
    system = vv.Hamiltonian(H, Q, V, parameters={K: 1.25}, forces={Q[1]: V[0] * Q[0]})
    slopes = [H.diff(p) for p in V] + [-H.diff(q) for q in Q]
    slopes[4] += V[0] * Q[0]
    for at in states(random, 4):
        found = rates(system, at[t], [at[q] for q in Q], [at[v] for v in V])
        wanted = np.array([float(exact(slope, at)) for slope in slopes])
        assert np.abs(found - wanted).max() <= 20 * EPSILON * (1.0 + np.abs(wanted).max())


@pytest.mark.parametrize("seed", range(4))
def test_equations_of_a_constrained_system(seed: int) -> None:
    """[M −Aᵀ; A 0] [q̈; λ] = [r; −(Ȧ q̇ + ḃ)], λ the force that acts on the system."""
    random = np.random.default_rng([13, seed])
    potential = drawn(random, Q, 3)
    L = (V[0] ** 2 + 2 * V[1] ** 2 + 3 * V[2] ** 2) / 2 + V[0] * V[1] * sp.cos(Q[2]) / 4 - potential
    g = sp.sin(Q[0]) * 2 + Q[1] + Q[2] * t
    a = Q[1] * V[0] + (2 + sp.cos(Q[0])) * V[2] - t
    system = vv.Lagrangian(L, Q, velocities=V, constraints=[g], nonholonomic=[a])
    along = dict(zip(Q, V, strict=True)) | {t: sp.Integer(1)}

    def rate(expression: Any) -> Any:
        return sum(expression.diff(x) * u for x, u in along.items())

    momenta = [L.diff(u) for u in V]
    M = sp.Matrix([[p.diff(u) for u in V] for p in momenta])
    A = sp.Matrix([[g.diff(q) for q in Q], [a.diff(u) for u in V]])
    r = sp.Matrix([L.diff(q) - rate(p) for q, p in zip(Q, momenta, strict=True)])
    curves = sp.Matrix([-rate(rate(g)), -rate(a)])
    for at in states(random, 3):
        whole = mpmath.matrix(5, 5)
        for i in range(3):
            for j in range(3):
                whole[i, j] = exact(M[i, j], at)
            for k in range(2):
                whole[i, 3 + k] = -exact(A[k, i], at)
                whole[3 + k, i] = exact(A[k, i], at)
        wanted = mpmath.lu_solve(whole, mpmath.matrix([exact(x, at) for x in (*r, *curves)]))
        position, velocity = [at[q] for q in Q], [at[v] for v in V]
        found = rates(system, at[t], position, velocity)
        columns = system._model.columns(np.array([at[t]]), np.array([[*position, *velocity]]), np.zeros((1, 0)))[0]
        condition = np.linalg.cond(np.array(whole.tolist(), dtype=float))
        size = 1.0 + max(abs(float(x)) for x in wanted)
        both = np.concatenate([found, columns[-2:]])
        assert np.abs(both - np.array([float(x) for x in wanted])).max() <= 4 * EPSILON * size * condition


def test_the_equations_are_shown() -> None:
    theta = vv.coordinate("theta")
    rate = theta.diff(vv.time)
    l, m = sp.symbols("l m")
    L = m * l**2 * rate**2 / 2 + m * sp.cos(theta)
    shown = vv.Lagrangian(L, [theta], parameters={l: 2.0, m: 3.0})
    assert sp.simplify(shown.mass_matrix - sp.Matrix([[m * l**2]])) == sp.zeros(1)
    assert sp.simplify(shown.momenta[0] - m * l**2 * rate) == 0
    x, p = sp.symbols("x p")
    q_rate, p_rate = vv.Hamiltonian(p**2 / (2 * m) + sp.sin(x), [x], [p], parameters={m: 3.0}).equations
    assert sp.simplify(q_rate[0] - p / m) == 0
    assert sp.simplify(p_rate[0] + sp.cos(x)) == 0


def test_functions_show_what_they_are_by_names() -> None:
    double = vv.systems.double_pendulum()
    a, b, m1, m2, l1, l2 = sp.symbols("theta1 theta2 m1 m2 l1 l2")
    mixed = m2 * l1 * l2 * sp.cos(a - b)
    wanted = sp.Matrix([[(m1 + m2) * l1**2, mixed], [mixed, m2 * l2**2]])
    assert sp.simplify(double.mass_matrix - wanted) == sp.zeros(2)
    assert sp.simplify(double.momenta[1] - m2 * l2**2 * sp.Symbol("v_theta2") - mixed * sp.Symbol("v_theta1")) == 0
