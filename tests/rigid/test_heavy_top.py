"""Heavy tops: published nutations, the pendulum they contain, steady precession, and what is refused.

Bounds: roots, periods and angles are rounded once or twice, 2e-16 to 1e-15.
"""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import visviva as vv

SIMO_WONG = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0)


@pytest.mark.parametrize(
    ("theta", "heights", "period"),
    [
        (0.3, (0.9470957121658395, 0.955336489125606), 0.6822560158311819),
        (0.05, (0.998512425506186, 0.9987502603949662), 0.6854584972896153),
    ],
)
def test_the_top_of_simo_and_wong(theta, heights, period):
    found = SIMO_WONG.nutation(theta, psi_dot=50.0)
    assert found.roots[:2] == pytest.approx(heights, rel=2e-16, abs=0)
    assert found.period == pytest.approx(period, rel=4e-16, abs=0)
    assert found.theta_min == pytest.approx(theta, rel=2e-16, abs=0)
    assert found.kind == "cusp"
    assert SIMO_WONG.sleeping_threshold == 20.0
    assert SIMO_WONG.steady_precession(0.3, 50.0) == pytest.approx(
        (0.416578700573934978, 10.050937314806921), rel=4e-16, abs=0
    )
    third = SIMO_WONG.steady_precession(np.pi / 3, 50.0)
    assert third == pytest.approx((0.408336953374560917, 19.5916630466254391), rel=4e-16, abs=0)


def test_the_top_of_bruels_and_cardona():
    """From the horizontal through 7e-7 of straight down: 1 + u₁ = 2.6e-13."""
    top = vv.rigid.HeavyTop(A=15.234375, C=0.46875, mass=15.0, g=9.81, R=1.0)
    found = top.nutation(np.pi / 2, phi_dot=-4.61538, psi_dot=150.0)
    assert found.period == pytest.approx(0.7452069476167691, rel=1e-15, abs=0)
    assert found.theta_min == pytest.approx(np.pi / 2, rel=4e-16, abs=0)
    with mpmath.workdps(60):
        a, c, torque = mpmath.mpf(15.234375), mpmath.mpf(0.46875), mpmath.mpf(15 * 9.81)
        phi, u0 = mpmath.mpf(-4.61538), mpmath.cos(mpmath.mpf(np.pi / 2))
        spin = 150 + phi * u0
        p_psi, p_phi = c * spin, a * phi * (1 - u0**2) + c * spin * u0
        energy = a * phi**2 * (1 - u0**2) / 2 + torque * u0
        # 2A (E − MgR u)(1 − u²) − (p_φ − p_ψ u)².
        cubic = [
            2 * a * torque,
            -2 * a * energy - p_psi**2,
            2 * p_phi * p_psi - 2 * a * torque,
            2 * a * energy - p_phi**2,
        ]
        # One of the three is beyond 1, one where the top starts, and the lowest next to -1.
        lowest = mpmath.findroot(lambda u: ((cubic[0] * u + cubic[1]) * u + cubic[2]) * u + cubic[3], -1)
        theta_max = float(mpmath.acos(lowest))
    assert found.theta_max == pytest.approx(theta_max, rel=4e-16, abs=0)
    assert 6e-7 < np.pi - found.theta_max < 8e-7
    assert top.sleeping_threshold == pytest.approx(202.0138609105821, rel=1e-15, abs=0)


def test_a_pendulum():
    """Without spin or precession: a physical pendulum, 4 √(A/MgR) K(sin(θ/2)) of swings past the lowest point.

    Its axis goes from θ down to π, where φ jumps by π, and up on the other side: one nutation is half a swing.
    """
    for swing in (1e-6, 0.5, 2.0, 3.1):
        found = SIMO_WONG.nutation(np.pi - swing, psi_dot=0.0)
        assert found.kind == "plane"
        assert found.theta_max == pytest.approx(np.pi, rel=4e-16, abs=0)
        with mpmath.workdps(30):
            exact = 2 * mpmath.sqrt(mpmath.mpf(5) / 20) * mpmath.ellipk(mpmath.cos(mpmath.mpf(np.pi - swing) / 2) ** 2)
        assert found.period == pytest.approx(float(exact), rel=1e-15, abs=0)


