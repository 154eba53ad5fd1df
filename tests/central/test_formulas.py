"""Motion in the potential of a formula: as exact as in a potential that is built in, at circles and beside them, too.

What decides there is the difference of an energy and of two near it, which has no digits in float64: formulas are
evaluated to thirty digits.
"""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv
from visviva.potentials import Coulomb, Custom, LennardJones, PowerLaw, Yukawa

KEPLER = Custom(lambda r: -1.0 / r)
# The period follows from the energy, whose rounding it shares, by 3/2, and is rounded itself.
ROUNDING = 1e-15


@pytest.mark.parametrize("radius", np.geomspace(0.01, 100.0, 12))
def test_circles(radius: float) -> None:
    orbit = vv.orbits.central_orbit(KEPLER, position=[radius, 0.0, 0.0], velocity=[0.0, radius**-0.5, 0.0])
    assert orbit.radial_period == pytest.approx(2.0 * np.pi * radius**1.5, rel=1e-13, abs=0.0)


def test_eccentricities_from_a_thousandth() -> None:
    """Of energy −1/2 all periods are 2π, and no ellipse precesses."""
    eccentricity = np.geomspace(1e-3, 0.3, 300)
    momentum = np.sqrt((1.0 - eccentricity) * (1.0 + eccentricity))
    found = vv.orbits.radial_motion(KEPLER, energy=-0.5, angular_momentum=momentum)
    assert set(found.kind) == {"bound"}
    np.testing.assert_allclose(found.radial_period, 2.0 * np.pi, rtol=ROUNDING, atol=0.0)
    np.testing.assert_allclose(found.apsidal_angle, np.pi, rtol=ROUNDING, atol=0.0)
    # 1 − e is what is left of l², rounded by half a unit: by 1e-16/e.
    np.testing.assert_allclose(found.r_min, 1.0 - eccentricity, rtol=3e-13, atol=0.0)


@pytest.mark.parametrize(
    ("formula", "built_in", "energy", "momentum"),
    [
        (Custom(lambda r: 4.0 * (r**-12 - r**-6)), LennardJones(1.0, 1.0), -0.9999, 0.01),
        (Custom(lambda r: -np.exp(-r / 5.0) / r), Yukawa(-1.0, length=5.0), -0.3258, 0.95),
        (Custom(lambda r: -0.3 * r**-0.7), PowerLaw(-0.3, 0.7), -0.17, 0.4),
        ([Coulomb(-1.0), Custom(lambda r: -0.05 / r**2)], [Coulomb(-1.0), PowerLaw(-0.05, 2.0)], -0.5549, 1.0),
        ([Coulomb(-1.0), Custom(lambda r: 1e-3 / r**3)], [Coulomb(-1.0), PowerLaw(1e-3, 3.0)], -0.498, 1.0),
    ],
)
def test_formulas_are_as_good_as_what_is_built_in(
    formula: vv.potentials.Potential | list[vv.potentials.Potential],
    built_in: vv.potentials.Potential | list[vv.potentials.Potential],
    energy: float,
    momentum: float,
) -> None:
    found, known = (
        vv.orbits.radial_motion(potential, energy=energy, angular_momentum=momentum)
        for potential in (formula, built_in)
    )
    assert found.kind == known.kind == "bound"
    # Constants of the formulas are rounded elsewhere: by a unit of the energy's last place, which near a circle is more
    # of the little that is left of it.
    assert found.radial_period == pytest.approx(known.radial_period, rel=1e-13, abs=0.0)
    assert found.apsidal_angle == pytest.approx(known.apsidal_angle, rel=1e-13, abs=0.0)
    assert found.r_max - found.r_min == pytest.approx(known.r_max - known.r_min, rel=1e-10, abs=0.0)


@pytest.mark.parametrize("function", ["sin", "cos", "tanh", "sinh", "arctan", "tan", "arcsinh", "sqrt"])
def test_near_circles_of_any_function(function: str) -> None:
    """Small swings about a circle have the period 2π/ω, ω² = V″ + 3l²/r⁴ of m = 1, but for a part of their square."""
    well = Custom(lambda r: getattr(np, function)(0.2 * r) + 0.5 * r * r)
    radius = 1.3
    force, h = float(well.force(radius)), 1e-3
    momentum = np.sqrt(-force * radius**3)
    bend = (well.force(radius - h) - well.force(radius + h)) / (2.0 * h)
    frequency = np.sqrt(float(bend) + 3.0 * momentum**2 / radius**4)
    bottom = float(well.value(radius)) + 0.5 * momentum**2 / radius**2
    size = 1e-5
    found = vv.orbits.radial_motion(well, energy=bottom + 0.5 * (frequency * size) ** 2, angular_momentum=momentum)
    # The difference quotient is good to h², and the amplitude, of an energy rounded by 2e-16, to 2e-6 of itself.
    assert found.radial_period == pytest.approx(2.0 * np.pi / frequency, rel=1e-6, abs=0.0)
    assert found.r_max - found.r_min == pytest.approx(2.0 * size, rel=1e-4, abs=0.0)
    assert found.period_error < 1e-12


