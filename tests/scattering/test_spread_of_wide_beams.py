"""Beams whose energies spread far: the deflections between the tables are those of each event."""

from __future__ import annotations

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize(("energy", "part"), [(5.0, 0.06), (5.0, 0.1), (20.0, 0.13), (100.0, 0.13)])
def test_a_spread_far_above_orbiting(energy: float, part: float) -> None:
    """From 6 % on it was refused: nine tables in the energy were too few, where in 1/E as many are enough."""
    potential = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
    how = {"beam_energy": energy, "masses": (1.0, 1e9), "b_max": 3.0, "energy_spread": part * energy}
    events = vv.scattering.scattering_events(potential, n_events=2000, seed=3, **how)
    direct = vv.scattering.deflect(
        potential, energy=events["beam_energy"] / (1.0 + 1e-9), impact_parameter=events["impact_parameter"]
    )
    # Tables are tried to 4e-6 in sin²(ψ/2).
    off = np.abs(np.sin(0.5 * events["cm_angle"]) ** 2 - np.sin(0.5 * direct.angle) ** 2)
    assert off.max() < 4e-6
