"""Problems with known answers, shared by tests, benchmarks and users.

A problem carries reference states computed beyond double precision (quadruple precision, Taylor
series of order 40, agreeing with order 34) or in closed form, and says how much the problem itself
amplifies a rounding of its input, so that nobody claims digits that float64 cannot hold.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva._arrays import float_array, number, positive, whole_number
from visviva._field_problems import arenstorf, crossed_fields, driven_oscillator, projectile
from visviva._keywords import known_keywords, unknown_name
from visviva._problem import Problem, Reference, reference, rows
from visviva._reference_states import (
    OUTER_SOLAR_SYSTEM,
    OUTER_SOLAR_SYSTEM_CONDITIONING,
    PLEIADES,
    PLEIADES_CONDITIONING,
    PYTHAGOREAN,
)
from visviva.datasets.outer_solar_system import outer_solar_system as outer_solar_system_data
from visviva.errors import InvalidInput
from visviva.forces import Gravity
from visviva.particles import Particles
from visviva.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Sequence


__all__ = [
    "Problem",
    "Reference",
    "arenstorf",
    "crossed_fields",
    "driven_oscillator",
    "euler_collinear",
    "figure_eight",
    "kepler",
    "lagrange_triangle",
    "outer_solar_system",
    "pleiades",
    "projectile",
    "pythagorean",
]


@known_keywords
def outer_solar_system(variant: Literal["hairer_lubich_wanner", "applegate"] = "hairer_lubich_wanner") -> Problem:
    """The Sun and five outer planets over 200 000 days, or Applegate's version over 3 650 000.

    Units: astronomical units, days and masses of the Sun.

    Parameters
    ----------
    variant : {"hairer_lubich_wanner", "applegate"}, optional
        As in `visviva.datasets.outer_solar_system`. Applegate's is put into its centre-of-mass frame.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Raises
    ------
    visviva.InvalidInput
        For another kind of start.

    References
    ----------
    Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed. (2006), section I.2.4; Applegate et al., Astron.
    J. 92 (1986) 176.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.problems.outer_solar_system().t_end
    200000.0
    """
    data = outer_solar_system_data(variant)
    scene = data.scene
    if variant == "applegate":
        scene = scene.center_of_mass_frame()
    t_end, positions = OUTER_SOLAR_SYSTEM[variant]
    return Problem(
        "outer_solar_system",
        "Sun, Jupiter, Saturn, Uranus, Neptune, Pluto; AU, day, solar mass",
        scene,
        t_end,
        (reference(t_end, positions),),
        OUTER_SOLAR_SYSTEM_CONDITIONING[variant],
        data.source,
    )


@known_keywords
def figure_eight(periods: int = 1) -> Problem:
    """Three equal bodies that chase each other along one figure eight.

    Units: those in which the gravitational constant is 1.

    Parameters
    ----------
    periods : int, optional
        How many periods to run; the orbit closes after each.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Raises
    ------
    visviva.InvalidInput
        For a number of periods that is not whole and positive.

    Notes
    -----
    Chenciner & Montgomery, Ann. Math. 152 (2000) 881; initial positions as found by Simó, velocities
    and period refined to 28 digits with them held fixed.

    Examples
    --------
    >>> import visviva as vv
    >>> round(vv.problems.figure_eight().t_end, 6)
    6.325914
    """
    x, y = 0.97000436, -0.24308753
    vx, vy = 0.46620368406953935340327136685, 0.43236573091747685005292775403
    position = [[x, y, 0.0], [-x, -y, 0.0], [0.0, 0.0, 0.0]]
    velocity = [[vx, vy, 0.0], [vx, vy, 0.0], [-2 * vx, -2 * vy, 0.0]]
    t_end = 6.3259140097821385504246998036 * whole_number("periods", periods, low=1)
    return Problem(
        "figure_eight",
        "three equal bodies on one closed curve",
        Scene(Particles([1.0, 1.0, 1.0], position, velocity), Gravity(1.0)),
        t_end,
        (reference(t_end, position),),
        # Linear in time: 11 for one period, 1.07e4 for 1000.
        ((t_end, 11.0 * periods),),
        "Chenciner & Montgomery, Ann. Math. 152 (2000) 881",
    )


@known_keywords
def pythagorean() -> Problem:
    """Burrau's problem: masses 3, 4, 5 at rest at the corners of a 3–4–5 triangle.

    The closest approach of all is 4.138248362587e-4, of bodies 1 and 2 at t = 15.829920271581. By t = 63 the
    problem has amplified its input 3e7 times: compare accuracy up to t = 30, and the outcome beyond.

    Units: those in which the gravitational constant is 1.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there. Its scene has three bodies, positions of shape (3, 3).

    Notes
    -----
    Burrau, Astron. Nachr. 195 (1913) 113; Szebehely & Peters, Astron. J. 72 (1967) 876.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.problems.pythagorean().scene.particles.mass
    array([3., 4., 5.])
    """
    return Problem(
        "pythagorean",
        "masses 3, 4, 5 released at the corners of a 3-4-5 triangle",
        Scene(Particles([3.0, 4.0, 5.0], [[1, 3, 0], [-2, -1, 0], [1, -1, 0]]), Gravity(1.0)),
        30.0,
        tuple(Reference(t, (0,), rows([[x, y, 0.0]])) for t, x, y in PYTHAGOREAN),
        ((30.0, 5.0), (40.0, 5e2), (46.0, 5e4), (59.0, 2e6), (63.0, 3e7), (70.0, 1.5e8)),
        "Szebehely & Peters, Astron. J. 72 (1967) 876",
    )


@known_keywords
def pleiades() -> Problem:
    """Seven stars in a plane with masses 1 … 7 and several close encounters.

    Units: those in which the gravitational constant is 1.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Notes
    -----
    Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, 2nd ed. (1993), II.10.

    Examples
    --------
    >>> import visviva as vv
    >>> len(vv.problems.pleiades().scene.particles)
    7
    """
    x, y = (3, 3, -1, -3, 2, -2, 2), (3, -3, 2, 0, 0, -4, 4)
    vx, vy = (0, 0, 0, 0, 0, 1.75, -1.5), (0, 0, 0, -1.25, 1, 0, 0)
    zero = (0.0,) * 7
    scene = Scene(Particles([1, 2, 3, 4, 5, 6, 7], np.array([x, y, zero]).T, np.array([vx, vy, zero]).T), Gravity(1.0))
    return Problem(
        "pleiades",
        "seven stars in a plane",
        scene,
        3.0,
        (reference(3.0, np.array([*PLEIADES, zero]).T),),
        PLEIADES_CONDITIONING,
        "Hairer, Norsett & Wanner, Solving ODE I (1993), II.10",
    )


@known_keywords
def kepler(e: float = 0.5, mass_ratio: float = 1.0, periods: int = 1) -> Problem:
    """Two bodies with semi-major axis 1, total mass 1 and period 2π, starting at pericenter.

    Units: those in which the gravitational constant is 1.

    Parameters
    ----------
    e : float, optional
        Eccentricity, 0 ≤ e < 1.
    mass_ratio : float, optional
        Mass of the second body over that of the first, not negative.
    periods : int, optional
        How many periods to run; the orbit closes after each.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there. Its scene has two bodies, positions of shape (2, 3).

    Raises
    ------
    visviva.InvalidInput
        For arguments outside these ranges.

    References
    ----------
    Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., § 3.7–3.8.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.problems.kepler(e=0.5).scene.particles.position[:, 0]
    array([-0.25,  0.25])
    """
    if not 0.0 <= number("e", e) < 1.0:
        raise InvalidInput("e", f"expected an eccentricity of an ellipse, 0 ≤ e < 1, got {e!r}")
    if not number("mass_ratio", mass_ratio) >= 0.0:
        raise InvalidInput("mass_ratio", f"expected a number that is not negative, got {mass_ratio!r}")
    first, second = 1.0 / (1.0 + mass_ratio), mass_ratio / (1.0 + mass_ratio)
    distance, speed = 1.0 - e, sqrt((1.0 + e) / (1.0 - e))
    position = [[-second * distance, 0.0, 0.0], [first * distance, 0.0, 0.0]]
    velocity = [[0.0, -second * speed, 0.0], [0.0, first * speed, 0.0]]
    t_end = 2.0 * pi * whole_number("periods", periods, low=1)
    return Problem(
        "kepler",
        f"two bodies, e = {e:g}",
        Scene(Particles([first, second], position, velocity), Gravity(1.0)),
        t_end,
        (reference(t_end, position),),
        # The period depends on the energy: dT/T = 3/2 da/a = 3 (1 + e)/(1 - e) dv/v, and a wrong time is
        # multiplied by the speed at pericenter.
        ((t_end, 6.0 * pi * periods * (1.0 + e) / (1.0 - e) * speed),),
        "Kepler's laws",
    )


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
    velocity = rate * np.stack([-position[:, 1], position[:, 0], np.zeros(3)], axis=1)
    t_end = 2.0 * pi * turn / rate
    c, s = cos(2.0 * pi * turn), sin(2.0 * pi * turn)
    turned = position @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
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
    velocity = rate * np.stack([-position[:, 1], position[:, 0], np.zeros(3)], axis=1)
    t_end = 2.0 * pi * turn / rate
    cosine, sine = cos(2.0 * pi * turn), sin(2.0 * pi * turn)
    turned = position @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
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


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
