"""The integration methods the core has registered, as records."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from visviva import _core
from visviva._html import Record, Sheet, Shown, as_text
from visviva._keywords import known_keywords
from visviva._text import count

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.typing import MethodName

__all__ = ["Method", "methods"]


@known_keywords
@dataclass(frozen=True, slots=True, repr=False)
class Method(Record):
    """An integration method and what it declares about itself.

    Attributes
    ----------
    name : str
        The name for ``run(method=...)``, which takes the record itself too.
    summary : str
        What it is for.
    order : int
        Order of accuracy.
    stages : int
        Force evaluations in a step.
    symplectic, reversible, adaptive : bool
        Whether the map is symplectic, whether a step back undoes a step, whether it chooses its own
        steps.
    time_transformation : bool
        Whether its steps may be equal in another time than time itself: ``run(time_transformation=...)``.
    dense_order : int
        Order of the states between steps.
    reference : str
        Where it was published.

    Examples
    --------
    >>> import visviva as vv
    >>> [leapfrog] = [method for method in vv.methods() if method.name == "leapfrog"]
    >>> leapfrog.order, leapfrog.stages, leapfrog.symplectic, leapfrog.adaptive
    (2, 1, True, False)
    """

    name: MethodName
    summary: str
    order: int
    stages: int
    symplectic: bool
    reversible: bool
    adaptive: bool
    time_transformation: bool
    dense_order: int
    reference: str

    @property
    def coefficients(self) -> dict[str, NDArray[np.float64]]:
        """The tables that a step is made of, in units of the step.

        Runge–Kutta methods have the strictly lower triangle ``a``, shape (S, S), the weights ``b`` and the nodes ``c``,
        shape (S,), and adaptive ones the weights of their error estimate, ``error``, with one more where the derivative
        at the end of the step enters. Splittings have ``kicks`` and ``drifts``: a kick, a drift, and so on to the last
        kick; outer kicks may be zero. Multistep methods have the weights of ``second_differences`` of the
        accelerations, and of those in the ``velocity``.

        They are the float64 numbers nearest to the coefficients, which are kept as double-doubles.

        Examples
        --------
        >>> import visviva as vv
        >>> rk4 = next(method for method in vv.methods() if method.name == "rk4")
        >>> (6 * rk4.coefficients["b"]).tolist()
        [1.0, 2.0, 2.0, 1.0]
        """
        rows = {row["name"]: row["coefficients"] for row in (*_core.methods(), *_core.methods(rigid=True))}
        tables = rows[self.name].items()
        return {name: _triangle(each) if name == "a" else np.array(each[0]) for name, each in tables}


class _Listed(list[Method], Shown):
    """A list of methods that reads as a table."""

    __slots__ = ()

    def __repr__(self) -> str:
        return as_text(self._sheet())

    def _sheet(self) -> Sheet:
        def row(method: Method) -> tuple[str, ...]:
            kinds = [word for word in ("adaptive", "symplectic", "reversible") if getattr(method, word)]
            # Of a summary what comes after the numbers, which have columns of their own.
            use = method.summary.rpartition(": ")[2]
            return (method.name, str(method.order), str(method.stages), ", ".join(kinds) or "fixed step", use)

        header = ("method", "order", "stages", "kind", "for what")
        note = "Each is a record, with its reference: methods()[0].reference. run(method=…) takes it, or its name."
        return Sheet(count(len(self), "method"), [row(method) for method in self], header, note)


def _triangle(rows: list[list[float]]) -> NDArray[np.float64]:
    """Rows of growing lengths as a square, with zeros on and above its diagonal."""
    square = np.zeros((len(rows), len(rows)))
    for place, row in enumerate(rows):
        square[place, : len(row)] = row
    return square


@known_keywords
def methods() -> list[Method]:
    """Every integration method.

    Returns
    -------
    list of Method
        Shown as a table.

    Examples
    --------
    >>> import visviva as vv
    >>> print(vv.methods())  # doctest: +ELLIPSIS
    32 methods
    method                order  stages  kind                    for what
    euler                 1      1       fixed step              the simplest method, for comparison.
    ...
    >>> [method.name for method in vv.methods() if method.adaptive and method.order == 8]
    ['dop853']
    """
    return _records(rigid=False)


def _records(*, rigid: bool) -> list[Method]:
    """The methods of scenes, or those that step rigid bodies."""
    return _Listed(_registered(rigid))


@cache
def _registered(rigid: bool) -> tuple[Method, ...]:
    """The same, which every run with a named method looks through."""
    return tuple(Method(**{name: row[name] for name in Method.__slots__}) for row in _core.methods(rigid=rigid))


def __dir__() -> list[str]:
    return list(__all__)
