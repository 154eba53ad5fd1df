"""A motion does not depend on the coordinates it is written in.

Both runs are good to some ten roundings of the largest number, times the conditioning of the motion: 1e-12 for a time
of ten, of motions that are not chaotic.
"""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from by_symbols import coordinates

import visviva as vv

T = np.linspace(0.0, 10.0, 21)


def same(a: Any, b: Any, within: float = 1e-12) -> None:
    a, b = np.asarray(a), np.asarray(b)
    assert a.shape == b.shape
    assert np.abs(a - b).max() <= within * np.abs(b).max()


def test_a_pendulum_by_four_coordinates() -> None:
    angle = 2.0
    theta = vv.systems.pendulum(position=[angle]).run(T)["theta"]
    place = np.stack([np.sin(theta), -np.cos(theta)], axis=1)
    # From the horizontal.
    (alpha,), (rate,) = coordinates("alpha")
    other = vv.Lagrangian(rate**2 / 2 - 9.81 * sp.sin(alpha), [alpha], position=[angle - np.pi / 2])
    alpha_t = other.run(T).position[:, 0]
    same(np.stack([np.cos(alpha_t), np.sin(alpha_t)], axis=1), place)
    # u = tan(θ/2), in which nothing is a function of an angle.
    stereographic = vv.Lagrangian(
        lambda q, v, _: 2 * v[0] ** 2 / (1 + q[0] ** 2) ** 2 + 9.81 * (1 - q[0] ** 2) / (1 + q[0] ** 2),
        ["u"],
        position=[np.tan(angle / 2)],
    )
    u = stereographic.run(T).position[:, 0]
    same(np.stack([2 * u, u**2 - 1], axis=1) / (1 + u**2)[:, None], place)
    # Places, and the rod a constraint.
    x, y, vx, vy = sp.symbols("x y vx vy")
    rod = vv.Lagrangian(
        (vx**2 + vy**2) / 2 - sp.Symbol("g") * y,
        [x, y],
        velocities=[vx, vy],
        parameters={"g": 9.81},
        position=[np.sin(angle), -np.cos(angle)],
        constraints=[(x**2 + y**2 - 1) / 2],
        consistent="project",
    )
    same(rod.run(T).position, place)
    # H(θ, p) of the same.
    hamiltonian = vv.Hamiltonian(lambda q, p, _: p[0] ** 2 / 2 - 9.81 * np.cos(q[0]), ["theta"], position=[angle])
    same(hamiltonian.run(T).position[:, 0], theta)


def test_a_double_pendulum_by_angles_of_three_kinds_and_by_places() -> None:
    absolute = vv.systems.double_pendulum(position=[0.9, 0.4]).run(T)
    a, b = absolute.position.T
    place = np.stack([np.sin(a), -np.cos(a), np.sin(a) + np.sin(b), -np.cos(a) - np.cos(b)], axis=1)
    (q, r), _ = coordinates("q r")
    t = sp.Symbol("t")
    x1, y1 = sp.sin(q), -sp.cos(q)

    def kinetic(*numbers: Any) -> Any:
        return sum(number.diff(t) ** 2 for number in numbers) / 2

    # The second angle from the first rod; then their sum and difference.
    x2, y2 = x1 + sp.sin(q + r), y1 - sp.cos(q + r)
    L = kinetic(x1, y1, x2, y2) - 9.81 * (y1 + y2)
    relative = vv.Lagrangian(L, [q, r], position=[0.9, -0.5]).run(T).position
    same(relative @ [[1, 1], [0, 1]], absolute.position)
    turned = L.subs({q: q + r, r: -2 * r}, simultaneous=True).doit()
    mixed = vv.Lagrangian(turned, [q, r], position=[0.65, 0.25]).run(T).position
    same(mixed @ [[1, 1], [1, -1]], absolute.position)
    names = [*coordinates("x1 y1 x2 y2")[0]]
    start = place[0]
    cartesian = vv.Lagrangian(
        kinetic(*names) - 9.81 * (names[1] + names[3]),
        names,
        position=start,
        constraints=[
            names[0] ** 2 + names[1] ** 2 - 1,
            (names[2] - names[0]) ** 2 + (names[3] - names[1]) ** 2 - 1,
        ],
        consistent="project",
    )
    assert cartesian.degrees_of_freedom == 2
    same(cartesian.run(T).position, place)


