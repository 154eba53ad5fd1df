"""Quadratic drag along a line: rise, fall, coasting, the mixed law, against digits and against integration.

Bounds: closed forms are rounded once or twice, 4e-16 to 1e-15.
"""

import math
from typing import Any

import mpmath
import numpy as np
import pytest

import visviva as vv

Number = Any


def along(m: float, c: float, v: float, *forces: vv.forces.Force) -> vv.Scene:
    return vv.Scene(vv.Particles([m], [[0.0, 0.0, 0.0]], [[0.0, 0.0, v]]), vv.QuadraticDrag(c), *forces)


def at(scene: vv.Scene, t: float) -> tuple[float, float]:
    out = scene.run(t=t)
    assert out.plan.solution == "closed form: drag along a line"
    return out.position[-1, 0, 2], out.velocity[-1, 0, 2]


def vacuum_reference(v: float, c: float, g: float, t: float) -> tuple[Number, Number]:
    """Catalogue 4.3.1 e, upward: a rise by the tangent, a fall by the hyperbolic one; backward by continuation."""
    v, c, g, t = (mpmath.mpf(float(x)) for x in (v, c, g, t))
    vt = mpmath.sqrt(g / c)
    if v > 0:
        theta = mpmath.atan(v / vt)
        turn = vt / g * theta
        if t <= turn:
            now = theta - g * t / vt
            return vt**2 / g * mpmath.log(mpmath.cos(now) / mpmath.cos(theta)), vt * mpmath.tan(now)
        rest = t - turn
        height = -(vt**2) / g * mpmath.log(mpmath.cos(theta))
        return height - vt**2 / g * mpmath.log(mpmath.cosh(g * rest / vt)), -vt * mpmath.tanh(g * rest / vt)
    if -v < vt:
        s = mpmath.atanh(-v / vt)
        now = s + g * t / vt
        return -(vt**2) / g * mpmath.log(mpmath.cosh(now) / mpmath.cosh(s)), -vt * mpmath.tanh(now)
    s = mpmath.acoth(-v / vt)
    now = s + g * t / vt
    return -(vt**2) / g * mpmath.log(mpmath.sinh(now) / mpmath.sinh(s)), -vt * mpmath.coth(now)


@pytest.mark.parametrize("seed", range(60))
def test_rise_and_fall_to_half_a_unit(seed: int) -> None:
    random = np.random.default_rng(seed)
    mpmath.mp.dps = 60
    c, g = (float(10 ** random.uniform(-3, 2)) for _ in range(2))
    vt = math.sqrt(g / c)
    v = float(random.choice([-1, 1]) * vt * 10 ** random.uniform(-4, 2))
    t = float(vt / g * 10 ** random.uniform(-5, 3))
    place, speed = at(along(1.0, c, v, vv.UniformField([0, 0, -g])), t)
    exact, fast = vacuum_reference(v, c, g, t)
    for value, right in ((place, exact), (speed, fast)):
        # The largest term is v t or g t², or vt t; near the apex half a unit of them, 1e-25 times.
        largest = max(abs(v) * t, vt * t, vt)
        assert abs(mpmath.mpf(value) - right) <= math.ulp(value) / 2 * 1.0000001 + 1e-25 * largest * (1 + g * t / vt)


def test_backward_it_was_thrown_up_and_before_that_infinitely_fast() -> None:
    c, g = 0.25, 1.0  # vt = 2
    mpmath.mp.dps = 60
    scene = along(1.0, c, -1.0, vv.UniformField([0, 0, -g]))
    turn = -2 * math.atanh(0.5)
    for before in (0.5, 1.0, 2.5, 3.1):
        place, speed = at(scene, turn - before)
        # From rest backward: v = vt tan(g s/vt), y = y_apex + (vt²/g) ln cos.
        apex = -4 * math.log(math.cosh(0.0) / math.cosh(math.atanh(0.5)))
        assert speed == pytest.approx(2 * math.tan(before / 2), rel=1e-13, abs=0)
        assert place == pytest.approx(apex + 4 * math.log(math.cos(before / 2)), rel=1e-13, abs=0)
        # And thrown up with that speed it comes back to where it was.
        again, down = at(along(1.0, c, speed, vv.UniformField([0, 0, -g])), before - turn)
        assert again + place == pytest.approx(0.0, abs=1e-12 * (1 + abs(place)))
        assert down == pytest.approx(-1.0, rel=1e-12)
    members = scene.ensemble(velocity=np.array([[[0, 0, -1.0]]])).run(t=[-1.0, turn - math.pi - 0.01])
    assert members.status.tolist() != [0]
    fast = along(1.0, c, -3.0, vv.UniformField([0, 0, -g])).ensemble(velocity=np.array([[[0, 0, -3.0]]]))
    assert fast.run(t=-10.0).status.tolist() != [0]


