"""Nodes of expressions: what goes to the core, and the expressions of plain Python that record themselves.

A node is ``(operation, arguments, value)``, its arguments the numbers of nodes before it. Equal nodes are one.
"""

from __future__ import annotations

from math import isfinite, log, pi
from typing import TYPE_CHECKING, Any, NoReturn, SupportsFloat, SupportsIndex, TypeAlias

import numpy as np

from visviva._keywords import known_keywords
from visviva._text import note_once
from visviva.errors import InvalidInput
from visviva.generalized._known_functions import (
    FUNCTIONS,
    KNOWN,
    MADE_OF,
    NUMPY,
    OF_FLOATS,
    OF_SYMPY,
    UNKNOWN,
)
from visviva.generalized._switches import instead, switches

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from visviva.generalized._switches import Purpose

__all__ = ["Expression", "Node", "Nodes", "call_with_expressions", "expression_array", "not_compiled", "recorded"]

Node: TypeAlias = tuple[str, list[int], float]


class Nodes:
    """A growing list of nodes."""

    __slots__ = ("_places", "all", "argument", "purpose")

    def __init__(self, purpose: Purpose = "motion") -> None:
        self.all: list[Node] = []
        self.purpose: Purpose = purpose
        #: What is written down: the argument that errors name.
        self.argument = "L"
        self._places: dict[tuple[str, tuple[int, ...], float], int] = {}

    def add(self, operation: str, arguments: tuple[int, ...] = (), value: float = 0.0) -> int:
        """Add a node unless it is there, and give its number."""
        key = (operation, arguments, value)
        place = self._places.get(key)
        if place is None:
            place = self._places[key] = len(self.all)
            self.all.append((operation, list(arguments), value))
        return place

    def reached(self, roots: Iterable[int]) -> list[int]:
        """Give the numbers of all nodes that some are made of, arguments first."""
        found: set[int] = set()
        pending = list(roots)
        while pending:
            place = pending.pop()
            if place not in found:
                found.add(place)
                pending.extend(self.all[place][1])
        return sorted(found)

    def part(self, roots: Sequence[int]) -> tuple[list[Node], list[int]]:
        """Give a list of those alone, and the numbers of the roots in it."""
        places = self.reached(roots)
        at = {place: number for number, place in enumerate(places)}
        part = [(self.all[place][0], [at[each] for each in self.all[place][1]], self.all[place][2]) for place in places]
        return part, [at[root] for root in roots]

    def constant(self, value: float) -> int:
        """Give the number of a constant."""
        return self.add("constant", (), float(value))


