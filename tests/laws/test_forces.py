"""Forces together: they add, each with its own parameters, and the conservation table says what they keep."""

import numpy as np
import pytest

import visviva as vv

RNG = np.random.default_rng(20)


def cluster(n: int) -> vv.Particles:
    return vv.Particles(RNG.uniform(0.5, 2.0, n), RNG.normal(size=(n, 3)), RNG.normal(size=(n, 3)))


@pytest.mark.parametrize("n", [2, 3, 8, 9, 70])
def test_two_gravities_add(n: int) -> None:
    """Each has its own constant and softening: accelerations and energies are those of both."""
    bodies = cluster(n)
    one, other = vv.Gravity(G=1.0), vv.Gravity(G=3.0, softening=0.4)
    apart = [vv.Scene(bodies, force) for force in (one, other)]
    both = vv.Scene(bodies, one, other)
    # One rounding for the sum of the two.
    assert np.allclose(both.acceleration(), sum(scene.acceleration() for scene in apart), rtol=4e-16, atol=0)
    total = both.invariants().potential_energy
    assert total == pytest.approx(sum(scene.invariants().potential_energy for scene in apart), rel=4e-16)


def test_two_gravities_are_one_of_the_summed_constant() -> None:
    bodies = cluster(3)
    both = vv.Scene(bodies, vv.Gravity(1.0), vv.Gravity(3.0)).run(t=0.1, method="dop853", rtol=1e-12)
    one = vv.Scene(bodies, vv.Gravity(4.0)).run(t=0.1, method="dop853", rtol=1e-12)
    # Two runs, each within rtol of the motion, which here magnifies little.
    assert np.allclose(both.position, one.position, rtol=0, atol=1e-11)
    assert "2 forces between them" in str(both.plan)


@pytest.mark.parametrize("method", ["auto", "leapfrog"])
def test_two_gravities_for_two_bodies(method: str) -> None:
    """No closed form may take the constant of the first for that of both."""
    pair = vv.Particles([1.0, 1.0], [[-0.5, 0, 0], [0.5, 0, 0]], [[0, -1.0, 0], [0, 1.0, 0]])
    how = {} if method == "auto" else {"method": method, "dt": 1e-3}
    out = vv.Scene(pair, vv.Gravity(1.0), vv.Gravity(1.0)).run(t=[0.0, 0.5, 1.0], **how)
    # A circle: v² = G m / (2 r) of each about the centre, 1 = 2 · 1 · 1/(4 · 0.5). Leapfrog's dt² phase error is 1e-7.
    assert np.allclose(np.linalg.norm(out.position, axis=-1), 0.5, rtol=0, atol=1e-6)


def test_two_uniform_and_two_central_fields_add() -> None:
    bodies = cluster(4)
    forces = [
        vv.UniformField([1.0, 0.0, 2.0]),
        vv.UniformField([0.0, -3.0, 0.5]),
        vv.CentralField(vv.potentials.Coulomb(-1.0), [5.0, 0.0, 0.0]),
        vv.CentralField(vv.potentials.Coulomb(-2.0), [0.0, 6.0, 0.0]),
    ]
    both = vv.Scene(bodies, *forces)
    apart = [vv.Scene(bodies, force) for force in forces]
    assert np.allclose(both.acceleration(), sum(scene.acceleration() for scene in apart), rtol=1e-15, atol=1e-15)
    energies = [scene.invariants().potential_energy for scene in apart]
    assert both.invariants().potential_energy == pytest.approx(sum(energies), rel=1e-15)


def test_a_force_that_does_nothing_keeps_everything() -> None:
    out = vv.Scene(cluster(2), vv.Gravity(1.0, softening=1.0), vv.UniformField([0.0, 0.0, 0.0])).run(t=0.5)
    assert all(row.conserved for row in out.conservation().rows)


def test_two_centers_keep_no_angular_momentum() -> None:
    forces = [vv.CentralField(vv.potentials.Coulomb(-1.0), [x, 0.0, 0.0]) for x in (-1.0, 1.0)]
    body = vv.Particles([1.0], [[0.0, 1.0, 0.0]], [[0.5, 0.0, 0.0]])
    table = vv.Scene(body, *forces).run(t=[0.0, 0.5, 1.0]).conservation(about=[1.0, 0.0, 0.0])
    assert not table.angular_momentum.conserved
    assert table.energy.conserved
