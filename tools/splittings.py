"""Splittings of kicks and drifts, and compositions of leapfrogs: closed forms, or published digits polished.

A palindrome is polished as one: the pieces of its first half are what moves, and the middle ones are what is left of
the whole step, so that nothing is free that the paper has fixed.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from mpmath import cbrt, factorial, mp, mpf, sqrt

import published_splittings as published
from polish import FIFTEEN_DIGITS, TWENTY_DIGITS, composition_residuals, polish

if TYPE_CHECKING:
    from collections.abc import Callable

    from polish import Row

Table = dict[str, "Row | list[Row]"]
Printed = dict[str, tuple[str, ...]]
half, one = mpf(1) / 2, mpf(1)


def composition(weights: Row) -> Table:
    """Kick-drift-kick leapfrogs of these lengths, neighboring half kicks merged."""
    padded = [mpf(0), *weights, mpf(0)]
    return {
        "KICKS": [(left + right) / 2 for left, right in pairwise(padded)],
        "DRIFTS": weights,
    }


def position_first(weights: Row) -> Table:
    """Drift-kick-drift leapfrogs of these lengths, neighboring half drifts merged."""
    padded = [mpf(0), *weights, mpf(0)]
    return {
        "KICKS": [mpf(0), *weights, mpf(0)],
        "DRIFTS": [(left + right) / 2 for left, right in pairwise(padded)],
    }


def leapfrog() -> Table:
    return composition([one])


def leapfrog_dkd() -> Table:
    return position_first([one])


def symplectic_euler() -> Table:
    return {"KICKS": [one, mpf(0)], "DRIFTS": [one]}


def ruth3() -> Table:
    kicks = [mpf(7) / 24, mpf(3) / 4, -one / 24, mpf(0)]
    return {"KICKS": kicks, "DRIFTS": [mpf(2) / 3, -mpf(2) / 3, one]}


def yoshida4() -> Table:
    outer = 1 / (2 - cbrt(mpf(2)))
    return composition([outer, 1 - 2 * outer, outer])


def boris4() -> Table:
    """Suzuki's five: a kick turns velocities in its middle and cannot be parted, so that whole steps are composed."""
    outer = 1 / (4 - cbrt(mpf(4)))
    return position_first([outer, outer, 1 - 4 * outer, outer, outer])


def mclachlan4() -> Table:
    root = sqrt(mpf(19))
    kicks = [(14 - root) / 108, (20 - 7 * root) / 108, (5 + 2 * root) / 27]
    drifts = [mpf(2) / 5, -one / 10, mpf(2) / 5, -one / 10, mpf(2) / 5]
    return {"KICKS": [*kicks, *kicks[::-1]], "DRIFTS": drifts}


def polished_composition(printed: tuple[str | None, ...], order: int) -> Table:
    """A palindrome of leapfrogs whose first half and middle are printed."""

    def palindrome(first: Row) -> Row:
        if printed[-1] is None:
            first = [*first, 1 - 2 * sum(first, mpf(0))]
        return first + first[-2::-1]

    start = [mpf(number) for number in printed if number is not None]
    few = max(len(number) for number in printed if number) < 20
    digits = FIFTEEN_DIGITS if few else TWENTY_DIGITS
    first = polish(lambda first: composition_residuals(palindrome(first), order), start, digits)
    return composition(palindrome(first))


def completed(first: Row, middles: int) -> Row:
    """The whole palindrome: what is left of 1 is its middle piece, or its two middle pieces."""
    left = (1 - 2 * sum(first, mpf(0))) / middles
    return [*first, *[left] * middles, *first[::-1]]


def polished_splitting(printed: Printed, order: int, residuals: Callable[[Row, Row, int], Row], *, drift: str) -> Table:
    """A palindrome of kicks and drifts that starts with the pieces printed first."""
    (outer_name, outer), (inner_name, inner) = printed.items()
    # Outer pieces are one more than inner ones, so one of the two is even in number.
    outer_middles = 1 if len(outer) == len(inner) + 1 else 2
    count = len(outer)

    def pieces(values: Row) -> dict[str, Row]:
        return {
            outer_name: completed(values[:count], outer_middles),
            inner_name: completed(values[count:], 3 - outer_middles),
        }

    def kicks_and_drifts(values: Row) -> tuple[Row, Row]:
        drifts, kicks = pieces(values)[drift], pieces(values)[inner_name if drift == outer_name else outer_name]
        return ([mpf(0), *kicks, mpf(0)] if drift == outer_name else kicks), drifts

    start = [mpf(digits) for digits in (*outer, *inner)]
    found = polish(lambda values: residuals(*kicks_and_drifts(values), order), start, FIFTEEN_DIGITS)
    kicks, drifts = kicks_and_drifts(found)
    return {"KICKS": kicks, "DRIFTS": drifts}


