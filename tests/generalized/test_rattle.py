"""RATTLE and its compositions: constraints and their rates to the last bits, and a symplectic motion on them.

Bounds: by the order, of steps of 0.05 (of order 8 four times what was seen); reactions and momenta to some ten
roundings of the largest, 1e-14; a run there and back to as many.
"""

import math
from typing import Any

import numpy as np
import pytest
import sympy as sp
from by_symbols import coordinates
from test_constraints import EPSILON, gaps, links
from test_runs import states

import visviva as vv

t = sp.Symbol("t")
ORDERS = {"rattle": 2, "rattle4": 4, "rattle6": 6, "rattle8": 8}
#: Steps at which errors are small, and far from round-off.
STEPS = {2: 0.01, 4: 0.04, 6: 0.1, 8: 0.2}


def ball(**further: Any) -> vv.Lagrangian:
    """A spherical pendulum by x, y and z."""
    (x, y, z), (vx, vy, vz) = coordinates("x y z")
    start: dict[str, Any] = {"position": [0.8, 0.0, -0.6], "velocity": [0.3, 0.9, 0.4], **further}
    return vv.Lagrangian(
        (vx**2 + vy**2 + vz**2) / 2 - z, [x, y, z], constraints=[(x**2 + y**2 + z**2 - 1) / 2], **start
    )


def swinging(**further: Any) -> vv.Lagrangian:
    """A pendulum in x and y on a pivot that moves, with drag and a drive."""
    (x, y), (vx, vy) = coordinates("x y")
    px, py = 0.2 * sp.cos(2 * t), 0.1 * sp.sin(3 * t)
    return vv.Lagrangian(
        (vx**2 + vy**2) / 2 - y,
        [x, y],
        position=[0.2 + math.sin(0.5), -math.cos(0.5)],
        velocity=[0.3, 0.3],
        constraints=[((x - px) ** 2 + (y - py) ** 2 - 1) / 2],
        dissipation=0.1 * (vx**2 + vy**2),
        forces={x: 0.3 * sp.cos(t) + 0.1 * vy},
        consistent="project",
        **further,
    )


def bead() -> vv.Lagrangian:
    """A bead on r = 1 + 0.3 cos φ in polar coordinates: a mass matrix that depends on places."""
    (r, phi), (vr, turning) = coordinates("r phi")
    return vv.Lagrangian(
        (vr**2 + r**2 * turning**2) / 2 + r * sp.cos(phi),
        [r, phi],
        position=[1 + 0.3 * math.cos(1.0), 1.0],
        velocity=[0.0, 0.5],
        constraints=[r - 1 - sp.Rational(3, 10) * sp.cos(phi)],
        consistent="project",
    )


def systems() -> dict[str, vv.Lagrangian]:
    return {
        "ball": ball(consistent="project"),
        "chain": links(2, np.array([1.0, 0.5])).at(parameters={"g": 1.0}),
        "swinging": swinging(),
        "bead": bead(),
    }


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", systems())
def test_the_order(name: str, method: str) -> None:
    system, order = systems()[name], ORDERS[method]
    exact = states(system.run(2.0, rtol=1e-15))[-1]
    h = STEPS[order]
    coarse, fine = (np.abs(states(system.run(2.0, method=method, dt=dt))[-1] - exact).max() for dt in (h, h / 2))
    # Above round-off, and so small (at most 3.4e-5) that the next order is seen by 0.09 at most.
    assert 1e-14 < fine < coarse < 1e-4
    assert math.log2(coarse / fine) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("method", ORDERS)
def test_the_spherical_pendulum_is_that_of_its_chart(method: str) -> None:
    system = ball(consistent="project")
    (x, y, z), (vx, vy, vz) = system.position, system.velocity
    rho = math.hypot(x, y)
    chart = vv.systems.spherical_pendulum(
        g=1.0,
        position=[math.acos(-z), math.atan2(y, x)],
        velocity=[vz / rho, (x * vy - y * vx) / rho**2],
    )
    times = np.linspace(0.0, 5.0, 6)
    theta, phi = chart.run(times).position.T
    wanted = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), -np.cos(theta)], axis=1)
    error = np.abs(system.run(times, method=method, dt=0.02).position - wanted).max()
    assert error <= {2: 3e-4, 4: 3e-6, 6: 3e-10, 8: 1e-13}[ORDERS[method]]


