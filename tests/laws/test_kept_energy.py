"""The event of the energy where the forces keep it: a guard that costs a look at each node, and no more."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from event_scenes import PERIOD, kepler

import visviva as vv

MASS = np.array([1.0, 0.5])


@pytest.mark.parametrize("method", ["leapfrog", "yoshida4", "rk4"])
@pytest.mark.parametrize("direction", [-1, 0, 1])
def test_it_passes_a_value_where_the_energies_of_the_nodes_do(method: str, direction: int) -> None:
    dt = PERIOD / 64
    nodes = dt * np.arange(401)
    plain = kepler(0.5).run(t=nodes, method=method, dt=dt, record=("energy",))
    level = float(np.median(plain.energy)) + 1e-9
    above = plain.energy > level
    changes = above[1:].astype(int) - above[:-1].astype(int)
    event = vv.events.energy(level, direction=direction)
    watched = kepler(0.5).run(t=nodes, method=method, dt=dt, record=("energy",), events=[event])
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
    scene = kepler(0.5)
    copies = scene.ensemble(velocity=scene.particles.velocity * np.array([1.0, 0.98])[:, None, None])
    level = float(scene.run(t=1.0).energy[0])
    for of in (scene, copies):
        plain = of.run(t=50.0, rtol=1e-9, **how) if "dt" not in how else of.run(t=50.0, **how)
        guarded = {"events": [vv.events.energy(0.5 * level, terminal=True)]}
        watched = of.run(t=50.0, rtol=1e-9, **how, **guarded) if "dt" not in how else of.run(t=50.0, **how, **guarded)
        assert len(watched.events) == 0
        np.testing.assert_array_equal(watched.position, plain.position)
        assert watched.stats.evaluations == plain.stats.evaluations


@pytest.mark.parametrize("how", [{"method": "dop853"}, {"method": "taylor"}, {"method": "yoshida4", "dt": 0.05}])
def test_copies_with_masses_of_their_own_and_massless_bodies(how: dict[str, Any]) -> None:
    """Eleven copies, of which each passes the level as it does alone, on one thread and on three."""
    pair = kepler(0.5).particles
    light = np.array([[5.0, 0.0, 0.0], [0.0, 7.0, 0.0]])
    bodies = vv.Particles(
        [*MASS, 0.0, 0.0], np.vstack([pair.position, light]), np.vstack([pair.velocity, np.zeros((2, 3))])
    )
    scene = vv.Scene(bodies, vv.Gravity(G=1.0))
    masses = bodies.mass * np.linspace(0.9, 1.1, 11)[:, None]
    many = scene.ensemble(mass=masses)
    level = float(scene.run(t=0.1, record=("energy",)).energy[0]) + 1e-9
    guard = {"events": [vv.events.energy(level)]}
    runs = [many.run(t=20.0, threads=threads, **how, **guard) for threads in (1, 3)]
    np.testing.assert_array_equal(runs[0].events.t, runs[1].events.t)
    for member in (0, 5, 10):
        own = vv.Scene(vv.Particles(masses[member], bodies.position, bodies.velocity), vv.Gravity(G=1.0))
        alone = own.run(t=20.0, **how, **guard)
        np.testing.assert_array_equal(runs[0].events.t[runs[0].events.member == member], alone.events.t)
        np.testing.assert_array_equal(runs[0].position[member, -1], alone.position[-1])


def test_what_takes_energy_is_looked_at_inside_of_steps() -> None:
    """A driven oscillator goes up through a value and down again, several times within a step."""
    drive = vv.DrivenForce(amplitude=(0.3, 0.0, 0.0), frequency=1.0)
    scene = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]]), vv.Harmonic(k=0.25), drive)
    fine = scene.run(t=np.linspace(0.0, 40.0, 20_001), rtol=1e-12, record=("energy",)).energy
    level = float(np.median(fine))
    wanted = int(np.sum((fine[1:] > level) != (fine[:-1] > level)))
    assert len(scene.run(t=40.0, rtol=1e-12, method="dop853", events=[vv.events.energy(level)]).events) == wanted
