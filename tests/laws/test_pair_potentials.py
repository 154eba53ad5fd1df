"""Potentials between all pairs of bodies."""

import numpy as np
import pytest
from own_bits import copies_have_their_own_bits

import visviva as vv

POTENTIALS = [
    vv.potentials.Coulomb(-1.5),
    vv.potentials.Yukawa(k=2.0, length=0.8),
    vv.potentials.LennardJones(epsilon=0.5, sigma=0.6),
]


def lattice(n: int) -> vv.Particles:
    """PreciseBodies at least 0.8 apart."""
    rng = np.random.default_rng(n)
    side = int(np.ceil(n ** (1 / 3)))
    places = np.array(list(np.ndindex(side, side, side)), dtype=float)[:n]
    return vv.Particles(rng.uniform(1, 2, n), places + rng.uniform(-0.1, 0.1, (n, 3)), rng.normal(size=(n, 3)) * 0.1)


@pytest.mark.parametrize("n", [2, 3, 8, 9, 16, 17, 23, 130, 300])
@pytest.mark.parametrize("potential", POTENTIALS, ids=repr)
def test_pairs_pull_as_the_potential_says(potential: vv.potentials.Potential, n: int) -> None:
    bodies = lattice(n)
    d = bodies.position[None] - bodies.position[:, None]
    r = np.linalg.norm(d, axis=-1) + np.eye(n)
    force = potential.force(r) * (1 - np.eye(n))
    expected = -(force / r)[..., None] * d
    a = vv.Scene(bodies, vv.PairPotential(potential)).acceleration()
    # The roundings of each pair, magnified twelvefold by the power law, of sums in which they may cancel.
    size = np.abs(expected).sum(axis=(1, 2)).max()
    assert np.abs(a * bodies.mass[:, None] - expected.sum(axis=1)).max() <= 1e-14 * size
    energy = vv.Scene(bodies, vv.PairPotential(potential)).invariants().potential_energy
    assert energy == pytest.approx(potential.value(r[np.triu_indices(n, 1)]).sum(), rel=1e-13, abs=0)


@pytest.mark.parametrize("n", [2, 3, 8, 9, 20])
def test_pair_potentials_have_their_own_bits_in_an_ensemble(n: int) -> None:
    bodies = lattice(n)
    scene = vv.Scene(bodies, vv.PairPotential(POTENTIALS[2]), vv.Gravity(0.1, 0.3))
    copies_have_their_own_bits(scene, 0.5, "leapfrog")


def test_pair_potentials_keep_everything_on_any_number_of_threads() -> None:
    scene = vv.Scene(lattice(300), vv.PairPotential(POTENTIALS[2]))
    runs = [scene.run(t=[0.0, 0.1, 0.2], method="rk4", dt=0.01, threads=threads) for threads in (1, 2, 3)]
    assert np.array_equal(runs[0].position, runs[1].position)
    assert np.array_equal(runs[0].position, runs[2].position)
    table = runs[0].conservation()
    assert all(row.conserved for row in table.rows)
    assert table.energy.max < 1e-8  # rk4's fourth order at this step
    assert table.momentum.max < 1e-14
    with pytest.raises(vv.InvalidInput, match="distinct positions"):
        vv.Scene(vv.Particles([1.0, 1.0], np.zeros((2, 3))), *scene.forces).plan(t=1.0)
