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
        Times after the first and before the last that are conjugate to the first, as often as they are multiple.

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
    """Give the times before the last at which neighbors come back, all found by bisection of their steps at once."""
    found = linear.neighbors(0.0)
    steps = np.repeat(np.arange(len(found.returns)), found.returns)
    turn = np.concatenate([np.arange(1, count + 1) for count in found.returns[found.returns > 0]] or [np.empty(0)])
    pieces, first = found.pieces[steps], found.first[steps, None]
    low, high = np.zeros(len(steps)), np.full(len(steps), found.width)
    while ((low < (middle := 0.5 * (low + high))) & (middle < high)).any():
        second = linear.second(pieces, first + linear.nodes * middle[:, None])
        shorter = linear.flows(linear.matrices(second, 0.0), linear.lengths[pieces] * middle)
        back = found.returned(steps, shorter) >= turn
        low, high = np.where(back, low, middle), np.where(back, middle, high)
    times: _Array = linear.path.t[pieces] + np.diff(linear.path.t)[pieces] * (first[:, 0] + high)
    before: _Array = times[linear.path.t[-1] - times > _AT_THE_END * linear.time]
    return before


def _eigenvalue(linear: Linear) -> float:
    """Give the smallest λ for which a conjugate point is at the end."""
    unit = np.pi**2
    first = linear.neighbors(0.0)
    low, high = (None, first) if first.any else (first, None)
    below = above = 0.0
    for power in range(40):
        if low is None:
            below = -unit * 4.0**power
            trial = linear.neighbors(below)
            low, (high, above) = (None, (trial, below)) if trial.any else (trial, (high, above))
        elif high is None:
            above = unit * 4.0**power
            trial = linear.neighbors(above)
            (low, below), high = ((low, below), trial) if trial.any else ((trial, above), None)
    if low is None or high is None:
        raise ConvergenceError("the accessory problem has no smallest eigenvalue that is a number")
    for step in range(200):
        if above - below <= 1e-14 * max(abs(below), abs(above), unit):
            break
        share = low.ahead / (low.ahead - high.ahead) if step % 2 and high.few else 0.5
        middle = below + min(max(share, 0.01), 0.99) * (above - below)
        trial = linear.neighbors(middle)
        if trial.any:
            high, above = trial, middle
        else:
            low, below = trial, middle
    return float(0.5 * (below + above) / linear.time / linear.time)
