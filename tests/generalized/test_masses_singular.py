"""Mass matrices that are singular but for the rounding of their numbers: no motion, whatever last digits make of one.

Where constraints make up for what is missing, there is one, the same as with the coordinate put in by hand.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y, z = (vv.coordinate(name) for name in "xyz")
vx, vy, vz = (q.diff(vv.time) for q in (x, y, z))

SINGULAR = {
    "thirds and sevenths": (vx / 7 + vy / 3) ** 2 / 2 - x * y,
    "tenths": (vx + sp.Float(0.3) * vy) ** 2 / 2 - x * y,
    "turning": (vx * sp.cos(x) + vy * sp.sin(x)) ** 2 / 2 - x * y,
    "three of rank two": ((vx + vy / 10 + 7 * vz / 10) ** 2 + (vx - 3 * vy / 10) ** 2) / 2 - x * y * z,
    "two bodies by three": (sp.Float(1.1) * (vx + vy) ** 2 + sp.Float(0.7) * (vx + vz) ** 2) / 2 - (y - z) ** 4,
}


@pytest.mark.parametrize("name", SINGULAR)
@pytest.mark.parametrize("method", ["auto", "gauss16", "dop853", "rk4"])
def test_no_motion_is_made_of_rounding(name: str, method: str) -> None:
    function = SINGULAR[name]
    coordinates = [q for q in (x, y, z) if function.has(q)]
    n = len(coordinates)
    system = vv.Lagrangian(function, coordinates, position=[0.1, 0.2, 0.4][:n], velocity=[0.3, 0.2, 0.1][:n])
    how = {"dt": 0.01} if method == "rk4" else {}
    with pytest.raises(vv.InvalidInput, match=r"no number at the start.*a mass matrix that is singular there"):
        system.run(1.0, method=method, **how)
    copies = system.ensemble(position=np.array([[0.1, 0.2, 0.4][:n], [0.2, 0.3, 0.1][:n]]))
    with pytest.raises(vv.InvalidInput, match=r"no number at the start.*a mass matrix that is singular there"):
        copies.run(1.0, method=method, **how)


def test_linear_equations_are_not_divided_by_rounding() -> None:
    """By the matrix exponential of each copy, too, with its own parameters."""
    a = sp.Symbol("a")
    system = vv.Lagrangian((vx / 7 + a * vy / 3) ** 2 / 2 + (a - 1) * vy**2 - x * y, [x, y], parameters={a: 2.0})
    system = system.at(position=[0.1, 0.2], velocity=[0.3, 0.2])
    assert system.run(1.0).status is vv.Status.OK
    with pytest.raises(vv.InvalidInput, match="singular"):
        system.ensemble(parameters={a: [2.0, 1.0]}).run(1.0)


def test_what_is_degenerate_but_for_rounding_has_no_transform() -> None:
    with pytest.raises(vv.InvalidInput, match="degenerate"):
        vv.Lagrangian(SINGULAR["thirds and sevenths"], [x, y]).hamiltonian()
    q1, q2, p1, p2 = sp.symbols("q1 q2 p1 p2")
    function = (p1 / 7 + p2 / 3) ** 2 / 2 + q1**2 + q2**2
    own = vv.Hamiltonian(function, q=[q1, q2], p=[p1, p2], position=[0.1, 0.2], momentum=[0.3, 0.4])
    # Its own motion is right: with q = a s along a = (1/7, 1/3) and p₁/7 + p₂/3 = s′ it is s″ = −2 |a|² s.
    a = np.array([1 / 7, 1 / 3])
    rate = np.sqrt(2 * a @ a)
    s = a @ [0.1, 0.2] * (np.cos(rate) - 1) / (a @ a) + a @ [0.3, 0.4] * np.sin(rate) / rate
    np.testing.assert_allclose(own.run(1.0).position[-1], [0.1, 0.2] + a * s, rtol=1e-12, atol=0)
    with pytest.raises(vv.InvalidInput, match="degenerate"):
        own.lagrangian()


@pytest.mark.parametrize("c", [Fraction(1), Fraction(1, 3), Fraction(7, 10), Fraction(2), Fraction(29, 10)], ids=str)
@pytest.mark.parametrize("method", ["auto", "dop853"])
def test_constraints_make_up_for_what_is_missing(c: Fraction, method: str) -> None:
    """With x + z = 0 the matrix is regular for every c > 0; whether it ran hung on the last digit of c."""
    weight = sp.Rational(c.numerator, c.denominator)
    function = weight * (vx + vy) ** 2 / 2 + (vx + 2 * vy + vz) ** 2 / 2 - x**2 - weight * y**2 / 7
    start, speed = [0.3, 0.2], [0.1, -0.2]
    by_hand = vv.Lagrangian(function.subs(z, -x).doit(), [x, y], position=start, velocity=speed).run(2.0)
    system = vv.Lagrangian(
        function, [x, y, z], constraints=[x + z], position=[*start, -start[0]], velocity=[*speed, -speed[0]]
    )
    out = system.run(2.0, method=method, max_steps=10_000)
    # Both keep to 1e-10 a step; the matrices have a condition of some tens.
    np.testing.assert_allclose(out.position[-1, :2], by_hand.position[-1], rtol=0, atol=1e-9)


@pytest.mark.parametrize("angle", [1e-3, 1e-6])
def test_what_is_nearly_singular_runs(angle: float) -> None:
    """A top near the vertical, where Euler's angles lose digits but not all of them, and one where they have."""
    theta, phi, psi = (vv.coordinate(name) for name in ("theta", "phi", "psi"))
    v = [q.diff(vv.time) for q in (theta, phi, psi)]
    spin = v[2] + v[1] * sp.cos(theta)
    function = (v[0] ** 2 + v[1] ** 2 * sp.sin(theta) ** 2) / 2 + spin**2 - 3 * sp.cos(theta)
    top = vv.Lagrangian(function, [theta, phi, psi], velocity=[0.0, 0.7, 3.0], position=[angle, 0.0, 0.0])
    assert top.run(1.0).status is vv.Status.OK
    with pytest.raises(vv.InvalidInput, match="singular"):
        top.at(position=[1e-9, 0.0, 0.0]).run(1.0)


