"""Systems with linear equations."""

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

__all__ = ["constant_force", "coupled_oscillators", "foucault", "oscillator"]


@known_keywords
def oscillator(
    *,
    k: float = 1.0,
    m: float = 1.0,
    position: ArrayLike = (1.0,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Harmonic oscillator: L = m ẋ²/2 − k x²/2.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    k, m : float
        Stiffness and mass.
    position, velocity : array_like, shape (1,)
        x from the place of rest, and ẋ.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 21.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.systems.oscillator(k=4.0).run(t=np.pi / 3).position[-1].round(12)
    array([-0.5])
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, k, m: m * v[0] ** 2 / 2 - k * q[0] ** 2 / 2,
            ["x"],
            parameters=checked(k=k, m=m),
            position=position,
            velocity=velocity,
        ),
        _points.line,
    )


@known_keywords
def constant_force(
    *,
    F: float = 1.0,
    m: float = 1.0,
    position: ArrayLike = (0.0,),
    velocity: ArrayLike = (0.0,),
) -> Lagrangian:
    """Constant force: L = m ẋ²/2 + F x.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    F, m : float
        Force and mass.
    position, velocity : array_like, shape (1,)
        x and ẋ.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 5.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.systems.constant_force(F=3.0).run(t=2.0).position[-1].round(12)
    array([6.])
    """
    return with_points(
        Lagrangian(
            lambda q, v, _, F, m: m * v[0] ** 2 / 2 + F * q[0],
            ["x"],
            parameters=checked(F=F, m=m),
            position=position,
            velocity=velocity,
        ),
        _points.line,
    )


@known_keywords
def coupled_oscillators(
    n: int = 2,
    *,
    k: float = 1.0,
    coupling: float = 0.1,
    m: float = 1.0,
    position: ArrayLike | None = None,
    velocity: ArrayLike | None = None,
) -> Lagrangian:
    """Equal oscillators in a row, coupled to their neighbors: L = Σ (m ẋᵢ² − k xᵢ²)/2 − Σ coupling (xᵢ₊₁ − xᵢ)²/2.

    Modes have ω² = [k + 4 · coupling · sin²(π j/2n)]/m with j = 0 … n − 1.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    n : int
        Oscillators.
    k, coupling, m : float
        Stiffness of each alone and of the springs between two, and mass.
    position, velocity : array_like, shape (n,), optional
        Places from rest, and their rates; the first at 1 if not given.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For less than one oscillator; for a mass that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 23, problem 1.

    Examples
    --------
    Of two, the sum oscillates with ω² = k/m and the difference with ω² = (k + 2 · coupling)/m:

    >>> import numpy as np, visviva as vv
    >>> out = vv.systems.coupled_oscillators(coupling=1.5).run(t=np.pi)
    >>> out.position[-1].round(12) + 0.0
    array([ 0., -1.])
    """
    n = whole_number("n", n, low=1)

    def function(q: Any, v: Any, _: Any, k: Any, coupling: Any, m: Any) -> Any:
        alone = sum(m * v[i] ** 2 / 2 - k * q[i] ** 2 / 2 for i in range(n))
        return alone - sum(coupling * (q[i + 1] - q[i]) ** 2 / 2 for i in range(n - 1))

    names = [f"x{i + 1}" for i in range(n)]
    start = np.eye(n)[0] if position is None else position
    values = checked(k=k, coupling=coupling, m=m)
    return with_points(Lagrangian(function, names, parameters=values, position=start, velocity=velocity), _points.line)


@known_keywords
def foucault(
    *,
    g: float = 9.81,
    l: float = 67.0,
    m: float = 28.0,
    Omega: float = 7.292115e-5,
    latitude: float = 0.8526,
    position: ArrayLike = (1.0, 0.0),
    velocity: ArrayLike = (0.0, 0.0),
) -> Lagrangian:
    """Foucault's pendulum, small swings: L = m (ẋ² + ẏ²)/2 + m Ω sin λ (x ẏ − y ẋ) − m g (x² + y²)/2l.

    The plane of its swings turns at −Ω sin λ. The centrifugal force is part of g.

    Parameters
    ----------
    g, l, m : float
        Gravity, length and mass.
    Omega, latitude : float
        Rate of the Earth in 1/s; λ in radians. Paris if not given.
    position, velocity : array_like, shape (2,)
        Places x to the east and y to the north of the place of rest, and their rates.

    Returns
    -------
    Lagrangian

    Raises
    ------
    InvalidInput
        For a mass or a length that is not positive.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., § 39, problem 3.

    Examples
    --------
    After 100 swings the plane has turned from the east to the south:

    >>> import numpy as np, visviva as vv
    >>> rate = 7.292115e-5 * np.sin(0.8526)
    >>> swings = 200 * np.pi / np.sqrt(9.81 / 67.0 + rate**2)
    >>> x, y = vv.systems.foucault().run(t=swings).position[-1]
    >>> bool(abs(np.arctan2(y, x) + rate * swings) < 1e-9)
    True
    """

    def function(q: Any, v: Any, _: Any, g: Any, l: Any, m: Any, Omega: Any, latitude: Any) -> Any:
        kinetic = m * (v[0] ** 2 + v[1] ** 2) / 2 + m * Omega * np.sin(latitude) * (q[0] * v[1] - q[1] * v[0])
        return kinetic - m * g * (q[0] ** 2 + q[1] ** 2) / (2 * l)

    values = checked(g=g, l=l, m=m, Omega=Omega, latitude=latitude)
    return with_points(
        Lagrangian(function, ["x", "y"], parameters=values, position=position, velocity=velocity), _points.cartesian
    )
