"""Expressions of a system that are put together, derived and evaluated: arithmetic in Python, derivatives in the core.

The one idea: nodes of the core and of a user become `Expression`s of one list, on which arithmetic works; what the core
gives back is simplified as all of its nodes are, so that what vanishes by its rules is the constant 0.
"""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._nodes import Expression, Nodes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from visviva.generalized._nodes import Node
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["Calculus", "expression_list"]


class Calculus:
    """A list of nodes about one system."""

    def __init__(self, system: GeneralizedSystem) -> None:
        self._system = system
        self._nodes = Nodes()

    def adopted(self, nodes: Sequence[Node], roots: Iterable[int]) -> list[Expression]:
        """Give nodes of another list as expressions of this one."""
        places: list[int] = []
        for operation, arguments, value in nodes:
            places.append(self._nodes.add(operation, tuple(places[each] for each in arguments), value))
        return [Expression(self._nodes, places[root]) for root in roots]

    def of_system(self, name: str) -> list[Expression]:
        """Give expressions that the core knows by name."""
        return self.adopted(*self._system._model.expressions(name))

    def of_user(self, argument: str, expressions: Iterable[Any]) -> list[Expression]:
        """Give what a user has written: expressions of SymPy, functions, or numbers."""
        return self.adopted(*self._system._source.nodes(argument, expressions))

    def constant(self, value: float) -> Expression:
        """Give a number."""
        return Expression(self._nodes, self._nodes.constant(value))

    def velocities(self) -> list[Expression]:
        """Give the second half of the state."""
        n = len(self._system.coordinates)
        return [Expression(self._nodes, self._nodes.add("variable", (), float(n + i))) for i in range(n)]

    def with_derivatives(self, expressions: Sequence[Expression]) -> list[list[Expression]]:
        """Give each expression as the core simplifies it, then its derivatives by the state's numbers and the time."""
        nodes, roots = self._nodes.part([each._place for each in expressions])
        found = self.adopted(*self._system._model.derivatives(nodes, roots))
        width = 2 * len(self._system.coordinates) + 2
        return [found[first : first + width] for first in range(0, len(found), width)]

    def simplified(self, expressions: Sequence[Expression]) -> list[Expression]:
        """Give each expression as the core simplifies it."""
        nodes, roots = self._nodes.part([each._place for each in expressions])
        found, places = self._system._model.derivatives(nodes, roots)
        # Node by node the expressions come before what they have as derivatives.
        own = places[:: 2 * len(self._system.coordinates) + 2]
        return self.adopted(found[: max(own, default=-1) + 1], own)

    def is_zero(self, expression: Expression) -> bool:
        """Whether an expression that the core has simplified vanishes identically."""
        operation, _, value = self._nodes.all[expression._place]
        return operation == "constant" and value == 0.0

    def values(
        self, expressions: Sequence[Expression], t: NDArray[np.float64], states: NDArray[np.float64], parameters: Any
    ) -> NDArray[np.float64]:
        """Give values (N, k) at times (N) and states (N, 2n)."""
        nodes, roots = self._nodes.part([each._place for each in expressions])
        states = np.ascontiguousarray(states)
        return self._system._model.evaluate(nodes, roots, t, states, parameters[None, :])

    def to_sympy(self, expressions: Sequence[Expression]) -> list[Any]:
        """Give expressions as trees of SymPy."""
        return self._system._trees(self._nodes.all, [each._place for each in expressions])


def expression_list(argument: str, given: Any, count: int, what: str) -> list[Any]:
    """Give so many expressions: of a sequence, or of one function that gives all of them."""
    if callable(given) and not hasattr(given, "free_symbols"):

        def part(index: int) -> Callable[..., Any]:
            @wraps(given)
            def one(*arguments: Any, **parameters: Any) -> Any:
                found = given(*arguments, **parameters)
                if not isinstance(found, (list, tuple, np.ndarray)) or len(found) != count:
                    got = f"{len(found)}" if hasattr(found, "__len__") else type(found).__name__
                    raise InvalidInput(argument, f"expected {what}, got {got} of the function")
                return found[index]

            return one

        return [part(index) for index in range(count)]
    if not isinstance(given, (list, tuple)) or len(given) != count:
        got = f"{len(given)}" if isinstance(given, (list, tuple)) else type(given).__name__
        raise InvalidInput(argument, f"expected {what}, or a function that gives them all, got {got}")
    return list(given)
