"""Heavy tops at any time: Taylor series in 40 digits, invariants, limits, poles, and what is refused.

Bounds: EPSILON times the angle that was turned, which is given to so much.
"""

import pickle

import numpy as np
import pytest
from high_order import angle_between
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from top_reference import taylor

import visviva as vv

HeavyTop = vv.rigid.HeavyTop
SIMO_WONG = HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)
UNIT = HeavyTop(A=1.0, C=1.0, mass=1.0, g=1.0, R=1.0)
BRUELS = HeavyTop(A=15.234375, C=0.46875, mass=15.0, g=9.81, R=1.0)
CONICAL = np.sqrt(-4.0 / np.cos(2.5))
TIMES = (-0.8, 0.0, 0.1, 0.9, 2.0)


def solved(top, angles, rates, times):
    theta, phi, psi = angles
    theta_dot, phi_dot, psi_dot = rates
    return top.solve(times, theta=theta, phi=phi, psi=psi, theta_dot=theta_dot, phi_dot=phi_dot, psi_dot=psi_dot)


@pytest.mark.parametrize(
    ("top", "angles", "rates"),
    [
        pytest.param(SIMO_WONG, (0.3, 0.0, 0.0), (0.0, 0.0, 50.0), id="cusp"),
        pytest.param(BRUELS, (np.pi / 2, 0.0, 0.0), (0.0, -4.61538, 150.0), id="by 7e-7 of straight down"),
        pytest.param(SIMO_WONG, (1.0, 0.3, -0.2), (0.4, 0.3, 2.0), id="wave"),
        pytest.param(SIMO_WONG, (1.0, 0.3, -0.2), (0.4, -0.3, -12.0), id="spin backwards"),
        pytest.param(SIMO_WONG, (0.7, 0.0, 0.0), (0.0, 5.6, 45.0), id="loop"),
        pytest.param(SIMO_WONG, (1.0, 0.2, 0.0), (0.0, 0.0, 0.0), id="pendulum"),
        pytest.param(SIMO_WONG, (1.0, 0.2, 0.1), (5.0, 0.0, 0.0), id="pendulum over the top"),
        pytest.param(SIMO_WONG, (2.0, 0.2, 0.1), (0.3, 1.0, -np.cos(2.0)), id="spherical pendulum"),
        pytest.param(SIMO_WONG, (2.5, 0.0, 0.0), (0.0, CONICAL, -np.cos(2.5) * CONICAL), id="conical pendulum"),
        pytest.param(SIMO_WONG, (0.0, 0.2, 0.1), (1.0, 0.0, 5.0), id="from upright"),
        pytest.param(SIMO_WONG, (0.0, 0.2, 0.1), (-1.0, 0.0, 5.0), id="from upright backwards"),
        pytest.param(SIMO_WONG, (np.pi, 0.2, 0.1), (1.0, 0.0, 5.0), id="through straight down"),
        pytest.param(SIMO_WONG, (np.pi, 0.2, 0.1), (-1.0, 0.0, 5.0), id="from straight down"),
        pytest.param(SIMO_WONG, (np.pi, 0.0, 0.0), (0.0, 1.0, 3.0), id="hanging"),
        pytest.param(SIMO_WONG, (np.pi - 1e-8, 0.0, 0.0), (0.0, 1.0, 3.0), id="hanging nearly"),
        pytest.param(SIMO_WONG, (0.0, 0.2, 0.1), (0.0, 1.0, 24.0), id="asleep"),
        pytest.param(SIMO_WONG, (1e-9, 0.0, 0.0), (0.0, 0.0, 25.0), id="asleep nearly"),
        pytest.param(SIMO_WONG, (0.0, 0.0, 0.0), (0.0, 0.0, 19.0), id="upright and unstable"),
        pytest.param(SIMO_WONG, (1e-20, 0.0, 0.0), (0.0, 1.0, 18.0), id="about to fall"),
        pytest.param(SIMO_WONG, (0.1, 0.0, 0.0), (0.0, 0.0, 20.0), id="at the threshold"),
        pytest.param(SIMO_WONG, (0.0, 0.0, 0.0), (1e-8, 0.0, 20.0), id="upright at the threshold"),
        pytest.param(UNIT, (np.pi, 0.0, 0.0), (2.0, 0.0, 0.0), id="separatrix from below"),
        pytest.param(UNIT, (1.0, 0.0, 0.0), (2 * np.sin(0.5), 0.0, 0.0), id="separatrix down"),
        pytest.param(UNIT, (1.0, 0.0, 0.0), (-2 * np.sin(0.5), 0.0, 0.0), id="separatrix up"),
        pytest.param(HeavyTop(5.0, 1.0, 1.0, 1e-12, 1.0), (1.0, 0.1, 0.2), (0.3, 2.0, 3.0), id="weak torque"),
        pytest.param(HeavyTop(1.0, 1e-9, 1.0, 1.0, 1.0), (1.0, 0.1, 0.2), (0.3, 0.5, 3.0), id="a rod"),
        pytest.param(HeavyTop(1.0, 2.0, 1.0, 1.0, 1.0), (1.0, 0.1, 0.2), (0.3, 0.5, 3.0), id="a disc"),
    ],
)
def test_every_regime(top, angles, rates):
    """The turns until then are below 310 radians: 4 ε of them below 3e-13; measured 2e-14 and less, until 5 too."""
    exact = [[float(part) for part in turn] for turn in taylor(top, angles, rates, TIMES)]
    found = solved(top, angles, rates, TIMES)
    turned = np.abs(found.phi) + np.abs(found.psi)
    assert (angle_between(found.orientation, exact) <= 1e-14 + 4 * np.finfo(float).eps * turned).all()


