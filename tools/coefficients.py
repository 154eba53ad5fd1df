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
from typing import TYPE_CHECKING

from mpmath import mp, mpf

import splittings
from dop853 import dop853
from embedded_pairs import bogacki_shampine32, dormand_prince54, fractions, tsitouras54, verner98
from multistep import stormer

if TYPE_CHECKING:
    from collections.abc import Callable

    from polish import Row

mp.dps = 80
INTEGRATORS = Path(__file__).resolve().parents[1] / "rust/core/src/ode/methods"
BLOCK = re.compile(r"(// <coefficients>[^\n]*\n).*?(// </coefficients>)", re.DOTALL)

Table = dict[str, "Row | list[Row]"]


def explicit(a: list[list[str]], b: list[str]) -> Table:
    """A tableau of fractions."""
    rows = [fractions(*row) for row in a]
    return {"A": rows, "B": fractions(*b), "C": [sum(row, mpf(0)) for row in rows]}


METHODS: dict[str, Callable[[], Table]] = {
    "euler": lambda: explicit([[]], ["1"]),
    "midpoint": lambda: explicit([[], ["1/2"]], ["0", "1"]),
    "heun": lambda: explicit([[], ["1"]], ["1/2", "1/2"]),
    "rk4": lambda: explicit([[], ["1/2"], ["0", "1/2"], ["0", "0", "1"]], ["1/6", "1/3", "1/3", "1/6"]),
    "bogacki_shampine32": bogacki_shampine32,
    "dormand_prince54": dormand_prince54,
    "tsitouras54": tsitouras54,
    "dop853": dop853,
    "verner98": verner98,
    **splittings.METHODS,
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
