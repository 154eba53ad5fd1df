"""Variational integrators: the discrete action is stationary, and what follows from that follows.

Bounds: discrete equations are solved to the last bits, 2 EPSILON of their terms; two ways to the same step part by
its roundings, 1e-15 a step and ten times that after a run; the midpoint is of order 2, whose error at these steps is
6e-6.
"""

import math
from typing import Any

import numpy as np
import pytest
from discrete_systems import ORDERS, charge_in_a_well, systems
from test_runs import pade, states

import visviva as vv

EPSILON = 2.0**-52
#: Steps at which errors are small, and far from round-off.
STEPS = {2: 0.01, 4: 0.05, 6: 0.1, 8: 0.25}
FORCED = {"dragged"}


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", systems())
def test_the_order_of_motions_that_are_not_linear(name: str, method: str) -> None:
    system, order = systems()[name], ORDERS[method]
    exact = states(system.run(2.0, rtol=1e-15))[-1]
    # At a polar angle that comes near to zero a step is longer than elsewhere.
    h = 0.125 if (name, order) == ("spherical_pendulum", 8) else STEPS[order]
    coarse, fine = (np.abs(states(system.run(2.0, method=method, dt=dt))[-1] - exact).max() for dt in (h, h / 2))
    # Above round-off, and so small (at most 1.4e-4) that the next order is seen by 0.1 at most.
    assert 1e-14 < fine < coarse < 4e-4
    assert math.log2(coarse / fine) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", systems())
def test_the_discrete_euler_lagrange_equations_hold(name: str, method: str) -> None:
    """Places are written down with a last digit each: a few of those of q M/h and of the momenta."""
    times = np.arange(201) / 16
    out = systems()[name].run(times, method=method, dt=1 / 16)
    found = out.system.discrete_action(out)
    assert found.method == method
    assert found.residual.shape == (199, out.position.shape[1])
    assert found.relative_residual.max() <= 2 * EPSILON
    # The discrete Legendre transforms are the momenta of the run.
    mass = np.abs(out.momentum).max() / np.abs(out.velocity).max()
    size = np.abs(out.momentum).max() + 32 * mass * np.abs(out.position).max()
    for momenta, wanted in ((found.momentum_before, out.momentum[:-1]), (found.momentum_after, out.momentum[1:])):
        assert np.abs(momenta - wanted).max() <= 4 * EPSILON * size
    # Another path does not solve them.
    wrong = out.system.discrete_action((times, out.position + 1e-6 * np.sin(40 * times)[:, None]), method=method)
    assert np.abs(wrong.residual).max() > 1e-8


@pytest.mark.parametrize("method", ORDERS)
def test_they_hold_from_rest_at_the_origin(method: str) -> None:
    """Where neither places nor velocities tell how small a correction is, and the first is far off."""
    pulled = vv.Lagrangian(lambda q, v, t: -np.sqrt(1.0 - v[0] ** 2) + 2 * q[0] - np.cosh(q[0]), ["x"], position=[0.0])
    for direction in (1.0, -1.0):
        times = direction * np.arange(9) / 4
        found = pulled.discrete_action(pulled.run(times, method=method, dt=0.25))
        assert found.relative_residual.max() <= 2 * EPSILON
        # The motion begins with no momentum.
        assert abs(found.momentum_before[0, 0]) <= 2 * EPSILON
        assert found.method == method
    still = vv.systems.pendulum(position=[0.0]).run([0.0, 1.0], method=method, dt=0.1)
    assert not still.position.any()
    assert not still.velocity.any()


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", [name for name in systems() if name not in FORCED])
def test_the_discrete_action_is_stationary(name: str, method: str) -> None:
    """Σ L_d changes by O(ε²) where the ends are held, and by p δq where they are not."""
    times = np.linspace(0.0, 2.0, 41)
    out = systems()[name].run(times, method=method, dt=0.05)
    system, n = out.system, out.position.shape[1]
    bump = np.sin(np.pi * times / 2) * np.cos(3 * times)
    held = bump[:, None] * np.linspace(1.0, 0.6, n)

    def S(eta: Any, epsilon: float) -> float:
        return float(system.discrete_action((times, out.position + epsilon * eta), method=method))

    # Differences of even powers: (S(ε) + S(−ε))/2 − S(0) goes with ε², odd ones with ε³.
    even = [S(held, e) + S(held, -e) - 2 * S(held, 0.0) for e in (1e-2, 5e-3)]
    odd = [S(held, e) - S(held, -e) for e in (1e-2, 5e-3)]
    assert even[0] / even[1] == pytest.approx(4.0, rel=1e-2)
    assert abs(odd[0]) <= 3e-2 * abs(even[0]) + 1e-12
    assert abs(odd[1]) <= 0.3 * abs(odd[0]) + 1e-12
    # Ends that move: p δq there.
    free = np.ones((len(times), n))
    free[:, 0] += times
    slope = (S(free, 1e-3) - S(free, -1e-3)) / 2e-3
    wanted = float(out.momentum[-1] @ free[-1] - out.momentum[0] @ free[0])
    # The difference of second order leaves ε²/6 of the third derivative of S: measured 1.2e-5.
    assert slope == pytest.approx(wanted, abs=3e-5 * (1 + np.abs(out.momentum).max()))


