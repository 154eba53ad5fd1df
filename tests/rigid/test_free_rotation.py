"""Free rotation against Taylor series in 40 digits, published cases, and the laws it must obey.

The bar is 1e-14 + 4 ε φ, relative, with φ the phase run through; where inputs are rounded decimals of a published case
their own rounding is within it.

Bounds: elliptic functions to a few roundings, of sums and products of them 1e-15, along many turns 1e-14; near the
separatrix to ten times what the moments are apart.
"""

import mpmath
import numpy as np
import pytest
from high_order import angle_between, taylor
from hypothesis import given, settings
from hypothesis import strategies as st

import visviva as vv

EPSILON = np.finfo(float).eps
TURN = np.array([0.5, -0.5, 0.5, 0.5])


def bar(moments, spin, t):
    path = vv.rigid.polhode(moments, spin)
    phase = (abs(path.precession_rate) + path.rate) * np.abs(t)
    return 1e-14 + 4 * EPSILON * phase


BODIES = {
    "about the largest": ([1.0, 2.0, 2.5], [0.3, 0.4, 0.5]),
    "about the smallest": ([1.0, 2.0, 2.5], [-0.9, -0.4, 0.01]),
    "in another order": ([2.5, 1.0, 2.0], [-0.3, 0.4, -0.5]),
    "in the third order": ([2.0, 2.5, 1.0], [0.9, -0.1, 0.05]),
    "prolate": ([1.5, 1.0, 1.5], [0.3, 0.4, -0.5]),
    "oblate": ([1.0, 1.0, 1.5], [0.3, 0.4, -0.5]),
    "sphere": ([1.0, 1.0, 1.0], [0.3, 0.4, -0.5]),
    "two moments 1e-15 apart": ([1.0, 1.0 + 1e-15, 1.5], [0.3, 0.4, 0.5]),
    "the others 4e-16 apart": ([1.0, 1.5, 1.5 + 4e-16], [0.3, 0.4, 0.5]),
    "nearly a sphere": ([1.0, 1.0 + 1e-9, 1.0 + 3e-9], [0.3, 0.4, 0.5]),
    "across a symmetric body": ([1.0, 2.0, 2.0], [1e-9, 0.4, 0.5]),
    "near the separatrix": ([1.0, 2.0, 3.0], [1e-3, -1.0, -1e-3]),
    "nearer": ([1.0, 2.0, 3.0], [1e-6, 1.0, 2e-6]),
    "beside it": ([1.0, 2.0, 3.0], [1.0, 0.5, np.sqrt(1 / 3)]),
    "about the middle": ([1.0, 2.0, 3.0], [0.0, 1.0, 0.0]),
    "nearly about it": ([1.0, 2.0, 3.0], [0.0, 1.0, 1e-20]),
    "nearly about the largest": ([1.0, 2.0, 3.0], [1e-20, 1e-30, 1.0]),
    "rod 26:1": ([1.7231e-4, 6.58e-6, 1.7243e-4], [10.0, 200.0, 5.0]),
    "rod 1e6:1": ([1e-6, 1.0, 1.0 + 5e-7], [20.0, 0.5, 0.3]),
    "rod": ([0.0, 1.0, 1.0], [0.0, 0.5, 0.3]),
    "plate": ([0.25, 0.5, 0.75], [1.0, 1.0, 0.1]),
}


@pytest.mark.parametrize("name", BODIES)
def test_against_taylor_series(name):
    moments, spin = BODIES[name]
    size = np.linalg.norm(spin)
    times = np.array([-4.0, 0.0, 1.5, 9.0]) / size
    out = vv.rigid.free_rotation(moments, spin, times, orientation=TURN)
    exact = np.array(moments)
    # Of a rod the equations are those of any body whose other moments agree, without spin about itself.
    exact[exact == 0.0] = 1.0
    for at, t in enumerate(times):
        velocity, turn = taylor(exact, spin, TURN, t)
        bound = bar(moments, spin, t)
        off = np.linalg.norm(out.angular_velocity[at] - velocity) / np.linalg.norm(velocity)
        assert off <= bound, (t, off / bound)
        assert angle_between(out.orientation[at], turn) <= bound, t
    assert np.all(np.abs(np.linalg.norm(out.orientation, axis=-1) - 1) <= 4 * EPSILON)


