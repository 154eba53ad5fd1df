"""Rainbows, glories, orbits and branches: what marks the deflection function of a potential at one energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import positive
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva._parameter import checked_potential
from visviva.scattering._arguments import angles as checked_angles

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva.potentials import Potential

__all__ = ["Glory", "Orbit", "Rainbow", "glories", "impact_parameter", "orbiting", "rainbows"]


@known_keywords
@dataclass(frozen=True, repr=False)
class Rainbow(Record):
    """An extremum of ψ(b): the cross section is infinite at its angle, beyond which its branches do not go.

    Units: those of the potential, energies and lengths; angles in radians.

    Attributes
    ----------
    impact_parameter : float
        b, where dψ/db = 0.
    angle : float
        ψ there, signed and not folded.

    References
    ----------
    K. W. Ford, J. A. Wheeler, Ann. Phys. 7 (1959) 259; H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd
    ed., §3.10.

    Examples
    --------
    >>> import visviva as vv
    >>> [rainbow] = vv.scattering.rainbows(vv.potentials.LennardJones(1.0, 1.0), energy=10.0)
    >>> round(rainbow.impact_parameter, 6), round(rainbow.angle, 6)
    (1.250655, -0.20656)
    """

    impact_parameter: float
    angle: float


@known_keywords
@dataclass(frozen=True, repr=False)
class Glory(Record):
    """An impact parameter other than 0 that leads straight on or straight back: ψ = kπ.

    Units: those of the potential, energies and lengths; angles in radians.

    Attributes
    ----------
    impact_parameter : float
        b.
    angle : float
        ψ = kπ: straight on for even k, straight back for odd.
    derivative : float
        dψ/db.

    References
    ----------
    K. W. Ford, J. A. Wheeler, Ann. Phys. 7 (1959) 259; H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd
    ed., §3.10.

    Examples
    --------
    >>> import visviva as vv
    >>> [glory] = vv.scattering.glories(vv.potentials.LennardJones(1.0, 1.0), energy=10.0)
    >>> glory.forward, round(glory.impact_parameter, 9)
    (True, 1.100666112)
    """

    impact_parameter: float
    angle: float
    derivative: float

    @property
    def forward(self) -> bool:
        """Whether it leads straight on."""
        return round(self.angle / np.pi) % 2 == 0


@known_keywords
@dataclass(frozen=True, repr=False)
class Orbit(Record):
    """A circular orbit at the top of a barrier, which impact parameters near its own approach.

    Units: those of the potential, energies and lengths; angles in radians.

    Attributes
    ----------
    impact_parameter : float
        b, at which ψ → −∞.
    radius : float
        Of the orbit; 0 where there is none but at the center, as for −C/r².
    captures : bool
        Whether what comes with less falls into the center.

    References
    ----------
    K. W. Ford, J. A. Wheeler, Ann. Phys. 7 (1959) 259; H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd
    ed., §3.10.

    Examples
    --------
    >>> import visviva as vv
    >>> [orbit] = vv.scattering.orbiting(vv.potentials.PowerLaw(-1.0, 4), energy=1.0)
    >>> orbit.captures, round(orbit.radius, 9), round(orbit.impact_parameter, 9)
    (True, 1.0, 1.414213562)
    """

    impact_parameter: float
    radius: float
    captures: bool


@known_keywords
def rainbows(potential: Potential, *, energy: float) -> tuple[Rainbow, ...]:
    """Extrema of the deflection function, from the smallest impact parameter on.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : float
        Of relative motion, positive.

    Returns
    -------
    tuple of Rainbow
        Empty if ψ(b) is monotone.

    Raises
    ------
    InvalidInput
        As `deflect`.

    References
    ----------
    K. W. Ford, J. A. Wheeler, Ann. Phys. 7 (1959) 259; H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd
    ed., §3.10.

    Examples
    --------
    >>> import visviva as vv
    >>> [rainbow] = vv.scattering.rainbows(vv.potentials.LennardJones(1.0, 1.0), energy=1.0)
    >>> round(rainbow.impact_parameter, 8)
    1.66597129
    """
    found, _ = structure(potential, energy)
    return tuple(Rainbow(*mark) for mark in found)


@known_keywords
def glories(potential: Potential, *, energy: float) -> tuple[Glory, ...]:
    """Impact parameters other than 0 that lead straight on or straight back.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : float
        Of relative motion, positive.

    Returns
    -------
    tuple of Glory
        From the smallest impact parameter on. Near an orbit there are infinitely many; those are listed whose impact
        parameters float64 tells apart.

    Raises
    ------
    InvalidInput
        As `deflect`.

    References
    ----------
    K. W. Ford, J. A. Wheeler, Ann. Phys. 7 (1959) 259; H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd
    ed., §3.10.

    Examples
    --------
    >>> import visviva as vv
    >>> [glory] = vv.scattering.glories(vv.potentials.LennardJones(1.0, 1.0), energy=10.0)
    >>> round(glory.impact_parameter, 9), glory.forward
    (1.100666112, True)
    """
    _, found = structure(potential, energy)
    return tuple(Glory(*mark) for mark in found)


@known_keywords
def orbiting(potential: Potential, *, energy: float) -> tuple[Orbit, ...]:
    """Circular orbits on barriers that can be approached from outside at an energy.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : float
        Of relative motion, positive.

    Returns
    -------
    tuple of Orbit
        Empty where nothing orbits. At the very energy from which on nothing does there is one still, of a barrier that
        has no top but is level: toward it ψ grows as a power of the distance, not as its logarithm.

    Raises
    ------
    InvalidInput
        As `deflect`.

    References
    ----------
    K. W. Ford, J. A. Wheeler, Ann. Phys. 7 (1959) 259; H. Goldstein, C. Poole, J. Safko, *Classical Mechanics*, 3rd
    ed., §3.10.

    Examples
    --------
    >>> import visviva as vv
    >>> [orbit] = vv.scattering.orbiting(vv.potentials.LennardJones(1.0, 1.0), energy=0.4)
    >>> round(orbit.radius, 9), round(orbit.impact_parameter, 9), orbit.captures
    (1.604636923, 1.998705157, False)
    """
    [found] = orbits(potential, np.array([positive("energy", energy)]))
    return tuple(Orbit(*mark) for mark in found)


@known_keywords
def impact_parameter(potential: Potential, *, energy: float, angle: ArrayLike) -> NDArray[np.float64]:
    """All impact parameters that lead to an angle from the beam, whole turns and either side included.

    Units: those of the potential, energies and lengths; angles in radians.

    Parameters
    ----------
    potential : Potential
        Any that goes to 0 far out.
    energy : float
        Of relative motion, positive.
    angle : array_like
        Angles from the beam in the center-of-mass frame, in [0, π].

    Returns
    -------
    ndarray
        Of the shape of ``angle`` and one axis more: the branches from the smallest impact parameter on, filled up with
        NaN. Near an orbit there are infinitely many; those are listed that float64 tells apart.

    Raises
    ------
    InvalidInput
        For an angle out of range, and as `deflect`.

    References
    ----------
    L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed., §18.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.scattering.impact_parameter(vv.potentials.LennardJones(1.0, 1.0), energy=10.0, angle=0.1).round(6)
    array([1.067861, 1.140732, 1.501064])
    """
    angles = checked_angles("angle", angle)
    counts, columns = _core.scattering_branches(described(potential), positive("energy", energy), angles.ravel())
    table = np.full((angles.size, max(counts, default=0)), np.nan)
    table[np.arange(table.shape[1]) < np.array(counts)[:, None]] = columns[0]
    return table.reshape((*angles.shape, table.shape[1]))


def structure(potential: object, energy: object) -> tuple[list[tuple[float, float]], list[tuple[float, float, float]]]:
    """Rainbows and glories, as the core finds them."""
    return _core.scattering_structure(described(potential), positive("energy", energy))


def orbits(potential: object, energy: NDArray[np.float64]) -> list[list[tuple[float, float, bool]]]:
    """Orbits at each energy, as the core finds them: impact parameter, radius, and whether it captures."""
    return _core.scattering_orbits(described(potential), energy)


def described(potential: object) -> dict[str, object]:
    """Check that it is a potential, and write it for the core."""
    return checked_potential("potential", potential)._to_core()
