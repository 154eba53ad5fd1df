"""Scattering of a beam: closed forms, two-body kinematics, Monte Carlo.

Angles are in radians. ``energy`` is that of relative motion, ½μu²; ``beam_energy`` is the projectile's in the
laboratory, where the target is at rest. ``mass_ratio`` is m₁/m₂, projectile over target. The functions of one array
keep its shape.
"""

from visviva.scattering._cross_sections import (
    capture_cross_section,
    collision_integral,
    cross_section,
    nuclear_stopping,
    total_cross_section,
    transport_cross_section,
)
from visviva.scattering._deflection import Deflection, DeflectionStatus, deflect, deflection_angle
from visviva.scattering._kinematics import cm_angle, energy_transfer, lab_angle, recoil_angle
from visviva.scattering._monte_carlo import monte_carlo
from visviva.scattering._rutherford import (
    rutherford_angle,
    rutherford_closest_approach,
    rutherford_cross_section,
    rutherford_impact_parameter,
)
from visviva.scattering._structure import Glory, Orbit, Rainbow, glories, impact_parameter, orbiting, rainbows
from visviva.scattering._tally import Beam, CrossSection, MonteCarlo, Tally

__all__ = [
    "Beam",
    "CrossSection",
    "Deflection",
    "DeflectionStatus",
    "Glory",
    "MonteCarlo",
    "Orbit",
    "Rainbow",
    "Tally",
    "capture_cross_section",
    "cm_angle",
    "collision_integral",
    "cross_section",
    "deflect",
    "deflection_angle",
    "energy_transfer",
    "glories",
    "impact_parameter",
    "lab_angle",
    "monte_carlo",
    "nuclear_stopping",
    "orbiting",
    "rainbows",
    "recoil_angle",
    "rutherford_angle",
    "rutherford_closest_approach",
    "rutherford_cross_section",
    "rutherford_impact_parameter",
    "total_cross_section",
    "transport_cross_section",
]


def __dir__() -> list[str]:
    return list(__all__)