@known_keywords
class Expression:
    """A number of a system as an expression: arithmetic and NumPy's functions record what is done with it.

    Given to the function that is passed to `Lagrangian` or `Hamiltonian` in the place of numbers.

    References
    ----------
    A. Griewank & A. Walther, *Evaluating Derivatives*, 2nd ed. (2008).

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

    def __repr__(self) -> str:
        operation, _, value = self._nodes.all[self._place]
        return f"Expression({value:g})" if operation == "constant" else f"Expression({operation})"

    def _with(self, operation: str, *others: object, swapped: bool = False) -> Expression:
        places = [self._place]
        for other in others:
            if isinstance(other, Expression):
                places.append(other._place)
            else:
                places.append(self._nodes.constant(self._number(other)))
        if swapped:
            places.reverse()
        return Expression(self._nodes, self._nodes.add(operation, tuple(places)))

    def __add__(self, other: object) -> Expression:
        if _is_array(other):
            return NotImplemented  # the array does it number by number
        return self._with("sum", other)

    __radd__ = __add__

    def __sub__(self, other: object) -> Expression:
        if _is_array(other):
            return NotImplemented  # the array does it number by number
        if isinstance(other, Expression):
            return self._with("sum", other._with("product", -1.0))
        return self._with("sum", -self._number(other))

    def __rsub__(self, other: object) -> Expression:
        return self._with("product", -1.0)._with("sum", other)

    def __mul__(self, other: object) -> Expression:
        if _is_array(other):
            return NotImplemented  # the array does it number by number
        return self._with("product", other)

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Expression:
        if _is_array(other):
            return NotImplemented  # the array does it number by number
        return self._with("quotient", other)

    def __rtruediv__(self, other: object) -> Expression:
        return self._with("quotient", other, swapped=True)

    def __pow__(self, other: object) -> Expression:
        if _is_array(other):
            return NotImplemented  # the array does it number by number
        return self._with("power", other)

    def __rpow__(self, other: object) -> Expression:
        return self._with("power", other, swapped=True)

    def __neg__(self) -> Expression:
        return self._with("product", -1.0)

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return self._with("product", self)._with("sqrt")

    def _leaps(self, name: str) -> NoReturn:
        raise self._refused(f"{name} has no derivatives where it leaps: {instead(name, self._nodes.purpose)}")

    def _refused(self, message: str) -> InvalidInput:
        return InvalidInput(self._nodes.argument, message)

    def _number(self, other: object) -> float:
        """Give what is no expression as a number."""
        if isinstance(other, (SupportsFloat, SupportsIndex)):
            try:
                return _finite(self._nodes.argument, float(other))
            except TypeError:  # an array of several
                pass
        raise self._refused(f"expected arithmetic of numbers and coordinates, got {type(other).__name__} in it")

    def __floordiv__(self, other: object) -> NoReturn:
        self._leaps("floor_divide")

    def __mod__(self, other: object) -> NoReturn:
        self._leaps("remainder")

    def __divmod__(self, other: object) -> NoReturn:
        self._leaps("divmod")

    __rfloordiv__, __rmod__, __rdivmod__ = __floordiv__, __mod__, __divmod__

    # What NumPy's functions of these names call, as np.cbrt.

    def _cbrt(self) -> Expression:
        return self * abs(self) ** (-2.0 / 3.0)

    def _exp2(self) -> Expression:
        return (self * log(2.0))._with("exp")

    # Both by identities in which nothing cancels: tanh(x/2) (e^x + 1), and sinh(log(1 + x)) = (x/2) (1 + 1/(1 + x)).

    def _expm1(self) -> Expression:
        return (0.5 * self)._with("tanh") * (self._with("exp") + 1.0)

    def _log1p(self) -> Expression:
        return (0.5 * self * (1.0 + 1.0 / (1.0 + self)))._with("asinh")

    def _log2(self) -> Expression:
        return self._with("log") / log(2.0)

    def _log10(self) -> Expression:
        return self._with("log") / log(10.0)

    def _radians(self) -> Expression:
        return self * (pi / 180.0)

    def _degrees(self) -> Expression:
        return self * (180.0 / pi)

    def hypot(self, other: object) -> Expression:
        """Give the length of the vector (self, other): what ``np.hypot`` calls.

        Units: those of both components.

        Parameters
        ----------
        other : Expression or float
            The other component.

        Returns
        -------
        Expression

        Raises
        ------
        InvalidInput
            If `other` is no finite number and no expression.

        Examples
        --------
        >>> import numpy as np, visviva as vv
        >>> cone = vv.Lagrangian(
        ...     lambda q, v, t: v @ v / 2 - np.hypot(q[0], q[1]), ["x", "y"], position=[3.0, 4.0])
        >>> cone.energy
        5.0
        """
        squares = self._with("product", self)._with("sum", self._with("product", 0.0)._with("sum", other) ** 2)
        return squares._with("sqrt")

    def __bool__(self) -> NoReturn:
        raise self._refused(
            "an expression has no truth value: the function must not branch on coordinates, nor use np.where; "
            f"max(x, y) is (x + y + abs(x - y)) / 2; {instead('where', self._nodes.purpose)}"
        )

    def __eq__(self, other: object) -> NoReturn:
        self.__bool__()

    __ne__ = __lt__ = __le__ = __gt__ = __ge__ = __eq__
    __hash__ = object.__hash__

    def __float__(self) -> float:
        raise self._refused(
            "an expression is no number: use NumPy's functions, as np.sin, and not those of math or tables, "
            "as np.interp, in whose place stands a formula: a polynomial or a sum of sines fitted to them"
        )

    def _rounded(self, *_: object) -> NoReturn:
        self._leaps("round")

    # What round, math.floor, math.ceil and math.trunc, and NumPy's functions of these names, call.
    __round__ = __floor__ = __ceil__ = __trunc__ = _rounded

    def arctan2(self, other: object) -> Expression:
        """Give the angle of the point (other, self) from the first axis, in radians: what ``np.arctan2`` calls.

        Parameters
        ----------
        other : Expression or float
            The component along the first axis.

        Returns
        -------
        Expression
            A number of the system, shape ().

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
        name = ufunc.__name__
        if name in ("maximum", "minimum", "fmax", "fmin"):
            raise self._refused(
                f"{name} is bent where its arguments meet, and the function must not branch on coordinates; "
                f"{instead(name, self._nodes.purpose)}"
            )
        if switches(name):
            self._leaps(name)
        ufunc = OF_FLOATS.get(ufunc, ufunc)
        # NumPy asks the first argument for these, which may be a number.
        if ufunc in (np.arctan2, np.hypot):
            inputs = tuple(self._with("product", 0.0)._with("sum", x) if np.isscalar(x) else x for x in inputs)
        boxed = (np.asarray(x, dtype=object) if isinstance(x, Expression) else x for x in inputs)
        return getattr(ufunc, method)(*boxed, **options)

    def __getattr__(self, name: str) -> Callable[[], Expression]:
        # np.sin of an object calls its method sin.
        function = NUMPY.get(name, name)
        if function in FUNCTIONS:
            return lambda: self._with(function)
        if name in MADE_OF:
            made: Callable[[], Expression] = object.__getattribute__(self, MADE_OF[name])
            return made
        if name.startswith("_"):
            raise AttributeError(name)
        raise self._refused(OF_SYMPY if name == "flat" else f"function {name} {UNKNOWN}")


