"""Spheres that overlap at the start of a run: those that merge do so there, whatever their velocities."""

import numpy as np
import pytest

import visviva as vv

PARTING = vv.Particles(
    [1.0, 3.0, 1.0], [[0, 0, 0], [1.0, 0, 0], [9.0, 0, 0]], [[-1.0, 0, 0], [1.0, 0, 0], [0, 0.5, 0]], radius=0.75
)


@pytest.mark.parametrize("how", [{}, {"method": "leapfrog", "dt": 0.125}, {"rtol": 1e-12}])
@pytest.mark.parametrize("t0", [0.0, 2.5])
def test_they_merge_at_the_start(how: dict[str, object], t0: float) -> None:
    """Momentum, mass and volume are those of both; the row of the start is of before."""
    scene = vv.Scene(PARTING, vv.Gravity(0.1), t0=t0)
    out = scene.run(t=t0 + np.array([0.0, 1.0]), collisions="merge", **how)  # type: ignore[arg-type]
    assert out.collisions.t.tolist() == [t0]
    assert out.collisions.survivor.tolist() == [1]
    np.testing.assert_array_equal(out.position[0], PARTING.position)
    after = out.final.particles
    # The lighter one is nothing by itself any more, in the place of the other.
    np.testing.assert_allclose(after.mass, [0.0, 4.0, 1.0], rtol=1e-15, atol=0)
    np.testing.assert_allclose(after.radius, [0.0, np.cbrt(2.0) * 0.75, 0.75], rtol=1e-15, atol=0)
    together = vv.Particles([4.0, 1.0], [[0.75, 0, 0], [9.0, 0, 0]], [[0.5, 0, 0], [0, 0.5, 0]])
    alone = vv.Scene(together, vv.Gravity(0.1), t0=t0).run(t=t0 + 1.0, **how)  # type: ignore[arg-type]
    np.testing.assert_allclose(after.position[1:], alone.position[-1], rtol=1e-14, atol=1e-14)
    assert out.final.run(t=t0 + 2.0, collisions="merge", **how).collisions.t.size == 0  # type: ignore[arg-type]


def test_a_heap_becomes_one() -> None:
    rng = np.random.default_rng(3)
    heap = vv.Particles(np.ones(40), rng.uniform(-1, 1, (40, 3)), rng.normal(size=(40, 3)), radius=1.2)
    out = vv.Scene(heap, vv.Gravity(1.0)).run(t=1.0, collisions="merge")
    after = out.final.particles
    assert np.count_nonzero(after.mass) == 1
    assert (out.collisions.t == 0.0).all()
    assert len(out.collisions) == 39
    momentum = (after.mass[:, None] * after.velocity).sum(axis=0)
    # 39 sums of numbers of up to 40.
    np.testing.assert_allclose(momentum, heap.velocity.sum(axis=0), rtol=0, atol=1e-13)
    lost = vv.Scene(heap).invariants().kinetic_energy - 0.5 * 40.0 * (momentum**2).sum() / 40.0**2
    np.testing.assert_allclose(out.collisions.energy_lost.sum(), lost, rtol=1e-13)


def test_copies_differ_in_what_overlaps() -> None:
    """A copy has the bits that it has alone, on one thread and on three."""
    places = np.tile([[-2.0, 0, 0], [2.0, 0, 0]], (7, 1, 1))
    places[[2, 5], 1, 0] = -1.5
    balls = vv.Particles([1.0, 1.0], places[0], [[0, 0.1, 0], [0, -0.1, 0]], radius=0.5)
    copies = vv.Scene(balls, vv.Gravity(1.0)).ensemble(position=places)
    outs = [copies.run(t=1.0, collisions="merge", threads=threads) for threads in (1, 3)]
    for out in outs:
        for member in range(7):
            alone = copies[member].run(t=1.0, collisions="merge")
            np.testing.assert_array_equal(out[member].position, alone.position)
            assert len(out[member].collisions) == (member in (2, 5))