def test_masses_of_any_ratio_are_not_taken_for_rounding() -> None:
    """A diagonal matrix, and two links of which the second hardly weighs anything."""
    for ratio in (1e-30, 1e-12, 1e12, 1e30):
        system = vv.Lagrangian(vx**2 / 2 + ratio * vy**2 / 2 - x**2 / 2 - ratio * y**2 / 2, [x, y])
        out = system.at(position=[1.0, 1.0], velocity=[0.0, 0.0]).run(1.0)
        np.testing.assert_allclose(out.position[-1], np.cos(1.0), rtol=1e-12)
        links = vv.systems.double_pendulum(m2=ratio, position=[1.0, 0.5], velocity=[0.0, 0.0])
        assert links.run(0.1).status is vv.Status.OK


def _rolling() -> vv.Lagrangian:
    """A hoop that rolls and leans over until it lies flat and beyond, where two of Euler's angles turn about one axis.

    Its masses are singular there, and with its constraints the motion is not.
    """
    cx, cy, lean, turn, spin = (vv.coordinate(name) for name in ("cx", "cy", "lean", "turn", "spin"))
    dx, dy, dlean, dturn, dspin = (q.diff(vv.time) for q in (cx, cy, lean, turn, spin))
    center = (cx - sp.cos(lean) * sp.sin(turn), cy + sp.cos(lean) * sp.cos(turn), sp.sin(lean))
    moving = sum(each.diff(vv.time) ** 2 for each in center) / 2
    turning = (dlean**2 + (dturn * sp.sin(lean)) ** 2) / 8 + (dspin + dturn * sp.cos(lean)) ** 2 / 4
    return vv.Lagrangian(
        moving + turning - sp.Float(9.81) * center[2],
        [cx, cy, lean, turn, spin],
        position=[0.0, 0.0, 1.3, 0.2, 0.0],
        velocity=[2.5 * np.cos(0.2), 2.5 * np.sin(0.2), 0.1, 0.4, 2.5],
        nonholonomic=[dx - dspin * sp.cos(turn), dy - dspin * sp.sin(turn)],
    )


