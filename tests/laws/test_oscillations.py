"""Oscillators in every regime, driven and not, against hundreds of digits and against integration.

The bound is that of `closed_forms/mod.rs`: half a unit in the last place of what is given, and 1e-26 of the largest
term times (1 + the largest angle or number of decays).

A run at rtol = 1e-13 ends 7e-15 off the closed form.
"""

import math
from typing import Any

import mpmath
import numpy as np
import pytest

import visviva as vv

Number = Any


def reference(
    x: float,
    v: float,
    g: float,
    k: float,
    m: float,
    center: float,
    tau: float,
    drives: list[tuple[float, ...]],
    t: float,
) -> tuple[Number, Number, Number, Number, Number]:
    """Position, velocity, their largest terms and the largest angle: divided differences written out in 500 digits.

    Roots that coincide are moved apart by 1e-120, which changes as little.
    """
    mpf = mpmath.mpf
    with mpmath.workdps(500):
        gamma = mpf(0) if math.isinf(tau) else 1 / (2 * mpf(tau))
        square, t = mpf(k) / mpf(m), mpf(t)
        delta = mpmath.sqrt(mpmath.mpc(gamma**2 - square))
        tiny = mpf(10) ** -120
        one, two = -gamma + delta, -gamma - delta + tiny
        size = max(abs(one), abs(two), 1 / abs(t))

        def second(a: Number, b: Number) -> Number:
            return (mpmath.exp(a * t) - mpmath.exp(b * t)) / (a - b)

        def third(a: Number) -> Number:
            for root in (one, two):
                if abs(a - root) < tiny / 2 * size:
                    a += 3 * tiny * size
            return (second(a, one) - second(a, two)) / (one - two)

        blow = second(one, two)
        rate = (one * mpmath.exp(one * t) - two * mpmath.exp(two * t)) / (one - two)
        start = mpf(g) - square * (mpf(x) - mpf(center))
        integral = third(mpf(0))
        place = [mpf(x), blow * v, integral * start]
        speed = [rate * v, blow * start]
        angle = max(abs(one * t), abs(two * t))
        for amplitude, frequency, phase in drives:
            a = mpf(amplitude) / mpf(m)
            turn = mpmath.exp(1j * mpf(phase))
            response = third(1j * mpf(frequency))
            place.append(a * (turn * response).real)
            speed.append(a * (turn * (blow + 1j * mpf(frequency) * response)).real)
            angle = max(angle, abs(mpf(frequency) * t), abs(mpf(phase)))
        if square > 0:
            rest = mpf(center) + mpf(g) / square
            place.append(rest)
        largest = max(abs(term) for term in place), max(abs(term) for term in speed)
        if square > 0:
            place.pop()
        return mpmath.re(sum(place)), mpmath.re(sum(speed)), *largest, angle


# Stiffness over mass and 1/(2 tau)²: all regimes, at all ratios, and the critical one itself.
REGIMES = ["under", "critical", "over", "undamped", "free"]


@pytest.mark.parametrize("driven", [0, 1, 2])
@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("decades", [1.0, 5.0])
def test_every_regime_to_half_a_unit(regime: str, driven: int, decades: float) -> None:
    random = np.random.default_rng([REGIMES.index(regime), driven, round(decades)])
    for _ in range(12):
        m = 2.0 ** int(random.integers(-2, 3))
        omega = float(np.round(2.0 ** random.uniform(-3, 3), 3))
        k = m * omega * omega if regime == "critical" else float(m * 10 ** random.uniform(-decades, decades))
        gamma = math.sqrt(k / m)
        if regime == "critical":
            k, gamma = m * 0.25, 0.5
        tau = {
            "under": 1 / (2 * gamma * float(10 ** random.uniform(-decades, -0.01))),
            "critical": 1.0,
            "over": 1 / (2 * gamma * float(10 ** random.uniform(0.01, decades))),
            "undamped": math.inf,
            "free": 2.0,
        }[regime]
        forces: list[vv.forces.Force] = []
        center = random.uniform(-1, 1, 3)
        if regime == "free":
            k = 0.0
            driven = max(driven, 1)
        else:
            forces.append(vv.Harmonic(k, center))
        if not math.isinf(tau):
            forces.append(vv.LinearDrag(tau))
        g = random.uniform(-1, 1, 3)
        forces.append(vv.UniformField(g))
        drives = []
        for index in range(driven):
            # One of them in resonance, to the last digit where there is no damping.
            frequency = math.sqrt(k / m) if index == 0 and k else float(10 ** random.uniform(-decades, decades))
            drives.append((random.uniform(-1, 1, 3), frequency, float(random.uniform(-3, 3))))
            forces.append(vv.DrivenForce(*drives[-1]))
        t = float(random.choice([-1.0, 1.0]) * 10 ** random.uniform(-decades, 1.0) / max(math.sqrt(k / m), 0.3))
        if not math.isinf(tau) and t < 0 and -t / tau > 100:
            t = -t
        x, v = random.uniform(-1, 1, (2, 3))
        out = vv.Scene(vv.Particles([m], [x], [v]), *forces).run(t=t)
        assert out.plan.solution == "closed form: oscillation"
        for c in range(3):
            along = [(float(a[c]), w, phase) for a, w, phase in drives]
            place, speed, far, fast, angle = reference(x[c], v[c], g[c], k, m, center[c], tau, along, t)
            for value, exact, size in (
                (out.position[-1, 0, c], place, far),
                (out.velocity[-1, 0, c], speed, fast),
            ):
                bound = mpmath.mpf(math.ulp(value)) / 2 * (1 + mpmath.mpf(10) ** -8) + size * 1e-26 * (1 + angle)
                assert abs(mpmath.mpf(float(value)) - exact) <= bound, (regime, value, exact)