@pytest.mark.parametrize("method", ORDERS)
def test_momenta_of_symmetries_are_kept_to_round_off(method: str) -> None:
    how: dict[str, Any] = {"method": method, "dt": 0.1}
    times = np.linspace(0.0, 500.0, 501)
    # A cyclic coordinate: the momentum moves by nothing but how velocities are written down.
    out = systems()["spherical_pendulum"].run(times, **how)
    assert np.ptp(out.momentum[:, 1]) <= 4 * EPSILON * np.abs(out.momentum[:, 1]).max()
    # A turn, which mixes coordinates: 5000 steps of round-off.
    out = charge_in_a_well().run(times, **how)
    (x, y), (px, py) = out.position.T, out.momentum.T
    scale = np.abs(out.position).max() * np.abs(out.momentum).max()
    assert np.ptp(x * py - y * px) <= 20 * EPSILON * scale
    # A shift of two bodies that pull at each other.
    pair = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 + 0.5 * v[1] ** 2 + v[0] * v[1] / 4 - np.cosh(q[0] - q[1]),
        ["a", "b"],
        position=[0.0, 1.0],
        velocity=[0.3, 0.1],
    )
    out = pair.run(np.linspace(0.0, 50.0, 51), **how)
    assert np.ptp(out.momentum.sum(axis=1)) <= 20 * EPSILON * np.abs(out.momentum).max()


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", [name for name in systems() if name not in FORCED])
def test_the_map_is_symplectic(name: str, method: str) -> None:
    """Φᵀ J Φ = J by differences of order 4 in (q, p); rk4 with such steps is none, which this tells."""
    system = systems()[name]
    start = np.concatenate([system.position, system.momentum])
    n = len(system.position)
    delta = 2e-3
    offsets = np.concatenate([k * delta * np.eye(2 * n) for k in (-2, -1, 1, 2)])
    many = system.ensemble(position=start[:n] + offsets[:, :n], momentum=start[n:] + offsets[:, n:])
    J = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])

    def defect(method: str) -> float:
        out = many.run(1.0, method=method, dt=0.25)
        ends = np.concatenate([out.position[:, -1], out.momentum[:, -1]], axis=1).reshape(4, 2 * n, 2 * n)
        jacobian = (ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]).T / (12 * delta)
        return float(np.abs(jacobian.T @ J @ jacobian - J).max())

    # The differences are off by δ⁴ times fifth derivatives.
    assert defect(method) <= 1e-8
    assert defect("rk4") > 1e-6


@pytest.mark.parametrize("method", ORDERS)
def test_energy_does_not_drift(method: str) -> None:
    """20 000 steps: the largest error of the second half is that of the first."""
    system = systems()["double_pendulum"].at(position=[0.5, 0.625])
    out = system.run(np.linspace(0.0, 2000.0, 20_001), method=method, dt=0.1)
    error = np.abs(out.energy / out.energy[0] - 1.0)
    assert error[10_000:].max() <= 1.3 * error[:10_000].max()


def test_rounded_coefficients_do_not_pull() -> None:
    """400 000 steps: what they lose of the momenta, 2e-20 a step, would be 1e-14 here."""
    system = systems()["double_pendulum"].at(position=[0.5, 0.625])
    out = system.run(np.linspace(0.0, 20_000.0, 401), method="variational_lobatto8", dt=0.05)
    assert np.abs(out.energy / out.energy[0] - 1.0).max() <= 4e-15


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", systems())
def test_back_is_where_it_came_from(name: str, method: str) -> None:
    """A step of −h undoes one of h, with drag, too: round-off, as the motion stretches it."""
    system = systems()[name]
    out = system.run(2.0, method=method, dt=0.1)
    back = out.final.run(0.0, method=method, dt=0.1)
    assert np.abs(states(back)[-1] - states(out)[0]).max() <= 1e-13 * (1 + np.abs(states(out)).max()) * 10
    assert out.steps == back.steps == 20
    assert out.longest_step == pytest.approx(0.1, rel=1e-12, abs=0)


