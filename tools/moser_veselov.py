"""Find the modified moments of discrete Moser-Veselov steps, for rust/core/src/rigid/flow/moser_veselov.

    python tools/moser_veselov.py [--check]

A step turns a free body by the quaternion (e, w) of h M / 2 = w J e + e × J e (Moser & Veselov, Commun. Math. Phys. 139
(1991) 217), M the angular momentum and J the moments. It is of order two, and exact with moments that differ from the
body's: 1/J = slope · 1/I + shift, series in h² whose coefficients are polynomials of the energy, |M|² and 1/I
(McLachlan & Zanna, Found. Comput. Math. 5 (2005) 87; Hairer & Vilmart, J. Phys. A 39 (2006) 13225). Nothing is copied:
bodies with integers for moments and momenta are turned by a Taylor series in exact fractions, each of which gives slope
and shift for all three axes, and the polynomials are those through more such bodies than they have coefficients.

Units are such that the largest moment is 1: the other two are 1/(1 + b) and 1/(1 + c), and b + c, b c, C = |h M|² and
g = b (h M₂)² + c (h M₃)² are the variables. In these, and with 1/J = offset + slope · (0, b, c), no power of b + c is
higher than that of g: all terms are of the size of powers of the angle per step, however thin the body.
"""

from __future__ import annotations

import argparse
import random
import sys
from fractions import Fraction
from math import prod
from pathlib import Path

from mpmath import matrix, mp, mpf, norm, odefun, sqrt

TARGET = Path(__file__).parents[1] / "rust/core/src/rigid/flow/moser_veselov/coefficients.rs"
HIGHEST = 4  # powers of h² that order 10 takes

Series = list[Fraction]
Polynomial = dict[tuple[int, int], Fraction]  # (power of b + c, power of b c): coefficient
Modified = dict[tuple[int, int], Polynomial]  # (power of C, power of g): coefficient


def times(a: Series, b: Series) -> Series:
    return [sum((a[i] * b[k - i] for i in range(k + 1)), Fraction(0)) for k in range(min(len(a), len(b)))]


def plus(*terms: Series) -> Series:
    return [sum(column, Fraction(0)) for column in zip(*terms, strict=True)]


def minus(a: Series, b: Series) -> Series:
    return [x - y for x, y in zip(a, b, strict=True)]


def over(a: Series, b: Series) -> Series:
    quotient: Series = []
    for k in range(min(len(a), len(b))):
        quotient.append((a[k] - sum((quotient[i] * b[k - i] for i in range(k)), Fraction(0))) / b[0])
    return quotient


def turn(inverse: Series, momentum: Series, terms: int) -> list[Series]:
    """The quaternion (x, y, z, w) of a free body as a series in the time."""
    m, q = [[part] for part in momentum], [[Fraction(part)] for part in (0, 0, 0, 1)]
    for k in range(terms - 1):
        v = [[inverse[i] * part for part in m[i]] for i in range(3)]
        x, y, z, w = q
        rates = [minus(times(m[i - 2], v[i - 1]), times(m[i - 1], v[i - 2])) for i in range(3)]
        turned = [
            plus(times(w, v[0]), minus(times(y, v[2]), times(z, v[1]))),
            plus(times(w, v[1]), minus(times(z, v[0]), times(x, v[2]))),
            plus(times(w, v[2]), minus(times(x, v[1]), times(y, v[0]))),
            [-part for part in plus(times(x, v[0]), times(y, v[1]), times(z, v[2]))],
        ]
        for part, rate in zip(m, rates, strict=True):
            part.append(rate[k] / (k + 1))
        for part, rate in zip(q, turned, strict=True):
            part.append(rate[k] / (2 * (k + 1)))
    return q


def slope_and_offset(excess: Series, momentum: Series) -> tuple[Series, Series]:
    """Of the exact motion, as series in the time; ``excess`` is (0, b, c)."""
    terms = 2 * HIGHEST + 2
    inverse = [1 + part for part in excess]
    *e, w = turn(inverse, momentum, terms)
    half = [part / 2 for part in momentum]
    # p = J e / h, from w p + e × p = M / 2; both e and p begin with a power of h that is left out of the quotient.
    along = over(plus(*([part * half[i] for part in e[i]] for i in range(3))), w)
    p = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        across = minus([part * half[k] for part in e[j]], [part * half[j] for part in e[k]])
        p.append(plus(minus([part * half[i] for part in w], across), times(e[i], along)))
    modified = [over(e[i][1:], p[i]) for i in range(3)]
    slope = [part / excess[1] for part in minus(modified[1], modified[0])]
    # Three axes and two unknown functions: that there is a solution at all is the theorem.
    if minus(modified[2], modified[0]) != [part * excess[2] for part in slope]:
        sys.exit("no modified moments of this form")
    return slope, modified[0]


def solved(rows: list[Series]) -> Series:
    """The solution of equations with the right-hand sides last, of which there are more than unknowns."""
    unknowns = len(rows[0]) - 1
    for column in range(unknowns):
        at = next(i for i in range(column, len(rows)) if rows[i][column])
        rows[column], rows[at] = rows[at], rows[column]
        pivot = [part / rows[column][column] for part in rows[column]]
        for i, row in enumerate(rows):
            if i != column and row[column]:
                rows[i] = [a - row[column] * b for a, b in zip(row, pivot, strict=True)]
        rows[column] = pivot
    if any(row[-1] for row in rows[unknowns:]):
        sys.exit("the equations contradict each other")
    return [row[-1] for row in rows[:unknowns]]


