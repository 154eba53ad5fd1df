"""Mass matrices that are singular but for the rounding of their numbers: no motion, whatever last digits make of one.

Where constraints make up for what is missing, there is one, the same as with the coordinate put in by hand.
"""

from __future__ import annotations

from fractions import Fraction

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
