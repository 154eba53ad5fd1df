# Written by tools/write_stubs.py from the core's registry.
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from visviva._declared import Declared

__all__ = ["Coulomb", "LennardJones", "Potential", "Tabulated", "Yukawa", "potential_by_name"]

class Potential(Declared):
    name: ClassVar[str]
    @property
    def parameters(self) -> tuple[Any, ...]: ...
    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self: ...
    def value(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def force(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def curvature(self, r: ArrayLike) -> NDArray[np.float64]: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Coulomb(Potential):
    k: float
    def __init__(self, k: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Yukawa(Potential):
    k: float
    length: float
    def __init__(self, k: float, length: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class LennardJones(Potential):
    epsilon: float
    sigma: float
    def __init__(self, epsilon: float, sigma: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Tabulated(Potential):
    r: NDArray[np.float64]
    V: NDArray[np.float64]
    def __init__(self, r: ArrayLike, V: ArrayLike) -> None: ...

def potential_by_name(name: str, parameters: Sequence[Any]) -> Potential: ...
def potential_from_core(description: dict[str, Any]) -> Potential: ...
