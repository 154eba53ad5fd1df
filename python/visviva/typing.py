"""Types to annotate with: the names that `run` and `solve_ivp` take, and what they report to.

`MethodName`, `SolverName` (of `solve_ivp`) and `ColumnName` are written by ``tools/write_names.py`` from what the core
has; a test compares.
"""

from collections.abc import Callable
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from visviva._progress import Progress, Report

__all__ = ["ColumnName", "EventFunction", "MethodName", "Progress", "Report", "SolverName"]

EventFunction: TypeAlias = Callable[[float, NDArray[np.float64], NDArray[np.float64]], Any]
"""A function of time, positions (N, 3) and velocities (N, 3) whose zeros are events."""

# written by tools/write_names.py: begin
MethodName: TypeAlias = Literal[
    "auto",
    "bogacki_shampine32",
    "boris",
    "dop853",
    "dormand_prince54",
    "kahan_li8",
    "leapfrog",
    "rk4",
    "stormer13",
    "yoshida4",
]
SolverName: TypeAlias = Literal["DOP853", "RK23", "RK45", "bogacki_shampine32", "dop853", "dormand_prince54", "rk4"]
ColumnName: TypeAlias = Literal[
    "angular_momentum",
    "center_of_mass",
    "energy",
    "kinetic_energy",
    "momentum",
    "position",
    "potential_energy",
    "velocity",
    "virial",
]
# written by tools/write_names.py: end


def __dir__() -> list[str]:
    return list(__all__)
