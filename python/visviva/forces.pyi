# Written by tools/write_stubs.py from the core's registry.
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from visviva._declared import Declared
from visviva.potentials import Potential

__all__ = [
    "CentralField",
    "Coulomb",
    "Damper",
    "Drag",
    "DrivenForce",
    "ExpressedForce",
    "Force",
    "Gravity",
    "Harmonic",
    "LinearDrag",
    "Oblate",
    "PairPotential",
    "PostNewtonian",
    "QuadraticDrag",
    "RotatingFrame",
    "SampledDrag",
    "Spring",
    "UniformElectricField",
    "UniformField",
    "UniformMagneticField",
]

class Force(Declared):
    kind: ClassVar[str]
    def __init_subclass__(cls, **arguments: Any) -> None: ...
    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> Self: ...
    def _resolved(self, names: tuple[str, ...], count: int) -> Self: ...
    def rotated(self, rotation: NDArray[np.float64]) -> Self: ...
    def reversed(self) -> Self: ...
    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Gravity(Force):
    G: float
    softening: float
    def __init__(self, G: float, softening: float = 0.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Coulomb(Force):
    charge: float | NDArray[np.float64]
    k: float
    softening: float
    def __init__(self, charge: ArrayLike, k: float, softening: float = 0.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Oblate(Force):
    body: int | str | tuple[int | str, ...] | NDArray[np.int64]
    G: float
    J2: float | NDArray[np.float64]
    radius: float | NDArray[np.float64]
    axis: tuple[float, float, float]
    J4: float | NDArray[np.float64]
    def __init__(
        self, body: ArrayLike, G: float, J2: ArrayLike, radius: ArrayLike, axis: ArrayLike, J4: ArrayLike = 0.0
    ) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class PostNewtonian(Force):
    body: int | str | tuple[int | str, ...] | NDArray[np.int64]
    G: float
    c: float
    def __init__(self, body: ArrayLike, G: float, c: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class UniformField(Force):
    g: tuple[float, float, float]
    def __init__(self, g: ArrayLike) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class CentralField(Force):
    potential: Potential
    center: tuple[float, float, float]
    def __init__(self, potential: Potential, center: ArrayLike = (0.0, 0.0, 0.0)) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Harmonic(Force):
    k: float
    center: tuple[float, float, float]
    def __init__(self, k: float, center: ArrayLike = (0.0, 0.0, 0.0)) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class LinearDrag(Force):
    tau: float
    def __init__(self, tau: float) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class QuadraticDrag(Force):
    coefficient: float | NDArray[np.float64]
    def __init__(self, coefficient: ArrayLike) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Drag(Force):
    density: float
    viscosity: float
    radius: float | NDArray[np.float64]
    law: Literal["schiller_naumann", "clift_gauvin", "turton_levenspiel", "stokes"]
    def __init__(
        self,
        density: float,
        viscosity: float,
        radius: ArrayLike,
        law: Literal["schiller_naumann", "clift_gauvin", "turton_levenspiel", "stokes"] = "schiller_naumann",
    ) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class SampledDrag(Force):
    density: float
    viscosity: float
    radius: float | NDArray[np.float64]
    breaks: NDArray[np.float64]
    coefficients: NDArray[np.float64]
    error: float
    def __init__(
        self,
        density: float,
        viscosity: float,
        radius: ArrayLike,
        breaks: ArrayLike,
        coefficients: ArrayLike,
        error: float = 0.0,
    ) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class UniformElectricField(Force):
    E: tuple[float, float, float]
    charge: float | NDArray[np.float64]
    def __init__(self, E: ArrayLike, charge: ArrayLike = 1.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class UniformMagneticField(Force):
    B: tuple[float, float, float]
    charge: float | NDArray[np.float64]
    def __init__(self, B: ArrayLike, charge: ArrayLike = 1.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class DrivenForce(Force):
    amplitude: tuple[float, float, float]
    frequency: float
    phase: float
    def __init__(self, amplitude: ArrayLike, frequency: float, phase: float = 0.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class RotatingFrame(Force):
    omega: tuple[float, float, float]
    center: tuple[float, float, float]
    def __init__(self, omega: ArrayLike, center: ArrayLike = (0.0, 0.0, 0.0)) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Spring(Force):
    i: int | str | tuple[int | str, ...] | NDArray[np.int64]
    j: int | str | tuple[int | str, ...] | NDArray[np.int64]
    k: float | NDArray[np.float64]
    length: float | NDArray[np.float64]
    def __init__(self, i: ArrayLike, j: ArrayLike, k: ArrayLike, length: ArrayLike = 0.0) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Damper(Force):
    i: int | str | tuple[int | str, ...] | NDArray[np.int64]
    j: int | str | tuple[int | str, ...] | NDArray[np.int64]
    c: float | NDArray[np.float64]
    def __init__(self, i: ArrayLike, j: ArrayLike, c: ArrayLike) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class PairPotential(Force):
    potential: Potential
    def __init__(self, potential: Potential) -> None: ...

@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class ExpressedForce(Force):
    gives: Literal["force", "potential", "acceleration"]
    nodes: NDArray[np.float64]
    values: NDArray[np.float64]
    first: tuple[float, float, float]
    second: tuple[float, float, float]
    third: tuple[float, float, float]
    origin: tuple[float, float, float]
    length: float
    mass: float
    time: float
    bodies: int | str | tuple[int | str, ...] | NDArray[np.int64] | None
    def __init__(
        self,
        gives: Literal["force", "potential", "acceleration"],
        nodes: ArrayLike,
        values: ArrayLike,
        first: ArrayLike,
        second: ArrayLike,
        third: ArrayLike,
        origin: ArrayLike = (0.0, 0.0, 0.0),
        length: float = 1.0,
        mass: float = 1.0,
        time: float = 1.0,
        bodies: ArrayLike | None = None,
    ) -> None: ...

def force_from_core(description: dict[str, Any]) -> Force: ...