def test_the_ladder_to_the_separatrix():
    """m₀ = (e, 2, 3e), t = 40: to 1e-14 of |m| by the linear motion beside the separatrix and Jacobi's functions."""
    for exponent in (2, 3, 4, 5, 7, 10, 16, 25, 40, 63, 100):
        e = float(f"1e-{exponent}")
        out = vv.rigid.free_rotation([1.0, 2.0, 3.0], [e, 1.0, e], 40.0)
        with mpmath.workdps(260):
            small = mpmath.mpf(e)
            # p = 1/2, q = 1/6, r = 2/3 and squared momenta e², 4, 9e² (the spin about the largest axis is e).
            p, q, r = (mpmath.mpf(1) / n for n in (2, 6, mpmath.mpf(3) / 2))
            x, y, z = (
                mpmath.sqrt(small**2 + 4 * q / r),
                mpmath.sqrt(4 + small**2 * r / q),
                mpmath.sqrt(9 * small**2 + 4 * p / r),
            )
            square = p * x**2 / (q * z**2)
            rate = mpmath.sqrt(q * r) * z
            start = mpmath.ellipf(mpmath.asin(2 / y), square)
            u = 40 * rate + start
            period = 4 * mpmath.ellipk(square)
            u -= period * mpmath.nint(u / period)
            sn, cn, dn = (mpmath.ellipfun(kind, u, m=square) for kind in ("sn", "cn", "dn"))
            wanted = [float(mpmath.re(part)) for part in (x * cn, y * sn, z * dn)]
        assert np.linalg.norm(out.body_angular_momentum - wanted) <= 2e-14, (e, out.body_angular_momentum, wanted)


@pytest.mark.parametrize(
    ("e", "period", "momentum"),
    [
        (1e-4, 71.014506079316962, (4.7959631750041128e-4, -1.9999997799873601, 8.6604727543008061e-4)),
        (1e-8, 134.8256166372423, (-0.1018163175208994, -1.9896064309169123, 0.17635103498576474)),
        (1e-12, 198.63672655430463, (-0.0039184201647425965, 1.9999846459244756, 0.0067869028107365875)),
    ],
)
def test_published_rungs(e, period, momentum):
    assert vv.rigid.period([1.0, 2.0, 3.0], [e, 1.0, e]) == pytest.approx(period, rel=4e-16, abs=0)
    out = vv.rigid.free_rotation([1.0, 2.0, 3.0], [e, 1.0, e], 40.0)
    assert np.linalg.norm(out.body_angular_momentum - momentum) <= 4e-15


def test_published_cases():
    moments = np.array([0.6, 0.8, 1.0])
    out = vv.rigid.free_rotation(moments, np.array([1.8, 0.4, -0.9]) / moments, [10.0, 100.0])
    wanted = [
        (1.76596250851820754, -0.695464197033089119, 0.779554981481871086),
        (1.81398048171994126, 0.158953342748450219, 0.945626060749270788),
    ]
    turns = [
        (-0.570786951240350733, -0.299388571830790094, -0.206839086104673192, -0.736061364160793936),
        (-0.401161607031241803, 0.3660001367406887, 0.0508399529158700676, 0.838169770474586381),
    ]
    bound = bar(moments, out.angular_velocity[0], np.array([10.0, 100.0]))
    assert np.all(np.linalg.norm(out.body_angular_momentum - wanted, axis=-1) <= 2 * bound)
    assert np.all(angle_between(out.orientation, turns) <= bound)
    assert vv.rigid.period(moments, out.angular_velocity[0]) == pytest.approx(6.86261617805811641, rel=1e-15, abs=0)


def test_toutatis():
    """Takahashi et al. 2013, as Principia has them: angular velocities in degrees a day."""
    moments, spin = [3.0836, 3.235, 1.0], np.radians([14.51, 33.529, -98.709])
    path = vv.rigid.polhode(moments, spin)
    assert path.kind == "about_smallest"
    assert path.axis == 2
    assert path.period == pytest.approx(5.36853031352291, rel=1e-14, abs=0)
    assert 2 * np.pi / path.precession_rate == pytest.approx(7.41165226793735, rel=1e-14, abs=0)


