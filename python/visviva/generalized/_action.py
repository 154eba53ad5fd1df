"""The action S = ∫ L dt along a path, and its variations: S[q + ε η] = S + ε δS[η] + ε²/2 δ²S[η] + O(ε³).

The one idea: an integrand of (t, q, q̇, η, η̇) is summed over the pieces of a path by Gauss and Legendre, and again over
their halves until that changes nothing; what a coarser path would have changed is told beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from visviva._arrays import float_array
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva._quadrature import _DERIVATIVE, _NODES, _WEIGHTS
from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._path import Path, as_path, interpolated

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._nodes import Node

__all__ = ["PathIntegral", "action", "derivatives", "first_variation", "hessian", "second_variation"]

#: Values at nodes in pieces: t (K, M); q, q̇, η, η̇ (K, M, n).
Integrand: TypeAlias = Callable[..., Any]
_MOST_HALVINGS = 7
_EPS = float(np.finfo(float).eps)


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class PathIntegral(Record):
    """An integral along a path; ``float`` gives its value.

    Units: those of an action in the system, energy times time.

    Attributes
    ----------
    value : float
    quadrature : float
        How far the sum may be from the integral along this path, round-off included.
    interpolation : float
        How much polynomials of two degrees less between the known times change the value: more than what the path
        itself is off, where its times are close enough to tell its shape. Of a run whose rows are not, how much the
        equations of motion change it that are followed between them, if that is more; not for variations that are
        given as numbers at the rows. 0 where straight lines were asked for.

    References
    ----------
    L. D. Landau & E. M. Lifshitz, *Mechanics*, 3rd ed., (2.1).

    Examples
    --------
    >>> import visviva as vv
    >>> free = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2, ["x"])
    >>> float(free.action(([0.0, 2.0], [0.0, 1.0])))
    0.25
    """

    value: float
    quadrature: float
    interpolation: float

    @property
    def error(self) -> float:
        """Both together, in the units of the value.

        Examples
        --------
        >>> import visviva as vv
        >>> free = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2, ["x"])
        >>> free.action(([0.0, 2.0], [0.0, 1.0])).error < 1e-14
        True
        """
        return self.quadrature + self.interpolation

    def __float__(self) -> float:
        return self.value


def derivatives(system: Lagrangian, order: int) -> tuple[list[Node], list[int]]:
    """Give L, its 2n first or its 4n² second derivatives by the numbers of a state, as nodes."""
    if order != 1:
        return system._model.expressions("curvatures" if order else "function")
    (nodes, roots), (further, others) = (system._model.expressions(name) for name in ("slopes", "conjugates"))
    first = len(nodes)
    moved = [(operation, [first + place for place in arguments], value) for operation, arguments, value in further]
    return [*nodes, *moved], [*roots, *(first + root for root in others)]


def derivatives_along(system: Lagrangian, order: int) -> Callable[..., NDArray[np.float64]]:
    """Give the function that has these derivatives at times (…) and places and velocities (…, n)."""
    nodes, roots = derivatives(system, order)

    def values(t: NDArray[np.float64], q: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
        states = np.concatenate([q, v], axis=-1).reshape(-1, 2 * q.shape[-1])
        found = system._model.evaluate(nodes, roots, np.ravel(t), states, system._values[None, :])
        if not np.isfinite(found).all():
            row = int(np.argmin(np.isfinite(found).all(axis=1)))
            raise InvalidInput("path", f"L has no value at t = {np.ravel(t)[row]:g} on it: a singularity; go round it")
        return found.reshape(*t.shape, len(roots))

    return values


def hessian(system: Lagrangian) -> Callable[..., NDArray[np.float64]]:
    """Give the function of (t, q, q̇) that has the second derivatives of L by (q, q̇), shape (…, 2n, 2n)."""
    values, n = derivatives_along(system, 2), len(system.coordinates)
    return lambda t, q, v: values(t, q, v).reshape(*t.shape, 2 * n, 2 * n)


def action(system: Lagrangian, path: Any, degree: int) -> PathIntegral:
    """Give ∫ L dt."""
    values = derivatives_along(system, 0)
    return _integral(as_path(system, path, degree), lambda t, q, v, *_: values(t, q, v)[..., 0], None)


def first_variation(system: Lagrangian, path: Any, variation: Any, degree: int) -> PathIntegral:
    """Give ∫ (∂L/∂q η + ∂L/∂q̇ η̇) dt."""
    values = derivatives_along(system, 1)

    def integrand(t: Any, q: Any, v: Any, eta: Any, rate: Any) -> Any:
        return (values(t, q, v) * np.concatenate([eta, rate], axis=-1)).sum(axis=-1)

    return _integral(*_varied(system, path, variation, degree, integrand))


def second_variation(system: Lagrangian, path: Any, variation: Any, degree: int) -> PathIntegral:
    """Give the integral of the second derivatives of L on (η, η̇)."""
    values = hessian(system)

    def integrand(t: Any, q: Any, v: Any, eta: Any, rate: Any) -> Any:
        both = np.concatenate([eta, rate], axis=-1)
        return np.einsum("...i,...ij,...j->...", both, values(t, q, v), both)

    return _integral(*_varied(system, path, variation, degree, integrand))


def _varied(
    system: Lagrangian, path: Any, variation: Any, degree: int, integrand: Integrand
) -> tuple[Path, Integrand, Any]:
    """Give what is integrated, its variation as a path or a function."""
    along_path, n = as_path(system, path, degree), len(system.coordinates)
    if callable(variation):

        def of(t: NDArray[np.float64]) -> NDArray[np.float64]:
            found = np.asarray(variation(t.ravel()))
            shape = (t.size,) if n == 1 and found.ndim == 1 else (t.size, n)
            return float_array("variation", found, shape).reshape(*t.shape, n)

        return along_path, integrand, of
    count = len(along_path.t)
    given = np.asarray(variation)
    shape = (count,) if n == 1 and given.ndim == 1 else (count, n)
    known = float_array("variation", variation, shape).reshape(count, n)
    return along_path, integrand, interpolated(along_path.t, known, along_path.coefficients.shape[1] - 1)


def _integral(path: Path, integrand: Integrand, variation: Any) -> PathIntegral:
    value, quadrature = _settled(path, integrand, variation)
    if path.coarser is None:
        return PathIntegral(value, quadrature, 0.0)
    of_pieces = isinstance(variation, Path)
    less = variation.coarser or variation if of_pieces else variation
    finer = None if of_pieces else path.finer
    changes = []
    try:
        changes.append(abs(value - _settled(path.coarser, integrand, less)[0]))
    except ConvergenceError:
        # Polynomials of a lower degree may come next to a singularity that the path itself does not.
        if finer is None:
            raise
    if finer is not None:
        ahead = 1.0 if path.t[0] < path.t[-1] else -1.0
        changes.append(abs(value - ahead * _settled(finer, integrand, variation)[0]))
    return PathIntegral(value, quadrature, max(changes))


def _settled(path: Path, integrand: Integrand, variation: Any) -> tuple[float, float]:
    """Give the integral, and by how much halves of the last pieces have changed it or round-off may have."""
    before, change, parts = np.nan, np.inf, 1
    for _ in range(_MOST_HALVINGS + 1):
        value, size = _sum(path, integrand, variation, parts)
        noise = 4.0 * _EPS * size
        last, change = change, abs(value - before) if parts > 1 else np.inf
        # Where halving no longer helps, what is left is the round-off of L itself.
        if change <= noise or (change <= 1e-9 * size and change > 0.25 * last):
            return value, max(change, noise)
        before, parts = value, 2 * parts
    if change <= 1e-6 * size:
        return value, change
    raise ConvergenceError(
        f"the integral along the path does not settle: finer pieces still change it by {change:.2g}; "
        "is the variation smooth between the times of the path?"
    )


def _sum(path: Path, integrand: Integrand, variation: Any, parts: int) -> tuple[float, float]:
    """Give the sum over all pieces in so many parts each, and that of sizes."""
    count = len(path.t) - 1
    pieces = np.repeat(np.arange(count), parts)
    part = np.tile(np.arange(parts), count)[:, None]
    u = (part + 0.5 * (_NODES + 1.0)) / parts
    lengths = np.diff(path.t)[pieces] / parts
    t = path.t[pieces][:, None] + u * np.diff(path.t)[pieces][:, None]
    q, v = path.at(pieces, u)
    if variation is None:
        rates = integrand(t, q, v)
    elif isinstance(variation, Path):
        rates = integrand(t, q, v, *variation.at(pieces, u))
    else:
        eta = variation(t)
        slope = np.einsum("ij,kjn->kin", _DERIVATIVE, eta) * (2.0 / lengths)[:, None, None]
        rates = integrand(t, q, v, eta, slope)
    shares = 0.5 * lengths[:, None] * _WEIGHTS * rates
    return float(shares.sum()), float(np.abs(shares).sum())
