"""Mixtures of linear forces in closed form: against matrix exponentials of 60 digits, and what is known of them."""

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

import visviva as vv
from visviva.forces import Force

Array = NDArray[np.float64]
FLOW = "closed form: linear flow"
CHARGE, MASS, K, TAU = 0.7, 1.3, 2.1, 8.0
B, E, G, OMEGA = np.array([0.3, -0.2, 1.5]), np.array([0.2, 0.1, -0.3]), np.array([0.1, 0.4, -0.9]), [0.0, 0.0, 0.6]
CENTER = [0.5, -1.0, 0.25]
FORCES: dict[str, Force] = {
    "harmonic": vv.Harmonic(K, center=CENTER),
    "magnetic": vv.UniformMagneticField(B, charge=CHARGE),
    "electric": vv.UniformElectricField(E, charge=CHARGE),
    "uniform": vv.UniformField(G),
    "drag": vv.LinearDrag(TAU),
    "frame": vv.RotatingFrame(OMEGA, CENTER),
}
MIXTURES = [
    ["harmonic", "magnetic"],
    ["harmonic", "magnetic", "electric", "uniform"],
    ["harmonic", "frame"],
    ["magnetic", "drag"],
    ["frame", "uniform"],
    ["magnetic", "drag", "electric", "uniform"],
    ["frame", "drag", "electric"],
    ["harmonic", "harmonic", "drag", "frame", "uniform", "electric"],
    ["harmonic", "harmonic", "magnetic", "drag", "uniform", "electric"],
]


def matrix(names: list[str]) -> mpmath.matrix:
    """M of y′ = M y, of the place, the velocity and a 1."""

    def across(v: Any) -> mpmath.matrix:
        x, y, z = (mpmath.mpf(float(part)) for part in v)
        return mpmath.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])

    def vector(v: Any) -> mpmath.matrix:
        return mpmath.matrix([mpmath.mpf(float(part)) for part in v])

    full, one = mpmath.zeros(7), mpmath.eye(3)
    places, speeds, constants = mpmath.zeros(3), mpmath.zeros(3), mpmath.zeros(3, 1)
    charge, mass = mpmath.mpf(CHARGE), mpmath.mpf(MASS)
    for name in names:
        if name == "harmonic":
            places -= one * (mpmath.mpf(K) / mass)
            constants += vector(CENTER) * (mpmath.mpf(K) / mass)
        elif name == "magnetic":
            speeds -= across(B) * (charge / mass)
        elif name == "electric":
            constants += vector(E) * (charge / mass)
        elif name == "uniform":
            constants += vector(G)
        elif name == "drag":
            speeds -= one / mpmath.mpf(TAU)
        else:
            turn = across(OMEGA)
            speeds -= 2 * turn
            places -= turn * turn
            constants += turn * turn * vector(CENTER)
    for i in range(3):
        full[i, 3 + i] = mpmath.mpf(1)
        full[3 + i, 6] = constants[i]
        for j in range(3):
            full[3 + i, j], full[3 + i, 3 + j] = places[i, j], speeds[i, j]
    return full


def scene(names: list[str], position: Any = (1.0, 0.2, 0.3), velocity: Any = (0.1, -0.5, 0.2)) -> vv.Scene:
    return vv.Scene(vv.Particles([MASS], [position], [velocity]), *(FORCES[name] for name in names))


@pytest.mark.parametrize("t", [1e-9, 0.37, 25.0, -25.0, 1e6])
@pytest.mark.parametrize("names", MIXTURES, ids=" ".join)
def test_against_sixty_digits(names: list[str], t: float) -> None:
    """To half a unit in the last place, and 1e-29 of the largest numbers, about 1 at first, for each unit of time."""
    if t < 0.0 and "drag" in names:
        pytest.skip("drag runs forwards")
    start = scene(names)
    if t == 1e6 and "frame" in names and "drag" in names and "harmonic" not in names:
        # What a medium turns along goes ever farther out.
        with pytest.raises(vv.ConvergenceError, match="infinite"):
            start.run(t=t)
        return
    mpmath.mp.dps = 60
    out = start.run(t=t)
    assert out.plan.solution == FLOW
    flow = mpmath.expm(matrix(names) * mpmath.mpf(t))
    y = [*start.particles.position[0], *start.particles.velocity[0], 1.0]
    found = [*out.position[-1, 0], *out.velocity[-1, 0]]
    for row in range(6):
        terms = [flow[row, column] * mpmath.mpf(float(y[column])) for column in range(7)]
        bound = mpmath.mpf(math.ulp(found[row])) / 2 * (1 + mpmath.mpf(10) ** -9)
        bound += (1 + 4 * abs(t)) * mpmath.mpf(10) ** -29 * max(1, *map(abs, terms))
        assert abs(mpmath.mpf(float(found[row])) - mpmath.fsum(terms)) <= bound, row


