"""Types to annotate with: the names that `run` takes, and what it reports to.

`MethodName` and `ColumnName` are written by ``tools/write_names.py`` from what the core has; a test compares.
"""

from typing import Literal, TypeAlias

from visviva._progress import Progress, Report

__all__ = ["ColumnName", "MethodName", "Progress", "Report"]

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
