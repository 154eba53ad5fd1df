"""The bodies of a scene: masses, positions and velocities, checked once and never changed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array, in_range, mass_array, positive
from visviva._keywords import known_keywords
from visviva._text import count

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from visviva._arrays import Sizes

__all__ = ["Particles"]


@known_keywords
@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Particles:
    """Point particles.

    Parameters
    ----------
    mass : array_like, shape (N,)
        Masses, not negative. Mass 0 marks a test particle: it feels the others and they do not feel
        it.
    position : array_like, shape (N, 3)
        Positions.
    velocity : array_like, shape (N, 3), optional
        Velocities; at rest if not given.

    All three are copied and the copies are read-only float64. Units are the caller's own, one
    consistent system for the whole scene.

    Raises
    ------
    visviva.InvalidInput
        For a wrong shape, complex or object arrays, NaN or infinity, or a negative mass.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.Particles(mass=[1.0, 0.0], position=[[0, 0, 0], [1, 0, 0]])
    Particles(2 bodies, 1 of them massless)
    """

    mass: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]

    def __init__(self, mass: ArrayLike, position: ArrayLike, velocity: ArrayLike | None = None) -> None:
        sizes: Sizes = {}
        object.__setattr__(self, "mass", read_only(mass_array(mass, ("N",), sizes), mass))
        object.__setattr__(self, "position", read_only(float_array("position", position, ("N", 3), sizes), position))
        if velocity is None:
            velocity = np.zeros(self.position.shape)
        object.__setattr__(self, "velocity", read_only(float_array("velocity", velocity, ("N", 3), sizes), velocity))

    def __len__(self) -> int:
        return len(self.mass)

    def __repr__(self) -> str:
        massless = int(np.count_nonzero(self.mass == 0.0))
        note = f", {massless} of them massless" if massless else ""
        return f"Particles({count(len(self), 'body', 'bodies')}{note})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Particles):
            return NotImplemented
        return (
            np.array_equal(self.mass, other.mass)
            and np.array_equal(self.position, other.position)
            and np.array_equal(self.velocity, other.velocity)
        )

    def __hash__(self) -> int:
        # Adding 0.0 turns -0.0, which compares equal to 0.0, into 0.0.
        return hash(tuple((a + 0.0).tobytes() for a in (self.mass, self.position, self.velocity)))

    def __reduce__(self) -> tuple[type[Particles], tuple[NDArray[np.float64], ...]]:
        return Particles, (self.mass, self.position, self.velocity)

    def center_of_mass(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position and velocity of the centre of mass.

        Returns
        -------
        position, velocity : ndarray, shape (3,)

        Raises
        ------
        visviva.InvalidInput
            If the total mass is zero.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.Particles([1.0, 3.0], [[0, 0, 0], [4, 0, 0]]).center_of_mass()[0]
        array([3., 0., 0.])
        """
        return weighted_mean(self.position, self.mass), weighted_mean(self.velocity, self.mass)

    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Particles:
        """The same particles in other units.

        Parameters
        ----------
        length, mass, time : float
            How many new units make one old unit. Powers of two change no bit of any mantissa.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a number would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> kilometres = vv.Particles([1.0], [[2.0, 0.0, 0.0]], [[3.0, 0.0, 0.0]])
        >>> kilometres.rescaled(length=1000.0).position
        array([[2000.,    0.,    0.]])
        """
        for name, scale in (("length", length), ("mass", mass), ("time", time)):
            positive(name, scale, "number of new units per old one")
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):  # in_range tells it better
            new = {
                "mass": self.mass * mass,
                "position": self.position * length,
                "velocity": self.velocity * (length / time),
            }
        return Particles(**{name: in_range(name, getattr(self, name), values) for name, values in new.items()})


def weighted_mean(values: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean of ``values`` (N, ...) with ``weights`` (N,), summed without loss (catalogue 8.1–8.2).

    `math.fsum` rounds each sum once, so the mean does not depend on the order of the bodies.
    """
    from math import fsum

    from visviva.errors import InvalidInput

    total = fsum(weights)
    if not total > 0.0:
        raise InvalidInput("mass", "the total mass is zero, so there is no centre of mass; give one body a mass")
    products = (values.reshape(values.shape[0], -1).T * weights).tolist()
    return np.array([fsum(row) / total for row in products]).reshape(values.shape[1:])


def read_only(array: NDArray[np.float64], given: object = None) -> NDArray[np.float64]:
    """The array, or a copy of what was given, as nobody can write to it."""
    if array is given or not array.flags.owndata:
        # Views are copied too, read-only ones among them: somebody else may hold what they look at.
        array = array.copy()
    array.flags.writeable = False
    return array
