"""SymPy's trees as nodes, and nodes as SymPy's trees. SymPy is asked for nothing else: it derives nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias, cast

from visviva._keywords import known_keywords
from visviva._packages import needed
from visviva.errors import InvalidInput
from visviva.generalized._known_functions import FUNCTIONS
from visviva.generalized._switches import instead

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from sympy import Symbol

    from visviva.generalized._nodes import Node, Nodes

__all__ = [
    "Symbols",
    "coordinate",
    "free_name",
    "named_symbols",
    "rates_of",
    "symbols_of_names",
    "sympy",
    "time",
    "trees",
]

#: Symbols of coordinates, of velocities or momenta, and of parameters.
_Groups: TypeAlias = tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]]

#: What is wrong with what switches, by what an expression is for.
_SWITCHES = {
    "motion": "switches inside a step, where no method keeps its order",
    "question": "has no derivatives where it switches",
    "distance": "switches, which no formula does",
}


def sympy(argument: str = "L") -> Any:
    """Give the module, or say how to get it, naming the argument that needs it."""
    return needed("sympy", argument, "symbolic", "pass a function of (position, velocity, t)")


def free_name(name: str, taken: Collection[str]) -> str:
    """Give a name that is nobody else's: p_x, or p_x_ beside a parameter of that name."""
    while name in taken:
        name += "_"
    return name


#: SymPy's symbol of the time, once it was asked for.
_OF_TIME: list[Any] = []


class _Time:
    """The time, as SymPy's symbol ``t`` wherever an expression meets it."""

    __slots__ = ()

    def _sympy_(self) -> Any:
        if not _OF_TIME:
            _OF_TIME.append(sympy().Symbol("t"))
        return _OF_TIME[0]

    def __repr__(self) -> str:
        return "t"

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._sympy_(), name)

    def __reduce__(self) -> str:
        return "time"

    def __eq__(self, other: object) -> bool:
        return other is self or bool(self._sympy_() == other)

    def __hash__(self) -> int:
        return hash("t")

    def __add__(self, other: object) -> Any:
        return self._sympy_() + other

    __radd__ = __add__

    def __sub__(self, other: object) -> Any:
        return self._sympy_() - other

    def __rsub__(self, other: object) -> Any:
        return other - self._sympy_()

    def __mul__(self, other: object) -> Any:
        return self._sympy_() * other

    __rmul__ = __mul__

    def __truediv__(self, other: object) -> Any:
        return self._sympy_() / other

    def __rtruediv__(self, other: object) -> Any:
        return other / self._sympy_()

    def __pow__(self, other: object) -> Any:
        return self._sympy_() ** other

    def __rpow__(self, other: object) -> Any:
        return other ** self._sympy_()

    def __neg__(self) -> Any:
        return -self._sympy_()

    def __lt__(self, other: object) -> Any:
        return self._sympy_() < other

    def __le__(self, other: object) -> Any:
        return self._sympy_() <= other

    def __gt__(self, other: object) -> Any:
        return self._sympy_() > other

    def __ge__(self, other: object) -> Any:
        return self._sympy_() >= other


# What it is to SymPy, wherever it meets an expression.
time: Symbol = cast("Any", _Time())


@known_keywords
def coordinate(names: str) -> Any:
    """Generalized coordinates: functions of the time, as SymPy's ``dynamicsymbols`` makes them.

    Parameters
    ----------
    names : str
        One name, or several parted by spaces or commas.

    Returns
    -------
    sympy.Function or tuple of them
        ``theta``; its velocity is ``theta.diff(vv.time)``.

    Raises
    ------
    InvalidInput
        Without SymPy, or for what is no name.

    Examples
    --------
    >>> import visviva as vv
    >>> theta = vv.coordinate("theta")
    >>> theta.diff(vv.time)
    Derivative(theta(t), t)
    """
    if not isinstance(names, str) or not names.replace(",", " ").split():
        raise InvalidInput("names", f"expected the name of a coordinate, got {names!r}")
    for name in names.replace(",", " ").split():
        if not name.isidentifier() or name == "t":
            raise InvalidInput("names", f"expected names as theta, and not t, which is the time, got {name!r}")
    sp = sympy("names")
    made = tuple(sp.Function(name)(sp.Symbol("t")) for name in names.replace(",", " ").split())
    return made[0] if len(made) == 1 else made


def rates_of(coordinates: Iterable[Any]) -> tuple[Any, ...]:
    """Give the derivatives of functions of the time, as ``theta.diff(vv.time)`` does more slowly."""
    derivative, t = sympy().Derivative, time._sympy_()
    return tuple(derivative(each, t, evaluate=False) for each in coordinates)


