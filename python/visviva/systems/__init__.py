"""Ready-made systems: each a Lagrangian or a Hamiltonian with named parameters and a start.

Every function takes its parameters, position and velocity by keyword; ``at`` changes them later without a new
derivation, and ``ensemble`` runs many at once. None needs SymPy, but to show equations.

Angles of pendulums are from the downward vertical. Units are those of the parameters: meters, kilograms and seconds
where they have a ``g``.

Examples
--------
>>> import numpy as np, visviva as vv
>>> out = vv.systems.pendulum(position=[3.0]).run(t=np.linspace(0.0, 10.0, 11))
>>> round(float(out["theta"][-1]), 9), out.conservation()["energy"] < 1e-14
(2.925055676, True)
"""

from typing import TYPE_CHECKING

from visviva._keywords import unknown_name
from visviva.systems._driven import hoop, kapitza, moving_pivot, rod
from visviva.systems._fields import central_force, charged_particle, henon_heiles
from visviva.systems._oscillators import constant_force, coupled_oscillators, foucault, oscillator
from visviva.systems._pendulums import (
    cart_pendulum,
    chain,
    double_pendulum,
    pendulum,
    spherical_pendulum,
    spring_pendulum,
)
from visviva.systems._strings import atwood, swinging_atwood

__all__ = [
    "atwood",
    "cart_pendulum",
    "central_force",
    "chain",
    "charged_particle",
    "constant_force",
    "coupled_oscillators",
    "double_pendulum",
    "foucault",
    "henon_heiles",
    "hoop",
    "kapitza",
    "moving_pivot",
    "oscillator",
    "pendulum",
    "rod",
    "spherical_pendulum",
    "spring_pendulum",
    "swinging_atwood",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
