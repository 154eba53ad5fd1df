"""Problems of few bodies in fields, drag and on a knife's edge; see `visviva.problems`."""

from __future__ import annotations

from visviva._keywords import known_keywords
from visviva._problem import Problem, reference
from visviva._reference_states import ARENSTORF, CROSSED_FIELDS, DRIVEN_OSCILLATOR, PROJECTILE
from visviva.forces import (
    DrivenForce,
    Gravity,
    LinearDrag,
    QuadraticDrag,
    Spring,
    UniformField,
    UniformMagneticField,
)
from visviva.particles import Particles
from visviva.scene import Scene

__all__ = ["arenstorf", "crossed_fields", "driven_oscillator", "projectile"]


@known_keywords
def arenstorf() -> Problem:
    """A satellite on Arenstorf's closed orbit about Earth and Moon, which turn about each other, through one period.

    In the frame that does not turn, so that it is a scene of two masses and a test particle: at the end the satellite
    is where it was as seen from the turned pair. It begins and ends beside the Moon, at 0.006 of the distance of the
    pair: equal steps do badly.

    Units: those in which the distance of the pair, the sum of their masses and the gravitational constant are 1.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Notes
    -----
    Arenstorf, Amer. J. Math. 85 (1963) 27; numbers of Hairer, Nørsett & Wanner, *Solving Ordinary Differential
    Equations I*, II.0. The reference is of the rounded numbers that the scene has, by Taylor series of order 40 in 50
    digits.

    Examples
    --------
    >>> import visviva as vv
    >>> problem = vv.problems.arenstorf()
    >>> problem.error(problem.scene.run(t=problem.t_end, rtol=1e-13)) < 1e-8
    True
    """
    moon, speed = 0.012277471, -2.00158510637908252240537862224
    bodies = Particles(
        [1.0 - moon, moon, 0.0],
        [[-moon, 0.0, 0.0], [1.0 - moon, 0.0, 0.0], [0.994, 0.0, 0.0]],
        [[0.0, -moon, 0.0], [0.0, 1.0 - moon, 0.0], [0.0, speed + 0.994, 0.0]],
        ["Earth", "Moon", "satellite"],
    )
    t_end = 17.0652165601579625588917206249
    return Problem(
        "arenstorf",
        "a satellite that passes Earth and Moon",
        Scene(bodies, Gravity(1.0)),
        t_end,
        (reference(t_end, ARENSTORF),),
        ((t_end, 3e4),),
        "Hairer, Norsett & Wanner, Solving ODE I (1993), II.0",
    )


@known_keywords
def driven_oscillator() -> Problem:
    """Two bodies on a spring in a medium that slows them, driven near resonance, for 24 periods of the drive.

    Their distance is a damped oscillator of the frequency 2 and the quality factor 40, driven at 1.5; the center of
    mass is driven, too. The energy comes and goes: errors are of positions.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Notes
    -----
    The closed form of the linear equations (Goldstein, Poole & Safko §6.5), in 45 digits.

    Examples
    --------
    >>> import visviva as vv
    >>> problem = vv.problems.driven_oscillator()
    >>> problem.error(problem.scene.run(t=problem.t_end, rtol=1e-12)) < 1e-9
    True
    """
    bodies = Particles([3.0, 1.0], [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 0.25]])
    scene = Scene(
        bodies, Spring(0, 1, k=3.0), LinearDrag(tau=20.0), DrivenForce([1.5, 0.75, 0.0], frequency=1.5, phase=0.25)
    )
    return Problem(
        "driven_oscillator",
        "two bodies on a spring, damped and driven",
        scene,
        100.0,
        (reference(100.0, DRIVEN_OSCILLATOR),),
        ((100.0, 50.0),),
        "Goldstein, Poole & Safko, Classical Mechanics 3rd ed., section 6.5",
    )


@known_keywords
def crossed_fields() -> Problem:
    """A charge in a magnetic field and an electric one across it, for 32 gyrations: it drifts across both.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Notes
    -----
    The closed form of a cycloid (Goldstein, Poole & Safko §1.5; Jackson, *Classical Electrodynamics* §12.3), in 45
    digits. Run without a method it is found in closed form.

    Examples
    --------
    >>> import visviva as vv
    >>> problem = vv.problems.crossed_fields()
    >>> problem.error(problem.scene.run(t=problem.t_end)) < 1e-13
    True
    """
    charge = Particles([1.0], [[0.0, 0.0, 0.0]], [[1.0, 0.25, 0.5]])
    return Problem(
        "crossed_fields",
        "a charge in a magnetic field and an electric one across it",
        Scene(charge, UniformMagneticField([0.0, 0.0, 2.0]), UniformField([0.5, 0.0, 0.0])),
        100.0,
        (reference(100.0, CROSSED_FIELDS),),
        ((100.0, 1.7e2),),
        "Jackson, Classical Electrodynamics 3rd ed., section 12.3",
    )


@known_keywords
def projectile() -> Problem:
    """A body thrown into a medium that resists by the square of its speed: it comes down almost upright.

    Returns
    -------
    Problem
        With its scene, its end, and where bodies must be there.

    Notes
    -----
    No closed form is known but for an upright throw. The reference is by Taylor series in 30 and 40 digits, which agree
    to 25 (mpmath's ``odefun``; the tests do it again).

    References
    ----------
    Landau & Lifshitz, *Fluid Mechanics*, 2nd ed., § 45, for the law of the drag.

    Examples
    --------
    >>> import visviva as vv
    >>> problem = vv.problems.projectile()
    >>> problem.error(problem.scene.run(t=problem.t_end, rtol=1e-12)) < 1e-9
    True
    """
    stone = Particles([2.0], [[0.0, 0.0, 0.0]], [[40.0, 0.0, 30.0]])
    return Problem(
        "projectile",
        "a throw with quadratic drag",
        Scene(stone, UniformField([0.0, 0.0, -9.75]), QuadraticDrag(0.125)),
        4.0,
        (reference(4.0, PROJECTILE),),
        ((4.0, 85.0),),
        "Landau & Lifshitz, Fluid Mechanics 2nd ed., section 45",
    )
