"""Check every array and number that a user hands in.

The one idea: one function decides what an array argument may be, so that every entry accepts the same things and
refuses the rest with the same words: the name of the argument, what was expected, what came, and what to do. What it
returns can go to the core as it is.
"""

import math
import re
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from visviva._long_arrays import all_finite, as_float64
from visviva._text import article
from visviva.errors import InvalidInput

__all__ = [
    "Shape",
    "Sizes",
    "float_array",
    "in_range",
    "mass_array",
    "number",
    "positive",
    "positive_array",
    "radius_array",
    "read_only",
    "whole_number",
]

Shape: TypeAlias = tuple[int | str | None, ...]
"""Lengths of the axes: a number, a name that stands for one length in all arguments of a call, or None for any."""

Sizes: TypeAlias = dict[str, tuple[int, str]]
"""For each named length: its value and the argument that set it."""

_EXACT = 2**53
_FLOAT64 = np.dtype(np.float64)
#: The total of as many as there may be, none larger than this, is a number.
_SURELY_SUMMED = 1e280
# Made once: a union of types takes longer to make than to ask.
_WHOLE, _OF_NUMPY = int | np.integer, np.ndarray | np.generic
#: "1 kg", "-9.81m/s²", "5e3 km" and "1e-3µm", but not "1e5" or "1_000", which are numbers as they are, nor "1d3",
#: "0x10", "1j" and "1E", which are meant to be some.
_NUMBER_WITH_UNIT = re.compile(
    r"\s*[-+]?(?!0[xXoObB][\da-fA-F])(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?"
    r"(?![dD][-+]?\d|[eEjJ]\s*$)\s*(?![eE][-+]?\d)([^\W\d_]|[°%])"
)
_ADVICE = {
    "b": "a mask is not a number; pass x.astype(float) if zeros and ones are meant",
    "c": "pass x.real if the imaginary part is to be dropped",
    "O": "build it with np.asarray(x, dtype=float), which will show the element that is not a number",
    "U": "convert the text with np.asarray(x, dtype=float)",
    "S": "convert the text with np.asarray(x, dtype=float)",
    "T": "convert the text with np.asarray(x, dtype=float)",
    "M": "pass times as numbers in the units of the scene",
    "m": "pass times as numbers in the units of the scene",
    "V": "pass one plain array per argument",
}


def float_array(name: str, value: object, shape: Shape | None, sizes: Sizes | None = None) -> NDArray[np.float64]:
    """Check an array argument and return it as C-contiguous float64.

    Parameters
    ----------
    name : str
        The name of the argument, for the message.
    value : array_like
        Floats of at most 64 bits or integers in any memory layout and byte order, or nested sequences of numbers, whose
        integers may have any size and are rounded.
    shape : tuple or None
        Expected lengths: numbers, names such as ``"N"``, or None for any length. None in place of the tuple allows
        any shape.
    sizes : dict, optional
        The named lengths of the call. Pass one dict for all arguments that must agree; it is filled in as they come.

    Returns
    -------
    ndarray
        Native, aligned, C-contiguous float64. It is the argument itself if that is all of this already.

    Raises
    ------
    InvalidInput
        For any other type, shape, NaN or infinity.

    Examples
    --------
    >>> from visviva._arrays import float_array
    >>> sizes = {}
    >>> float_array("mass", [1, 2], ("N",), sizes)
    array([1., 2.])
    >>> float_array("position", [[0, 0, 0]], ("N", 3), sizes)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: position: expected shape (N, 3) with N = 2 as in mass, got (1, 3)
    """
    ready = _ready(value)
    array = _real(name, value) if ready is None else ready
    if shape is not None:
        _check_shape(name, array.shape, shape, {} if sizes is None else sizes)
    if ready is None:
        ready = _ready(array)  # as arrays of lists are
    result = as_float64(name, array) if ready is None else ready
    if not all_finite(result):
        first = _first(name, result, ~np.isfinite(result))
        raise InvalidInput(name, f"expected finite numbers, but {first}; remove or replace it")
    return result


def _ready(value: object) -> NDArray[np.float64] | None:
    """Give an array that can go to the core as it is: a look, where making sure would cost as much as a short run."""
    if type(value) is np.ndarray and value.dtype is _FLOAT64 and value.flags.c_contiguous and value.flags.aligned:
        return value
    return None


def mass_array(value: object, shape: Shape, sizes: Sizes | None = None) -> NDArray[np.float64]:
    """Check an array of masses: a `float_array` of which no element is negative.

    Raises
    ------
    InvalidInput
        As `float_array`, and for the first negative mass.

    Examples
    --------
    >>> from visviva._arrays import mass_array
    >>> mass_array([1.0, -2.0], ("N",))
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: mass: expected masses of at least 0, but mass[1] is -2.0; 0 marks a test particle
    """
    array = float_array("mass", value, shape, sizes)
    negative = array < 0.0
    if np.count_nonzero(negative):
        which = _first("mass", array, negative)
        raise InvalidInput("mass", f"expected masses of at least 0, but {which}; 0 marks a test particle")
    largest = array.max(initial=0.0)
    if array.ndim and largest > _SURELY_SUMMED:
        with np.errstate(over="ignore"):
            finite = np.isfinite(array.sum(axis=-1)).all()
        if not finite:
            raise InvalidInput(
                "mass",
                f"expected masses whose total is within the range of float64, but the largest is {largest:g}; "
                "choose a larger unit of mass",
            )
    return array


