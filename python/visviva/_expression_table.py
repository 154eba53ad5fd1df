"""Expressions as tables of numbers: what forces and potentials of one's own keep, frozen, hashed and filed.

The one idea: what is written here is only a list of nodes; the core derives, compiles and runs it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from visviva._arrays import number
from visviva._keywords import check_call
from visviva.errors import InvalidInput
from visviva.generalized._nodes import FUNCTIONS, Expression, Nodes, called, recorded
from visviva.generalized._symbolic import Symbols, sympy, time

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = ["named", "of_distance", "parameter_names", "table"]

#: Operations by their numbers in a table; functions come after them.
_OPERATIONS = ("constant", "variable", "parameter", "time", "sum", "product", "quotient", "atan2", "power", *FUNCTIONS)
#: In the place of an operation: the letters of a parameter's name follow.
_NAME = 1000


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
    given = [int(number) for number in numbers]
    names, at = [], 1 + given[0]
    while at < len(given):
        operation, _, count = given[at : at + 3]
        if operation == _NAME:
            names.append("".join(map(chr, given[at + 3 : at + 3 + count])))
        at += 3 + count
    return tuple(names)


def named(parameters: Mapping[Any, float] | None, taken: tuple[str, ...]) -> tuple[tuple[str, ...], list[float]]:
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


def of_distance(function: Any, parameters: Mapping[Any, float] | None) -> tuple[list[float], list[float]]:
    """Give the table of an expression of r, of SymPy or a function that is called once, and its parameters' values."""
    names, values = named(parameters, ("r", "t"))
    nodes = Nodes()
    if hasattr(function, "free_symbols"):
        root = _of_symbols(nodes, function, names)
    else:
        check_call("function", function, ("r",), names)
        r, *own = (
            Expression(nodes, nodes.add(operation, (), float(index)))
            for operation, index in [("variable", 0), *(("parameter", index) for index in range(len(names)))]
        )
        result = called(nodes, "function", function, (r,), dict(zip(names, own, strict=True)))
        root = recorded(nodes, result, "function")
    return table(nodes, [root], names), values


def _of_symbols(nodes: Nodes, function: Any, names: tuple[str, ...]) -> int:
    sp = sympy("function")
    # Symbols go by their names: what is assumed of them makes others of them.
    found = {symbol.name: symbol for symbol in function.free_symbols}
    plain = {found[name]: sp.Symbol(name) for name in ("r", *names) if name in found}
    if time._sympy_() in function.free_symbols:
        raise InvalidInput("function", "expected an expression of r and of parameters, got one of the time")
    known = Symbols(nodes, [sp.Symbol("r")], [], [sp.Symbol(name) for name in names])
    return known.node("function", function.xreplace(plain))
