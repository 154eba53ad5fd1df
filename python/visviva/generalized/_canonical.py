"""Whether a transformation (q, p) → (Q, P) is canonical: Lagrange's brackets, as expressions and at random states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._calculus import VANISHES, Calculus, listed, random_states

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian

__all__ = ["CanonicalTest", "canonical_test"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False)
class CanonicalTest:
    """What became of MᵀJM − J, M being the derivatives of (Q, P) by (q, p); true where it vanishes.

    Attributes
    ----------
    holds : bool
        Whether the transformation is canonical.
    proved : bool
        Whether that follows from the expressions, whatever the parameters; else it was seen at random states.
    residual : float
        The largest entry of MᵀJM − J there, relative to what it is made of.
    matrix : ndarray, shape (2n, 2n)
        Each entry of MᵀJM − J where it is largest.

    Examples
    --------
    >>> import visviva as vv
    >>> H = vv.Hamiltonian(lambda q, p, t: (p[0] ** 2 + q[0] ** 2) / 2, ["x"])
    >>> H.is_canonical(lambda q, p, t: [2 * q[0], p[0]]).matrix
    array([[ 0.,  1.],
           [-1.,  0.]])
    """

    holds: bool
    proved: bool
    residual: float
    matrix: NDArray[np.float64]

    def __bool__(self) -> bool:
        return self.holds


def canonical_test(system: Hamiltonian, transformation: Any) -> CanonicalTest:
    """Test a transformation."""
    c, n = Calculus(system), len(system.coordinates)
    what = f"Q and P of {list(system.coordinates)}: {2 * n} expressions"
    rows = c.derived(c.of_user("transformation", listed("transformation", transformation, 2 * n, what)))
    states = random_states(system)
    pairs = [(a, b) for a in range(2 * n) for b in range(a + 1, 2 * n)]
    matrix, proved, worst = np.zeros((2 * n, 2 * n)), True, 0.0
    for a, b in pairs:
        parts = [rows[k][1 + a] * rows[n + k][1 + b] for k in range(n)]
        parts += [-(rows[n + k][1 + a] * rows[k][1 + b]) for k in range(n)]
        parts.append(c.constant(-1.0 if b == a + n else 0.0))
        if c.is_zero(c.derived([sum(parts, c.constant(0.0))])[0][0]):
            continue
        proved = False
        values = c.values(parts, *states, system._values)
        values = values[np.isfinite(values).all(axis=1)]
        if len(values) < len(states[0]) // 8:
            raise InvalidInput("transformation", "it has values at too few states near the start to test it there")
        sums, sizes = values.sum(axis=1), np.abs(values).sum(axis=1)
        worst = max(worst, float((np.abs(sums) / np.where(sizes > 0.0, sizes, 1.0)).max()))
        matrix[a, b] = sums[np.argmax(np.abs(sums))]
        matrix[b, a] = -matrix[a, b]
    matrix.flags.writeable = False
    return CanonicalTest(worst <= VANISHES, proved, worst, matrix)
