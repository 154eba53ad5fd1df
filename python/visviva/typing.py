"""Types to annotate with: the names that `run` and `solve_ivp` take, and what they report to.

`MethodName`, `SolverName` (of `solve_ivp`) and `ColumnName` are written by ``tools/write_names.py`` from what the core
has; a test compares. `TransformationName` is what a time transformation watches. `GeneralizedMethodName`,
`DiscreteMethodName` and `GeneralizedColumnName` are those of systems in generalized coordinates; `TallyName` and
`FoilTallyName` what Monte Carlo runs count.
"""

from collections.abc import Callable
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from visviva._progress import Progress, Report

__all__ = [
    "CollisionRule",
    "ColumnName",
    "DiscreteMethodName",
    "EventFunction",
    "FoilTallyName",
    "GeneralizedColumnName",
    "GeneralizedMethodName",
    "MethodName",
    "Progress",
    "Report",
    "SolverName",
    "TallyName",
    "TransformationName",
]

EventFunction: TypeAlias = Callable[[float, NDArray[np.float64], NDArray[np.float64]], Any]
"""A function of time, positions (N, 3) and velocities (N, 3) whose zeros are events."""

CollisionRule: TypeAlias = Literal["merge", "bounce", "stop"]
"""What spheres do that touch."""

TransformationName: TypeAlias = Literal["potential_energy", "distance"]

GeneralizedColumnName: TypeAlias = Literal["position", "velocity", "momentum", "energy", "reactions"]
"""What a run in generalized coordinates knows at its times."""

TallyName: TypeAlias = Literal["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy", "impact_parameter"]
"""What `visviva.scattering.monte_carlo` counts of an event."""

FoilTallyName: TypeAlias = Literal[
    "lab_angle",
    "transmitted_angle",
    "reflected_angle",
    "transmitted_energy",
    "reflected_energy",
    "stopped_depth",
    "cm_angle",
]
"""What `visviva.scattering.Foil` counts of an ion."""

DiscreteMethodName: TypeAlias = Literal[
    "variational_midpoint",
    "variational_trapezoidal",
    "variational_lobatto4",
    "variational_lobatto6",
    "variational_lobatto8",
]
"""Methods that make the action of a discrete path stationary."""

# written by tools/write_names.py: begin
MethodName: TypeAlias = Literal[
    "auto",
    "blanes_moan_rkn4",
    "blanes_moan_rkn6_11",
    "blanes_moan_rkn6_14",
    "blanes_moan_s10",
    "blanes_moan_s6",
    "bogacki_shampine32",
    "boris",
    "boris4",
    "dop853",
    "dormand_prince54",
    "euler",
    "heun",
    "kahan_li6",
    "kahan_li8",
    "leapfrog",
    "leapfrog_dkd",
    "mclachlan4",
    "midpoint",
    "moser_veselov10",
    "moser_veselov2",
    "moser_veselov4",
    "moser_veselov6",
    "moser_veselov8",
    "pefrl4",
    "rattle",
    "rk4",
    "ruth3",
    "sofroniou_spaletta10",
    "sofroniou_spaletta6",
    "sofroniou_spaletta8",
    "stormer13",
    "symplectic_euler",
    "taylor",
    "tsitouras54",
    "verner98",
    "yoshida4",
    "yoshida6",
    "yoshida8",
]
SolverName: TypeAlias = Literal[
    "DOP853",
    "RK23",
    "RK45",
    "bogacki_shampine32",
    "dop853",
    "dormand_prince54",
    "euler",
    "heun",
    "midpoint",
    "rk4",
    "tsitouras54",
    "verner98",
]
ColumnName: TypeAlias = Literal[
    "angular_momentum",
    "angular_velocity",
    "center_of_mass",
    "energy",
    "kinetic_energy",
    "momentum",
    "orientation",
    "position",
    "potential_energy",
    "velocity",
    "virial",
]
# written by tools/write_names.py: end

GeneralizedMethodName: TypeAlias = (
    MethodName
    | DiscreteMethodName
    | Literal["gauss4", "gauss8", "gauss16", "matrix_exponential", "rattle", "rattle4", "rattle6", "rattle8"]
)
"""Methods of systems in generalized coordinates; which of them takes a system, its plan says."""


def __dir__() -> list[str]:
    return list(__all__)
