"""Pairs of Runge-Kutta formulas: fractions, digits enough as they are printed, or digits polished.

P. Bogacki & L. F. Shampine, A 3(2) pair of Runge-Kutta formulas, Appl. Math. Lett. 2 (1989) 321.
J. R. Dormand & P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980) 19, RK5(4)7M;
its continuous extension of order 4 is L. F. Shampine's, as printed by Hairer, Norsett & Wanner, Solving Ordinary
Differential Equations I, 2nd ed. (Springer 1993), II.6.
Ch. Tsitouras, Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying assumption, Comput. Math.
Appl. 62 (2011) 770: 16 digits, and the decimals 0.161, 0.327, 0.9, 0.01, 0.1017 and 2.5, which are exact. The weight
of the derivative at the end in the estimate is -1/66 (the sign is missing in print).
Verner's pair of orders 9 and 8 is printed with 40 digits (published_verner.py), which satisfy all conditions to
1e-35.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mpmath import mp, mpf

import published_verner as verner
from dop853 import in_nested_basis
from polish import FIFTEEN_DIGITS, density, polish, stage_weights, trees_to_order, vertices

if TYPE_CHECKING:
    from polish import Row


def fractions(*printed: str) -> Row:
    """Fractions as they are printed."""
    return [mpf(numerator) / mpf(denominator or 1) for numerator, _, denominator in (p.partition("/") for p in printed)]


def pair(a: list[Row], b: Row, embedded: Row, beyond_hermite: Row | None = None) -> dict[str, Row | list[Row]]:
    """The tables of a pair. Its extension is the cubic through the ends of the step and their derivatives, and what
    the weights `beyond_hermite` of all stages add to that.
    """
    stages = len(b)
    b_all = [*b, mpf(0)]
    dense = []
    for i, weight in enumerate(b_all):
        first, last = mpf(i == 0), mpf(i == stages)
        dense.append([weight, first - weight, 2 * weight - first - last])
        if beyond_hermite:
            dense[-1].append(beyond_hermite[i])
    return {
        "A": a,
        "B": b,
        "C": [sum(row, mpf(0)) for row in a],
        "ERROR": [mine - other for mine, other in zip(b_all, embedded, strict=True)],
        "DENSE": dense,
    }


def bogacki_shampine32() -> dict[str, Row | list[Row]]:
    return pair(
        a=[[], fractions("1/2"), fractions("0", "3/4")],
        b=fractions("2/9", "1/3", "4/9"),
        embedded=fractions("7/24", "1/4", "1/3", "1/8"),
    )


def dormand_prince54() -> dict[str, Row | list[Row]]:
    return pair(
        a=[
            [],
            fractions("1/5"),
            fractions("3/40", "9/40"),
            fractions("44/45", "-56/15", "32/9"),
            fractions("19372/6561", "-25360/2187", "64448/6561", "-212/729"),
            fractions("9017/3168", "-355/33", "46732/5247", "49/176", "-5103/18656"),
        ],
        b=fractions("35/384", "0", "500/1113", "125/192", "-2187/6784", "11/84"),
        embedded=fractions("5179/57600", "0", "7571/16695", "393/640", "-92097/339200", "187/2100", "1/40"),
        beyond_hermite=fractions(
            "-12715105075/11282082432",
            "0",
            "87487479700/32700410799",
            "-10690763975/1880347072",
            "701980252875/199316789632",
            "-1453857185/822651844",
            "69997945/29380423",
        ),
    )


def tsitouras54() -> dict[str, Row | list[Row]]:
    """Free are what is printed with 16 digits; the first column follows from the nodes."""
    c = [mpf(0), mpf("0.161"), mpf("0.327"), mpf("0.9"), mpf(0), mpf(1), mpf(1)]
    printed = [
        "0.9800255409045097",  # c
        "0.3354806554923570",  # a, row after row from the second column on
        *("-6.359448489975075", "4.362295432869581"),
        *("-11.74888356406283", "7.495539342889836", "-0.09249506636175525"),
        *("-12.92096931784711", "8.159367898576159", "-0.07158497328140100", "-0.02826905039406838"),
        *("0.4798896504144996", "1.379008574103742", "-3.290069515436081", "2.324710524099774"),  # b, from the third on
        "0.00178001105222577714",  # the estimate, but for the last
        *("0.0008164344596567469", "-0.007880878010261995", "0.1447110071732629"),
        *("-0.5823571654525552", "0.45808210592918697"),
        *("-1.0530884977290216", "2.490627285651252793"),  # beyond Hermite, but for the second and the last
        *("-16.54810288924490272", "47.37952196281928122", "-34.87065786149660974"),
    ]

    def rows(values: Row) -> tuple[list[Row], Row, Row]:
        left = iter(values)
        nodes = [*c[:4], next(left), *c[5:]]
        a: list[Row] = [[], [nodes[1]]]
        for stage in range(2, 6):
            others = [next(left) for _ in range(stage - 1)]
            a.append([nodes[stage] - sum(others, mpf(0)), *others])
        others = [mpf("0.01"), *[next(left) for _ in range(4)]]
        a.append([1 - sum(others, mpf(0)), *others])
        estimate = [*[next(left) for _ in range(6)], -mpf(1) / 66]
        beyond = [next(left), mpf("0.1017"), *[next(left) for _ in range(4)], mpf("2.5")]
        return a, estimate, beyond

    trees = [tree for trees in trees_to_order(5) for tree in trees]

    def residual(values: Row) -> Row:
        a, estimate, beyond = rows(values)
        weights = stage_weights(a, trees)
        found = [mp.fdot(a[6], weights[tree][:6]) - mpf(1) / density(tree) for tree in trees]
        for tree in trees:
            if vertices(tree) <= 4:
                found.append(mp.fdot(estimate, weights[tree]))
                exact = in_nested_basis(vertices(tree))[3] / density(tree)
                found.append(mp.fdot(beyond, weights[tree]) - exact)
        return found

    # With as many conditions as numbers, of which the last has a pivot of 2.5e-9.
    digits = FIFTEEN_DIGITS._replace(independent=mpf("1e-10"), redundant=mpf("1e-20"))
    start = [mpf(number) for number in printed]
    a, estimate, beyond = rows(polish(residual, start, digits))
    b = a.pop()
    embedded = [mine - error for mine, error in zip([*b, mpf(0)], estimate, strict=True)]
    return pair(a, b, embedded, beyond)


def verner98() -> dict[str, Row | list[Row]]:
    stages, extended = 16, 21

    def row(printed: dict[int, str], width: int) -> Row:
        return [mpf(printed.get(stage, "0")) for stage in range(width)]

    b = row(verner.B, stages)
    a = [b if i == stages else row(verner.A.get(i, {}), i) for i in range(extended)]
    basis = [in_nested_basis(power) for power in range(1, 9)]

    def nested(stage: int) -> Row:
        powers = [mpf(digits) for digits in verner.DENSE.get(stage, ())]
        return [mp.fdot(powers, [terms[k] for terms in basis[: len(powers)]]) for k in range(8)]

    dense = [nested(stage) for stage in range(extended)]
    for stage, weights in enumerate(dense):
        first, last, weight = mpf(stage == 0), mpf(stage == stages), (b + [mpf(0)] * 5)[stage]
        # Printed with 40 digits they are those of the ends of the step to 1e-35, and so are made exactly that.
        weights[:3] = [weight, first - weight, 2 * weight - first - last]
    return {
        "A": a[:stages],
        "B": b,
        "C": [sum(row, mpf(0)) for row in a[:stages]],
        "ERROR": [-other for other in row(verner.OTHER, stages)],
        "DENSE_A": a[stages + 1 :],
        "DENSE_C": [sum(row, mpf(0)) for row in a[stages + 1 :]],
        "DENSE": dense,
    }
