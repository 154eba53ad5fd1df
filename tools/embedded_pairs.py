"""Pairs of Runge-Kutta formulas whose last stage is the first of the next step; all coefficients are fractions.

P. Bogacki & L. F. Shampine, A 3(2) pair of Runge-Kutta formulas, Appl. Math. Lett. 2 (1989) 321.
J. R. Dormand & P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6 (1980) 19, RK5(4)7M;
its continuous extension of order 4 is L. F. Shampine's, as printed by Hairer, Norsett & Wanner, Solving Ordinary
Differential Equations I, 2nd ed. (Springer 1993), II.6.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mpmath import mpf

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
