"""Smooth walls, bumps and pulses far narrower than a step, of which nothing is left at the places where steps look.

Widths are 1e-2, 1e-3 and 1e-4 of the way. What is expected is a quadrature of the energy, or closed. Bounds: in one
passage a method errs by some hundred of its tolerances in a number of size 1 or, of low order, by what it follows of a
wall (as in `test_unfelt_forces`); without a look between nodes all of it is missed, and every one of these is off by 1.
"""

from __future__ import annotations

import warnings

import mpmath
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
vx, vy = x.diff(vv.time), y.diff(vv.time)
WIDTHS = [1e-2, 1e-3, 1e-4]
# Of numbers up to 1, after one narrow feature. gauss8 and gauss4 choose their steps by an estimate that goes with a
# lower power of them than their errors.
OFF = {
    "auto": 1e-10,
    "gauss16": 1e-10,
    "gauss8": 1e-6,
    "gauss4": 1e-5,
    "taylor": 1e-9,
    "dop853": 1e-9,
    "verner98": 1e-9,
    "tsitouras54": 1e-8,
}
METHODS = list(OFF)
HEIGHT = 50.0


def falls_on_a_wall(width: float) -> sp.Expr:
    """L of a fall with g = 1 onto a wall of tanh at 0."""
    return vx**2 / 2 - x - HEIGHT * (1 - sp.tanh(x / sp.Float(width))) / 2


def period_on_a_wall(width: float) -> float:
    """2 ∫ dq/v between the wall and the height 1.

    From either end it is taken in the root of the way, as which v goes, and near the wall in parts of its width.
    """
    with mpmath.workdps(30):
        w, height = mpmath.mpf(width), mpmath.mpf(HEIGHT)

        def less(q: mpmath.mpf, further: mpmath.mpf) -> mpmath.mpf:
            """By how much the wall is lower there."""
            e = mpmath.exp(2 * q / w)
            return height * e * mpmath.expm1(2 * further / w) / ((e + 1) * (e * mpmath.exp(2 * further / w) + 1))

        foot = mpmath.findroot(lambda q: 1 - q - less(q, 1 - q), (w, 6 * w), solver="anderson", tol=1e-50)
        middle = (1 - foot) / 2
        parts = [mpmath.sqrt(2**k * w) for k in range(12) if 2**k * w < middle]
        from_wall = [0, *parts, mpmath.sqrt(middle)]
        low = mpmath.quad(lambda r: 2 * r / mpmath.sqrt(2 * (less(foot, r * r) - r * r)), from_wall)
        high = mpmath.quad(lambda r: 2 * r / mpmath.sqrt(2 * (r * r + less(1, -r * r))), [0, mpmath.sqrt(middle)])
        return float(2 * (low + high))


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("method", METHODS)
def test_a_ball_keeps_bouncing_on_a_steep_wall(method: str, width: float) -> None:
    """Ten bounces: the energy is that of the start, and after ten periods it is at rest where it began."""
    system = vv.Lagrangian(falls_on_a_wall(width), [x], position=[1.0], velocity=[0.0])
    period = period_on_a_wall(width)
    out = system.run(10.0 * period, method=method)
    # Each bounce adds its own error, of which the velocity 1.4 at the wall makes twice as much of the energy.
    np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=0, atol=20.0 * OFF[method])
    # g times what ten periods are off: an energy that is off by ε changes each by about as much.
    np.testing.assert_allclose(out.velocity[-1, 0], 0.0, rtol=0, atol=200.0 * OFF[method])
    assert out.position.min() > 0.0


def delay(width: float, height: float) -> float:
    """∫ (1/v − 1) dq over height · exp(−(q/w)²) at the energy 1/2."""
    s = np.linspace(-12.0, 12.0, 4001)
    slower = 1.0 / np.sqrt(1.0 - 2.0 * height * np.exp(-(s**2))) - 1.0
    # The trapezoidal rule is exact to rounding for what is smooth and vanishes at both ends.
    return float(width * slower.sum() * (s[1] - s[0]))


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("height", [0.3, -2.0])
def test_a_bump_and_a_hollow_delay_what_passes(method: str, width: float, height: float) -> None:
    bump = height * sp.exp(-((x / sp.Float(width)) ** 2))
    system = vv.Lagrangian(vx**2 / 2 - bump, [x], position=[-5.0], velocity=[1.0])
    out = system.run(10.0, method=method)
    # Passed with half the velocity, a place is off twice.
    assert 5.0 - out.position[-1, 0] == pytest.approx(delay(width, height), rel=0, abs=2.0 * OFF[method])
    assert out.velocity[-1, 0] == pytest.approx(1.0, rel=0, abs=2.0 * OFF[method])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", ["gaussian", "sech", "logistic", "logistic turned round"])
