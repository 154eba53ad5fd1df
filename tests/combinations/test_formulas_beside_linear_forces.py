"""Taylor series of formulas beside forces that are linear in places and velocities: one walk through all orders."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv


def trap(r, v, t, k):
    x, y, z = r
    return 0.5 * k * (z * z - 0.5 * (x * x + y * y)) + 0.05 * x * x * y


def shaken(r, v, t, k):
    x, y, z = r
    return (-k * x + 0.1 * np.cos(1.3 * t), -k * y * (1.0 + 0.2 * np.sin(t)), -0.5 * z - 0.1 * v[2])


FORMULAS = {
    "potential": lambda **more: vv.ExpressionForce(potential=trap, parameters={"k": 0.4}, **more),
    "of time and velocity": lambda **more: vv.ExpressionForce(force=shaken, parameters={"k": 0.7}, **more),
}


def linear(name: str, bodies: int) -> list[Any]:
    charge = 1.0 + 0.25 * np.arange(bodies)
    known = {
        "none": [],
        "magnetic": [vv.UniformMagneticField(B=(0.3, -0.2, 2.0), charge=charge)],
        "uniform": [vv.UniformField(g=(0.1, 0.2, -0.3))],
        "electric": [vv.UniformElectricField(E=(0.2, 0.0, 0.1), charge=charge)],
        "harmonic": [vv.Harmonic(k=1.5, center=(0.5, -1.0, 2.0))],
        "drag": [vv.LinearDrag(tau=7.0)],
        "rotating": [vv.RotatingFrame(omega=(0.1, 0.2, 0.7), center=(1.0, 0.0, -0.5))],
    }
    known["all"] = [force for forces in known.values() for force in forces]
    return known[name]


def particles(bodies: int) -> vv.Particles:
    rng = np.random.default_rng(bodies)
    return vv.Particles(1.0 + rng.random(bodies), rng.normal(size=(bodies, 3)), 0.5 * rng.normal(size=(bodies, 3)))


@pytest.mark.parametrize("formula", FORMULAS)
@pytest.mark.parametrize("beside", ["none", "magnetic", "uniform", "electric", "harmonic", "drag", "rotating", "all"])
@pytest.mark.parametrize("bodies", [1, 3, 11])
@pytest.mark.parametrize("end", [5.0, -2.0])
def test_series_agree_with_another_method(formula, beside, bodies, end):
    # Formulas first or last: their place in the scene tells nothing.
    forces = [FORMULAS[formula](), *linear(beside, bodies)][:: 1 if bodies > 1 else -1]
    scene = vv.Scene(particles(bodies), forces)
    series, other = (scene.run(end, method=method, rtol=1e-13) for method in ("taylor", "verner98"))
    # Both hold each step to 1e-13 of what they are at; errors of the motion grow by what drives and hills make of them.
    size = max(1.0, np.abs(other.position).max())
    np.testing.assert_allclose(series.position[-1], other.position[-1], rtol=0.0, atol=2e-11 * size)
    np.testing.assert_allclose(series.velocity[-1], other.velocity[-1], rtol=0.0, atol=2e-11 * size)


@pytest.mark.parametrize("formula", FORMULAS)
def test_a_formula_of_some_bodies_leaves_the_others_to_what_else_acts(formula):
    bodies = 5
    field = vv.UniformMagneticField(B=(0.0, 0.0, 2.0), charge=np.ones(bodies))
    scene = vv.Scene(particles(bodies), [FORMULAS[formula](bodies=[1, 3]), field])
    out = scene.run(3.0, method="taylor", rtol=1e-13)
    free = vv.Scene(particles(bodies), [field]).run(3.0)
    others = [0, 2, 4]
    np.testing.assert_allclose(out.position[-1, others], free.position[-1, others], rtol=0.0, atol=1e-12)
    assert np.abs(out.position[-1, [1, 3]] - free.position[-1, [1, 3]]).min() > 1e-3


def test_a_formula_that_is_no_number_where_nothing_is_leaves_no_trace():
    # 1/z is infinite in the plane in which a body that it does not act on lies.
    rising = vv.ExpressionForce(force=lambda r, v, t: (0.0, 0.0, 1.0 / r[2]), bodies=[1])
    two = vv.Particles([1.0, 1.0], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    out = vv.Scene(two, [rising, vv.UniformField(g=(0.0, 0.0, 0.0)), vv.LinearDrag(tau=5.0)]).run(2.0, method="taylor")
    expected = 5.0 * (1.0 - np.exp(-2.0 / 5.0))
    np.testing.assert_allclose(out.position[-1, 0], [1.0, expected, 0.0], rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("beside", ["none", "magnetic", "all"])
@pytest.mark.parametrize("threads", [1, 3])
def test_copies_have_the_bits_that_they_have_alone(beside, threads):
    scene = vv.Scene(particles(2), [FORMULAS["potential"](), *linear(beside, 2)])
    starts = scene.particles.position + 0.1 * np.random.default_rng(3).normal(size=(19, 2, 3))
    copies = scene.ensemble(position=starts, parameters={"ExpressionForce": {"k": np.linspace(0.2, 0.6, 19)}})
    out = copies.run(4.0, method="taylor", threads=threads)
    for member in (0, 7, 18):
        assert np.array_equal(out.position[member], copies[member].run(4.0, method="taylor").position)


def test_other_units_tell_the_same_motion():
    scene = vv.Scene(particles(2), [FORMULAS["potential"](), *linear("all", 2)])
    other = scene.rescaled(length=3.0, mass=0.7, time=1.9)
    out, again = scene.run(4.0, method="taylor"), other.run(4.0 * 1.9, method="taylor")
    # Coefficients are taken from one unit to the other, each rounded once.
    np.testing.assert_allclose(again.position[-1] / 3.0, out.position[-1], rtol=0.0, atol=1e-11)
