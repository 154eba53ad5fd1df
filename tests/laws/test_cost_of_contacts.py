"""What a contact costs among many spheres: of all that come near each other in a step the first alone is located."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import visviva as vv


def gas(side: int) -> vv.Particles:
    """Spheres on a grid, each on its way somewhere else."""
    grid = np.stack(np.meshgrid(*[np.arange(float(side))] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    velocity = np.random.default_rng(3).normal(size=grid.shape)
    masses, radius = np.ones(len(grid)), np.full(len(grid), 0.3)
    return vv.Particles(masses, grid - grid.mean(axis=0), velocity - velocity.mean(axis=0), radius=radius)


def test_a_contact_costs_a_few_evaluations_however_many_come_near() -> None:
    """A step, its start and the state of the contact; 53 were taken among a thousand spheres, and seven once."""
    for side in (4, 8):
        run = vv.Scene(gas(side), vv.Gravity(1e-3)).run(t=0.3, method="leapfrog", dt=0.02, collisions="bounce")
        contacts = len(run.collisions)
        assert contacts >= side**2 // 2
        assert run.stats.evaluations < 10 * contacts
        # Those that pass each other take a few more, and so do the steps without a contact.
        assert run.stats.evaluations < 4 * contacts + 2 * run.stats.steps


def test_who_passes_by_costs_no_evaluation() -> None:
    """Beside a star, by leapfrog: where spheres are inside a step is known without a force, and how fast to h³."""
    rng = np.random.default_rng(8)
    a, phase = rng.uniform(0.9, 1.1, 300), rng.uniform(0, 2 * np.pi, 300)
    zero = np.zeros(300)
    place = np.stack([a * np.cos(phase), a * np.sin(phase), zero], axis=1)
    speed = np.stack([-np.sin(phase), np.cos(phase), zero], axis=1) * (a**-0.5)[:, None]
    masses, position = np.r_[1.0, zero + 1e-9], np.r_[[[0.0] * 3], place]
    velocity = np.r_[[[0.0] * 3], speed]
    apart = np.linalg.norm(place[:, None] - place, axis=2)[np.triu_indices(300, 1)].min()
    runs = []
    for radius in (0.0, 0.1 * apart):
        bodies = vv.Particles(masses, position, velocity, radius=np.r_[0.001, zero + radius])
        runs.append(vv.Scene(bodies, vv.Gravity(1.0)).run(t=2.0, method="leapfrog", dt=0.05, collisions="merge"))
    points, spheres = runs
    assert len(spheres.collisions) == 0
    assert spheres.stats.evaluations <= points.stats.evaluations + 2
    assert points.stats.evaluations <= points.stats.steps + 2


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


def test_a_contact_within_a_step_that_is_too_long_is_where_the_method_has_it() -> None:
    """Where velocities say nothing of the way inside a step, as of a composition with steps back, places do."""
    falls = vv.ExpressionForce(acceleration=lambda r, v, t: [-r[0] * (1 + np.sin(5 * t)), -r[1] * t, -r[2]])
    t0 = 1.63767198698917
    bodies = vv.Particles(
        [1.5279008010481698, 1.119240244173477],
        [
            [-0.42706614107752183, 0.6455095628565112, -0.8280929593478952],
            [-1.1952318156281652, 0.6345375322592814, -1.0733968535032168],
        ],
        [
            [-2.5213267291020873, -0.2777211872450179, -2.2749492295625613],
            [0.3650814137876209, -1.7385568963766946, 0.5444570226351699],
        ],
        radius=0.1,
    )
    scene = vv.Scene(bodies, falls, vv.Gravity(3.0), t0=t0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vv.AccuracyWarning)
        contact = scene.run(t=t0 + 0.25, method="kahan_li8", dt=0.25, collisions="stop").collisions.t[0]
        there = scene.run(t=contact, method="kahan_li8", dt=contact - t0).position[-1]
    # The time of day and the step are rounded; the gap closes at about one per unit of time.
    assert np.linalg.norm(there[0] - there[1]) == pytest.approx(0.2, rel=0, abs=1e-12)
