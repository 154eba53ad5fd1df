"""Classes made from what the core declares: forces and potentials.

The one idea: a parameter's kind says how it is checked, printed, compared, written into a file, turned with the bodies
and changed to other units. A force or a potential that the core registers needs nothing here.
"""

from __future__ import annotations

from dataclasses import dataclass, field, make_dataclass
from itertools import repeat
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from visviva import _core
from visviva._arrays import float_array, in_range, number, positive, whole_number
from visviva._keywords import known_keywords, one_of
from visviva._names import body_index
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from visviva.potentials import Potential

__all__ = [
    "VECTORS",
    "Declared",
    "Parameter",
    "as_comparable",
    "checked_potential",
    "class_from_entry",
    "unit_change",
    "wrapped",
]

VECTORS = ("vector", "axial_vector", "direction", "point")
_ARRAYS = ("numbers", "table", *VECTORS)
_QUANTITIES = ("number", "numbers", *VECTORS)  # what has a dimension, and says so where it is none
_TYPES = {
    "number": "float",
    "numbers": "float or array_like",
    "indices": "int or str, or array_like of them, shape (M,)",
    "vector": "array_like, shape (3,)",
    "axial_vector": "array_like, shape (3,)",
    "direction": "array_like, shape (3,)",
    "point": "array_like, shape (3,)",
    "potential": "visviva.potentials.Potential",
    "choice": "str",
    "table": "array_like, shape (P,)",
}
_SHOWN = 8  # numbers of a table that are printed
_SIGNS = {"positive": ", positive", "not_negative": ", not negative"}


