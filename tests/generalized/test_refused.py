"""What cannot be run is refused before anything runs, by name and with what to do.

Bounds: energies next to a singularity, where potentials are 1e4 times the energy.
"""

import inspect
import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

t = sp.Symbol("t")
theta, phi = vv.coordinate("theta"), vv.coordinate("phi")
rate, turning = theta.diff(t), phi.diff(t)
x, y, z = vv.coordinate("x y z")
vx, vy = x.diff(t), y.diff(t)
g, m = sp.symbols("g m")
L = rate**2 / 2 + g * sp.cos(theta)
FREE = (vx**2 + vy**2) / 2
REST = {"position": [0.0, 0.0]}


def lagrangian(function: Any, coordinates: Any = (theta,), **further: Any) -> Callable[[], Any]:
    return lambda: vv.Lagrangian(function, list(coordinates), **further)


def plane(function: Any = FREE, **further: Any) -> Callable[[], Any]:
    return lambda: vv.Lagrangian(function, [x, y], **{"position": [0.0, 0.0], **further}).run(1.0)


def space(**further: Any) -> Callable[[], Any]:
    start = {"position": [0.0, 0.0, 0.0], **further}
    return lambda: vv.Lagrangian(FREE + z.diff(t) ** 2, [x, y, z], **start).run(1.0)


def one(function: Callable[..., Any], **further: Any) -> Callable[[], Any]:
    return lambda: vv.Lagrangian(function, ["x"], **further)


def run(system: Any, *times: Any, **how: Any) -> Callable[[], Any]:
    return lambda: system.run(*times, **how)


PENDULUM = vv.systems.pendulum()
VALLEY = vv.Lagrangian(vx**2 / 2 - sp.Abs(x), [x], position=[1.0])
OVER_A_KINK = "would choose steps that pass over where an absolute value turns"
ACROSS_A_KINK = "expected a function without absolute values: where one turns the derivatives of a motion jump"

