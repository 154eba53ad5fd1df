"""Scattering of a beam: closed forms, two-body kinematics, Monte Carlo.

Angles are in radians. ``energy`` is that of relative motion, ½μu²; ``beam_energy`` is the projectile's in the
laboratory, where the target is at rest. ``mass_ratio`` is m₁/m₂, projectile over target. The functions of one array
keep its shape.
"""

from visviva.scattering._deflection import Deflection, DeflectionStatus, deflect, deflection_angle
from visviva.scattering._kinematics import cm_angle, energy_transfer, lab_angle, recoil_angle
from visviva.scattering._monte_carlo import monte_carlo, scattering_events
from visviva.scattering._result import MonteCarlo
from visviva.scattering._rutherford import (
    rutherford_angle,
    rutherford_closest_approach,
    rutherford_cross_section,
    rutherford_impact_parameter,
)
from visviva.scattering._tally import Beam, CrossSection, JointTally, Spectrum, Tally

__all__ = [
    "Beam",
    "CrossSection",
    "Deflection",
    "DeflectionStatus",
    "JointTally",
    "MonteCarlo",
    "Spectrum",
    "Tally",
    "cm_angle",
    "deflect",
    "deflection_angle",
    "energy_transfer",
    "lab_angle",
    "monte_carlo",
    "recoil_angle",
    "rutherford_angle",
    "rutherford_closest_approach",
    "rutherford_cross_section",
    "rutherford_impact_parameter",
    "scattering_events",
]


def __dir__() -> list[str]:
    return list(__all__)