def test_the_top_of_bruels_and_cardona():
    """Published centers of mass, of a top along y, in axes that are those here turned half about the vertical."""
    found = BRUELS.solve([0.2, 1.0, 2.0], theta=np.pi / 2, phi_dot=-4.61538, psi_dot=150.0)
    published = [
        [0.6055505613771198, 0.5989576817949192, -0.5239830274300032],
        [0.173343964098386, 0.6400885920705688, -0.7484907911335813],
        [-0.1504168227456418, -0.7241655916368957, -0.6730222695604441],
    ]
    # The least angle from straight down is 7e-7: the azimuth after it has its rounding 1e6 times, 1e-16 of π/2 each.
    assert np.abs(found.axis * [-1.0, -1.0, 1.0] - published).max() <= 1e-12
    # 270 nutations later: of an even motion about u's lowest place, the same angle as far before that place as after.
    nutation = BRUELS.nutation(np.pi / 2, phi_dot=-4.61538, psi_dot=150.0)
    late = BRUELS.solve([200.0, -200.0, 268 * nutation.period], theta=np.pi / 2, phi_dot=-4.61538, psi_dot=150.0)
    assert late.theta[0] == pytest.approx(late.theta[1], abs=1e-13)
    assert late.psi[0] == pytest.approx(-late.psi[1], rel=1e-15, abs=0)
    # The period is rounded to 6e-17 of itself, and the angle is stationary there.
    assert late.theta[2] == pytest.approx(np.pi / 2, abs=1e-13)


def test_the_same_top_after_two_hundred_seconds():
    """Against `taylor`, which takes five minutes to get there; 30 761 radians are turned through until then."""
    exact = [0.9569495342822668, 0.10194178926670941, -0.20039690984978636, 0.18356617052363158]
    found = BRUELS.solve(200.0, theta=np.pi / 2, phi_dot=-4.61538, psi_dot=150.0)
    turned = abs(found.phi) + abs(found.psi)
    assert angle_between(found.orientation, exact) <= 1e-14 + 4 * np.finfo(float).eps * turned
    assert np.abs(found.axis - vv.rigid.rotate(exact, [0.0, 0.0, 1.0])).max() < 1e-13  # its nods and turns alone: 181