@pytest.mark.parametrize(("method", "dt"), [("variational_midpoint", 1e-3), ("variational_lobatto8", 0.02)])
@pytest.mark.parametrize("name", systems())
def test_short_steps_lead_where_gauss_leads(name: str, method: str, dt: float) -> None:
    system = systems()[name]
    times = np.linspace(0.0, 3.0, 4)
    exact, found = states(system.run(times)), states(system.run(times, method=method, dt=dt))
    assert np.abs(found - exact).max() <= (3e-5 if method == "variational_midpoint" else 1e-12)


def test_what_is_what_by_another_name() -> None:
    """The midpoint is Gauss's method of one stage, the trapezoid Störmer's where the mass matrix is constant."""
    for dt in (0.1, 0.5, 1.0):
        out = vv.systems.oscillator().run(10 * dt, method="variational_midpoint", dt=dt)
        assert abs(out.position[-1, 0] - 1j * out.velocity[-1, 0] - pade(1, 1j * dt) ** 10) <= 1e-14
    pendulum = vv.systems.pendulum(position=[2.0])
    times = np.linspace(0.0, 5.0, 51)
    leapfrog = states(pendulum.run(times, method="leapfrog", dt=0.05))
    assert np.abs(states(pendulum.run(times, method="variational_trapezoidal", dt=0.05)) - leapfrog).max() <= 1e-14


def galerkin_gauss(system: vv.Lagrangian, h: float) -> Any:
    """A step of the parabola whose action by Gauss's two points is stationary in its middle: of x⁴ with mass 1 + x²."""
    c, b = np.array([0.5 - math.sqrt(3) / 6, 0.5 + math.sqrt(3) / 6]), np.array([0.5, 0.5])
    values = np.array([(1 - c) * (1 - 2 * c), 4 * c * (1 - c), c * (2 * c - 1)])
    slopes = np.array([4 * c - 3, 4 - 8 * c, 4 * c - 1])
    (q,), (p,) = system.position, system.momentum
    w = np.array([0.5, 1.0]) * system.velocity[0]
    for _ in range(50):
        x, u = q + h * (values[1:].T @ w), slopes[1:].T @ w
        force, momentum = x * u**2 - x**3, (1 + x**2) * u
        rows = h * (values * force) @ b + (slopes * momentum) @ b
        residual = np.array([p, 0.0]) + rows[:2]
        # Newton's method with the derivatives that matter for short steps.
        w = w - np.linalg.solve((slopes[:2] * (b * (1 + x**2))) @ slopes[1:].T, residual)
    return q + h * w[1], rows[2]


def test_galerkin_by_gauss_is_collocation_of_hamiltons_equations() -> None:
    """Hairer, Lubich & Wanner, VI.6.2: so it has no method of its own here; with accelerations it is another one."""
    system = vv.Lagrangian(
        lambda q, v, t: (1 + q[0] ** 2) * v[0] ** 2 / 2 - q[0] ** 4 / 4, ["x"], position=[0.9], velocity=[0.4]
    )
    q, p = galerkin_gauss(system, 0.1)
    out = system.hamiltonian().run(0.1, method="gauss4", dt=0.1)
    assert out.position[-1, 0] == pytest.approx(q, abs=1e-15)
    assert out.momentum[-1, 0] == pytest.approx(p, abs=1e-15)
    other = system.run(0.1, method="gauss4", dt=0.1)
    assert abs(other.position[-1, 0] - q) > 1e-9


@pytest.mark.parametrize("method", ORDERS)
def test_drag_takes_energy_as_it_should(method: str) -> None:
    """dE/dt = −2R: of an oscillator with ẍ + 2γẋ + x = 0 the size falls as e^{−γt}, to the order of the method."""
    gamma, order = 0.05, ORDERS[method]
    damped = vv.Lagrangian(
        lambda q, v, t: v[0] ** 2 / 2 - q[0] ** 2 / 2,
        ["x"],
        position=[1.0],
        dissipation=lambda q, v, t: gamma * v[0] ** 2,
    )
    turn = math.sqrt(1 - gamma**2)

    def rate(dt: float) -> float:
        out = damped.run([10.0, 50.0], method=method, dt=dt)
        # x + i (ẋ + γ x)/turn goes round with the size e^{−γt}.
        size = np.abs(out.position[:, 0] + 1j * (out.velocity[:, 0] + gamma * out.position[:, 0]) / turn)
        return float(np.log(size[0] / size[1]) / 40.0)

    h = {2: 0.1, 4: 0.2, 6: 0.5, 8: 1.0}[order]
    errors = [abs(rate(dt) - gamma) for dt in (h, h / 2)]
    assert errors[1] < 1e-3 * gamma
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.3)
