"""Classes made from what the core declares: forces and potentials.

The one idea: what a declaration says of its parameters (`_parameter.py`) is all that a class needs to check, print,
compare and write its values, and to change their units. A force or a potential that the core registers needs nothing
here.
"""

from __future__ import annotations

from dataclasses import field, make_dataclass
from itertools import repeat
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from visviva import _core
from visviva._arrays import in_range, positive
from visviva._keywords import known_keywords
from visviva._parameter import TYPES, Parameter
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import NoReturn

__all__ = ["Declared", "as_comparable", "class_from_entry", "unit_change"]


class Declared:
    """What a class made from a declaration has: frozen values that are checked, compared, printed and described."""

    __slots__ = ()

    kind: ClassVar[str]
    _parameters: ClassVar[tuple[Parameter, ...]]
    _at_rest: ClassVar[str]
    _one_way: ClassVar[str]
    _checked_together: ClassVar[tuple[str, ...]] = ()  # what is refused for the values of others, too
    _no_sum: ClassVar[str]  # what to do in the place of a sum

    def __post_init__(self) -> None:
        for parameter in self._parameters:
            object.__setattr__(self, parameter.name, parameter.check(getattr(self, parameter.name)))
        self._check_pairs()

    def _check_pairs(self) -> None:
        """Refuse pairs of one body, of what acts between listed ones, by their indices or by their names."""
        ends = [getattr(self, p.name) for p in self._parameters if p.kind == "indices"]
        if len(ends) != 2:
            return
        first, second = (
            end.tolist() if isinstance(end, np.ndarray) else [*end] if isinstance(end, tuple) else [end] for end in ends
        )
        several = max(len(first), len(second))
        # One end may be that of all pairs; what does not fit is refused by the scene.
        first, second = (each * several if len(each) == 1 else each for each in (first, second))
        for one, other in zip(first, second, strict=False):
            if one == other:
                i, j = (p.name for p in self._parameters if p.kind == "indices")
                raise InvalidInput(
                    j,
                    f"expected another body than {i}, got {one!r} for both, which are bodies by index or name: to a "
                    "fixed place leads Harmonic(k, center=…), or an ExpressionForce with a length of its own",
                )

    def _values(self) -> dict[str, Any]:
        return {parameter.name: getattr(self, parameter.name) for parameter in self._parameters}

    def __repr__(self) -> str:
        shown = (f"{p.name}={p.shown(getattr(self, p.name))}" for p in self._parameters)
        return f"{type(self).__name__}({', '.join(shown)})"

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        theirs = other._values()
        return all(np.array_equal(_as_kept(value), _as_kept(theirs[name])) for name, value in self._values().items())

    if not TYPE_CHECKING:  # to which there is no sum of them

        def __add__(self, other: object) -> NoReturn:
            raise TypeError(self._no_sum)

        __radd__ = __add__

    def __hash__(self) -> int:
        return hash((type(self), *map(as_comparable, self._values().values())))

    def _each_with(self, columns: Mapping[str, Sequence[Any]], count: int) -> list[Self]:
        """So many of it with values of their own, as `Parameter.check` gives them."""
        made = [object.__new__(type(self)) for _ in range(count)]
        for name, value in self._values().items():
            for one, own in zip(made, columns.get(name, repeat(value, count)), strict=True):
                object.__setattr__(one, name, own)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), tuple(self._values().values())

    def _to_core(self) -> dict[str, Any]:
        """The dictionary by which the core and a file know it."""
        return {"kind": self.kind} | {p.name: p.to_core(getattr(self, p.name)) for p in self._parameters}

    @classmethod
    def _from_core(cls, description: dict[str, Any]) -> Self:
        return cls(**{p.name: p.from_core(description[p.name]) for p in cls._parameters if p.name in description})

    def _rescaled(self, length: float, mass: float, time: float) -> Self:
        """The same in units of which ``length``, ``mass`` and ``time`` make one old unit."""
        scales = tuple(
            positive(unit, scale, "number of new units per old one")
            for unit, scale in (("length", length), ("mass", mass), ("time", time))
        )
        new: dict[str, Any] = {}
        for parameter, powers in zip(self._parameters, _core.dimensions(self._to_core()), strict=True):
            name, value = parameter.name, getattr(self, parameter.name)
            if parameter.kind == "potential":
                value = value.rescaled(length=length, mass=mass, time=time)
            elif parameter.kind not in ("indices", "choice") and any(powers):
                factor = unit_change(name, powers, scales)
                value = _each(value, factor)
            new[name] = value
        return type(self)(**new)


