"""Energies recorded eight outputs at a time, where copies, events, massless bodies and threads meet them.

The column is that of the recorded states, output by output, whatever else is asked for.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv

BODIES, COPIES = 12, 11
TIMES = 0.01 * np.arange(38)  # no whole number of eights


def cluster(massless: int = 0) -> vv.Scene:
    random = np.random.default_rng(12)
    mass = np.concatenate([random.uniform(0.5, 1.5, BODIES), np.zeros(massless)]) / BODIES
    count = BODIES + massless
    return vv.Scene(
        vv.Particles(mass, random.normal(size=(count, 3)), 0.3 * random.normal(size=(count, 3))),
        vv.Gravity(1.0, softening=0.05),
    )


def energy(out: Any, mass: np.ndarray) -> np.ndarray:
    """Of the rows of a run, by sums of NumPy."""
    x, v = out.position[:, :BODIES], out.velocity[:, :BODIES]
    apart = np.linalg.norm(x[:, :, None] - x[:, None], axis=-1)
    pairs = np.triu_indices(BODIES, 1)
    potential = -(mass[:, None] * mass)[pairs] / np.sqrt(apart[:, *pairs] ** 2 + 0.05**2)
    return 0.5 * (mass * (v**2).sum(axis=2)).sum(axis=1) + potential.sum(axis=1)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("method", ["leapfrog", "yoshida4"])
def test_copies_of_many_bodies_with_masses_of_their_own(method: str, threads: int) -> None:
    scene = cluster()
    masses = scene.particles.mass * np.linspace(0.5, 2.0, COPIES)[:, None]
    plane = vv.events.plane([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], body=0)
    many = scene.ensemble(mass=masses)
    how = {"method": method, "dt": 0.01, "record": ("position", "velocity", "energy")}
    out = many.run(TIMES, threads=threads, events=[plane], **how)
    without = many.run(TIMES, threads=threads, method=method, dt=0.01, record=("energy",))
    assert np.array_equal(out.energy, without.energy)
    for copy in range(COPIES):
        alone = many[copy].run(TIMES, **how)
        assert np.array_equal(alone.energy, out.energy[copy])
        # Sums of 66 pairs and 12 bodies in another order.
        assert out.energy[copy] == pytest.approx(energy(alone, masses[copy]), rel=1e-14, abs=1e-15)


def test_rows_up_to_a_terminal_event_are_all_there() -> None:
    scene = cluster()
    start = scene.particles.position[0]
    passed = vv.events.plane(
        start + 0.11 * scene.particles.velocity[0], scene.particles.velocity[0], body=0, terminal=True
    )
    how = {"method": "leapfrog", "dt": 0.01, "record": ("energy",)}
    whole = scene.run(TIMES, **how)
    cut = scene.run(TIMES, events=[passed], **how)
    assert cut.status == vv.Status.STOPPED
    rows = len(cut.t)
    # Of more than eight rows the last are no eight.
    assert 8 < rows < len(TIMES)
    assert np.isfinite(cut.energy).all()
    assert np.array_equal(cut.energy[:rows], whole.energy[:rows])


def test_hundreds_of_massless_bodies_have_no_energy_and_change_none() -> None:
    how = {"method": "leapfrog", "dt": 0.01, "record": ("energy",)}
    with_them = cluster(300).run(TIMES, **how)
    massive = cluster(300).particles
    alone = vv.Scene(
        vv.Particles(massive.mass[:BODIES], massive.position[:BODIES], massive.velocity[:BODIES]),
        vv.Gravity(1.0, softening=0.05),
    ).run(TIMES, **how)
    assert np.array_equal(with_them.energy, alone.energy)


@pytest.mark.parametrize("threads", [1, 3])
def test_copies_of_a_light_ball_between_heavy_ones(threads: int) -> None:
    spheres = vv.Particles(
        [1.0, 1.0, 1.0],
        [[-1.0, 0, 0], [1.0, 0, 0], [0.0, 0, 0]],
        [[1.0, 0, 0], [-1.0, 0, 0], [0.0, 0, 0]],
        radius=[0.125, 0.125, 0.0625],
    )
    masses = np.column_stack([np.ones(COPIES), np.ones(COPIES), np.geomspace(1e-6, 1.0, COPIES)])
    out = vv.Scene(spheres).ensemble(mass=masses).run(3.0, collisions="bounce", threads=threads)
    # Heavy ones come back as they came, and the light one stays, as well as the angle between its contacts is known.
    expected = np.array([-1.0, 1.0, 0.0])
    assert out.velocity[:, -1, :, 0] == pytest.approx(np.tile(expected, (COPIES, 1)), rel=0.0, abs=1e-12)
