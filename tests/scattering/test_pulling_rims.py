"""Potentials that end where they still attract, as the truncated and shifted one of molecular dynamics does.

At energies below r_c V'(r_c)/2 the effective barrier of the way in has no top but the rim itself, on which nothing
stays: what comes within the rim is drawn in, turns at the core and leaves, and nothing is captured.
"""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv

s = vv.scattering
V = vv.potentials
LENNARD_JONES = V.LennardJones(1.0, 1.0)
RIM = 3.0
_SHIFT = float(LENNARD_JONES.value(RIM))
_DISTANCES = np.linspace(0.5, RIM, 401)
TABLE = V.Tabulated(_DISTANCES, LENNARD_JONES.value(_DISTANCES) - _SHIFT)
SAMPLED = V.Custom(lambda r: LENNARD_JONES.value(r) - _SHIFT, r_min=0.5, r_max=RIM)
#: r_c V'(r_c)/2 = 0.0164.
BELOW = [0.001, 0.01, 0.016]


def quadrature(potential: vv.potentials.Potential, energy: float, b: float) -> float:
    """π − 2b ∫ dr/(r² √G) − 2 asin(b/r_c), by Gauss and Legendre in the root of r − r₀."""
    low, high = 0.6, 1.3
    for _ in range(80):
        middle = 0.5 * (low + high)
        inside = 1.0 - (b / middle) ** 2 - float(potential.value(middle)) / energy < 0.0
        low, high = (middle, high) if inside else (low, middle)
    x, weight = np.polynomial.legendre.leggauss(20)
    panels = 200
    share = ((np.arange(panels)[:, None] + 0.5 * (1.0 + x)) / panels).ravel()
    weight = np.tile(weight / panels, panels)
    r = high + (RIM - high) * share**2
    rest = 1.0 - (b / r) ** 2 - potential.value(r) / energy
    integral = float(np.sum(0.5 * weight * 2.0 * (RIM - high) * share / (r * r * np.sqrt(rest))))
    return float(np.pi - 2.0 * b * integral - 2.0 * np.arcsin(b / RIM))


@pytest.mark.parametrize("potential", [TABLE, SAMPLED], ids=["table", "sampled"])
@pytest.mark.parametrize("energy", [*BELOW, 0.017])
@pytest.mark.parametrize("b", [0.5, 1.0, 2.0, 2.7])
def test_angles(potential: vv.potentials.Potential, energy: float, b: float) -> None:
    found = s.deflect(potential, energy=energy, impact_parameter=b)
    # The rule of the test crosses the ends of pieces, where third derivatives jump, and the turning point is rounded: G
    # near it has ten digits or so at the least energy.
    assert float(found.angle) == pytest.approx(quadrature(potential, energy, b), abs=3e-6)
    assert int(found.turning_points) == 1


@pytest.mark.parametrize("energy", BELOW)
def test_nothing_is_captured(energy: float) -> None:
    b = np.array([0.0, 1e-9, 1.0, 2.99, RIM * (1.0 - 1e-9), RIM * (1.0 - 1e-13), RIM, RIM * (1.0 + 1e-15), 3.5, 100.0])
    found = s.deflect(TABLE, energy=energy, impact_parameter=b)
    assert set(found.status.tolist()) == {0}
    assert np.all(found.angle[b >= RIM] == 0.0)
    # Up to the rim the angle goes to a limit of its own, as the root of what is left; beyond there is none.
    assert found.angle[-5] == pytest.approx(found.angle[-6], abs=1e-2)
    assert abs(found.angle[-5]) > 0.5
    assert s.capture_cross_section(TABLE, energy=energy) == 0.0
    assert s.total_cross_section(TABLE, energy=energy) == pytest.approx(np.pi * RIM**2, rel=1e-12, abs=0.0)
    assert s.orbiting(TABLE, energy=energy) == ()


def test_cross_sections_go_on_through_the_energy_of_the_rim() -> None:
    """A transport cross section is the mean of 1 − cos ψ over the disc; of both kinds of potential the same but for
    what they differ by."""
    energies = np.array([0.001, 0.01, 0.016, 0.0165, 0.02])
    table, sampled = (s.transport_cross_section(potential, energy=energies) for potential in (TABLE, SAMPLED))
    # The table is off by its fourth power of 1/160: 1e-7 of the depth, which is 1/100 of these energies and more.
    np.testing.assert_allclose(table, sampled, rtol=3e-7, atol=0.0)
    for energy, found in zip(energies[:3], sampled, strict=False):
        # The midpoint rule in b² over a smooth function with a jump at its end, where the angle goes as a root.
        b = RIM * np.sqrt((np.arange(4000) + 0.5) / 4000)
        mean = np.mean(1.0 - np.cos(s.deflection_angle(SAMPLED, energy=energy, impact_parameter=b)))
        assert found == pytest.approx(np.pi * RIM**2 * mean, rel=2e-4, abs=0.0)


def test_events_are_all_scattered() -> None:
    found = s.monte_carlo(SAMPLED, beam_energy=0.01, masses=(1.0, 1e9), b_max=RIM, n_events=100_000, seed=1, bins=40)
    tally = found["cm_angle"]
    assert int(tally.captured) == 0
    b = RIM * np.sqrt((np.arange(4000) + 0.5) / 4000)
    angle = np.arccos(np.cos(s.deflection_angle(SAMPLED, energy=0.01, impact_parameter=b)))
    expected = np.histogram(angle, bins=40, range=(0.0, np.pi))[0] * 25.0
    # Five standard deviations of a count, and two of the mean's own steps at either end of a bin.
    assert np.all(np.abs(tally.counts - expected) < 5.0 * np.sqrt(expected) + 50.0)