angles = st.one_of(st.floats(0.0, np.pi), st.floats(-12.0, 0.0).map(lambda x: 10.0**x))
rates = st.floats(-20.0, 20.0)


@settings(max_examples=200, deadline=None)
@given(angles, st.booleans(), rates, rates, rates, st.floats(0.01, 2.0), st.floats(-3.0, 1.0))
def test_it_keeps_what_it_must(theta, hanging, theta_dot, phi_dot, psi_dot, along, gravity):
    top = HeavyTop(1.0, along, 1.0, 10.0**gravity, 1.0)
    theta = np.pi - theta if hanging else theta
    # Refused in between.
    off = max(theta, abs(theta_dot))
    assume(off == 0.0 or off > 1e-50)
    t = np.linspace(-50.0, 50.0, 201)
    found = solved(top, (theta, 0.0, 0.0), (theta_dot, phi_dot, psi_dot), t)
    sine, cosine = np.sin(found.theta), np.cos(found.theta)
    # Rates of φ and ψ apart are as uncertain as the sine is small.
    flat = sine > 1e-3
    size = 1.0 + abs(theta_dot) + abs(phi_dot) + abs(psi_dot)
    spin = found.psi_dot + found.phi_dot * cosine
    first = psi_dot + phi_dot * np.cos(theta)
    assert np.abs(spin - first)[flat].max(initial=0.0) <= 1e-11 * size
    energy = 0.5 * (found.theta_dot**2 + (found.phi_dot * sine) ** 2) + top.g * cosine
    wanted = 0.5 * (theta_dot**2 + (phi_dot * np.sin(theta)) ** 2) + top.g * np.cos(theta)
    assert np.abs(energy - wanted)[flat].max(initial=0.0) <= 1e-11 * size**2
    momentum = found.phi_dot * sine**2 + along * spin * cosine
    assert (
        np.abs(momentum - (phi_dot * np.sin(theta) ** 2 + along * first * np.cos(theta)))[flat].max(initial=0.0)
        <= 1e-11 * size
    )
    nutation = top.nutation(theta, theta_dot=theta_dot, phi_dot=phi_dot, psi_dot=psi_dot)
    assert found.theta.min() >= nutation.theta_min - 1e-14
    assert found.theta.max() <= nutation.theta_max + 1e-14


@settings(max_examples=60, deadline=None)
@given(st.floats(0.1, 3.0), rates, rates, rates, st.floats(-3.0, 3.0))
def test_rates_are_those_of_the_angles_and_a_motion_goes_on(theta, theta_dot, phi_dot, psi_dot, t):
    found = solved(SIMO_WONG, (theta, 0.3, 0.4), (theta_dot, phi_dot, psi_dot), t)
    h = 1e-3
    near = solved(SIMO_WONG, (theta, 0.3, 0.4), (theta_dot, phi_dot, psi_dot), t + h * np.arange(-3, 4))
    if np.sin(near.theta).min() > 0.2:
        for name in ("theta", "phi", "psi"):
            slope = getattr(near, name) @ np.array([-1, 9, -45, 0, 45, -9, 1]) / (60 * h)
            # Sixth order: (h · 100)⁶ of rates of up to 100.
            assert slope == pytest.approx(getattr(found, name + "_dot"), abs=1e-6 * (1 + abs(slope)))
        on = solved(
            SIMO_WONG,
            (float(found.theta), float(found.phi), float(found.psi)),
            (float(found.theta_dot), float(found.phi_dot), float(found.psi_dot)),
            0.5,
        )
        whole = solved(SIMO_WONG, (theta, 0.3, 0.4), (theta_dot, phi_dot, psi_dot), t + 0.5)
        assert angle_between([on.orientation], [whole.orientation])[0] <= 1e-12


