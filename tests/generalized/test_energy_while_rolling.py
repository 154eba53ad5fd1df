"""What holds a motion to velocities that may be zero does no work: the energy is told as conserved, and watched."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import visviva as vv


def edge(constraint: Any, velocity: Any = (1.0, 0.0, 2.0), potential: Any = lambda q: 3.0 * q[0]) -> vv.Lagrangian:
    """A knife edge on an incline, which goes where its constraint lets it."""
    return vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2 + v[2] ** 2 / 2) / 2 - potential(q),
        ["x", "y", "angle"],
        nonholonomic=[constraint],
        position=[0.0, 0.0, 0.0],
        velocity=velocity,
    )


def along(q: Any, v: Any, t: Any) -> Any:
    return np.sin(q[2]) * v[0] - np.cos(q[2]) * v[1]


def turning(q: Any, v: Any, t: Any) -> Any:
    """The edge turns under the body as time goes on: homogeneous in the velocities all the same."""
    return np.sin(q[2] + t) * v[0] - np.cos(q[2] + t) * v[1]


def driven(q: Any, v: Any, t: Any) -> Any:
    """It slips sideways at a speed that is given."""
    return np.sin(q[2]) * v[0] - np.cos(q[2]) * v[1] + 0.5


def test_a_knife_edge_keeps_its_energy() -> None:
    blade = edge(along)
    assert blade.conserved == ["energy", "momentum of angle"]
    run = blade.run(t=np.linspace(0.0, 10.0, 11))
    # Of an energy of 2 that is made of what falls by as much and more.
    np.testing.assert_allclose(run.energy, run.energy[0], rtol=0, atol=1e-12)
    assert run.conservation()["energy"] < 1e-12


def test_also_where_the_edge_turns_with_the_time() -> None:
    blade = edge(turning)
    assert "energy" in blade.conserved
    run = blade.run(t=np.linspace(0.0, 10.0, 11))
    np.testing.assert_allclose(run.energy, run.energy[0], rtol=0, atol=1e-11)


def test_not_where_it_is_driven() -> None:
    blade = edge(driven, (1.0, 0.5, 2.0))
    assert "energy" not in blade.conserved
    run = blade.run(t=np.linspace(0.0, 10.0, 11))
    assert "energy" not in run.conservation()
    assert np.ptp(run.energy) > 0.1


def test_steps_too_long_for_it_are_told() -> None:
    """Without a quantity that is kept nothing told that equal steps resolve nothing."""
    with pytest.warns(vv.AccuracyWarning):
        edge(along, potential=lambda q: 40.0 * np.sin(5.0 * q[0])).run(t=10.0, method="rk4", dt=0.25)
