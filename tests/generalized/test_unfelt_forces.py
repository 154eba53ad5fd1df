"""Forces that are not felt where a run begins, far ahead or to come with the time; and zeros that are none.

Bounds: times and places of sections to some roundings of numbers up to 30, 1e-13; an energy over a wall a hundred
times steeper than the motion, ten times what is lost.
"""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import visviva as vv

x, y = vv.coordinate("x"), vv.coordinate("y")
vx, vy = x.diff(vv.time), y.diff(vv.time)
# What each follows of the default rtol through a wall, measured by what it is off: a low order by more.
METHODS = [("auto", 1e-9), ("gauss16", 1e-9), ("gauss8", 1e-6), ("gauss4", 1e-5)]
# A series tells of a force ahead no more than the stages of a step do.
AHEAD = [*METHODS, ("taylor", 1e-9)]


@pytest.mark.parametrize(("method", "off"), AHEAD)
@pytest.mark.parametrize(("far", "width"), [(5.3, 0.1), (10.0, 0.3), (20.0, 0.5), (40.0, 1.0)])
def test_a_barrier_far_ahead_throws_back(method: str, off: float, far: float, width: float) -> None:
    """H = p²/2 + exp(−((q − L)/w)²) at energy 1/2, from where the force is below 1e-300: one step was the whole run."""
    q, p = sp.symbols("q p")
    barrier = p**2 / 2 + sp.exp(-(((q - far) / sp.Float(width)) ** 2))
    thrown = vv.Hamiltonian(barrier, q=[q], p=[p], position=[0.0], momentum=[1.0]).run(2.0 * far, method=method)
    assert thrown.momentum[-1, 0] == pytest.approx(-1.0, abs=off)


@pytest.mark.parametrize(("method", "off"), AHEAD)
@pytest.mark.parametrize("start", [30.0, 100.0, 300.0])
def test_a_hard_core_far_ahead_throws_back(method: str, off: float, start: float) -> None:
    """Lennard-Jones's core is 1 wide, and tells little from 300 away; dop853 at rtol 1e-13 is another method."""
    system = vv.Lagrangian(vx**2 / 2 - 4 * (x**-12 - x**-6), [x], position=[start], velocity=[-1.0])
    expected = system.run(2.0 * start, method="dop853", rtol=1e-13).position[-1, 0]
    assert expected > start
    assert system.run(2.0 * start, method=method).position[-1, 0] == pytest.approx(expected, abs=off * start)


def test_a_step_of_potential_between_two_stages_is_met() -> None:
    """A wall of tanh, 0.01 wide, at which the energy 1/2 turns back: no force is left on either side."""
    system = vv.Lagrangian(vx**2 / 2 - sp.tanh((x - 5.3) * 100) - x / 1000, [x], position=[0.0], velocity=[1.0])
    out = system.run(10.0)
    np.testing.assert_allclose(out.energy[-1], out.energy[0], rtol=2e-13)
    assert out.velocity[-1, 0] < 0.0


def test_scattering_from_far_away_in_two_dimensions() -> None:
    """A Yukawa center at 100, impact parameter 0.1: the same deflection from there as from 10."""
    r = sp.sqrt(x**2 + y**2)
    potential = sp.exp(-2 * r) / r

    def leaves(far: float) -> float:
        system = vv.Lagrangian((vx**2 + vy**2) / 2 - potential, [x, y], position=[-far, 0.1], velocity=[1.0, 0.0])
        velocity = system.run(2.0 * far).velocity[-1]
        return float(np.arctan2(velocity[1], velocity[0]))

    # What the tail beyond 10 turns is below e⁻²⁰.
    assert leaves(100.0) == pytest.approx(leaves(10.0), abs=1e-9)


@pytest.mark.parametrize(("method", "off"), METHODS)
@pytest.mark.parametrize("place", [0.0, 1.0])
def test_what_rests_until_a_pulse_comes(method: str, off: float, place: float) -> None:
    """ẍ = −x + exp(−((t − 20)/w)²) from rest: w √π exp(−w²/4) sin(t − 20) after it, in one run and in ensembles."""
    width = 0.5
    pulse = sp.exp(-(((vv.time - 20) / width) ** 2))
    system = vv.Lagrangian(vx**2 / 2 - (x - place) ** 2 / 2, [x], forces={x: pulse}, position=[place], velocity=[0.0])
    size = width * np.sqrt(np.pi) * np.exp(-(width**2) / 4)
    out = system.run(40.0, method=method)
    assert out.position[-1, 0] - place == pytest.approx(size * np.sin(20.0), abs=off)
    assert out.velocity[-1, 0] == pytest.approx(size * np.cos(20.0), abs=off)
    both = system.ensemble(position=[[place], [place + 0.25]], velocity=[[0.0], [0.0]])
    for threads in (1, 3):
        assert both.run(40.0, method=method, threads=threads).position[0, -1, 0] == out.position[-1, 0]