@pytest.mark.parametrize("outputs", ["nodes", "between"])
@pytest.mark.parametrize("method", ORDERS)
def test_a_chain_of_three_keeps_lengths(method: str, outputs: str) -> None:
    """2000 steps of 0.05 with |g| ≤ 4 ε; energies stay near, with rattle8 and steps of 0.005 to round-off."""
    chain = links(3, np.array([0.5, 0.625, 0.75]))
    steps = 0.05 * np.arange(1, 2001)
    out = chain.run(steps if outputs == "nodes" else steps - 0.03, method=method, dt=0.05)
    assert gaps(out.position).max() <= 4
    speed = np.abs((out.position * out.velocity)[:, :2].sum(axis=1)).max()
    assert speed <= 8 * EPSILON * np.abs(out.velocity).max()
    error = np.abs(out.energy / chain.energy - 1.0)
    assert error[1000:].max() <= 2.0 * error[:1000].max()
    assert error.max() <= {2: 1e-3, 4: 1e-5, 6: 3e-9, 8: 1e-12}[ORDERS[method]]
    if ORDERS[method] == 8:
        fine = chain.run(0.005 * np.arange(2001), method=method, dt=0.005)
        assert gaps(fine.position).max() <= 4
        assert np.ptp(fine.energy) <= 5e-15 * abs(chain.energy)


@pytest.mark.parametrize("method", ORDERS)
def test_reactions_are_those_of_the_state(method: str) -> None:
    """Tension of a pendulum: m (g cos θ + l θ̇²)."""
    (x, y), (vx, vy) = coordinates("x y")
    l, m = 2.0, 3.0
    rod = vv.Lagrangian(
        m * (vx**2 + vy**2) / 2 - m * 9.81 * y,
        [x, y],
        position=[l * math.sin(1.2), -l * math.cos(1.2)],
        constraints=[(x**2 + y**2 - l**2) / (2 * l)],
        consistent="project",
    )
    out = rod.run(np.linspace(0.0, 10.0, 101), method=method, dt=0.02)
    tension = m * (9.81 * -out.position[:, 1] / l + (out.velocity**2).sum(axis=1) / l)
    assert np.abs(out.reactions[:, 0] + tension).max() <= 1e-14 * tension.max()


@pytest.mark.parametrize("method", ORDERS)
def test_momenta_of_symmetries_are_kept_to_round_off(method: str) -> None:
    """Turns about z leave the ball's constraint alone: 5000 steps."""
    out = ball(consistent="project").run(np.linspace(0.0, 500.0, 501), method=method, dt=0.1)
    (x, y, _), (px, py, _) = out.position.T, out.momentum.T
    assert np.ptp(x * py - y * px) <= 40 * EPSILON
    error = np.abs(out.energy - out.energy[0])
    assert error[250:].max() <= 1.5 * error[:250].max() + 1e-14


@pytest.mark.parametrize("method", ORDERS)
def test_the_map_is_symplectic_on_the_sphere(method: str) -> None:
    """Areas Σ dp ∧ dq of the cotangent bundle, by the chart's coordinates at both ends; rk4 keeps none."""
    start = np.array([1.1, 0.3, 0.2, 0.5])
    delta = 2e-3

    def place(y: Any) -> tuple[Any, Any]:
        theta, phi, rate, turning = y.T
        s, c = np.sin(theta), np.cos(theta)
        q = np.stack([s * np.cos(phi), s * np.sin(phi), -c], axis=1)
        v = np.stack(
            [
                c * np.cos(phi) * rate - s * np.sin(phi) * turning,
                c * np.sin(phi) * rate + s * np.cos(phi) * turning,
                s * rate,
            ],
            axis=1,
        )
        return q, v

    def canonical(q: Any, v: Any) -> Any:
        rho = np.hypot(q[:, 0], q[:, 1])
        momentum = q[:, 0] * v[:, 1] - q[:, 1] * v[:, 0]
        return np.stack([np.arccos(-q[:, 2]), np.arctan2(q[:, 1], q[:, 0]), v[:, 2] / rho, momentum], axis=1)

    offsets = np.concatenate([k * delta * np.eye(4) for k in (-2, -1, 1, 2)])
    q, v = place(start + offsets)
    many = ball().ensemble(position=q, velocity=v)
    J = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.eye(2), np.zeros((2, 2))]])

    def jacobian(y: Any) -> Any:
        y = y.reshape(4, 4, 4)
        return (y[0] - 8 * y[1] + 8 * y[2] - y[3]).T / (12 * delta)

    def defect(method: str) -> float:
        out = many.run(0.75, method=method, dt=0.25)
        before, after = jacobian(canonical(q, v)), jacobian(canonical(out.position[:, -1], out.velocity[:, -1]))
        return float(np.abs(after.T @ J @ after - before.T @ J @ before).max())

    # Rounding over twice the step of the differences; measured 1e-12.
    assert defect(method) <= 1e-11
    assert defect("rk4") > 1e-6


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", systems())
def test_back_is_where_it_came_from(name: str, method: str) -> None:
    out = systems()[name].run(2.0, method=method, dt=0.1)
    back = out.final.run(0.0, method=method, dt=0.1)
    assert np.abs(states(back)[-1] - states(out)[0]).max() <= 1e-14
    assert out.steps == back.steps == 20


