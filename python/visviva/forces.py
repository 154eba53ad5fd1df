"""Forces: what acts on the particles, as frozen descriptions that the core reads.

To add a force: one class here with its `kind` (the word the core knows it by) and its symmetries;
everything else — saving, loading, change of frame, the notes of the conservation table — follows.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from visviva._arrays import float_array, in_range, number, positive
from visviva._keywords import known_keywords, refuse_subclass
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential

__all__ = ["CentralField", "Force", "Gravity", "UniformField"]

_Vector = tuple[float, float, float]


class Force(ABC):
    """What every force says about itself."""

    __slots__ = ()

    kind: ClassVar[str]
    conserves_momentum: ClassVar[bool]
    # About the moving centre of mass.
    conserves_spin: ClassVar[bool]

    def __init_subclass__(cls) -> None:
        refuse_subclass(cls, "use Gravity, UniformField and CentralField, which add")

    @abstractmethod
    def conserves_angular_momentum(self, about: NDArray[np.float64]) -> bool:
        """Whether it leaves the angular momentum about the point ``about`` (3,) constant."""

    @abstractmethod
    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> Force:
        """The force as it acts on bodies displaced by ``position`` (3,) and boosted by ``velocity`` (3,)."""

    @abstractmethod
    def rotated(self, rotation: NDArray[np.float64]) -> Force:
        """The force as it acts on bodies turned (or reflected) by an orthogonal matrix (3, 3)."""

    @abstractmethod
    def rescaled(self, *, length: float, mass: float, time: float) -> Force:
        """The force in units of which ``length``, ``mass`` and ``time`` make one old unit."""

    @abstractmethod
    def _to_core(self) -> dict[str, Any]:
        """The dictionary by which the core and a file know the force."""

    @classmethod
    def _from_core(cls, description: dict[str, Any]) -> Self:
        return cls(**{name: value for name, value in description.items() if name != "kind"})


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class Gravity(Force):
    """Newton's law between every two bodies: V = −Σ G mᵢ mⱼ / √(r² + softening²).

    Parameters
    ----------
    G : float
        The gravitational constant in the units of the scene.
    softening : float, optional
        Plummer softening length. Without it, coincident bodies are refused.

    Raises
    ------
    visviva.InvalidInput
        If either is not a finite real number, or the softening is negative.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.Gravity(G=1.0)
    Gravity(G=1.0, softening=0.0)
    """

    kind: ClassVar[str] = "gravity"
    conserves_momentum: ClassVar[bool] = True
    conserves_spin: ClassVar[bool] = True

    G: float
    softening: float

    def __init__(self, G: float, softening: float = 0.0) -> None:
        object.__setattr__(self, "G", number("G", G))
        length = number("softening", softening)
        if length < 0.0:
            raise InvalidInput("softening", f"expected a length of at least 0, got {length!r}")
        object.__setattr__(self, "softening", length)

    def conserves_angular_momentum(self, about: NDArray[np.float64]) -> bool:
        """Always: the forces of a pair are opposite and along the line between the two."""
        return True

    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> Gravity:
        """Itself: only relative positions enter."""
        return self

    def rotated(self, rotation: NDArray[np.float64]) -> Gravity:
        """Itself: only distances enter."""
        return self

    def rescaled(self, *, length: float, mass: float, time: float) -> Gravity:
        """G has the dimension length³ / (mass · time²)."""
        scales = length, mass, time
        return Gravity(
            _in_units("G", self.G, (3, -1, -2), *scales), in_range("softening", self.softening, self.softening * length)
        )

    def _to_core(self) -> dict[str, Any]:
        return {"kind": self.kind, "G": self.G, "softening": self.softening}


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class UniformField(Force):
    """The same acceleration g everywhere: V = −Σ mᵢ g·rᵢ.

    Parameters
    ----------
    g : array_like, shape (3,)
        The acceleration.

    Raises
    ------
    visviva.InvalidInput
        If it is not three finite real numbers.

    Examples
    --------
    >>> import visviva as vv
    >>> ball = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.0, 2.0]]), vv.UniformField([0, 0, -8]))
    >>> ball.run(t=0.5).position[-1, 0]
    array([0.5, 0. , 0. ])
    """

    kind: ClassVar[str] = "uniform_field"
    conserves_momentum: ClassVar[bool] = False
    conserves_spin: ClassVar[bool] = True

    g: _Vector

    def __init__(self, g: ArrayLike) -> None:
        object.__setattr__(self, "g", _vector("g", g))

    def conserves_angular_momentum(self, about: NDArray[np.float64]) -> bool:
        """No: its torque about any fixed point is M (R − a) × g."""
        return False

    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> UniformField:
        """Itself: it is the same everywhere."""
        return self

    def rotated(self, rotation: NDArray[np.float64]) -> UniformField:
        """The field turned with the bodies."""
        return UniformField(rotation @ np.array(self.g))

    def rescaled(self, *, length: float, mass: float, time: float) -> UniformField:
        """An acceleration: length / time²."""
        return UniformField([_in_units("g", component, (1, 0, -2), length, mass, time) for component in self.g])

    def _to_core(self) -> dict[str, Any]:
        return {"kind": self.kind, "g": np.array(self.g)}


@known_keywords
@dataclass(frozen=True, slots=True, init=False)
class CentralField(Force):
    """A potential V(r) around a fixed point, felt by every body: F = −dV/dr r̂.

    Parameters
    ----------
    potential : visviva.potentials.Potential
        The potential energy of one body at the distance r.
    center : array_like, shape (3,), optional
        The fixed point.

    Raises
    ------
    visviva.InvalidInput
        If ``potential`` is not a potential, or ``center`` not three finite real numbers.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.CentralField(vv.potentials.Coulomb(k=-1.0))
    CentralField(potential=Coulomb(k=-1.0), center=(0.0, 0.0, 0.0))
    """

    kind: ClassVar[str] = "central_field"
    conserves_momentum: ClassVar[bool] = False
    conserves_spin: ClassVar[bool] = False

    potential: Potential
    center: _Vector

    def __init__(self, potential: Potential, center: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        from visviva.potentials import Potential

        if not isinstance(potential, Potential):
            raise InvalidInput(
                "potential",
                f"expected one of visviva.potentials, for example Coulomb(k=-1.0), got {type(potential).__name__}",
            )
        object.__setattr__(self, "potential", potential)
        object.__setattr__(self, "center", _vector("center", center))

    def conserves_angular_momentum(self, about: NDArray[np.float64]) -> bool:
        """About its own centre only."""
        return bool(np.array_equal(about, self.center))

    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> CentralField:
        """The field around the displaced centre; a moving centre is refused."""
        if velocity.any():
            raise InvalidInput(
                "velocity",
                "a central field has a fixed centre, which would move in the boosted frame; "
                "shift the position only, or let a heavy body be the centre",
            )
        return CentralField(self.potential, np.array(self.center) + position)

    def rotated(self, rotation: NDArray[np.float64]) -> CentralField:
        """The field around the turned centre."""
        return CentralField(self.potential, rotation @ np.array(self.center))

    def rescaled(self, *, length: float, mass: float, time: float) -> CentralField:
        """Refused: a potential does not carry the dimensions of its parameters."""
        raise InvalidInput(
            "forces",
            f"{self.potential} has parameters of several dimensions that are not scaled automatically; "
            "build the scene anew with the potential in the new units",
        )

    def _to_core(self) -> dict[str, Any]:
        return {
            "kind": self.kind,
            "potential": self.potential.name,
            "parameters": list(self.potential.parameters),
            "center": np.array(self.center),
        }

    @classmethod
    def _from_core(cls, description: dict[str, Any]) -> Self:
        from visviva.potentials import potential_by_name

        return cls(potential_by_name(description["potential"], description["parameters"]), description["center"])


_FORCES: dict[str, type[Force]] = {force.kind: force for force in (Gravity, UniformField, CentralField)}


def force_from_core(description: dict[str, Any]) -> Force:
    """The force of a dictionary made by ``_to_core``; used when a file is loaded."""
    kind = description["kind"]
    if kind not in _FORCES:
        raise InvalidInput(
            "path", f"the file holds a force {kind!r} that this version does not know; use a newer visviva"
        )
    return _FORCES[kind]._from_core(description)


def _in_units(name: str, value: float, powers: tuple[int, int, int], *scales: float) -> float:
    """A number of the dimension length^p mass^q time^r in other units, rounded once.

    The product is exact: scales of 1e±150 that together make a moderate factor do not overflow or vanish on the way.
    """
    from fractions import Fraction

    exact = Fraction(value)
    for unit, scale, power in zip(("length", "mass", "time"), scales, powers, strict=True):
        exact *= Fraction(positive(unit, scale, "number of new units per old one")) ** power
    try:
        result = float(exact)
    except OverflowError:
        result = float("inf")
    return in_range(name, value, result)


def _vector(name: str, value: ArrayLike) -> _Vector:
    x, y, z = float_array(name, value, (3,)).tolist()
    return (x, y, z)


def __dir__() -> list[str]:
    return list(__all__)
