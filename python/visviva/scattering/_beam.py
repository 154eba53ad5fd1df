"""What is scattered by what: a beam, its energies, and the center it meets."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from visviva._arrays import float_array, positive
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from visviva.potentials import Potential
    from visviva.scattering._channels import Channel
    from visviva.scattering._importance import Strata

__all__ = ["Beam", "Spectrum", "Spread", "as_spread", "described"]


@known_keywords
@dataclass(frozen=True, repr=False)
class Spectrum(Record):
    """Energies of a beam, each with its part of the projectiles.

    Units: energies in those of the potential; weights are without dimension.

    Parameters
    ----------
    energy : array_like, shape (L,)
        Positive.
    weight : array_like, shape (L,)
        Positive, one for each energy; only their ratios count.

    Raises
    ------
    InvalidInput
        For no energy, what is not positive, or another number of weights than of energies.

    Examples
    --------
    >>> import visviva as vv
    >>> lines = vv.scattering.Spectrum([5.486, 5.443], [84.8, 13.1])
    >>> lines.energy
    (5.486, 5.443)
    """

    energy: tuple[float, ...]
    weight: tuple[float, ...]

    def __init__(self, energy: ArrayLike, weight: ArrayLike) -> None:
        for name, given in (("energy", energy), ("weight", weight)):
            values = float_array(name, given, (None,))
            if not values.size or not (values > 0.0).all():
                raise InvalidInput(name, f"expected one or more positive numbers, got {values.tolist()}")
            object.__setattr__(self, name, tuple(values.tolist()))
        if len(self.energy) != len(self.weight):
            raise InvalidInput(
                "weight", f"expected one for each of {len(self.energy)} energies, got {len(self.weight)}"
            )


@known_keywords
@dataclass(frozen=True, init=False, repr=False)
class Spread(Record):
    """How energies or directions of a beam lie about their middle.

    Units: energies in those of the beam, directions in radians.

    Attributes
    ----------
    shape : {"gaussian", "uniform"}
        Of the distribution.
    width : float
        Standard deviation of a Gaussian, of directions in each of two planes; it ends at 6 of them. Half width of a
        uniform one, of directions the half angle of the cone.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.Spread.gaussian(0.01), vv.scattering.Spread.uniform(0.02)
    (Spread(shape='gaussian', width=0.01), Spread(shape='uniform', width=0.02))
    """

    shape: str
    width: float

    def __init__(self) -> None:
        raise InvalidInput("spread", "expected Spread.gaussian or Spread.uniform, got Spread itself")

    @staticmethod
    @known_keywords
    def gaussian(sigma: float) -> Spread:
        """Make a Gaussian.

        Units: energies in those of the beam, directions in radians.

        Parameters
        ----------
        sigma : float
            Standard deviation, positive.

        Returns
        -------
        Spread

        Raises
        ------
        InvalidInput
            For what is no positive number.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.scattering.Spread.gaussian(0.01).width
        0.01
        """
        return _spread("gaussian", positive("sigma", sigma))

    @staticmethod
    @known_keywords
    def uniform(half_width: float) -> Spread:
        """Make an even distribution: of energies over an interval, of directions over a cone's solid angle.

        Parameters
        ----------
        half_width : float
            Half of the interval, or the cone's half angle in radians; positive.

        Returns
        -------
        Spread

        Raises
        ------
        InvalidInput
            For what is no positive number.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.scattering.Spread.uniform(0.02).shape
        'uniform'
        """
        return _spread("uniform", positive("half_width", half_width))


def _spread(shape: str, width: float) -> Spread:
    spread = object.__new__(Spread)
    object.__setattr__(spread, "shape", shape)
    object.__setattr__(spread, "width", width)
    return spread


def as_spread(name: str, given: object) -> Spread | None:
    """A spread as an argument: a number is the standard deviation of a Gaussian."""
    if given is None or isinstance(given, Spread):
        return given
    return _spread("gaussian", positive(name, given))


@known_keywords
@dataclass(frozen=True, repr=False)
class Beam(Record):
    """A beam on a disc around one center: what results must have in common to be added.

    Units: energies and lengths are those of the potential, masses in one unit, any; angles in radians.

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
        The deflection at the edge of the disc, in the center-of-mass frame, or a greater one beyond it: where
        deflections fall with the impact parameter, no event is scattered by less. It follows from the rest and is not
        compared.
    tables : tuple of int
        The hash of the event table of each energy, from which angles are taken; of a spread of energies, of those
        between which is interpolated; none of a Coulomb target, and of a spread whose angles are found event by event.
    energy_spread, divergence : Spread or None
        Of the energies about each one given, and of the directions about the axis.
    spot : float or None
        Standard deviation of the places, in each of two dimensions; None where the disc is filled evenly.
    importance : Strata or None
        Rings of impact parameters with parts of the events of their own; None where events fill the disc evenly.
    channels : tuple of Channel
        Reactions with their parts of the events; what is left of them is elastic.

    References
    ----------
    J. K. Salmon et al., *Parallel random numbers: as easy as 1, 2, 3*, SC'11 (2011), for the random numbers.

    Examples
    --------
    >>> import visviva as vv
    >>> run = vv.scattering.monte_carlo(
    ...     vv.potentials.HardSphere(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=1.0, n_events=1000, seed=1, bins=4)
    >>> run.beam.b_max, run.beam.masses
    (1.0, (1.0, 4.0))
    """

    potential: Potential
    beam_energy: float | Spectrum
    masses: tuple[float, float]
    b_max: float
    smallest_angle: float = field(compare=False)
    tables: tuple[int, ...] = ()
    energy_spread: Spread | None = None
    divergence: Spread | None = None
    spot: float | None = None
    importance: Strata | None = None
    channels: tuple[Channel, ...] = ()


def described(beam: Beam) -> dict[str, Any]:
    """A beam in the words of the core."""
    energy, strata = beam.beam_energy, beam.importance
    lines = (energy.energy, energy.weight) if isinstance(energy, Spectrum) else ((energy,), (1.0,))
    return {
        "potential": beam.potential._to_core(),
        "energies": list(lines[0]),
        "weights": list(lines[1]),
        "masses": beam.masses,
        "b_max": beam.b_max,
        "energy_spread": _pair(beam.energy_spread),
        "divergence": _pair(beam.divergence),
        "spot": beam.spot,
        "importance": None if strata is None else (list(strata.edges), list(strata.fractions)),
        "channels": [
            (channel.probability, channel.excitation_function or 1.0, channel.q_value, channel.products)
            for channel in beam.channels
        ],
    }


def _pair(given: Spread | None) -> tuple[str, float] | None:
    return None if given is None else (given.shape, given.width)
