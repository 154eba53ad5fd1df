"""Scattering of a beam: closed forms, two-body kinematics, Monte Carlo.

Angles are in radians. ``energy`` is that of relative motion, ½μu²; ``beam_energy`` is the projectile's in the
laboratory, where the target is at rest. ``mass_ratio`` is m₁/m₂, projectile over target. Arguments of the kinematics
broadcast against each other; the functions of one array keep its shape. Energies and lengths are in the units of the
potential; those of a `Foil` in eV, Å and µm.

Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. §3.10–3.11; Landau & Lifshitz, *Mechanics*, 3rd ed.,
§16–20.
"""

from typing import TYPE_CHECKING

from visviva._keywords import unknown_name
from visviva.scattering._beam import Beam, Spectrum, Spread
from visviva.scattering._bins import Bins
from visviva.scattering._channels import Channel
from visviva.scattering._cross_sections import (
    capture_cross_section,
    collision_integral,
    cross_section,
    nuclear_stopping,
    total_cross_section,
    transport_cross_section,
)
from visviva.scattering._deflection import Deflection, DeflectionStatus, deflect, deflection_angle
from visviva.scattering._energies import (
    energy_kept,
    energy_transfer,
    greatest_lab_angle,
    greatest_recoil_angle,
    kinematic_factor,
    threshold_energy,
    two_branch_energy,
)
from visviva.scattering._events import scattering_events
from visviva.scattering._foil import Foil
from visviva.scattering._foil_material import Ion, Material
from visviva.scattering._foil_result import Bombardment, FoilResult
from visviva.scattering._foil_tally import FoilTally, Fraction
from visviva.scattering._importance import LargeAngles, Strata
from visviva.scattering._joint_tally import JointTally
from visviva.scattering._kinematics import (
    cm_angle,
    cm_angle_from_recoil,
    lab_angle,
    lab_jacobian,
    opening_angle,
    recoil_angle,
    recoil_jacobian,
)
from visviva.scattering._moderation import Moderation, moderation
from visviva.scattering._monte_carlo import monte_carlo
from visviva.scattering._result import MonteCarlo
from visviva.scattering._rutherford import (
    rutherford_angle,
    rutherford_closest_approach,
    rutherford_cross_section,
    rutherford_impact_parameter,
)
from visviva.scattering._structure import Glory, Orbit, Rainbow, glories, impact_parameter, orbiting, rainbows
from visviva.scattering._tally import CrossSection, Tally

__all__ = [
    "Beam",
    "Bins",
    "Bombardment",
    "Channel",
    "CrossSection",
    "Deflection",
    "DeflectionStatus",
    "Foil",
    "FoilResult",
    "FoilTally",
    "Fraction",
    "Glory",
    "Ion",
    "JointTally",
    "LargeAngles",
    "Material",
    "Moderation",
    "MonteCarlo",
    "Orbit",
    "Rainbow",
    "Spectrum",
    "Spread",
    "Strata",
    "Tally",
    "capture_cross_section",
    "cm_angle",
    "cm_angle_from_recoil",
    "collision_integral",
    "cross_section",
    "deflect",
    "deflection_angle",
    "energy_kept",
    "energy_transfer",
    "glories",
    "greatest_lab_angle",
    "greatest_recoil_angle",
    "impact_parameter",
    "kinematic_factor",
    "lab_angle",
    "lab_jacobian",
    "moderation",
    "monte_carlo",
    "nuclear_stopping",
    "opening_angle",
    "orbiting",
    "rainbows",
    "recoil_angle",
    "recoil_jacobian",
    "rutherford_angle",
    "rutherford_closest_approach",
    "rutherford_cross_section",
    "rutherford_impact_parameter",
    "scattering_events",
    "threshold_energy",
    "total_cross_section",
    "transport_cross_section",
    "two_branch_energy",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
