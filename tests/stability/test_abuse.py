"""Conditions nobody should ask for, and what comes out: eccentricity, mass ratios, long times, far origins, odd units.

A tolerance is the measured error with a margin of 2 to 4; where a closed form is measured, it is the conditioning of
the problem times a few roundings, since no algorithm can do better on rounded input.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

EPSILON = 2.0**-53
FINE: dict[str, dict[str, Any]] = {
    "dop853": {"rtol": 1e-12},
    "kahan_li8": {"dt": 50.0},
    "leapfrog": {"dt": 10.0},
    "auto": {},
}


def rounding_at_pericenter(e: float) -> float:
    """Rounding the starting state changes the period: Δa/a = (1+e)/(1-e) · 3ε, and the phase by 3π of that, at a
    speed of √((1+e)/(1-e))."""
    speed = np.sqrt((1 + e) / (1 - e))
    return float(3 * np.pi * (1 + e) / (1 - e) * 3 * EPSILON * speed)


@pytest.mark.parametrize("e", [0.9, 0.99, 0.999, 0.9999, 1 - 1e-6, 1 - 1e-8, 1 - 1e-10])
def test_eccentricity_to_one_closed_form(e: float) -> None:
    """Measured: at most 0.8 of the conditioning."""
    problem = vv.problems.kepler(e=e)
    out = problem.scene.run(t=problem.t_end)
    assert out.stats.steps == out.stats.evaluations == 0
    assert problem.error(out) < 2 * rounding_at_pericenter(e) + 4 * EPSILON


@pytest.mark.parametrize(("e", "bound"), [(0.9, 1e-10), (0.99, 2e-9), (0.999, 6e-8), (0.9999, 2e-6), (1 - 1e-6, 3e-4)])
def test_eccentricity_to_one_integrated(e: float, bound: float) -> None:
    """The error grows with the conditioning, (1-e)^-3/2, and the steps only with the logarithm of 1-e."""
    problem = vv.problems.kepler(e=e)
    out = problem.scene.run(t=problem.t_end, method="dop853", rtol=1e-13)
    assert problem.error(out) < bound
    assert out.stats.steps < 120 * (1 - np.log10(1 - e))


def test_a_radial_ellipse_falls_through_in_closed_form() -> None:
    """e = 1 exactly: two bodies released at rest meet after a quarter of the period, and are back after one."""
    scene = vv.Scene(vv.Particles([1.0, 1.0], [[-1, 0, 0], [1, 0, 0]], np.zeros((2, 3))), vv.Gravity(1.0))
    period = 2 * np.pi  # a = 1, G M = 2: 2π √(a³/GM) with a = half the distance 2, so 2π/√2
    period /= np.sqrt(2.0)
    out = scene.run(t=np.array([period / 4, period]))
    # Nothing goes beyond a start at rest; back to it within the rounding of the period.
    assert np.abs(out.position[-1] - scene.particles.position).max() < 1e-14
    assert np.abs(out.position[0]).max() < 1.0


@pytest.mark.parametrize("ratio", [1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-300, 0.0, 1e15])
def test_mass_ratios(ratio: float) -> None:
    problem = vv.problems.kepler(e=0.5, mass_ratio=ratio)
    assert problem.error(problem.scene.run(t=problem.t_end)) < 5e-14  # measured 1.9e-14
    integrated = problem.scene.run(t=problem.t_end, method="dop853", rtol=1e-13)
    assert problem.error(integrated) < 1e-11  # measured 3.9e-12
    # The light body's pull on the heavy one is there, not rounded away.
    if 1e-15 <= ratio < 1e-2:
        start = problem.scene.particles.velocity
        closed = problem.scene.run(t=1.0)
        heavy = np.linalg.norm(closed.velocity[-1, 0] - start[0])
        light = np.linalg.norm(closed.velocity[-1, 1] - start[1])
        # Both are one number times a mass: measured one unit in the last place. No absolute tolerance, which would
        # pass any ratio this small.
        assert heavy / light == pytest.approx(ratio, rel=1e-15, abs=0.0)


@pytest.mark.parametrize("periods", [1, 1000, 1_000_000])
def test_a_million_orbits_in_closed_form(periods: int) -> None:
    """Within a rounding of the input times its amplification; as cheap as one orbit."""
    problem = vv.problems.kepler(e=0.5, periods=periods)
    out = problem.scene.run(t=problem.t_end)
    ((_, factor),) = problem.conditioning
    assert problem.error(out) < factor * EPSILON  # measured 0.24 of it
    assert out.stats.evaluations == 0


@pytest.mark.parametrize("method", ["dop853", "kahan_li8"])
@pytest.mark.parametrize(("offset", "drift"), [(1e9, 0.0), (0.0, 1e3), (1e9, 1e3)])
def test_far_from_the_origin(method: str, offset: float, drift: float) -> None:
    """What counts is what the offset left of the input: ulp(1e9) = 1.2e-7 of positions, ulp(1e3) t of velocities."""
    scene = vv.problems.outer_solar_system().scene
    bodies = scene.particles
    moved_position = bodies.position + offset
    moved_velocity = bodies.velocity + drift
    moved = vv.Scene(vv.Particles(bodies.mass, moved_position, moved_velocity), *scene.forces)
    # The same rounded input, brought back near the origin exactly.
    near = vv.Scene(vv.Particles(bodies.mass, moved_position - offset, moved_velocity - drift), *scene.forces)
    end = 10_000.0
    there = moved.run(t=end, method=method, **FINE[method]).position[-1]
    here = near.run(t=end, method=method, **FINE[method]).position[-1]
    apart = np.abs((there - there[0]) - (here - here[0])).max()
    # Only the output is rounded: to an ulp of where it is, twice in a difference.
    assert apart <= 2 * np.spacing(offset + drift * end) + 1e-10


@pytest.mark.parametrize("method", list(FINE))
@pytest.mark.parametrize(
    "powers", [(332, 0, 0), (-332, 0, 0), (0, 332, 0), (0, -332, 0), (0, 0, 332), (0, 0, -332), (300, -200, 250)]
)
def test_units_of_1e100_in_powers_of_two_change_no_bit(method: str, powers: tuple[int, int, int]) -> None:
    length, mass, time = (2.0**power for power in powers)
    scene = vv.problems.outer_solar_system().scene
    here = scene.run(t=1e4, method=method, **FINE[method])
    there = scene.rescaled(length=length, mass=mass, time=time).run(
        t=1e4 * time, method=method, **{name: x * time if name == "dt" else x for name, x in FINE[method].items()}
    )
    assert np.array_equal(here.position * length, there.position)
    assert np.array_equal(here.velocity * (length / time), there.velocity)


@pytest.mark.parametrize("method", list(FINE))
@pytest.mark.parametrize(
    "exponents",
    [(100, 0, 0), (-100, 0, 0), (0, 100, 0), (0, 0, 100), (0, 0, -100), (100, 100, 100), (-100, -100, -100)],
)
def test_units_of_1e100_in_decimals(method: str, exponents: tuple[int, int, int]) -> None:
    """To the rounding of the input; adaptive steps that move with it show their tolerance (1e-9 for auto)."""
    length, mass, time = (10.0**exponent for exponent in exponents)
    scene = vv.problems.outer_solar_system().scene
    here = scene.run(t=1e4, method=method, **FINE[method])
    there = scene.rescaled(length=length, mass=mass, time=time).run(
        t=1e4 * time, method=method, **{name: x * time if name == "dt" else x for name, x in FINE[method].items()}
    )
    bound = {"auto": 2e-10, "dop853": 1e-12}.get(method, 1e-13)  # measured 7e-11, 2.3e-13, 2.2e-14
    assert np.abs(there.position / length - here.position).max() < bound


def test_the_pythagorean_problem() -> None:
    """To t = 30, past an approach to 4e-4 with coordinates of order 1: one rounding there, 1e-16 of 4e-4, changes the
    energy of the pair, 2e4, by 5e-9. Tighter tolerances than 1e-11 cannot help, and are not worse than that."""
    problem = vv.problems.pythagorean()
    for rtol in (1e-11, 1e-12, 1e-13):
        out = problem.scene.run(t=30.0, method="dop853", rtol=rtol)
        assert problem.error(out) < 1e-6  # measured at 1e-13: 2.5e-8
        assert out.conservation().energy.max < 1e-7
    early = problem.scene.run(t=10.0, method="dop853", rtol=1e-13)
    assert problem.error(early) < 5e-10  # measured 1.2e-10
