"""Whether a start is on its constraints, but for round-off.

The one idea: what round-off may leave of a constraint is a small part of the terms that it is the sum of, and of what
it would change if the coordinates did by as much as they are: in any units.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from visviva.errors import InvalidInput
from visviva.generalized._calculus import Calculus
from visviva.generalized._probe import terms_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._nodes import Expression
    from visviva.generalized._system import GeneralizedSystem

__all__ = ["check_on_constraints", "constraints_and_rates", "projected", "wants_projection"]

#: Residuals above this part of their sizes, and corrections above this part of a number, are no round-off.
_CONSISTENT = 1e-10
#: A number that is smaller than this part of the largest is taken as large: it may be what rounding leaves of 0.
_ROUNDED = 1e-3


def check_on_constraints(system: Lagrangian, state: NDArray[np.float64]) -> None:
    """Refuse a start that is off them."""
    n = len(system.coordinates)
    places, velocities, nearest = system._model.projected(system.t0, state, system._values)
    halves = (("position", "constraint", places, 0), ("velocity", "the rate of constraint", velocities, 1))
    sizes = None
    for argument, what, residuals, half in halves:
        own = slice(half * n, (half + 1) * n)
        # Mostly the nearest state on the constraints is the same one.
        if (np.abs(nearest[own] - state[own]) <= _CONSISTENT * np.abs(state[own])).all():
            continue
        sizes = _sizes(system, state) if sizes is None else sizes
        for index, (residual, size) in enumerate(zip(residuals, sizes[half], strict=True)):
            if not abs(residual) <= _CONSISTENT * size:
                # Projected, it came to none: Newton's method is for starts near the constraints.
                instead = "start nearer to where all are 0" if system._projects else "pass consistent='project'"
                raise InvalidInput(argument, f"{what} {index} is {residual:.3g} at the start and not 0; {instead}")


def wants_projection(consistent: Literal["project"] | None) -> bool:
    """Whether a start is to be put on its constraints."""
    if consistent is None:
        return False
    if not isinstance(consistent, str) or consistent != "project":
        raise InvalidInput("consistent", f"expected 'project' or None, got {consistent!r}")
    return True


def projected(
    system: GeneralizedSystem, state: NDArray[np.float64], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Give the nearest state on the constraints, with these values of the parameters."""
    nearest: NDArray[np.float64] = system._model.projected(system.t0, state, values)[2]
    return nearest


def _sizes(system: Lagrangian, state: NDArray[np.float64]) -> tuple[list[float], list[float]]:
    """Give sizes of all holonomic constraints, and of the rates of all."""
    c, n = Calculus(system), len(system.coordinates)
    holonomic, rates = constraints_and_rates(c, system)
    halves = np.abs(state.reshape(2, n))
    scales = np.maximum(halves, _ROUNDED * halves.max(axis=1, keepdims=True)).ravel()

    def sizes(expressions: list[Expression], to: int) -> list[float]:
        found = []
        for expression, row in zip(expressions, c.with_derivatives(expressions), strict=True):
            terms = terms_of(c, [expression])
            both = [*terms, *row[1 : to + 1]]
            values = np.abs(c.values(both, np.array([system.t0]), state[None], system._values)[0])
            changes = float(values[len(terms) :] @ scales[:to])
            found.append(float(values[: len(terms)].sum()) + changes)
        return found

    return sizes(holonomic, n), sizes(rates, 2 * n)


def constraints_and_rates(c: Calculus, system: GeneralizedSystem) -> tuple[list[Expression], list[Expression]]:
    """Give what vanishes on constraints: the holonomic ones, and the rates of all."""
    n, description, v = len(system.coordinates), system._source.description, c.velocities()
    holonomic = c.adopted(description["nodes"], description["holonomic"])
    others = c.adopted(description["nodes"], description["nonholonomic"])
    rates = [sum((v[i] * row[1 + i] for i in range(n)), row[2 * n + 1]) for row in c.with_derivatives(holonomic)]
    return holonomic, [*rates, *others]
