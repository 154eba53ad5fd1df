# Written by tools/write_stubs.py from the core's registry.
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self, overload

import numpy as np
import sympy
from numpy.typing import ArrayLike, NDArray

from visviva._declared import Declared
from visviva.generalized import Expression
from visviva.typing import CompiledFunction, ParameterValues, ScreeningName

__all__ = [
    "Buckingham",
    "Coulomb",
    "Custom",
    "Expressed",
    "HardSphere",
    "LennardJones",
    "Mie",
    "Morse",
    "PiecewisePolynomial",
    "Plummer",
    "Potential",
    "PowerLaw",
    "ScreenedCoulomb",
    "SoftSphere",
    "SquareWell",
    "Tabulated",
    "Yukawa",
    "potential_by_name",
]

class Potential(Declared):
    name: ClassVar[str]
    @property
    def parameters(self) -> tuple[object, ...]: ...
    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self: ...
    def value(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def force(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def curvature(self, r: ArrayLike) -> NDArray[np.float64]: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Coulomb(Potential):
    k: float
    def __init__(self, k: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class PowerLaw(Potential):
    k: float
    n: float
    def __init__(self, k: float, n: float) -> None: ...

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
class Mie(Potential):
    epsilon: float
    sigma: float
    n: float
    m: float
    def __init__(self, epsilon: float, sigma: float, n: float, m: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Morse(Potential):
    depth: float
    a: float
    r_e: float
    def __init__(self, depth: float, a: float, r_e: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Buckingham(Potential):
    A: float
    b: float
    C: float
    def __init__(self, A: float, b: float, C: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Plummer(Potential):
    k: float
    a: float
    def __init__(self, k: float, a: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class SoftSphere(Potential):
    k: float
    radius: float
    n: float
    def __init__(self, k: float, radius: float, n: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class SquareWell(Potential):
    depth: float
    radius: float
    def __init__(self, depth: float, radius: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class HardSphere(Potential):
    radius: float
    def __init__(self, radius: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class ScreenedCoulomb(Potential):
    k: float
    length: float
    screening: Literal["zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi"]
    def __init__(
        self,
        k: float,
        length: float,
        screening: Literal["zbl", "moliere", "kr_c", "lenz_jensen", "thomas_fermi"] = "zbl",
    ) -> None: ...
    @classmethod
    def between(
        cls,
        Z1: float,
        Z2: float,
        screening: ScreeningName = "zbl",
        e2: float = 14.399645478,
        bohr_radius: float = 0.529177210544,
    ) -> Self: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Tabulated(Potential):
    r: NDArray[np.float64]
    V: NDArray[np.float64]
    def __init__(self, r: ArrayLike, V: ArrayLike) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class PiecewisePolynomial(Potential):
    breaks: NDArray[np.float64]
    coefficients: NDArray[np.float64]
    error: float
    def __init__(self, breaks: ArrayLike, coefficients: ArrayLike, error: float = 0.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Expressed(Potential):
    nodes: NDArray[np.float64]
    values: NDArray[np.float64]
    length: float
    energy: float
    def __init__(self, nodes: ArrayLike, values: ArrayLike, length: float = 1.0, energy: float = 1.0) -> None: ...

@overload
def Custom(
    function: Callable[..., ArrayLike] | CompiledFunction,
    r_min: float,
    r_max: float,
    *,
    tolerance: float | None = ...,
) -> PiecewisePolynomial: ...
@overload
def Custom(
    function: sympy.Expr | Callable[..., ArrayLike | Expression],
    r_min: None = ...,
    r_max: None = ...,
    *,
    tolerance: None = ...,
    parameters: ParameterValues | None = ...,
) -> Expressed: ...
def potential_by_name(name: str, parameters: Sequence[object]) -> Potential: ...
def potential_from_core(description: dict[str, Any]) -> Potential: ...
