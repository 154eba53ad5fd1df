"""Throws against drag: against a hundred digits, and against the runs of the forces themselves."""

import mpmath
import numpy as np
import pytest

import visviva as vv


def linear(v: float, g: float, tau: float) -> list[mpmath.mpf]:
    """Catalogue 4.3.1 d, by Lambert's function with as many digits as its branch point takes."""
    with mpmath.workdps(120):
        v, g, tau = mpmath.mpf(v), mpmath.mpf(g), mpmath.mpf(tau)
        x = v / (g * tau)
        s = 1 + x
        back = s + mpmath.lambertw(-s * mpmath.exp(-s), 0).real
        apex = mpmath.log(1 + x)
        speed = g * tau - (v + g * tau) * mpmath.exp(-back)
        return [g * tau, tau * apex, g * tau**2 * (x - apex), tau * back, speed]


def quadratic(v: float, g: float, vt: float) -> list[mpmath.mpf]:
    with mpmath.workdps(120):
        v, g, vt = mpmath.mpf(v), mpmath.mpf(g), mpmath.mpf(vt)
        x = v / vt
        rise, fall = vt / g * mpmath.atan(x), vt / g * mpmath.asinh(x)
        return [vt, rise, vt**2 / (2 * g) * mpmath.log(1 + x * x), rise + fall, v / mpmath.sqrt(1 + x * x)]


def told(throw: vv.drag.Throw) -> list[float]:
    return [throw.terminal_speed, throw.apex_time, throw.apex_height, throw.return_time, throw.return_speed]


@pytest.mark.parametrize("seed", range(80))
def test_throws_to_a_few_units(seed: int) -> None:
    random = np.random.default_rng(seed)
    g = float(10 ** random.uniform(-2, 2))
    scale = float(10 ** random.uniform(-2, 2))
    x = float(10 ** random.uniform(-14, 3))
    exact, found = (
        (linear(x * g * scale, g, scale), vv.drag.throw(speed=x * g * scale, g=g, tau=scale))
        if seed % 2
        else (quadratic(x * scale, g, scale), vv.drag.throw(speed=x * scale, g=g, terminal_speed=scale))
    )
    for value, right in zip(told(found), exact, strict=True):
        # arctan errs by 1.4 units, all else is rounded once or twice.
        assert abs(value / right - 1) < 5e-16


@pytest.mark.parametrize("how", ["linear", "quadratic"])
def test_a_run_does_what_is_told(how: str) -> None:
    g, v = 9.80665, 25.0
    throw = vv.drag.throw(speed=v, g=g, **({"tau": 1.2} if how == "linear" else {"terminal_speed": 18.0}))
    force = vv.LinearDrag(1.2) if how == "linear" else vv.QuadraticDrag(2.0 * g / 18.0**2)
    body = vv.Particles([2.0], [[0, 0, 0]], [[0, 0, v]])
    out = vv.Scene(body, force, vv.UniformField([0, 0, -g])).run(t=[throw.apex_time, throw.return_time, 1e4])
    # The times are rounded: 1e-16 of them times the speed.
    np.testing.assert_allclose(out.position[:2, 0, 2], [throw.apex_height, 0.0], rtol=1e-15, atol=2e-14)
    np.testing.assert_allclose(
        out.velocity[:, 0, 2], [0.0, -throw.return_speed, -throw.terminal_speed], rtol=1e-15, atol=1e-14
    )
    assert throw.return_speed < min(v, throw.terminal_speed)
    assert throw.apex_time < throw.return_time / 2


def test_a_law_is_refused_where_it_does_not_hold() -> None:
    ball = {"density": 1.2, "radius": 0.02, "viscosity": 1.8e-5}
    assert vv.drag.quadratic(**ball, drag_coefficient=0.47, speed=30.0).coefficient > 0.0
    for speed in (0.1, 3000.0):  # R = 133 and 4e6
        with pytest.raises(vv.InvalidInput, match="Reynolds number") as caught:
            vv.drag.quadratic(**ball, drag_coefficient=0.47, speed=speed)
        assert caught.value.argument == "speed"
    with pytest.raises(vv.InvalidInput, match="Reynolds number") as caught:
        vv.drag.stokes(mass=1.0, **ball, speed=1.0)
    assert caught.value.argument == "speed"
    for how, argument in (
        ({"speed": 1.0, "g": 1.0}, "tau"),
        ({"speed": 1.0, "g": 1.0, "tau": 1.0, "terminal_speed": 1.0}, "tau"),
        ({"speed": 0.0, "g": 1.0, "tau": 1.0}, "speed"),
        ({"speed": 1.0, "g": -1.0, "tau": 1.0}, "g"),
    ):
        with pytest.raises(vv.InvalidInput) as caught:
            vv.drag.throw(**how)
        assert caught.value.argument == argument
    with pytest.raises(vv.InvalidInput) as caught:
        vv.drag.quadratic(density=1.0, radius=1.0, drag_coefficient=1.0, viscosity=1.0)
    assert caught.value.argument == "speed"
