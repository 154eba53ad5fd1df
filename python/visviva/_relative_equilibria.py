"""Problems of three bodies that turn as if they were rigid; see `visviva.problems`.

The one idea: in a central configuration the pull on each body points to the center of mass, in proportion to its
distance from there, so one rate of turning fits all. States are known in closed form at any time, and how unstable they
are from linear theory.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array, number, positive
from visviva._keywords import known_keywords
from visviva._problem import Problem, reference
from visviva.errors import InvalidInput
from visviva.forces import Gravity
from visviva.particles import Particles
from visviva.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["euler_collinear", "lagrange_triangle"]


@known_keywords
def lagrange_triangle(masses: Sequence[float] = (1.0, 2.0, 3.0), side: float = 2.0, turn: float = 1.0) -> Problem:
    """Three bodies that turn as a rigid equilateral triangle, ω² = (m₁ + m₂ + m₃) / side³.

    Units: those in which the gravitational constant is 1.

    Parameters
    ----------
    masses : sequence of 3 floats, optional
    side : float, optional
        Length of a side.
    turn : float, optional
        How far to turn, in full turns.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Raises
    ------
    visviva.InvalidInput
        For masses that are not three numbers, or a side that is not positive.

    Notes
    -----
    Unstable unless one body outweighs the others (Gascheau): with equal or similar masses the
    triangle breaks up after a few turns whatever the method.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.12; J. M. A. Danby, *Fundamentals of Celestial
    Mechanics*, 2nd ed. (1988), ch. 8.

    Examples
    --------
    >>> import visviva as vv
    >>> problem = vv.problems.lagrange_triangle()
    >>> round(problem.t_end, 6)
    7.255197
    """
    a, b, d = three = float_array("masses", masses, (3,))
    side, turn = positive("side", side, "length"), number("turn", turn)
    total = float(a + b + d)
    if not (min(three) >= 0.0 and total > 0.0):
        raise InvalidInput("masses", f"expected masses of at least 0 and one above, got {three.tolist()}")
    rate = sqrt(total / (side * side * side))
    corners = side / sqrt(3.0) * np.array([[cos(a), sin(a), 0.0] for a in (0.0, 2 * pi / 3, 4 * pi / 3)])
    position = corners - Particles(masses, corners).center_of_mass()[0]
    velocity, t_end, turned = _turning(position, rate, turn)
    # Routh's linear growth rate of the instability, in units of the rotation rate; zero when stable.
    routh = 27.0 * (a * b + b * d + d * a) / total**2
    growth = sqrt(max(0.0, sqrt(routh) - 1.0)) / 2.0
    return Problem(
        "lagrange_triangle",
        "three bodies turning as a rigid equilateral triangle",
        Scene(Particles(masses, position, velocity), Gravity(1.0)),
        t_end,
        (reference(t_end, turned),),
        ((t_end, float(max(1.0, np.exp(2.0 * pi * turn * growth)))),),
        "Lagrange, Essai sur le probleme des trois corps (1772)",
    )


@known_keywords
def euler_collinear(masses: Sequence[float] = (1.0, 2.0, 3.0), separation: float = 1.0, turn: float = 0.25) -> Problem:
    """Three bodies that turn on a straight line, in the order given, as if on a rigid rod.

    Units: those in which the gravitational constant is 1.

    Parameters
    ----------
    masses : sequence of 3 floats, optional
    separation : float, optional
        Distance of the first two. That of the last two follows from Euler's equation of the fifth degree.
    turn : float, optional
        How far to turn, in full turns.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Raises
    ------
    visviva.InvalidInput
        For masses that are not three numbers, or a separation that is not positive.

    Notes
    -----
    Unstable for any masses: what is out of line grows by the factor that the conditioning tells.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.12; J. M. A. Danby, *Fundamentals of Celestial
    Mechanics*, 2nd ed. (1988), ch. 8.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.problems.euler_collinear(masses=(1.0, 5.0, 1.0)).scene.particles.position[:, 0].round(12).tolist()
    [-1.0, 0.0, 1.0]
    """
    a, b, c = three = float_array("masses", masses, (3,))
    separation, turn = positive("separation", separation, "length"), number("turn", turn)
    if not (min(three) >= 0.0 and min(a + b, b + c) > 0.0):
        expected = "masses of at least 0, of which two neighbors have not none"
        raise InvalidInput("masses", f"expected {expected}, got {three.tolist()}")
    # Of the distance of the last two over that of the first two: one change of sign, so one positive root.
    quintic = [a + b, 3 * a + 2 * b, 3 * a + b, -b - 3 * c, -2 * b - 3 * c, -b - c]
    roots = np.roots(quintic)
    ratio = float(max(roots[np.abs(roots.imag) <= 1e-9 * np.abs(roots)].real))
    slope = np.polyder(np.array(quintic))
    for _ in range(3):  # what the companion matrix left
        ratio -= float(np.polyval(quintic, ratio) / np.polyval(slope, ratio))
    places = separation * np.array([0.0, 1.0, 1.0 + ratio])
    line = np.stack([places, np.zeros(3), np.zeros(3)], axis=1)
    position = line - Particles(masses, line).center_of_mass()[0]
    # Of two bodies that move relative to each other: what pulls them together is ω² times their distance.
    (r12, r23), r13 = np.diff(places), places[2]
    rate = sqrt(((a + b) / r12**2 + c * (1 / r13**2 - 1 / r23**2)) / r12)
    velocity, t_end, turned = _turning(position, rate, turn)
    # The third eigenvalue of the field's gradient, beside that of a displacement and of a stretch, in units of ω².
    third = ((a + b) / r12**3 + (b + c) / r23**3 + (a + c) / r13**3) / rate**2 - 1.0
    growth = sqrt((third - 2.0 + sqrt(9.0 * third**2 - 8.0 * third)) / 2.0)
    return Problem(
        "euler_collinear",
        "three bodies turning on a straight line",
        Scene(Particles(masses, position, velocity), Gravity(1.0)),
        t_end,
        (reference(t_end, turned),),
        ((t_end, float(np.exp(2.0 * pi * abs(turn) * growth))),),
        "Euler, De motu rectilineo trium corporum se mutuo attrahentium (1767)",
    )


def _turning(
    position: NDArray[np.float64], rate: float, turn: float
) -> tuple[NDArray[np.float64], float, NDArray[np.float64]]:
    """Velocities of places that turn about z at a rate, when they have made so many turns, and where they are then."""
    velocity = rate * np.stack([-position[:, 1], position[:, 0], np.zeros(len(position))], axis=1)
    cosine, sine = cos(2.0 * pi * turn), sin(2.0 * pi * turn)
    turned = position @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return velocity, 2.0 * pi * turn / rate, turned