def mean_advance(moments, spin):
    """The angle by which the axis goes round L in one period, by quadrature of Euler's angle."""
    path = vv.rigid.polhode(moments, spin)
    with mpmath.workdps(30):
        a, b, c = (mpmath.mpf(moments[at]) for at in (3 - path.axis - path.middle_axis, path.middle_axis, path.axis))
        w = [mpmath.mpf(spin[at]) for at in (3 - path.axis - path.middle_axis, path.middle_axis, path.axis)]
        x, y, z = a * w[0], b * w[1], c * w[2]
        sign = 1 if c > b else -1
        p, q = sign * (1 / a - 1 / b), sign * (1 / b - 1 / c)
        r = p + q
        x2, z2 = x**2 + q / r * y**2, z**2 + p / r * y**2
        square, rate = p * x2 / (q * z2), mpmath.sqrt(q * r * z2)
        length = mpmath.sqrt(x**2 + y**2 + z**2)
        period = 4 * mpmath.ellipk(square) / rate
        whole = 4 * mpmath.ellippi(-p / q, square) / rate
        return period, length * (period / c + sign * r * whole), rate


@pytest.mark.parametrize("name", ["about the largest", "about the smallest", "in another order", "near the separatrix"])
def test_a_million_flips(name):
    """After n periods the body is where it was but for a turn about L, whose angle is a complete integral."""
    moments, spin = BODIES[name]
    period, advance, _ = mean_advance(moments, spin)
    path = vv.rigid.polhode(moments, spin)
    assert path.period == pytest.approx(float(period), rel=4e-16, abs=0)
    assert path.precession_rate == pytest.approx(float(advance / period), rel=4e-16, abs=0)
    n = 10**6
    with mpmath.workdps(30):
        t = float(n * period)
        left = float(mpmath.mpf(t) - n * period)
        angle = float(mpmath.fmod(n * advance, 2 * mpmath.pi))
    then, start = (vv.rigid.free_rotation(moments, spin, t, orientation=TURN) for t in (t, left))
    bound = bar(moments, spin, t)
    size = np.linalg.norm(spin)
    # The bar of φ = 10⁷ is 1e-8; double-double keeps 1e-13.
    assert bound > 1e-9
    assert np.linalg.norm(then.angular_velocity - start.angular_velocity) <= 1e-13 * size
    axis = start.angular_momentum / np.linalg.norm(start.angular_momentum)
    turned = vv.rigid.quaternion_product(vv.rigid.quaternion_from_rotation_vector(angle * axis), start.orientation)
    assert angle_between(then.orientation, turned) <= 1e-13


def drawn(low, high):
    return st.floats(low, high, allow_nan=False)


