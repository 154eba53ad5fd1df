"""The event of the energy where the forces keep it: a guard that costs a look at each node, and no more."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

MASS = np.array([1.0, 0.5])
PERIOD = 2.0 * np.pi / np.sqrt(1.5)


def kepler(e: float = 0.5) -> vv.Scene:
    """Two bodies at the pericenter, with the semi-major axis 1."""
    separation, speed = np.array([1.0 - e, 0.0, 0.0]), np.sqrt(1.5 * (1.0 + e) / (1.0 - e))
    share = np.array([-0.5, 1.0])[:, None] / 1.5
    velocity = np.array([0.0, speed, 0.0])
    return vv.Scene(vv.Particles(MASS, share * separation, share * velocity), vv.Gravity(G=1.0))


@pytest.mark.parametrize("method", ["leapfrog", "yoshida4", "rk4"])
@pytest.mark.parametrize("direction", [-1, 0, 1])
def test_it_passes_a_value_where_the_energies_of_the_nodes_do(method: str, direction: int) -> None:
    dt = PERIOD / 64
    nodes = dt * np.arange(401)
    plain = kepler().run(t=nodes, method=method, dt=dt, record=("energy",))
    level = float(np.median(plain.energy)) + 1e-9
    above = plain.energy > level
    changes = above[1:].astype(int) - above[:-1].astype(int)
    event = vv.events.energy(level, direction=direction)
    watched = kepler().run(t=nodes, method=method, dt=dt, record=("energy",), events=[event])
    np.testing.assert_array_equal(watched.energy, plain.energy)
    wanted = np.flatnonzero(changes if direction == 0 else changes == direction)
    assert len(wanted) > 0
    assert len(watched.events) == len(wanted)
    assert np.all((nodes[wanted] <= watched.events.t) & (watched.events.t <= nodes[wanted + 1]))
    found = 0.5 * (watched.events.velocity**2).sum(axis=2) @ MASS
    relative = watched.events.position[:, 1] - watched.events.position[:, 0]
    found -= 0.5 / np.linalg.norm(relative, axis=1)
    # A few units of round-off of energies of size 1 (a node's own if the step turns round there).
    np.testing.assert_allclose(found, level, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(
    "how", [{"method": "dop853"}, {"method": "taylor"}, {"method": "kahan_li8", "dt": PERIOD / 500}]
)
def test_a_guard_that_is_not_met_evaluates_no_forces(how: dict[str, Any]) -> None:
    scene = kepler()
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.98])[:, None, None])
    level = float(scene.run(t=1.0).energy[0])
    for of in (scene, copies):
        plain = of.run(t=50.0, rtol=1e-9, **how) if "dt" not in how else of.run(t=50.0, **how)
        guarded = {"events": [vv.events.energy(0.5 * level, terminal=True)]}
        watched = of.run(t=50.0, rtol=1e-9, **how, **guarded) if "dt" not in how else of.run(t=50.0, **how, **guarded)
        assert len(watched.events) == 0
        np.testing.assert_array_equal(watched.position, plain.position)
        assert watched.stats.evaluations == plain.stats.evaluations


def test_what_takes_energy_is_looked_at_inside_of_steps() -> None:
    """A driven oscillator goes up through a value and down again, several times within a step."""
    drive = vv.DrivenForce(amplitude=(0.3, 0.0, 0.0), frequency=1.0)
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]), vv.Harmonic(k=0.25), drive)
    fine = scene.run(t=np.linspace(0.0, 40.0, 20_001), rtol=1e-12, record=("energy",)).energy
    level = float(np.median(fine))
    wanted = int(np.sum((fine[1:] > level) != (fine[:-1] > level)))
    assert len(scene.run(t=40.0, rtol=1e-12, method="dop853", events=[vv.events.energy(level)]).events) == wanted