def _first(name: str, array: NDArray[np.float64], wrong: NDArray[np.bool_]) -> str:
    """Name the first wrong element and its value."""
    where = tuple(int(i) for i in np.argwhere(wrong)[0])
    label = name + (f"[{', '.join(map(str, where))}]" if where else "")
    return f"{label} is {array[where]}"


def number(name: str, value: object) -> float:
    """Check a scalar argument and return it as a float.

    Parameters
    ----------
    name : str
        The name of the argument, for the message.
    value : real number
        A Python or NumPy number, or an array without axes.

    Returns
    -------
    float
        Its value.

    Raises
    ------
    InvalidInput
        For anything else, NaN or infinity.

    Examples
    --------
    >>> from visviva._arrays import number
    >>> number("dt", 1)
    1.0
    """
    if type(value) is float and math.isfinite(value):
        return value
    if type(value) is int:
        try:
            return float(value)
        except OverflowError:
            raise InvalidInput(name, "expected a number within the range of float64, got a larger integer") from None
    array = _real(name, value)
    if array.shape != ():
        raise InvalidInput(name, f"expected one real number, got an array of shape {array.shape}")
    return float(float_array(name, array, ()))


def positive(name: str, value: object, what: str = "number") -> float:
    """Check a scalar argument that must be above 0; see `number`.

    Examples
    --------
    >>> from visviva._arrays import positive
    >>> positive("length", 0)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: length: expected a positive number, got 0.0
    """
    checked = number(name, value)
    if not checked > 0.0:
        raise InvalidInput(name, f"expected a positive {what}, got {checked!r}")
    return checked


def positive_array(name: str, value: object) -> NDArray[np.float64]:
    """Check an array of any shape that must be above 0; see `float_array`.

    Examples
    --------
    >>> from visviva._arrays import positive_array
    >>> positive_array("mass_ratio", [1.0, 0.0])
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: mass_ratio: expected a positive number, got 0.0 at mass_ratio[1]
    """
    array = float_array(name, value, None)
    wrong = ~(array > 0.0)
    if wrong.any():
        first = array[wrong][0]
        at = "" if array.ndim == 0 else f" at {_first(name, array, wrong).partition(' ')[0]}"
        raise InvalidInput(name, f"expected a positive number, got {first}{at}")
    return array


_Values = TypeVar("_Values", float, NDArray[np.float64])


def in_range(name: str, before: _Values, after: _Values) -> _Values:
    """Check that a change of units lost nothing: what comes after is finite, and zero only where it was zero before.

    Nor may it be so small that digits are missing (below 2.2e-308), where it was not before.

    Examples
    --------
    >>> from visviva._arrays import in_range
    >>> in_range("G", 2.0, 0.0)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: G: expected units in which it stays within float64, all digits of \
it, but 2.0 becomes 0.0; choose them nearer to the scene
    """
    old, new = np.asarray(before), np.asarray(after)
    least = np.finfo(np.float64).tiny
    lost = ~np.isfinite(new) | ((np.abs(new) < least) & (np.abs(old) >= least))
    if lost.any():
        raise InvalidInput(
            name,
            f"expected units in which it stays within float64, all digits of it, but {old[lost][0]} becomes "
            f"{new[lost][0]}; choose them nearer to the scene",
        )
    return after


def whole_number(name: str, value: object, low: int = -(2**63), high: int = 2**63 - 1) -> int:
    """Check a scalar argument that counts something: an integer of Python or NumPy within [low, high].

    Raises
    ------
    InvalidInput
        For anything else, True and False and floats without a fraction among it.

    Examples
    --------
    >>> from visviva._arrays import whole_number
    >>> whole_number("n_events", 1e6, low=1)
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: n_events: expected a whole number, got 1000000.0; pass int(1000000.0)
    """
    if isinstance(value, bool) or not isinstance(value, _WHOLE):
        advice = f"; pass int({value})" if isinstance(value, float) and value.is_integer() else ""
        raise InvalidInput(name, f"expected a whole number, got {value!r}{advice}")
    if not low <= value <= high:
        raise InvalidInput(name, f"expected a whole number from {low} to {high}, got {value}")
    return int(value)


