"""The plane pendulum by elliptic functions: swinging, turning, at their border, tilted, and however it is written."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
import sympy

import visviva as vv

THETA, RATE, MOMENTUM = sympy.symbols("theta omega p")


def pendulum(position: float, velocity: float, cosine: float = 1.0, sine: float = 0.0) -> vv.Lagrangian:
    """θ″ = −cosine · sin θ + sine · cos θ."""
    function = RATE**2 / 2 + cosine * sympy.cos(THETA) + sine * sympy.sin(THETA)
    return vv.Lagrangian(function, [THETA], velocities=[RATE], position=[position], velocity=[velocity])


def swing(amplitude: float, t: float) -> float:
    """From rest, with 50 digits: sin(θ/2) = k cd(t) (NIST DLMF 22.19(i))."""
    with mpmath.workdps(50):
        k = mpmath.sin(mpmath.mpf(amplitude) / 2)
        return float(2 * mpmath.asin(k * mpmath.ellipfun("cd", mpmath.mpf(t), k=k)))


def turn(rate: float, t: float) -> float:
    """From the lowest point, over the top: θ/2 is the amplitude of ω t/2 for k = 2/ω, with 50 digits."""
    with mpmath.workdps(50):
        k = 2 / mpmath.mpf(rate)
        argument = mpmath.mpf(rate) * mpmath.mpf(t) / 2
        quarter = mpmath.ellipk(k**2)
        half_turns = mpmath.nint(argument / (2 * quarter))
        rest = argument - 2 * quarter * half_turns
        return float(2 * (mpmath.asin(mpmath.ellipfun("sn", rest, k=k)) + mpmath.pi * half_turns))


@pytest.mark.parametrize("amplitude", [1e-8, 0.3, 1.5, 3.0, 3.1415])
def test_a_swing_is_that_of_fifty_digits(amplitude: float) -> None:
    t = np.array([0.0, 0.1, 1.0, 7.77, 100.0, 12345.678])
    out = pendulum(amplitude, 0.0).run(t=t)
    assert out.method == "elliptic_functions"
    assert out.steps == 0
    # Units in the last place of an angle, by the rounding of the argument of one period; that of the longest is 24.
    for found, at in zip(out["theta"], t, strict=True):
        assert found == pytest.approx(swing(amplitude, float(at)), rel=0.0, abs=3e-14 * amplitude)


@pytest.mark.parametrize("rate", [2.0000001, 2.5, 40.0, -3.0])
def test_a_turn_is_that_of_fifty_digits(rate: float) -> None:
    t = np.array([1e-9, 0.4, 2.0, 33.0, 1000.5])
    out = pendulum(0.0, rate).run(t=t)
    expected = [turn(rate, float(at)) for at in t]
    # A part of the angle, and of a turn that is passed by what the rounding of its argument makes; slow turns take 19.
    np.testing.assert_allclose(out["theta"], expected, rtol=1e-15, atol=1e-13)
    backward = pendulum(0.0, rate).run(t=-t)
    np.testing.assert_allclose(backward["theta"], -np.array(expected), rtol=1e-15, atol=1e-13)


def test_at_the_border_it_comes_to_the_top() -> None:
    """θ = 4 arctan(e^t) − π, from the lowest point with a rate of 2."""
    t = np.array([-3.0, 0.5, 2.0, 10.0])
    for end in (t[1:], t[:1]):
        out = pendulum(0.0, 2.0).run(t=end)
        # What is left to the top falls as e^−t, and rates with it.
        np.testing.assert_allclose(out["theta"], 4 * np.arctan(np.exp(end)) - np.pi, rtol=0.0, atol=1e-15)
        np.testing.assert_allclose(out.velocity[:, 0], 2 / np.cosh(end), rtol=1e-14, atol=0.0)


def test_what_is_at_rest_stays() -> None:
    for cosine in (1.0, -1.0):
        # Where the sign is other, the lowest point is at π, and zero is the top: unstable, but exact.
        out = pendulum(0.0, 0.0, cosine).run(t=[1.0, 1e6])
        assert out["theta"].tolist() == [0.0, 0.0]
        assert out.velocity.tolist() == [[0.0], [0.0]]


def test_without_gravity_it_turns_evenly() -> None:
    free = vv.systems.pendulum(position=[1.0], velocity=[0.5], g=0.0).run(t=[8.0])
    assert free["theta"].tolist() == [5.0]


def test_what_nothing_pulls_passes_its_events() -> None:
    """Evenly, however often it turns."""
    free = vv.systems.pendulum(position=[0.0], velocity=[3.0], g=0.0)
    out = free.run(20.0, events=[vv.events.coordinate("theta", value=30.0), lambda q, v, t, **_: np.cos(q[0])])
    assert out.events.which.tolist().count(0) == 1
    # cos θ vanishes at odd quarters of a turn: 60/π times, rounded.
    assert out.events.which.tolist().count(1) == round(60.0 / np.pi)


def test_a_momentum_that_moves_nothing_grows() -> None:
    """With no kinetic energy the angle stands, and the torque stays."""
    a = sympy.Symbol("a")
    still = vv.Hamiltonian(
        a * MOMENTUM**2 / 2 - sympy.cos(THETA), q=[THETA], p=[MOMENTUM], position=[0.5], momentum=[0.25],
        parameters={"a": 0.0},
    )  # fmt: skip
    out = still.run(t=[2.0])
    assert out.method == "elliptic_functions"
    assert out["theta"].tolist() == [0.5]
    assert out.momentum[-1, 0] == pytest.approx(0.25 - 2.0 * np.sin(0.5), rel=1e-15, abs=0.0)


@pytest.mark.parametrize(("cosine", "sine"), [(0.6, 0.8), (-0.6, 0.8), (-0.3, -1.1), (0.0, 1.0)])
def test_a_tilted_one_is_another_by_its_angle(cosine: float, sine: float) -> None:
    tilt, strength = np.arctan2(sine, cosine), np.hypot(cosine, sine)
    t = np.linspace(0.3, 30.0, 50)
    for position, velocity in ((0.4, 0.3), (2.0, -3.1), (-9.0, 0.1)):
        tilted = pendulum(position, velocity, cosine, sine).run(t=t)
        plain = pendulum(position - tilt, velocity / np.sqrt(strength)).run(t=t * np.sqrt(strength))
        # Starts and times are rounded, which swings keep and multiply by the time.
        np.testing.assert_allclose(tilted["theta"], plain["theta"] + tilt, rtol=0.0, atol=1e-13)


def test_random_starts_are_those_of_gauss() -> None:
    rng = np.random.default_rng(5)
    t = np.linspace(0.0, 12.0, 40)
    for _ in range(30):
        system = pendulum(rng.uniform(-9.0, 9.0), rng.normal(0.0, 1.8), rng.normal(), rng.normal())
        exact, stepped = system.run(t=t), system.run(t=t, method="gauss16")
        assert stepped.method == "gauss16"
        # Beside the top errors of starts, and those of gauss16 of 1e-15 in each step, grow as e^t, by 1e5.
        np.testing.assert_allclose(exact.position, stepped.position, rtol=0.0, atol=2e-10)
        np.testing.assert_allclose(exact.velocity, stepped.velocity, rtol=0.0, atol=2e-10)


def test_a_hamiltonian_moves_as_its_lagrangian() -> None:
    """Of mass 3 and length 2: p = m l² ω."""
    function = MOMENTUM**2 / (2 * 3 * 4) - 3 * 9.81 * 2 * sympy.cos(THETA)
    t = np.linspace(0.0, 5.0, 11)
    for position, velocity in ((2.5, 1.0), (0.1, 6.0)):
        of_momenta = vv.Hamiltonian(function, q=[THETA], p=[MOMENTUM], position=[position], momentum=[12 * velocity])
        of_rates = vv.systems.pendulum(position=[position], velocity=[velocity], m=3.0, l=2.0)
        out, other = of_momenta.run(t=t), of_rates.run(t=t)
        assert out.method == other.method == "elliptic_functions"
        # Rounded by other products.
        np.testing.assert_allclose(out.position, other.position, rtol=1e-13, atol=1e-14)
        np.testing.assert_allclose(out.momentum, 12 * other.velocity, rtol=1e-13, atol=1e-12)


def test_energies_stay_and_runs_join() -> None:
    system = pendulum(2.9, 0.2)
    out = system.run(t=np.linspace(0.0, 1e4, 777))
    # Energies of order 1, summed of rounded sines and squares.
    assert np.abs(out.energy - out.energy[0]).max() < 2e-15
    middle = system.run(41.5)
    later = pendulum(*middle.position[-1], *middle.velocity[-1]).run(58.5)
    # A start that is rounded, after nine swings.
    assert later["theta"][-1] == pytest.approx(system.run(100.0)["theta"][-1], rel=0.0, abs=1e-13)


def test_copies_are_as_alone_with_parameters_of_their_own() -> None:
    system = vv.systems.pendulum(position=[1.0])
    lengths, positions = np.linspace(0.5, 2.0, 7), np.linspace(-3.0, 3.0, 7)[:, None]
    t = np.linspace(0.0, 20.0, 9)
    many = system.ensemble(position=positions, parameters={"l": lengths}).run(t=t, threads=2)
    for index, length in enumerate(lengths):
        alone = vv.systems.pendulum(position=positions[index], l=length).run(t=t)
        np.testing.assert_array_equal(many.position[index], alone.position)


def test_events_are_where_the_period_says() -> None:
    """It passes the lowest point at odd quarters, and comes to rest at even ones."""
    system = pendulum(2.0, 0.0)
    quarter = float(mpmath.ellipk(mpmath.sin(1.0) ** 2))
    out = system.run(40.0, events=["theta", vv.events.coordinate("theta", value=2 * np.pi)])
    expected = quarter * np.arange(1, 40.0 / quarter, 2)
    # Times are found to round-off of the angle, which passes with a rate of 1.7.
    np.testing.assert_allclose(out.events.t, expected, rtol=1e-14, atol=0.0)
    stopped = system.run(40.0, events=[vv.events.coordinate("theta", terminal=True)])
    assert stopped.status is vv.Status.STOPPED
    assert stopped.t[-1] == pytest.approx(quarter, rel=1e-14, abs=0.0)


def test_a_period_of_a_run_is_that_of_quadrature() -> None:
    system = vv.systems.pendulum(position=[3.0])
    period = system.period()
    out = system.run(period)
    # The period is as good as its last digits, and the turn is stationary there.
    assert out["theta"][-1] == pytest.approx(3.0, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(
    "function",
    [
        RATE**2 / 2 + sympy.cos(2 * THETA),
        RATE**2 / 2 + sympy.cos(THETA) - THETA**2 / 10,
        RATE**2 / 2 * (1 + sympy.cos(THETA) ** 2) + sympy.cos(THETA),
        RATE**2 / 2 + sympy.cos(THETA) * sympy.cos(sympy.Symbol("t")),
    ],
)
def test_others_are_not_taken_for_one(function: sympy.Expr) -> None:
    system = vv.Lagrangian(function, [THETA], velocities=[RATE], position=[1.0], velocity=[0.0])
    assert system.plan(t=1.0).method == "gauss16"
    with pytest.raises(vv.InvalidInput, match="elliptic_functions needs the equation of a pendulum"):
        system.run(1.0, method="elliptic_functions")


def test_a_damped_one_is_stepped_and_a_step_is_taken() -> None:
    damped = vv.Lagrangian(
        RATE**2 / 2 + sympy.cos(THETA), [THETA], velocities=[RATE], position=[1.0], velocity=[0.0],
        dissipation=RATE**2 / 20,
    )  # fmt: skip
    assert damped.plan(t=1.0).method == "gauss16"
    assert pendulum(1.0, 0.0).plan(t=1.0, dt=0.1).method == "gauss16"
    with pytest.raises(vv.InvalidInput, match="takes no steps"):
        pendulum(1.0, 0.0).run(1.0, method="elliptic_functions", dt=0.1)
