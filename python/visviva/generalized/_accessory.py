"""Jacobi's accessory problem: whether the action is least along a path, and where it ceases to be.

The one idea: neighbors of a motion that leave its first point obey a linear equation, and come back to it at conjugate
points. Their places A and momenta B make a unitary matrix W = (B + iA)(B − iA)⁻¹, whose eigenvalues pass 1 there, and
only forwards: counting turns of W counts conjugate points, and so the directions in which the action is largest
(M. Morse). With ∂²L/∂q∂q − λ ∂²L/∂q̇∂q̇ in the place of ∂²L/∂q∂q it counts the eigenvalues below λ.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._action import hessian
from visviva.generalized._path import Path, as_path

if TYPE_CHECKING:
    from collections.abc import Callable

    from visviva.generalized._lagrangian import Lagrangian

__all__ = ["AccessoryProblem", "accessory_problem"]

_Array: TypeAlias = NDArray[np.float64]

#: Gauss's collocation of order 12.
_STAGES = 6
#: The length of a step times the fastest rate of the linear equation: what order 12 leaves is then below round-off.
_RATE = 0.25
_MOST_STEPS = 100_000
#: Where in each step turns are counted.
_READ = np.array([0.25, 0.5, 0.75, 1.0])


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


class _Linear:
    """The accessory equation along a path, in places η and momenta P η̇ + Cᵀη, by collocation."""

    def __init__(self, system: Lagrangian, path: Path) -> None:
        self.path, self.n = path, len(system.coordinates)
        self._second = hessian(system)
        self._nodes, self._weights = _collocation()
        self._known: dict[int, _Array] = {}
        middles = self._at(np.arange(len(path.t) - 1), np.full((len(path.t) - 1, 1), 0.5))
        kinetic = np.linalg.eigvalsh(middles[:, 0, self.n :, self.n :])
        if kinetic.min() <= 1e-14 * np.abs(kinetic).max():
            raise InvalidInput(
                "path", "expected ∂²L/∂q̇∂q̇ to be positive along it (Legendre's condition): the action has no minimum"
            )
        # A and B in numbers of the same size, so that W turns evenly.
        self.scale = float(np.abs(kinetic).max()) / (path.t[-1] - path.t[0])

    def _at(self, pieces: NDArray[np.intp], u: _Array) -> _Array:
        q, v = self.path.at(pieces, u)
        t = self.path.t[pieces][:, None] + u * np.diff(self.path.t)[pieces][:, None]
        return self._second(t, q, v)

    def _matrices(self, second: _Array, shift: float) -> _Array:
        """Give the matrices of the linear equation of (η, π)."""
        n = self.n
        kinetic, mixed = second[..., n:, n:], second[..., :n, n:]
        inverse = np.linalg.inv(kinetic)
        back = mixed @ inverse
        top = np.concatenate([-np.swapaxes(back, -1, -2), inverse], axis=-1)
        rest = second[..., :n, :n] - shift * kinetic - back @ np.swapaxes(mixed, -1, -2)
        return np.concatenate([top, np.concatenate([rest, back], axis=-1)], axis=-2)

    def _flows(self, matrices: _Array, lengths: _Array, read: _Array) -> _Array:
        """Give what (η, π) at the beginnings of steps become, at fractions of them: (K, len(read), 2n, 2n)."""
        stages, size = _STAGES, 2 * self.n
        # K_i = A_i (1 + h Σ a_ij K_j), for all columns of a fundamental matrix at once.
        inner = self._weights(self._nodes)
        coupled = np.einsum("kiab,ij,k->kiajb", matrices, inner, lengths)
        system = np.eye(stages * size) - coupled.reshape(-1, stages * size, stages * size)
        slopes = np.linalg.solve(system, matrices.reshape(-1, stages * size, size)).reshape(-1, stages, size, size)
        moved = np.einsum("rj,kjab,k->krab", self._weights(read), slopes, lengths)
        result: _Array = np.eye(size) + moved
        return result

    def _parts(self, shift: float) -> int:
        """Give how many steps a piece is cut in."""
        second = self._at(np.arange(len(self.path.t) - 1), np.full((len(self.path.t) - 1, 1), 0.5))
        rates = np.abs(np.linalg.eigvals(self._matrices(second, shift))).max(axis=(1, 2))
        parts = int(np.ceil((rates * np.diff(self.path.t)).max() / _RATE))
        if parts * len(rates) > _MOST_STEPS:
            raise ConvergenceError("the path is too long for its fastest motion: cut it")
        # A power of two, so that steps for other shifts are often the same.
        return 1 << max(0, parts - 1).bit_length()

    def turns(self, shift: float) -> _Turns:
        """Give the turns of W on the way from the first point."""
        parts, count = self._parts(shift), len(self.path.t) - 1
        pieces = np.repeat(np.arange(count), parts)
        first = np.tile(np.arange(parts), count)[:, None] / parts
        if parts not in self._known:
            self._known[parts] = self._at(pieces, first + self._nodes / parts)
        lengths = np.diff(self.path.t)[pieces] / parts
        flows = self._flows(self._matrices(self._known[parts], shift), lengths, _READ)
        frames = np.empty((len(flows), 2 * self.n, self.n))
        frame = np.concatenate([np.zeros((self.n, self.n)), np.eye(self.n)])
        for step in range(len(flows)):
            # Other columns that span the same neighbors: W is that of the span.
            frames[step] = frame
            frame = np.linalg.qr(flows[step, -1] @ frame)[0]
        angles = self._angles(flows @ frames[:, None]).reshape(-1, self.n)
        whole = _whole_turns(angles, np.zeros(1))
        return _Turns(pieces, first[:, 0], 1.0 / parts, frames, angles, whole)

    def conjugate_points(self) -> _Array:
        """Give the times at which W's eigenvalues pass 1, each found by bisection of shorter steps to it."""
        found, times = self.turns(0.0), []
        whole = found.whole[:: len(_READ)], found.whole[len(_READ) - 1 :: len(_READ)]
        ends = np.concatenate([[0], np.maximum.accumulate(whole[1])])
        starts = np.concatenate([np.zeros((1, self.n)), found.angles[len(_READ) - 1 : -1 : len(_READ)]])
        for step in np.flatnonzero(np.diff(ends) > 0):
            piece, u = found.pieces[step], found.first[step]
            for turn in range(ends[step] + 1, ends[step + 1] + 1):
                low, high = 0.0, found.width
                while low < (middle := 0.5 * (low + high)) < high:
                    shorter = self._shorter(piece, u, middle, found.frames[step])
                    reached = ends[step] + _whole_turns(shorter, starts[step])[-1]
                    low, high = (low, middle) if reached >= turn else (middle, high)
                times.append(self.path.t[piece] + np.diff(self.path.t)[piece] * (u + high))
        return np.array(times, dtype=float)

    def _shorter(self, piece: int, u: float, width: float, frame: _Array) -> _Array:
        """Give the angles where they are read in a step of another width, from a frame on."""
        second = self._at(np.array([piece]), (u + self._nodes * width)[None])
        length = np.diff(self.path.t)[[piece]] * width
        return self._angles(self._flows(self._matrices(second, 0.0), length, _READ)[0] @ frame)

    def eigenvalue(self) -> float:
        """Give the smallest λ for which a conjugate point is at the end."""
        unit = (np.pi / (self.path.t[-1] - self.path.t[0])) ** 2
        first = self.turns(0.0)
        low, high = (None, first) if first.any else (first, None)
        below = above = 0.0
        for power in range(40):
            if low is None:
                below = -unit * 4.0**power
                trial = self.turns(below)
                low, (high, above) = (None, (trial, below)) if trial.any else (trial, (high, above))
            elif high is None:
                above = unit * 4.0**power
                trial = self.turns(above)
                (low, below), high = ((low, below), trial) if trial.any else ((trial, above), None)
        if low is None or high is None:
            raise ConvergenceError("the accessory problem has no smallest eigenvalue that is a number")
        for step in range(200):
            if above - below <= 1e-14 * max(abs(below), abs(above), unit):
                break
            share = low.ahead / (low.ahead - high.ahead) if step % 2 and high.few else 0.5
            middle = below + min(max(share, 0.01), 0.99) * (above - below)
            trial = self.turns(middle)
            if trial.any:
                high, above = trial, middle
            else:
                low, below = trial, middle
        return float(0.5 * (below + above))

    def _angles(self, frames: _Array) -> _Array:
        """Give the angles of W's eigenvalues in [0, 2π)."""
        a, b = self.scale * frames[..., : self.n, :], frames[..., self.n :, :]
        turned = np.linalg.solve(np.swapaxes(b - 1j * a, -1, -2), np.swapaxes(b + 1j * a, -1, -2))
        angles = np.angle(np.linalg.eigvals(turned)) % (2.0 * np.pi)
        return np.where(angles >= 2.0 * np.pi, 0.0, angles)