def _real(name: str, value: object) -> NDArray[np.floating | np.integer]:
    """Give an array of a type that float64 holds exactly."""
    if hasattr(value, "units") or hasattr(value, "unit"):
        raise InvalidInput(
            name,
            f"expected plain numbers, got {_came(value)} with a unit; pass its value in the scene's units",
        )
    if isinstance(value, np.ndarray) and hasattr(value, "mask"):  # not np.ma, which would be imported for this
        raise InvalidInput(name, "expected plain numbers, got a masked array; pass x.compressed() or x.filled(…)")
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError) as error:
        message = f"expected an array of real numbers, got {_came(value)} that is none: {error}"
        raise InvalidInput(name, message) from None
    if not isinstance(value, _OF_NUMPY) or array.dtype.kind == "O":
        array = _rounded(name, array)
    kind, dtype = array.dtype.kind, array.dtype
    if kind in _ADVICE:
        what = f"dtype {dtype.name}" if isinstance(value, np.ndarray) else f"{_came(value)} (dtype {dtype.name})"
        raise InvalidInput(name, f"expected real numbers, got {what}; {_with_unit(array) or _ADVICE[kind]}")
    if kind == "f" and dtype.itemsize > 8:
        raise InvalidInput(name, f"expected at most float64, got {dtype.name}; round it with x.astype(np.float64)")
    if dtype.itemsize == 8 and kind in "iu" and array.size and (array.max() > _EXACT or array.min() < -_EXACT):
        raise InvalidInput(
            name,
            "expected integers up to 2**53, which float64 holds exactly, got larger; round them with x.astype(float)",
        )
    return array


def _with_unit(array: NDArray[Any]) -> str:
    """What to do with texts of which one is a number with a unit; nothing where none is."""
    for each in array.flat if array.dtype.kind in "OUT" else ():
        if isinstance(each, str) and _NUMBER_WITH_UNIT.match(each):
            return (
                f"leave the unit of {str(each)!r} out and pass plain numbers, all in one system of units: vv.units has "
                "several, with the constants in each"
            )
    return ""


def _came(value: object) -> str:
    return article(type(value).__name__)


def _rounded(name: str, array: NDArray[Any]) -> NDArray[Any]:
    """Round Python's own integers, which have no largest, as ``float()`` does; leave anything else as it is.

    NumPy's integers of 64 bits may be keys or counters whose last digits mean something: those are refused later.
    """
    if array.dtype.kind == "O":
        if not array.size or any(type(each) not in (int, float) for each in array.flat):
            return array
        if not any(type(each) is int and abs(each) > _EXACT for each in array.flat):
            return array
    elif array.dtype.kind not in "iu" or array.dtype.itemsize < 8:
        return array
    try:
        return array.astype(np.float64)
    except OverflowError:
        raise InvalidInput(name, "expected numbers within the range of float64, got a larger integer") from None


def _check_shape(name: str, came: tuple[int, ...], shape: Shape, sizes: Sizes) -> None:
    """Compare shapes, looking up and filling in the named lengths."""
    set_here: Sizes = {}
    agrees = len(came) == len(shape)
    for length, wanted in zip(came, shape, strict=False):
        if isinstance(wanted, str):
            known = sizes.get(wanted) or set_here.setdefault(wanted, (length, name))
            agrees = agrees and known[0] == length
        elif wanted is not None:
            agrees = agrees and wanted == length
    if agrees:
        sizes.update(set_here)
        return
    expected = ", ".join("any" if length is None else str(length) for length in shape) + (
        "," if len(shape) == 1 else ""
    )
    known_names = (part for part in dict.fromkeys(shape) if isinstance(part, str) and part in sizes)
    known_lengths = " and ".join(f"{part} = {sizes[part][0]} as in {sizes[part][1]}" for part in known_names)
    wanted_shape = "an array with one axis" if shape == (None,) else f"shape ({expected})"
    message = f"expected {wanted_shape}" + (f" with {known_lengths}" if known_lengths else "") + ", got "
    message += f"shape {came}" if shape == (None,) else f"{came}"
    if shape == (3,) and not came:
        message += "; give its three components"
    if len(shape) == 2 and came[::-1][1:] == shape[1:] and came[1:] != shape[1:]:
        message += "; the vector axis is the last: pass x.T"
    raise InvalidInput(name, message)


def radius_array(value: ArrayLike, shape: tuple[int, ...], sizes: Sizes | None = None) -> NDArray[np.float64]:
    """Radii of this shape: one for all, or one for each body."""
    if type(value) is float and 0.0 <= value < math.inf:
        return np.full(shape, value)
    given = float_array("radius", value, () if np.ndim(value) == 0 else ("N",) if len(shape) == 1 else shape, sizes)
    if (given < 0.0).any():
        raise InvalidInput("radius", f"expected radii of at least 0, got {float(given.min())}; 0 is a point")
    return given if given.shape == shape else np.full(shape, float(given))


def read_only(array: NDArray[np.float64], given: object = None) -> NDArray[np.float64]:
    """The array, or a copy of what was given, as nobody can write to it."""
    if array is given or not array.flags.owndata:
        # Views are copied too, read-only ones among them: somebody else may hold what they look at.
        array = array.copy()
    array.flags.writeable = False
    return array