@pytest.mark.parametrize("width", [1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("method", ["gauss16", "gauss8", "gauss4"])
def test_a_layer_where_the_run_begins(method: str, width: float) -> None:
    """ẍ = −x + tanh(t/w)/2: the force is 0 at the start, and 1/2 at every stage of a step that is long beside w."""
    system = vv.Lagrangian(
        vx**2 / 2 - x**2 / 2, [x], forces={x: sp.tanh(vv.time / width) / 2}, position=[1.0], velocity=[0.0]
    )
    t = np.linspace(0.0, 20.0 * width, 20_001)
    # What the layer leaves out of the impulse ∫ cos(20 − t)/2, by Simpson's rule; it is 0 beyond 20 w but for e⁻⁴⁰.
    left = 0.5 * (1.0 - np.tanh(t / width))
    weights = np.full(t.size, 2.0)
    weights[1::2], weights[[0, -1]] = 4.0, 1.0
    lost = (weights * left * np.sin(20.0 - t)).sum() * (t[1] - t[0]) / 3.0
    expected = np.cos(20.0) + 0.5 * (1.0 - np.cos(20.0)) - lost
    both = system.ensemble(position=[[1.0], [0.5]], velocity=[[0.0], [0.0]])
    out = system.run(20.0, method=method)
    off = {"gauss16": 1e-9, "gauss8": 1e-7, "gauss4": 1e-6}[method]
    assert out.position[-1, 0] == pytest.approx(expected, abs=off)
    assert both.run(20.0, method=method).position[0, -1, 0] == out.position[-1, 0]


def test_what_is_switched_on_meets_no_singularity() -> None:
    """1 + tanh(t − 20) is 1e-16 in steps of 1e-16 before it is anything: rounding of nothing yet."""
    system = vv.Lagrangian(vx**2 / 2, [x], forces={x: 1 + sp.tanh(vv.time - 20)}, position=[0.0], velocity=[0.0])
    out = system.run(40.0)
    # v = t + ln cosh(t − 20) − ln cosh 20.
    assert out.velocity[-1, 0] == pytest.approx(40.0, abs=1e-10)


def test_jumps_and_poles_are_no_zeros() -> None:
    """An angle passes from π to −π, 1/x and a tangent change their sign at infinity: none of these is a section."""
    oscillator = vv.Lagrangian((vx**2 - x**2) / 2, [x], position=[1.0], velocity=[0.2])
    down = oscillator.poincare(sp.atan2(vx, x), 10.0, direction=-1)
    np.testing.assert_allclose(down.t, np.arctan(0.2) + np.array([0.0, 2.0 * np.pi]), rtol=0, atol=1e-13)
    assert len(oscillator.poincare(sp.atan2(vx, x), 10.0, direction=1)) == 0
    assert len(oscillator.poincare(1 / x, 6.0, direction=0)) == 0
    at_zero = oscillator.poincare(sp.tan(2 * x), 6.0, direction=0).position[:, 0]
    np.testing.assert_allclose(np.sin(2 * at_zero), 0.0, rtol=0, atol=1e-14)
    turning = vv.systems.pendulum(position=[0.1], velocity=[8.0])
    wrapped = turning.poincare(lambda q, v, t, **_: np.arctan2(np.sin(q[0]), np.cos(q[0])), 5.0, direction=0)
    np.testing.assert_allclose(wrapped.position[:, 0] / (2.0 * np.pi), np.arange(1.0, 6.0), rtol=0, atol=5e-14)


@pytest.mark.parametrize(("middle", "width"), [(50, 0.01), (20, 0.01), (7.77, 0.01)])
def test_a_short_pulse_that_no_look_ahead_meets(middle: float, width: float) -> None:
    """It begins with velocities without digits, on which steps came to nothing: 10⁸ did not pass the pulse."""
    force = 100 * x * sp.exp(-(((vv.time - middle) / sp.Float(width)) ** 2))
    out = vv.Lagrangian(vx**2 / 2 + force, [x], position=[0.0]).run(100.0, max_steps=100_000)
    kick = 100 * np.sqrt(np.pi) * width
    assert out.velocity[-1, 0] == pytest.approx(kick, rel=1e-9, abs=0)
    assert out.position[-1, 0] == pytest.approx(kick * (100.0 - middle), rel=1e-9, abs=0)