angles = st.floats(1e-3, np.pi - 1e-3)
rates = st.floats(-20.0, 20.0)


@settings(max_examples=300, deadline=None)
@given(angles, rates, rates, rates)
def test_the_cubic_vanishes_at_its_roots(theta, theta_dot, phi_dot, psi_dot):
    found = SIMO_WONG.nutation(theta, theta_dot=theta_dot, phi_dot=phi_dot, psi_dot=psi_dot)
    assert found.theta_min <= theta * (1 + 1e-15)
    assert found.theta_max >= theta * (1 - 1e-15)
    low, high, beyond = found.roots
    assert -1 <= low <= np.cos(theta) + 1e-15
    assert np.cos(theta) - 1e-15 <= high <= 1 <= beyond * (1 + 1e-15)
    spin = psi_dot + phi_dot * np.cos(theta)
    sum_of_roots = low + high + beyond
    # Vieta: of the cubic 2g u³ − (2E'/A + b²) u² + …, with E' the energy but for the spin's.
    energy = 2.5 * (theta_dot**2 + (phi_dot * np.sin(theta)) ** 2) + 20 * np.cos(theta)
    assert sum_of_roots == pytest.approx((2 * energy / 5 + (spin / 5) ** 2) / 8, rel=1e-13, abs=1e-13)
    assert (found.kind == "loop") == (low < found.turning < high) or abs(found.turning - high) < 1e-12


@settings(max_examples=100, deadline=None)
@given(angles, st.floats(20.1, 200.0))
def test_steady_precessions_do_not_nutate(theta, spin):
    for precession in SIMO_WONG.steady_precession(theta, spin):
        if abs(precession) < 1e6:
            psi_dot = spin - precession * np.cos(theta)
            found = SIMO_WONG.nutation(theta, phi_dot=precession, psi_dot=psi_dot)
            # The rounding of a rate turns a double root into two, its square root apart at most.
            assert found.theta_max - found.theta_min <= 1e-7 * max(1.0, abs(precession) / spin)


def test_limits():
    # To the horizontal from both sides: the slow one is M g R/(C ω) there, the fast one goes to infinity.
    for off in (1e-3, 1e-9, 1e-15):
        above, below = (SIMO_WONG.steady_precession(np.pi / 2 + side * off, 50.0) for side in (-1, 1))
        assert above.slow == pytest.approx(0.4, rel=2 * off + 4e-16, abs=0)
        assert below.slow == pytest.approx(0.4, rel=2 * off + 4e-16, abs=0)
        assert above.fast > 0 > below.fast
    # At the least spin both are one.
    spin = SIMO_WONG.least_spin(1.0) * (1 + 1e-14)
    slow, fast = SIMO_WONG.steady_precession(1.0, spin)
    assert slow == pytest.approx(fast, rel=1e-6, abs=0)
    assert SIMO_WONG.steady_precession(1.0, -30.0) == tuple(-x for x in SIMO_WONG.steady_precession(1.0, 30.0))
    # A conical pendulum: Ω² = M g R/(A |cos θ|).
    slow, fast = SIMO_WONG.steady_precession(2.5, 0.0)
    assert slow == pytest.approx(np.sqrt(20 / 5 / -np.cos(2.5)), rel=1e-15, abs=0)
    assert fast == pytest.approx(-slow, rel=1e-15, abs=0)
    # Asleep, and on the way from upright for ever.
    assert SIMO_WONG.nutation(0.0, psi_dot=20.1).kind == "steady"
    falling = SIMO_WONG.nutation(0.0, psi_dot=19.0)
    assert np.isinf(falling.period)
    assert falling.theta_max > 0.3
    assert SIMO_WONG.nutation_range(0.3, psi_dot=50.0)[0] == pytest.approx(0.3, rel=2e-16, abs=0)