def class_from_entry(entry: dict[str, Any], base: type[Any], module: str, namespace: dict[str, Any]) -> type[Any]:
    """The class of an entry of the registry."""
    parameters = tuple(Parameter(**(row | {"choices": tuple(row["choices"])})) for row in entry["parameters"])
    made = make_dataclass(
        entry["class_name"],
        [
            (p.name, TYPES[p.kind]) if p.default is None else (p.name, TYPES[p.kind], field(default=p.missing))
            for p in parameters
        ],
        bases=(base,),
        namespace={
            "kind": entry["name"],
            "_at_rest": entry["at_rest"],
            "_one_way": entry["one_way"],
            "_parameters": parameters,
            "__doc__": _document(entry, parameters),
        }
        | namespace,
        frozen=True,
        slots=True,
        eq=False,
        repr=False,
    )
    made.__module__ = module
    return known_keywords(made)


def _document(entry: dict[str, Any], parameters: tuple[Parameter, ...]) -> str:
    lines = [f"{entry['summary'].rstrip('.')}: {entry['formula']}.", ""]
    if entry["notes"]:
        lines += [entry["notes"], ""]
    lines += ["Parameters", "----------"]
    for parameter in parameters:
        lines += parameter.document()
    lines += [
        "",
        "Raises",
        "------",
        "visviva.InvalidInput",
        "    If a parameter is not as described above, or not finite.",
    ]
    lines += ["", "References", "----------", entry["source"] + "."]
    lines += ["", "Examples", "--------", ">>> import visviva as vv", *entry["example"].splitlines()]
    return "\n".join(lines) + "\n"


def unit_change(name: str, powers: tuple[float, float, float], scales: tuple[float, ...]) -> Callable[[float], float]:
    """What brings a number of the dimension length^p mass^q time^r to other units, rounded once if p, q, r are whole.

    The product is exact: scales of 1e±150 that together make a moderate factor do not overflow or vanish on the way.
    """
    from fractions import Fraction

    exact, rest = Fraction(1), 1.0
    for scale, power in zip(scales, powers, strict=True):
        whole = int(power)
        exact *= Fraction(scale) ** whole
        rest *= scale ** (power - whole)

    def scaled(value: float) -> float:
        try:
            result = float(Fraction(value) * exact) * rest
        except OverflowError:
            result = float("inf")
        return in_range(name, value, result)

    return scaled


def _each(value: Any, change: Callable[[float], float]) -> Any:
    if isinstance(value, np.ndarray):
        return np.array([change(x) for x in value.tolist()])
    return tuple(map(change, value)) if isinstance(value, tuple) else change(value)


def _as_kept(value: Any) -> Any:
    """An array of one as the number in it, which means the same to the core, and as which files give it back."""
    return value.item() if isinstance(value, np.ndarray) and value.shape == (1,) else value


def as_comparable(value: Any) -> Any:
    """What has a hash, and is equal where values are kept that are."""
    kept = _as_kept(value)
    # Adding 0.0 turns -0.0, which compares equal to 0.0, into 0.0; numbers by themselves have the hash of that.
    return (kept + 0.0 if kept.dtype.kind == "f" else kept).tobytes() if isinstance(kept, np.ndarray) else kept
