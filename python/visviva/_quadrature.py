"""∫ F·dr along a path, to a tolerance: Gauss and Legendre in ever more pieces."""

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
_SHIFTS = (0.381966, 0.723607)


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
        forces = float_array("force", at(places), places.shape)
        # dr over half a piece, the unit of the nodes.
        steps = np.einsum("ij,pjc->pic", _DERIVATIVE, places.reshape(panels, -1, 3))
        rate = (forces.reshape(steps.shape) * steps).sum(axis=2)
        sizes = np.linalg.norm(forces.reshape(steps.shape), axis=2) * np.linalg.norm(steps, axis=2)
        total, size = float((rate @ _WEIGHTS).sum()), float((sizes @ _WEIGHTS).sum())
        if abs(total - before) <= rtol * size:
            return total
        before, panels = total, 2 * panels
    raise ConvergenceError(f"the work does not settle to {rtol:g} of it: the field jumps or is singular on the path")
