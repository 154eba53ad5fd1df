"""What rounding may do to expressions, at most: errors that are carried from node to node.

The one idea: an operation passes on what its arguments are off by, and adds a rounding of its own. So what was lost on
the way is known, also where the result does not show it: 1/cosh² of a large number from 1 − tanh², or 0 as one over
what has left the range of numbers.
N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed. (2002), 3.1 and 3.3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from visviva.generalized._nodes import Expression

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from visviva.generalized._calculus import Calculus

__all__ = ["rounding_of"]

#: What an operation adds, as a part of its result: a rounding and, of functions, what they are off by.
_OWN = 2.0 * float(np.finfo(float).eps)
#: And where that is below the range of numbers.
_TINY = 1e-323
#: An argument that is off by more than this part of itself says nothing of a function of it.
_LOST = 0.25


def rounding_of(
    c: Calculus, expressions: Sequence[Expression], t: NDArray[np.float64], states: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give what values (N, k) at times (N) and states (N, 2n) are off by at most; inf where nothing is known."""
    nodes = c._nodes
    reached = nodes.reached(each._place for each in expressions)
    with np.errstate(all="ignore"):
        values = c.values([Expression(nodes, place) for place in reached], t, states, c._system._values).T
        at = dict(zip(reached, values, strict=True))
        off: dict[int, NDArray[np.float64]] = {}
        for place in reached:
            operation, arguments, _ = nodes.all[place]
            value = at[place]
            if not arguments:
                off[place] = np.zeros(len(value))
                continue
            error = _passed_on(operation, [at[each] for each in arguments], [off[each] for each in arguments], value)
            error = error + _OWN * (np.abs(value) + error) + _TINY
            off[place] = np.where(np.isfinite(value) & np.isfinite(error), error, np.inf)
    return np.array([off[each._place] for each in expressions]).T


def _passed_on(
    operation: str, x: list[NDArray[np.float64]], e: list[NDArray[np.float64]], value: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give by how much the result is off as its arguments are; NaN where that has no end."""
    size = [np.abs(each) for each in x]
    if operation == "sum":
        # Each of the additions rounds what is no more than all of them.
        return np.asarray(sum(e) + _OWN * sum(size))
    if operation == "product":
        most = np.prod([a + b for a, b in zip(size, e, strict=True)], axis=0)
        return np.asarray(most - np.prod(size, axis=0) + len(x) * _OWN * most)
    if operation == "quotient":
        least = size[1] - e[1]
        return np.where(least > 0.0, (size[0] + e[0]) / least - size[0] / size[1], np.nan)
    if operation == "power":
        # Of a constant exponent, which is not off.
        exponent = x[1]
        other = np.where(exponent > 0.0, size[0] + e[0], size[0] - e[0])
        return np.where(other >= 0.0, np.abs(other**exponent - np.abs(value)), np.nan)
    if operation == "atan2":
        far = np.hypot(size[0], size[1])
        return np.where(e[0] + e[1] <= _LOST * far, 2.0 * (e[0] + e[1]) / far, np.nan)
    return e[0] * _steepest(operation, size[0], e[0], np.abs(value))


def _steepest(
    function: str, x: NDArray[np.float64], e: NDArray[np.float64], value: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give the greatest slope of a function within e of an argument of that size; NaN if it may have none there."""
    near, far = np.maximum(x - e, 0.0), x + e
    if function in {"sin", "cos"}:
        return np.ones_like(x)
    if function in {"atan", "asinh"}:
        return 1.0 / np.hypot(1.0, near) ** (2.0 if function == "atan" else 1.0)
    if function in {"sinh", "cosh"}:
        return np.cosh(far)
    if function in {"tanh", "sech_squared"}:
        return np.minimum(1.0, 8.0 * np.exp(-2.0 * near))
    if function == "exp":
        return np.where(e <= 1.0, 3.0 * value, np.nan)
    if function == "log":
        return np.where(near > 0.0, 1.0 / near, np.nan)
    if function == "sqrt":
        return np.where(x > 0.0, 1.0 / np.sqrt(x), np.nan)
    if function == "tan":
        return np.where(e * (1.0 + value) <= _LOST, 2.0 * (1.0 + value * value), np.nan)
    if function in {"asin", "acos"}:
        return np.where(far < 1.0, 1.0 / np.sqrt(1.0 - far * far), np.nan)
    if function == "acosh":
        return np.where(near > 1.0, 1.0 / np.sqrt(near * near - 1.0), np.nan)
    if function == "atanh":
        return np.where(far < 1.0, 1.0 / (1.0 - far * far), np.nan)
    # What is not known here is not known to be right.
    return np.full_like(x, np.nan)
