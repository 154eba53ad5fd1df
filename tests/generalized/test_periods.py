"""Periods where the integrand is not smooth, has narrow features or great range, and in units of any size.

Bounds: quadratures to some EPSILON, of powers and functions those that their exponents and arguments round away.
"""

from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp

import visviva as vv

x = vv.coordinate("x")
EPSILON = 2.0**-52


def moving(potential: Any, place: float, speed: float = 0.0) -> vv.Lagrangian:
    return vv.Lagrangian(x.diff(vv.time) ** 2 / 2 - potential, [x], position=[place], velocity=[speed])


@pytest.mark.parametrize("place", [1e-100, 1e-20, 1e-10, 1e10])
def test_a_small_swing_is_none_the_less_one(place: float) -> None:
    """Nothing is measured against 1: 8 ε as for a swing of 1."""
    assert vv.systems.oscillator(k=1.0, m=1.0, position=[place]).period() == pytest.approx(
        2 * np.pi, rel=8 * EPSILON, abs=0
    )
    if place < 1.0:
        pushed = vv.systems.oscillator(k=1.0, m=1.0, position=[0.0], velocity=[place])
        assert pushed.period() == pytest.approx(2 * np.pi, rel=8 * EPSILON, abs=0)
        assert vv.systems.pendulum(g=1.0, position=[place]).period() == pytest.approx(2 * np.pi, rel=8 * EPSILON, abs=0)


def test_the_period_of_a_quartic_in_other_units() -> None:
    """x⁴/4 from 1, and with lengths of 1e-30."""
    wanted = moving(x**4 / 4, 1.0).period()
    assert wanted == pytest.approx(float(4 * mpmath.sqrt(2) * mpmath.ellipk(-1)), rel=1e-14, abs=0)
    assert moving(x**4 / 4 * sp.Float(1e60), 1e-30).period() == pytest.approx(wanted, rel=1e-14, abs=0)


@pytest.mark.parametrize(
    ("potential", "place"),
    [(x**2 / 2, 0.0), (sp.cos(x), 0.0), (x**4 / 4 - x**2 / 2, 1.0), (-sp.cos(x - 0.7), 0.7), (sp.cos(x), np.pi)],
)
def test_what_stands_still_is_refused_as_that(potential: Any, place: float) -> None:
    with pytest.raises(vv.InvalidInput, match="stands still"):
        moving(potential, place).period()


#: Potential, start, speed, period and how exactly it is known.
HARD: list[tuple[Any, float, float, float, float]] = [
    # 4 √(2 x₀); with slopes 3/2 and −1/2 the ends are 2 and −6, and times 2 √(2 V) / slope.
    (sp.Abs(x), 2.0, 0.0, 8.0, 4 * EPSILON),
    (sp.Abs(x) + x / 2, 2.0, 0.0, float(2 * np.sqrt(6.0) * (1 / 1.5 + 1 / 0.5)), 8 * EPSILON),
    # Where x + 0.3 is 0, its slope is 0/0.
    (sp.Abs(x + sp.Float(0.3)), 1.7, 0.0, 8.0, 4 * EPSILON),
    # 2π cos x₀: what the last digit of x₀ is of its distance from the wall.
    (sp.tan(x) ** 2 / 2, 1.5, 0.0, 2 * np.pi * np.cos(1.5), 32 * EPSILON),
    (sp.tan(x) ** 2 / 2, 1.5707, 0.0, 2 * np.pi * np.cos(1.5707), 2e4 * EPSILON),
    # Small oscillations about x = 1, whose last digit is 2e-9 of them.
    (x**4 / 4 - x**2 / 2, 1.0 + 1e-7, 0.0, 4.4428829381584, 2e-9),
    # √(2/A) π / √(1 − E/D) of Morse with D = 1.
    ((1 - sp.exp(-x)) ** 2, 0.0, 1.4, float(np.pi * np.sqrt(2) / np.sqrt(1 - 0.98)), 50 * 8 * EPSILON),
    # Kepler's third law, 2π / (−2E)^(3/2), from 5e-7 to 1.9.
    (-1 / x + 0.5e-6 / x**2, 1.9, 0.0, float(2 * np.pi * (2 * (1 / 1.9 - 0.5e-6 / 1.9**2)) ** -1.5), 16 * EPSILON),
    # From the top of a barrier with a push of 1e-6, by mpmath's quadrature of 30 digits.
    (x**4 / 4 - x**2 / 2, 0.0, 1e-6, 62.193514037435726, 8 * EPSILON),
    # What is narrow: by Gauss's quadrature of 60 digits between places where it is divided.
    (x**2 / 2 + 0.4 * sp.exp(-1e5 * x**2), 1.0, 0.0, 6.2925782503411, 1e-14),
    (
        x**2 / 2 + sp.Float(0.3) * sp.exp(-1e8 * (x - sp.Rational(37, 100)) ** 2),
        1.0,
        0.0,
        6.2834191922034287,
        16 * EPSILON,
    ),
    (x**2 / 2 + x**1000, 1.0, 0.0, 2.4658330655769355, 1000 * EPSILON),
]


