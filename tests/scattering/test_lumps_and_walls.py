"""What stands before an orbit: branches that rise from side to side, walls that hide, overflow that is nothing.

Bounds: impact parameters and cross sections to the roundings of an inverse of the deflection function, 1e-12; angles of
two writings of one potential to theirs, 1e-12 of what is added up.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import visviva as vv

s = vv.scattering


def lump(r: np.ndarray) -> np.ndarray:
    return 0.68 * np.exp(-(((r - 4.0) / 0.6) ** 2))


def well_with_barrier(r: np.ndarray) -> np.ndarray:
    return 6.0 * np.exp(-r / 2.0) - 20.0 * np.exp(-r * r)


@pytest.mark.parametrize(("formula", "energy"), [(lump, 1.2), (well_with_barrier, 2.0)])
@pytest.mark.parametrize("angle", [0.5, 0.99, 1.01, 1.2])
def test_a_branch_that_rises_from_behind_is_found(formula: object, energy: float, angle: float) -> None:
    """Outside an orbit ψ rises from −∞ to a rainbow on the other side: every θ on the way belongs to a branch."""
    potential = vv.potentials.Custom(formula)
    orbit = s.orbiting(potential, energy=energy)[-1].impact_parameter
    top = min(
        (found for found in s.rainbows(potential, energy=energy) if found.impact_parameter > orbit),
        key=lambda found: found.impact_parameter,
    )
    assert top.angle > angle

    def missed(b: float, target: float) -> float:
        return float(s.deflect(potential, energy=energy, impact_parameter=b).angle) - target

    found = s.impact_parameter(potential, energy=energy, angle=angle)
    inner = orbit * (1.0 + 1e-9)
    targets = [target for target in (angle, -angle, angle - 2.0 * np.pi) if missed(inner, target) < 0.0]
    assert targets[0] == angle
    for target in targets:
        b = brentq(missed, inner, top.impact_parameter, args=(target,), xtol=1e-14)
        assert np.abs(found / b - 1.0).min() < 1e-12, target
    slopes = s.deflect(potential, energy=energy, impact_parameter=found).derivative
    alone = found / np.sin(angle) / np.abs(slopes)
    assert s.cross_section(potential, energy=energy, angle=angle) == pytest.approx(alone.sum(), rel=1e-9, abs=0.0)


def test_events_of_a_lump() -> None:
    """Counts of a tally are those of its cross section, rainbow, orbit and all."""
    potential = vv.potentials.Custom(lump)
    counted = s.monte_carlo(
        potential, beam_energy=1.5, masses=(1.0, 4.0), b_max=5.0, n_events=200_000, seed=3, bins=12
    )["cm_angle"]
    expected = counted.expected()
    inside = expected > 20.0
    pull = (counted.counts - expected)[inside] / np.sqrt(expected[inside])
    # Twelve normal deviates, none of which is beyond five.
    assert inside.sum() > 6
    assert np.abs(pull).max() < 5.0


@pytest.mark.parametrize("energy", [0.5, 20.0])
def test_what_is_behind_a_wall_is_no_orbit(energy: float) -> None:
    """Inside of a wall that nothing passes, −1/r⁴ would capture."""
    potential = vv.potentials.Custom(lambda r: -1.0 / r**4 + 100.0 * np.exp(-(((r - 3.0) / 0.2) ** 2)))
    assert s.orbiting(potential, energy=energy) == ()
    assert s.capture_cross_section(potential, energy=energy) == 0.0
    nearest = s.deflect(potential, energy=energy, impact_parameter=[0.0, 1.0, 2.0]).closest_approach
    assert (nearest > 3.0).all()
    # One that is passed hides nothing.
    passed = vv.potentials.Custom(lambda r: -1.0 / r**4 + 0.25 * np.exp(-(((r - 3.0) / 0.2) ** 2)))
    assert s.orbiting(passed, energy=energy)[0].captures


def test_an_exponential_that_overflows_below_is_nothing_fast() -> None:
    """Coulomb's barrier beside the well of Woods and Saxon, as books write it, and without a number out of range."""
    written = vv.potentials.Custom(lambda r: 4.0 / r - 8.0 / (1.0 + np.exp((r - 2.0) / 0.2)))
    decaying = vv.potentials.Custom(
        lambda r: 4.0 / r - 8.0 * np.exp(-(r - 2.0) / 0.2) / (1.0 + np.exp(-(r - 2.0) / 0.2))
    )
    b = [0.0, 0.5, 2.0, 10.0, 150.0, 4000.0, 1e6]
    one, other = (s.deflect(potential, energy=3.0, impact_parameter=b) for potential in (written, decaying))
    assert np.allclose(one.angle, other.angle, rtol=1e-12, atol=0.0)
    assert np.allclose(one.closest_approach, other.closest_approach, rtol=1e-13, atol=0.0)
    # Far out it is Rutherford's.
    assert one.angle[-1] == pytest.approx(2.0 * np.arctan(4.0 / (2.0 * 3.0 * 1e6)), rel=1e-12, abs=0.0)
