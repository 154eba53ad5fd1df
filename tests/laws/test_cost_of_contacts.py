"""What a contact costs among many spheres: of all that come near each other in a step the first alone is located."""

from __future__ import annotations

import numpy as np

import visviva as vv


def gas(side: int) -> vv.Particles:
    """Spheres on a grid, each on its way somewhere else."""
    grid = np.stack(np.meshgrid(*[np.arange(float(side))] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    velocity = np.random.default_rng(3).normal(size=grid.shape)
    masses, radius = np.ones(len(grid)), np.full(len(grid), 0.3)
    return vv.Particles(masses, grid - grid.mean(axis=0), velocity - velocity.mean(axis=0), radius=radius)


def test_a_contact_costs_a_few_evaluations_however_many_come_near() -> None:
    """A step, its start and the shadow steps of one secant search; 53 of them were taken among a thousand spheres."""
    for side in (4, 8):
        run = vv.Scene(gas(side), vv.Gravity(1e-3)).run(t=0.3, method="leapfrog", dt=0.02, collisions="bounce")
        contacts = len(run.collisions)
        assert contacts >= side**2 // 2
        assert run.stats.evaluations < 10 * contacts


def test_the_order_of_bodies_changes_no_contact() -> None:
    """Which pair is looked at first follows from where spheres are, not from their numbers."""
    particles = gas(4)
    order = np.random.default_rng(5).permutation(len(particles.mass))
    mixed = vv.Particles(
        particles.mass[order], particles.position[order], particles.velocity[order], radius=particles.radius[order]
    )
    here, there = (
        vv.Scene(each, vv.Gravity(1e-3)).run(t=0.7, method="leapfrog", dt=0.02, collisions="bounce")
        for each in (particles, mixed)
    )
    assert len(here.collisions) == len(there.collisions) > 20
    np.testing.assert_allclose(here.collisions.t, there.collisions.t, rtol=0, atol=1e-13)
    # Hundreds of contacts between spheres tell roundings apart by about ten for each that a sphere has had.
    np.testing.assert_allclose(here.final.particles.position[order], there.final.particles.position, rtol=0, atol=1e-9)
