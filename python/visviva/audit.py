"""What a field of force does and whether it may: work along paths, curl, and action against reaction.

The one idea: a field is a function of places, whatever made it. `field` makes one of a force of a scene; everything
else that is written here takes any function ``F(r)`` of places of shape (K, 3). What motions and integrators tell of
themselves is in `_audit_motions` and `_audit_methods`, forces between bodies in `_audit_third_law`, work along a run in
`_audit_work_along`.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array, positive
from visviva._audit_methods import order, reversal, symplecticity
from visviva._audit_motions import impulse, mass_ratio, rigidity
from visviva._audit_third_law import ThirdLaw, third_law
from visviva._audit_work_along import looks_at_time, of_any_body, work_along
from visviva._differences import ROUNDING, derivatives
from visviva._expression_table import looks_at_velocities
from visviva._html import Record
from visviva._keywords import known_keywords, unknown_name
from visviva._quadrature import line_integral
from visviva.errors import InvalidInput
from visviva.forces import ExpressedForce, Force
from visviva.particles import Particles
from visviva.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    _Field = Callable[[NDArray[np.float64]], ArrayLike]

__all__ = [
    "Curl",
    "ThirdLaw",
    "curl",
    "field",
    "impulse",
    "mass_ratio",
    "order",
    "reversal",
    "rigidity",
    "symplecticity",
    "third_law",
    "work",
    "work_along",
]


def __dir__() -> list[str]:
    return sorted(__all__)


if not TYPE_CHECKING:
    __getattr__ = unknown_name(__name__, __all__)


@known_keywords
def field(force: Force, *, mass: float = 1.0, t0: float = 0.0) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """The force on a body at rest, as a function of where it is: on one that it acts on, where it names its bodies.

    Units: those of the force's parameters.

    Parameters
    ----------
    force : Force
        One that acts on each body for itself, such as `CentralField` or `UniformField`. On which bodies of a scene
        an `ExpressionForce` acts is left aside: at every place is what one of them feels there.
    mass : float
        Of the body.
    t0 : float
        The time, for a force that looks at it.

    Returns
    -------
    callable
        Of places, shape (K, 3); gives forces, shape (K, 3).

    Raises
    ------
    visviva.InvalidInput
        For a force between bodies, or one with a number for each body, such as charges: those are so many fields.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.audit.field(vv.Harmonic(k=2.0))(np.array([[1.0, 0.0, 0.0]])).tolist()
    [[-2.0, 0.0, 0.0]]
    """
    alone = _on_any_body(force)
    mass = positive("mass", mass)

    def at(places: NDArray[np.float64]) -> NDArray[np.float64]:
        bodies = Particles(np.full(len(places), mass), places)
        return mass * Scene(bodies, alone, t0=t0).acceleration()

    return at


def _on_any_body(force: Force) -> Force:
    """The force as any body that it acts on feels it: places are no bodies of a scene, which could be counted."""
    of_any = of_any_body(force)
    for parameter in force._parameters:
        if parameter.kind == "numbers" and np.size(value := getattr(force, parameter.name)) > 1:
            raise InvalidInput(
                "force",
                f"expected one {parameter.name} of {force!r}, that of the body which feels the field, got "
                f"{np.size(value)}: each of them makes another field",
            )
    return of_any


def _looks_at_velocities(force: Force) -> bool:
    """Of a drag, of what turns velocities, which has an axis, and of an expression that has them."""
    turns = any(parameter.kind == "axial_vector" for parameter in force._parameters)
    by_hand = isinstance(force, ExpressedForce) and looks_at_velocities(force.nodes)
    return turns or force._at_rest == "medium" or by_hand


def _of_places(force: Force | _Field) -> _Field:
    """The field of what depends on places alone: of anything else work along a path and curl say nothing."""
    if not isinstance(force, Force):
        return force
    at = field(force)
    velocities, time = _looks_at_velocities(force), looks_at_time(force)
    if velocities or time:
        looks, alone = ("velocities", "field(force)") if velocities else ("the time", "field(force, t0=...)")
        what = "a body at rest feels of it" if velocities else "it is at one time"
        raise InvalidInput(
            "force",
            f"expected a force of places alone, but {force!r} looks at {looks}, and so what it does depends on the "
            f"motion: take vv.audit.work_along(run, force), or vv.audit.{alone}, which is what {what}",
        )
    return at


@known_keywords
def work(
    force: Force | _Field, path: ArrayLike | Callable[[NDArray[np.float64]], ArrayLike], *, rtol: float = 1e-12
) -> float:
    """The work ∫ F·dr of a field along a path.

    Units: those of the force times those of the places; `rtol` is without dimension.

    Parameters
    ----------
    force : Force or callable
        A force of places alone, on a body of mass 1, or a function of places (K, 3) that gives forces (K, 3).
    path : array_like, shape (P, 3), or callable
        The corners of straight lines, or a smooth function of s from 0 to 1, shape (K,), that gives places (K, 3).
    rtol : float
        Allowed error, of ∫ the product of the sizes of F and dr.

    Returns
    -------
    float

    Raises
    ------
    visviva.InvalidInput
        A force between bodies, or one that looks at velocities or at the time: see `work_along`.
    visviva.ConvergenceError
        If the integral does not settle: a field that jumps or is singular on the path.

    Notes
    -----
    Gauss–Legendre with 8 places in each of ever more pieces, until two in turn agree. What is felt over less than a
    thousandth of a smooth path, or of a line, may fall between all places: give it corners there. Goldstein, Poole &
    Safko, Classical Mechanics, 3rd ed., equation 1.10.

    Examples
    --------
    Not every field of places is conservative: (-y, x) does the work 2π R² around a circle.

    >>> import numpy as np, visviva as vv
    >>> circle = lambda s: np.stack([np.cos(2 * np.pi * s), np.sin(2 * np.pi * s), 0 * s], axis=-1)
    >>> round(vv.audit.work(lambda r: np.stack([-r[:, 1], r[:, 0], 0 * r[:, 2]], axis=-1), circle) / np.pi, 9)
    2.0
    >>> round(vv.audit.work(vv.Harmonic(k=2.0), circle), 12) + 0.0
    0.0
    """
    at = _of_places(force)
    rtol = positive("rtol", rtol)
    if callable(path):
        return line_integral(at, path, rtol)
    corners = float_array("path", path, (None, 3))
    if len(corners) < 2:
        raise InvalidInput("path", f"expected two corners at least, got {len(corners)}")
    pieces = (line_integral(at, _line(a, b), rtol) for a, b in pairwise(corners))
    return float(sum(pieces))


def _line(a: NDArray[np.float64], b: NDArray[np.float64]) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    return lambda s: a + s[:, None] * (b - a)


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Curl(Record):
    """What `curl` finds.

    Units: those of the field over a length; `relative` is without dimension.

    Attributes
    ----------
    value : ndarray, shape (K, 3)
        The curl of the field at each place.
    relative : float
        The largest, over the largest derivative of the field at its place or, where all are smaller than that, over 1e8
        times what differences of the field are rounded by.
    conservative : bool
        Whether that is no more than what the differences err by (1e-8).

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.1.

    Examples
    --------
    >>> import visviva as vv
    >>> places = [[1.0, 0.0, 0.0], [0.0, 2.0, 1.0]]
    >>> found = vv.audit.curl(vv.CentralField(vv.potentials.Coulomb(k=-1.0)), places)
    >>> found.conservative, found.value.shape
    (True, (2, 3))
    """

    value: NDArray[np.float64]
    relative: float
    conservative: bool


@known_keywords
def curl(force: Force | _Field, places: ArrayLike) -> Curl:
    """The curl of a field: zero wherever it is the gradient of a potential.

    Units: those of the field over those of the places.

    Parameters
    ----------
    force : Force or callable
        As of `work`.
    places : array_like, shape (K, 3)
        Where to look.

    Returns
    -------
    Curl

    Raises
    ------
    visviva.InvalidInput
        For places of another shape, a force between bodies, one that looks at velocities or at the time, or a function
        whose values have another shape.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> places = np.random.default_rng(1).normal(size=(5, 3))
    >>> vv.audit.curl(vv.CentralField(vv.potentials.Yukawa(k=-1.0, length=2.0)), places).conservative
    True
    >>> turning = vv.audit.curl(lambda r: np.stack([-r[:, 1], r[:, 0], 0 * r[:, 2]], axis=-1), places)
    >>> turning.conservative, (turning.value[0].round(9) + 0.0).tolist()
    (False, [0.0, 0.0, 2.0])
    """
    at = _of_places(force)
    x = float_array("places", places, (None, 3))
    if len(x) == 0:
        raise InvalidInput("places", "expected one place at least, got none")
    d, rounded = derivatives(at, x)
    value = np.stack([d[:, 2, 1] - d[:, 1, 2], d[:, 0, 2] - d[:, 2, 0], d[:, 1, 0] - d[:, 0, 1]], axis=-1)
    # Beside a field that hardly changes all derivatives are rounding.
    size = np.maximum(np.abs(d).max(axis=(1, 2)), rounded / ROUNDING)
    relative = float(np.max(np.abs(value).max(axis=1) / np.where(size > 0.0, size, 1.0)))
    return Curl(value, relative, relative <= ROUNDING)