def test_what_is_higher_than_the_energy_throws_back(method: str, shape: str) -> None:
    """Heights of 1, a 3000th wide, at the energy 1/2: a Gaussian, 1/cosh² (of 300 yet a number), logistic steps."""
    s = x / sp.Rational(1, 3000)
    potential = {
        "gaussian": sp.exp(-(s**2)),
        "sech": 1 / sp.cosh(s) ** 2,
        "logistic": 1 / (1 + sp.exp(-s)),
        "logistic turned round": sp.exp(s) / (1 + sp.exp(s)),
    }[shape]
    out = vv.Lagrangian(vx**2 / 2 - potential, [x], position=[-0.1], velocity=[1.0]).run(0.2, method=method)
    assert out.velocity[-1, 0] == pytest.approx(-1.0, rel=0, abs=4.0 * OFF[method])
    assert out.position.max() < 0.0


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rests", [True, False])
def test_a_pulse_gives_its_impulse(method: str, width: float, rests: bool) -> None:
    """exp(−((t − 4.123)/w)²) gives √π w to what rests, and to what moves."""
    pulse = sp.exp(-(((vv.time - sp.Float(4.123)) / sp.Float(width)) ** 2))
    begin = 0.0 if rests else 0.3
    system = vv.Lagrangian(vx**2 / 2, [x], forces={x: pulse}, position=[0.0], velocity=[begin])
    out = system.run(10.0, method=method)
    impulse = np.sqrt(np.pi) * width
    assert out.velocity[-1, 0] - begin == pytest.approx(impulse, rel=10.0 * OFF[method], abs=OFF[method])


@pytest.mark.parametrize("method", METHODS)
def test_a_layer_of_a_hamiltonian_bends_rays(method: str) -> None:
    """H = p²/2 + tanh(x/w)/5: refraction in two dimensions, with p_y conserved."""
    q1, q2, p1, p2 = sp.symbols("q1 q2 p1 p2")
    hamiltonian = (p1**2 + p2**2) / 2 + sp.tanh(q1 * 2000) / 5
    system = vv.Hamiltonian(hamiltonian, q=[q1, q2], p=[p1, p2], position=[-3.0, 0.0], momentum=[1.0, 0.5])
    out = system.run(8.0, method=method)
    # The kinetic energy falls from 5/8 by 2/5, all in p₁.
    expected = [np.sqrt(1.0 - 0.8), 0.5]
    np.testing.assert_allclose(out.momentum[-1], expected, rtol=0, atol=10.0 * OFF[method])


def test_a_thin_ring_in_the_plane_is_met_on_both_sides() -> None:
    """A ring of radius 1, 1e-3 wide, on which what comes from the middle is thrown back again and again."""
    ring = sp.exp(-(((sp.sqrt(x**2 + y**2) - 1) / sp.Float(1e-3)) ** 2))
    system = vv.Lagrangian((vx**2 + vy**2) / 2 - ring, [x, y], position=[0.0, 0.3], velocity=[1.0, 0.0])
    out = system.run(30.0)
    radius = np.hypot(out["x"], out["y"])
    assert radius.max() < 1.0
    angular = out["x"] * out.velocity[:, 1] - out["y"] * out.velocity[:, 0]
    # Both conserved: ten tolerances a bounce, of about fifteen bounces.
    np.testing.assert_allclose(angular, -0.3, rtol=0, atol=1e-10)
    np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=0, atol=1e-10)


def test_a_wall_where_the_motion_turns_is_felt() -> None:
    """A throw that turns back a few widths short of the wall, or in it: at the top the argument turns, too."""
    width = 1e-3
    for short in (20.0, 6.0, 2.0, 0.0):
        wall = HEIGHT * (1 + sp.tanh((x - 1) / sp.Float(width))) / 2
        speed = np.sqrt(2.0 * (1.0 - short * width))
        system = vv.Lagrangian(vx**2 / 2 - x - wall, [x], position=[0.0], velocity=[speed])
        fine = system.run(4.0, max_step=2e-4, method="dop853", rtol=1e-13)
        for method in ("auto", "taylor", "dop853", "verner98"):
            out = system.run(4.0, method=method)
            # What they are off where they turn, within the wall or beside it, in time and place.
            assert out.position[-1, 0] == pytest.approx(fine.position[-1, 0], rel=0, abs=20.0 * OFF[method])


