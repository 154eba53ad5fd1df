# Written by tools/write_stubs.py from the core's registry.
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from visviva._declared import Declared
from visviva.potentials import Potential

__all__ = ["CentralField", "Force", "Gravity", "UniformField"]

class Force(Declared):
    kind: ClassVar[str]
    def __init_subclass__(cls, **arguments: Any) -> None: ...
    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> Self: ...
    def rotated(self, rotation: NDArray[np.float64]) -> Self: ...
    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Gravity(Force):
    G: float
    softening: float
    def __init__(self, G: float, softening: float = 0.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class UniformField(Force):
    g: tuple[float, float, float]
    def __init__(self, g: ArrayLike) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class CentralField(Force):
    potential: Potential
    center: tuple[float, float, float]
    def __init__(self, potential: Potential, center: ArrayLike = (0.0, 0.0, 0.0)) -> None: ...

def force_from_core(description: dict[str, Any]) -> Force: ...