@pytest.mark.parametrize(
    ("potential", "energy", "momentum", "expected"),
    [
        (Custom(lambda r: np.sqrt(1.0 + r * r)), 1.2, 0.1, (0.163649747525196, 0.641051639819978)),
        (Custom(lambda r: np.sqrt(1e4 + r * r) - 100.0), 1.0, 0.1, (0.0707115620406929, 14.177269659542063)),
        (Custom(lambda r: r * r / (4.0 + r * r)), 0.5, 0.1, (0.100251575913027, 1.994981108062669)),
        (
            [Custom(lambda r: 0.5 * np.log(1.0 + r * r)), Coulomb(-1.0)],
            0.2,
            0.5,
            (0.122127388919097, 1.792329976023923),
        ),
        ([Custom(lambda r: 0.2 * np.sin(r) / r), Coulomb(-1.0)], -0.3, 0.5, (0.133962211542551, 3.339962087973768)),
        (Custom(lambda r: np.cbrt(1.0 + r * r)), 1.2, 0.1, (0.1616416441903399, 0.8349873570262202)),
    ],
)
def test_what_cancels_or_leaves_the_range_far_out_is_no_feature(
    potential: vv.potentials.Potential | list[vv.potentials.Potential],
    energy: float,
    momentum: float,
    expected: tuple[float, float],
) -> None:
    """Far out a second derivative like 1/r − r²/r³ is rounding, and (1 + r²)² leaves the range: its signs are no places
    by which to scale. At the turning points the energy is that of the effective potential."""
    (found,) = vv.orbits.range_of_motion(potential, energy=energy, angular_momentum=momentum)
    assert found.kind == "bound"
    assert (found.r_min, found.r_max) == pytest.approx(expected, rel=1e-12, abs=0.0)
    at = vv.orbits.effective_potential(potential, [found.r_min, found.r_max], angular_momentum=momentum)
    np.testing.assert_allclose(at, energy, rtol=0.0, atol=2e-14)


@pytest.mark.parametrize(
    ("potential", "energy", "momentum", "expected"),
    [
        # Beside the height to which it rises, so that Newton's steps end in rounding before they end.
        (
            Custom(lambda r: 0.025228368098082918 * np.arctan(r * (1.0 / 0.10020258711828287))),
            0.03960422075769023,
            0.32487905515826887,
            ("bound", 28.990514842583803, 74.58357597249886),
        ),
        (
            Custom(lambda r: -0.24369327333160326 * np.exp(-0.014577159623154538 / (1.0 + r))),
            -0.24262455357449036,
            0.00105880961032366,
            ("escapes", 2.316966558828138, np.inf),
        ),
        # √(1 + r²) − r = 1/2r far out: roots of E r² ∓ r/2 − l²/2, but for a part of 1e-20.
        (Custom(lambda r: np.sqrt(1.0 + r * r) - r), 1e-10, 1.0, ("escapes", 5000000001.0, np.inf)),
        (Custom(lambda r: r - np.sqrt(1.0 + r * r)), -1e-10, 1.0, ("bound", 1.1601162680405868, 4999999999.0)),
        # ln(1 + r) − ln r.
        (Custom(lambda r: np.log(1.0 + r) - np.log(r)), 1e-12, 1.0, ("escapes", 1e12, np.inf)),
        # Hyperbolic functions that leave the range of numbers, and what is large only within.
        (Custom(lambda r: -4.0 / np.cosh(r) ** 2), 1e-12, 1e-2, ("escapes", 1e-2 / np.sqrt(2e-12), np.inf)),
        (
            Custom(lambda r, a: a * np.exp(-(r**2)) - 1.0 / r, parameters={"a": 1e100}),
            -0.01,
            0.1,
            ("bound", 15.26926421097165, 99.994999749975),
        ),
        (Custom(lambda r: -1.0 / (1.0 + r**200)), 1e-9, 1.0, ("escapes", 1.0 / np.sqrt(2e-9), np.inf)),
        (Custom(lambda r: -4.0 / np.sqrt(np.cosh(r))), 1e-9, 1.0, ("escapes", 1.0 / np.sqrt(2e-9), np.inf)),
        # An exponential that leaves it.
        (Custom(lambda r: -1.0 / (1.0 + np.exp(r - 5.0))), 1e-12, 1e3, ("escapes", 1e9 / np.sqrt(2.0), np.inf)),
    ],
)
def test_what_is_left_of_near_values_turns_where_it_should(
    potential: vv.potentials.Potential, energy: float, momentum: float, expected: tuple[str, float, float]
) -> None:
    """Far out a formula may be the difference of near numbers: it is told to more digits there, or not at all."""
    found = vv.orbits.range_of_motion(potential, energy=energy, angular_momentum=momentum)[-1]
    assert found.kind == expected[0]
    # A difference of numbers like 5e9 has in thirty digits ten or more left.
    assert (found.r_min, found.r_max) == pytest.approx(expected[1:], rel=1e-12, abs=0.0)