def test_singular_masses_that_constraints_make_up_for_are_passed_through() -> None:
    """Of 100 starts 16 ended with "the constraints depend on each other", and by verner98 all, after 4e5 steps."""
    starts = np.tile([0.0, 0.0, 0.0, 0.2, 0.0], (4, 1))
    starts[:, 2] = [1.1035353535, 1.1459595960, 1.1530303030, 1.3]
    copies = _rolling().ensemble(position=starts)
    times = np.linspace(0.0, 10.0, 201)
    runs = [
        copies.run(times, method="auto"),
        copies.run(times, method="dop853"),
        copies.run(times, method="verner98"),
        copies.run(times, method="gauss16", dt=0.02),
    ]
    for out in runs:
        assert not out.status.any()
        # Some flat places are between two times of each copy.
        assert (np.diff(np.sign(np.sin(out["lean"])), axis=1) != 0).any(axis=1).all()
        assert out.steps.max() < 1000
        # Constraints that do no work: a hundred steps of the tolerance, 1e-12.
        np.testing.assert_allclose(out.energy, out.energy[:, :1] + np.zeros(201), rtol=1e-11, atol=0.0)
        # Where the lying hoop turns fast errors grow by a thousand; before, what two methods had in common was 5e-9.
        np.testing.assert_allclose(out.position, runs[0].position, rtol=0.0, atol=2e-9)


@pytest.mark.parametrize("light", [1e-6, 1e-9, 1e-12, 1e-16, 1e-18, 1e-30, 1e-300])
@pytest.mark.parametrize("method", ["auto", "verner98", "dop853", "rk4", "gauss4"])
def test_two_constraints_of_one_light_coordinate(light: float, method: str) -> None:
    """A pulley of hardly any mass: from 1e-12 on it ended, or by rk4 was off its constraints by 0.6 with status OK."""
    m, n, k, g, end = 2.0, 1.0, 1.5, 9.81, 1.0
    system = vv.Lagrangian(
        lambda q, v, t: (
            (m * v[0] ** 2 + n * v[1] ** 2 + k * v[2] ** 2 + light * v[3] ** 2) / 2
            - g * (m * q[0] + n * q[1] + k * q[2] + light * q[3])
        ),
        ["a", "b", "c", "p"],
        position=[0.0, 0.0, 0.0, 0.0],
        constraints=[lambda q, v, t: q[0] + q[3], lambda q, v, t: q[1] + q[2] - 2.0 * q[3]],
    )
    how = {"dt": 0.002} if method in ("rk4", "gauss4") else {}
    out = system.run(end, method=method, **how)
    assert out.status == vv.Status.OK
    # With the constraints put in by hand, p = -a and c = -2 a - b.
    masses = np.array([[m + light + 4.0 * k, 2.0 * k], [2.0 * k, n + k]])
    forces = -g * np.array([m - 2.0 * k - light, n - k])
    a, b = 0.5 * end**2 * np.linalg.solve(masses, forces)
    # A constant acceleration, which all methods have, to roundings of a few hundred steps.
    np.testing.assert_allclose(out.position[-1], [a, b, -2.0 * a - b, -a], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("method", ["auto", "dop853", "verner98", "taylor"])
def test_a_coordinate_of_no_mass_is_held_by_a_constraint(method: Any) -> None:
    x, y, vx, vy = sp.symbols("x y vx vy", real=True)
    system = vv.Lagrangian(
        vx**2 / 2 - x**2 / 2 - y,
        [x, y],
        velocities=[vx, vy],
        constraints=[y - x**2],
        position=[1.0, 1.0],
        velocity=[0.5, 1.0],
    )
    out = system.run([1.0, 7.0], method=method, rtol=1e-12)
    # With y = x² it is an oscillator of ω² = 3; the constraint pulls y with the force against its weight, λ = 1.
    omega = np.sqrt(3.0)
    exact = np.cos(omega * out.t) + 0.5 / omega * np.sin(omega * out.t)
    np.testing.assert_allclose(out.position[:, 0], exact, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(out.position[:, 1], out.position[:, 0] ** 2, rtol=0.0, atol=4e-16)
    np.testing.assert_allclose(out.reactions[:, 0], 1.0, rtol=0.0, atol=1e-12)


def test_a_coordinate_of_no_mass_that_nothing_holds_is_refused() -> None:
    x, y, vx, vy = sp.symbols("x y vx vy", real=True)
    with pytest.raises(vv.InvalidInput, match="coordinate 'y' vanishes identically"):
        vv.Lagrangian(vx**2 / 2 - y * x, [x, y], velocities=[vx, vy], constraints=[x - 1])
