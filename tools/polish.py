"""Order conditions in many digits, and the least change that makes published digits satisfy them.

A table printed to 25 or 30 digits misses its order conditions by its last digit. Newton's method
with the least-norm step moves it onto the set of exact solutions while changing it as little as
possible, and keeps what is known exactly (rational entries, structural zeros) as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations_with_replacement
from typing import NamedTuple

from mpmath import factorial, lu_solve, matrix, mp, mpf

Row = list[mpf]
Tree = tuple["Tree", ...]
Residual = Callable[[Row], Row]


class Printed(NamedTuple):
    """What so many digits allow."""

    independent: mpf
    """Pivots of independent conditions are larger."""
    redundant: mpf
    """Those of redundant ones are smaller: at digits that are wrong they are not zero."""
    farthest: mpf
    """By how much digits may change: more means that they are not those of such a method."""


TWENTY_DIGITS = Printed(mpf("1e-12"), mpf("1e-20"), mpf("1e-19"))
FIFTEEN_DIGITS = Printed(mpf("1e-6"), mpf("1e-9"), mpf("1e-12"))


def trees_to_order(order: int) -> list[list[Tree]]:
    """Rooted trees by number of vertices, from 1; a tree is the tuple of its branches."""
    by_order: list[list[Tree]] = [[], [()]]
    for size in range(2, order + 1):
        by_order.append(sorted(_forests(size - 1, size - 1, by_order)))
    return by_order[1:]


def _forests(size: int, largest: int, by_order: list[list[Tree]]) -> list[Tree]:
    """Collections of trees with ``size`` vertices, none of more than ``largest``."""
    if size == 0:
        return [()]
    found = []
    for top in range(min(size, largest), 0, -1):
        for copies in range(1, size // top + 1):
            for chosen in combinations_with_replacement(by_order[top], copies):
                rest = _forests(size - copies * top, top - 1, by_order)
                found += [chosen + other for other in rest]
    return found


def vertices(tree: Tree) -> int:
    """The order of a tree."""
    return 1 + sum(map(vertices, tree))


def density(tree: Tree) -> int:
    """The γ of a tree: an order condition reads Σ b_i Φ_i = 1/γ."""
    product = vertices(tree)
    for branch in tree:
        product *= density(branch)
    return product


def stage_weights(a: Sequence[Row], trees: list[Tree]) -> dict[Tree, Row]:
    """Φ_i of each tree at each stage. The branches of a tree must come before it."""
    stages = len(a)
    weights: dict[Tree, Row] = {}
    grown: dict[Tree, Row] = {}
    for tree in trees:
        weight = [mpf(1)] * stages
        for branch in tree:
            weight = [x * y for x, y in zip(weight, grown[branch], strict=True)]
        weights[tree] = weight
        grown[tree] = [mp.fdot(row, weight[: len(row)]) for row in a]
    return weights


def composition_residuals(lengths: Row, order: int) -> Row:
    """How far a composition of symmetric second-order steps is from order ``order``.

    A symmetric step of length g is exp(g Y1 + g³ Y3 + g⁵ Y5 + …) with Y1, Y3, … free of relations,
    so the product of the steps must agree with exp(Y1) in the coefficient of every word.
    """
    words: list[tuple[int, ...]] = [()]
    for word in words:  # grows while it is read
        words += [(*word, k) for k in range(1, order + 1, 2) if sum(word) + k <= order]
    series = {word: mpf(word == ()) for word in words}
    for length in lengths:
        series = {
            word: sum(
                (
                    series[word[:cut]] * length ** sum(word[cut:]) / factorial(len(word) - cut)
                    for cut in range(len(word) + 1)
                ),
                mpf(0),
            )
            for word in words
        }
    exact = {(1,) * n: 1 / factorial(n) for n in range(order + 1)}
    return [series[word] - exact.get(word, 0) for word in words]


def rational(value: mpf) -> mpf | None:
    """The fraction of denominator below 10⁶ that 30 printed digits can only mean, if any."""
    if value == 0:
        return mpf(0)
    guess = Fraction(mp.nstr(value, 40)).limit_denominator(10**6)
    exact = mpf(guess.numerator) / guess.denominator
    # Two fractions of such denominators differ by 1e-12; 1e-28 cannot agree by accident.
    return exact if abs(exact - value) <= mpf("1e-28") * abs(value) else None


def polish(residual: Residual, start: Row, printed: Printed = TWENTY_DIGITS) -> Row:
    """The zero of ``residual`` nearest to ``start``, by Newton's method with least-norm steps.

    Redundant conditions are allowed: the rank of the Jacobian must show as a gap between pivots.
    Raises ArithmeticError if it does not, if the residual does not fall to the working precision, or if the zero is
    farther away than the digits allow.
    """
    x = list(start)
    step = mpf(10) ** (-mp.dps // 3)
    goal = mpf(10) ** (15 - mp.dps)
    for _ in range(6):
        value = residual(x)
        if max(map(abs, value)) < goal:
            moved = max(abs(new - old) for new, old in zip(x, start, strict=True))
            if moved > printed.farthest:
                raise ArithmeticError(f"the nearest method is {mp.nstr(moved, 3)} away")
            return x
        columns = []
        for k in range(len(x)):
            moved = residual([*x[:k], x[k] + step, *x[k + 1 :]])
            columns.append([(new - old) / step for new, old in zip(moved, value, strict=True)])
        rows = [list(row) for row in zip(*columns, strict=True)]
        x = [old - change for old, change in zip(x, _least_norm(rows, value, printed), strict=True)]
    raise ArithmeticError(f"residual stays at {mp.nstr(max(map(abs, value)), 3)}")


def _least_norm(rows: list[Row], right: Row, printed: Printed) -> Row:
    """The shortest solution of a consistent system with redundant rows."""
    chosen = _independent(rows, printed)
    kept = [rows[i] for i in chosen]
    gram = matrix([[mp.fdot(p, q) for q in kept] for p in kept])
    multipliers = lu_solve(gram, matrix([right[i] for i in chosen]))
    return [mp.fdot((row[k] for row in kept), multipliers) for k in range(len(rows[0]))]


def _independent(rows: list[Row], printed: Printed) -> list[int]:
    """Indices of a largest set of independent rows, by elimination with the largest pivot."""
    left = dict(enumerate(map(list, rows)))
    chosen: list[int] = []
    while left:
        size, index, column = max((abs(entry), i, j) for i, row in left.items() for j, entry in enumerate(row))
        if size < printed.independent:
            if size > printed.redundant:
                raise ArithmeticError(f"the rank is not clear: pivot {mp.nstr(size, 3)}")
            break
        pivot = left.pop(index)
        chosen.append(index)
        for row in left.values():
            factor = row[column] / pivot[column]
            if factor:
                for j, entry in enumerate(pivot):
                    row[j] -= factor * entry
    return chosen
