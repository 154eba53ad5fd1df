"""Functions of expressions: those that the core knows, by their names in NumPy."""

from __future__ import annotations

import numpy as np

__all__ = [
    "FUNCTIONS",
    "KNOWN",
    "MADE_OF",
    "NUMPY",
    "OF_FLOATS",
    "OF_SYMPY",
    "UNKNOWN",
]

FUNCTIONS = (
    "sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh",
    "asin", "acos", "atan", "asinh", "acosh", "atanh",
)  # fmt: skip
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
