"""What is scattered by what: a beam, its energies, and the center it meets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from visviva._arrays import float_array
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from visviva.potentials import Potential

__all__ = ["Beam", "Spectrum", "described"]


@known_keywords
@dataclass(frozen=True)
class Spectrum:
    """Energies of a beam, each with its part of the projectiles.

    Parameters
    ----------
    energy : array_like
        Positive.
    weight : array_like
        Positive, one for each energy; only their ratios count.

    Raises
    ------
    InvalidInput
        For what is no such list.

    Examples
    --------
    >>> import visviva as vv
    >>> lines = vv.scattering.Spectrum([5.486, 5.443], [84.8, 13.1])
    >>> lines.energy
    (5.486, 5.443)
    """

    energy: tuple[float, ...]
    weight: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("energy", "weight"):
            values = float_array(name, getattr(self, name), (None,))
            if not values.size or not (values > 0.0).all():
                raise InvalidInput(name, f"expected one or more positive numbers, got {values.tolist()}")
            object.__setattr__(self, name, tuple(values.tolist()))
        if len(self.energy) != len(self.weight):
            raise InvalidInput(
                "weight", f"expected one for each of {len(self.energy)} energies, got {len(self.weight)}"
            )


@known_keywords
@dataclass(frozen=True)
class Beam:
    """A parallel beam on a disc around one centre: what results must have in common to be added.

    Attributes
    ----------
    potential : Potential
        V(r).
    beam_energy : float or Spectrum
        Of the projectile in the laboratory.
    masses : tuple of float
        Projectile and target.
    b_max : float
        Radius of the disc of impact parameters.
    smallest_angle : float
        The deflection at the edge of the disc, in the centre-of-mass frame, or a greater one beyond it: where
        deflections fall with the impact parameter, no event is scattered by less.
    tables : tuple of int
        The hash of the event table of each energy, from which angles are taken; none of a Coulomb target.
    """

    potential: Potential
    beam_energy: float | Spectrum
    masses: tuple[float, float]
    b_max: float
    smallest_angle: float
    tables: tuple[int, ...] = ()


def described(beam: Beam) -> dict[str, Any]:
    """A beam in the words of the core."""
    energy = beam.beam_energy
    lines = (energy.energy, energy.weight) if isinstance(energy, Spectrum) else ((energy,), (1.0,))
    return {
        "potential": beam.potential._to_core(),
        "energies": list(lines[0]),
        "weights": list(lines[1]),
        "masses": beam.masses,
        "b_max": beam.b_max,
    }
