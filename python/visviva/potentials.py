"""Potentials V(r), one class for each that the core has registered.

The classes are made from the core's registry, so a potential that is added there (one file, one line)
appears here with its parameters, its documentation and its tests. `potentials.pyi` spells them out for
editors and type checkers; a test compares the two.
"""

from __future__ import annotations

from dataclasses import make_dataclass
from typing import TYPE_CHECKING, Any, ClassVar, cast

from visviva import _core
from visviva._arrays import float_array, number, positive
from visviva._keywords import did_you_mean, known_keywords, refuse_subclass
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import ArrayLike, NDArray


@known_keywords
class Potential:
    """A potential energy V(r) of the distance between two bodies, or from a fixed centre.

    Frozen, hashable and picklable. Every parameter is in the caller's own units.
    """

    __slots__ = ()

    name: ClassVar[str]
    _fields: ClassVar[tuple[str, ...]]
    _positive: ClassVar[tuple[str, ...]]

    def __init_subclass__(cls) -> None:
        refuse_subclass(cls, "a force along the line to a fixed centre is CentralField(one of visviva.potentials)")

    def __post_init__(self) -> None:
        for field in self._fields:
            check = positive if field in self._positive else number
            object.__setattr__(self, field, check(field, getattr(self, field)))

    @property
    def parameters(self) -> tuple[float, ...]:
        """The parameters, in the order of the constructor."""
        return tuple(getattr(self, field) for field in self._fields)

    def value(self, r: ArrayLike) -> NDArray[np.float64]:
        """V(r).

        Parameters
        ----------
        r : array_like
            Distances, of any shape.

        Returns
        -------
        ndarray
            Of the shape of ``r``.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).value([1.0, 4.0])
        array([2. , 0.5])
        """
        return self._evaluate(r, 0)

    def force(self, r: ArrayLike) -> NDArray[np.float64]:
        """−dV/dr at the distances ``r``: positive where the force repels.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).force([1.0, 4.0])
        array([2.   , 0.125])
        """
        return self._evaluate(r, 1)

    def curvature(self, r: ArrayLike) -> NDArray[np.float64]:
        """d²V/dr² at the distances ``r``.

        Examples
        --------
        >>> import visviva as vv
        >>> vv.potentials.Coulomb(k=2.0).curvature([1.0, 4.0])
        array([4.    , 0.0625])
        """
        return self._evaluate(r, 2)

    def _evaluate(self, r: ArrayLike, which: int) -> NDArray[np.float64]:
        distances = float_array("r", r, None)
        results = _core.potential(self.name, list(self.parameters), distances.ravel())
        return results[which].reshape(distances.shape)


def _make(entry: dict[str, Any]) -> type[Potential]:
    fields = tuple(parameter["name"] for parameter in entry["parameters"])
    made = make_dataclass(
        entry["class_name"],
        [(field, "float") for field in fields],
        bases=(Potential,),
        namespace={
            "__module__": __name__,
            "name": entry["name"],
            "_fields": fields,
            "_positive": tuple(p["name"] for p in entry["parameters"] if p["positive"]),
            "__doc__": _document(entry),
        },
        frozen=True,
        slots=True,
    )
    return cast("type[Potential]", known_keywords(made))


def _document(entry: dict[str, Any]) -> str:
    lines = [f"{entry['summary']}: V(r) = {entry['formula']}.", "", "Parameters", "----------"]
    for parameter in entry["parameters"]:
        positive = ", positive" if parameter["positive"] else ""
        lines += [f"{parameter['name']} : float{positive}", f"    {parameter['description']}"]
    lines += ["", "Raises", "------", "visviva.InvalidInput", "    If a parameter is not finite or has the wrong sign."]
    return "\n".join(lines)


_BY_NAME = {entry["name"]: _make(entry) for entry in _core.potentials()}
_CLASSES = {made.__name__: made for made in _BY_NAME.values()}
globals().update(_CLASSES)
__all__ = ["Potential", "potential_by_name"]
__all__ += list(_CLASSES)


@known_keywords
def potential_by_name(name: str, parameters: Sequence[float]) -> Potential:
    """The potential of a registry name, as files hold it.

    Examples
    --------
    >>> import visviva as vv
    >>> vv.potentials.potential_by_name("coulomb", [-1.0])
    Coulomb(k=-1.0)
    """
    if not isinstance(name, str) or name not in _BY_NAME:
        hint = did_you_mean(str(name), _BY_NAME)
        raise InvalidInput("potential", f"expected one of {', '.join(_BY_NAME)}, got {name!r}{hint}")
    made = _BY_NAME[name]
    if len(parameters) != len(made._fields):
        expected = f"{len(made._fields)} ({', '.join(made._fields)})"
        raise InvalidInput("parameters", f"expected {expected} for {name}, got {len(parameters)}")
    return made(*parameters)


def __dir__() -> list[str]:
    return list(__all__)