class Symbols:
    """What the symbols of an expression mean, and the walk from its tree to nodes.

    Velocities that are None are the derivatives of the coordinates.
    """

    def __init__(
        self, nodes: Nodes, coordinates: Sequence[Any], velocities: Sequence[Any] | None, parameters: Iterable[Any]
    ) -> None:
        self._sympy = sympy()
        self._nodes = nodes
        self._time = time._sympy_()
        self._known: dict[Any, int] = {self._time: nodes.add("time")}
        self._coordinates = tuple(coordinates)
        n = len(self._coordinates)
        for index, symbol in enumerate(parameters):
            self._known[symbol] = nodes.add("parameter", (), float(index))
        for index, symbol in enumerate(self._coordinates):
            self._known[symbol] = nodes.add("variable", (), float(index))
        self._rates: dict[Any, int] = {}
        of, keys = (self._rates, self._coordinates) if velocities is None else (self._known, velocities)
        for index, key in enumerate(keys):
            of[key] = nodes.add("variable", (), float(n + index))

    def node(self, argument: str, expression: Any) -> int:
        """Give the node of an expression."""
        sp = self._sympy
        if isinstance(expression, str):
            raise InvalidInput(
                argument, f"expected an expression, got the text {expression!r}; sympy.sympify makes one of it"
            )
        try:
            tree = sp.sympify(expression, strict=True)
        except sp.SympifyError:
            raise InvalidInput(argument, f"expected an expression of SymPy, got {type(expression).__name__}") from None
        if isinstance(tree, sp.MatrixBase) or not isinstance(tree, sp.Expr):
            raise InvalidInput(argument, f"expected a scalar expression, got {type(tree).__name__}")
        try:
            return self._walk(argument, tree)
        except RecursionError:
            raise InvalidInput(
                argument, "the expression is nested too deeply; write it as a function of (position, velocity, t)"
            ) from None

    def _walk(self, argument: str, tree: Any) -> int:
        place = self._known.get(tree)
        if place is None:
            place = self._known[tree] = self._new_node(argument, tree)
        return place

    def _new_node(self, argument: str, tree: Any) -> int:
        sp, nodes, known = self._sympy, self._nodes, self._known
        if tree.is_Add or tree.is_Mul or tree.is_Pow:
            operation = "sum" if tree.is_Add else "product" if tree.is_Mul else "power"
            places = []
            for part in tree.args:  # as `_walk`, which would be called for every part, most of them known
                place = known.get(part)
                if place is None:
                    place = known[part] = self._new_node(argument, part)
                places.append(place)
            return nodes.add(operation, tuple(places))
        if tree.is_Number or tree.is_NumberSymbol:
            value = _number_of(tree)
            if value.imag or value.real != value.real or abs(value.real) == float("inf"):
                raise InvalidInput(argument, f"expected finite real numbers, got {tree}")
            return nodes.constant(value.real)
        if tree is sp.I:
            raise InvalidInput(argument, "expected real numbers, got I in it")
        if tree.is_Symbol and tree.name == self._time.name:
            # The time, whatever is assumed of it.
            return self._known[self._time]
        if tree.is_Symbol:
            raise InvalidInput(argument, f"free symbol {str(tree)!r} has no value; pass parameters={{{tree}: …}}")
        if isinstance(tree, sp.Derivative):
            inner, *by = tree.args
            if inner in self._rates and by == [(self._time, 1)]:
                return self._rates[inner]
            raise self._derivative(argument, tree)
        name = type(tree).__name__
        if name in FUNCTIONS:
            return nodes.add(name, (self._walk(argument, tree.args[0]),))
        if isinstance(tree, sp.atan2):
            return nodes.add("atan2", tuple(self._walk(argument, part) for part in tree.args))
        if isinstance(tree, sp.Abs):
            inner = self._walk(argument, tree.args[0])
            return nodes.add("sqrt", (nodes.add("product", (inner, inner)),))
        if isinstance(tree, (sp.cot, sp.sec, sp.csc, sp.coth, sp.sech, sp.csch)):
            return self._walk(argument, self._inverse(tree))
        if isinstance(tree, (sp.Piecewise, sp.Heaviside, sp.Max, sp.Min, sp.sign, sp.floor, sp.ceiling)):
            raise InvalidInput(
                argument, f"{name} {_SWITCHES[nodes.purpose]}; {instead(name, nodes.purpose, symbols=True)}"
            )
        if isinstance(tree, sp.core.function.AppliedUndef):
            raise InvalidInput(
                argument,
                f"{tree} is not among the coordinates {list(self._coordinates)}; add it, or put a value in its place",
            )
        raise InvalidInput(
            argument, f"function {name} is not known to the compiled core; known: {', '.join(FUNCTIONS)}, atan2, Abs"
        )

    def _inverse(self, tree: Any) -> Any:
        sp = self._sympy
        of = {sp.cot: sp.tan, sp.sec: sp.cos, sp.csc: sp.sin, sp.coth: sp.tanh, sp.sech: sp.cosh, sp.csch: sp.sinh}
        return 1 / of[type(tree)](*tree.args)

    def _derivative(self, argument: str, tree: Any) -> InvalidInput:
        inner = tree.args[0]
        if inner in self._coordinates and tree.derivative_count > 1:
            return InvalidInput(
                argument, f"the second derivative of {inner} is in it: only first ones make equations of motion"
            )
        if inner in self._coordinates:
            return InvalidInput(
                argument,
                f"{tree} is in it, a function of coordinates and momenta: write the velocity in terms of these",
            )
        if isinstance(inner, self._sympy.core.function.AppliedUndef):
            return InvalidInput(
                argument, f"{tree} is in it, but {inner} is not among the coordinates {list(self._coordinates)}; add it"
            )
        return InvalidInput(argument, f"{tree} is not carried out; call its doit() first")


