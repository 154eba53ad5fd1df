"""Two masses on a string over a pulley."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._keywords import known_keywords
from visviva.generalized import Lagrangian
from visviva.generalized._points import with_points
from visviva.systems import _points
from visviva.systems._values import checked

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["atwood", "swinging_atwood"]


@known_keywords
def atwood(
    *,
    g: float = 9.81,
    m1: float = 2.0,
    m2: float = 1.0,
    length: float = 2.0,
    position: ArrayLike | None = None,
    velocity: ArrayLike | None = None,
) -> Lagrangian:
    """Atwood's machine, the string as a constraint: L = m₁ ẋ₁²/2 + m₂ ẋ₂²/2 + g (m₁ x₁ + m₂ x₂) with x₁ + x₂ = length.

    ``reactions`` of a run is the force of the string along either coordinate: minus its tension 2 m₁ m₂ g/(m₁ + m₂), as
    it pulls up and coordinates go down.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, m1, m2, length : float
        Gravity, the masses, and the length of the string.
    position, velocity : array_like, shape (2,), optional
        How far the masses are below the pulley, and their rates; in the middle and at rest if not given.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.6, example 2, and § 2.4.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.systems.atwood(m1=3.0, m2=2.0, g=10.0).run(t=0.5)
    >>> out.position[-1].round(12), out.reactions[-1].round(12)
    (array([1.25, 0.75]), array([-24.]))
    """
    values = checked(g=g, m1=m1, m2=m2, length=length)
    middle = values["length"] / 2
    return with_points(
        Lagrangian(
            lambda q, v, _, g, m1, m2, length: (  # noqa: ARG005
                m1 * v[0] ** 2 / 2 + m2 * v[1] ** 2 / 2 + g * (m1 * q[0] + m2 * q[1])
            ),
            ["x1", "x2"],
            parameters=values,
            position=(middle, middle) if position is None else position,
            velocity=velocity,
            constraints=[lambda q, _v, _t, length, **_others: q[0] + q[1] - length],
        ),
        _points.atwood,
    )


@known_keywords
def swinging_atwood(
    *,
    g: float = 9.81,
    m: float = 1.0,
    counterweight: float = 3.0,
    position: ArrayLike = (1.0, 1.5),
    velocity: ArrayLike = (0.0, 0.0),
) -> Lagrangian:
    """Swinging Atwood's machine: one mass swings, the other is its counterweight.

    L = (M + m) ṙ²/2 + m r² θ̇²/2 − g r (M − m cos θ) with the counterweight M. For M = 3 m it is integrable, else it may
    be chaotic.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, m, counterweight : float
        Gravity, the mass that swings, and the other.
    position, velocity : array_like, shape (2,)
        Distance r from the pulley and θ from the downward vertical, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass that is not positive.

    References
    ----------
    N. B. Tufillaro, T. A. Abbott & D. J. Griffiths, Am. J. Phys. **52**, 895 (1984).

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.systems.swinging_atwood().run(t=10.0)
    >>> out.conservation()["energy"] < 1e-13
    True
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, g, m, counterweight: (
                (counterweight + m) * v[0] ** 2 / 2
                + m * q[0] ** 2 * v[1] ** 2 / 2
                - g * q[0] * (counterweight - m * np.cos(q[1]))
            ),
            ["r", "theta"],
            parameters=checked(g=g, m=m, counterweight=counterweight),
            position=position,
            velocity=velocity,
        ),
        _points.swinging_atwood,
    )
