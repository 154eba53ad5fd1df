"""Drag of spheres: which law holds and how strong it is, and what is told of a body thrown straight up.

The Reynolds number is taken with the radius, ρ a v/μ. `stokes` and `quadratic` make the forces of a scene; both
together are the mixed law. `visviva.Drag` has the laws that hold between them, by name; `custom` and `tabulated` take
one's own. Units are yours, one consistent system.

Source: Landau & Lifshitz, *Fluid Mechanics*, 2nd ed., §19, §20 and §45.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from visviva import _core
from visviva._arrays import float_array, number, positive
from visviva._drag_throw import Throw, throw
from visviva._keywords import known_keywords, unknown_name
from visviva.errors import InvalidInput
from visviva.forces import LinearDrag, QuadraticDrag, SampledDrag

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from visviva.typing import CompiledFunction

__all__ = ["Throw", "crossover_speed", "custom", "quadratic", "reynolds_number", "stokes", "tabulated", "throw"]


@known_keywords
def reynolds_number(*, density: float, radius: float, speed: float, viscosity: float) -> float:
    """The Reynolds number ρ a v/μ of a sphere.

    Parameters
    ----------
    density, radius, speed, viscosity : float
        Density of the fluid, radius and speed of the sphere, viscosity of the fluid; positive, in consistent units.

    Returns
    -------
    float

    Raises
    ------
    visviva.InvalidInput
        If a number is not positive.

    References
    ----------
    Landau & Lifshitz, *Fluid Mechanics*, 2nd ed., § 19.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.drag.reynolds_number(density=2.0, radius=3.0, speed=4.0, viscosity=8.0)
    3.0
    """
    return _core.drag_reynolds_number(
        positive("density", density),
        positive("radius", radius),
        positive("speed", speed),
        positive("viscosity", viscosity),
    )


@known_keywords
def quadratic(
    *,
    density: float,
    radius: float,
    drag_coefficient: float,
    viscosity: float | None = None,
    speed: float | None = None,
) -> QuadraticDrag:
    """Quadratic drag on a sphere, with the coefficient ½ C ρ π a².

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    density, radius : float
        Density of the fluid and radius of the sphere.
    drag_coefficient : float
        C, about 0.5 for a smooth sphere where the law holds.
    viscosity, speed : float, optional
        Viscosity of the fluid and speed of the sphere: where both are given, the law is refused where it does not hold.

    Returns
    -------
    QuadraticDrag

    Raises
    ------
    visviva.InvalidInput
        If a number is not positive; for a Reynolds number outside of 1e3 to 1e5.

    References
    ----------
    Landau & Lifshitz, Fluid Mechanics, 2nd ed., section 45.

    Examples
    --------
    >>> import visviva as vv
    >>> ball = vv.drag.quadratic(density=1.2, radius=0.02, drag_coefficient=0.47, viscosity=1.8e-5, speed=30.0)
    >>> round(ball.coefficient, 9)
    0.000354372
    """
    checked = _both("viscosity", viscosity, "speed", speed)
    return QuadraticDrag(
        _core.drag_quadratic(
            positive("density", density),
            positive("radius", radius),
            positive("drag_coefficient", drag_coefficient),
            *checked,
        )
    )


@known_keywords
def stokes(
    *, mass: float, radius: float, viscosity: float, density: float | None = None, speed: float | None = None
) -> LinearDrag:
    """Linear drag on a sphere by Stokes' law, with the time m/(6πaμ).

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    mass, radius, viscosity : float
        Mass and radius of the sphere, viscosity of the fluid.
    density, speed : float, optional
        Density of the fluid and speed of the sphere: where both are given, the law is refused where it does not hold.

    Returns
    -------
    LinearDrag

    Raises
    ------
    visviva.InvalidInput
        If a number is not positive; for a Reynolds number above 0.3, where the law errs by more than a tenth.

    References
    ----------
    Landau & Lifshitz, Fluid Mechanics, 2nd ed., section 20.

    Examples
    --------
    >>> import visviva as vv
    >>> round(vv.drag.stokes(mass=1e-15, radius=4e-7, viscosity=1.002e-3).tau, 12)
    1.32364e-07
    """
    checked = _both("density", density, "speed", speed)
    return LinearDrag(
        _core.drag_stokes(
            positive("mass", mass), positive("radius", radius), positive("viscosity", viscosity), *checked
        )
    )


@known_keywords
def custom(
    function: Callable[[NDArray[np.float64]], ArrayLike] | CompiledFunction,
    R_min: float,
    R_max: float,
    *,
    density: float,
    viscosity: float,
    radius: ArrayLike,
    tolerance: float = 1e-12,
) -> SampledDrag:
    """Drag F(R) ρ a² v² by a function of the Reynolds number, sampled once: polynomials in pieces that were checked.

    What is kept is the factor f = R F/(6π), drag over that of Stokes. Below `R_min` it stays what it is there, so drag
    is linear; beyond `R_max` there is no value. A drag coefficient C of the Reynolds number Re with the diameter is the
    function ``lambda R: np.pi / 2 * C(2 * R)``.

    Units: those of the caller, one consistent system; R and F are without dimension.

    Parameters
    ----------
    function : callable, int, numba CFunc, ctypes function or scipy.LowLevelCallable
        F(R) of an array of any shape, elementwise, nowhere negative; or a compiled ``double f(double)``, or its
        address.
    R_min, R_max : float, positive
        Reynolds numbers, ρ a v/μ, between which the function is asked.
    density, viscosity : float, positive
        Of the fluid.
    radius : float or array_like, shape (N,), not negative
        Of every body, or of each.
    tolerance : float, optional
        Largest error of f allowed, from 1e-12 to 1e-4, relative to f + R abs(df/dR): as of `visviva.potentials.Custom`.

    Returns
    -------
    SampledDrag
        With a continuous second derivative, and in `error` the largest error found. The function is not kept.

    Raises
    ------
    visviva.InvalidInput
        For a number that is not as said above, values that are no finite numbers of the shape of R, and a function that
        is not smooth enough.

    References
    ----------
    L. N. Trefethen, Approximation Theory and Approximation Practice (2013), chapters 3 to 8.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> def abraham(R):  # F. F. Abraham, Phys. Fluids 13 (1970) 2194
    ...     return np.pi / 2 * 0.29238 * (1 + 9.06 / np.sqrt(2 * R)) ** 2
    >>> drop = vv.drag.custom(abraham, 1e-6, 2.5e3, density=1.2, viscosity=1.8e-5, radius=1e-3)
    >>> drop.error < 1e-12
    True
    """
    from visviva._compiled import sampler

    between = number("R_min", R_min), number("R_max", R_max)
    pieces = _core.fitted(sampler(function, "R"), between, number("tolerance", tolerance), drag=True)
    return SampledDrag(density, viscosity, radius, *pieces)


@known_keywords
def tabulated(
    R: ArrayLike,
    F: ArrayLike,
    *,
    density: float,
    viscosity: float,
    radius: ArrayLike,
) -> SampledDrag:
    """Drag F(R) ρ a² v² by a table over the Reynolds number: twice continuously differentiable, and monotone.

    Where R F rises, or falls, over four points in a row, so does the curve of it between the middle two. Below the
    first point drag is linear, beyond the last there is no value.

    Units: those of the caller, one consistent system; R and F are without dimension.

    Parameters
    ----------
    R : array_like, shape (P,)
        Reynolds numbers, ρ a v/μ, ascending and above 0, at least four.
    F : array_like, shape (P,)
        Values there, not negative; π/2 C of a drag coefficient C.
    density, viscosity : float, positive
        Of the fluid.
    radius : float or array_like, shape (N,), not negative
        Of every body, or of each.

    Returns
    -------
    SampledDrag
        For ``Scene``.

    Raises
    ------
    visviva.InvalidInput
        If a number is not as said above.

    References
    ----------
    R. L. Dougherty, A. Edelman, J. M. Hyman, Math. Comp. 52 (1989) 471.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> Re = np.array([0.1, 1.0, 10.0, 100.0, 1e3, 1e4])  # S. A. Morsi, A. J. Alexander, J. Fluid Mech. 55 (1972) 193
    >>> C = np.array([240.0, 26.5, 4.1, 1.07, 0.46, 0.41])
    >>> vv.drag.tabulated(Re / 2, np.pi / 2 * C, density=1.2, viscosity=1.8e-5, radius=1e-3).breaks[-1].item()
    5000.0
    """
    pieces = _core.tabulated_drag(float_array("R", R, (None,)), float_array("F", F, (None,)))
    return SampledDrag(density, viscosity, radius, *pieces)


@known_keywords
def crossover_speed(*, density: float, radius: float, viscosity: float, drag_coefficient: float) -> float:
    """The speed of a sphere at which Stokes' law and the quadratic one give the same drag.

    Units: those of the caller, one consistent system.

    Parameters
    ----------
    density, radius, viscosity, drag_coefficient : float
        As in `quadratic`.

    Returns
    -------
    float

    Raises
    ------
    visviva.InvalidInput
        If a number is not positive.

    References
    ----------
    Landau & Lifshitz, *Fluid Mechanics*, 2nd ed., § 20 and 45.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.drag.crossover_speed(density=2.0, radius=3.0, viscosity=4.0, drag_coefficient=0.5)
    16.0
    """
    return _core.drag_crossover_speed(
        positive("density", density),
        positive("radius", radius),
        positive("viscosity", viscosity),
        positive("drag_coefficient", drag_coefficient),
    )


def _both(one: str, first: float | None, other: str, second: float | None) -> tuple[float, float]:
    """Both numbers, or zeros if neither is known."""
    if first is None and second is None:
        return 0.0, 0.0
    if first is None or second is None:
        missing = one if first is None else other
        raise InvalidInput(missing, f"expected {one} and {other}, or neither; {missing} is missing")
    return positive(one, first), positive(other, second)


def __dir__() -> list[str]:
    return list(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)