REFUSED = [
    # Kinks
    (run(VALLEY, 1.0, method="gauss16"), "method", f"gauss16 {OVER_A_KINK}, as if it did not; dop853 makes"),
    (run(VALLEY, 1.0, method="gauss4"), "method", f"gauss4 {OVER_A_KINK}"),
    (run(VALLEY.ensemble(position=[[1.0], [2.0]]), 1.0, method="gauss8"), "method", f"gauss8 {OVER_A_KINK}"),
    (lambda: VALLEY.poincare("x", 5.0, method="gauss16"), "method", f"gauss16 {OVER_A_KINK}"),
    (lambda: VALLEY.flow_jacobian(5.0), "system", ACROSS_A_KINK),
    (lambda: VALLEY.lyapunov_exponents(5.0), "system", ACROSS_A_KINK),
    (lambda: VALLEY.boundary_value(5.0, [0.0]), "system", ACROSS_A_KINK),
    # Expressions
    (lagrangian(rate**2 / 2 + phi**2), "L", r"phi\(t\) is not among the coordinates \[theta\(t\)\]; add it"),
    (lagrangian(rate**2 + turning**2), "L", r"Derivative\(phi\(t\), t\) is in it, but phi\(t\) is not among"),
    (lagrangian(L), "L", r"free symbol 'g' has no value; pass parameters=\{g: …\}"),
    (lagrangian(rate**2 + rate.diff(t)), "L", r"second derivative of theta\(t\) is in it: only first ones"),
    (lagrangian(rate**2 / 2 + sp.Derivative(sp.sin(g * t), t), parameters={g: 1.0}), "L", "call its doit"),
    (lagrangian(sp.Matrix([rate**2])), "L", "expected a scalar expression, got ImmutableDenseMatrix"),
    (lagrangian("theta"), "L", "got the text 'theta'; sympy.sympify makes one of it"),
    (lagrangian(None), "L", "expected an expression of SymPy, got NoneType"),
    (lagrangian(sp.besselj(0, theta)), "L", "function besselj is not known to the compiled core; known: sin, cos"),
    (lagrangian(sp.Function("f")(theta)), "L", "not among the coordinates"),
    (
        lagrangian(sp.Piecewise((theta, theta > 0), (0, True))),
        "L",
        "Piecewise switches inside a step.* which steps follow",
    ),
    (
        lagrangian(sp.Heaviside(theta)),
        "L",
        r"Heaviside switches inside a step.* \(1 \+ tanh\(x/width\)\)/2, which steps follow",
    ),
    (lagrangian(sp.Max(theta, 0)), "L", "Max switches inside a step"),
    (lagrangian(sp.sign(theta)), "L", r"sign switches inside a step.* tanh\(x/width\), which steps follow"),
    (lagrangian(sp.I * theta), "L", "expected real numbers, got I"),
    (lagrangian(sp.oo * theta), "L", "expected finite real numbers, got oo"),
    (lagrangian(L, parameters={g: 1.0}, forces={theta: m}), "forces", "free symbol 'm' has no value"),
    (lagrangian(L, parameters={g: 1.0}, dissipation=m), "dissipation", "free symbol 'm' has no value"),
    (lagrangian(L, parameters={g: 1.0}, constraints=[m]), "constraints", "free symbol 'm' has no value"),
    # Names
    (lagrangian(L, [theta, theta], parameters={g: 1.0}), "coordinates", "expected different names"),
    (lagrangian(L, []), "coordinates", "expected at least one coordinate, got none"),
    (lagrangian(L, ["theta"]), "coordinates", r"vv.coordinate\('theta'\) makes them.*got 'theta'"),
    (lagrangian(L, [t]), "coordinates", "got t"),
    (lagrangian(L, [rate]), "coordinates", "got Derivative"),
    (lagrangian(m**2, [m]), "velocities", "expected the velocities of coordinates that are symbols"),
    (lagrangian(m**2, [m], velocities=[g, g]), "velocities", "expected 1, one for each of"),
    (lagrangian(L, parameters=[g]), "parameters", r"expected values by parameter, as \{g: 9.81\}, got list"),
    (lagrangian(L, parameters={3: 1.0}), "parameters", "expected symbols or names, got 3"),
    (lagrangian(L, parameters={t: 1.0}), "parameters", "t is the time"),
    (lagrangian(L, parameters={g: math.nan}), "parameters['g']", "expected finite numbers"),
    (lagrangian(L, parameters={g: "a"}), "parameters['g']", "got a str"),
    (lagrangian(L, parameters={g: 1.0}, forces={"phi": 1.0}), "forces", "there is no coordinate 'phi'"),
    (lagrangian(L, parameters={g: 1.0}, forces=[1.0]), "forces", r"as \{theta: Q\}, got list"),
    (lagrangian(L, parameters={g: 1.0}, position=[1.0, 2.0]), "position", r"expected shape \(1,\), got \(2,\)"),
    (lagrangian(L, parameters={g: 1.0}, position=[math.inf]), "position", "expected finite numbers"),
    (lagrangian(L, parameters={g: 1.0}, velocity=[[1.0]]), "velocity", r"expected shape \(1,\)"),
    (lagrangian(L, parameters={g: 1.0}, t0=math.nan), "t0", "expected finite numbers"),
    (lambda: vv.coordinate("2x"), "names", "got '2x'"),
    (lambda: vv.coordinate("x t"), "names", "and not t, which is the time"),
    (lambda: vv.coordinate(""), "names", "expected the name of a coordinate"),
    (lambda: vv.Hamiltonian(m**2 / 2, [g]), "p", r"expected the momenta, one for each of \[g\]"),
    (lambda: vv.Hamiltonian(m**2 / 2, [g], [m, g]), "p", "expected 1, one for each"),
    (lagrangian(m**2, [m], velocities=[m]), "velocities", "m is something else, too; use another symbol"),
    (lagrangian(m**2, [m, g], velocities=[x, x]), "velocities", r"x\(t\) is something else, too"),
    (lagrangian(m**2, [m], velocities=[t]), "velocities", "t is something else, too"),
    (lagrangian(m**2, [m], velocities=[3.0]), "velocities", "expected symbols, got 3.0"),
    (lambda: vv.Hamiltonian(m**2 / 2, [m], [m]), "p", "m is something else, too"),
    (lagrangian(m**2, [m], velocities=[g], parameters={m: 1.0}), "parameters", "'m' is a coordinate"),
    (lagrangian(m**2, [m], velocities=[g], parameters={g: 1.0}), "velocities", "g is something else, too"),
    (one(lambda q, v, t, x: x * v[0], parameters={"x": 1.0}), "parameters", "'x' is a coordinate"),
    # Functions
    (one(lambda q, v, t: v[0] if q[0] > 0 else q[0]), "L", "must not branch on coordinates.* which steps follow"),
    (one(lambda q, v, t: v[0] if q[0] == 0 else q[0]), "L", "must not branch on coordinates"),
    (one(lambda q, v, t: v[0] or q[0]), "L", "must not branch on coordinates"),
    (one(lambda q, v, t: np.maximum(q[0], 0.0)), "L", "must not branch on coordinates"),
    (one(lambda q, v, t: math.sin(q[0])), "L", "use NumPy's functions, as np.sin, and not those of math"),
    (one(lambda q, v, t: np.interp(q[0], [0.0, 1.0], [0.0, 1.0])), "L", "tables, as np.interp, in whose place stands"),
    (one(lambda q, v, t: np.array([v[0], q[0]])), "L", "expected one number of the function, got ndarray"),
    (one(lambda q, v, t: None), "L", "expected one number of the function, got NoneType"),
    (one(lambda q, v, t: 1j * v[0]), "L", "got complex in it"),
    (one(lambda q, v, t: "x" * 3), "L", "expected one number"),
    (one(lambda q, v, t: math.inf * v[0]), "L", "expected finite numbers, got inf"),
    (one(lambda q, v, t: math.nan), "L", "expected finite numbers, got nan"),
    (one(lambda q, v, t: q[0].real), "L", "function real is not known"),
    (one(lambda q, v, t, k: k * v[0]), "parameters", r"value of 'k', which L takes; pass parameters={'k': ...}"),
    (one(lambda t, q, v: v[0] ** 2), "L", r"f\(position, velocity, t\), in this order, got f\(t, q, v\)"),
    (
        lambda: PENDULUM.run(1.0, events=[lambda t, q, v: q[0] - 0.1]),
        "events",
        r"f\(position, velocity, t\), in this order, got f\(t, q, v\); .* visviva.events.function",
    ),
    (lambda: vv.Lagrangian(lambda q, v, _: v[0] ** 2, ["t"]), "coordinates", "t is the time"),
    (one(lambda q, v, t: v[0], parameters={"k": 1.0}), "L", r"called with \(position, velocity, t, k=\)"),
    (lambda: PENDULUM.evaluate(sp.sin(theta)), "expressions", "got a sin"),
    (lambda: vv.systems.henon_heiles().poisson(x, y), "f", "brackets are of expressions of SymPy"),
    # Equations without a meaning
    (lagrangian(rate**2 / 2 + phi * theta, [theta, phi]), "L", "degenerate: .* velocity of coordinate 'phi' vanishes"),
    (lagrangian(x * vy - y * vx - x**2, [x, y]), "L", "degenerate: .* coordinate 'x' vanishes .* no acceleration"),
    (plane((vx + vy) ** 2 / 2 - x**2), "position", "a mass matrix that is singular there"),
    (run(vv.systems.spherical_pendulum(position=[0.0, 0.0]), 1.0), "position", "acceleration of 'phi' is no number"),
    (run(vv.systems.central_force(position=[0.0, 0.0]), 1.0), "position", "'r' is no number at the start: a singul"),
    (lambda: vv.Hamiltonian(m**2 / 2 + 1 / g, [g], [m], position=[0.0]).run(1.0), "position", "singularity of H"),
    (lambda: vv.Lagrangian(rate**2 / 2, [theta]).run(1.0), "position", r"coordinates \['theta'\] at the start"),
    # Constraints
    (plane(constraints=[x + vx]), "constraints", "constraint 0 contains velocities; pass it as nonholonomic="),
    (plane(constraints=[x, t]), "constraints", "constraint 1 contains no coordinate"),
    (plane(nonholonomic=[vx * vy]), "nonholonomic", "constraint 0 is not linear in the velocities"),
    (plane(nonholonomic=[vx, y]), "nonholonomic", "constraint 1 contains no velocity; pass it as constraints="),
    (plane(constraints=[x, y, x + y]), "constraints", "3 constraints leave nothing of 2 coordinates"),
    (plane(constraints=[x + y, 2 * x + 2 * y]), "constraints", "constraints 0 and 1 are dependent at the start"),
    (plane(constraints=[x + y], nonholonomic=[vx + vy]), "constraints", "constraints 0 and 1 are dependent"),
    (plane(constraints=[x + y, 2 * x + 2 * y - 1]), "constraints", "constraints 0 and 1 do not agree"),
    (plane(constraints=[x - t, x - 2 * t], position=[0.0, 0.0]), "constraints", "0 and 1 do not agree"),
    (plane(constraints=[x + y], nonholonomic=[vx + vy - 1]), "constraints", "0 and 1 do not agree"),
    (
        plane(constraints=[x + y - 1, x**2 + 2 * x * y + y**2 - 1], position=[1.0, 0.0]),
        "constraints",
        "0 and 1 are dep",
    ),
    (space(constraints=[z, x + z, 3 * x]), "constraints", "constraint 2 follows from constraints 0, 1 at"),
    (space(constraints=[z - 1, x + z, 3 * x - 3]), "constraints", "constraints 0, 1 and 2 do not agree"),
    (space(constraints=[x + z, x - z, z + y, 3 * z]), "constraints", "4 constraints leave nothing of 3"),
    (space(constraints=[x, x + z], nonholonomic=[2 * vx]), "constraints", "constraints 0 and 2 are dependent"),
    (space(constraints=[x, x + z], nonholonomic=[2 * vx - 1]), "constraints", "0 and 2 do not agree"),
    (plane(constraints=[x * y]), "constraints", "constraint 0 has no gradient at the start"),
    (plane(constraints=[x + 0.5]), "position", r"constraint 0 is 0\.5 at the start .* consistent='project'"),
    (plane(constraints=[y, x], velocity=[2.0, 0.0]), "velocity", "the rate of constraint 1 is 2 at the start"),
    (plane(nonholonomic=[vx - 3]), "velocity", "the rate of constraint 0 is -3 at the start"),
    (plane(constraints="x"), "constraints", "got the text 'x'"),
    # Runs
    (run(PENDULUM, 1.0, method="gaus16"), "method", "did you mean 'gauss16'"),
    (run(PENDULUM, 1.0, method=None), "method", "got None"),
    (run(PENDULUM, 1.0, method="automatic"), "method", "expected one of auto, gauss16, .*rattle8 or a method of"),
    (
        run(
            vv.Lagrangian(lambda q, v, t: v[0] ** 2 - np.arctan2(q[0], 1.0) ** 2, ["x"], position=[1.0]),
            1.0,
            method="taylor",
        ),
        "method",
        "atan2 in these leaps by 2π at negative x, which no series tells; gauss16 and dop853 take them",
    ),
    (run(PENDULUM, 1.0, method="rk4"), "dt", "rk4 has a fixed one; pass dt"),
    (run(PENDULUM, 1.0, method="dop853", dt=0.1), "dt", "chooses its own steps; leave dt out"),
    (run(vv.systems.pendulum(), [0.0, 1.0, -1.0]), "t", "got -1 after 1"),
    (run(vv.systems.pendulum(), [0.0, -1.0, 1.0]), "t", "got 1 after -1"),
    (run(vv.systems.double_pendulum(), 1.0, method="leapfrog", dt=0.1), "method", r"H = T\(p\) \+ V\(q\).*gauss16"),
    (run(vv.systems.atwood(), 1.0, method="yoshida4", dt=0.1), "method", "keeps no constraints; gauss16 and dop853 do"),
    (run(PENDULUM, []), "t", "expected the end, or output times"),
    (run(PENDULUM, [[1.0]]), "t", r"an array of shape \(1, 1\)"),
    (run(PENDULUM, [2.0, 1.0]), "t", "expected times in order from t0 = 0 on"),
    (run(PENDULUM, [-1.0, 1.0]), "t", "expected times in order"),
    (run(PENDULUM, math.nan), "t", "expected finite numbers"),
    (run(PENDULUM, 1.0, rtol=1.0), "rtol", "expected a tolerance between 1e-15 and 1e-2, got 1"),
    (run(PENDULUM, 1.0, rtol=0.0), "rtol", "expected a tolerance"),
    (run(PENDULUM, 1.0, dt=-0.1), "dt", "expected a positive number, got -0.1; the direction is that of t"),
    (run(PENDULUM, 1.0, max_step=0.0), "max_step", "expected a positive number"),
    # Copies
    (
        lambda: PENDULUM.at(parameters={"q": 1.0}),
        "parameters",
        r"there is no parameter 'q'; there are \['g', 'l', 'm'\]",
    ),
    (lambda: PENDULUM.at(speed=[1.0]), "speed", "expected a keyword of at"),
    (lambda: PENDULUM.at(velocity=[1.0], momentum=[1.0]), "momentum", "expected velocity or momentum, got both"),
    (lambda: PENDULUM.at(momentum=[1.0, 2.0]), "momentum", r"expected shape \(1,\)"),
    (lambda: PENDULUM.hamiltonian().at(velocity=[1.0], momentum=[1.0]), "velocity", "got both"),
    (lambda: PENDULUM.ensemble(momentum=[[1.0], [2.0]], parameters={"l": [1.0, 2.0]}), "momentum", "does not follow"),
    (lambda: PENDULUM.ensemble(position=[[1.0]], momentum=[[1.0], [2.0]]), "momentum", r"\(B, 1\) with B = 1"),
    (PENDULUM.ensemble, "position", "velocity or parameters of the copies, got none"),
    (lambda: PENDULUM.ensemble(position=[[1.0], [2.0]], velocity=[[1.0]]), "velocity", r"\(B, 1\) with B = 2"),
    (lambda: PENDULUM.ensemble(position=np.zeros((0, 1))), "position", "expected at least one copy, got none"),
    (lambda: PENDULUM.ensemble(parameters={"z": [1.0]}), "parameters", "there is no parameter 'z'"),
    (
        lambda: PENDULUM.ensemble(position=np.ones((100_000, 1))).run(np.linspace(0.0, 1.0, 1_000_000)),
        "t",
        "1000000 times of states of 2 numbers in 100000 copies would take",
    ),
    (lambda: PENDULUM.ensemble(position=[[1.0]]).run(1.0, threads=0), "threads", "from 1 to 1024, got 0"),
    (
        lambda: vv.systems.atwood().ensemble(position=[[1.0, 1.0], [1.0, 1.5], [1.0, 1.0]]).run(1.0),
        "position",
        r"copy 1: constraint 0 is 0\.5 at the start",
    ),
    (lambda: setattr(PENDULUM, "position", [1.0]), "position", "frozen"),
    (lambda: PENDULUM.run(1.0)["phi"], "name", r"no coordinate 'phi'; there are \['theta'\]"),
]


