"""What a field of force does and whether it may: work along paths, curl, and action against reaction.

The one idea: a field is a function of places, whatever made it. `field` makes one of a force of a scene; everything
else that is written here takes any function ``F(r)`` of places of shape (K, 3). What motions and integrators tell of
themselves is in `_audit_motions` and `_audit_methods`, forces between bodies in `_audit_third_law`.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core
from visviva._arrays import float_array, positive
from visviva._audit_methods import order, reversal, symplecticity
from visviva._audit_motions import impulse, mass_ratio, rigidity
from visviva._audit_third_law import ThirdLaw, third_law
from visviva._differences import ROUNDING, derivatives
from visviva._expression_table import looks_at_time, looks_at_velocities
from visviva._html import Record
from visviva._keywords import known_keywords, unknown_name
from visviva._quadrature import line_integral
from visviva.errors import InvalidInput
from visviva.forces import DrivenForce, ExpressedForce, Force
from visviva.particles import Particles
from visviva.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from visviva.trajectory import Trajectory

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
    """The force on a body at rest, as a function of where it is.

    Units: those of the force's parameters.

    Parameters
    ----------
    force : Force
        One that acts on each body for itself, such as `CentralField` or `UniformField`.
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
        For a force between bodies.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> vv.audit.field(vv.Harmonic(k=2.0))(np.array([[1.0, 0.0, 0.0]])).tolist()
    [[-2.0, 0.0, 0.0]]
    """
    _on_each(force)
    mass = positive("mass", mass)

    def at(places: NDArray[np.float64]) -> NDArray[np.float64]:
        bodies = Particles(np.full(len(places), mass), places)
        return mass * Scene(bodies, force, t0=t0).acceleration()

    return at


def _on_each(force: Force) -> None:
    """Refuse what is no force, or acts between bodies."""
    if not isinstance(force, Force):
        raise InvalidInput("force", f"expected a force, got {type(force).__name__}")
    # One that has to list bodies acts between them, and what it calls them only a scene knows.
    lists = any(parameter.kind == "indices" and parameter.default is None for parameter in force._parameters)
    if lists or _core.acts_between(force._to_core()):
        raise InvalidInput("force", f"expected a force on each body for itself, but {force!r} acts between bodies")


def _looks_at_time(force: Force) -> bool:
    return isinstance(force, DrivenForce) or (isinstance(force, ExpressedForce) and looks_at_time(force.nodes))


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
    velocities, time = _looks_at_velocities(force), _looks_at_time(force)
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
def work_along(trajectory: Trajectory, force: Force) -> NDArray[np.float64]:
    """The work of one force on each body along a recorded run, up to each of its times.

    Units: those of the scene.

    Parameters
    ----------
    trajectory : Trajectory
        With position and velocity at times as close as the motion needs.
    force : Force
        One that acts on each body for itself.

    Returns
    -------
    ndarray, shape (T, N)
        From 0 at the first time. All forces together do the work by which the kinetic energy grows.

    Raises
    ------
    visviva.InvalidInput
        For a force between bodies, or a run that did not record velocities.

    Notes
    -----
    Power F·v between two times is that at three places of Gauss and Lobatto, the middle one on Hermite's cubic through
    both ends: the error falls with the fourth power of the times' distance.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., § 1.1.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> pull = vv.UniformField((0, 0, -10.0))
    >>> ball = vv.Scene(vv.Particles([2.0], [[0, 0, 0]], [[1.0, 0, 5.0]]), pull)
    >>> vv.audit.work_along(ball.run(t=np.linspace(0, 1, 5)), pull)[-1].tolist()
    [0.0]
    """
    _on_each(force)
    t, x, v = trajectory.t, trajectory.position, trajectory.velocity
    mass = trajectory.scene.particles.mass
    if len(t) < 2:
        return np.zeros((len(t), len(mass)))
    before, after = slice(None, -1), slice(1, None)
    h = np.diff(t)[:, None, None]
    middle_x = 0.5 * (x[before] + x[after]) + 0.125 * h * (v[before] - v[after])
    # Between two rows of one time nothing is done, whatever the velocity.
    middle_v = 1.5 * (x[after] - x[before]) / np.where(h != 0.0, h, 1.0) - 0.25 * (v[before] + v[after])
    ends = _power(force, mass, t, x, v)
    middle = _power(force, mass, 0.5 * (t[before] + t[after]), middle_x, middle_v)
    steps = h[:, :, 0] / 6.0 * (ends[before] + 4.0 * middle + ends[after])
    return np.concatenate([np.zeros((1, len(mass))), np.cumsum(steps, axis=0)])


def _power(force: Force, mass: Any, t: Any, x: Any, v: Any) -> NDArray[np.float64]:
    """F·v of every body at every time."""
    power: NDArray[np.float64] = np.einsum("tnc,tnc->tn", mass[:, None] * _accelerations(force, mass, t, x, v), v)
    return power


def _accelerations(force: Force, mass: Any, t: Any, x: Any, v: Any) -> NDArray[np.float64]:
    """Those of every body at every time, (T, N, 3): all times as so many more bodies, if a force is the same at all."""
    own = force._to_core()
    if not _looks_at_time(force):
        several = [p.name for p in force._parameters if p.kind == "numbers" and np.ndim(own[p.name]) == 1]
        if all(len(own[name]) == len(mass) for name in several):
            of_all = own | {name: np.tile(own[name], len(t)) for name in several}
            masses, places, velocities = np.tile(mass, len(t)), x.reshape(-1, 3), v.reshape(-1, 3)
            # What is refused is refused below, where bodies have the numbers that they have in the run.
            with suppress(InvalidInput):
                return _core.acceleration(
                    mass=masses, forces=[of_all], position=places, velocity=velocities, t0=float(t[0])
                ).reshape(x.shape)
    rows = [
        _core.acceleration(mass=mass, forces=[own], position=places, velocity=velocities, t0=now)
        for now, places, velocities in zip(t.tolist(), x, v, strict=True)
    ]
    return np.array(rows).reshape(x.shape)


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
