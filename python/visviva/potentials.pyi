from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Coulomb", "LennardJones", "Potential", "Yukawa", "potential_by_name"]

class Potential:
    name: ClassVar[str]
    def __post_init__(self) -> None: ...
    @property
    def parameters(self) -> tuple[float, ...]: ...
    def value(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def force(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def curvature(self, r: ArrayLike) -> NDArray[np.float64]: ...

@dataclass(frozen=True, slots=True)
class Coulomb(Potential):
    k: float

@dataclass(frozen=True, slots=True)
class Yukawa(Potential):
    k: float
    length: float

@dataclass(frozen=True, slots=True)
class LennardJones(Potential):
    epsilon: float
    sigma: float

def potential_by_name(name: str, parameters: Sequence[float]) -> Potential: ...