@pytest.mark.parametrize("t", [0.1, 4.0, -0.3])
def test_coasting(t: float) -> None:
    """1/v grows linearly, v = v₀ e^{−c s}: G4.24; any direction."""
    m, c, v = 0.7, 0.3, np.array([1.0, -2.0, 0.5])
    out = vv.Scene(vv.Particles([m], [[5.0, 1.0, 2.0]], [v]), vv.QuadraticDrag(c)).run(t=t)
    assert out.plan.closed_form
    tau = m / (c * np.linalg.norm(v))
    np.testing.assert_allclose(out.velocity[-1, 0], v / (1 + t / tau), rtol=1e-15)
    np.testing.assert_allclose(out.position[-1, 0], [5.0, 1.0, 2.0] + v * tau * np.log1p(t / tau), rtol=1e-15)


@pytest.mark.parametrize("seed", range(25))
def test_the_mixed_law_with_a_field_against_integration(seed: int) -> None:
    """Both signs, forward, in all regimes of b² + 4cG, and nearly between them."""
    random = np.random.default_rng(seed)
    m, c, v = 0.5, float(10 ** random.uniform(-1, 1)), float(random.normal() * 3)
    tau = m / float(10 ** random.uniform(-1, 1))
    g = float(random.normal())
    if seed % 5 == 0:  # critical: b² = 4 c |g| / m of a rise
        g = -math.copysign(1 / tau**2 / (4 * c / m), v)
    scene = along(m, c, v, vv.LinearDrag(tau), vv.UniformField([0, 0, g]))
    times = np.linspace(0.2, 3.0, 5)
    exact = scene.run(t=times)
    assert exact.plan.closed_form
    stepped = scene.run(t=times, method="dop853", rtol=1e-13)
    # |v| v has no second derivative where the body stops: a step across it errs by its square of 1e-5.
    np.testing.assert_allclose(exact.position, stepped.position, rtol=0, atol=2e-9)
    np.testing.assert_allclose(exact.velocity, stepped.velocity, rtol=0, atol=2e-9)


def test_limits_of_the_mixed_law() -> None:
    """c → 0 is linear drag, and c = 0 for one of two bodies is it exactly; far away a terminal speed is held."""
    bodies = vv.Particles([1.0, 1.0], np.zeros((2, 3)), [[0, 0, 3.0], [1.0, 2.0, 3.0]])
    forces = vv.LinearDrag(0.7), vv.UniformField([0.0, 0.0, -2.0])
    plain = vv.Scene(bodies, *forces).run(t=1.3)
    with_none = vv.Scene(bodies, vv.QuadraticDrag([1e-30, 0.0]), *forces).run(t=1.3)
    assert with_none.plan.solution == "closed form: drag along a line"
    np.testing.assert_allclose(with_none.position, plain.position, rtol=4e-16)
    np.testing.assert_allclose(with_none.velocity, plain.velocity, rtol=4e-16)
    for t in (1e3, 1e12, 1e250):
        place, speed = at(along(1.0, 0.5, 0.0, vv.UniformField([0, 0, -2.0])), t)
        assert speed == -2.0
        # y = −(vt²/g) ln cosh(g t/vt) → −vt t + (vt²/g) ln 2.
        assert place == pytest.approx(-2.0 * t + 2.0 * math.log(2.0), rel=2e-16, abs=0)


def test_drag_across_a_field_is_integrated() -> None:
    assert (
        not vv.Scene(
            vv.Particles([1.0], np.zeros((1, 3)), [[1.0, 0, 0]]), vv.QuadraticDrag(1.0), vv.UniformField([0, 0, -1.0])
        )
        .plan(t=1.0)
        .closed_form
    )