def word_residuals(kicks: Row, drifts: Row, order: int) -> Row:
    """How far a splitting is from order ``order`` for any two flows: every word of at most so many letters."""
    words: list[tuple[int, ...]] = [()]
    for word in words:  # grows while it is read
        if len(word) < order:
            words += [(*word, 0), (*word, 1)]
    series = {word: mpf(word == ()) for word in words}
    pieces = [piece for pair in zip(kicks, [*drifts, mpf(0)], strict=True) for piece in pair]
    for index, length in enumerate(pieces):
        letter = index % 2
        changed = {}
        for word in words:
            cut, term, total = len(word), one, series[word]
            while cut and word[cut - 1] == letter:
                cut -= 1
                term = term * length / (len(word) - cut)
                total += series[word[:cut]] * term
            changed[word] = total
        series = changed
    return [series[word] - 1 / factorial(len(word)) for word in words]


def nystrom_residuals(kicks: Row, drifts: Row, order: int) -> Row:
    """How far a splitting is from order ``order`` for q'' = a(q): special Nystrom trees (Hairer, Norsett & Wanner,
    Solving Ordinary Differential Equations I, II.14), in which a child is a velocity or an acceleration.
    """
    nodes = [sum(drifts[:i], mpf(0)) for i in range(len(kicks))]
    # By vertices: the exact value of the integral, and the values at the kicks; grown are trees beneath a velocity.
    children: list[list[tuple[mpf, Row]]] = [[] for _ in range(order + 1)]
    children[1] = [(one, nodes)]
    residuals = [sum(drifts, mpf(0)) - 1]
    for size in range(1, order + 1):
        for exact, values in _products(size - 1, size - 1, children, len(kicks)):
            residuals.append(mp.fdot(kicks, values) - exact / size)
            if size + 2 <= order:
                grown = [
                    sum((kicks[j] * (nodes[i] - nodes[j]) * values[j] for j in range(i)), mpf(0))
                    for i in range(len(kicks))
                ]
                children[size + 1].append((exact / (size * (size + 1)), grown))
    return residuals


def _products(size: int, largest: int, children: list[list[tuple[mpf, Row]]], kicks: int) -> list[tuple[mpf, Row]]:
    """Products of children with ``size`` vertices in all, none with more than ``largest``."""
    if size == 0:
        return [(one, [one] * kicks)]
    found = []
    for top in range(min(size, largest), 0, -1):
        for index, (exact, values) in enumerate(children[top]):
            below = [*children[:top], children[top][: index + 1]]
            for other, weights in _products(size - top, top, below, kicks):
                found.append((exact * other, [x * y for x, y in zip(values, weights, strict=True)]))
    return found


# Any two flows may be a and b. With drifts for a, S6 has the smaller errors on orbits, and with kicks for a S10.
METHODS: dict[str, Callable[[], Table]] = {
    "leapfrog": leapfrog,
    "leapfrog_dkd": leapfrog_dkd,
    "symplectic_euler": symplectic_euler,
    "ruth3": ruth3,
    "yoshida4": yoshida4,
    "mclachlan4": mclachlan4,
    "pefrl4": lambda: polished_splitting(published.PEFRL4, 4, word_residuals, drift="drift"),
    "blanes_moan_s6": lambda: polished_splitting(published.BLANES_MOAN_S6, 4, word_residuals, drift="a"),
    "blanes_moan_s10": lambda: polished_splitting(published.BLANES_MOAN_S10, 6, word_residuals, drift="b"),
    "blanes_moan_rkn4": lambda: polished_splitting(published.BLANES_MOAN_RKN4, 4, nystrom_residuals, drift="a"),
    "blanes_moan_rkn6_11": lambda: polished_splitting(published.BLANES_MOAN_RKN6_11, 6, nystrom_residuals, drift="a"),
    "blanes_moan_rkn6_14": lambda: polished_splitting(published.BLANES_MOAN_RKN6_14, 6, nystrom_residuals, drift="a"),
    "yoshida6": lambda: polished_composition(published.YOSHIDA6, 6),
    "kahan_li6": lambda: polished_composition(published.KAHAN_LI6, 6),
    "sofroniou_spaletta6": lambda: polished_composition(published.SOFRONIOU_SPALETTA6, 6),
    "yoshida8": lambda: polished_composition(published.YOSHIDA8, 8),
    "kahan_li8": lambda: polished_composition(published.KAHAN_LI8, 8),
    "sofroniou_spaletta8": lambda: polished_composition(published.SOFRONIOU_SPALETTA8, 8),
    "sofroniou_spaletta10": lambda: polished_composition(published.SOFRONIOU_SPALETTA10, 10),
    "boris": leapfrog_dkd,
    "boris4": boris4,
}
