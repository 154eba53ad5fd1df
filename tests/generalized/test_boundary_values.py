"""Motions through two places from starts that are far from them, and what is said where there are none.

Bounds: a solution misses its place by 1e-13 of its size or what round-off allows, which the slope of the place by the
velocity amplifies: by 1e3 a thousandth before a conjugate point; of known velocities eight digits are written.
"""

from itertools import product

import numpy as np
import pytest

import visviva as vv


def arrives(system: vv.Lagrangian | vv.Hamiltonian, t: float, place: list[float], within: float = 1e-11) -> None:
    found = system.boundary_value(t, place)
    assert type(found) is type(system)
    assert np.array_equal(found.position, system.position)
    # By another method than the one it was found with.
    assert np.abs(found.run(t, method="taylor").position[-1] - place).max() <= within


@pytest.mark.parametrize("speed", [0.0, 1.0, -3.0, 8.0, 20.0])
@pytest.mark.parametrize(("t", "place"), [(2.0, 2.5), (5.0, 1.0)])
def test_a_pendulum_from_any_velocity(speed: float, t: float, place: float) -> None:
    arrives(vv.systems.pendulum(g=9.81, l=1.0, position=[0.0], velocity=[speed]), t, [place])


@pytest.mark.parametrize("speed", [0.0, 1.0, -3.0, 8.0])
def test_a_hamiltonian_pendulum_from_any_momentum(speed: float) -> None:
    pendulum = vv.systems.pendulum(g=9.81, l=1.0, position=[0.0], velocity=[speed]).hamiltonian()
    arrives(pendulum, 5.0, [-2.0], within=1e-10)


def test_the_present_velocity_chooses_between_solutions() -> None:
    """Of a pendulum after a while there are several; each start that is near one gives that one."""
    found = [
        vv.systems.pendulum(g=9.81, l=1.0, position=[0.0], velocity=[v]).boundary_value(5.0, [1.0]).velocity[0]
        for v in (3.2, 4.5)
    ]
    assert found == pytest.approx([3.21533786, 4.46554168], abs=1e-7)


def test_conjugate_points_are_named() -> None:
    """All motions of an oscillator are at −x₀ after half a period, whatever their velocity."""
    swing = vv.systems.oscillator(k=1.0, m=1.0, position=[1.0], velocity=[0.3])
    for system in (swing, swing.hamiltonian()):
        with pytest.raises(vv.ConvergenceError, match=r"missed by .*conjugate point"):
            system.boundary_value(np.pi, [0.5])
    assert swing.boundary_value(np.pi, [-1.0]).velocity[0] == 0.3
    nearly = swing.boundary_value(np.pi - 1e-3, [0.5])
    wanted = (0.5 - np.cos(np.pi - 1e-3)) / np.sin(np.pi - 1e-3)
    assert nearly.velocity[0] == pytest.approx(wanted, rel=2e-13, abs=0)


def test_where_there_is_none_the_nearest_miss_is_told() -> None:
    """q̇ of √(1 + p²) is below 1: nothing comes 3 far in a time of 2."""
    light = vv.Hamiltonian(lambda q, p, t: np.sqrt(1 + p[0] ** 2), ["x"], position=[0.0], momentum=[0.5])
    assert light.boundary_value(2.0, [1.2]).momentum[0] == pytest.approx(0.75, rel=1e-14, abs=0)
    with pytest.raises(vv.ConvergenceError, match="missed by"):
        light.boundary_value(2.0, [3.0])


@pytest.mark.parametrize("velocity", [[0.0, 0.0], [100.0, -40.0]])
def test_a_projectile_with_drag(velocity: list[float]) -> None:
    ball = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - 9.81 * q[1],
        ["x", "y"],
        position=[0.0, 0.0],
        velocity=velocity,
        dissipation=lambda q, v, t: 0.1 * (v[0] ** 2 + v[1] ** 2),
    )
    thrown = ball.boundary_value(2.0, [6.0, 1.0])
    # x = (v + g/k) (1 − e^(−k t))/k − g t/k, with k = 0.2.
    reach = (1 - np.exp(-0.4)) / 0.2
    fall = 9.81 / 0.2
    assert thrown.velocity == pytest.approx([6.0 / reach, (1.0 + fall * 2.0) / reach - fall], rel=1e-12, abs=0)