@pytest.mark.parametrize("method", ORDERS)
@pytest.mark.parametrize("name", systems())
def test_steps_and_parts_of_steps_may_be_tiny(name: str, method: str) -> None:
    """Read as a rate, a constraint has large last digits; outputs may lie a unit of the time behind a node."""
    system = systems()[name]
    times = np.sort(np.concatenate([0.1 * np.arange(1, 21), np.nextafter(0.1 * np.arange(1, 21), 3.0)]))
    out = system.run(times, method=method, dt=0.1)
    assert np.abs(np.diff(out.position, axis=0)[::2]).max() <= 8 * EPSILON
    for dt in (1e-4, 1e-7):
        out = system.run(20 * dt, method=method, dt=dt)
        assert np.abs(out.position[-1] - system.run(20 * dt).position[-1]).max() <= 1e-9 * dt / 1e-4 + 20 * EPSILON


def test_a_constraint_that_moves_is_kept() -> None:
    out = swinging().run(np.linspace(0.0, 20.0, 201), method="rattle4", dt=0.1)
    pivot = np.stack([0.2 * np.cos(2 * out.t), 0.1 * np.sin(3 * out.t)], axis=1)
    rates = np.stack([-0.4 * np.sin(2 * out.t), 0.3 * np.cos(3 * out.t)], axis=1)
    # The last digit of a time of 20 is 16 ε, and the pivot moves by half of that.
    assert np.abs(((out.position - pivot) ** 2).sum(axis=1) - 1.0).max() <= (8 + 16) * EPSILON
    assert np.abs(((out.position - pivot) * (out.velocity - rates)).sum(axis=1)).max() <= (8 + 32) * EPSILON


@pytest.mark.parametrize("method", ORDERS)
def test_a_copy_has_the_bits_it_has_alone(method: str) -> None:
    heights = np.linspace(0.5, 2.0, 6)
    many = links(2, np.array([1.0, 0.5])).ensemble(parameters={"g": heights})
    times = np.linspace(0.0, 1.03, 7)
    out = many.run(times, method=method, dt=0.05, threads=1)
    for threads in (2, 3):
        assert np.array_equal(many.run(times, method=method, dt=0.05, threads=threads).position, out.position)
    for member in range(len(many)):
        alone = many[member].run(times, method=method, dt=0.05)
        assert np.array_equal(alone.position, out.position[member])
        assert np.array_equal(alone.velocity, out.velocity[member])
        assert np.array_equal(alone.reactions, out.reactions[member])


def test_what_cannot_be_run_is_refused_by_name() -> None:
    def argument(call: Any, words: str) -> str:
        with pytest.raises(vv.InvalidInput, match=words) as caught:
            call()
        return caught.value.argument

    (x, y), (vx, vy) = coordinates("x y")
    skate = vv.Lagrangian(
        (vx**2 + vy**2) / 2, [x, y], position=[0.0, 0.0], velocity=[1.0, 2.0], nonholonomic=[vy - 2 * vx]
    )
    pendulum, well = vv.systems.pendulum(), vv.systems.henon_heiles()
    for method in ORDERS:
        assert argument(lambda m=method: ball().run(1.0, method=m), f"{method} has a fixed one; pass dt") == "dt"
        words = "keeps no nonholonomic constraints; gauss16 and dop853 do"
        assert argument(lambda m=method: skate.run(1.0, method=m, dt=0.1), words) == "method"
        words = "is for constraints; without any take variational_trapezoidal"
        assert argument(lambda m=method: pendulum.run(1.0, method=m, dt=0.1), words) == "method"
        assert argument(lambda m=method: well.run(1.0, method=m, dt=0.1), "is of Lagrangians") == "method"
    assert argument(lambda: ball().run(1.0, method="rattl", dt=0.1), "did you mean 'rattle'") == "method"
    off = ball(position=[0.9, 0.0, -0.6])
    assert argument(lambda: off.run(1.0, method="rattle", dt=0.1), "constraint 0 is 0.085 at the start") == "position"


def test_a_step_that_is_too_long_ends_with_what_there_is() -> None:
    """A link that turns too far in a step has no multiplier that brings it back."""
    with pytest.raises(vv.ConvergenceError, match="take a smaller dt") as caught:
        ball(velocity=[0.0, 30.0, 0.0]).run([0.0, 0.5, 1.0], method="rattle", dt=0.5)
    assert caught.value.trajectory is not None
    assert caught.value.trajectory.status is vv.Status.STEP_FAILURE