def test_what_decays_keeps_its_digits() -> None:
    """An oscillator about the origin after a thousand decays: 1e-16 of what is left, not of the start."""
    body = vv.Particles([1.0], [[1.0, 0.5, 0.0]], [[0.0, 1.0, 0.0]])
    for k, tau in ((4.0, 0.5), (4.0, 0.25), (4.0, 0.05)):
        out = vv.Scene(body, vv.Harmonic(k), vv.LinearDrag(tau)).run(t=100.0)
        for c in range(2):
            x, v = body.position[0, c], body.velocity[0, c]
            place, speed, *_ = reference(x, v, 0.0, k, 1.0, 0.0, tau, [], 100.0)
            # Half a unit, and 1e-26 (1 + angle) where an oscillation passes zero.
            assert abs(out.position[-1, 0, c] / float(place) - 1) < 2e-16
            assert abs(out.velocity[-1, 0, c] / float(speed) - 1) < 2e-16


def test_at_rest_in_its_place_it_stays_there_forever() -> None:
    for t in (1e300, -1e300, -3e7, 5.0):
        scene = vv.Scene(vv.Particles([2.0], [[1.0, 2.0, 3.0]]), vv.Harmonic(8.0, [1.0, 2.0, 3.0]), vv.LinearDrag(1.0))
        assert scene.run(t=t).position[-1, 0].tolist() == [1.0, 2.0, 3.0]


def test_what_grows_beyond_the_range_ends_the_run() -> None:
    """Backward in time a damped oscillator grows: e^2000 is no number."""
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]]), vv.Harmonic(1.0), vv.LinearDrag(0.5))
    for t in (-2000.0, -1e9):
        members = scene.ensemble(position=np.array([[[1.0, 0.0, 0.0]]])).run(t=[-1.0, t])
        assert members.status.tolist() != [0]
        assert np.isfinite(members.position[0, 0]).all()


def test_an_ensemble_of_oscillators_has_the_bits_of_each() -> None:
    random = np.random.default_rng(5)
    scene = vv.Scene(
        vv.Particles([1.0, 2.0], random.normal(size=(2, 3)), random.normal(size=(2, 3))),
        vv.Harmonic(3.0, [0.1, 0.2, 0.3]),
        vv.LinearDrag(0.7),
        vv.DrivenForce([1.0, 0.0, 0.5], 1.3, 0.2),
        vv.UniformElectricField([0.5, 0.0, 1.0], [1.0, -2.0]),
        t0=2.5,
    )
    starts = random.normal(size=(9, 2, 3))
    together = scene.ensemble(position=starts).run(t=9.0)
    for copy in (0, 8):
        alone = scene.with_state(starts[copy], scene.particles.velocity).run(t=9.0)
        assert np.array_equal(alone.position[-1], together.position[copy, -1])
    named = scene.run(t=9.0, method="dop853", rtol=1e-13)
    np.testing.assert_allclose(named.position, scene.run(t=9.0).position, rtol=0, atol=1e-13)