@pytest.mark.parametrize(
    ("call", "argument", "message"), REFUSED, ids=[f"{i}-{row[1]}" for i, row in enumerate(REFUSED)]
)
def test_it_is_refused_by_name(call: Callable[[], Any], argument: str, message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as caught:
        call()
    assert caught.value.argument == argument


def test_a_constraint_follows_from_two_others() -> None:
    (a, b, c), v = vv.coordinate("a b c"), [each.diff(t) for each in vv.coordinate("a b c")]
    system = vv.Lagrangian(
        sum(u**2 for u in v) / 2, [a, b, c], position=[0.0, 0.0, 0.0], constraints=[a + b, c, a + b + 3 * c]
    )
    with pytest.raises(vv.InvalidInput, match="constraint 2 follows from constraints 0, 1 at the start"):
        system.run(1.0)


@pytest.mark.parametrize(("method", "within"), [("gauss16", 1e-12), ("dop853", 1e-12)])
def test_a_singularity_on_the_way_keeps_what_was_computed(method: str, within: float) -> None:
    """A fall into the center: at r₀^(3/2) π/2√2, which is when it says."""
    fall = vv.systems.central_force(velocity=[0.0, 0.0])
    with pytest.raises(vv.ConvergenceError, match="a singularity") as caught:
        fall.run(np.linspace(0.0, 2.0, 21), method=method)
    assert caught.value.time == pytest.approx(np.pi / np.sqrt(8.0), abs=within)
    kept = caught.value.trajectory
    assert len(kept) == 12
    assert kept.status is vv.Status.STEP_FAILURE
    assert np.abs(kept.energy + 1.0).max() < 1e-10
    copies = fall.ensemble(velocity=[[0.0, 1.0], [0.0, 0.0]])
    both = copies.run(np.linspace(0.0, 2.0, 21), method=method)
    assert list(both.status) == [vv.Status.OK, vv.Status.STEP_FAILURE]
    assert np.isfinite(both.position[0]).all()
    assert np.array_equal(np.isnan(both.position[1, :, 0]), both.t > 1.15)


def test_what_nests_deeply_is_refused_or_done() -> None:
    limit, deep = sys.getrecursionlimit(), theta
    sys.setrecursionlimit(100_000)  # SymPy itself needs much of it
    try:
        for _ in range(200):
            deep = sp.sin(deep, evaluate=False)
        expression = rate**2 + deep
    finally:
        sys.setrecursionlimit(limit)
    # What is left of Python's stack under the tests differs; so little is not enough for any.
    sys.setrecursionlimit(len(inspect.stack()) + 150)
    try:
        with pytest.raises(vv.InvalidInput, match="nested too deeply; write it as a function"):
            vv.Lagrangian(expression, [theta])
    finally:
        sys.setrecursionlimit(limit)

    def function(q: Any, v: Any, t: Any) -> Any:
        deep = q[0]
        for _ in range(2000):
            deep = np.sin(deep)
        return v[0] ** 2 / 2 + deep

    assert np.isfinite(vv.Lagrangian(function, ["theta"], position=[1.0]).run(0.1).position).all()


def test_results_are_read_only() -> None:
    out = PENDULUM.ensemble(position=[[0.1], [0.2]]).run(1.0)
    for one in (out, out[0], PENDULUM.run(1.0)):
        for name in ("position", "velocity", "momentum", "energy", "reactions", "t"):
            with pytest.raises(ValueError, match="read-only"):
                getattr(one, name)[...] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        PENDULUM.position[0] = 1.0


def test_too_long_a_step_is_told() -> None:
    with pytest.raises(vv.ConvergenceError, match="take a smaller dt"):
        PENDULUM.run(100.0, dt=10.0)


def test_a_start_that_overflows_or_has_no_mass_says_so() -> None:
    x = vv.coordinate("x")
    v = x.diff(vv.time)
    quartic = vv.Lagrangian(v**4 - x**2, [x], position=[1.0], velocity=[0.0])
    with pytest.raises(vv.InvalidInput, match=r"mass matrix.*is singular there.*start with a velocity") as refused:
        quartic.run(1.0)
    assert refused.value.argument == "velocity"
    assert quartic.at(velocity=[1.0]).run(0.1).status is vv.Status.OK
    steep = vv.Lagrangian(v**2 / 2 - sp.exp(x), [x], position=[1000.0])
    for system in (steep, steep.hamiltonian()):
        with pytest.raises(vv.InvalidInput, match=r"beyond 1.8e308"):
            system.run(1.0)
    pole = vv.Lagrangian(v**2 / 2 - 1 / x, [x], position=[0.0])
    for system in (pole, pole.hamiltonian()):
        with pytest.raises(vv.InvalidInput, match="a singularity of"):
            system.run(1.0)


def test_a_velocity_beyond_the_domain_of_the_function() -> None:
    """L = −√(1 − v²): faster than light there is no energy, though without a force the acceleration is 0."""
    free = vv.Lagrangian(lambda q, v, t: -np.sqrt(1.0 - v[0] ** 2), ["x"], position=[0.0], velocity=[0.5])
    assert free.run(1.0).position[-1, 0] == pytest.approx(0.5, rel=1e-15, abs=0)
    fast = free.at(velocity=[1.5])
    told = "the momentum of 'x' and the energy are no numbers at the start: L is not defined there"
    with pytest.raises(vv.InvalidInput, match=told) as caught:
        fast.run(1.0)
    assert caught.value.argument == "velocity"
    for asked in (fast.flow_jacobian, fast.lyapunov_exponents, lambda _: fast.period()):
        with pytest.raises(vv.InvalidInput, match=told):
            asked(1.0)
    with pytest.raises(vv.ConvergenceError, match="no motion through both places"):
        free.boundary_value(1.0, [1.5])
    with pytest.raises(vv.InvalidInput, match=told):
        fast.boundary_value(1.0, [0.5])
    # Of light itself they are infinite.
    with pytest.raises(vv.InvalidInput, match="the momentum of 'x' and the energy are no number or infinite at the"):
        free.at(velocity=[1.0]).run(1.0)
    # An energy that is only beyond the range of numbers is no reason: the motion is x cos t.
    far = vv.Lagrangian(lambda q, v, t: (v[0] ** 2 - q[0] ** 2) / 2.0, ["x"], position=[1e200])
    for out in (far.run(1.0).position[-1, 0], far.ensemble(position=[[1e200]]).run(1.0).position[0, -1, 0]):
        assert out == pytest.approx(1e200 * np.cos(1.0), rel=1e-14, abs=0)
    for threads in (1, 3):
        with pytest.raises(vv.InvalidInput, match=f"copy 2: {told}"):
            free.ensemble(velocity=[[0.5], [-0.5], [1.5], [2.0]]).run(1.0, threads=threads)


def test_a_place_beyond_the_domain_of_the_function() -> None:
    """log(q) where q < 0: no energy, though 1/q is a number; at q = 0 no force, as the status of a copy tells."""
    log = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2.0 - np.log(q[0]), ["x"], position=[-1.0])
    for system, function in ((log, "L"), (log.hamiltonian(), "H")):
        told = f"the energy is no number at the start: {function} is not defined there"
        with pytest.raises(vv.InvalidInput, match=told) as caught:
            system.run(0.5)
        assert caught.value.argument == "position"
        with pytest.raises(vv.InvalidInput, match=told):
            system.boundary_value(0.5, [-1.5])
        with pytest.raises(vv.InvalidInput, match=f"copy 1: {told}"):
            system.ensemble(position=[[1.0], [-1.0]]).run(0.5)
        out = system.ensemble(position=[[1.0], [0.0]]).run(0.5)
        assert out.status.tolist() == [vv.Status.OK, vv.Status.STEP_FAILURE]
