"""Equations of motion as they are read, against those derived by hand.

Bounds: one solution of two equations, 1e-14.
"""

import pickle
from typing import Any

import pytest
import sympy as sp

import visviva as vv

t = vv.time
theta, r = vv.coordinate("theta"), vv.coordinate("r")
g, l, m, k = sp.symbols("g l m k")


def same(equation: Any, left: Any, right: Any = 0) -> bool:
    return sp.simplify(equation.lhs - equation.rhs - (left - right)) == 0


def test_a_spring_pendulum_with_forces_and_dissipation() -> None:
    rate, swing = r.diff(t), theta.diff(t)
    L = m * (rate**2 + r**2 * swing**2) / 2 + m * g * r * sp.cos(theta) - k * (r - l) ** 2 / 2
    system = vv.Lagrangian(
        L,
        [r, theta],
        parameters={g: 9.81, l: 1.0, m: 2.0, k: 30.0},
        forces={theta: sp.cos(t)},
        dissipation=k * rate**2 / 2,
    )
    shown = system.equations
    radial = m * r.diff(t, 2) - m * r * swing**2 - m * g * sp.cos(theta) + k * (r - l)
    angular = m * r**2 * theta.diff(t, 2) + 2 * m * r * rate * swing + m * g * r * sp.sin(theta)
    assert same(shown.equations[0], radial, -k * rate)
    assert same(shown.equations[1], angular, sp.cos(t))
    assert shown.momenta[1] == sp.Eq(sp.Symbol("p_theta"), m * r**2 * swing)
    energy = m * (rate**2 + r**2 * swing**2) / 2 - m * g * r * sp.cos(theta) + k * (r - l) ** 2 / 2
    assert sp.simplify(shown.jacobi_integral.rhs - energy) == 0
    assert shown.conserved == []
    assert "conserved" not in str(shown)


def test_a_double_pendulum_is_short() -> None:
    """Goldstein, § 1.4: its Coriolis' terms are sin(θ₁ − θ₂), and what cancels is not there."""
    shown = vv.systems.double_pendulum().equations
    a, b, m1, m2, l1, l2, g = sp.symbols("theta1 theta2 m1 m2 l1 l2 g")
    fast, slow, a2, b2 = sp.symbols("v_theta1 v_theta2 a_theta1 a_theta2")
    first = (m1 + m2) * l1**2 * a2 + m2 * l1 * l2 * (b2 * sp.cos(a - b) + slow**2 * sp.sin(a - b))
    second = m2 * l2**2 * b2 + m2 * l1 * l2 * (a2 * sp.cos(a - b) - fast**2 * sp.sin(a - b))
    assert same(shown.equations[0], first + (m1 + m2) * g * l1 * sp.sin(a))
    assert same(shown.equations[1], second + m2 * g * l2 * sp.sin(b))
    assert "theta1'*theta2'" not in "".join(str(shown).splitlines()[1:3])


def test_lines_of_a_pendulum_and_formulas() -> None:
    shown = vv.systems.pendulum().equations
    assert str(shown).splitlines() == [
        "Lagrange's equations",
        "  theta:  g*l*m*sin(theta) + l**2*m*theta'' = 0",
        "Momenta",
        "  p_theta = l**2*m*theta'",
        "Jacobi's integral, conserved",
        "  h = -g*l*m*cos(theta) + l**2*m*theta'**2/2",
    ]
    formulas = shown._repr_latex_()
    assert formulas.startswith("$$")
    assert formulas.endswith("$$")
    assert r"g l m \sin{\left(\theta \right)} + l^{2} m \ddot{\theta} &= 0" in formulas
    assert r"p_{\theta} &= l^{2} m \dot{\theta}" in formulas
    assert "  p_phi = l**2*m*phi'*sin(theta)**2, conserved" in str(vv.systems.spherical_pendulum().equations)


def test_reactions_are_on_the_right() -> None:
    """m q̈ = m g + λ: the multiplier is the force along the gradient, as a run records it."""
    machine = vv.systems.atwood()
    shown = machine.equations
    m1, m2, g, x1, x2, length, reaction = sp.symbols("m1 m2 g x1 x2 length lambda_1")
    assert same(shown.equations[0], m1 * sp.Symbol("a_x1"), m1 * g + reaction)
    assert same(shown.constraints[0], x1 + x2 - length)
    values = {sp.Symbol(name): value for name, value in machine.parameters.items()}
    acceleration = (m1 - m2) * g / (m1 + m2)
    tension = sp.solve(shown.equations[0].subs(sp.Symbol("a_x1"), acceleration), reaction)[0].subs(values)
    assert machine.run(0.1).reactions[-1, 0] == pytest.approx(float(tension), rel=1e-14, abs=0)


def test_a_rolling_constraint_is_along_velocities() -> None:
    (x, y), (vx, vy) = sp.symbols("x y"), sp.symbols("u w")
    skate = vv.Lagrangian(
        (vx**2 + vy**2) / 2, [x, y], velocities=[vx, vy], nonholonomic=[vy - x * vx], position=[0.0, 0.0]
    )
    assert same(skate.equations.equations[0], sp.Symbol("a_x"), -x * sp.Symbol("lambda_1"))
    assert same(skate.equations.constraints[0], vy - x * vx)


def test_hamiltons_equations_have_further_forces() -> None:
    x, p, b = sp.symbols("x p b")
    damped = vv.Hamiltonian(p**2 / 2 + x**2 / 2, [x], [p], parameters={b: 0.1}, forces={x: -b * p})
    rates, slopes = damped.equations
    assert rates == [p]
    assert sp.expand(slopes[0] + x + b * p) == 0
    assert str(damped.equations).splitlines() == ["Hamilton's equations", "  x' = p", "  p' = -b*p - x"]
    assert r"\dot{p} &= - b p - x" in damped.equations._repr_latex_()
    assert str(pickle.loads(pickle.dumps(damped.equations))) == str(damped.equations)


def test_names_that_meet_are_told_apart() -> None:
    """Parameters called as momenta and multipliers usually are stay themselves; the others get names of their own."""
    weight, slope = sp.Symbol("lambda_1"), sp.Symbol("p_x")
    x, y = vv.coordinate("x"), vv.coordinate("y")
    free = (x.diff(vv.time) ** 2 + y.diff(vv.time) ** 2) / 2
    held = vv.Lagrangian(
        free - weight * x, [x, y], parameters={weight: 2.0}, constraints=[x**2 + y**2 - 1], position=[1.0, 0.0]
    )
    assert "x:  lambda_1 + x'' = 2*lambda_1_*x" in str(held.equations)
    falling = vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - slope * x, [x], parameters={slope: 2.0})
    assert "p_x_ = x'" in str(falling.equations)
    assert str(falling.hamiltonian().equations).splitlines()[1:] == ["  x' = p_x_", "  p_x_' = -p_x"]
    # The motion is that of the parameter.
    assert falling.at(position=[1.0], velocity=[0.0]).hamiltonian().run(t=1.0).position[-1, 0] == pytest.approx(
        0.0, abs=1e-15
    )
