"""Problems with known answers, shared by tests, benchmarks and users.

A problem carries reference states computed beyond double precision (quadruple precision, Taylor
series of order 40, agreeing with order 34) or in closed form, and says how much the problem itself
amplifies a rounding of its input, so that nobody claims digits that float64 cannot hold.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva._arrays import number, whole_number
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
from visviva._relative_equilibria import euler_collinear, lagrange_triangle
from visviva.datasets.outer_solar_system import outer_solar_system as outer_solar_system_data
from visviva.errors import InvalidInput
from visviva.forces import Gravity
from visviva.particles import Particles
from visviva.scene import Scene

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
        As in `visviva.datasets.outer_solar_system`. Applegate's is put into its center-of-mass frame.

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

    References
    ----------
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

    References
    ----------
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

    References
    ----------
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


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
