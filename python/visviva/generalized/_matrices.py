"""The matrices of small motions of a Lagrangian at places, and what their numbers are the sums of.

The one idea: a number is known to the rounding of what it is the sum of, be that parameters or constants of a formula.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from visviva.generalized._calculus import Calculus
from visviva.generalized._kinks import with_limits
from visviva.generalized._probe import terms_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.generalized._lagrangian import Lagrangian
    from visviva.generalized._nodes import Expression, Nodes

__all__ = ["LAST_DIGITS", "Matrices", "Sizes", "balanced_units", "matrices", "matrices_along", "nudges", "rounding"]

_EPSILON = float(np.finfo(float).eps)
#: How far places and parameters are moved to see what rounding makes of a matrix, and how often.
LAST_DIGITS = 2.0**-51
_NUDGES = 3
#: Rounds of balancing a matrix: a few are usual.
_SWEEPS = 100
#: Stiffnesses of more coordinates are too many to be taken apart.
_FEW = 3


class Matrices(NamedTuple):
    """F (n), and M, C and K (n, n) of M ξ̈ + C ξ̇ + K ξ = 0."""

    forces: NDArray[np.float64]
    mass: NDArray[np.float64]
    damping: NDArray[np.float64]
    stiffness: NDArray[np.float64]


def matrices(system: Lagrangian, place: NDArray[np.float64], values: NDArray[np.float64] | None = None) -> Matrices:
    """At rest at a place; what has no number there, though it comes to one, is that."""
    n = len(place)
    numbers = system._values if values is None else values

    def evaluate(states: NDArray[np.float64]) -> NDArray[np.float64]:
        parts = _evaluated(system, states, numbers)
        return np.concatenate([part.reshape(len(states), -1) for part in parts], axis=1)

    found = with_limits(evaluate, np.concatenate([place, np.zeros(n)]), n)
    forces, mass, damping, stiffness = np.split(found, [n, n + n * n, n + 2 * n * n])
    return Matrices(forces, *(part.reshape(n, n) for part in (mass, damping, stiffness)))


def matrices_along(system: Lagrangian, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """F (S, n) and K (S, n, n) at rest at places (S, n), as their formulas have them."""
    states = np.concatenate([places, np.zeros_like(places)], axis=1)
    forces, _, _, stiffness = _evaluated(system, states, system._values)
    return forces, stiffness


def _evaluated(
    system: Lagrangian, states: NDArray[np.float64], values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """F, M, C and K at states (S, 2n)."""
    return system._model.matrices(system.t0, np.ascontiguousarray(states), values)


class Sizes:
    """Sizes of what forces at rest, and stiffnesses, are the sums of; 0 for a single term, which is but itself."""

    def __init__(self, system: Lagrangian) -> None:
        self._system = system
        self._calculus = Calculus(system)

    def expressions(self, c: Calculus) -> list[list[Expression]]:
        """Give what each force at rest is the sum of, as the system was told."""
        description = self._system._source.description
        further = c.adopted(description["nodes"], description["forces"])
        forces = [[slope] for slope in c.of_system("slopes")]
        for force, other in zip(forces, further, strict=False):
            force.append(other)
        return forces

    @cached_property
    def _forces(self) -> list[list[Expression]]:
        return self.expressions(self._calculus)

    @cached_property
    def _terms_of_forces(self) -> list[list[Expression]]:
        return [_collected(terms_of(self._calculus, force)) for force in self._forces]

    @cached_property
    def _terms_of_stiffnesses(self) -> list[list[Expression]]:
        c, n = self._calculus, len(self._forces)
        found = []
        for force in self._forces:
            rows = c.with_derivatives(force)
            found += [_collected(terms_of(c, [row[1 + j] for row in rows])) for j in range(n)]
        return found

    def forces(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of forces (S, n) at places (S, n)."""
        return self._sums(self._terms_of_forces, places)

    def stiffness(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of K (n, n) at a place; zeros for many coordinates."""
        n = len(place)
        if n > _FEW:
            return np.zeros((n, n))
        sums: NDArray[np.float64] = self._sums(self._terms_of_stiffnesses, place[None])[0]
        return sums.reshape(n, n)

    def _sums(self, sums: list[list[Expression]], places: NDArray[np.float64]) -> NDArray[np.float64]:
        several = [terms if len(terms) > 1 else [] for terms in sums]
        flat = [term for terms in several for term in terms]
        count = len(places)
        if not flat:
            return np.zeros((count, len(sums)))
        states = np.concatenate([places, np.zeros_like(places)], axis=1)
        times = np.full(count, self._system.t0)
        with np.errstate(all="ignore"):
            values = np.abs(self._calculus.values(flat, times, states, self._system._values))
        values = np.where(np.isfinite(values), values, 0.0)
        parts = np.split(values, np.cumsum([len(terms) for terms in several])[:-1], axis=1)
        return np.stack([part.sum(axis=1) for part in parts], axis=1)


def _collected(terms: list[Expression]) -> list[Expression]:
    """Terms with numbers before them that are alike as one: what momenta of rest add takes itself away exactly."""
    alike: dict[tuple[int, ...], list[tuple[float, Expression]]] = {}
    for term in terms:
        number, factors = _factors(term._nodes, term._place)
        alike.setdefault(tuple(sorted(factors)), []).append((number, term))
    found = []
    for group in alike.values():
        numbers, (first, *others) = [number for number, _ in group], [term for _, term in group]
        total = sum(numbers)
        if not others:
            found.append(first)
        elif abs(total) > len(numbers) * _EPSILON * sum(map(abs, numbers)):
            found.append(first * (total / numbers[0]))
    return found


def _factors(nodes: Nodes, place: int) -> tuple[float, list[int]]:
    """Give the number before a product, and what else it is the product of."""
    operation, arguments, value = nodes.all[place]
    if operation == "constant":
        return value, []
    if operation != "product" and not (operation == "sum" and len(arguments) == 1):
        return 1.0, [place]
    number, factors = 1.0, list[int]()
    for each in arguments:
        before, others = _factors(nodes, each)
        number, factors = number * before, factors + others
    return number, factors


def balanced_units(matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give units (S, n) of numbers in which rows and columns of matrices (S, n, n) of their rates are alike.

    Powers of two, which round nothing (B. N. Parlett & C. Reinsch, Numer. Math. 13 (1969) 293).
    """
    n = matrices.shape[-1]
    sizes = np.where(np.isfinite(matrices), np.abs(matrices), 0.0) * (1.0 - np.eye(n))
    units = np.ones(matrices.shape[:-1])
    for _ in range(_SWEEPS):
        changed = False
        for i in range(n):
            row, column = sizes[:, i].max(axis=1), sizes[:, :, i].max(axis=1)
            known = (row > 0.0) & (column > 0.0)
            logarithms = np.log2(np.where(known, row, 1.0)) - np.log2(np.where(known, column, 1.0))
            factor = np.exp2(np.rint(0.5 * logarithms))
            changed |= bool((factor != 1.0).any())
            sizes[:, :, i] *= factor[:, None]
            sizes[:, i] /= factor[:, None]
            units[:, i] *= factor
        if not changed:
            break
    return units


def nudges(count: int) -> list[NDArray[np.float64]]:
    """Give signs (count), which differ from turn to turn, so that no two changes take each other away each time."""
    return [np.where((np.arange(count) * (2 * turn + 1) // 2 + turn) % 2, 1.0, -1.0) for turn in range(_NUDGES)]


def rounding(
    system: Lagrangian, place: NDArray[np.float64], stiffness: NDArray[np.float64], sizes: Sizes
) -> NDArray[np.float64]:
    """Give what the last digits of the place, of parameters and of what it is the sum of make of K."""
    off = np.fmax(LAST_DIGITS * np.abs(stiffness), _EPSILON * sizes.stiffness(place))
    numbers = np.concatenate([place, system._values])
    for signs in nudges(len(numbers)):
        nudged = numbers * (1.0 + LAST_DIGITS * signs)
        other = matrices(system, nudged[: len(place)], nudged[len(place) :]).stiffness
        off = np.fmax(off, np.abs(other - stiffness))
    return off


def __dir__() -> list[str]:
    return list(__all__)
