"""Lagrangians and Hamiltonians: an expression in, equations of motion at native speed out.

`Lagrangian` and `Hamiltonian` take an expression of SymPy, or a plain function of Python that is called once. The core
makes a graph of it, derives the equations there, and runs them; nothing is compiled, and parameters change without a
new derivation. The names here are those of `visviva` itself.

Units are those of the parameters. Source: Goldstein, Poole & Safko, *Classical Mechanics* 3rd ed. ch. 1, 2, 6 and 8.
"""

from typing import TYPE_CHECKING

from visviva._keywords import unknown_name
from visviva.generalized._accessory import AccessoryProblem
from visviva.generalized._action import PathIntegral
from visviva.generalized._analysis import Linearization
from visviva.generalized._canonical import CanonicalTest
from visviva.generalized._discrete import DiscreteAction
from visviva.generalized._ensemble import GeneralizedEnsemble
from visviva.generalized._ensemble_trajectory import GeneralizedEnsembleTrajectory
from visviva.generalized._equations import EquationsOfMotion, HamiltonsEquations
from visviva.generalized._equilibria import Equilibrium
from visviva.generalized._events import GeneralizedEventTable
from visviva.generalized._hamiltonian import Hamiltonian
from visviva.generalized._lagrangian import Lagrangian
from visviva.generalized._legendre import LegendreTransform
from visviva.generalized._nodes import Expression
from visviva.generalized._noether import NoetherSymmetry
from visviva.generalized._plan import GeneralizedPlan
from visviva.generalized._section import PoincareSection
from visviva.generalized._stats import GeneralizedStats
from visviva.generalized._symbolic import coordinate, time
from visviva.generalized._system import GeneralizedSystem
from visviva.generalized._trajectory import GeneralizedTrajectory

__all__ = [
    "AccessoryProblem",
    "CanonicalTest",
    "DiscreteAction",
    "EquationsOfMotion",
    "Equilibrium",
    "Expression",
    "GeneralizedEnsemble",
    "GeneralizedEnsembleTrajectory",
    "GeneralizedEventTable",
    "GeneralizedPlan",
    "GeneralizedStats",
    "GeneralizedSystem",
    "GeneralizedTrajectory",
    "Hamiltonian",
    "HamiltonsEquations",
    "Lagrangian",
    "LegendreTransform",
    "Linearization",
    "NoetherSymmetry",
    "PathIntegral",
    "PoincareSection",
    "coordinate",
    "time",
]


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
