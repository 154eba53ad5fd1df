"""Counts where the deflection turns: beside glories and rainbows, head-on and at the angle at which a quantity turns.

Counts are exact integers of one function of one draw, and so are the events that are told one by one: but for an event
that lies on an edge to the last digit the two are the same.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

S, V = vv.scattering, vv.potentials
POTENTIALS = {
    "lennard_jones": V.LennardJones(1.0, 1.0),
    "morse": V.Morse(1.0, 2.0, 1.2),
    "mie": V.Mie(1.0, 1.0, 10.0, 5.0),
    "yukawa": V.Yukawa(-1.0, 1.0),
}
QUANTITIES = ("cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy")


def off(potential: Any, quantity: str, edges: Any, **beam: Any) -> int:
    """By how many events counts and events differ in any bin."""
    values = np.asarray(S.scattering_events(potential, **beam)[quantity])
    values = values[np.isfinite(values)]
    tally = S.monte_carlo(potential, tally={quantity: edges}, **beam)[quantity]
    # The last bin of NumPy has its upper edge in it.
    inside = values[values < edges[-1]]
    return int(np.abs(np.asarray(tally.counts) - np.histogram(inside, edges)[0]).max())


def test_a_glory_inside_the_last_part_of_a_piece() -> None:
    """5031 of a million go straight on to within 0.01: none of them was counted."""
    beam: dict[str, Any] = {"beam_energy": 2.5, "masses": (1.0, 4.0), "b_max": 1.5, "seed": 5, "n_events": 10**6}
    tally = S.monte_carlo(POTENTIALS["lennard_jones"], tally={"cm_angle": [0.0, 0.01, np.pi]}, **beam)["cm_angle"]
    assert tally.counts.tolist() == [5031, 994969]
    # A probability of 0.005: 70 of a million are one standard deviation.
    assert tally.expected()[0] == pytest.approx(5031, rel=0, abs=4 * 71)


def test_folds_beside_head_on() -> None:
    """Where ψ goes beyond -π by little there are two folds beside a rainbow."""
    edges = np.array([3.0, 3.13, 3.138, 3.14, 3.1413, 3.14158, np.pi])
    beam: dict[str, Any] = {"beam_energy": 1.0, "masses": (1.0, 4.0), "b_max": 2.0, "seed": 5, "n_events": 10**5}
    assert off(POTENTIALS["lennard_jones"], "cm_angle", edges, **beam) == 0


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("name", POTENTIALS)
def test_counts_are_those_of_the_events(name: str, quantity: str) -> None:
    """Bins at the rarest events of each end, at eight energies, mass ratios and discs."""
    chance = np.random.default_rng([list(POTENTIALS).index(name), QUANTITIES.index(quantity)])
    for seed in range(8):
        beam: dict[str, Any] = {
            "beam_energy": float(10.0 ** chance.uniform(-0.4, 0.9)),
            "masses": (1.0, float(10.0 ** chance.uniform(-1.0, 1.5))),
            "b_max": float(chance.uniform(1.0, 4.0)),
            "seed": seed,
            "n_events": 20_000,
        }
        values = np.asarray(S.scattering_events(POTENTIALS[name], **beam)[quantity])
        values = np.sort(values[np.isfinite(values)])
        # Between events, so that none is on an edge.
        ranks = np.array([2, 10, 40, 200, 10_000, -200, -40, -10, -3])
        edges = np.unique(0.5 * (values[ranks] + values[ranks + 1]))
        if len(edges) > 1:
            assert off(POTENTIALS[name], quantity, edges, **beam) == 0, (seed, beam)
