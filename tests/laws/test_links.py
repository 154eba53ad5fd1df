"""Springs and dampers between listed bodies.

Bounds: at rtol = 1e-12 distances end 1e-13 off and energies 3e-13; more than ten times that is not allowed.
"""

import numpy as np
import pytest

import visviva as vv


@pytest.mark.parametrize("copies", [1, 5])
def test_springs_swing(copies: int) -> None:
    """Two masses on a spring: ω² = k (1/m + 1/M); all is conserved, and others are integrated by themselves."""
    mass, k, length, t = np.array([1.0, 3.0, 1.0]), 4.0, 1.0, np.linspace(0.0, 3.0, 7)
    scene = vv.Scene(
        vv.Particles(mass, [[0.0, 0, 0], [1.5, 0, 0], [9.0, 0, 0]], [[0, 0, 0], [0, 0, 0], [0, 1.0, 0]]),
        vv.Spring(0, 1, k, length),
    )
    if copies == 1:
        out = scene.run(t=t, rtol=1e-12)
        position = out.position
        table = out.conservation()
        assert all(row.conserved for row in table.rows)
        assert table.energy.max < 1e-11
    else:
        alone = scene.run(t=t, rtol=1e-12).position
        position = scene.ensemble(mass=np.tile(mass, (copies, 1))).run(t=t, rtol=1e-12).position[-1]
        assert np.array_equal(position, alone)
    omega = np.sqrt(k * (1 + 1 / 3))
    assert np.allclose(position[:, 1, 0] - position[:, 0, 0], length + 0.5 * np.cos(omega * t), rtol=0, atol=2e-12)
    free = np.outer(t, [0, 1.0, 0]) + np.array([9.0, 0, 0])
    assert np.allclose(position[:, 2], free, rtol=0, atol=1e-13)


@pytest.mark.parametrize("n", [3, 8, 20])
def test_a_chain_has_its_own_bits_in_an_ensemble(n: int) -> None:
    rng = np.random.default_rng(n)
    bodies = vv.Particles(
        rng.uniform(1, 2, n), rng.normal(size=(n, 3)) + np.arange(n)[:, None], rng.normal(size=(n, 3))
    )
    links = np.arange(n - 1)
    scene = vv.Scene(bodies, vv.Spring(links, links + 1, k=rng.uniform(1, 2, n - 1), length=1.0), vv.LinearDrag(3.0))
    starts = bodies.position + 0.01 * rng.normal(size=(11, n, 3))
    together = scene.ensemble(position=starts).run(t=2.0, rtol=1e-10)
    for copy in (0, 7, 10):
        alone = scene.with_state(starts[copy], bodies.velocity).run(t=2.0, rtol=1e-10)
        assert np.array_equal(alone.position, together.position[copy])
    gravity = vv.Scene(bodies, vv.Gravity(1.0, 0.1), *scene.forces)
    assert np.array_equal(
        gravity.ensemble(position=starts).run(t=0.5).position[4],
        gravity.with_state(starts[4], bodies.velocity).run(t=0.5).position,
    )


def test_a_damper_slows_what_changes_the_distance_and_nothing_else() -> None:
    """F = −c ((vⱼ − vᵢ)·n) n, n along the line; momentum and angular momentum are kept, energy falls."""
    rng = np.random.default_rng(8)
    x, v, m = rng.normal(size=(3, 3)), rng.normal(size=(3, 3)), np.array([1.0, 2.0, 0.5])
    scene = vv.Scene(vv.Particles(m, x, v), vv.Damper([0, 1], [1, 2], [0.5, 2.0]))
    force = np.zeros((3, 3))
    for i, j, c in ((0, 1, 0.5), (1, 2, 2.0)):
        n = (x[j] - x[i]) / np.linalg.norm(x[j] - x[i])
        pull = c * np.dot(v[j] - v[i], n) * n
        force[i] += pull
        force[j] -= pull
    # A few roundings of numbers of size 4.
    np.testing.assert_allclose(scene.acceleration(), force / m[:, None], rtol=0, atol=1e-14)
    out = scene.run(t=np.linspace(0.0, 2.0, 9), rtol=1e-12)
    table = out.conservation()
    assert [row.conserved for row in table.rows] == [False, True, True, True]
    assert table.momentum.max < 1e-14
    assert table.angular_momentum.max < 1e-11  # rtol over some tens of steps
    assert np.all(np.diff(out.energy) < 0.0)


def test_a_damped_spring_swings_as_the_damped_oscillator() -> None:
    """The distance of two bodies obeys μ s″ = −k (s − length) − c s′, μ the reduced mass."""
    k, c, length = 4.0, 0.6, 1.0
    pair = vv.Particles([1.0, 3.0], [[0, 0, 0], [1.5, 0, 0]], [[0, 0, 0], [0.4, 0, 0]])
    t = np.linspace(0.0, 4.0, 9)
    out = vv.Scene(pair, vv.Spring(0, 1, k, length), vv.Damper(0, 1, c)).run(t=t, rtol=1e-12)
    mu = 0.75
    one = vv.Scene(vv.Particles([mu], [[0.5, 0, 0]], [[0.4, 0, 0]]), vv.Harmonic(k), vv.LinearDrag(mu / c)).run(t=t)
    assert one.plan.closed_form
    s = out.position[:, 1, 0] - out.position[:, 0, 0] - length
    np.testing.assert_allclose(s, one.position[:, 0, 0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("n", [2, 3, 8, 9, 20])
def test_dampers_have_their_own_bits_in_an_ensemble(n: int) -> None:
    rng = np.random.default_rng(n)
    bodies = vv.Particles(
        rng.uniform(1, 2, n), rng.normal(size=(n, 3)) + 2 * np.arange(n)[:, None], rng.normal(size=(n, 3))
    )
    links = np.arange(n - 1)
    scene = vv.Scene(bodies, vv.Damper(links, links + 1, c=rng.uniform(1, 2, n - 1)), vv.QuadraticDrag(0.1))
    starts = bodies.position + 0.01 * rng.normal(size=(11, n, 3))
    together = scene.ensemble(position=starts).run(t=1.0, rtol=1e-10)
    for copy in (0, 7, 10):
        alone = scene.with_state(starts[copy], bodies.velocity).run(t=1.0, rtol=1e-10)
        assert np.array_equal(alone.position, together.position[copy])