@dataclass(frozen=True, slots=True)
class Parameter:
    """What the core declares of a parameter."""

    name: str
    description: str
    kind: str
    sign: str
    choices: tuple[str, ...]
    default: float | None
    dimension: tuple[int, int, int] | None

    @property
    def missing(self) -> Any:
        """The value of a parameter that is not given; None if it has to be."""
        if self.default is None:
            return None
        if self.kind == "choice":
            return self.choices[int(self.default)]
        if self.kind == "indices":
            return ()
        return (self.default,) * 3 if self.kind in VECTORS else self.default

    def check(self, value: Any) -> Any:
        """The value as it is kept: frozen, comparable, of one type for each kind."""
        if self.kind in VECTORS:
            vector = float_array(self.name, value, (3,))
            if self.kind == "direction" and not vector.any():
                raise InvalidInput(self.name, "expected a direction, got 0.0 in every component")
            return tuple(vector.tolist())
        if self.kind == "number":
            return self._signed(number(self.name, value))
        if self.kind == "numbers":
            return self._numbers(value)
        if self.kind == "indices":
            return self._indices(value)
        if self.kind == "table":
            table: NDArray[np.float64] = _frozen(float_array(self.name, value, (None,)), value)
            return table
        if self.kind == "potential":
            return checked_potential(self.name, value)
        return one_of(self.name, value, self.choices)

    def _signed(self, value: float) -> float:
        if self.sign == "positive":
            return positive(self.name, value)
        if self.sign == "not_negative" and value < 0.0:
            raise InvalidInput(self.name, f"expected a number of at least 0, got {value!r}")
        return value

    def _numbers(self, value: Any) -> float | NDArray[np.float64]:
        array = float_array(self.name, value, None)
        if array.ndim == 0:
            return self._signed(float(array))
        if array.ndim > 1:
            raise InvalidInput(self.name, f"expected one number or an array of one axis, got shape {array.shape}")
        for wrong in array[array <= 0.0 if self.sign == "positive" else array < 0.0] if self.sign != "any" else ():
            self._signed(float(wrong))
        kept: NDArray[np.float64] = _frozen(array, value)
        return kept

    def _indices(self, value: Any) -> int | str | tuple[int | str, ...] | NDArray[np.int64]:
        if isinstance(value, str):
            return value
        if not isinstance(value, np.ndarray | list | tuple):
            return whole_number(self.name, value, low=0)
        if any(isinstance(each, str) for each in value):
            # Names wait for the scene to say which bodies they are.
            return tuple(each if isinstance(each, str) else whole_number(self.name, each, low=0) for each in value)
        array = np.asarray(value, dtype=np.int64 if len(value) == 0 and self.default is not None else None)
        if array.size == 0 and self.default is not None:
            all_of_them: NDArray[np.int64] = _frozen(array, value)
            return all_of_them
        if array.ndim != 1 or array.dtype.kind not in "iu" or array.size == 0:
            raise InvalidInput(
                self.name,
                f"expected the index of a body or a one-dimensional array of them, "
                f"got an array of {array.dtype.name} of shape {array.shape}",
            )
        if array.min() < 0:
            raise InvalidInput(self.name, f"expected indices of bodies, from 0 on, got {array.min()}")
        kept: NDArray[np.int64] = _frozen(array.astype(np.int64), value)
        return kept

    def to_core(self, value: Any) -> Any:
        """What the core and a file know it by."""
        if self.kind in _ARRAYS:
            return np.array(value, dtype=float, ndmin=1)
        if self.kind == "indices":
            if isinstance(value, str | tuple):
                raise InvalidInput(self.name, f"expected indices of bodies outside a scene, got {value!r}")
            return np.array(value, dtype=np.int64, ndmin=1)
        return value._to_core() if self.kind == "potential" else value

    def resolved(self, value: Any, names: tuple[str, ...], count: int) -> Any:
        """The value with the indices of the bodies that are given by name."""
        if isinstance(value, str):
            return body_index(self.name, value, names, count)
        return self.check([body_index(self.name, each, names, count) for each in value])

    def from_core(self, value: Any) -> Any:
        """The value that `to_core` described, from a file."""
        if self.kind in ("numbers", "indices"):
            return value[0] if len(value) == 1 else value
        if self.kind == "potential":
            from visviva.potentials import potential_from_core

            return potential_from_core(value)
        return value

    def shown(self, value: Any) -> str:
        """The value as it is printed; of a long table its ends."""
        if self.kind != "table" or len(value) <= _SHOWN:
            return repr(_plain(value))
        first, last = (", ".join(map(repr, part.tolist())) for part in (value[: _SHOWN // 2], value[-1:]))
        return f"[{first}, ..., {last}]"

    def document(self) -> list[str]:
        """Its entry in the documentation."""
        optional = "" if self.default is None else ", optional"
        kind = "{" + ", ".join(f'"{word}"' for word in self.choices) + "}" if self.choices else _TYPES[self.kind]
        text = self.description + ("" if self.description.endswith(".") else ".")
        if self.dimension is not None and (any(self.dimension) or self.kind in _QUANTITIES):
            text += f" Dimension: {_dimension(self.dimension)}."
        if self.default is not None:
            text += f" {self.missing!r} if not given."
        return [f"{self.name} : {kind}{_SIGNS.get(self.sign, '')}{optional}", f"    {text}"]


class Declared:
    """What a class made from a declaration has: frozen values that are checked, compared, printed and described."""

    __slots__ = ()

    kind: ClassVar[str]
    _parameters: ClassVar[tuple[Parameter, ...]]
    _at_rest: ClassVar[str]
    _one_way: ClassVar[str]
    _checked_together: ClassVar[tuple[str, ...]] = ()  # what is refused for the values of others, too

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
                raise InvalidInput(j, f"expected another body than {i}, got {one!r} for both; give two that are apart")

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
            (p.name, _TYPES[p.kind]) if p.default is None else (p.name, _TYPES[p.kind], field(default=p.missing))
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


def _dimension(powers: tuple[int, ...]) -> str:
    units = [(name, power) for name, power in zip(("length", "mass", "time"), powers, strict=True) if power]
    if not units:
        return "no length, mass or time"
    above = " · ".join(name if power == 1 else f"{name}^{power}" for name, power in units if power > 0) or "1"
    below = " · ".join(name if power == -1 else f"{name}^{-power}" for name, power in units if power < 0)
    if not below:
        return above
    return f"{above} / ({below})" if "·" in below else f"{above} / {below}"


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


def checked_potential(name: str, value: object) -> Potential:
    """Refuse what is no potential."""
    from visviva.potentials import Potential

    if not isinstance(value, Potential):
        kind = type(value).__name__
        raise InvalidInput(
            name, f"expected one of visviva.potentials, for example Coulomb(k=-1.0), got {kind}{wrapped(value)}"
        )
    return value


def wrapped(value: object) -> str:
    """The end of a message that refuses functions, formulas or several as a potential: what makes one of them."""
    if isinstance(value, list | tuple):
        return "; their sum is one formula: vv.potentials.Custom(lambda r: …)"
    if isinstance(value, type) or not (callable(value) or hasattr(value, "free_symbols")):
        return ""
    return "; wrap it: vv.potentials.Custom(function), and one that is no formula with r_min=… and r_max=…"


def _frozen(array: NDArray[Any], given: object) -> Any:
    if array.flags.writeable or array is given:
        array = array.copy()
        array.flags.writeable = False
    return array


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value


def _as_kept(value: Any) -> Any:
    """An array of one as the number in it, which means the same to the core, and as which files give it back."""
    return value.item() if isinstance(value, np.ndarray) and value.shape == (1,) else value


def as_comparable(value: Any) -> Any:
    """What has a hash, and is equal where values are kept that are."""
    kept = _as_kept(value)
    # Adding 0.0 turns -0.0, which compares equal to 0.0, into 0.0; numbers by themselves have the hash of that.
    return (kept + 0.0 if kept.dtype.kind == "f" else kept).tobytes() if isinstance(kept, np.ndarray) else kept
