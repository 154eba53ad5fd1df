"""Systems on guides that move by themselves: constraints that know the time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import known_keywords
from visviva.generalized import Lagrangian
from visviva.generalized._points import with_points
from visviva.systems import _points
from visviva.systems._values import checked

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["hoop", "kapitza", "moving_pivot", "rod"]


@known_keywords
def rod(
    *,
    m: float = 1.0,
    Omega: float = 1.0,
    position: ArrayLike = (1.0,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Bead on a straight rod that turns in a horizontal plane at a constant rate: L = m (ṙ² + r² Ω²)/2.

    Jacobi's integral m (ṙ² − r² Ω²)/2 is conserved, and is no energy: the motor gives what the bead gains.

    Units: those of the caller, one consistent system; angles in radians.

    Parameters
    ----------
    m, Omega : float
        Mass of the bead, rate of the rod.
    position, velocity : array_like, shape (1,)
        Distance r from the axis, and its rate.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass that is not positive.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.6, example 3.

    Examples
    --------
    From rest in the rod, r = r₀ cosh Ω t:

    >>> import visviva as vv
    >>> vv.systems.rod().run(t=1.0).position[-1].round(12)
    array([1.54308063])
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, m, Omega: m * (v[0] ** 2 + Omega**2 * q[0] ** 2) / 2,
            ["r"],
            parameters=checked(m=m, Omega=Omega),
            position=position,
            velocity=velocity,
        ),
        _points.bead_on_rod,
    )


@known_keywords
def hoop(
    *,
    g: float = 9.81,
    m: float = 1.0,
    R: float = 1.0,
    Omega: float = 4.0,
    position: ArrayLike = (0.25,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Bead on a hoop that turns about its vertical diameter at a constant rate.

    L = m R² (θ̇² + Ω² sin² θ)/2 + m g R cos θ. Jacobi's integral is conserved; T + V exceeds it by m R² Ω² sin² θ. Above
    Ω² = g/R the bead is at rest where cos θ = g/(R Ω²), and oscillates about that with Ω sin θ.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, m, R, Omega : float
        Gravity, mass of the bead, radius and rate of the hoop.
    position, velocity : array_like, shape (1,)
        θ from the downward vertical, and θ̇.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a radius that is not positive.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., ch. 2, exercise 18.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> aloft = vv.systems.hoop(g=8.0, position=[np.pi / 3])
    >>> bool(abs(aloft.run(t=1.0).position[-1, 0] - np.pi / 3) < 1e-14)
    True
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, g, m, R, Omega: (
                m * R**2 * (v[0] ** 2 + Omega**2 * np.sin(q[0]) ** 2) / 2 + m * g * R * np.cos(q[0])
            ),
            ["theta"],
            parameters=checked(g=g, m=m, R=R, Omega=Omega),
            position=position,
            velocity=velocity,
        ),
        _points.bead_on_hoop,
    )


@known_keywords
def moving_pivot(
    *,
    g: float = 9.81,
    l: float = 1.0,
    m: float = 1.0,
    X: float = 0.2,
    Y: float = 0.0,
    Omega: float = 2.0,
    position: ArrayLike = (0.0,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Pendulum whose pivot goes round an ellipse, or along a line: x = X cos Ωt, y = Y sin Ωt.

    L = m l² θ̇²/2 + m l [(g + ÿ) cos θ − ẍ sin θ], up to a derivative with respect to time.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, l, m : float
        Gravity, length and mass.
    X, Y, Omega : float
        Half-axes of the pivot's way, horizontal and vertical, and its rate.
    position, velocity : array_like, shape (1,)
        θ from the downward vertical, and θ̇.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 5, problem 3.

    Examples
    --------
    >>> import visviva as vv
    >>> shaken = vv.systems.moving_pivot()
    >>> shaken.autonomous, shaken.conserved
    (False, [])
    """

    def function(q: Any, v: Any, t: Any, g: Any, l: Any, m: Any, X: Any, Y: Any, Omega: Any) -> Any:
        x, y = -X * Omega**2 * np.cos(Omega * t), -Y * Omega**2 * np.sin(Omega * t)
        return m * l**2 * v[0] ** 2 / 2 + m * l * ((g + y) * np.cos(q[0]) - x * np.sin(q[0]))

    values = checked(g=g, l=l, m=m, X=X, Y=Y, Omega=Omega)
    return with_points(
        Lagrangian(function, ["theta"], parameters=values, position=position, velocity=velocity), _points.moving_pivot
    )


@known_keywords
def kapitza(
    *,
    g: float = 9.81,
    l: float = 1.0,
    m: float = 1.0,
    a: float = 0.1,
    Omega: float = 100.0,
    position: ArrayLike = (3.0,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Kapitza's pendulum: the pivot vibrates along the vertical, y = a cos Ωt, and upside down it may stand.

    L = m l² θ̇²/2 + m l (g + ÿ) cos θ, up to a derivative with respect to time. The upper place is stable if
    a² Ω² > 2 g l (for a ≪ l).

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, l, m : float
        Gravity, length and mass.
    a, Omega : float
        Amplitude and rate of the pivot.
    position, velocity : array_like, shape (1,)
        θ from the downward vertical, and θ̇.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 30, problem 1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> standing = vv.systems.kapitza().run(t=np.linspace(0.0, 10.0, 101))["theta"]
    >>> falling = vv.systems.kapitza(a=0.01).run(t=np.linspace(0.0, 10.0, 101))["theta"]
    >>> bool(abs(standing - np.pi).max() < 0.2), bool(abs(falling - np.pi).max() < 0.2)
    (True, False)
    """

    def function(q: Any, v: Any, t: Any, g: Any, l: Any, m: Any, a: Any, Omega: Any) -> Any:
        y = -a * Omega**2 * np.cos(Omega * t)
        return m * l**2 * v[0] ** 2 / 2 + m * l * (g + y) * np.cos(q[0])

    values = checked(g=g, l=l, m=m, a=a, Omega=Omega)
    return with_points(
        Lagrangian(function, ["theta"], parameters=values, position=position, velocity=velocity), _points.moving_pivot
    )
