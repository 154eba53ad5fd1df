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
from itertools import pairwise
from pathlib import Path

from mpmath import cbrt, mp, mpf

import published_coefficients as published
from dop853 import dop853
from embedded_pairs import bogacki_shampine32, dormand_prince54
from multistep import stormer
from polish import Row, composition_residuals, polish

mp.dps = 80
INTEGRATORS = Path(__file__).resolve().parents[1] / "rust/core/src/ode/methods"
BLOCK = re.compile(r"(// <coefficients>[^\n]*\n).*?(// </coefficients>)", re.DOTALL)

Table = dict[str, "Row | list[Row]"]


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
        "KICKS": [(left + right) / 2 for left, right in pairwise(padded)],
        "DRIFTS": weights,
    }


def leapfrog() -> Table:
    return composition([mpf(1)])


def boris() -> Table:
    """Drift-kick-drift."""
    half = mpf(1) / 2
    return {"KICKS": [mpf(0), mpf(1), mpf(0)], "DRIFTS": [half, half]}


def yoshida4() -> Table:
    outer = 1 / (2 - cbrt(mpf(2)))
    return composition([outer, 1 - 2 * outer, outer])


def kahan_li8() -> Table:
    """The printed 26 digits, polished as a palindrome."""

    def palindrome(half: Row) -> Row:
        return half + half[-2::-1]

    printed = [mpf(digits) for digits in published.KAHAN_LI8]
    half = polish(lambda half: composition_residuals(palindrome(half), 8), printed)
    return composition(palindrome(half))


METHODS = {
    "rk4": rk4,
    "bogacki_shampine32": bogacki_shampine32,
    "dormand_prince54": dormand_prince54,
    "dop853": dop853,
    "leapfrog": leapfrog,
    "boris": boris,
    "yoshida4": yoshida4,
    "kahan_li8": kahan_li8,
    "stormer13": lambda: stormer(13),
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
        after, found = BLOCK.subn(lambda match, block=block: match[1] + block + match[2], before)
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