def found() -> tuple[Modified, Modified]:
    """Slope − 1 and offset − 1."""
    generator = random.Random(1)
    slopes: Modified = {}
    offsets: Modified = {}
    samples = []
    for _ in range(60):
        b, c = (Fraction(part) for part in generator.sample(range(1, 30), 2))
        momentum = [Fraction(generator.randint(1, 9)) for _ in range(3)]
        square, excess = sum(part**2 for part in momentum), b * momentum[1] ** 2 + c * momentum[2] ** 2
        samples.append(((square, excess, b + c, b * c), slope_and_offset([Fraction(0), b, c], momentum)))
    for term in range(1, HIGHEST + 1):
        for which, table, weight in ((0, slopes, 2 * term), (1, offsets, 2 * term + 1)):
            powers = [
                (term - i, i, j, k)
                for i in range(term + 1)
                for j in range(min(i, weight - i) + 1)
                for k in range((weight - i - j) // 2 + 1)
            ]
            rows = [
                [prod((x**n for x, n in zip(variables, each, strict=True)), start=Fraction(1)) for each in powers]
                + [series[which][2 * term]]
                for variables, series in samples[: len(powers) + 8]
            ]
            for (i, j, k, n), value in zip(powers, solved(rows), strict=True):
                if value:
                    table.setdefault((i, j), {})[k, n] = value
    return slopes, offsets


def value(table: Modified, variables: list[mpf], terms: int) -> mpf:
    square, excess, total, product = variables
    return 1 + sum(
        mpf(factor.numerator) / factor.denominator * square**i * excess**j * total**k * product**n
        for (i, j), polynomial in table.items()
        if i + j <= terms
        for (k, n), factor in polynomial.items()
    )


def step(moments: list[mpf], momentum: list[mpf], h: mpf, tables: tuple[Modified, Modified], terms: int) -> list[mpf]:
    """The quaternion of one step; moments with the largest first, which is 1."""
    b, c = 1 / moments[1] - 1, 1 / moments[2] - 1
    u = [h * part for part in momentum]
    variables = [sum(part**2 for part in u), b * u[1] ** 2 + c * u[2] ** 2, b + c, b * c]
    slope, offset = (value(table, variables, terms) for table in tables)
    inverse = [offset + slope * part for part in (0, b, c)]
    e = [x * part / 2 for x, part in zip(inverse, u, strict=True)]
    for _ in range(300):
        w = sqrt(1 - sum(part**2 for part in e))
        p = [part / x for part, x in zip(e, inverse, strict=True)]
        across = [e[i - 2] * p[i - 1] - e[i - 1] * p[i - 2] for i in range(3)]
        e = [inverse[i] * (u[i] / 2 - across[i]) / w for i in range(3)]
    return [*e, w]


def verify(tables: tuple[Modified, Modified]) -> None:
    """The error of one step, against a Taylor series of the motion, is of the power of the step that it must be."""
    mp.dps = 40

    def rate(_: mpf, y: list[mpf]) -> list[mpf]:
        *m, x, y_, z, w = y
        v = [part / moment for part, moment in zip(m, moments, strict=True)]
        dm = [m[i - 2] * v[i - 1] - m[i - 1] * v[i - 2] for i in range(3)]
        dq = [
            w * v[0] + y_ * v[2] - z * v[1],
            w * v[1] + z * v[0] - x * v[2],
            w * v[2] + x * v[1] - y_ * v[0],
            -(x * v[0] + y_ * v[1] + z * v[2]),
        ]
        return [*dm, *(part / 2 for part in dq)]

    for moments in ([mpf(1), mpf("0.8"), mpf("0.6")], [mpf(1), mpf("0.99"), mpf("0.03")]):
        momentum = [mpf("-0.9"), mpf("0.4"), mpf("0.2")]
        motion = odefun(rate, 0, [*momentum, 0, 0, 0, 1])
        for terms in range(HIGHEST + 1):
            errors = []
            for h in (mpf(1) / 20, mpf(1) / 40):
                made = step(moments, momentum, h, tables, terms)
                errors.append(norm(matrix([a - b for a, b in zip(made, motion(h)[3:], strict=True)])))
            order = mp.log(errors[0] / errors[1], 2) - 1
            if abs(order - (2 * terms + 2)) > 0.1:
                sys.exit(f"order {2 * terms + 2} is {mp.nstr(order, 6)}: {[mp.nstr(each, 5) for each in errors]}")


def rust(name: str, comment: str, table: Modified) -> str:
    lines = [f"/// {comment}", f"pub(super) static {name}: [&[Term]; {len(table)}] = ["]
    for (i, j), polynomial in sorted(table.items(), key=lambda item: (sum(item[0]), item[0][1])):
        lines.append(f"    // C^{i} g^{j}")
        terms = [f"({f.numerator}, {f.denominator}, {k}, {n})" for (k, n), f in polynomial.items()]
        line = f"    &[{', '.join(terms)}],"
        lines += [line] if len(line) <= 110 else ["    &[", *(f"        {term}," for term in terms), "    ],"]
    return "\n".join([*lines, "];", ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    tables = found()
    verify(tables)
    text = "\n".join(
        [
            "//! The series of modified moments; written by tools/moser_veselov.py, which finds them.",
            "",
            "/// Numerator, denominator, power of b + c, power of b c.",
            "pub(super) type Term = (i32, i32, i32, i32);",
            "",
            rust("SLOPES", "What multiplies Cⁱ gʲ in the slope − 1: by i + j, and then by j.", tables[0]),
            rust("OFFSETS", "And in the offset − 1.", tables[1]),
        ]
    )
    if parser.parse_args().check:
        sys.exit(None if TARGET.read_text() == text else f"{TARGET.name} is not what is found")
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_text(text)


if __name__ == "__main__":
    main()