bodies = st.tuples(drawn(0.01, 1.0), drawn(0.01, 1.0), drawn(0.01, 1.0)).map(
    # Moments of masses on three axes: b + c, c + a, a + b.
    lambda d: [d[1] + d[2], d[2] + d[0], d[0] + d[1]]
)
spins = st.tuples(drawn(-1.0, 1.0), drawn(-1.0, 1.0), drawn(-1.0, 1.0)).filter(lambda w: np.linalg.norm(w) > 1e-3)
rotations = st.tuples(*[drawn(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 1e-2)


@settings(max_examples=200, deadline=None)
@given(bodies, spins, rotations, drawn(-1e3, 1e3))
def test_what_is_conserved(moments, spin, turn, t):
    turn = np.array(turn) / np.linalg.norm(turn)
    times = np.array([0.0, t / 2, t])
    out = vv.rigid.free_rotation(moments, spin, times, orientation=turn)
    bound = bar(moments, spin, times)
    momentum = out.angular_momentum
    size = np.linalg.norm(np.multiply(moments, spin))
    assert np.all(np.linalg.norm(momentum - vv.rigid.rotate(turn, np.multiply(moments, spin)), axis=-1) <= bound * size)
    assert np.all(np.abs(out.energy / out.energy[0] - 1) <= 1e-14)
    assert np.all(np.abs(np.linalg.norm(out.body_angular_momentum, axis=-1) / size - 1) <= 4 * EPSILON)
    # Poinsot: the energy ellipsoid rolls on the plane that L stands upright on; ω·L is twice the energy in space, too.
    rolling = vv.rigid.rotate(out.orientation, out.angular_velocity)
    assert np.all(np.abs((rolling * momentum).sum(axis=-1) / (2 * out.energy) - 1) <= 1e-14)
    # Continued from the middle it comes to the same end: what is rounded there grows with the shear of the motion.
    again = vv.rigid.free_rotation(
        moments, out.angular_velocity[1], times[2] - times[1], orientation=out.orientation[1]
    )
    path = vv.rigid.polhode(moments, spin)
    shear = 1e-12 * (1 + path.rate * abs(t)) / max(path.complement, 1e-8) ** 2
    assert np.linalg.norm(again.angular_velocity - out.angular_velocity[2]) <= shear * np.linalg.norm(spin)
    # And back.
    back = vv.rigid.free_rotation(moments, -out.angular_velocity[2], t, orientation=out.orientation[2])
    assert np.linalg.norm(back.angular_velocity + spin) <= shear * np.linalg.norm(spin)


@settings(max_examples=100, deadline=None)
@given(bodies, spins, st.permutations(range(3)), drawn(-30.0, 30.0))
def test_the_order_of_axes_does_not_matter(moments, spin, order, t):
    order = list(order)
    parity = np.linalg.det(np.eye(3)[order])
    out = vv.rigid.free_rotation(moments, spin, t)
    other = vv.rigid.free_rotation(np.array(moments)[order], parity * np.array(spin)[order], t)
    bound = 4 * bar(moments, spin, t) * np.linalg.norm(spin)
    assert np.linalg.norm(parity * other.angular_velocity - out.angular_velocity[order]) <= bound


@pytest.mark.parametrize("size", [1e-100, 1e100, 1e-300])
@pytest.mark.parametrize("weight", [1e-200, 1e200])
@pytest.mark.parametrize("name", ["about the largest", "near the separatrix", "oblate", "sphere"])
def test_units_do_not_matter(size, weight, name):
    moments, spin = map(np.array, BODIES[name])
    t = 2.0**4
    power = 2.0 ** np.round(np.log2(size))
    mass = 2.0 ** np.round(np.log2(weight))
    out = vv.rigid.free_rotation(moments, spin, [t])
    if mass * power < 1e-300:
        mass = 1.0
    other = vv.rigid.free_rotation(mass * moments, power * spin, [t / power])
    assert np.array_equal(other.angular_velocity, power * out.angular_velocity)
    assert np.array_equal(other.orientation, out.orientation)


def test_limits_are_continuous():
    """Two moments that approach each other, a spin that approaches an axis, and the two sides of the separatrix."""
    t = 7.3
    for apart in 10.0 ** -np.arange(1.0, 16.0):
        for at in range(3):
            moments = np.array([1.0, 1.5, 2.0])
            moments[at] = moments[at - 1] * (1 + apart)
            near = vv.rigid.free_rotation(moments, [0.3, 0.4, 0.5], t)
            moments[at] = moments[at - 1]
            there = vv.rigid.free_rotation(moments, [0.3, 0.4, 0.5], t)
            assert np.linalg.norm(near.angular_velocity - there.angular_velocity) <= 10 * apart + 1e-14
            assert angle_between(near.orientation, there.orientation) <= 10 * apart + 1e-14
    # I = (1, 2, 3), ω = (1, ·, 1/√3): D = q Lz² − p Lx² vanishes.
    exact = [1.0, 0.5, np.sqrt(1 / 3)]
    wanted = vv.rigid.free_rotation([1.0, 2.0, 3.0], exact, t)
    for off in 10.0 ** -np.arange(2.0, 17.0):
        for side in (1.0, -1.0):
            out = vv.rigid.free_rotation([1.0, 2.0, 3.0], [exact[0], exact[1], exact[2] * (1 + side * off)], t)
            assert np.linalg.norm(out.angular_velocity - wanted.angular_velocity) <= 300 * off + 1e-13
            assert angle_between(out.orientation, wanted.orientation) <= 300 * off + 1e-13


def test_the_separatrix_itself():
    """1/I = (4, 3, 2)/60 and L = (30, 0, 30): 2E I₂ = L² exactly, and L₂ comes to its end as a tanh."""
    moments, spin = [15.0, 20.0, 30.0], [2.0, 0.0, 1.0]
    path = vv.rigid.polhode(moments, spin)
    assert path.kind == "separatrix"
    assert path.complement == 0.0
    assert np.isinf(path.period)
    times = np.array([-400.0, -20.0, -1.0, 0.0, 0.3, 5.0, 300.0, 1e6])
    out = vv.rigid.free_rotation(moments, spin, times, orientation=TURN)
    length = np.sqrt(2.0) * 30.0
    rate = length * np.sqrt(1 / 60 / 60)
    assert path.rate == pytest.approx(rate, rel=1e-15, abs=0)
    grown = np.array([1 / np.cosh(rate * times[:-1]), 1 / np.cosh(rate * times[:-1])]).T * 30.0
    assert np.all(np.abs(out.body_angular_momentum[:-1, [0, 2]] - grown) <= 1e-14)
    middle = out.body_angular_momentum[:, 1]
    assert np.all(np.abs(np.abs(middle) - length * np.abs(np.tanh(rate * times))) <= 1e-13)
    velocity, turn = taylor(moments, spin, TURN, 5.0)
    assert np.linalg.norm(out.angular_velocity[5] - velocity) <= 1e-14
    assert angle_between(out.orientation[5], turn) <= bar(moments, spin, 5.0)
    # Long after it turns about the middle axis, at |L|/I₂.
    assert abs(np.linalg.norm(out.angular_velocity[-1]) - length / 20) <= 1e-15


def test_flips_come_at_their_times():
    moments, spin = [1.0, 2.0, 3.0], [1e-3, 1.0, 1e-3]
    flip = vv.rigid.flip_time(moments, spin)
    path = vv.rigid.polhode(moments, spin)
    # Near the separatrix (2/λ) ln(4/k').
    assert flip == pytest.approx(2 / path.rate * np.log(4 / path.complement), rel=1e-5, abs=0)
    times = np.linspace(0.0, 10 * flip, 20001)
    middle = vv.rigid.free_rotation(moments, spin, times).angular_velocity[:, 1]
    assert np.count_nonzero(np.diff(np.sign(middle))) == 10
    assert path.period == 2 * flip
    assert vv.rigid.period(moments, spin) == path.period
    assert vv.rigid.precession_rate(moments, spin) == path.precession_rate


def test_shapes_and_results():
    out = vv.rigid.free_rotation([1.0, 2.0, 2.5], [0.3, 0.4, 0.5], np.zeros((2, 3)))
    assert out.angular_velocity.shape == out.angular_momentum.shape == (2, 3, 3)
    assert out.orientation.shape == (2, 3, 4)
    assert out.energy.shape == (2, 3)
    assert angle_between(out.orientation[1, 2], [0.0, 0.0, 0.0, 1.0]) <= 2 * EPSILON
    single = vv.rigid.free_rotation([1.0, 2.0, 2.5], [0.3, 0.4, 0.5], 1.0)
    assert single.angular_velocity.shape == (3,)
    assert "FreeRotation" in repr(single)
    with pytest.raises(ValueError, match="read-only"):
        single.orientation[0] = 1.0
    empty = vv.rigid.free_rotation([1.0, 2.0, 2.5], [0.3, 0.4, 0.5], [])
    assert empty.orientation.shape == (0, 4)
    rest = vv.rigid.free_rotation([1.0, 2.0, 2.5], [0.0, 0.0, 0.0], [0.0, 5.0], orientation=TURN)
    assert np.array_equal(rest.orientation, [TURN, TURN])


@pytest.mark.parametrize(
    ("moments", "spin", "turn", "t", "argument", "words"),
    [
        ([1.0, 1.0, 2.5], [0, 0, 1], None, 1.0, "moments", r"moments\[2\] = 2.5 is larger by 0.5"),
        ([1.0, -1.0, 1.0], [0, 0, 1], None, 1.0, "moments", r"moments\[1\] is -1.0"),
        ([0.0, 0.0, 0.0], [0, 0, 1], None, 1.0, "moments", "a point has no orientation"),
        ([0.0, 1.0, 1.0], [1, 0, 1], None, 1.0, "angular_velocity", "axis of a rod"),
        ([1.0, 1.0], [0, 0, 1], None, 1.0, "moments", r"expected shape \(3,\)"),
        ([1.0, 1.0, 1.0], [0, 0, np.nan], None, 1.0, "angular_velocity", "finite"),
        ([1.0, 1.0, 1.0], [0, 0, 1], [0, 0, 0, 0], 1.0, "orientation", "zero is no rotation"),
        ([1.0, 1.0, 1.0], [0, 0, 1], [0, 0, 0, 1.1], 1.0, "orientation", "length 1 within 1e-6"),
        ([1.0, 1.0, 1.0], [0, 0, 1], [0, 0, 1], 1.0, "orientation", "shape"),
        ([1.0, 1.5, 2.0], [0, 1e200, 1], None, 1e200, "t", "turns can be counted"),
        ([1e200, 1e200, 1e200], [0, 1e200, 1], None, 1.0, "angular_velocity", "range of float64"),
        ([1.0, 1.0, 1.0], [0, 0, 1], None, np.inf, "t", "finite"),
    ],
)
def test_bad_input(moments, spin, turn, t, argument, words):
    with pytest.raises(vv.InvalidInput, match=words) as caught:
        vv.rigid.free_rotation(moments, spin, t, orientation=turn)
    assert caught.value.argument == argument


def test_bodies_of_all_sizes_and_spins_beside_every_axis():
    """Moments over eight decades, some 1e-17 to 1e-3 apart, spins down to 1e-150 of the largest component.

    That orientation and momentum go together to a fifth of the bar shows that neither was lost; that a stop on the way
    changes nothing, that the rates are right. The factor 20 is for what rounding at the stop does to a near separatrix.
    """
    random = np.random.default_rng(3)
    for k in range(600):
        a, b, c = 10.0 ** random.uniform(-8, 0, 3) if k % 2 else random.uniform(0.05, 1, 3)
        b = a * (1 + 10.0 ** random.uniform(-17, -3)) if k % 5 == 0 else b
        c = b * (1 + 10.0 ** random.uniform(-17, -3)) if k % 7 == 0 else c
        moments = random.permutation([b + c, c + a, a + b])
        spin = random.normal(size=3) * 10.0 ** random.uniform(-12 if k % 3 else -150, 0, 3)
        if k % 11 == 0:
            spin[random.integers(3)] = 0.0
        spin /= np.abs(spin).max()
        path = vv.rigid.polhode(moments, spin)
        period = path.period if np.isfinite(path.period) else 10.0
        times = np.concatenate([random.uniform(-2, 2, 6), [0.25, 0.5, 0.75, 1.0, -0.25, -0.5]]) * period
        times = times[np.abs(times) * (path.rate + path.precession_rate) < 1e6]
        out = vv.rigid.free_rotation(moments, spin, times)
        bound, momentum = bar(moments, spin, times), moments * spin
        off = np.linalg.norm(out.angular_momentum - momentum, axis=-1)
        assert np.all(off <= 0.2 * bound * np.linalg.norm(momentum)), (moments, spin)
        assert np.all(np.abs(out.energy / (0.5 * momentum @ spin) - 1) <= 1e-14)
        assert np.all(np.abs(np.linalg.norm(out.orientation, axis=-1) - 1) <= 4 * EPSILON)
        if path.complement > 1e-3 and times.size:
            half = vv.rigid.free_rotation(moments, spin, times[0] / 2)
            rest = vv.rigid.free_rotation(moments, half.angular_velocity, times[0] / 2, orientation=half.orientation)
            assert angle_between(rest.orientation, out.orientation[0]) <= 20 * bound[0], (moments, spin)
