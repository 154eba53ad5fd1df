"""Event tables of potentials with an orbit: nothing depends on where the first intervals of a table happen to end."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv

#: An α particle at lead, Coulomb's barrier and Woods and Saxon's well (MeV, fm).
NUCLEUS = vv.potentials.Custom(
    lambda r, Z, V0, R, a: Z / r - V0 / (1 + np.exp((r - R) / a)),
    parameters={"Z": 227.5, "V0": 100.0, "R": 8.0, "a": 0.55},
)


@pytest.mark.parametrize("energy", [25.0, 26.0, 27.0, 28.0, 47.5])
def test_every_energy_above_the_barrier_is_taken(energy: float) -> None:
    """Three of a hundred were refused, as a point 1e-8 beside the orbit was taken for one that matters."""
    result = vv.scattering.monte_carlo(
        NUCLEUS, beam_energy=energy * 201 / 197, masses=(4.0, 197.0), b_max=20.0, n_events=2000, seed=1
    )
    assert result.n_events == 2000
