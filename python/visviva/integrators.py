"""The integration methods the core has registered, as records."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from visviva import _core
from visviva._keywords import known_keywords

if TYPE_CHECKING:
    from visviva.typing import MethodName

__all__ = ["Method", "methods"]


@known_keywords
@dataclass(frozen=True, slots=True)
class Method:
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
    dense_order : int
        Order of the states between steps.
    reference : str
        Where it was published.
    """

    name: MethodName
    summary: str
    order: int
    stages: int
    symplectic: bool
    reversible: bool
    adaptive: bool
    dense_order: int
    reference: str


@known_keywords
def methods() -> list[Method]:
    """Every integration method.

    Returns
    -------
    list of Method

    Examples
    --------
    >>> import visviva as vv
    >>> [method.name for method in vv.methods() if method.adaptive and method.order == 8]
    ['dop853']
    """
    return [Method(**{name: row[name] for name in Method.__slots__}) for row in _core.methods()]
