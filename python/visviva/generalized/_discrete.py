"""The discrete action Σ L_d(qₖ, qₖ₊₁) of a path in segments, and how far it is from stationary: `DiscreteAction`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array
from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._methods import DISCRETE, discrete_name
from visviva.generalized._trajectory import GeneralizedTrajectory

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["DiscreteAction", "discrete_action"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class DiscreteAction(Record):
    """The action of a discrete path, and its derivatives; ``float`` gives its value.

    Made by `Lagrangian.discrete_action`.

    Units: those of the system: an action, momenta and times.

    Attributes
    ----------
    method : str
        The variational integrator whose segments these are.
    t : ndarray, shape (T,)
        Times of the places.
    value : float
        Σ L_d(qₖ, qₖ₊₁).
    momentum_before, momentum_after : ndarray, shape (T − 1, n)
        The momenta that a segment has at its first and its last place, −∂L_d/∂qₖ − f⁻ and ∂L_d/∂qₖ₊₁ + f⁺ (the discrete
        Legendre transforms; f are the impulses of further forces).
    residual : ndarray, shape (T − 2, n)
        What the discrete Euler–Lagrange equations leave at the inner places: the momentum of the segment before less
        that of the segment after. Without further forces it is the derivative of the action with respect to the place.
    relative_residual : ndarray, shape (T − 2, n)
        Its size relative to what it is made of: a few units of round-off along a run of this method.

    References
    ----------
    J. E. Marsden & M. West, Acta Numerica 10 (2001) 357, section 1.3.

    Examples
    --------
    >>> import visviva as vv
    >>> free = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2, ["x"])
    >>> free.discrete_action(([0.0, 1.0, 2.0], [0.0, 1.0, 3.0])).residual
    array([[-1.]])
    """

    method: str
    t: NDArray[np.float64]
    value: float
    momentum_before: NDArray[np.float64]
    momentum_after: NDArray[np.float64]
    residual: NDArray[np.float64]
    relative_residual: NDArray[np.float64]

    def __float__(self) -> float:
        return self.value


def discrete_action(system: Lagrangian, path: Any, method: object) -> DiscreteAction:
    """Give the action of the segments through a path's places."""
    n, values = len(system.coordinates), system._values
    if system._constraints():
        raise InvalidInput("path", "a discrete action is that of a Lagrangian without constraints")
    if isinstance(path, GeneralizedTrajectory):
        run = path.system
        if run._source.kind != "lagrangian" or run.coordinates != system.coordinates:
            raise InvalidInput("path", f"expected a run of a Lagrangian of {list(system.coordinates)}, got {path}")
        if method is None and path.method not in DISCRETE:
            raise InvalidInput(
                "method", f"expected one of {', '.join(DISCRETE)}, as the path is a run of {path.method}; pass method"
            )
        t, places, values = path.t, path.position, run._values
        method = path.method if method is None else method
    elif isinstance(path, (tuple, list)) and len(path) == 2:
        t = float_array("path[0]", path[0], (None,))
        given = np.asarray(path[1])
        shape = (len(t),) if n == 1 and given.ndim == 1 else (len(t), n)
        places = float_array("path[1]", path[1], shape).reshape(len(t), n)
        method = DISCRETE[0] if method is None else method
    else:
        raise InvalidInput(
            "path", f"expected a trajectory of a Lagrangian, or times and places as (t, q), got {type(path).__name__}"
        )
    name = discrete_name(method)
    steps = np.diff(t)
    if len(t) < 2 or not ((steps > 0.0).all() or (steps < 0.0).all()):
        raise InvalidInput("path", "expected two times or more, all in order, each once")
    actions, (before, after, sizes) = system._model.segments(
        name, np.ascontiguousarray(t), np.ascontiguousarray(places), values
    )
    residual = after[:-1] - before[1:]
    made_of = sizes[:-1] + sizes[1:]
    relative = np.divide(np.abs(residual), made_of, out=np.zeros_like(residual), where=made_of > 0.0)
    for array in (before, after, residual, relative):
        array.flags.writeable = False
    return DiscreteAction(name, t, float(actions.sum()), before, after, residual, relative)
