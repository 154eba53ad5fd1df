"""What becomes of two bodies that collide, and when spheres do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive_array
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva._together import Together
from visviva.collisions._arguments import masses, vectors
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CollisionOutcome(Record):
    """Two bodies after a collision.

    Units: those of the caller, one consistent system.

    Attributes
    ----------
    velocity1, velocity2 : ndarray, shape (..., 3)
    impulse : ndarray, shape (..., 3)
        What the first body has received; the second has received as much the other way.
    energy_loss : ndarray, shape (...)
        Kinetic energy that is gone, −Q: the same in every frame; negative where energy was released.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 17; Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.11.

    Examples
    --------
    >>> import visviva as vv
    >>> after = vv.collisions.elastic(1.0, 3.0, [2.0, 0, 0], [0, 0, 0], normal=[1, 0, 0])
    >>> after.velocity1, after.velocity2, float(after.energy_loss)
    (array([-1.,  0.,  0.]), array([1., 0., 0.]), 0.0)
    """

    velocity1: NDArray[np.float64]
    velocity2: NDArray[np.float64]
    impulse: NDArray[np.float64]
    energy_loss: NDArray[np.float64]


@known_keywords
def elastic(
    mass1: ArrayLike,
    mass2: ArrayLike,
    velocity1: ArrayLike,
    velocity2: ArrayLike,
    *,
    normal: ArrayLike | None = None,
    direction: ArrayLike | None = None,
) -> CollisionOutcome:
    """Velocities after an elastic collision.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive.
    velocity1, velocity2 : array_like, shape (..., 3)
        Before.
    normal : array_like, shape (..., 3), optional
        Line of centers at contact, such as position1 − position2, along which smooth bodies push each other; of any
        length and either sense. See `line_of_centers`.
    direction : array_like, shape (..., 3), optional
        In its place: where the first goes as seen from the second, or from the center of mass, afterwards; of any
        length.

    Returns
    -------
    CollisionOutcome
        With the axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, neither or both of normal and direction, a vector without direction, or shapes
        that do not broadcast.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 17; Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.11.

    Examples
    --------
    >>> import visviva as vv
    >>> after = vv.collisions.elastic(1.0, 1.0, [2.0, 0.0, 0.0], [0.0, 0.0, 0.0], normal=[1.0, 1.0, 0.0])
    >>> after.velocity1.round(12), after.velocity2.round(12)
    (array([ 1., -1.,  0.]), array([1., 1., 0.]))
    """
    return _collided("q_value", 0.0, mass1, mass2, velocity1, velocity2, normal, direction)


@known_keywords
def inelastic(
    mass1: ArrayLike,
    mass2: ArrayLike,
    velocity1: ArrayLike,
    velocity2: ArrayLike,
    *,
    q_value: ArrayLike,
    normal: ArrayLike | None = None,
    direction: ArrayLike | None = None,
) -> CollisionOutcome:
    """Velocities after a collision that releases or takes up a given energy.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive, and unchanged.
    velocity1, velocity2 : array_like, shape (..., 3)
        Before.
    q_value : array_like, shape (...)
        Energy that is released (Q > 0) or taken up (Q < 0); at least −½μu², the energy of relative motion, where they
        stick. With a normal at least −½μ(u·n)².
    normal : array_like, shape (..., 3), optional
        Line of centers at contact, as of `elastic`: the velocity across it stays as it is.
    direction : array_like, shape (..., 3), optional
        In its place: where the first goes as seen from the second afterwards.

    Returns
    -------
    CollisionOutcome
        With the axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a Q-value below the threshold, which the message gives; else as `elastic`.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.11 (collisions with a Q-value).

    Examples
    --------
    >>> import visviva as vv
    >>> rest = [0.0, 0.0, 0.0]
    >>> after = vv.collisions.inelastic(2.0, 3.0, [5.0, 0.0, 0.0], rest, q_value=-15.0, direction=[0.0, 1.0, 0.0])
    >>> after.velocity1, after.velocity2, after.energy_loss
    (array([2., 0., 0.]), array([2., 0., 0.]), np.float64(15.0))
    """
    return _collided("q_value", q_value, mass1, mass2, velocity1, velocity2, normal, direction)


@known_keywords
def restitution(
    mass1: ArrayLike,
    mass2: ArrayLike,
    velocity1: ArrayLike,
    velocity2: ArrayLike,
    *,
    coefficient: ArrayLike,
    normal: ArrayLike,
) -> CollisionOutcome:
    """Velocities after smooth bodies have collided with a coefficient of restitution.

    Along the line of centers they part with ε times the speed with which they met, (v₂' − v₁')·n = ε (v₁ − v₂)·n;
    across it nothing changes.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive.
    velocity1, velocity2 : array_like, shape (..., 3)
        Before.
    coefficient : array_like, shape (...)
        ε, from 0 (no speed along the line of centers is left) to 1 (elastic).
    normal : array_like, shape (..., 3)
        Line of centers at contact, such as position1 − position2; of any length and either sense. See
        `line_of_centers`.

    Returns
    -------
    CollisionOutcome
        With the axes of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For a mass that is not positive, a coefficient outside [0, 1], a normal without direction, or shapes that do not
        broadcast.

    References
    ----------
    E. T. Whittaker, *Analytical Dynamics*, 4th ed. (1937), ch. VIII (impact).

    Examples
    --------
    >>> import visviva as vv
    >>> rest = [0.0, 0.0, 0.0]
    >>> after = vv.collisions.restitution(1.0, 2.5, [4.0, 0.0, 0.0], rest, coefficient=0.6, normal=[1.0, 0.0, 0.0])
    >>> after.velocity1.round(6), after.velocity2.round(6)
    (array([-0.571429,  0.      ,  0.      ]), array([1.828571, 0.      , 0.      ]))
    """
    return _collided("coefficient", coefficient, mass1, mass2, velocity1, velocity2, normal, None)


@known_keywords
def impulse(
    mass1: ArrayLike,
    mass2: ArrayLike,
    velocity1: ArrayLike,
    velocity2: ArrayLike,
    *,
    normal: ArrayLike,
    coefficient: ArrayLike = 1.0,
) -> NDArray[np.float64]:
    """Impulse that the first body receives, J = −μ(1 + ε)((v₁ − v₂)·n) n; the second receives −J.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass1, mass2 : array_like, shape (...)
        Positive.
    velocity1, velocity2 : array_like, shape (..., 3)
        Before.
    normal : array_like, shape (..., 3)
        Line of centers at contact, of any length and either sense.
    coefficient : array_like, shape (...), optional
        Of restitution, from 0 to 1, elastic by default.

    Returns
    -------
    ndarray, shape (..., 3)
        The change of the first body's momentum, the integral of the force over the time of contact.

    Raises
    ------
    InvalidInput
        As `restitution`.

    References
    ----------
    E. T. Whittaker, *Analytical Dynamics*, 4th ed. (1937), ch. VIII (impact).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.collisions.impulse(1.0, 3.0, [4.0, 0.0, 0.0], [0.0, 0.0, 0.0], normal=[1.0, 0.0, 0.0])
    array([-6.,  0.,  0.])
    """
    return restitution(mass1, mass2, velocity1, velocity2, coefficient=coefficient, normal=normal).impulse


@known_keywords
def line_of_centers(
    velocity1: ArrayLike, velocity2: ArrayLike, *, impact: ArrayLike, distance: ArrayLike
) -> NDArray[np.float64]:
    """Line of centers of two spheres at the moment at which they touch.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    velocity1, velocity2 : array_like, shape (..., 3)
        Before.
    impact : array_like, shape (..., 3)
        Position of the first as seen from the second, at any time before, of which only what is across the relative
        velocity counts: the impact parameter with its direction.
    distance : array_like, shape (...)
        Of the centers at contact: both radii together.

    Returns
    -------
    ndarray, shape (..., 3)
        Of length 1, from the second to the first.

    Raises
    ------
    InvalidInput
        For spheres that miss each other or do not move against each other, a distance that is not positive, or shapes
        that do not broadcast.

    References
    ----------
    Landau & Lifshitz, *Mechanics*, 3rd ed., § 18, problem 1 (rigid spheres).

    Examples
    --------
    >>> import visviva as vv
    >>> vv.collisions.line_of_centers([1.0, 0.0, 0.0], [0.0, 0.0, 0.0], impact=[0.0, 0.6, 0.0], distance=1.0)
    array([-0.8,  0.6,  0. ])
    """
    given = Together(
        {"distance": positive_array("distance", distance)},
        vectors(velocity1=velocity1, velocity2=velocity2, impact=impact),
    )
    if 0 in given.shape:
        return np.empty((*given.shape, 3))
    found = _core.line_of_centers(given.pair("velocity"), given.vectors["impact"], given.numbers["distance"])
    return given.shaped(found, 3)


@known_keywords
def contact_time(
    position1: ArrayLike, position2: ArrayLike, velocity1: ArrayLike, velocity2: ArrayLike, *, distance: ArrayLike
) -> NDArray[np.float64]:
    """Time from now at which two spheres in straight motion touch.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    position1, position2, velocity1, velocity2 : array_like, shape (..., 3)
        Of the centers, now.
    distance : array_like, shape (...)
        Of the centers at contact: both radii together.

    Returns
    -------
    ndarray
        The first root of |r + vt| = distance that is not in the past; infinite for spheres that miss each other or move
        apart. Known to round-off also where they nearly miss. Of the shape of the arguments, broadcast.

    Raises
    ------
    InvalidInput
        For spheres that overlap now, a distance that is not positive, or shapes that do not broadcast.

    References
    ----------
    M. P. Allen & D. J. Tildesley, *Computer Simulation of Liquids* (1987), § 3.6.1 (hard spheres).

    Examples
    --------
    >>> import visviva as vv
    >>> rest = [0.0, 0.0, 0.0]
    >>> vv.collisions.contact_time([5.0, 0.0, 0.0], rest, [-2.0, 0.0, 0.0], rest, distance=[1.0, 3.0])
    array([2., 1.])
    """
    given = Together(
        {"distance": positive_array("distance", distance)},
        vectors(position1=position1, position2=position2, velocity1=velocity1, velocity2=velocity2),
    )
    if 0 in given.shape:
        return np.empty(given.shape)
    return given.shaped(_core.contact_time(given.pair("position"), given.pair("velocity"), given.numbers["distance"]))


def _collided(
    rule: str,
    number: object,
    mass1: object,
    mass2: object,
    velocity1: object,
    velocity2: object,
    normal: object,
    direction: object,
) -> CollisionOutcome:
    if (normal is None) == (direction is None):
        what = "both" if direction is not None else "neither"
        along_a_line = "; on a line, normal=[1, 0, 0]" if direction is None else ""
        raise InvalidInput("normal", f"expected either a normal or a direction, got {what}{along_a_line}")
    geometry = "normal" if direction is None else "direction"
    along = normal if direction is None else direction
    given = Together(
        masses(mass1, mass2) | {rule: float_array(rule, number, None)},
        vectors(velocity1=velocity1, velocity2=velocity2) | vectors(**{geometry: along}),
    )
    if 0 in given.shape:
        first, second, between = (np.empty((*given.shape, 3)) for _ in range(3))
        return CollisionOutcome(first, second, between, np.empty(given.shape))
    found = _core.collided(
        (rule, given.numbers[rule]), (geometry, given.vectors[geometry]), given.pair("mass"), given.pair("velocity")
    )
    first, second, between = (given.shaped(found[:, start : start + 3], 3) for start in (0, 3, 6))
    return CollisionOutcome(first, second, between, given.shaped(found[:, 9]))
