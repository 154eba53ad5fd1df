"""Charges that push and pull each other.

Bounds: sums of a few terms in another order, 1e-14 of them; at rtol = 1e-12 what is kept drifts by 1e-13, and a run
at 1e-13 ends 1e-12 off the closed form.
"""

import numpy as np
import pytest
from own_bits import copies_have_their_own_bits

import visviva as vv


def charges(n: int) -> tuple[vv.Particles, np.ndarray]:
    rng = np.random.default_rng(n)
    bodies = vv.Particles(rng.uniform(1, 2, n), 2 * rng.normal(size=(n, 3)), rng.normal(size=(n, 3)))
    return bodies, rng.choice([-1.0, 1.0, 2.0, 0.0], n, p=[0.4, 0.3, 0.2, 0.1])


@pytest.mark.parametrize("softening", [0.0, 0.3])
@pytest.mark.parametrize("n", [2, 3, 8, 9, 16, 17, 130])
def test_charges_push_and_pull(n: int, softening: float) -> None:
    """F = k qᵢ qⱼ r/r³ with masses of their own; energy and virial of the pairs."""
    bodies, q = charges(n)
    q[:2] = 1.0, -2.0
    d = bodies.position[:, None] - bodies.position[None]
    r2 = (d**2).sum(-1) + softening**2 + np.eye(n)
    pairs = 1.5 * np.outer(q, q)[..., None] * d / r2[..., None] ** 1.5
    scene = vv.Scene(bodies, vv.Coulomb(q, k=1.5, softening=softening))
    size = np.abs(pairs).sum(axis=(1, 2)).max()
    # The roundings of each pair, of sums in which they may cancel.
    assert np.abs(scene.acceleration() * bodies.mass[:, None] - pairs.sum(1)).max() <= 4e-15 * size
    upper = np.triu_indices(n, 1)
    energies = (1.5 * np.outer(q, q) / np.sqrt(r2))[upper]
    potential = scene.invariants().potential_energy
    assert potential == pytest.approx(energies.sum(), abs=1e-14 * np.abs(energies).sum())
    virial = scene.run(t=1e-9, record="virial").virial[0] if hasattr(vv.Trajectory, "virial") else None
    if virial is not None:
        expected = (energies * (r2 - softening**2)[upper] / r2[upper]).sum()
        assert virial == pytest.approx(expected, abs=1e-14 * np.abs(energies).sum())


@pytest.mark.parametrize("n", [3, 8, 9, 20])
def test_charges_have_their_own_bits_in_an_ensemble(n: int) -> None:
    bodies, q = charges(n)
    scene = vv.Scene(bodies, vv.Coulomb(q, k=0.5, softening=0.2), vv.Gravity(0.1, 0.3))
    copies_have_their_own_bits(scene, 0.5, "leapfrog")


def test_charges_keep_everything_and_two_laws_add() -> None:
    bodies, q = charges(12)
    scene = vv.Scene(bodies, vv.Coulomb(q, k=0.5, softening=0.1))
    table = scene.run(t=np.linspace(0, 2, 9), rtol=1e-12).conservation()
    assert all(row.conserved for row in table.rows)
    assert all(row.max < 2e-12 for row in table.rows)
    both = vv.Scene(bodies, vv.Coulomb(q, k=0.5), vv.Coulomb(2 * q, k=0.25))
    one = vv.Scene(bodies, vv.Coulomb(q, k=1.5))
    np.testing.assert_allclose(both.acceleration(), one.acceleration(), rtol=1e-14, atol=1e-15)
    assert both.invariants().potential_energy == pytest.approx(one.invariants().potential_energy, rel=1e-14, abs=0)


@pytest.mark.parametrize("exponent", [-498, -63, 300, 498])
def test_charges_of_any_size(exponent: int) -> None:
    """k q² is what matters, though q² alone may leave the range."""
    bodies, q = charges(9)
    expected = vv.Scene(bodies, vv.Coulomb(q, k=1.0))
    scene = vv.Scene(bodies, vv.Coulomb(q * 2.0**exponent, k=2.0 ** (-2 * exponent)))
    np.testing.assert_allclose(scene.acceleration(), expected.acceleration(), rtol=1e-14)
    assert scene.invariants().potential_energy == pytest.approx(
        expected.invariants().potential_energy, rel=1e-14, abs=0
    )


@pytest.mark.parametrize(
    ("q", "gravity"), [((1.0, -2.0), 0.0), ((1.0, 2.0), 0.0), ((1.0, 2.0), 3.0), ((0.5, 0.5), 1.0)]
)
def test_two_charges_are_keplers_problem(q: tuple[float, float], gravity: float) -> None:
    pair = vv.Particles([1.0, 3.0], [[0, 0, 0], [2.0, 0, 0.5]], [[0, 0.3, 0], [0, -0.2, 0.1]])
    forces = [vv.Coulomb(q, k=1.5)] + ([vv.Gravity(gravity)] if gravity else [])
    scene = vv.Scene(pair, *forces)
    t = np.linspace(0.0, 3.0, 7)
    exact = scene.run(t=t)
    assert exact.plan.solution == "closed form: Kepler's two-body problem"
    stepped = scene.run(t=t, method="dop853", rtol=1e-13)
    np.testing.assert_allclose(exact.position, stepped.position, rtol=0, atol=1e-11)
    assert not vv.Scene(pair, vv.Coulomb(q, k=1.5, softening=0.1)).plan(t=1.0).closed_form
    # Where both cancel, they are free.
    free = vv.Scene(pair, vv.Coulomb([1.0, 3.0], k=1.0), vv.Gravity(1.0)).run(t=2.0, rtol=1e-12)
    np.testing.assert_allclose(free.position[-1], pair.position + 2 * pair.velocity, rtol=0, atol=1e-12)


def test_a_neutral_massless_body_may_be_where_a_charge_is() -> None:
    bodies = vv.Particles([1.0, 1.0, 0.0], [[0.0, 0, 0], [1.0, 0, 0], [0.0, 0, 0]], np.zeros((3, 3)))
    scene = vv.Scene(bodies, vv.Coulomb([1.0, 1.0, 0.0], k=1.0))
    assert scene.acceleration().tolist() == [[-1.0, 0, 0], [1.0, 0, 0], [0.0, 0, 0]]
    assert scene.run(t=1.0).position[-1, 2].tolist() == [0.0, 0.0, 0.0]
    with pytest.raises(vv.InvalidInput, match="distinct positions"):
        vv.Scene(vv.Particles([1.0, 1.0], np.zeros((2, 3))), vv.Coulomb([1.0, 1.0], k=1.0)).plan(t=1.0)
