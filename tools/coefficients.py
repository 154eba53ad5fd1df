"""Compute the coefficient tables of the integrators and write them into their Rust files.

Closed forms are evaluated, published digits are polished onto the order conditions, and every
number is rounded once, to a double-double. With ``--check`` nothing is written: the exit status
says whether the checked-in tables equal what is computed here.

    python tools/coefficients.py [--check]
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

from mpmath import cbrt, mp, mpf, sqrt

import published_coefficients as published

mp.dps = 80
INTEGRATORS = Path(__file__).resolve().parents[1] / "rust/core/src/integrators"
BLOCK = re.compile(r"(// <coefficients>[^\n]*\n).*?(// </coefficients>)", re.DOTALL)

Row = list[mpf]
Table = dict[str, "Row | list[Row]"]


def rows_of(table: dict[int, dict[int, str]], width: int) -> dict[int, Row]:
    """Dense rows of a sparse published table."""
    return {i: [mpf(row.get(j, 0)) for j in range(width)] for i, row in table.items()}


def rk4() -> Table:
    half = mpf(1) / 2
    third, sixth = mpf(1) / 3, mpf(1) / 6
    return {
        "A": [[], [half], [mpf(0), half], [mpf(0), mpf(0), mpf(1)]],
        "B": [sixth, third, third, sixth],
        "C": [mpf(0), half, half, mpf(1)],
    }


def composition(weights: Row) -> Table:
    """Kick-drift-kick leapfrogs of these lengths, neighbouring half kicks merged."""
    padded = [mpf(0), *weights, mpf(0)]
    return {
        "KICKS": [(left + right) / 2 for left, right in zip(padded, padded[1:])],
        "DRIFTS": weights,
    }


def leapfrog() -> Table:
    return composition([mpf(1)])


def yoshida4() -> Table:
    outer = 1 / (2 - cbrt(mpf(2)))
    return composition([outer, 1 - 2 * outer, outer])


def kahan_li8() -> Table:
    half = [mpf(digits) for digits in published.KAHAN_LI8]
    return composition(half + half[-2::-1])


def dop853() -> Table:
    root = sqrt(mpf(6))
    c = [mpf(0), (12 - 2 * root) / 135, (6 - root) / 45, (6 - root) / 30, (6 + root) / 30]
    c += [mpf(p) / q for p, q in ((1, 3), (1, 4), (4, 13), (127, 195), (3, 5), (6, 7), (1, 1))]
    dense_c = [mpf(p) / q for p, q in ((1, 10), (1, 5), (7, 9))]
    a = rows_of(published.DOP853_A, 16)
    b = a[12][:12]
    e5 = [mpf(published.DOP853_E5.get(j, 0)) for j in range(12)]
    e3 = [b[j] - mpf(published.DOP853_B3.get(j, 0)) for j in range(12)]
    d = rows_of(published.DOP853_D, 16)
    weights = b + 4 * [mpf(0)]
    dense = []
    for i in range(16):
        first = mpf(i == 0)
        last = mpf(i == 12)
        ends = [weights[i], first - weights[i], 2 * weights[i] - first - last]
        dense.append(ends + [d[k][i] for k in range(3, 7)])
    return {
        "A": [[]] + [a[i][:i] for i in range(1, 12)],
        "B": b,
        "C": c,
        "ERROR": e5,
        "SECOND_ERROR": e3,
        "DENSE_A": [a[i][:i] for i in range(13, 16)],
        "DENSE_C": dense_c,
        "DENSE": dense,
    }


METHODS = {
    "rk4": rk4,
    "dop853": dop853,
    "leapfrog": leapfrog,
    "yoshida4": yoshida4,
    "kahan_li8": kahan_li8,
}


def literal(value: mpf) -> str:
    """A double-double in Rust: the nearest double, then the double nearest to what is left."""
    if value == 0:
        return "ZERO"
    high = float(value)
    low = float(value - mpf(high))
    return f"dd({high!r}, {low!r})"


def packed(row: Row, indent: str) -> list[str]:
    """The entries of a row, as many to a line as fit."""
    lines, line = [], indent
    for text in (literal(value) + "," for value in row):
        if len(line) + len(text) + 1 > 110 and line != indent:
            lines.append(line.rstrip())
            line = indent
        line += text + " "
    return [*lines, line.rstrip()] if row else []


def rust(table: Table) -> str:
    """The constants of a table as Rust source."""
    lines = []
    for name, content in table.items():
        nested = isinstance(content[0], list)
        kind = "&[&[DoubleDouble]]" if nested else "&[DoubleDouble]"
        lines += ["#[rustfmt::skip]", f"const {name}: {kind} = &["]
        if nested:
            for row in content:
                lines += ["    &[", *packed(row, "        "), "    ],"] if row else ["    &[],"]
        else:
            lines += packed(content, "    ")
        lines.append("];")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    check = parser.parse_args().check
    stale = []
    for name, compute in METHODS.items():
        path = INTEGRATORS / f"{name}.rs"
        before = path.read_text(encoding="utf-8")
        block = rust(compute())
        after, found = BLOCK.subn(lambda match: match[1] + block + match[2], before)
        if found != 1:
            raise SystemExit(f"{path}: expected one block of coefficients, found {found}")
        if after == before:
            continue
        if check:
            stale.append(name)
        else:
            path.write_text(after, encoding="utf-8")
    print(f"differ: {', '.join(stale)}" if stale else f"{len(METHODS)} tables agree")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
