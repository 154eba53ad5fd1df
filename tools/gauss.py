"""Write the tables of Gauss's collocation methods: ``rust/core/src/generalized/gauss/tables.rs``.

Nodes are the zeros of Legendre's polynomials; every weight is an integral of a Lagrange polynomial, found with 80
digits and rounded once. Of the matrix some entries are rounded to the other side, so that Σ bᵢ aᵢⱼ is 1/2 to some
1e-20: what it lacks is a drift of the energy, the same in every step. With ``--check`` nothing is written:
the exit status says whether the checked-in file equals what is computed.

    python tools/gauss.py [--check]
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

from mpmath import matrix, mp, mpf

mp.dps = 80
TABLES = Path(__file__).resolve().parents[1] / "rust/core/src/generalized/gauss/tables.rs"
WIDTH = 8
HEADER = """//! Gauss's collocation methods: nodes, weights, what leads on. Written by `tools/gauss.py`.
//!
//! J. C. Butcher, Math. Comp. 18 (1964) 50. Lanes beyond the stages are at the start of the step.

#![allow(clippy::unreadable_literal, clippy::excessive_precision, reason = "generated")]

use super::Table;
use crate::numerics::lanes::Lanes;
"""


def legendre_nodes(stages: int) -> list[mpf]:
    """The zeros of Legendre's polynomial, moved to 0 … 1, ascending."""
    nodes = []
    for k in range(1, stages + 1):
        x = mp.cos(mp.pi * (mpf(k) - mpf(1) / 4) / (stages + mpf(1) / 2))
        for _ in range(12):
            value_there, before = mp.legendre(stages, x), mp.legendre(stages - 1, x)
            x -= value_there * (x * x - 1) / (stages * (x * value_there - before))
        nodes.append((1 + x) / 2)
    return sorted(nodes)


def basis(nodes: list[mpf], k: int) -> list[mpf]:
    """The coefficients of the polynomial that is 1 at node ``k`` and 0 at the others, lowest power first."""
    polynomial = [mpf(1)]
    for j, node in enumerate(nodes):
        if j != k:
            scale = nodes[k] - node
            shifted = [mpf(0), *polynomial]
            polynomial = [
                (shifted[i] - node * (polynomial[i] if i < len(polynomial) else 0)) / scale for i in range(len(shifted))
            ]
    return polynomial


def integral(polynomial: list[mpf], to: mpf) -> mpf:
    """From 0 to ``to``."""
    return sum((c * to ** (i + 1) / (i + 1) for i, c in enumerate(polynomial)), mpf(0))


def value(polynomial: list[mpf], at: mpf) -> mpf:
    """The value of a polynomial."""
    return sum((c * at**i for i, c in enumerate(polynomial)), mpf(0))


def number(x: mpf) -> str:
    """Its nearest binary64 number, as Rust writes it."""
    text = repr(float(x))
    return text if any(mark in text for mark in ".en") else text + ".0"


def lanes(values: list[mpf]) -> str:
    """Eight numbers; zeros beyond those that are there."""
    padded = [*values, *[mpf(0)] * (WIDTH - len(values))]
    return "Lanes([" + ", ".join(number(x) for x in padded) + "])"


def balanced(a: matrix, b: list[mpf]) -> matrix:
    """The entries as binary64 numbers with Σ bᵢ aᵢⱼ = 1/2, each within 1.5 units in the last place."""
    stages = len(b)
    rounded = matrix(stages, stages)
    for i in range(stages):
        for j in range(stages):
            rounded[i, j] = mpf(float(a[i, j]))
    places = [(i, j) for i in range(stages) for j in range(stages)]
    unit = {(i, j): mpf(math.ulp(float(a[i, j]))) for i, j in places}
    lacks = mpf(1) / 2 - sum((b[i] * rounded[i, j] for i, j in places), mpf(0))
    for i, j in sorted(places, key=lambda place: -b[place[0]] * unit[place]):
        moved = b[i] * unit[i, j]
        if abs(lacks) > moved / 2:
            sign = 1 if lacks > 0 else -1
            rounded[i, j] += sign * unit[i, j]
            lacks -= sign * moved
    return rounded


def table(stages: int) -> str:
    """One method."""
    c = legendre_nodes(stages)
    polynomials = [basis(c, k) for k in range(stages)]
    a = matrix(stages, stages)
    for i in range(stages):
        for j in range(stages):
            a[i, j] = integral(polynomials[j], c[i])
    b = [integral(polynomial, mpf(1)) for polynomial in polynomials]
    a2 = a * a
    b2 = [sum((b[i] * a[i, j] for i in range(stages)), mpf(0)) for j in range(stages)]
    entries = balanced(a, b)
    weights = []
    for k in range(stages):
        product = mpf(1)
        for j in range(stages):
            if j != k:
                product *= c[k] - c[j]
        weights.append(1 / product)

    def columns(entry: object) -> str:
        rows = [lanes([entry(i, j) for i in range(stages)]) if j < stages else lanes([]) for j in range(WIDTH)]  # type: ignore[operator]
        return "[" + ", ".join(rows) + "]"

    def rest(values: list[mpf]) -> list[mpf]:
        return [x - mpf(float(x)) for x in values]

    fields = {
        "stages": str(stages),
        "c": lanes(c),
        "c_rest": lanes(rest(c)),
        "a": columns(lambda i, j: entries[i, j]),
        "a2": columns(lambda i, j: a2[i, j]),
        "b": f"[{lanes(b)}, {lanes(rest(b))}]",
        "b2": f"[{lanes(b2)}, {lanes(rest(b2))}]",
        "ahead": columns(lambda i, j: value(polynomials[j], 1 + c[i])),
        "weights": lanes(weights),
    }
    body = "\n".join(f"    {name}: {text}," for name, text in fields.items())
    return f"\n/// Order {2 * stages}.\npub(super) static GAUSS{2 * stages}: Table = Table {{\n{body}\n}};\n"


def formatted(text: str) -> str:
    """As rustfmt has it."""
    import subprocess

    root = TABLES.parents[5]
    return subprocess.run(
        ["rustfmt", "--edition", "2024", "--config-path", str(root / "rustfmt.toml")],
        input=text,
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def main() -> int:
    """Write the tables, or check them."""
    text = formatted(HEADER + "".join(table(stages) for stages in (2, 4, 8)))
    if "--check" in sys.argv[1:]:
        return int(TABLES.read_text(encoding="utf-8") != text)
    TABLES.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