@pytest.mark.parametrize(
    ("theta", "p_phi", "p_psi"),
    [
        (1e-9, 30.0, 30.0),
        (1e-9, 30.0000001, 30.0),
        (0.3, 3.0, 30.0),
        (1.5, 2.0, 7.0),
        (2.5, 1.0, 0.0),
        (2.5, 3.0, 7.0),
        (2.9, -30.0, 30.0),
        (np.pi - 1e-4, -29.9997, 30.0),
        (np.pi - 1e-8, -30.0, 30.0),
    ],
)
def test_the_potential_in_which_it_nods(theta, p_phi, p_psi):
    with mpmath.workdps(40):
        sine, cosine = mpmath.sin(theta), mpmath.cos(theta)
        barrier = (p_phi - p_psi * cosine) ** 2 / (2 * 5 * sine**2)
        exact, size = barrier + 20 * cosine, barrier + 20
    found = vv.rigid.HeavyTop(5.0, 1.0, 1.0, 20.0, 1.0).effective_potential(theta, p_phi=p_phi, p_psi=p_psi)
    assert abs(found - exact) < 8 * np.finfo(float).eps * size  # rounding of its two terms


def test_a_fast_top_goes_round_at_the_rate_of_a_weak_torque():
    for spin in (1e3, -1e5):
        rate = SIMO_WONG.weak_torque_precession(spin)
        assert rate == 20.0 / spin
        # Off by A M g R cos θ/(C ω₃)² of itself, and by its square.
        share = 5.0 * 20.0 * np.cos(0.3) / spin**2
        assert abs(SIMO_WONG.steady_precession(0.3, spin).slow / rate - 1.0 - share) < 3.0 * share**2 + 1e-15


def test_the_potential_at_the_poles():
    top = vv.rigid.HeavyTop(5.0, 1.0, 1.0, 20.0, 1.0)
    assert top.effective_potential(0.0, p_phi=3.0, p_psi=3.0) == 20.0
    assert top.effective_potential([0.0, np.pi], p_phi=3.0, p_psi=2.0).min() > 1e30
    assert top.effective_potential(np.pi, p_phi=-3.0, p_psi=3.0) == -20.0
    # A steady precession is at the bottom: the derivative vanishes to the square of the step.
    slow = top.steady_precession(0.7, 60.0).slow
    momenta = top.momenta(0.7, psi_dot=60.0 - slow * np.cos(0.7), phi_dot=slow)
    left, middle, right = top.effective_potential([0.699, 0.7, 0.701], **momenta._asdict())
    assert middle < min(left, right)
    assert abs(left - right) < 2e-3 * (left + right - 2.0 * middle)  # of third order in the step


@pytest.mark.parametrize(
    ("call", "argument", "words"),
    [
        (lambda: vv.rigid.HeavyTop(0.0, 1.0, 1.0, 1.0, 1.0), "A", "positive"),
        (lambda: vv.rigid.HeavyTop(1.0, 2.1, 1.0, 1.0, 1.0), "C", "larger by 0.1"),
        (lambda: vv.rigid.HeavyTop(1.0, 1.0, -1.0, 1.0, 1.0), "mass", "positive"),
        (lambda: vv.rigid.HeavyTop(1.0, 1.0, 1.0, 1.0, 0.0), "R", "see free_rotation"),
        (lambda: vv.rigid.HeavyTop(1.0, 1.0, 1.0, -9.8, 1.0), "g", "theta beyond pi/2"),
        (lambda: vv.rigid.HeavyTop(1.0, 1.0, 1.0, "x", 1.0), "g", "real numbers"),
        (lambda: SIMO_WONG.steady_precession(0.3, 10.0), "spin", r"expected at least 19.548\d*"),
        (lambda: SIMO_WONG.nutation(-0.1, psi_dot=1.0), "theta", r"\[0, π\]"),
        (lambda: SIMO_WONG.nutation(0.1, psi_dot=np.nan), "psi_dot", "finite"),
    ],
)
def test_bad_input(call, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        call()
    assert caught.value.argument == argument


@pytest.mark.parametrize("theta", [0.3, 1.2, 2.5])
def test_steady_precession_is_steady(theta):
    """Its own rates, which are rounded, were told a wave; a millionth more is one."""
    for rate in SIMO_WONG.steady_precession(theta, spin=50.0):
        found = SIMO_WONG.nutation(theta, psi_dot=50.0 - rate * np.cos(theta), phi_dot=rate)
        assert found.kind == "steady"
        # The bend of F about its double root: what rounding moves it by.
        assert found.theta_max - found.theta_min < 1e-14
        beside = SIMO_WONG.nutation(theta, psi_dot=50.0 - rate * np.cos(theta), phi_dot=rate * (1 + 1e-6))
        assert beside.kind == "wave"
