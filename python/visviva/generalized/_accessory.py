"""Jacobi's accessory problem: whether the action is least along a path, and where it ceases to be.

The one idea: as many conjugate points as lie on a path, so many independent variations make the action smaller (M.
Morse), and with ∂²L/∂q∂q − λ ∂²L/∂q̇∂q̇ in the place of ∂²L/∂q∂q, so many eigenvalues are below λ: counting how often
neighbors come back finds both, each by bisection.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._jacobi_fields import Linear
from visviva.generalized._path import as_path

if TYPE_CHECKING:
    from collections.abc import Callable

    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["AccessoryProblem", "accessory_problem"]

_Array: TypeAlias = NDArray[np.float64]

#: What is no farther from the last point than rounding is at it, in parts of the whole time.
_AT_THE_END = 4.0 * float(np.finfo(float).eps)


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AccessoryProblem(Record):
    """The second variation of the action among all variations that vanish at both ends of a path.

    Units: those of the system: times, and one over a time squared.

    Attributes
    ----------
    eigenvalue : float
        The smallest λ with −d/dt(P η̇ + Cᵀη) + C η̇ + R η = λ P η, where P, C and R are the second derivatives of L by
        velocities, by places and velocities, and by places: δ²S ≥ λ ∫ ηᵀP η dt. A time to the power −2.
    conjugate_points : ndarray, shape (K,)
        Times after the first and before the last that are conjugate to the first (of a run backward in time to the
        earliest), as often as they are multiple.

    References
    ----------
    I. M. Gelfand & S. V. Fomin, *Calculus of Variations* (1963), sections 26 to 29.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> swing = vv.systems.oscillator(k=1.0, m=1.0, position=[1.0]).run(t=np.linspace(0.0, 4.0, 81))
    >>> swing.system.accessory_problem(swing).conjugate_points.round(9)
    array([3.14159265])
    """

    eigenvalue: float
    conjugate_points: NDArray[np.float64]

    @property
    def index(self) -> int:
        """How many independent variations make the action smaller to second order.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> swing = vv.systems.oscillator(k=1.0, m=1.0, position=[1.0]).run(t=np.linspace(0.0, 4.0, 81))
        >>> swing.system.accessory_problem(swing).index
        1
        """
        return len(self.conjugate_points)

    @property
    def minimum(self) -> bool:
        """Whether the action is least among paths nearby between the same ends.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> swing = vv.systems.oscillator(k=1.0, m=1.0, position=[1.0]).run(t=np.linspace(0.0, 4.0, 81))
        >>> swing.system.accessory_problem(swing).minimum  # beyond half a period
        False
        """
        return self.eigenvalue > 0.0


def accessory_problem(system: Lagrangian, path: Any, degree: int) -> AccessoryProblem:
    """Give the smallest eigenvalue, and the conjugate points."""
    if system._constraints():
        raise InvalidInput("path", "variations are free here: eliminate the constraints, and ask again")
    linear = Linear(system, as_path(system, path, degree, ascending=True))
    return AccessoryProblem(_eigenvalue(linear), _conjugate_points(linear))


def _conjugate_points(linear: Linear) -> _Array:
    """Give the times before the last at which neighbors come back, all of them at once."""
    found = linear.neighbors(0.0)
    steps = np.repeat(np.arange(len(found.returns)), found.returns)
    turn = np.concatenate([np.arange(count) for count in found.returns[found.returns > 0]] or [np.empty(0, dtype=int)])
    pieces, first = found.pieces[steps], found.first[steps, None]

    def beyond(width: _Array) -> _Array:
        second = linear.second(pieces, first + linear.nodes * width[:, None])
        shorter = linear.flows(linear.matrices(second, 0.0), linear.lengths[pieces] * width)
        values, earlier = found.forms(steps, shorter)
        # Like the part of the step, by which a form of a short one is divided.
        beyond: _Array = -values[np.arange(len(steps)), turn + earlier] * width
        return beyond

    ends = np.full(len(steps), found.width)
    after = beyond(ends)
    widths = _passes(beyond, (np.zeros(len(steps)), ends), (-np.abs(after), after), found.width * _AT_THE_END)
    times: _Array = linear.path.t[pieces] + np.diff(linear.path.t)[pieces] * (first[:, 0] + widths)
    before: _Array = times[linear.path.t[-1] - times > _AT_THE_END * linear.time]
    return before


def _eigenvalue(linear: Linear) -> float:
    """Give the smallest λ for which a conjugate point is at the end."""
    unit = np.pi**2
    ahead = linear.neighbors(0.0).ahead
    sign = 1.0 if ahead <= 0.0 else -1.0
    near, ahead_near = 0.0, ahead
    for power in range(40):
        far = sign * unit * 4.0**power
        ahead_far = linear.neighbors(far).ahead
        if (ahead_far > 0.0) != (ahead > 0.0):
            break
        near, ahead_near = far, ahead_far
    else:
        raise ConvergenceError("the accessory problem has no smallest eigenvalue that is a number")
    ends, values = ((near, far), (ahead_near, ahead_far)) if sign > 0.0 else ((far, near), (ahead_far, ahead_near))
    (found,) = _passes(
        lambda trials: np.array([linear.neighbors(trial).ahead for trial in trials]),
        (np.array(ends[:1]), np.array(ends[1:])),
        (np.array(values[:1]), np.array(values[1:])),
        1e-15 * max(abs(far), unit),
    )
    return float(found / linear.time / linear.time)


def _passes(
    function: Callable[[_Array], _Array], ends: tuple[_Array, _Array], values: tuple[_Array, _Array], within: float
) -> _Array:
    """Give where functions that rise pass 0 between two ends each, to a width.

    In no more steps than bisection and one (I. F. D. Oliveira & R. H. C. Takahashi, ACM TOMS 47 (2020) 5).
    """
    (low, high), (below, above) = ends, values
    if not len(low):
        return low
    first = high - low
    most = int(np.ceil(np.log2(first.max() / within))) + 1
    for step in range(most):
        middle, width = 0.5 * (low + high), high - low
        if not ((low < middle) & (middle < high) & (width > within)).any():
            break
        straight = (above * low - below * high) / np.where(above > below, above - below, 1.0)
        side = np.sign(middle - straight)
        toward = np.minimum(0.2 * width**2 / first, np.abs(middle - straight))
        room = np.fmax(0.0, 0.5 * within * 2.0 ** (most - step) - 0.5 * width)
        offset = np.abs(middle - straight) - toward
        trial = middle - side * np.minimum(offset, room)
        trial = np.where((low < trial) & (trial < high), trial, middle)
        value = function(trial)
        over = value > 0.0
        low, below = np.where(over, low, trial), np.where(over, below, value)
        high, above = np.where(over, trial, high), np.where(over, value, above)
    return np.where(-below < above, low, high)