def _number_of(tree: Any) -> complex:
    """Give the number that a tree without symbols is; of whole ones the quotient, which SymPy cuts before it rounds."""
    if tree.is_Float:
        return complex(float(tree))
    if tree.is_Rational:
        try:
            return complex(int(tree.p) / int(tree.q))
        except OverflowError:
            return complex(tree)
    return complex(tree)


def trees(
    nodes: Sequence[Node], roots: Sequence[int], variables: Sequence[Any], parameters: Sequence[Any]
) -> list[Any]:
    """Give SymPy's trees of nodes; numbers that are whole are shown as such."""
    sp = sympy()
    made: list[Any] = []
    for operation, arguments, value in nodes:
        of = [made[argument] for argument in arguments]
        match operation:
            case "constant":
                made.append(
                    sp.Integer(int(value)) if value == int(value) and abs(value) < 1e15 else _fraction(sp, value)
                )
            case "variable":
                made.append(variables[int(value)])
            case "parameter":
                made.append(parameters[int(value)])
            case "time":
                made.append(time._sympy_())
            case "sum":
                made.append(sp.Add(*of))
            case "product":
                made.append(sp.Mul(*of))
            case "quotient":
                made.append(of[0] / of[1])
            case "power":
                made.append(sp.Pow(*of))
            case "sech_squared":
                made.append(sp.sech(*of) ** 2)
            case _:
                made.append(getattr(sp, operation)(*of))
    return [made[root] for root in roots]


def _fraction(sp: Any, value: float) -> Any:
    """Give a small fraction where that is the very number."""
    fraction = sp.Rational(value).limit_denominator(10**4)
    return fraction if float(fraction) == value else sp.Float(value)


def named_symbols(symbols: _Groups) -> list[list[dict[str, Any]]] | None:
    """Give symbols as JSON has them, in their groups; None if names would not make the very same."""
    kept = [[_named(each) for each in group] for group in symbols]
    return kept if symbols_of_names(kept) == symbols else None


def _named(symbol: Any) -> dict[str, Any]:
    sp = sympy()
    if isinstance(symbol, sp.Derivative):
        return {"velocity": _named(symbol.args[0])}
    if isinstance(symbol, sp.core.function.AppliedUndef):
        return {"function": symbol.func.__name__}
    return {"symbol": str(symbol), "assumptions": getattr(symbol, "assumptions0", {})}


def symbols_of_names(kept: list[list[dict[str, Any]]]) -> _Groups | None:
    """Give the symbols that `named_symbols` kept; None without SymPy, which nothing but expressions needs."""
    try:
        sp = sympy()
    except InvalidInput:
        return None

    def symbol_of(each: dict[str, Any]) -> Any:
        if "velocity" in each:
            return symbol_of(each["velocity"]).diff(time._sympy_())
        if "function" in each:
            return sp.Function(str(each["function"]))(time._sympy_())
        return sp.Symbol(str(each["symbol"]), **each["assumptions"])

    first, second, parameters = (tuple(symbol_of(each) for each in group) for group in kept)
    return first, second, parameters
