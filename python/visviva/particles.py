"""The bodies of a scene: masses, positions, velocities and radii, checked once and never changed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, in_range, mass_array, positive, radius_array, read_only
from visviva._attributes_elsewhere import OF_PARTICLES, no_attribute
from visviva._html import Sheet, Shown, first_rows
from visviva._keywords import JOINING, known_keywords
from visviva._names import body_index, body_indices, checked_names
from visviva._text import count
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import NoReturn

    from numpy.typing import ArrayLike, NDArray

    from visviva._arrays import Sizes

__all__ = ["Particles"]


def _cure(argument: str, mass: object, position: object) -> str:
    """What is written first of one body, or of motion in a plane, and how it goes."""
    if argument == "mass" and isinstance(mass, (int, float)):
        return f"; one body is [{mass}], [[x, y, z]]"
    if argument == "position" and isinstance(position, (list, tuple)) and position:
        flat = all(isinstance(place, (list, tuple)) and len(place) == 2 for place in position)
        return "; in a plane give z = 0" if flat else ""
    return ""


@known_keywords
@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class Particles(Shown):
    """Point particles, or spheres.

    Parameters
    ----------
    mass : array_like, shape (N,)
        Masses, not negative. Mass 0 marks a test particle: it feels the others and they do not feel
        it.
    position : array_like, shape (N, 3)
        Positions.
    velocity : array_like, shape (N, 3), optional
        Velocities; at rest if not given.
    names : sequence of str, optional
        A name for each body, all different. Runs, files, pictures and whatever is made from the particles keep them;
        forces, events and results take them in place of indices: ``out["Jupiter"]``.
    radius : array_like, a number or shape (N,), optional
        Radii, not negative; 0, the default, is a point. They matter to ``run(collisions=…)`` alone: a point touches
        bodies that have a radius, and never another point.

    The arrays are copied and the copies are read-only float64. Units are the caller's own, one consistent system for
    the whole scene. Indexing with names, indices, a slice or a mask gives the particles of some of the bodies.

    Raises
    ------
    visviva.InvalidInput
        For a wrong shape, complex or object arrays, NaN or infinity, a negative mass or radius, or names that are not
        one for each body.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.Particles(mass=[1.0, 0.0], position=[[0, 0, 0], [1, 0, 0]])
    Particles(2 bodies, 1 of them massless)
    >>> particles = vv.Particles([1.0, 0.0], [[0, 0, 0], [1, 0, 0]], names=["star", "comet"])
    >>> particles["comet"].position
    array([[1., 0., 0.]])
    """

    mass: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    names: tuple[str, ...]
    radius: NDArray[np.float64]

    if not TYPE_CHECKING:
        __getattr__ = no_attribute(OF_PARTICLES)

    def __init__(
        self,
        mass: ArrayLike,
        position: ArrayLike,
        velocity: ArrayLike | None = None,
        names: Sequence[str] | None = None,
        radius: ArrayLike = 0.0,
    ) -> None:
        sizes: Sizes = {}
        try:
            object.__setattr__(self, "mass", read_only(mass_array(mass, ("N",), sizes), mass))
            object.__setattr__(
                self, "position", read_only(float_array("position", position, ("N", 3), sizes), position)
            )
        except InvalidInput as refused:
            cure = _cure(refused.argument, mass, position)
            raise InvalidInput(refused.argument, refused.message + cure) if cure else refused from None
        if velocity is None:
            velocity = np.zeros(self.position.shape)
        object.__setattr__(self, "velocity", read_only(float_array("velocity", velocity, ("N", 3), sizes), velocity))
        object.__setattr__(self, "names", checked_names(names, len(self.mass)))
        object.__setattr__(self, "radius", read_only(radius_array(radius, self.mass.shape, sizes), radius))

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, bodies: str | int | slice | Sequence[str | int] | ArrayLike) -> Particles:
        chosen = body_indices("bodies", bodies, self.names, len(self))
        names = [self.names[body] for body in chosen] if self.names else None
        return Particles(self.mass[chosen], self.position[chosen], self.velocity[chosen], names, self.radius[chosen])

    def __iter__(self) -> Iterator[Particles]:
        return (self[body] for body in range(len(self)))

    if not TYPE_CHECKING:  # to which there is no sum of them

        def __add__(self, other: object) -> NoReturn:
            raise TypeError(f"Particles are not added; {JOINING}")

        __radd__ = __add__

    def __repr__(self) -> str:
        massless = int(np.count_nonzero(self.mass == 0.0))
        note = f", {massless} of them massless" if massless else ""
        named = f": {', '.join(self.names[:12])}{', …' if len(self.names) > 12 else ''}" if self.names else ""
        return f"Particles({count(len(self), 'body', 'bodies')}{note}{named})"

    def _sheet(self) -> Sheet:
        def row(body: int) -> tuple[str, ...]:
            name = self.names[body] if self.names else str(body)
            return (name, f"{self.mass[body]:.6g}", *map(_vector, (self.position[body], self.velocity[body])))

        rows, note = first_rows(len(self), row)
        caption = f"Particles: {count(len(self), 'body', 'bodies')}"
        return Sheet(caption, rows, ("", "mass", "position", "velocity"), note)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Particles):
            return NotImplemented
        return (
            np.array_equal(self.mass, other.mass)
            and np.array_equal(self.position, other.position)
            and np.array_equal(self.velocity, other.velocity)
            and np.array_equal(self.radius, other.radius)
            and self.names == other.names
        )

    def __hash__(self) -> int:
        # Adding 0.0 turns -0.0, which compares equal to 0.0, into 0.0.
        return hash(
            (self.names, *((a + 0.0).tobytes() for a in (self.mass, self.position, self.velocity, self.radius)))
        )

    def __reduce__(self) -> tuple[type[Particles], tuple[Any, ...]]:
        return Particles, (self.mass, self.position, self.velocity, self.names, self.radius)

    def _changed(self, **changes: ArrayLike) -> Particles:
        """The same bodies with other numbers."""
        own = {"mass": self.mass, "position": self.position, "velocity": self.velocity, "radius": self.radius}
        return Particles(**(own | changes), names=self.names)

    def _in_state(self, **checked: NDArray[np.float64]) -> Particles:
        """The same bodies with the numbers of a copy, all of which are checked and written to by nobody."""
        made = object.__new__(Particles)
        for name, value in {"names": self.names, **checked}.items():
            object.__setattr__(made, name, value)
        return made

    @classmethod
    def from_elements(
        cls,
        central: Particles | float,
        mass: ArrayLike,
        *,
        G: float,
        about: int | str | Sequence[int | str] = 0,
        semi_major_axis: ArrayLike | None = None,
        pericenter: ArrayLike | None = None,
        semi_latus_rectum: ArrayLike | None = None,
        period: ArrayLike | None = None,
        eccentricity: ArrayLike = 0.0,
        inclination: ArrayLike = 0.0,
        longitude_of_ascending_node: ArrayLike = 0.0,
        argument_of_pericenter: ArrayLike | None = None,
        longitude_of_pericenter: ArrayLike | None = None,
        true_anomaly: ArrayLike | None = None,
        eccentric_anomaly: ArrayLike | None = None,
        mean_anomaly: ArrayLike | None = None,
        mean_longitude: ArrayLike | None = None,
        time_of_pericenter: ArrayLike | None = None,
        t0: float = 0.0,
        names: Sequence[str] | None = None,
        radius: ArrayLike = 0.0,
    ) -> Particles:
        """Bodies on given orbits about others: ellipses, parabolas and hyperbolas.

        Numbers and arrays of one axis, over the new bodies, broadcast against each other. Angles are in radians; x is
        the reference direction, z the pole. The way back is `Scene.elements`.

        Parameters
        ----------
        central : float or Particles
            The mass of a central body at rest at the origin; or bodies that are there already, to which the new ones
            are added.
        mass : array_like
            Masses of the new bodies, 0 of test particles.
        G : float
            The gravitational constant: μ = G (mass of what a body is about + its own mass).
        about : int or str, or sequence of them, optional
            What the new bodies orbit, all the same or one for each: a body that is there before them, by index (0 the
            central one) or name; ``"jacobi"``, the center of mass of all bodies before each; ``"center_of_mass"``,
            that of the bodies of `central`.
        semi_major_axis, pericenter, semi_latus_rectum, period : array_like, optional
            The size, by one of the four, positive: a (also of a hyperbola; a parabola has none), the least distance, p,
            or the period of an ellipse.
        eccentricity : array_like, optional
            e ≥ 0.
        inclination : array_like, optional
            From 0 to π.
        longitude_of_ascending_node : array_like, optional
            Ω, from x to the ascending node.
        argument_of_pericenter, longitude_of_pericenter : array_like, optional
            ω, from the node to the pericenter along the motion, or ϖ = Ω + ω (of retrograde orbits, too, where
            REBOUND has Ω − ω); ω = 0 if neither is given.
        true_anomaly, eccentric_anomaly, mean_anomaly, mean_longitude, time_of_pericenter : array_like, optional
            Where the bodies are, by one of the five: the angle from the pericenter, inside the asymptotes of a
            hyperbola; E, H or tan(ν/2) of an ellipse, hyperbola or parabola; E − e sin E, e sinh H − H or
            D + D³/3; ϖ + the mean anomaly; or the time of a passage. At the pericenter if none is given.
        t0 : float, optional
            The time of the state, from which `time_of_pericenter` is counted: the scene's `t0`.
        names : sequence of str, optional
            Of the new bodies; if `central` is a mass, its name first.
        radius : array_like, a number or shape (N,), optional
            Radii of the new bodies.

        Returns
        -------
        Particles
            The bodies of `central`, then the new ones.

        Raises
        ------
        visviva.InvalidInput
            By the name of the argument: for a number out of its range, a size, direction or place given twice or, the
            size, not at all, a parabola's semi-major axis, a body about one that comes after it, masses none of which
            attracts.

        References
        ----------
        Murray & Dermott, *Solar System Dynamics* (1999), § 2.8; § 9.7 for Jacobi coordinates.

        Examples
        --------
        >>> import visviva as vv
        >>> earth = vv.Particles.from_elements(1.0, 3e-6, G=1.0, semi_major_axis=1.0, names=["Sun", "Earth"])
        >>> both = vv.Particles.from_elements(
        ...     earth, 3.7e-8, G=1.0, about="Earth", semi_major_axis=0.0026, eccentricity=0.05, names=["Moon"])
        >>> both.names, both["Moon"].position.round(5).tolist()
        (('Sun', 'Earth', 'Moon'), [[1.00247, 0.0, 0.0]])
        """
        from visviva._from_elements import from_elements

        given = {
            "mass": mass,
            "semi_major_axis": semi_major_axis,
            "pericenter": pericenter,
            "semi_latus_rectum": semi_latus_rectum,
            "period": period,
            "eccentricity": eccentricity,
            "inclination": inclination,
            "longitude_of_ascending_node": longitude_of_ascending_node,
            "argument_of_pericenter": argument_of_pericenter,
            "longitude_of_pericenter": longitude_of_pericenter,
            "true_anomaly": true_anomaly,
            "eccentric_anomaly": eccentric_anomaly,
            "mean_anomaly": mean_anomaly,
            "mean_longitude": mean_longitude,
            "time_of_pericenter": time_of_pericenter,
            "radius": radius,
        }
        return from_elements(cls, central, G, about, t0, names, given)

    def index(self, name: str | int) -> int:
        """The index of a body by its name.

        Parameters
        ----------
        name : str or int
            The name, or the index itself.

        Returns
        -------
        int

        Raises
        ------
        visviva.InvalidInput
            If there is none of that name; the message has the nearest.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.datasets.outer_solar_system().particles.index("Saturn")
        2
        """
        return body_index("name", name, self.names, len(self))

    def center_of_mass(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position and velocity of the center of mass.

        Units: those of the scene.

        Returns
        -------
        position, velocity : ndarray, shape (3,)

        Raises
        ------
        visviva.InvalidInput
            If the total mass is zero.

        References
        ----------
        H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.2.

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

        Returns
        -------
        Particles
            With arrays of the same shapes.

        Raises
        ------
        visviva.InvalidInput
            If a scale is not positive, or a number would leave the range of float64.

        Examples
        --------
        >>> import visviva as vv
        >>> kilometers = vv.Particles([1.0], [[2.0, 0.0, 0.0]], [[3.0, 0.0, 0.0]])
        >>> kilometers.rescaled(length=1000.0).position
        array([[2000.,    0.,    0.]])
        """
        for name, scale in (("length", length), ("mass", mass), ("time", time)):
            positive(name, scale, "number of new units per old one")
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):  # in_range tells it better
            new = {
                "mass": self.mass * mass,
                "position": self.position * length,
                "velocity": self.velocity * (length / time),
                "radius": self.radius * length,
            }
        return self._changed(**{name: in_range(name, getattr(self, name), values) for name, values in new.items()})


def weighted_mean(values: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean of ``values`` (N, ...) with ``weights`` (N,), summed without loss (catalogue 8.1–8.2).

    `math.fsum` rounds each sum once, so the mean does not depend on the order of the bodies.
    """
    from math import fsum

    from visviva.errors import InvalidInput

    total = fsum(weights)
    if not total > 0.0:
        raise InvalidInput("mass", "the total mass is zero, so there is no center of mass; give one body a mass")
    products = (values.reshape(values.shape[0], -1).T * weights).tolist()
    return np.array([fsum(row) / total for row in products]).reshape(values.shape[1:])


def _vector(numbers: NDArray[np.float64]) -> str:
    return ", ".join(f"{number:.6g}" for number in numbers)


def __dir__() -> list[str]:
    return list(__all__)