def test_limits():
    t = np.linspace(-3.0, 3.0, 25)
    # Steady, with the angles as they were told, and asleep.
    slow = SIMO_WONG.steady_precession(0.3, 50.0).slow
    steady = SIMO_WONG.solve(t, theta=0.3, phi_dot=slow, psi_dot=50.0 - slow * np.cos(0.3))
    assert np.abs(steady.theta - 0.3).max() <= 1e-15
    assert np.abs(steady.phi - slow * t).max() <= 1e-14
    asleep = SIMO_WONG.solve(t, theta=0.0, phi_dot=1.0, psi_dot=30.0)
    assert (asleep.theta == 0.0).all()
    assert (asleep.psi == 30.0 * t).all()
    # No torque: the free symmetric top, of which the plan has its own closed form.
    weak = HeavyTop(5.0, 1.0, 1.0, 1e-15, 1.0).solve(t, theta=1.0, theta_dot=0.3, phi_dot=2.0, psi_dot=3.0)
    start = HeavyTop(5.0, 1.0, 1.0, 1e-15, 1.0).solve(0.0, theta=1.0, theta_dot=0.3, phi_dot=2.0, psi_dot=3.0)
    spun = vv.rigid.angular_velocity_from_euler([0.0, 1.0, 0.0], [2.0, 0.3, 3.0])
    free = vv.rigid.free_rotation([5.0, 5.0, 1.0], spun, t, orientation=start.orientation)
    assert angle_between(weak.orientation, free.orientation).max() <= 4e-14
    # Continuous through the separatrix, from both sides.
    on = UNIT.solve(t, theta=1.0, theta_dot=2 * np.sin(0.5), psi_dot=0.0)
    for off in (-1e-13, 1e-13):
        beside = UNIT.solve(t, theta=1.0, theta_dot=2 * np.sin(0.5) * (1 + off), psi_dot=0.0)
        assert np.abs(beside.theta - on.theta).max() <= 1e-11
    # A whole nutation later the angle is the same: after a million of them too.
    found = SIMO_WONG.nutation(0.3, psi_dot=50.0)
    late = SIMO_WONG.solve(1e6 * found.period, theta=0.3, psi_dot=50.0)
    assert late.theta == pytest.approx(0.3, abs=1e-9)


def test_shapes_and_copies():
    one = SIMO_WONG.solve(1.0, theta=0.3, psi_dot=50.0)
    assert one.theta.shape == ()
    assert one.axis.shape == (3,)
    assert one.orientation.shape == (4,)
    many = SIMO_WONG.solve(np.ones((2, 3)), theta=0.3, psi_dot=50.0)
    assert many.phi.shape == (2, 3)
    assert (many.phi == one.phi).all()
    assert SIMO_WONG.solve([], theta=0.3, psi_dot=50.0).psi.shape == (0,)
    with pytest.raises(ValueError, match="read-only"):
        many.phi[0, 0] = 1.0
    assert (pickle.loads(pickle.dumps(many)).phi == many.phi).all()
    assert repr(many) == "TopMotion(t of shape (2, 3))"


@pytest.mark.parametrize(
    ("changed", "argument", "words"),
    [
        ({"theta": -0.1}, "theta", r"\[0, π\]"),
        ({"theta": 1e-300, "psi_dot": 3.0}, "theta", "at rest upright"),
        ({"theta": 0.0, "theta_dot": 1e-80}, "theta", "at rest upright"),
        ({"theta": 3.2}, "theta", r"\[0, π\]"),
        ({"psi_dot": np.nan}, "psi_dot", "finite"),
        ({"phi": np.inf}, "phi", "finite"),
        ({"psi_dot": 1e40}, "psi_dot", "see free_rotation"),
        ({"t": 1e308}, "t", "can be counted"),
        ({"t": [0.0, np.nan]}, "t", "finite"),
    ],
)
def test_bad_input(changed, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        SIMO_WONG.solve(**{"t": 1.0, "theta": 0.3, "psi_dot": 50.0, **changed})
    assert caught.value.argument == argument
