"""Whether a transformation (q, p) → (Q, P) is canonical: Lagrange's brackets, as expressions and at many states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._html import Record
from visviva._keywords import known_keywords
from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus, expression_list
from visviva.generalized._probe import VANISHES, Probe

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._hamiltonian import Hamiltonian

__all__ = ["CanonicalTest", "canonical_test"]


@known_keywords
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CanonicalTest(Record):
    """What became of MᵀJM − J, M being the derivatives of (Q, P) by (q, p); true where it vanishes.

    Units: residuals are relative, without dimension.

    Attributes
    ----------
    holds : bool
        Whether the transformation is canonical.
    proved : bool
        Whether that follows from the expressions, whatever the parameters; else it was seen at states of many sizes.
    residual : float
        The largest entry of MᵀJM − J there, relative to what it is made of.
    matrix : ndarray, shape (2n, 2n)
        Each entry of MᵀJM − J where it is largest.

    References
    ----------
    H. Goldstein, C. Poole & J. Safko, *Classical Mechanics*, 3rd ed., (9.55).

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
    rows = c.with_derivatives(
        c.of_user("transformation", expression_list("transformation", transformation, 2 * n, what))
    )
    probe, undecided = Probe(c), False
    pairs = [(a, b) for a in range(2 * n) for b in range(a + 1, 2 * n)]
    matrix, proved, worst = np.zeros((2 * n, 2 * n)), True, 0.0
    for a, b in pairs:
        parts = [rows[k][1 + a] * rows[n + k][1 + b] for k in range(n)]
        parts += [-(rows[n + k][1 + a] * rows[k][1 + b]) for k in range(n)]
        parts.append(c.constant(-1.0 if b == a + n else 0.0))
        if c.is_zero(c.with_derivatives([sum(parts, c.constant(0.0))])[0][0]):
            continue
        proved = False
        found = probe.check_sum(parts)
        if not found.known:
            raise InvalidInput("transformation", "it has values at too few states near the start to test it there")
        worst, undecided = max(worst, found.residual), undecided or not found.seen
        matrix[a, b] = found.largest
        matrix[b, a] = -matrix[a, b]
    if worst <= VANISHES and undecided:
        raise InvalidInput(
            "transformation",
            "not decided: some of the terms of its brackets are nowhere to be seen, 0 or drowned by others at all "
            "states that were tried, of the sizes of the start, the parameters and 1; start where they are large, "
            "or take other units",
        )
    matrix.flags.writeable = False
    return CanonicalTest(worst <= VANISHES, proved, worst, matrix)