def not_compiled(function: Callable[..., Any]) -> Callable[..., Any]:
    """Give the Python function that one of Numba, which takes numbers only, was made of; any other as it is."""
    written: Callable[..., Any] = getattr(function, "py_func", function)
    return written


def call_with_expressions(
    nodes: Nodes, argument: str, function: Callable[..., Any], numbers: tuple[Any, ...], values: dict[str, Any]
) -> Any:
    """Call a function with expressions: what cannot be done with them is refused by name.

    Errors of one's own stay what they are, with a note of where they come from.
    """
    nodes.argument = argument
    function = not_compiled(function)
    try:
        return function(*numbers, **values)
    except InvalidInput:
        raise
    except Exception as error:
        size = getattr(numbers[0], "size", None) if isinstance(error, IndexError) else None
        if size is not None and f"out of bounds for axis 0 with size {size}" in str(error):
            last = f"{size} numbers, the last at [{size - 1}]" if size > 1 else "1 number, at [0]"
            raise InvalidInput(argument, f"{error}: positions and velocities have {last}") from error
        if not isinstance(error, TypeError) or not any(word in str(error) for word in ("ufunc", "Expression")):
            name = getattr(function, "__qualname__", type(function).__qualname__)
            note_once(error, f"{argument}: raised in {name}, which is called with expressions in the place of numbers")
            raise
        name = str(error).partition("ufunc '")[2].partition("'")[0]
        cure = f"; {instead(name, nodes.purpose)}" if switches(name) else ""
        raise InvalidInput(argument, f"{error}{cure}. Functions that the core knows: {KNOWN}") from error


def recorded(nodes: Nodes, value: Any, argument: str) -> int:
    """Give the node of what a function has returned."""
    if isinstance(value, np.ndarray) and value.shape == () and value.dtype == object:
        value = value[()]
    if isinstance(value, Expression):
        return value._place
    try:
        number = float(value)
    except (TypeError, ValueError):
        cure = "" if np.ndim(value) == 0 else "; places and velocities come as arrays, whose parts are r[0], r[1], …"
        came = type(value).__name__
        raise InvalidInput(argument, f"expected one number of the function, got {came}{cure}") from None
    return nodes.constant(_finite(argument, number))


def expression_array(expressions: Iterable[Expression]) -> NDArray[np.object_]:
    """Give expressions as an array, which has arithmetic of its own: ``v @ v``, ``q - q0``."""
    listed = list(expressions)
    numbers = np.empty(len(listed), dtype=object)
    numbers[:] = listed
    return numbers


def _is_array(other: object) -> bool:
    return isinstance(other, np.ndarray) and other.ndim > 0


def _finite(argument: str, number: float) -> float:
    if not isfinite(number):
        raise InvalidInput(argument, f"expected finite numbers, got {number} in it")
    return number
