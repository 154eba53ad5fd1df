"""DOP853 in more digits than were printed.

The nodes have closed forms (they contain √6), and entries that 30 digits show to be rational are kept
as those fractions. What remains is moved onto the exact solutions of the conditions that the method
satisfies: first the step and its estimate of order 5, then the continuous extension.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mpmath import mp, mpf, sqrt

import published_coefficients as published
from polish import Row, Tree, density, polish, rational, stage_weights, trees_to_order, vertices

if TYPE_CHECKING:
    from collections.abc import Callable

STAGES = 12
EXTENDED = 16
Entries = dict[tuple[str, int, int], mpf]


def nodes() -> Row:
    """The nodes of all 16 stages."""
    root = sqrt(mpf(6))
    c = [mpf(0), (12 - 2 * root) / 135, (6 - root) / 45, (6 - root) / 30, (6 + root) / 30]
    step = ((1, 3), (1, 4), (4, 13), (127, 195), (3, 5), (6, 7), (1, 1), (1, 1))
    extension = ((1, 10), (1, 5), (7, 9))
    return c + [mpf(p) / q for p, q in step + extension]


def in_nested_basis(power: int) -> Row:
    """θ^power in the basis θ(f0 + (1-θ)(f1 + θ(f2 + (1-θ)(f3 + …)))), for 1 ≤ power ≤ 8."""
    left = [mpf(k == power - 1) for k in range(8)]  # coefficients of θ^0, θ^1, …
    basis = []
    for k in range(8):
        if k % 2:  # the next factor is θ: take the value at 0
            basis.append(left[0])
            left = [*left[1:], mpf(0)]
        else:  # the next factor is 1-θ: take the value at 1 and divide
            basis.append(sum(left, mpf(0)))
            left = [sum((-c for c in left[j + 1 :]), mpf(0)) for j in range(len(left))]
    return basis


class Table:
    """The method under polishing: all entries, of which some are free to move."""

    def __init__(self) -> None:
        self.c = nodes()
        self.entries: Entries = {}
        sources = {"a": published.DOP853_A, "d": published.DOP853_D}
        sources |= {"e5": {0: published.DOP853_E5}, "b3": {0: published.DOP853_B3}}
        for kind, rows in sources.items():
            for i, row in rows.items():
                for j, digits in row.items():
                    self.entries[kind, i, j] = mpf(digits)
        self.exact = {key: rational(value) for key, value in self.entries.items()}
        self.entries |= {key: value for key, value in self.exact.items() if value is not None}

    def row(self, kind: str, i: int, width: int = EXTENDED) -> Row:
        """A row with its structural zeros."""
        return [self.entries.get((kind, i, j), mpf(0)) for j in range(width)]

    def stage_conditions(self, stages: range) -> list[tuple[int, int]]:
        """The (i, q) for which Σ_j a_ij c_j^(q-1) = c_i^q / q holds to the printed digits."""
        pairs = [(i, q) for i in stages for q in range(1, 8)]
        return [(i, q) for i, q in pairs if abs(self.stage_residual(i, q)) < mpf("1e-26")]

    def stage_residual(self, i: int, q: int) -> mpf:
        """How far stage i is from integrating t^(q-1) exactly."""
        powers = [c ** (q - 1) for c in self.c]
        return mp.fdot(self.row("a", i), powers) - self.c[i] ** q / q

    def step_residual(self, stages: list[tuple[int, int]], trees: list[Tree]) -> Row:
        """Order 8 of the step, order 5 of the estimate, and the simplifying conditions."""
        a = [self.row("a", i, STAGES) for i in range(STAGES)]
        b, e5 = self.row("a", 12, STAGES), self.row("e5", 0, STAGES)
        weights = stage_weights(a, trees)
        residual = [self.stage_residual(i, q) for i, q in stages]
        residual += [mp.fdot(b, column) - b[j] * (1 - self.c[j]) for j, column in enumerate(zip(*a, strict=True))]
        residual += [mp.fdot(b, weights[tree]) - mpf(1) / density(tree) for tree in trees]
        residual += [mp.fdot(e5, weights[tree]) for tree in trees if vertices(tree) <= 5]
        return residual

    def extension_residual(self, stages: list[tuple[int, int]], trees: list[Tree]) -> Row:
        """Order 7 of the continuous extension at every θ, and the simplifying conditions."""
        weights = stage_weights([self.row("a", i) for i in range(EXTENDED)], trees)
        residual = [self.stage_residual(i, q) for i, q in stages]
        rows = {k: self.row("d", k) for k in range(3, 7)}
        for tree in trees:
            exact = in_nested_basis(vertices(tree))
            for k, row in rows.items():
                residual.append(mp.fdot(row, weights[tree]) - exact[k] / density(tree))
        return residual

    def polish(self, kinds: set[tuple[str, int]], conditions: Callable[[], Row]) -> None:
        """Move the entries of these rows that are not exact onto the conditions."""
        free = [key for key in self.entries if key[:2] in kinds and self.exact[key] is None]

        def residual(values: Row) -> Row:
            self.entries |= dict(zip(free, values, strict=True))
            return conditions()

        self.entries |= dict(zip(free, polish(residual, [self.entries[key] for key in free]), strict=True))


def dop853() -> dict[str, Row | list[Row]]:
    """The tables of DOP853 as the Rust side lays them out."""
    table = Table()
    by_order = trees_to_order(8)
    step_trees = [tree for trees in by_order for tree in trees]
    extension_trees = [tree for trees in by_order[:7] for tree in trees]
    stages = table.stage_conditions(range(1, STAGES))
    table.polish(
        {("a", i) for i in range(1, 13)} | {("e5", 0)},
        lambda: table.step_residual(stages, step_trees),
    )
    extension_stages = table.stage_conditions(range(13, EXTENDED))
    table.polish(
        {("a", i) for i in range(13, EXTENDED)} | {("d", k) for k in range(3, 7)},
        lambda: table.extension_residual(extension_stages, extension_trees),
    )
    b = table.row("a", 12, STAGES)
    b3 = table.row("b3", 0, STAGES)
    dense = []
    for i, weight in enumerate([*b, *[mpf(0)] * 4]):
        first, last = mpf(i == 0), mpf(i == 12)
        ends = [weight, first - weight, 2 * weight - first - last]
        dense.append(ends + [table.row("d", k)[i] for k in range(3, 7)])
    return {
        "A": [table.row("a", i, i) for i in range(STAGES)],
        "B": b,
        "C": table.c[:STAGES],
        "ERROR": table.row("e5", 0, STAGES),
        "SECOND_ERROR": [mine - other for mine, other in zip(b, b3, strict=True)],
        "DENSE_A": [table.row("a", i, i) for i in range(13, EXTENDED)],
        "DENSE_C": table.c[13:],
        "DENSE": dense,
    }
