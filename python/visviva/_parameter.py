"""A parameter that the core declares of a force or a potential, and what its kind says of its values.

The one idea: the kind says how a value is checked, kept, printed, documented, and written for the core and into a file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, number, positive, whole_number
from visviva._keywords import one_of
from visviva._names import body_index
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from visviva.potentials import Potential

__all__ = ["NOT_NONE", "TYPES", "VECTORS", "Parameter", "checked_potential", "wrapped"]

NOT_NONE = "expected those on which it acts, got none of them; leave it out, or give None, for all"
VECTORS = ("vector", "axial_vector", "direction", "point")
_ARRAYS = ("numbers", "table", *VECTORS)
_QUANTITIES = ("number", "numbers", *VECTORS)  # what has a dimension, and says so where it is none
TYPES = {
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
            return None  # which is all bodies
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

    def _indices(self, value: Any) -> int | str | tuple[int | str, ...] | NDArray[np.int64] | None:
        if self.default is not None:
            # All bodies are an empty array in pickles of earlier versions.
            if value is None or (isinstance(value, np.ndarray) and value.size == 0):
                return None
            if np.size(value) == 0:
                raise InvalidInput(self.name, NOT_NONE)
        if isinstance(value, str):
            return value
        if not isinstance(value, np.ndarray | list | tuple):
            return whole_number(self.name, value, low=0)
        if any(isinstance(each, str) for each in value):
            # Names wait for the scene to say which bodies they are.
            return tuple(each if isinstance(each, str) else whole_number(self.name, each, low=0) for each in value)
        array = np.asarray(value)
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
            return np.array([] if value is None else value, dtype=np.int64, ndmin=1)
        return value._to_core() if self.kind == "potential" else value

    def resolved(self, value: Any, names: tuple[str, ...], count: int) -> Any:
        """The value with the indices of the bodies that are given by name."""
        if isinstance(value, str):
            return body_index(self.name, value, names, count)
        return self.check([body_index(self.name, each, names, count) for each in value])

    def from_core(self, value: Any) -> Any:
        """The value that `to_core` described, from a file."""
        if self.kind == "indices" and len(value) == 0:
            return None
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
        kind = "{" + ", ".join(f'"{word}"' for word in self.choices) + "}" if self.choices else TYPES[self.kind]
        text = self.description + ("" if self.description.endswith(".") else ".")
        if self.dimension is not None and (any(self.dimension) or self.kind in _QUANTITIES):
            text += f" Dimension: {_dimension(self.dimension)}."
        if self.default is not None:
            text += f" {self.missing!r} if not given."
        return [f"{self.name} : {kind}{_SIGNS.get(self.sign, '')}{optional}", f"    {text}"]


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


def _dimension(powers: tuple[int, ...]) -> str:
    units = [(name, power) for name, power in zip(("length", "mass", "time"), powers, strict=True) if power]
    if not units:
        return "no length, mass or time"
    above = " · ".join(name if power == 1 else f"{name}^{power}" for name, power in units if power > 0) or "1"
    below = " · ".join(name if power == -1 else f"{name}^{-power}" for name, power in units if power < 0)
    if not below:
        return above
    return f"{above} / ({below})" if "·" in below else f"{above} / {below}"


def _frozen(array: NDArray[Any], given: object) -> Any:
    if array.flags.writeable or array is given:
        array = array.copy()
        array.flags.writeable = False
    return array


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value
