"""Neighbors of a motion that leave its first point with it (Jacobi fields), and how often they come back to it.

The one idea: neighbors obey a linear equation. Their places A and momenta B at the beginning of a step that is too
short for one to return within it, (A, B) → (aA + bB, …), make a symmetric matrix Aᵀb⁻¹(aA + bB), which has as many
negative eigenvalues as conjugate points lie in the step (M. Morse's broken extremals): whatever the units, and however
different the masses.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from visviva.errors import ConvergenceError, InvalidInput
from visviva.generalized._action import hessian

if TYPE_CHECKING:
    from collections.abc import Callable

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._path import Path

__all__ = ["Linear", "Neighbors"]

_Array: TypeAlias = NDArray[np.float64]

#: Gauss's collocation of order 12.
_STAGES = 6
#: The length of a step times the fastest rate of the linear equation: what order 12 leaves is then below round-off.
_RATE = 0.25
_MOST_STEPS = 100_000
#: Steps of what depends on the time by itself, at least: what the path's own times need not tell.
_FEWEST_IN_TIME = 64
#: The last coefficients of what is in a step are no larger beside ∂²L/∂q̇∂q̇: what order 12 leaves is then round-off.
_RESOLVED = 1e-7
#: The sine of the angle between what comes back to the first point and what would, below which a step goes on from the
#: one before: rounding decides there which of two steps a conjugate point is in, and both may count it, or neither.
_NEAR = 1e-6
#: How many steps are joined for that at most: a neighbor needs π/0.25 of them to return.
_MOST_JOINED = 8


class Linear:
    """The accessory equation along a path, in places η and momenta P η̇ + Cᵀη, by collocation.

    In units in which the path takes the time one, and ∂²L/∂q̇∂q̇ has diagonal elements about one halfway; without the
    mean of ηᵀSη̇ with a symmetric S, the rate of ηᵀSη/2: it changes no motion, and would cost digits.
    """

    def __init__(self, system: Lagrangian, path: Path) -> None:
        self.path, self.n = path, len(system.coordinates)
        self.time = float(path.t[-1] - path.t[0])
        self.lengths = np.diff(path.t) / self.time
        self._hessian, self._units, self._rate = hessian(system), np.ones(self.n), np.zeros((2 * self.n, 2 * self.n))
        self.nodes, self._weights = _collocation()
        self._last = _last_coefficients(self.nodes)
        self._known: dict[int, _Coefficients] = {}
        halfway = self.second(np.arange(len(self.lengths)), np.full((len(self.lengths), 1), 0.5))[:, 0]
        mixed, kinetic = halfway[:, : self.n, self.n :], halfway[:, self.n :, self.n :]
        diagonal = np.diagonal(kinetic, axis1=-2, axis2=-1)
        with np.errstate(divide="ignore", invalid="ignore"):
            sizes = np.sqrt(diagonal)
            compared = kinetic / sizes[:, :, None] / sizes[:, None, :]
        if not (np.isfinite(compared).all() and np.linalg.eigvalsh(compared).min() > 1e-14):
            raise _without_minimum()
        # Powers of two: no digit of the coefficients changes.
        self._units = np.exp2(np.rint(np.log2(sizes).mean(axis=0)))
        mixed = mixed.mean(axis=0) / self._units[:, None] / self._units
        self._rate[: self.n, self.n :] = 0.5 * (mixed + mixed.T)
        self._rate[self.n :, : self.n] = self._rate[: self.n, self.n :].T
        self._fewest = 1 if system.autonomous else _FEWEST_IN_TIME

    def second(self, pieces: NDArray[np.intp], u: _Array) -> _Array:
        """Give the second derivatives of L by (η, η̇), in the units of this class."""
        q, v = self.path.at(pieces, u)
        t = self.path.t[pieces][:, None] + u * np.diff(self.path.t)[pieces][:, None]
        units = np.concatenate([self.time / self._units, 1.0 / self._units])
        scaled: _Array = self._hessian(t, q, v) * units[:, None] * units - self._rate
        return scaled

    def matrices(self, second: _Array, shift: float) -> _Array:
        """Give the matrices of the linear equation of (η, π)."""
        n = self.n
        kinetic, mixed = second[..., n:, n:], second[..., :n, n:]
        inverse = np.linalg.inv(kinetic)
        back = mixed @ inverse
        top = np.concatenate([-np.swapaxes(back, -1, -2), inverse], axis=-1)
        rest = second[..., :n, :n] - shift * kinetic - back @ np.swapaxes(mixed, -1, -2)
        return np.concatenate([top, np.concatenate([rest, back], axis=-1)], axis=-2)

    def flows(self, matrices: _Array, lengths: _Array) -> _Array:
        """Give what (η, π) at the beginnings of steps become at their ends: (K, 2n, 2n)."""
        stages, size = _STAGES, 2 * self.n
        # K_i = A_i (1 + h Σ a_ij K_j), for all columns of a fundamental matrix at once.
        inner = self._weights(self.nodes)
        coupled = np.einsum("kiab,ij,k->kiajb", matrices, inner, lengths)
        system = np.eye(stages * size) - coupled.reshape(-1, stages * size, stages * size)
        slopes = np.linalg.solve(system, matrices.reshape(-1, stages * size, size)).reshape(-1, stages, size, size)
        moved = np.einsum("j,kjab,k->kab", self._weights(np.ones(1))[0], slopes, lengths)
        result: _Array = np.eye(size) + moved
        return result

    def _parts(self, shift: float) -> int:
        """Give how many steps a piece is cut in."""
        parts = max(1, -(-self._fewest // len(self.lengths)))
        while parts * len(self.lengths) <= _MOST_STEPS:
            # A power of two, so that steps for other shifts are often the same.
            whole = 1 << (parts - 1).bit_length()
            if whole not in self._known:
                self._known[whole] = self._coefficients(whole)
            known = self._known[whole]
            # The shift is one of squares of frequencies.
            turned = float((known.lengths * np.sqrt(np.abs(known.squares + shift).max(axis=0))).max()) / _RATE
            if known.resolved and turned <= 1.0:
                return whole
            parts = max(2 * whole, int(min(turned, 2.0 * _MOST_STEPS) * whole))
        raise ConvergenceError("the path is too long for its fastest motion: cut it")

    def _coefficients(self, parts: int) -> _Coefficients:
        pieces = np.repeat(np.arange(len(self.lengths)), parts)
        first = np.tile(np.arange(parts), len(self.lengths))[:, None] / parts
        second, lengths = self.second(pieces, first + self.nodes / parts), self.lengths[pieces] / parts
        # Of the polynomial through what is at the nodes, the last two coefficients, as parts of ∂²L/∂q̇∂q̇.
        tails = np.abs(np.einsum("di,kiab->kdab", self._last, second)).sum(axis=1)
        sizes = np.sqrt(np.abs(np.diagonal(second, axis1=-2, axis2=-1)[..., self.n :]).max(axis=1))
        sizes = np.concatenate([sizes / lengths[:, None], sizes], axis=-1)
        resolved = bool((tails <= _RESOLVED * sizes[:, :, None] * sizes[:, None, :]).all())
        frequencies = -(np.linalg.eigvals(self.matrices(second, 0.0)) ** 2).real
        squares: _Array = np.stack([frequencies.min(axis=(1, 2)), frequencies.max(axis=(1, 2))])
        return _Coefficients(pieces, first, second, lengths, squares, resolved)

    def neighbors(self, shift: float) -> Neighbors:
        """Give the neighbors from the first point on, and how often they come back."""
        known = self._known[parts := self._parts(shift)]
        local = known.local = self._local(known) if known.local is None else known.local
        flows = self.flows(self.matrices(known.second, shift), known.lengths)
        n = self.n
        frames = np.empty((len(flows) + 1, 2 * n, n))
        frames[0] = np.concatenate([np.zeros((n, n)), np.eye(n)])
        for step in range(len(flows)):
            # Other columns that span the same neighbors, orthonormal in units of the step: none of them is lost.
            frame = frames[step] @ np.linalg.inv(np.linalg.qr(local[step] @ frames[step], mode="r"))
            frames[step] = frame
            frames[step + 1] = flows[step] @ frame
        smallest = np.linalg.svd((local @ frames[:-1])[:, :n], compute_uv=False).min(axis=-1)
        starts, returns = _starts(smallest < _NEAR), (_forms(frames[:-1], flows) < 0.0).sum(axis=-1)
        found = Neighbors(known.pieces, known.first[:, 0], 1.0 / parts, frames, flows, starts, returns)
        for step in np.flatnonzero(starts < np.arange(len(flows))).tolist():
            values, earlier = found.forms(np.array([step]), flows[[step]])
            returns[step] = max(0, int((values < 0.0).sum()) - int(earlier[0]))
        return found

    def _local(self, known: _Coefficients) -> _Array:
        """Give the units of steps: √P η/√h and √h P⁻¹ᐟ² π, which a free motion mixes evenly."""
        n = self.n
        try:
            roots = np.linalg.cholesky(self.second(known.pieces, known.first)[:, 0, n:, n:])
        except np.linalg.LinAlgError:
            raise _without_minimum() from None
        roots = np.swapaxes(roots, -1, -2)
        h = np.sqrt(known.lengths)[:, None, None]
        none = np.zeros_like(roots)
        momenta = h * np.swapaxes(np.linalg.inv(roots), -1, -2)
        return np.concatenate(
            [np.concatenate([roots / h, none], axis=-1), np.concatenate([none, momenta], axis=-1)], axis=-2
        )


@dataclass(slots=True)
class _Coefficients:
    """Steps, a number of them to each piece, and the second derivatives of L at their nodes."""

    pieces: NDArray[np.intp]
    first: _Array
    second: _Array
    lengths: _Array
    #: Of the frequencies of the linear equation at the nodes, the least and the largest, shape (2, K).
    squares: _Array
    #: Whether a polynomial through the nodes tells what is between them.
    resolved: bool
    #: Units of the steps, once they were asked for.
    local: _Array | None = None


@dataclass(frozen=True, slots=True)
class Neighbors:
    """Steps, the neighbors at their ends, and how often they come back in each."""

    pieces: NDArray[np.intp]
    first: _Array
    width: float
    #: One more than the steps, shape (K + 1, 2n, n).
    frames: _Array
    flows: _Array
    #: The steps that the returns of each are counted from.
    starts: NDArray[np.intp]
    returns: NDArray[np.int64]

    def forms(self, steps: NDArray[np.intp], shorter: _Array) -> tuple[_Array, NDArray[np.int64]]:
        """Give the values (K, n) of which those below 0 count returns in parts of steps, and those before the steps."""
        starts, flows = self.starts[steps], shorter.copy()
        earlier = np.zeros(len(steps), dtype=np.int64)
        for back in range(1, _MOST_JOINED + 1):
            joined = np.flatnonzero(steps - back >= starts)
            flows[joined] = flows[joined] @ self.flows[steps[joined] - back]
            earlier[joined] += self.returns[steps[joined] - back]
        return _forms(self.frames[starts], flows), earlier

    @property
    def any(self) -> bool:
        return bool(self.returns.any())

    @property
    def ahead(self) -> float:
        """How far the neighbors are past the end's point, or what they lack, as an angle that grows evenly."""
        a, b = np.split(self.frames[-1], 2)
        turned = np.linalg.solve((b - 1j * np.pi * a).T, (b + 1j * np.pi * a).T)
        angles = np.angle(np.linalg.eigvals(turned)) % (2.0 * np.pi)
        turns = 2.0 * np.pi * (int(self.returns.sum()) - 1)
        return float(angles.min()) + turns if self.any else float(angles.max()) + turns


