"""Lattices at rest of which an end is pulled out or driven: others begin to move with ever higher powers of the time.

`taylor` measures each number by how far it goes, and that of the tenth mass goes by t²⁰: beside the rounding of
forces between masses that stand where they stood, nothing.
"""

import numpy as np
import pytest

import visviva as vv


def lattice(n: int, *, cubic: float = 0.0, driven: bool = False) -> vv.Lagrangian:
    def energy(q, v, t):  # type: ignore[no-untyped-def]
        stretched = [q[i] - q[i - 1] - 1.0 for i in range(1, n)]
        return sum(v[i] ** 2 for i in range(n)) / 2 - sum(s**2 / 2 + cubic * s**3 / 3 for s in stretched)

    position = np.arange(n) * 1.0
    position[0] -= 0.0 if driven else 0.3
    forces = {"q0": lambda _q, _v, t: np.sin(t)} if driven else None
    return vv.Lagrangian(energy, [f"q{i}" for i in range(n)], position=position, forces=forces)


@pytest.mark.parametrize("driven", [False, True])
@pytest.mark.parametrize("cubic", [0.0, 0.25])
@pytest.mark.parametrize("n", [4, 5, 8, 12, 20])
def test_a_lattice_at_rest_is_set_in_motion(n: int, cubic: float, driven: bool) -> None:
    """As by `verner98`, to some roundings of places of up to 20; steps of 1e-82 never came to an end."""
    system = lattice(n, cubic=cubic, driven=driven)
    expected = system.run(2.0, method="verner98", rtol=1e-13)
    out = system.run(2.0, method="taylor", max_steps=20_000)
    np.testing.assert_allclose(out.position[-1], expected.position[-1], rtol=0, atol=1e-13)
    np.testing.assert_allclose(out.velocity[-1], expected.velocity[-1], rtol=0, atol=1e-12)


def test_copies_and_momenta_too() -> None:
    system = lattice(6, cubic=0.25)
    alone = system.run(2.0, method="taylor")
    starts = np.stack([system.position, system.position + 0.1 * np.arange(6) % 0.3])
    copies = system.ensemble(position=starts).run(2.0, method="taylor")
    assert (copies.status == vv.Status.OK).all()
    np.testing.assert_array_equal(copies.position[0, -1], alone.position[-1])
    by_momenta = system.hamiltonian().run(2.0, method="taylor")
    np.testing.assert_allclose(by_momenta.position[-1], alone.position[-1], rtol=0, atol=1e-13)
