"""Systems for variational integrators: of every kind that they take."""

from typing import Any

import numpy as np

import visviva as vv

ORDERS = {
    "variational_midpoint": 2,
    "variational_trapezoidal": 2,
    "variational_lobatto4": 4,
    "variational_lobatto6": 6,
    "variational_lobatto8": 8,
}


def charge_in_a_well(**start: Any) -> vv.Lagrangian:
    """A central force and a magnetic field along z, in x and y: the canonical angular momentum is conserved."""

    def L(q: Any, v: Any, t: Any, B: Any) -> Any:
        r2 = q[0] ** 2 + q[1] ** 2
        return (v[0] ** 2 + v[1] ** 2) / 2 + B * (q[0] * v[1] - q[1] * v[0]) / 2 - r2 / 2 - r2**2 / 8

    start = {"position": [1.0, 0.2], "velocity": [0.1, 0.8], **start}
    return vv.Lagrangian(L, ["x", "y"], parameters={"B": 0.7}, **start)


def relativistic() -> vv.Lagrangian:
    """Not quadratic in the velocity."""
    return vv.Lagrangian(
        lambda q, v, t: -np.sqrt(1.0 - v[0] ** 2) - q[0] ** 2 / 2 - q[0] ** 4 / 8, ["x"], position=[1.0], velocity=[0.3]
    )


def dragged(R: float = 0.3) -> vv.Lagrangian:
    """A pendulum with drag, a drive that depends on the velocity and time in the Lagrangian."""
    return vv.Lagrangian(
        lambda q, v, t: (1 + 0.2 * np.sin(t)) * v[0] ** 2 / 2 + np.cos(q[0]),
        ["theta"],
        position=[1.0],
        velocity=[0.5],
        dissipation=lambda q, v, t: R * v[0] ** 2 / 2,
        forces={"theta": lambda q, v, t: 0.4 * np.cos(2 * t) * (1 + q[0] * v[0])},
    )


def systems() -> dict[str, Any]:
    return {
        "pendulum": vv.systems.pendulum(g=1.0, position=[2.0]),
        "double_pendulum": vv.systems.double_pendulum(g=1.0, position=[1.0, 1.5]),
        "spring_pendulum": vv.systems.spring_pendulum(position=[0.3, 0.8]).at(parameters={"g": 1.0, "k": 4.0}),
        "spherical_pendulum": vv.systems.spherical_pendulum(g=1.0, position=[1.0, 0.0], velocity=[0.2, 0.7]),
        "kapitza": vv.systems.kapitza(g=1.0, a=0.1, Omega=3.0, position=[1.0]),
        "charge": charge_in_a_well(),
        "relativistic": relativistic(),
        "dragged": dragged(),
    }
