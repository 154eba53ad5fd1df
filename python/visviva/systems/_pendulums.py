"""Pendulums: rods without mass, of one length or elastic, hung from a point, from each other or from a cart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import whole_number
from visviva._keywords import known_keywords
from visviva.generalized import Lagrangian
from visviva.generalized._points import with_points
from visviva.systems import _points
from visviva.systems._values import checked

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["cart_pendulum", "chain", "double_pendulum", "pendulum", "spherical_pendulum", "spring_pendulum"]


@known_keywords
def pendulum(
    *,
    g: float = 9.81,
    l: float = 1.0,
    m: float = 1.0,
    position: ArrayLike = (1.0,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Plane pendulum: L = m l² θ̇²/2 + m g l cos θ.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, l, m : float
        Gravity, length and mass.
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
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 11.1 (the pendulum in phase space).

    Examples
    --------
    A large swing comes back after 4 √(l/g) K(sin θ₀/2):

    >>> import visviva as vv
    >>> vv.systems.pendulum(g=1.0, position=[3.0]).run(t=16.1555393723933747).position[-1].round(12)
    array([3.])
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, g, l, m: m * l**2 * v[0] ** 2 / 2 + m * g * l * np.cos(q[0]),
            ["theta"],
            parameters=checked(g=g, l=l, m=m),
            position=position,
            velocity=velocity,
        ),
        _points.hanging,
    )


@known_keywords
def double_pendulum(
    *,
    g: float = 9.81,
    l1: float = 1.0,
    l2: float = 1.0,
    m1: float = 1.0,
    m2: float = 1.0,
    position: ArrayLike = (2.0, 2.5),
    velocity: ArrayLike = (0.0, 0.0),
) -> Lagrangian:
    """Double pendulum, either angle from the downward vertical.

    L = (m₁+m₂) l₁² θ̇₁²/2 + m₂ l₂² θ̇₂²/2 + m₂ l₁ l₂ θ̇₁ θ̇₂ cos(θ₁−θ₂) + (m₁+m₂) g l₁ cos θ₁ + m₂ g l₂ cos θ₂.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, l1, l2, m1, m2 : float
        Gravity; lengths and masses, the upper ones first.
    position, velocity : array_like, shape (2,)
        θ₁ and θ₂, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 5, problem 1.

    Examples
    --------
    >>> import visviva as vv
    >>> out = vv.systems.double_pendulum().run(t=10.0)
    >>> bool(abs(out.energy[-1] / out.energy[0] - 1.0) < 1e-13)
    True
    """

    def function(q: Any, v: Any, _: Any, g: Any, l1: Any, l2: Any, m1: Any, m2: Any) -> Any:
        # cos(θ₁ − θ₂) of the sines and cosines that gravity needs.
        c1, c2, s1, s2 = np.cos(q[0]), np.cos(q[1]), np.sin(q[0]), np.sin(q[1])
        kinetic = (m1 + m2) * l1**2 * v[0] ** 2 / 2 + m2 * l2**2 * v[1] ** 2 / 2
        kinetic = kinetic + m2 * l1 * l2 * v[0] * v[1] * (c1 * c2 + s1 * s2)
        return kinetic + (m1 + m2) * g * l1 * c1 + m2 * g * l2 * c2

    values = checked(g=g, l1=l1, l2=l2, m1=m1, m2=m2)
    return with_points(
        Lagrangian(function, ["theta1", "theta2"], parameters=values, position=position, velocity=velocity),
        _points.hanging,
    )


@known_keywords
def spherical_pendulum(
    *,
    g: float = 9.81,
    l: float = 1.0,
    m: float = 1.0,
    position: ArrayLike = (1.0, 0.0),
    velocity: ArrayLike = (0.0, 1.5),
) -> Lagrangian:
    """Spherical pendulum: L = m l² (θ̇² + φ̇² sin² θ)/2 + m g l cos θ.

    The momentum of φ is conserved. The coordinates are singular on the vertical, where a start is refused.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, l, m : float
        Gravity, length and mass.
    position, velocity : array_like, shape (2,)
        θ from the downward vertical and the azimuth φ, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 14, problem 1.

    Examples
    --------
    With φ̇ = √(g/(l cos θ)) it goes round on a cone:

    >>> import numpy as np, visviva as vv
    >>> cone = vv.systems.spherical_pendulum(position=[0.5, 0.0], velocity=[0.0, np.sqrt(9.81 / np.cos(0.5))])
    >>> cone.run(t=10.0).position[-1].round(12)
    array([ 0.5       , 33.43416729])
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, g, l, m: (
                m * l**2 * (v[0] ** 2 + np.sin(q[0]) ** 2 * v[1] ** 2) / 2 + m * g * l * np.cos(q[0])
            ),
            ["theta", "phi"],
            parameters=checked(g=g, l=l, m=m),
            position=position,
            velocity=velocity,
        ),
        _points.spherical,
    )