@pytest.mark.parametrize("method", ["auto", "gauss8", "gauss4", "taylor", "dop853", "verner98"])
def test_copies_have_the_bits_that_they_have_alone(method: str) -> None:
    """Eleven copies that meet the wall at other times, and one that never does, on one thread and on three."""
    system = vv.Lagrangian(falls_on_a_wall(1e-3), [x], position=[1.0], velocity=[0.0])
    places, times = np.append(np.linspace(0.3, 2.0, 11), 90.0), np.linspace(0.0, 9.0, 10)
    for threads in (1, 3):
        both = system.ensemble(position=places[:, None]).run(times, method=method, threads=threads)
        for index, place in enumerate(places):
            alone = vv.Lagrangian(falls_on_a_wall(1e-3), [x], position=[place], velocity=[0.0]).run(
                times, method=method
            )
            np.testing.assert_array_equal(both.position[index], alone.position)
            np.testing.assert_array_equal(both.velocity[index], alone.velocity)


@pytest.mark.parametrize("method", ["auto", "taylor", "dop853"])
def test_output_times_change_nothing(method: str) -> None:
    system = vv.Lagrangian(falls_on_a_wall(1e-4), [x], position=[1.0], velocity=[0.0])
    few, many = system.run([0.0, 5.0], method=method), system.run(np.linspace(0.0, 5.0, 101), method=method)
    np.testing.assert_array_equal(few.position[-1], many.position[-1])


@pytest.mark.parametrize("method", ["leapfrog", "yoshida8", "rk4", "gauss16", "gauss4"])
def test_equal_steps_over_a_wall_end_by_name(method: str) -> None:
    system = vv.Lagrangian(falls_on_a_wall(1e-4), [x], position=[1.0], velocity=[0.0])
    with pytest.raises(vv.ConvergenceError, match=r"narrower than the step.*shorter dt"):
        system.run([0.0, 3.0], method=method, dt=0.03)
    copies = system.ensemble(position=[[1.0], [1.1], [90.0]]).run([0.0, 3.0], method=method, dt=0.03)
    # The last is still falling.
    np.testing.assert_array_equal(copies.status == vv.Status.OK, [False, False, True])


def test_equal_steps_that_resolve_what_they_meet_go_on() -> None:
    """Ten steps to a width: nothing is unseen, and a bump too low to matter may stay so."""
    system = vv.Lagrangian(falls_on_a_wall(1e-1), [x], position=[1.0], velocity=[0.0])
    out = system.run([0.0, 10.0], method="leapfrog", dt=1e-3)
    # Of order 2, in steps of a hundredth of the wall.
    np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=0, atol=1e-3)
    low = sp.Float(1e-9) * sp.exp(-((x / sp.Float(1e-3)) ** 2))
    out = vv.Lagrangian(vx**2 / 2 - low, [x], position=[-1.0], velocity=[1.0]).run(
        [0.0, 2.0], method="leapfrog", dt=0.03
    )
    assert out.position[-1, 0] == pytest.approx(1.0, rel=0, abs=1e-8)


def test_what_does_not_matter_costs_no_steps() -> None:
    """A bump of 1e-16 of the energy, and one passed at thirty widths: the steps are those of a free way."""
    free = vv.Lagrangian((vx**2 + vy**2) / 2 - x / 100, [x, y], position=[-1.0, 0.3], velocity=[1.0, 0.0])
    low = sp.Float(1e-17) * sp.exp(-((x / sp.Float(1e-3)) ** 2))
    aside = sp.exp(-((x**2 + y**2) / sp.Float(1e-2) ** 2))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        expected = len(free.run(2.0).t)
        for bump in (low, aside):
            lagrangian = (vx**2 + vy**2) / 2 - x / 100 - bump
            system = vv.Lagrangian(lagrangian, [x, y], position=[-1.0, 0.3], velocity=[1.0, 0.0])
            assert len(system.run(2.0).t) == expected


@pytest.mark.parametrize("method", METHODS)
def test_a_weak_drive_many_times_as_fast_as_a_step_gives_no_alias(method: str) -> None:
    """ε cos(ωt) with ε/ω = 1e-9: stages see of it a noise of ε, which in steps of 100 turns added up to 3e-8."""
    weak, fast = 1e-5, 1e4
    drive = sp.Float(weak) * sp.cos(sp.Float(fast) * vv.time)
    out = vv.Lagrangian(vx**2 / 2, [x], forces={x: drive}, position=[0.0], velocity=[1.0]).run(10.0, method=method)
    expected = 1.0 + weak / fast * np.sin(10.0 * fast)
    assert out.velocity[-1, 0] == pytest.approx(expected, rel=0, abs=OFF[method])