@dataclass(frozen=True, slots=True)
class _Turns:
    """Steps, the frames before them, angles where they are read, and whole turns until there."""

    pieces: NDArray[np.intp]
    first: _Array
    width: float
    frames: _Array
    angles: _Array
    whole: NDArray[np.int64]

    @property
    def any(self) -> bool:
        return bool(self.whole.max() > 0)

    @property
    def few(self) -> bool:
        return bool(self.whole[-1] <= 1)

    @property
    def ahead(self) -> float:
        """How far the last turn is begun, or what the first lacks."""
        return float(self.angles[-1].min()) if self.any else float(self.angles[-1].max()) - 2.0 * np.pi


def _whole_turns(angles: _Array, before: _Array) -> NDArray[np.int64]:
    """Give the turns of eigenvalues since they were `before`, from their angles at moments close to each other."""
    sums = np.concatenate([[before.sum()], angles.sum(axis=-1)])
    steps = (np.diff(sums) + np.pi) % (2.0 * np.pi) - np.pi
    whole: NDArray[np.int64] = np.rint((sums[0] + np.cumsum(steps) - sums[1:]) / (2.0 * np.pi)).astype(np.int64)
    return whole


def _collocation() -> tuple[_Array, Callable[[_Array], _Array]]:
    """Give Gauss's nodes in (0, 1), and the weights at them of integrals from 0 to some places."""
    nodes, gauss = np.polynomial.legendre.leggauss(_STAGES)
    degrees = np.arange(_STAGES)
    # Legendre's polynomials are orthogonal over the nodes: monomials would cost two digits.
    values = np.polynomial.legendre.legvander(nodes, _STAGES - 1).T
    coefficients = 0.5 * (2 * degrees[:, None] + 1) * gauss * values

    def weights(places: _Array) -> _Array:
        x = 2.0 * places - 1.0
        p = np.polynomial.legendre.legvander(x, _STAGES)
        integrals = np.column_stack([x + 1.0, (p[:, 2:] - p[:, :-2]) / (2 * degrees[1:] + 1)])
        found: _Array = 0.5 * integrals @ coefficients
        return found

    return 0.5 * (nodes + 1.0), weights


def accessory_problem(system: Lagrangian, path: Any, degree: int) -> AccessoryProblem:
    """Give the smallest eigenvalue, and the conjugate points."""
    if system._constraints():
        raise InvalidInput("path", "variations are free here: eliminate the constraints, and ask again")
    linear = _Linear(system, as_path(system, path, degree, ascending=True))
    points = linear.conjugate_points()
    return AccessoryProblem(linear.eigenvalue(), points[points < linear.path.t[-1]])
