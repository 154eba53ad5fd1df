"""Expressions as tables of numbers: what forces and potentials of one's own keep, frozen, hashed and filed.

The one idea: what is written here is only a list of nodes; the core derives, compiles and runs it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva._arrays import number
from visviva._keywords import check_call
from visviva._text import count
from visviva.errors import InvalidInput
from visviva.generalized._known_functions import FUNCTIONS
from visviva.generalized._nodes import Expression, Nodes, call_with_expressions, recorded
from visviva.generalized._symbolic import Symbols, sympy, time

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

__all__ = [
    "checked_parameters",
    "distance_table",
    "formulas",
    "has_corners",
    "looks_at_time",
    "looks_at_velocities",
    "most_parameters",
    "parameter_names",
    "parameter_values",
    "table",
]

#: Operations by their numbers in a table; functions come after them.
_OPERATIONS = ("constant", "variable", "parameter", "time", "sum", "product", "quotient", "atan2", "power", *FUNCTIONS)
#: In the place of an operation: the letters of a parameter's name follow.
_NAME = 1000
#: How strongly texts of expressions bind; a minus is before what is else a product.
_SUM, _MINUS, _PRODUCT, _POWER, _ATOM = range(5)
#: Letters of a formula that is still written out.
_LONGEST = 80


def table(nodes: Nodes, roots: list[int], names: tuple[str, ...]) -> list[float]:
    """Write nodes as numbers: how many roots, and which; each node, with its number of arguments; names by letters."""
    numbers: list[float] = [len(roots), *roots]
    for operation, arguments, value in nodes.all:
        numbers += [_OPERATIONS.index(operation), value, len(arguments), *arguments]
    for index, name in enumerate(names):
        numbers += [_NAME, index, len(name), *map(ord, name)]
    return numbers


def parameter_names(numbers: Iterable[float]) -> tuple[str, ...]:
    """Give the names of the parameters that a table has, in the order of their values."""
    return tuple("".join(map(chr, letters)) for operation, _, letters in _rows(numbers) if operation == _NAME)


def most_parameters(numbers: Sequence[float]) -> int:
    """Give a number of parameters that a table has no more of, whether it is one or not."""
    return numbers.count(_NAME)


def parameter_values(numbers: Iterable[float], values: Sequence[float]) -> dict[str, float]:
    """Give the values of the parameters by name; a table that was written by hand may do without names."""
    names = parameter_names(numbers)
    names += tuple(f"values[{index}]" for index in range(len(names), len(values)))
    return dict(zip(names, values, strict=False))


def looks_at_time(numbers: Iterable[float]) -> bool:
    """Whether anything in a table, which has the time in it with or without need, depends on it."""
    return any(_OPERATIONS[operation] == "time" for operation, _ in _needed(numbers))


def looks_at_velocities(numbers: Iterable[float], first: int = 3) -> bool:
    """Whether anything in a table depends on a velocity: its last three variables, of a force from the fourth on."""
    return any(_OPERATIONS[operation] == "variable" and value >= first for operation, value in _needed(numbers))


def has_corners(numbers: Iterable[float]) -> bool:
    """Whether a table has absolute values, which it has as roots of squares: there derivatives jump."""
    nodes = [row for row in _rows(numbers) if row[0] != _NAME]

    def is_square(operation: int, value: float, arguments: Sequence[int]) -> bool:
        if _OPERATIONS[operation] == "product":
            return len(arguments) == 2 and arguments[0] == arguments[1]
        if _OPERATIONS[operation] != "power":
            return False
        exponent = nodes[int(arguments[1])][1] if len(arguments) > 1 else value
        return exponent == 2.0

    roots = (arguments[0] for operation, _, arguments in nodes if _OPERATIONS[operation] == "sqrt")
    return any(is_square(*nodes[int(root)]) for root in roots)


def _needed(numbers: Iterable[float]) -> Iterator[tuple[int, float]]:
    """Operation and value of every node that another one, or the result, is made of."""
    numbers = list(numbers)
    rows = [row for row in _rows(numbers) if row[0] != _NAME]
    needed = {int(at) for at in (*numbers[1 : 1 + int(numbers[0])], *(at for row in rows for at in row[2]))}
    return ((rows[at][0], rows[at][1]) for at in sorted(needed))


def formulas(numbers: Iterable[float], variables: tuple[str, ...], parameters: tuple[str, ...]) -> list[str]:
    """Write the expressions of a table as one reads them; where one is long, how many nodes there are."""
    numbers = list(numbers)
    roots = [int(root) for root in numbers[1 : 1 + int(numbers[0])]]
    rows = [row for row in _rows(numbers) if row[0] != _NAME]
    # Of each node its text and how strongly that binds; nodes are shared, so that only short texts are kept.
    texts: list[tuple[str, int]] = []
    for operation, value, arguments in rows:
        match _OPERATIONS[operation]:
            case "constant":
                texts.append((f"{value:.9g}", _MINUS if value < 0.0 else _ATOM))
            case "variable":
                texts.append((variables[int(value)], _ATOM))
            case "parameter":
                texts.append((parameters[int(value)], _ATOM))
            case "time":
                texts.append(("t", _ATOM))
            case name:
                texts.append(_operation_text(name, [texts[at] for at in arguments]))
        if len(texts[-1][0]) > _LONGEST:
            return [count(len(rows), "node")]
    return [texts[root][0] for root in roots]


def _operation_text(operation: str, arguments: list[tuple[str, int]]) -> tuple[str, int]:
    """The text of an operation, and how strongly it binds."""

    def within(argument: tuple[str, int], least: int) -> str:
        text, binds = argument
        return text if binds >= least else f"({text})"

    # A minus before a factor is one before them all.
    minus = [binds == _MINUS for _, binds in arguments]
    bare = [
        (text[1:], _PRODUCT) if less else (text, binds) for (text, binds), less in zip(arguments, minus, strict=True)
    ]
    sign, level = ("-", _MINUS) if sum(minus) % 2 else ("", _PRODUCT)
    match operation:
        case "sum":
            return " + ".join(text for text, _ in arguments).replace("+ -", "- "), _SUM
        case "product":
            factors = [within(each, _PRODUCT) for each in bare if each[0] != "1"]
            above = [factor for factor in factors if not factor.startswith("1/")] or ["1"]
            above.sort(key=lambda factor: not factor[0].isdigit())  # 2*r, not r*2
            below = [factor[1:] for factor in factors if factor.startswith("1/")]
            return f"{sign}{'*'.join(above)}{''.join(below)}", level
        case "quotient":
            return f"{'-' * minus[0]}{within(bare[0], _PRODUCT)}/{within(arguments[1], _POWER)}", (
                _MINUS if minus[0] else _PRODUCT
            )
        case "power" if minus[1]:
            base, power = within(arguments[0], _ATOM), bare[1][0]
            power = power if power.replace(".", "").isalnum() else f"({power})"
            return f"1/{base}" if power == "1" else f"1/{base}**{power}", _PRODUCT
        case "power":
            return f"{within(arguments[0], _ATOM)}**{within(arguments[1], _ATOM)}", _POWER
        case name:
            return f"{name}({', '.join(text for text, _ in arguments)})", _ATOM


def _rows(numbers: Iterable[float]) -> Iterator[tuple[int, float, list[int]]]:
    """Give the rows of a table after its roots: operation, value, and arguments or letters."""
    given = list(numbers)
    at = 1 + int(given[0])
    while at < len(given):
        length = int(given[at + 2])
        yield int(given[at]), given[at + 1], [int(each) for each in given[at + 3 : at + 3 + length]]
        at += 3 + length


def checked_parameters(
    parameters: Mapping[Any, float] | None, taken: tuple[str, ...]
) -> tuple[tuple[str, ...], list[float]]:
    """Give names and values of parameters, none of which is a name that is taken."""
    if parameters is not None and not hasattr(parameters, "items"):
        kind = type(parameters).__name__
        raise InvalidInput("parameters", f"expected values by parameter, as {{k: 4.0}}, got {kind}")
    given = dict(parameters or {})
    names = tuple(str(key) for key in given)
    for name, key in zip(names, given, strict=True):
        if not name.isidentifier() or name in taken:
            listed = f"{', '.join(taken[:-1])} or {taken[-1]}"
            raise InvalidInput("parameters", f"expected names that are not {listed}, got {key!r}")
    values = [number(f"parameters[{name!r}]", value) for name, value in zip(names, given.values(), strict=True)]
    if len(set(names)) < len(names):
        raise InvalidInput("parameters", f"expected different names, got {list(names)}")
    return names, values


def distance_table(function: Any, parameters: Mapping[Any, float] | None) -> tuple[list[float], list[float]]:
    """Give the table of an expression of r, of SymPy or a function that is called once, and its parameters' values."""
    names, values = checked_parameters(parameters, ("r", "t"))
    nodes = Nodes("distance")
    if hasattr(function, "free_symbols"):
        root = _root_of_symbols(nodes, function, names)
    else:
        check_call("function", function, ("r",), names)
        r, *own = (
            Expression(nodes, nodes.add(operation, (), float(index)))
            for operation, index in [("variable", 0), *(("parameter", index) for index in range(len(names)))]
        )
        result = call_with_expressions(nodes, "function", function, (r,), dict(zip(names, own, strict=True)))
        root = recorded(nodes, result, "function")
    return table(nodes, [root], names), values


def _root_of_symbols(nodes: Nodes, function: Any, names: tuple[str, ...]) -> int:
    sp = sympy("function")
    # Symbols go by their names: what is assumed of them makes others of them.
    found = {symbol.name: symbol for symbol in function.free_symbols}
    plain = {found[name]: sp.Symbol(name) for name in ("r", *names) if name in found}
    if time._sympy_() in function.free_symbols:
        raise InvalidInput("function", "expected an expression of r and of parameters, got one of the time")
    known = Symbols(nodes, [sp.Symbol("r")], [], [sp.Symbol(name) for name in names])
    return known.node("function", function.xreplace(plain))
