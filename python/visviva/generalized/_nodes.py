"""Nodes of expressions: what goes to the core, and the expressions of plain Python that record themselves.

A node is ``(operation, arguments, value)``, its arguments the numbers of nodes before it. Equal nodes are one.
"""

from __future__ import annotations

from inspect import signature
from math import isfinite
from typing import TYPE_CHECKING, Any, NoReturn, SupportsFloat, SupportsIndex, TypeAlias

import numpy as np

from visviva._keywords import known_keywords
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

__all__ = ["FUNCTIONS", "Expression", "Node", "Nodes", "check_call", "recorded"]

Node: TypeAlias = tuple[str, list[int], float]

FUNCTIONS = (
    "sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh",
    "asin", "acos", "atan", "asinh", "acosh", "atanh",
)  # fmt: skip
_NUMPY = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arcsinh": "asinh",
    "arccosh": "acosh",
    "arctanh": "atanh",
}


class Nodes:
    """A growing list of nodes."""

    __slots__ = ("_places", "all")

    def __init__(self) -> None:
        self.all: list[Node] = []
        self._places: dict[tuple[str, tuple[int, ...], float], int] = {}

    def add(self, operation: str, arguments: tuple[int, ...] = (), value: float = 0.0) -> int:
        """Add a node unless it is there, and give its number."""
        key = (operation, arguments, value)
        place = self._places.get(key)
        if place is None:
            place = self._places[key] = len(self.all)
            self.all.append((operation, list(arguments), value))
        return place

    def constant(self, value: float) -> int:
        """Give the number of a constant."""
        return self.add("constant", (), float(value))


@known_keywords
class Expression:
    """A number of a system as an expression: arithmetic and NumPy's functions record what is done with it.

    Given to the function that is passed to `Lagrangian` or `Hamiltonian` in the place of numbers.

    Examples
    --------
    >>> import numpy as np, visviva as vv
    >>> seen = []
    >>> def L(q, v, t):
    ...     seen.append(type(q[0]).__name__)
    ...     return v[0] ** 2 / 2 + np.cos(q[0])
    >>> pendulum = vv.Lagrangian(L, ["theta"], position=[0.1])
    >>> seen[0]
    'Expression'
    """

    __slots__ = ("_nodes", "_place")

    def __init__(self, nodes: Nodes, place: int) -> None:
        self._nodes = nodes
        self._place = place

    def _with(self, operation: str, *others: object, swapped: bool = False) -> Expression:
        places = [self._place]
        for other in others:
            if isinstance(other, Expression):
                places.append(other._place)
            else:
                places.append(self._nodes.constant(_number(other)))
        if swapped:
            places.reverse()
        return Expression(self._nodes, self._nodes.add(operation, tuple(places)))

    def __add__(self, other: object) -> Expression:
        return self._with("sum", other)

    __radd__ = __add__

    def __sub__(self, other: object) -> Expression:
        return self._with("sum", other._with("product", -1.0) if isinstance(other, Expression) else -_number(other))

    def __rsub__(self, other: object) -> Expression:
        return self._with("product", -1.0)._with("sum", other)

    def __mul__(self, other: object) -> Expression:
        return self._with("product", other)

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Expression:
        return self._with("quotient", other)

    def __rtruediv__(self, other: object) -> Expression:
        return self._with("quotient", other, swapped=True)

    def __pow__(self, other: object) -> Expression:
        return self._with("power", other)

    def __rpow__(self, other: object) -> Expression:
        return self._with("power", other, swapped=True)

    def __neg__(self) -> Expression:
        return self._with("product", -1.0)

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return self._with("product", self)._with("sqrt")

    def __bool__(self) -> NoReturn:
        raise InvalidInput("L", "an expression has no truth value: the function must not branch on coordinates")

    def __eq__(self, other: object) -> NoReturn:
        self.__bool__()

    __ne__ = __lt__ = __le__ = __gt__ = __ge__ = __eq__
    __hash__ = object.__hash__

    def __float__(self) -> float:
        raise InvalidInput("L", "an expression is no number: use NumPy's functions, as np.sin, and not those of math")

    def arctan2(self, other: object) -> Expression:
        """Give the angle of the point (other, self) from the first axis: what ``np.arctan2`` calls.

        Parameters
        ----------
        other : Expression or float
            The component along the first axis.

        Returns
        -------
        Expression

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> free = vv.Lagrangian(
        ...     lambda q, v, t: (v[0] ** 2 + v[1] ** 2) / 2 - np.arctan2(q[1], q[0]),
        ...     ["x", "y"], position=[1.0, 0.0])
        >>> free.run(t=[0.0, 1.0]).energy.round(12)
        array([0., 0.])
        """
        return self._with("atan2", other)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        # NumPy asks the first argument for arctan2, which may be a number.
        if ufunc is np.arctan2:
            inputs = tuple(self._with("product", 0.0)._with("sum", x) if np.isscalar(x) else x for x in inputs)
        boxed = (np.asarray(x, dtype=object) if isinstance(x, Expression) else x for x in inputs)
        return getattr(ufunc, method)(*boxed, **options)

    def __getattr__(self, name: str) -> Callable[[], Expression]:
        # np.sin of an object calls its method sin.
        function = _NUMPY.get(name, name)
        if function in FUNCTIONS:
            return lambda: self._with(function)
        if name.startswith("_"):
            raise AttributeError(name)
        raise InvalidInput(
            "L", f"function {name} is not known to the compiled core; known: {', '.join(FUNCTIONS)}, arctan2"
        )


def recorded(nodes: Nodes, value: Any, argument: str) -> int:
    """Give the node of what a function has returned."""
    if isinstance(value, Expression):
        return value._place
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InvalidInput(argument, f"expected one number of the function, got {type(value).__name__}") from None
    return nodes.constant(_finite(argument, number))


def check_call(argument: str, function: Callable[..., Any], places: Iterable[str], keywords: Iterable[str]) -> None:
    """Refuse a function that does not take what it will be called with."""
    places, keywords = tuple(places), tuple(keywords)
    try:
        signature(function).bind(*places, **dict.fromkeys(keywords))
    except TypeError as error:
        called = ", ".join([*places, *(f"{name}=" for name in keywords)])
        raise InvalidInput(argument, f"the function is called with ({called}): {error}") from None
    except ValueError:  # one that does not tell what it takes
        pass


def _number(other: object) -> float:
    """Give what is no expression as a number."""
    if isinstance(other, (SupportsFloat, SupportsIndex)):
        try:
            return _finite("L", float(other))
        except TypeError:  # an array of several
            pass
    raise InvalidInput("L", f"expected arithmetic of numbers and coordinates, got {type(other).__name__} in it")


def _finite(argument: str, number: float) -> float:
    if not isfinite(number):
        raise InvalidInput(argument, f"expected finite numbers, got {number} in it")
    return number
