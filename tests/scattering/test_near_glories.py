"""Cross sections beside a backward glory, where b is not zero while sin θ is."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize("energy", [0.5, 0.9, 1.0])
def test_the_sine_times_the_cross_section_goes_to_its_limit(energy: float) -> None:
    """σ sin θ goes to Σ 2b/|dψ/db| over the glories at odd turns, and to what comes head-on none."""
    scattering, potential = vv.scattering, vv.potentials.LennardJones(1.0, 1.0)
    backward = [glory for glory in scattering.glories(potential, energy=energy) if abs(np.sin(0.5 * glory.angle)) > 0.9]
    limit = sum(
        (1.0 if glory.impact_parameter == 0.0 else 2.0) * glory.impact_parameter / abs(glory.derivative)
        for glory in backward
    )
    assert limit > 0.0
    for missing in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14):
        angle = np.pi - missing
        # The float π stands for π, so what is missing to it is known exactly.
        product = scattering.cross_section(potential, energy=energy, angle=angle) * np.sin(np.pi - angle)
        # It changes by a few times the angle that is missing; glories are found to 1e-10, and dψ/db there to 1e-9.
        assert product == pytest.approx(limit, rel=1e-8 + 20.0 * missing, abs=0.0)