@known_keywords
def chain(
    n: int = 10,
    *,
    g: float = 9.81,
    l: float = 1.0,
    m: float = 1.0,
    position: ArrayLike | None = None,
    velocity: ArrayLike | None = None,
) -> Lagrangian:
    """Chain of n equal masses on equal links: a pendulum of n pendulums.

    L = Σᵢ m |ṙᵢ|²/2 + m g l (n+1−i) cos θᵢ with ṙᵢ = Σⱼ≤ᵢ l θ̇ⱼ (cos θⱼ, sin θⱼ).

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    n : int
        Links.
    g, l, m : float
        Gravity, length of a link and mass at its end.
    position, velocity : array_like, shape (n,), optional
        Angles of the links from the downward vertical, the upmost first, and their rates; from 1/2 on by 1/16, and at
        rest, if not given.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For less than one link; for a mass or a length that is not positive.

    References
    ----------
    D. Bernoulli, Comm. Acad. Sci. Petrop. **6**, 108 (1738): small oscillations have ω² = g x/l, x the zeros of
    Laguerre's polynomial Lₙ.

    Examples
    --------
    The slowest oscillation of two links, ω² = (2 − √2) g/l, has θ₂ = √2 θ₁:

    >>> import numpy as np, visviva as vv
    >>> two = vv.systems.chain(2, g=1.0, position=[1e-6, np.sqrt(2) * 1e-6])
    >>> (two.run(t=2 * np.pi / np.sqrt(2 - np.sqrt(2))).position[-1] * 1e6).round(9)
    array([1.        , 1.41421356])
    """
    n = whole_number("n", n, low=1)

    def function(q: Any, v: Any, _: Any, g: Any, l: Any, m: Any) -> Any:
        x: Any = 0.0
        y: Any = 0.0
        total: Any = 0.0
        for i in range(n):
            c = np.cos(q[i])
            x, y = x + l * v[i] * c, y + l * v[i] * np.sin(q[i])
            total = total + m * (x**2 + y**2) / 2 + (n - i) * m * g * l * c
        return total

    start = 0.5 + np.arange(n) / 16 if position is None else position
    names = [f"theta{i + 1}" for i in range(n)]
    return with_points(
        Lagrangian(function, names, parameters=checked(g=g, l=l, m=m), position=start, velocity=velocity),
        _points.hanging,
    )


@known_keywords
def spring_pendulum(
    *,
    g: float = 9.81,
    k: float = 40.0,
    l: float = 1.0,
    m: float = 1.0,
    position: ArrayLike = (1.3, 0.5),
    velocity: ArrayLike = (0.0, 0.0),
) -> Lagrangian:
    """Pendulum on a spring: L = m (ṙ² + r² θ̇²)/2 + m g r cos θ − k (r − l)²/2.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, k, l, m : float
        Gravity, stiffness and length at rest of the spring, mass.
    position, velocity : array_like, shape (2,)
        The length r and θ from the downward vertical, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    A. Vitt & G. Gorelik, J. Tech. Phys. (USSR) **3**, 294 (1933): where k = 3 m g/l, bouncing and swinging
    exchange energy.

    Examples
    --------
    Straight down it bounces with ω² = k/m about l + m g/k:

    >>> import numpy as np, visviva as vv
    >>> bouncing = vv.systems.spring_pendulum(g=10.0, position=[1.5, 0.0])
    >>> bouncing.run(t=np.pi / np.sqrt(40.0)).position[-1].round(12)
    array([1., 0.])
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, g, k, l, m: (
                m * (v[0] ** 2 + q[0] ** 2 * v[1] ** 2) / 2 + m * g * q[0] * np.cos(q[1]) - k * (q[0] - l) ** 2 / 2
            ),
            ["r", "theta"],
            parameters=checked(g=g, k=k, l=l, m=m),
            position=position,
            velocity=velocity,
        ),
        _points.spring,
    )


@known_keywords
def cart_pendulum(
    *,
    g: float = 9.81,
    l: float = 1.0,
    m: float = 1.0,
    cart: float = 2.0,
    position: ArrayLike = (0.0, 1.0),
    velocity: ArrayLike = (0.0, 0.0),
) -> Lagrangian:
    """Pendulum on a cart that rolls freely: L = (M + m) ẋ²/2 + m l ẋ θ̇ cos θ + m l² θ̇²/2 + m g l cos θ.

    The momentum of x is conserved.

    Units: meters, kilograms and seconds, as the default of g is, or any others that go together; angles in radians.

    Parameters
    ----------
    g, l, m, cart : float
        Gravity; length and mass of the pendulum; mass M of the cart.
    position, velocity : array_like, shape (2,)
        The place x of the cart and θ from the downward vertical, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 5, problem 2.

    Examples
    --------
    From rest the center of mass stays above one place:

    >>> import numpy as np, visviva as vv
    >>> x, theta = vv.systems.cart_pendulum().run(t=np.linspace(0.0, 10.0, 11)).position.T
    >>> bool(abs(3.0 * x + np.sin(theta) - np.sin(1.0)).max() < 1e-13)
    True
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, g, l, m, cart: (
                (cart + m) * v[0] ** 2 / 2
                + m * l * v[0] * v[1] * np.cos(q[1])
                + m * l**2 * v[1] ** 2 / 2
                + m * g * l * np.cos(q[1])
            ),
            ["x", "theta"],
            parameters=checked(g=g, l=l, m=m, cart=cart),
            position=position,
            velocity=velocity,
        ),
        _points.cart,
    )
