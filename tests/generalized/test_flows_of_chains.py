"""Derivatives of the flow of more than sixteen coordinates: whatever their variational equations have room for."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import visviva as vv


def fermi_pasta_ulam_tsingou(n: int) -> vv.Lagrangian:
    """A chain of unit masses between walls, with springs of cubic potentials; its lowest mode at the start."""

    def lagrangian(q: list, v: list, t: object) -> object:  # type: ignore[type-arg]
        places = [0.0, *q, 0.0]
        stretched = [right - left for left, right in pairwise(places)]
        return sum(rate**2 for rate in v) / 2 - sum(s**2 / 2 + s**3 / 12 for s in stretched)

    position = np.sin(np.pi * np.arange(1, n + 1) / (n + 1))
    return vv.Lagrangian(lagrangian, [f"q{k}" for k in range(n)], position=position, velocity=np.zeros(n))


def test_a_chain_of_twenty_flows_symplectically() -> None:
    n = 20
    jacobian = fermi_pasta_ulam_tsingou(n).flow_jacobian(5.0)
    unit = np.block([[np.zeros((n, n)), np.eye(n)], [-np.eye(n), np.zeros((n, n))]])
    # Of unit masses velocities are momenta: sums of forty products of numbers of order 1, in steps of 1e-16.
    assert np.abs(jacobian.T @ unit @ jacobian - unit).max() < 1e-13
    # Beside the differences of neighbors, which lose half of the digits.
    system, step = fermi_pasta_ulam_tsingou(n), 1e-6
    starts = system.position + step * np.eye(n)[3] * np.array([[1.0], [-1.0]])
    ahead, behind = system.ensemble(position=starts).run(5.0).position[:, -1]
    np.testing.assert_allclose(jacobian[:n, 3], (ahead - behind) / (2 * step), rtol=0.0, atol=1e-8)


def test_variational_equations_without_room_are_refused() -> None:
    chain = vv.systems.chain(40, position=[0.1] * 40)
    with pytest.raises(vv.InvalidInput, match=r"its variational equations would be made of some .* neighboring starts"):
        chain.flow_jacobian(0.1)