def lambert(velocity: np.ndarray, place: list[float], most: int = 3) -> list[float]:
    """All times of flight from (1, 0) on the orbit of this energy: Lagrange's equation (Battin 1999, § 6.6)."""
    c, r = np.hypot(place[0] - 1.0, place[1]), np.hypot(*place)
    a, s = 1.0 / (2.0 - float(velocity @ velocity)), (1.0 + r + c) / 2
    alpha, beta = 2 * np.arcsin(np.sqrt(s / (2 * a))), 2 * np.arcsin(np.sqrt((s - c) / (2 * a)))
    return [
        a**1.5 * (A - np.sin(A) - B + np.sin(B) + 2 * np.pi * turns)
        for A, B, turns in product((alpha, 2 * np.pi - alpha), (beta, -beta), range(most))
    ]


@pytest.mark.parametrize("velocity", [[0.0, 1.0], [0.3, 1.0], [0.0, 1.2], [0.0, -1.0], [0.2, 0.2]])
@pytest.mark.parametrize("t", [1.5, 16.0])
def test_lamberts_problem_with_and_without_revolutions(velocity: list[float], t: float) -> None:
    planet = vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 + 1 / np.sqrt(q[0] ** 2 + q[1] ** 2),
        ["x", "y"],
        position=[1.0, 0.0],
        velocity=velocity,
    )
    place = [-0.3, 1.2]
    found = planet.boundary_value(t, place)
    assert min(abs(time - t) for time in lambert(found.velocity, place)) <= 4e-13
    arrives(planet, t, place)


@pytest.mark.parametrize("seed", [0, 2, 3])
def test_a_double_pendulum_from_a_wild_start(seed: int) -> None:
    random = np.random.default_rng(seed)
    velocity, place = list(random.normal(size=2) * 3), list(random.normal(size=2) * 1.5)
    arrives(vv.systems.double_pendulum(position=[0.1, 0.2], velocity=velocity), 1.5, place, within=1e-9)


def test_no_time_to_arrive_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="another time than the start"):
        vv.systems.pendulum(position=[0.1]).boundary_value(0.0, [0.4])


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-8, np.pi / 2, 1.0])
@pytest.mark.parametrize("far", [1.0, 2.0])
def test_half_an_orbit_however_its_axes_are_turned(angle: float, far: float) -> None:
    """From pericenter to apocenter in half a period: a coordinate that is zero at both ends is not small on the way."""

    def turned(x: float, y: float) -> list[float]:
        return [x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)]

    # a = (1 + far)/2, v² = 2 − 1/a at r = 1.
    semi_major_axis = (1.0 + far) / 2.0
    speed = np.sqrt(2.0 - 1.0 / semi_major_axis)
    for first in (speed, 1.02 * speed):
        system = vv.Lagrangian(
            lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2.0 + 1.0 / np.sqrt(q[0] ** 2 + q[1] ** 2),
            ["x", "y"],
            position=turned(1.0, 0.0),
            velocity=turned(0.0, first),
        )
        found = system.boundary_value(np.pi * semi_major_axis**1.5, turned(-far, 0.0))
        # det ∂x/∂v is 16 and more; some roundings of the flow's derivatives.
        assert found.velocity == pytest.approx(turned(0.0, speed), rel=0, abs=1e-13)


@pytest.mark.parametrize(("t", "target"), [(np.pi, 1.0), (np.pi, -1.5), (3 * np.pi, 3.0)])
def test_what_does_not_arrive_is_no_answer(t: float, target: float) -> None:
    """After half a period all motions meet at −1: a velocity of 6e15 was given, which rounding takes to −0.27."""
    oscillator = vv.systems.oscillator(k=1.0, m=1.0, position=[1.0])
    with pytest.raises(vv.ConvergenceError, match="conjugate point"):
        oscillator.boundary_value(t, [target])
    found = oscillator.boundary_value(t + 1e-6, [target])
    # Of a motion as large as 1e6 the last digits are left.
    assert found.run(t + 1e-6).position[-1, 0] == pytest.approx(target, rel=1e-9, abs=0.0)