@pytest.mark.parametrize(("potential", "place", "speed", "wanted", "exactly"), HARD)
def test_kinks_narrow_features_and_great_range(
    potential: Any, place: float, speed: float, wanted: float, exactly: float
) -> None:
    found = moving(potential, place, speed)
    assert found.period() == pytest.approx(wanted, rel=exactly, abs=0)
    if not potential.has(sp.exp):
        # As long as it says, the motion comes back: to first order in what the run has lost in time.
        out = found.run(found.period(), method="dop853", rtol=1e-13)
        assert out.position[-1, 0] == pytest.approx(place, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("power", [4, 10, 32, 34, 100, 1000, 5000])
def test_periods_of_powers(power: int) -> None:
    """2 √(2π) Γ(1 + 1/n) / Γ(1/2 + 1/n) of xⁿ from 1, where the last digit of x is n times that of the energy."""
    with mpmath.workdps(30):
        wanted = 2 * mpmath.sqrt(2 * mpmath.pi) * mpmath.gamma(1 + 1 / mpmath.mpf(power))
        wanted /= mpmath.gamma(0.5 + 1 / mpmath.mpf(power))
    assert moving(x**power, 1.0).period() == pytest.approx(float(wanted), rel=(4 + power / 16) * EPSILON, abs=0)


def test_a_thin_barrier_holds_the_motion() -> None:
    """x²/2 and a wall at 0.5, 1e-4 wide: the motion turns at it (and passes one that is too low)."""
    wall = sp.exp(-1e8 * (x - 0.5) ** 2)
    held = moving(x**2 / 2 + wall, -0.8)
    # As an arc of the oscillation that ends at 0.4998, but for what the foot of the wall takes.
    arc = 2 * (np.arcsin(0.4998 / 0.8) + np.pi / 2)
    assert held.period() == pytest.approx(arc, rel=1e-4, abs=0)
    assert moving(x**2 / 2 + 0.1 * wall, -0.8).period() == pytest.approx(2 * np.pi, rel=1e-3, abs=0)


def test_what_is_infinite_is_refused_by_its_name() -> None:
    with pytest.raises(vv.InvalidInput, match="separatrix"):
        moving(x**4 / 4 - x**2 / 2, float(np.sqrt(2))).period()
    with pytest.raises(vv.InvalidInput, match="no finite number"):
        moving(-1 / x, 1.0).period()
    with pytest.raises(vv.InvalidInput, match="does not turn back"):
        moving((1 - sp.exp(-x)) ** 2, 0.0, 1.5).period()
    with pytest.raises(vv.InvalidInput, match="separatrix"):
        moving(-sp.cos(x), 0.0, 2.0).period(turn=2 * np.pi)


@pytest.mark.parametrize("amplitude", [0.01, 1.0, 20.0])
def test_a_relativistic_oscillator_by_its_lagrangian(amplitude: float) -> None:
    """−√(1 − v²) − x²/2: at x = a sin s the rapidity has cosh − 1 = u = a² cos² s / 2."""

    def integral(integrand: Any) -> float:
        def at(s: Any) -> Any:
            return integrand(s, (amplitude * mpmath.cos(s)) ** 2 / 2)

        parts = [mpmath.pi / 2 * (1 - mpmath.mpf(2) ** -k) for k in range(16)] + [mpmath.pi / 2]
        return float(4 * mpmath.quad(at, parts))

    found = vv.Lagrangian(-sp.sqrt(1 - x.diff(vv.time) ** 2) - x**2 / 2, [x], position=[amplitude], velocity=[0.0])
    period = integral(lambda s, u: mpmath.sqrt(2) * (1 + u) / mpmath.sqrt(u + 2))
    area = integral(lambda s, u: amplitude * mpmath.cos(s) * mpmath.sqrt(u * (u + 2)))
    assert found.period() == pytest.approx(period, rel=1e-12, abs=0.0)
    assert found.action_variable() == pytest.approx(area / (2 * np.pi), rel=1e-12, abs=0.0)


def test_what_has_no_period_beyond_quadratic_velocities_is_refused() -> None:
    free = vv.Lagrangian(-sp.sqrt(1 - x.diff(vv.time) ** 2), [x], position=[0.0], velocity=[0.5])
    with pytest.raises(vv.InvalidInput, match="does not come back"):
        free.period()
    rotating = vv.Lagrangian(-sp.sqrt(1 - x.diff(vv.time) ** 2) + sp.cos(x) / 10, [x], position=[0.0], velocity=[0.8])
    with pytest.raises(vv.InvalidInput, match="turn"):
        rotating.period()
    energy = 1 / 0.6 - 0.1
    parts = mpmath.linspace(0, 2 * mpmath.pi, 9)
    period = mpmath.quad(lambda q: 1 / mpmath.sqrt(1 - (energy + mpmath.cos(q) / 10) ** -2), parts)
    assert rotating.period(turn=2 * np.pi) == pytest.approx(float(period), rel=1e-12, abs=0.0)
    with pytest.raises(vv.InvalidInput, match="energy does not repeat"):
        rotating.period(turn=3.0)


def test_a_fast_relativistic_oscillator() -> None:
    """L = −√(1 − v²) − x²/2 from x = 100: at nearly the speed of light but for its turns, of ten thousand steps each.

    T = 4 ∫ E dx/√(E² − 1) with E = 1 + (A² − x²)/2, by quadrature to 15 digits.
    """
    fast = vv.Lagrangian(lambda q, v, t: -np.sqrt(1.0 - v[0] ** 2) - q[0] ** 2 / 2.0, ["x"], position=[100.0])
    assert fast.period() == pytest.approx(400.040016188414, rel=1e-10, abs=0)


def test_a_period_of_too_many_steps_says_what_tells_it() -> None:
    """From x = 300 the turns take 2e5 steps; `period` has no argument for them, and what it names instead does tell it.

    T as above. At nearly the speed of light an ε of v is γ² ε of 1 − v², with γ = 4.5e4; the momentum of H loses
    nothing, and its 1e3 steps add up to 1e-12.
    """
    wanted, start = 1200.013334095816, [300.0]
    fast = vv.Lagrangian(lambda q, v, t: -np.sqrt(1.0 - v[0] ** 2) - q[0] ** 2 / 2.0, ["x"], position=start)
    for asked in (fast.period, fast.action_variable):
        with pytest.raises(vv.InvalidInput, match="in 100000 steps, until") as caught:
            asked()
        message = str(caught.value)
        assert "max_steps" not in message
        assert "run(t, events=[vv.events.coordinate('x', place, direction=1)])" in message
        assert "the same motion takes far fewer as a Hamiltonian" in message
    passing = vv.events.coordinate("x", 0.0, direction=1)
    times = fast.run(2200.0, events=[passing]).events.t
    assert times[1] - times[0] == pytest.approx(wanted, rel=4.5e4**2 * EPSILON, abs=0)
    slow = vv.Hamiltonian(lambda q, p, t: np.sqrt(1.0 + p[0] ** 2) + q[0] ** 2 / 2.0, ["x"], position=start)
    assert slow.period() == pytest.approx(wanted, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("amplitude", "bound"),
    # What the last digit of a place is of its distance from the top, in the logarithm that the period is.
    [(3.1, 4e-16), (3.14, 1e-14), (3.1415, 1e-14), (3.14159, 1e-12), (3.1415926, 1e-10), (3.1415926535, 1e-7)],
)
def test_a_pendulum_thrown_from_near_the_top(amplitude: float, bound: float) -> None:
    """It turns at the opposite place whatever its energy is: elliptic integrals of the amplitude that is given."""
    with mpmath.workdps(50):
        k = mpmath.sin(mpmath.mpf(amplitude) / 2)
        period = 4 * mpmath.ellipk(k**2)
        action = 8 / mpmath.pi * (mpmath.ellipe(k**2) - (1 - k**2) * mpmath.ellipk(k**2))
    for start in (amplitude, -amplitude):
        pendulum = vv.systems.pendulum(g=1.0, position=[start])
        assert pendulum.period() == pytest.approx(float(period), rel=bound, abs=0)
        assert pendulum.action_variable() == pytest.approx(float(action), rel=4 * EPSILON, abs=0)


def test_a_place_whose_last_digits_are_its_distance_from_the_top_is_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="the last digit of its place changes its period by a part of"):
        vv.systems.pendulum(g=1.0, position=[3.14159265358979]).period()