def _without_minimum() -> InvalidInput:
    expected = "expected ∂²L/∂q̇∂q̇ to be positive along it (Legendre's condition): the action has no minimum"
    return InvalidInput("path", expected)


def _forms(frames: _Array, flows: _Array) -> _Array:
    """Give the eigenvalues of Aᵀb⁻¹(aA + bB), ascending."""
    n = frames.shape[-1]
    places, momenta = frames[..., :n, :], frames[..., n:, :]
    a, b = flows[..., :n, :n], flows[..., :n, n:]
    form = np.swapaxes(places, -1, -2) @ (np.linalg.solve(b, a @ places) + momenta)
    return np.asarray(np.linalg.eigvalsh(form + np.swapaxes(form, -1, -2)), dtype=float)


def _starts(near: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Give, for each step, the last at or before it at whose beginning no neighbor is about to come back."""
    starts = np.arange(len(near))
    # At the first point all neighbors are together, to the bit.
    for step in (np.flatnonzero(near[1:]) + 1).tolist():
        if step - starts[step - 1] < _MOST_JOINED:
            starts[step] = starts[step - 1]
    return starts


def _last_coefficients(nodes: _Array) -> _Array:
    """Give the weights (2, nodes) of the last two Legendre coefficients of what is at the nodes."""
    return np.asarray(np.linalg.inv(np.polynomial.legendre.legvander(2.0 * nodes - 1.0, _STAGES - 1))[-2:], dtype=float)


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
