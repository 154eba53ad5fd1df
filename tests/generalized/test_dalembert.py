"""d'Alembert's principle along constrained runs, and that what is no reaction is seen."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

T = np.linspace(0.0, 2.0, 41)


def rod(**further: Any) -> vv.Lagrangian:
    return vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - 9.81 * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: q[0] ** 2 + q[1] ** 2 - 1],
        position=[1.0, 0.0],
        **further,
    )


SYSTEMS: dict[str, vv.Lagrangian] = {
    "pendulum": rod(),
    "with friction": rod(dissipation=lambda q, v, t: 0.2 * (v[0] ** 2 + v[1] ** 2)),
    "pushed": rod(forces={"x": lambda q, v, t: np.sin(3 * t) * q[1]}),
    "moving": vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - 9.81 * q[1],
        ["x", "y"],
        constraints=[lambda q, v, t: (q[0] - 0.2 * np.sin(2 * t)) ** 2 + q[1] ** 2 - 1],
        position=[0.0, -1.0],
        velocity=[0.4, 0.0],
    ),
    "skate": vv.Lagrangian(
        lambda q, v, t: (v[0] ** 2 + v[1] ** 2 + 0.3 * v[2] ** 2) / 2 - q[0],
        ["x", "y", "angle"],
        nonholonomic=[lambda q, v, t: np.sin(q[2]) * v[0] - np.cos(q[2]) * v[1]],
        position=[0.0, 0.0, 0.3],
        velocity=[np.cos(0.3), np.sin(0.3), 0.5],
    ),
    "atwood": vv.systems.atwood(),
    "free": vv.systems.double_pendulum(position=[1.0, -0.5]),
    "driven": vv.systems.kapitza(),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_reactions_do_no_virtual_work(name: str) -> None:
    system = SYSTEMS[name]
    residual = system.dalembert(system.run(T if name != "atwood" else T / 10))
    assert residual.shape == T.shape
    # Of the sum of all terms: a solution of some equations by elimination.
    assert residual.max() <= 1e-14


def test_what_is_no_reaction_is_seen() -> None:
    """A run with a force that the Lagrangian does not know of, and one on another curve."""
    plain = SYSTEMS["pendulum"]
    assert plain.dalembert(SYSTEMS["pushed"].run(T))[1:].max() > 1e-3
    flat = vv.Lagrangian(lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - 9.81 * q[1], ["x", "y"], position=[1.0, 0.0])
    assert plain.dalembert(flat.run(T)).max() <= 1e-14  # free fall needs no reactions
    assert flat.dalembert(plain.run(T)).max() > 1e-2  # all displacements are virtual, and the rod pulls


def test_refused() -> None:
    with pytest.raises(vv.errors.InvalidInput, match=r"trajectory: expected a run of a Lagrangian of \['x', 'y'\]"):
        SYSTEMS["pendulum"].dalembert(SYSTEMS["skate"].run(1.0))
    hamiltonian = vv.systems.henon_heiles()
    with pytest.raises(vv.errors.InvalidInput, match="a run of a Lagrangian"):
        hamiltonian.lagrangian().dalembert(hamiltonian.run(1.0))
