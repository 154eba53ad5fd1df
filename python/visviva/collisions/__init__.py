"""Collisions of two bodies in space: what becomes of their velocities, and the impulse between them.

The one idea: only the relative velocity changes, by what the line of centers or the direction of parting says; each
body takes the other's share of the mass of the change, so that momentum is conserved by construction. Vectors have
their three components along the last axis; all arguments broadcast against each other over the axes before it.

Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.11; Landau & Lifshitz, *Mechanics*, §16–17.
"""

from typing import TYPE_CHECKING

from visviva._keywords import unknown_name
from visviva.collision_table import CollisionTable
from visviva.collisions._impacts import (
    CollisionOutcome,
    contact_time,
    elastic,
    impulse,
    inelastic,
    line_of_centers,
    restitution,
)
from visviva.collisions._relative import from_relative, reduced_mass, to_relative

__all__ = [
    "CollisionOutcome",
    "CollisionTable",
    "contact_time",
    "elastic",
    "from_relative",
    "impulse",
    "inelastic",
    "line_of_centers",
    "reduced_mass",
    "restitution",
    "to_relative",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