@pytest.mark.parametrize("start", [1.2, 1.414, 1.4143, 1.5, 3.0])
def test_two_wells_that_are_opposite(start: float) -> None:
    """Within one of them nothing is opposite; over both, a quarter tells the rest."""
    with mpmath.workdps(40):
        far, energy = mpmath.mpf(start), (mpmath.mpf(start) ** 2 - 1) ** 2
        over = energy > 1
        near = -far if over else mpmath.sqrt(1 - mpmath.sqrt(energy))
        # 2 (E − V) = 2 (far² − x²)(x² − other), of which (far − x)(x − near) goes with x = center + half sin s.
        other = 2 - far**2
        center, half = (far + near) / 2, (far - near) / 2

        def rate(s: Any) -> Any:
            x = center + half * mpmath.sin(s)
            return 1 / mpmath.sqrt(2 * (x**2 - other if over else (far + x) * (x + near)))

        period = 2 * mpmath.quad(rate, mpmath.linspace(-mpmath.pi / 2, mpmath.pi / 2, 40))
    assert moving((x**2 - 1) ** 2, start).period() == pytest.approx(float(period), rel=1e-11, abs=0)


def test_what_moves_at_the_start_is_not_turned_there() -> None:
    """Even, too, but its amplitude is not the start; and one about another place than zero."""
    fast = vv.systems.pendulum(g=1.0, position=[1.0], velocity=[0.5])
    amplitude = float(np.arccos(np.cos(1.0) - 0.125))
    assert fast.period() == pytest.approx(vv.systems.pendulum(g=1.0, position=[amplitude]).period(), rel=1e-14, abs=0)
    shifted = moving(-sp.cos(x - sp.Float(0.25)), 1.25)
    assert shifted.period() == pytest.approx(vv.systems.pendulum(g=1.0, position=[1.0]).period(), rel=1e-14, abs=0)
