"""From what a user says of a system to what the core takes: names, parameters, and nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from inspect import Parameter, signature
from typing import Any

from visviva._arrays import number
from visviva._keywords import check_call
from visviva.errors import InvalidInput
from visviva.generalized._nodes import Expression, Nodes, call_with_expressions, expression_array, recorded
from visviva.generalized._symbolic import Symbols, rates_of, sympy, time

__all__ = ["Source", "calls", "described", "placed_arguments", "refuse_missing_values", "refuse_other_arguments"]

#: What the second half of a state is.
_SECOND = {"lagrangian": "velocity", "hamiltonian": "momentum"}
_SECOND_ARGUMENT = {"lagrangian": "velocities", "hamiltonian": "p"}


@dataclass(frozen=True, slots=True)
class Source:
    """A system as the core takes it, and the names of what is in it."""

    kind: str
    names: tuple[str, ...]
    #: Symbols of coordinates, of velocities or momenta, and of parameters; None of a function of Python. Velocities
    #: that are the derivatives of the coordinates are None here: to make them takes time.
    groups: tuple[tuple[Any, ...], tuple[Any, ...] | None, tuple[Any, ...]] | None
    parameters: tuple[str, ...]
    description: dict[str, Any]
    #: Of coordinates, time and parameters, the points that a picture shows; None where nobody said.
    points: Callable[..., Any] | None = None

    @property
    def symbols(self) -> tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...]] | None:
        """All symbols, velocities among them."""
        if self.groups is None:
            return None
        first, second, parameters = self.groups
        return first, rates_of(first) if second is None else second, parameters

    def nodes(self, argument: str, expressions: Iterable[Any]) -> tuple[list[Any], list[int]]:
        """Give further expressions of the same state as nodes and their places."""
        nodes = Nodes("question")
        walk = self._walk(nodes)
        roots = [walk(argument, expression) for expression in expressions]
        return nodes.all, roots

    def _walk(self, nodes: Nodes) -> Callable[[str, Any], int]:
        if self.groups is None:
            return calls(nodes, self.names, self.parameters, _SECOND[self.kind])
        return Symbols(nodes, *self.groups).node


def described(
    kind: str,
    function: Any,
    coordinates: Any,
    second: Any,
    parameters: Mapping[Any, Any] | None,
    further: dict[str, Any],
) -> tuple[Source, list[Any]]:
    """Describe a system; its parameters' values come along.

    ``further`` holds forces (of coordinates), dissipation, holonomic and nonholonomic constraints.
    """
    given = dict(parameters) if isinstance(parameters, Mapping) else {} if parameters is None else None
    if given is None:
        raise InvalidInput(
            "parameters", f"expected values by parameter, as {{g: 9.81}}, got {type(parameters).__name__}"
        )
    listed = _listed("coordinates" if kind == "lagrangian" else "q", coordinates)
    argument = "L" if kind == "lagrangian" else "H"
    nodes = Nodes()
    if callable(function) and not hasattr(function, "free_symbols"):
        names = tuple(_name(each) for each in listed)
        keys = tuple(_name(each) for each in given)
        groups = None
        walk = calls(nodes, names, keys, _SECOND[kind])
    else:
        sp = sympy(argument)
        t = time._sympy_()
        first = tuple([_coordinate(sp, t, each) for each in listed])
        others = _second(sp, kind, first, second)
        names = tuple([_label(each) for each in first])
        keys = tuple([_name(each) for each in given])
        parameter_symbols = tuple([_parameter(sp, t, each, function) for each in given])
        groups = (first, others, parameter_symbols)
        walk = Symbols(nodes, first, others, parameter_symbols).node
    for what, each in (("coordinates", names), ("parameters", keys)):
        if len(set(each)) < len(each):
            raise InvalidInput(what, f"expected different names, got {list(each)}")
    if "t" in keys:
        raise InvalidInput("parameters", "t is the time; give the parameter another name")
    if "t" in names:
        raise InvalidInput("coordinates", "t is the time; give the coordinate another name")
    shared = [key for key in keys if key in names]
    if shared:
        raise InvalidInput("parameters", f"{shared[0]!r} is a coordinate; give the parameter another name")
    if groups is not None:
        all_first, all_second, all_parameters = groups
        taken = {*all_first, *all_parameters, time._sympy_()}
        for symbol in all_second or ():
            if symbol in taken:
                raise InvalidInput(_SECOND_ARGUMENT[kind], f"{symbol} is something else, too; use another symbol")
            taken.add(symbol)
    root = walk(argument, function)
    forces = {} if further.get("forces") is None else further["forces"]
    if not isinstance(forces, Mapping):
        raise InvalidInput("forces", f"expected forces by coordinate, as {{theta: Q}}, got {type(forces).__name__}")
    by_name = {_label(key): value for key, value in forces.items()}
    unknown = [key for key in by_name if key not in names]
    if unknown:
        raise InvalidInput("forces", f"there is no coordinate {unknown[0]!r}; there are {list(names)}")
    dissipation = further.get("dissipation")
    description = {
        "kind": kind,
        "coordinates": len(names),
        "parameters": len(keys),
        "function": root,
        "forces": [walk("forces", by_name.get(name, 0)) for name in names] if by_name else [],
        "dissipation": None if dissipation is None else walk("dissipation", dissipation),
        "holonomic": [walk("constraints", each) for each in _listed("constraints", further.get("constraints", ()))],
        "nonholonomic": [
            walk("nonholonomic", each) for each in _listed("nonholonomic", further.get("nonholonomic", ()))
        ],
        "nodes": nodes.all,
    }
    return Source(kind, names, groups, keys, description), list(given.values())


def _listed(argument: str, value: Any) -> list[Any]:
    if isinstance(value, (list, tuple)):
        if not value and argument in ("coordinates", "q"):
            raise InvalidInput(argument, "expected at least one coordinate, got none")
        return list(value)
    if isinstance(value, str) or not isinstance(value, Iterable):
        return [value]
    return list(value)


def _name(value: Any) -> str:
    name = str(value)
    if not name.isidentifier():
        raise InvalidInput("parameters", f"expected symbols or names, got {value!r}")
    return name


def _label(coordinate: Any) -> str:
    """Give the name of a coordinate: of theta(t), theta."""
    function = getattr(coordinate, "func", None)
    name = getattr(function, "__name__", None) if getattr(coordinate, "args", ()) else None
    return name or str(coordinate)


def _coordinate(sp: Any, t: Any, value: Any) -> Any:
    if isinstance(value, sp.Symbol) and value != t:
        return value
    if isinstance(value, sp.core.function.AppliedUndef) and value.args == (t,):
        return value
    of_another = isinstance(value, sp.core.function.AppliedUndef) and len(value.args) == 1
    cure = ", which is no function of the time: that is vv.time, Symbol('t') without assumptions" if of_another else ""
    raise InvalidInput(
        "coordinates",
        f"expected coordinates as vv.coordinate('theta') makes them, or symbols with velocities=, got {value!r}{cure}",
    )


def _second(sp: Any, kind: str, first: tuple[Any, ...], second: Any) -> tuple[Any, ...] | None:
    """Give the symbols of velocities, or of momenta; None of velocities that are the derivatives of coordinates."""
    argument = _SECOND_ARGUMENT[kind]
    if second is None:
        if kind == "lagrangian" and not any(isinstance(each, sp.Symbol) for each in first):
            return None
        what = "velocities of coordinates that are symbols" if kind == "lagrangian" else "momenta"
        raise InvalidInput(argument, f"expected the {what}, one for each of {list(first)}")
    listed = tuple(_listed(argument, second))
    if len(listed) != len(first):
        raise InvalidInput(argument, f"expected {len(first)}, one for each of {list(first)}, got {len(listed)}")
    wrong = [each for each in listed if not isinstance(each, (sp.Symbol, sp.Derivative, sp.core.function.AppliedUndef))]
    if wrong:
        raise InvalidInput(argument, f"expected symbols, got {wrong[0]!r}")
    return listed


def _parameter(sp: Any, t: Any, key: Any, function: Any) -> Any:
    """Give the symbol of a parameter; a name means the symbol of that name in the function."""
    if key == t or key == "t":
        raise InvalidInput("parameters", "t is the time; give the parameter another name")
    if not isinstance(key, str):
        return key
    named = [symbol for symbol in getattr(function, "free_symbols", ()) if symbol.name == key]
    return named[0] if named else sp.Symbol(key)


def _arguments(function: Callable[..., Any]) -> list[Parameter]:
    try:
        return list(signature(function).parameters.values())
    except (TypeError, ValueError):  # one that does not tell what it takes
        return []


def placed_arguments(function: Callable[..., Any]) -> list[Parameter]:
    """Give what a function takes by its place, in that order; none of one that does not tell, as some in C do not."""
    by_place = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
    return [each for each in _arguments(function) if each.kind in by_place]


def refuse_other_arguments(
    argument: str, function: Callable[..., Any], second_name: str, parameters: tuple[str, ...]
) -> None:
    """Refuse what would be taken for something else, or what no parameter is given for.

    Raises
    ------
    InvalidInput
        By the name of the argument.
    """
    by_place = placed_arguments(function)
    placed = [each.name for each in by_place]
    if placed[:1] == ["t"] and "t" not in placed[1:]:
        raise InvalidInput(
            argument,
            f"expected a function f(position, {second_name}, t), in this order, got f({', '.join(placed)}); "
            "functions of (t, ...) are those of visviva.events.function",
        )
    if placed[:2] == ["x", "y"]:
        raise InvalidInput(
            argument,
            f"expected a function f(position, {second_name}, t), got f({', '.join(placed)}): x and y are one argument, "
            f"whose parts are position[0] and position[1]",
        )
    for each in by_place[2:3]:
        # Of parameters by that name `check_call` tells.
        is_time = each.name in ("t", "time", "_t", "_time", "_") or each.default is Parameter.empty
        if not is_time and each.name not in parameters:
            raise InvalidInput(
                argument,
                f"expected the time in the third place, f(position, {second_name}, t), got {each} there; if it is the "
                f"time call it t, if not write f(position, {second_name}, t, {each})",
            )
    refuse_missing_values(argument, function, parameters)


def refuse_missing_values(argument: str, function: Callable[..., Any], parameters: tuple[str, ...]) -> None:
    """Refuse a function that takes more than three numbers and what no parameter is given for.

    Raises
    ------
    InvalidInput
        Naming the first.
    """
    placed = [each.name for each in placed_arguments(function)]
    named = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
    needed = [each.name for each in _arguments(function) if each.default is Parameter.empty and each.kind in named]
    for name in needed:
        if name not in placed[:3] and name not in parameters:
            raise InvalidInput(
                "parameters", f"expected a value of {name!r}, which {argument} takes; pass parameters={{{name!r}: ...}}"
            )


def calls(
    nodes: Nodes, names: tuple[str, ...], parameters: tuple[str, ...], second_name: str
) -> Callable[[str, Any], int]:
    """Record functions of (first, second, t, **parameters)."""
    n = len(names)

    def expression(operation: str, value: float = 0.0) -> Expression:
        return Expression(nodes, nodes.add(operation, (), value))

    def walk(argument: str, function: Any) -> int:
        if isinstance(function, str):
            cure = "sympy.sympify makes an expression of it"
            raise InvalidInput(argument, f"expected a function or an expression of SymPy, got {function!r}; {cure}")
        if not callable(function):
            return nodes.constant(number(argument, function))
        first = expression_array(expression("variable", float(i)) for i in range(n))
        second = expression_array(expression("variable", float(n + i)) for i in range(n))
        values = {name: expression("parameter", float(i)) for i, name in enumerate(parameters)}
        refuse_other_arguments(argument, function, second_name, parameters)
        check_call(argument, function, ("position", second_name, "t"), parameters)
        return recorded(
            nodes,
            call_with_expressions(nodes, argument, function, (first, second, expression("time")), values),
            argument,
        )

    return walk
