"""Functions of expressions: those that the core knows, by their names in NumPy, and what to write instead of others."""

from __future__ import annotations

import numpy as np

__all__ = [
    "BENT",
    "FUNCTIONS",
    "KNOWN",
    "LEAPS",
    "MADE_OF",
    "NUMPY",
    "OF_FLOATS",
    "OF_SYMPY",
    "SWITCH",
    "UNKNOWN",
    "WIDTH",
]

FUNCTIONS = (
    "sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh",
    "asin", "acos", "atan", "asinh", "acosh", "atanh",
)  # fmt: skip
#: Of a smooth step in the place of a leap: one that is narrower than a step is found by methods that choose theirs.
WIDTH = "which steps follow; what sticks costs time as 1/width, so take a thousandth of the usual values for it"
#: Where two laws meet.
SWITCH = "end the run by an event where it switches, and go on from out.final with the other law"
_LARGER = "write (x + y + abs(x - y)) / 2"
_SMALLER = "write (x + y - abs(x - y)) / 2"
_WHOLE = f"{{}} is the same between leaps: put a number in its place, or {SWITCH}"
#: What leaps, and what to write instead.
LEAPS = {
    "floor_divide": "x // y leaps; write x / y, or end the run by an event where parts differ, and go on from there",
    "remainder": "x % y leaps; where it is to wrap an angle, leave it: sines and cosines do so themselves",
    "divmod": "divmod leaps; end the run by an event where parts differ, and go on from there",
    "sign": f"write x / abs(x), which has no value at 0, or np.tanh(x / width), {WIDTH}, or {SWITCH}",
    "heaviside": "write (1 + x / abs(x)) / 2, which has no value at 0, or (1 + np.tanh(x / width)) / 2, "
    f"{WIDTH}, or {SWITCH}",
} | {name: _WHOLE.format(name) for name in ("floor", "ceil", "trunc", "rint", "round")}
#: What is bent where its arguments meet.
BENT = {"maximum": _LARGER, "fmax": _LARGER, "minimum": _SMALLER, "fmin": _SMALLER}
#: What is the same as another of floats.
OF_FLOATS = {np.fabs: np.absolute, np.float_power: np.power}
#: What NumPy calls otherwise.
NUMPY = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arcsinh": "asinh",
    "arccosh": "acosh",
    "arctanh": "atanh",
}
#: What is made of these, by the name that NumPy calls.
MADE_OF = {
    "cbrt": "_cbrt",
    "exp2": "_exp2",
    "expm1": "_expm1",
    "log1p": "_log1p",
    "log2": "_log2",
    "log10": "_log10",
    "deg2rad": "_radians",
    "radians": "_radians",
    "rad2deg": "_degrees",
    "degrees": "_degrees",
}
#: All of them, as a message lists them.
KNOWN = ", ".join(
    (*FUNCTIONS, "cbrt", "exp2", "expm1", "log1p", "log2", "log10", "deg2rad", "rad2deg", "hypot", "arctan2")
)
UNKNOWN = f"is not known to the compiled core; known: {KNOWN}"
#: What SymPy asks of, to see whether it is an array.
OF_SYMPY = (
    "expected functions of NumPy, such as np.cos, got one that takes its argument for an array or a symbol, as "
    f"sympy.cos does; known: {KNOWN}"
)