@pytest.mark.parametrize("pole", ["z", "x"])
def test_a_spherical_pendulum_about_another_pole_and_by_places(pole: str) -> None:
    start, rate = np.array([1.0, 0.3]), np.array([0.2, 1.5])
    theta, phi = vv.systems.spherical_pendulum(position=start, velocity=rate).run(T).position.T

    def to_place(theta: Any, phi: Any) -> Any:
        return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), -np.cos(theta)], axis=-1)

    place = to_place(theta, phi)
    step = 1e-6
    ahead, back = to_place(*(start + step * rate)), to_place(*(start - step * rate))
    velocity = (ahead - back) / (2 * step)
    # The derivative by hand, as differences have nine digits.
    s, c = np.sin(start), np.cos(start)
    exact = [
        c[0] * c[1] * rate[0] - s[0] * s[1] * rate[1],
        c[0] * s[1] * rate[0] + s[0] * c[1] * rate[1],
        s[0] * rate[0],
    ]
    # Differences with steps of 1e-6: rounding of 1e-16 over 2e-6; measured 5e-11.
    assert np.abs(velocity - exact).max() < 3e-10
    if pole == "z":
        ball = vv.Lagrangian(
            lambda q, v, _: (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 - 9.81 * q[2],
            ["x", "y", "z"],
            position=place[0],
            velocity=exact,
            constraints=[lambda q, _v, _t: np.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2) - 1.0],
            consistent="project",
        )
        same(ball.run(T).position, place)
        return
    # Angles a, b with x = cos a, y = sin a cos b, z = sin a sin b: both are missing from no term.
    (a, b), (a_rate, b_rate) = coordinates("a b")
    L = (a_rate**2 + (sp.sin(a) * b_rate) ** 2) / 2 - 9.81 * sp.sin(a) * sp.sin(b)
    angle = np.arccos(place[0, 0])
    turn = np.arctan2(place[0, 2], place[0, 1])
    a_start = -exact[0] / np.sin(angle)
    b_start = (place[0, 1] * exact[2] - place[0, 2] * exact[1]) / (place[0, 1] ** 2 + place[0, 2] ** 2)
    other = vv.Lagrangian(L, [a, b], position=[angle, turn], velocity=[a_start, b_start]).run(T)
    x, y = other.position.T
    same(np.stack([np.cos(x), np.sin(x) * np.cos(y), np.sin(x) * np.sin(y)], axis=1), place)
    assert other.system.cyclic == []


def test_kepler_in_the_plane_by_places_angles_and_parabolas() -> None:
    polar = vv.systems.central_force().run(T).position
    place = polar[:, :1] * np.stack([np.cos(polar[:, 1]), np.sin(polar[:, 1])], axis=1)
    by_places = vv.Lagrangian(
        lambda q, v, _: (v[0] ** 2 + v[1] ** 2) / 2 + 1 / np.sqrt(q[0] ** 2 + q[1] ** 2),
        ["x", "y"],
        position=[1.0, 0.0],
        velocity=[0.0, 1.2],
    )
    same(by_places.run(T).position, place, 2e-12)
    # Levi-Civita's x + iy = (u + iw)²: r = u² + w², and ṙ² = 4 r (u̇² + ẇ²).
    parabolic = vv.Lagrangian(
        lambda q, v, _: 2 * (q[0] ** 2 + q[1] ** 2) * (v[0] ** 2 + v[1] ** 2) + 1 / (q[0] ** 2 + q[1] ** 2),
        ["u", "w"],
        position=[1.0, 0.0],
        velocity=[0.0, 0.6],
    )
    u, w = parabolic.run(T).position.T
    same(np.stack([u**2 - w**2, 2 * u * w], axis=1), place, 2e-12)
    # The scene of the same: another room of the house, another way.
    bodies = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1.2, 0.0]])
    scene = vv.Scene(bodies, vv.CentralField(vv.potentials.Coulomb(-1.0)))
    same(scene.run(t=T).position[:, 0, :2], place, 2e-12)


def test_a_charge_by_two_gauges() -> None:
    """A changes by a gradient, L by a derivative with respect to time: momenta change, and no motion."""
    symmetric = vv.systems.charged_particle(E=[0.2, 0.0, 0.1], velocity=[1.0, 0.5, 0.0]).run(T)
    landau = vv.Lagrangian(
        lambda q, v, _: (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) / 2 + 0.2 * q[0] + 0.1 * q[2] + q[0] * v[1],
        ["x", "y", "z"],
        position=[0.0, 0.0, 0.0],
        velocity=[1.0, 0.5, 0.0],
    )
    out = landau.run(T)
    same(out.position, symmetric.position)
    assert landau.cyclic == ["y"]
    assert np.ptp(out.momentum[:, 1]) < 1e-14
    assert np.ptp(symmetric.momentum[:, 1]) > 0.1


def test_any_chart_of_a_random_lagrangian() -> None:
    """q = x + ε sin(B x): the same motion through a map that nothing knows of."""
    rng = np.random.default_rng(3)
    B = rng.normal(size=(3, 3)).round(3)
    (x, y, z), _ = coordinates("x y z")
    t = sp.Symbol("t")

    def lagrangian(q: Any) -> Any:
        speed = sum((number.diff(t) ** 2 for number in q), sp.Integer(0)) / 2
        return speed + q[0] * q[1].diff(t) / 3 - (q[0] ** 2 + 2 * q[1] ** 2 + 3 * q[2] ** 2) / 2 - q[0] * q[1] * q[2]

    plain = sp.Matrix([x, y, z])
    mapped = plain + (B * plain).applyfunc(sp.sin) / 8

    def at(numbers: Any) -> Any:
        numbers = np.asarray(numbers)
        return numbers + np.sin(numbers @ B.T) / 8

    start, rate = np.array([0.3, -0.2, 0.4]), np.array([0.1, 0.2, -0.3])
    jacobian = np.eye(3) + np.cos(B @ start)[:, None] * B / 8
    straight = vv.Lagrangian(lagrangian(plain), [x, y, z], position=at(start), velocity=jacobian @ rate).run(T)
    curved = vv.Lagrangian(lagrangian(mapped), [x, y, z], position=start, velocity=rate).run(T)
    same(at(curved.position), straight.position)
    same(curved.energy, straight.energy)
