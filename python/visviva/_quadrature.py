"""∫ F·dr along a path and ∫ F dt, to a tolerance: Gauss and Legendre in ever more pieces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva._arrays import float_array
from visviva.errors import ConvergenceError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    _Field = Callable[[NDArray[np.float64]], ArrayLike]

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_MOST_PANELS = 2**14
# Pieces of a path on which nothing is felt.
_LOOKED_AT = 256
_SHIFTS = (0.381966, 0.723607)
# A blow is short beside the time between blows: so many pieces of a span are looked at; those that do not settle are
# halved so often at most. What jumps never does.
_PIECES = 512
_HALVINGS = 9


def _differentiation(nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives at the nodes of the polynomial through values there: Berrut & Trefethen, SIAM Rev. 46 (2004) 501."""
    apart = nodes[:, None] - nodes
    np.fill_diagonal(apart, 1.0)
    weights = 1.0 / apart.prod(axis=1)
    matrix: NDArray[np.float64] = weights / weights[:, None] / apart
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return matrix


_DERIVATIVE = _differentiation(_NODES)


def line_integral(at: _Field, path: Callable[[NDArray[np.float64]], ArrayLike], rtol: float) -> float:
    before, panels = np.inf, 4
    while panels <= _MOST_PANELS:
        # Pieces that share no ends and no middles from one time to the next, where a jump may hide from both.
        shift = _SHIFTS[panels.bit_length() % 2]
        edges = np.concatenate([[0.0], (np.arange(panels - 1) + shift) / (panels - 1), [1.0]])
        s = edges[:-1, None] + np.diff(edges)[:, None] * (0.5 * (_NODES + 1.0))
        places = float_array("path", path(s.ravel()), (s.size, 3))
        if panels >= _LOOKED_AT and not np.ptp(places, axis=0).any():
            return 0.0  # what stays where it is does no work
        forces = float_array("force", at(places), places.shape)
        # dr over half a piece, the unit of the nodes.
        steps = np.einsum("ij,pjc->pic", _DERIVATIVE, places.reshape(panels, -1, 3))
        rate = (forces.reshape(steps.shape) * steps).sum(axis=2)
        sizes = np.linalg.norm(forces.reshape(steps.shape), axis=2) * np.linalg.norm(steps, axis=2)
        total, size = float((rate @ _WEIGHTS).sum()), float((sizes @ _WEIGHTS).sum())
        # Where nothing at all was felt, something may be in between.
        if abs(total - before) <= rtol * size and (size > 0.0 or panels >= _LOOKED_AT):
            return total
        before, panels = total, 2 * panels
    raise ConvergenceError(
        f"the work does not settle to {rtol:g} of it: the field jumps or is singular on the path, or "
        "bends sharply there; give it corners there"
    )


def time_integral(at: _Field, start: float, end: float, rtol: float) -> NDArray[np.float64]:
    """∫ F dt of a function of times (K,) that gives forces (K, 3)."""

    def pieces(left: NDArray[np.float64], width: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
        """The integral over each piece, given in shares of the span, and that of the size of the force."""
        shares = left[:, None] + width[:, None] * (0.5 * (_NODES + 1.0))
        forces = float_array("force", at(start + shares.ravel() * (end - start)), (shares.size, 3))
        forces = forces.reshape(*shares.shape, 3)
        sizes = np.linalg.norm(forces, axis=2) @ _WEIGHTS
        return 0.5 * width[:, None] * np.einsum("pic,i->pc", forces, _WEIGHTS), 0.5 * width * sizes

    # Edges at which nothing round is, where a jump would hide.
    edges = np.concatenate([[0.0], (np.arange(_PIECES - 1) + _SHIFTS[0]) / (_PIECES - 1), [1.0]])
    left, width = edges[:-1], np.diff(edges)
    whole, _ = pieces(left, width)
    total, size = np.zeros(3), 0.0
    for _ in range(_HALVINGS):
        halves = 0.5 * width
        lefts, widths = np.concatenate([left, left + halves]), np.concatenate([halves, halves])
        values, sizes = pieces(lefts, widths)
        finer = values[: len(left)] + values[len(left) :]
        open_ones = np.abs(finer - whole).max(axis=1) > 0.1 * rtol * (size + sizes.sum())
        total += finer[~open_ones].sum(axis=0)
        if not open_ones.any():
            return (end - start) * total
        both = np.concatenate([open_ones, open_ones])
        size += float(sizes[~both].sum())
        left, width, whole = lefts[both], widths[both], values[both]
    raise ConvergenceError(f"the impulse does not settle to {rtol:g} of it: the force jumps or is infinite in between")