def test_larmor_and_zeeman() -> None:
    """A charge on a spring in a field along z: x + iy is a sum of turns at −ω_L ± √(ω² + ω_L²), ω_L = qB/2m."""
    larmor, omega = CHARGE * 2.0 / (2 * MASS), math.sqrt(K / MASS)
    fast = math.hypot(omega, larmor)
    particle = vv.Particles([MASS], [[1.0, 0.0, 0.5]], [[0.0, 0.3, 0.0]])
    made = vv.Scene(particle, vv.Harmonic(K), vv.UniformMagneticField([0, 0, 2.0], charge=CHARGE))
    t = np.linspace(0.0, 40.0, 81)
    out = made.run(t=t)
    assert out.plan.solution == FLOW
    rates = np.array([-larmor + fast, -larmor - fast])
    # Amplitudes with sum 1 and sum of i·rate·amplitude 0.3i.
    amplitudes = np.linalg.solve([[1.0, 1.0], rates], [1.0, 0.3])
    exact = np.exp(1j * np.multiply.outer(t, rates)) @ amplitudes
    # Roundings of angles of up to 100 radians in the closed form of the test.
    np.testing.assert_allclose(out.position[:, 0, 0] + 1j * out.position[:, 0, 1], exact, rtol=0.0, atol=4e-14)
    np.testing.assert_allclose(out.position[:, 0, 2], 0.5 * np.cos(omega * t), rtol=0.0, atol=2e-14)


def test_foucaults_pendulum_turns_by_the_frame() -> None:
    """Small swings seen from a frame: the ellipse turns by −Ω t, and is what it is outside."""
    omega, t = 0.05, 60.0
    bob = vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, -omega, 0.0]])
    out = vv.Scene(bob, vv.Harmonic(4.0), vv.RotatingFrame([0.0, 0.0, omega], [0.0, 0.0, 0.0])).run(t=t)
    assert out.plan.solution == FLOW
    outside, turn = math.cos(2.0 * t), -omega * t
    expected = [outside * math.cos(turn), outside * math.sin(turn), 0.0]
    # Roundings of an angle of 120 radians.
    np.testing.assert_allclose(out.position[-1, 0], expected, rtol=0.0, atol=3e-14)


def test_members_threads_and_what_is_beyond_the_range() -> None:
    """One member in a place of 1e200 is integrated; the others are as alone."""
    names = ["harmonic", "magnetic", "uniform"]
    places = np.random.default_rng(2).normal(size=(13, 1, 3))
    places[5] = 1e200
    copies = scene(names).ensemble(position=places)
    t = np.linspace(0.0, 30.0, 5)
    together = copies.run(t=t, threads=1)
    assert np.array_equal(copies.run(t=t, threads=3).position, together.position)
    for copy in range(13):
        alone = copies[copy].run(t=t)
        assert (alone.plan.solution == FLOW) == (copy != 5)
        assert np.array_equal(alone.position, together.position[copy]), copy


def test_own_parameters_and_bodies_without_charge() -> None:
    particles = vv.Particles([0.0, 1.0], [[1.0, 0, 0], [2.0, 0, 0]], [[0, 1.0, 0], [0, 1.0, 0]])
    field = vv.UniformMagneticField([0.0, 0.0, 1.0], charge=[0.0, 2.0])
    made = vv.Scene(particles, field, vv.LinearDrag(TAU))
    out = made.run(t=3.0)
    assert out.plan.solution == FLOW
    # The one without a charge only slows down; two roundings, of the exponential and of its argument.
    assert out.velocity[-1, 0, 1] == pytest.approx(math.exp(-3.0 / TAU), rel=4e-16, abs=0.0)
    copies = made.ensemble(parameters={"UniformMagneticField": {"B": [[0, 0, 1.0], [0, 0.5, 1.0]]}})
    together = copies.run(t=3.0)
    for copy in range(2):
        assert np.array_equal(copies[copy].run(t=3.0).position, together.position[copy])


def test_events_are_found_on_steps_that_are_as_exact() -> None:
    names = ["harmonic", "magnetic"]
    out = scene(names).run(t=20.0, events=[vv.events.plane(CENTER, [1.0, 0.0, 0.0])])
    assert len(out.events) > 3
    on_the_way = scene(names).run(t=[0.0, *out.events.t])
    # Of steps that are held to 3e-14, at speeds of about 1.
    np.testing.assert_allclose(on_the_way.position[1:, 0, 0], CENTER[0], rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("others", [["uniform"], ["magnetic"], ["harmonic"], ["drag", "uniform"]], ids=" ".join)
def test_frames_about_slanted_axes_are_integrated(others: list[str]) -> None:
    """What drifts along one grows into all components: energies were off by 1e-6 at t = 1e9, with status OK."""
    slanted = vv.RotatingFrame([0.2, 0.1, 0.6], CENTER)
    made = vv.Scene(vv.Particles([MASS], [[1.0, 0.2, 0.3]]), slanted, *(FORCES[name] for name in others))
    assert made.plan(t=10.0).solution == "integration"
    assert scene(["frame", "magnetic"]).plan(t=10.0).solution == "integration"


@pytest.mark.parametrize("t", [1e6, 1e9])
def test_what_falls_along_the_axis_of_a_frame(t: float) -> None:
    upright = vv.Scene(
        vv.Particles([1.0], [[1.0, 0.2, 0.3]]), vv.RotatingFrame([0, 0, 0.6], CENTER), vv.UniformField([0.0, 0.0, -1.0])
    )
    out = upright.run(t=t)
    assert out.plan.solution == FLOW
    assert out.velocity[-1, 0, 2] == -t
    assert out.position[-1, 0, 2] == pytest.approx(0.3 - 0.5 * t**2, rel=1e-16, abs=0.0)


@pytest.mark.parametrize("t", [1e9, 1e12])
def test_energy_is_kept_after_many_turns(t: float) -> None:
    out = scene(["harmonic", "magnetic", "electric", "uniform"]).run(t=[0.0, t])
    assert out.plan.solution == FLOW
    # Roundings of the sums of the energy.
    assert out.energy[1] == pytest.approx(out.energy[0], rel=4e-15, abs=0.0)
