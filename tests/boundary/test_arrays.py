"""Every layout of an array is read right, and everything else is refused by name."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from visviva import _core
from visviva._arrays import Sizes, float_array, number
from visviva.errors import InvalidInput

PLAIN = np.arange(12.0).reshape(4, 3) - 5.5
WHOLE = np.arange(12).reshape(4, 3)


def read_only(array: np.ndarray) -> np.ndarray:
    array = array.copy()
    array.flags.writeable = False
    return array


def unaligned(array: np.ndarray) -> np.ndarray:
    record = np.zeros(array.shape, np.dtype([("pad", "i1"), ("value", "f8")]))
    record["value"] = array
    assert not record["value"].flags.aligned
    return record["value"]


LAYOUTS = {
    "C": PLAIN,
    "Fortran": np.asfortranarray(PLAIN),
    "transposed": PLAIN.T.copy().T,
    "strided": np.repeat(np.repeat(PLAIN, 2, axis=0), 3, axis=1)[::2, ::3],
    "reversed": PLAIN[::-1, ::-1].copy()[::-1, ::-1],
    "fancy": np.stack([PLAIN, PLAIN])[0][:, [0, 1, 2]],
    "broadcast": np.broadcast_to(np.float64(2.5), (4, 3)),
    "read-only": read_only(PLAIN),
    "unaligned": unaligned(PLAIN),
    "byte-swapped": PLAIN.astype(">f8"),
    "big-endian strided": np.repeat(PLAIN, 2, axis=0).astype(">f8")[::2],
    "memory map like": np.frombuffer(PLAIN.tobytes()).reshape(4, 3),
    "subclass": PLAIN.view(type("Sub", (np.ndarray,), {})),
    "float32": PLAIN.astype(np.float32),
    "float16": PLAIN.astype(np.float16),
    **{name: WHOLE.astype(name) for name in ("int8", "uint8", "int16", "int32", "uint32", "int64", "uint64", ">i4")},
    "lists": PLAIN.tolist(),
    "tuples": tuple(map(tuple, WHOLE.tolist())),
    "list of arrays": list(PLAIN),
    "no rows": np.zeros((0, 3)),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts_are_read_as_they_stand(layout: str) -> None:
    value: Any = LAYOUTS[layout]
    result = float_array("position", value, ("N", 3))
    assert result.dtype == np.float64
    assert result.dtype.isnative
    assert result.flags.c_contiguous
    assert result.flags.aligned
    assert type(result) is np.ndarray
    np.testing.assert_array_equal(result, np.array(value, dtype=float).reshape(-1, 3))
    np.testing.assert_array_equal(_core._echo(result), result)


@pytest.mark.parametrize(
    "layout", ["C", "Fortran", "strided", "reversed", "broadcast", "read-only", "no rows", "unaligned"]
)
def test_the_core_reads_any_strides_itself(layout: str) -> None:
    value: Any = LAYOUTS[layout]
    result = _core._echo(value)
    assert result.flags.c_contiguous
    assert result.flags.writeable
    assert not np.shares_memory(result, value)
    np.testing.assert_array_equal(result, value)


def test_the_core_refuses_what_it_cannot_read() -> None:
    with pytest.raises(InvalidInput, match=r"array: expected shape \(any, 3\), got \[3, 4\]"):
        _core._echo(np.zeros((3, 4)))
    with pytest.raises(InvalidInput, match=r"array: expected shape \(any, 3\), got \[3\]"):
        _core._echo(np.zeros(3))
    for wrong in (PLAIN.astype(">f8"), PLAIN.astype("f4"), WHOLE, PLAIN.tolist(), None):
        with pytest.raises(TypeError):
            _core._echo(wrong)


@given(
    hnp.arrays(
        hnp.floating_dtypes(sizes=(32, 64), endianness="?"),
        hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5),
        elements=st.floats(-1e6, 1e6, width=32),
    ),
    st.data(),
)
def test_any_view_of_any_array(array: np.ndarray, data: st.DataObject) -> None:
    view = array[data.draw(hnp.basic_indices(array.shape, allow_ellipsis=True))]
    view = view.transpose(data.draw(st.permutations(range(np.ndim(view)))))
    np.testing.assert_array_equal(float_array("x", view, None), np.array(view.tolist()).reshape(view.shape))


class Quantity(list):  # type: ignore[type-arg]
    unit = "km"


REFUSED = {
    "bool": (np.ones((4, 3), bool), "dtype bool.*astype"),
    "complex": (PLAIN + 0j, "dtype complex128.*x.real"),
    "object": (PLAIN.astype(object), "dtype object"),
    "fractions": ([[Fraction(1, 3)] * 3], "a list .dtype object"),
    "None": (None, "a NoneType .dtype object"),
    "string": ("abc", "a str .dtype str"),
    "strings": ([["1", "2", "3"]], "a list .dtype str.*convert"),
    "bytes": ([[b"1", b"2", b"3"]], "a list .dtype bytes"),
    "datetime": (np.zeros((4, 3), "M8[s]"), "dtype datetime64.*units of the scene"),
    "timedelta": (np.zeros((4, 3), "m8[s]"), "dtype timedelta64"),
    "record": (np.zeros(4, "f8,f8,f8"), "one plain array per argument"),
    "ragged": ([[1.0, 2.0, 3.0], [1.0]], "a list that is none"),
    "integers beyond float64": ([[10**400, 0, 0]], "range of float64, got a larger integer"),
    "inexact integers": (np.array([[2**53 + 1, 0, 0]]), "2\\*\\*53"),
    "inexact negative integers": (np.array([[-(2**53) - 1, 0, 0]]), "2\\*\\*53"),
    "a huge integer among fractions": ([[2**70, Fraction(1, 3), 0]], "dtype object"),
    "a huge integer among masks": ([[2**70, True, 0]], "dtype object"),
    "masked": (np.ma.masked_greater(PLAIN, 0.0), "masked"),
    "quantity": (Quantity(PLAIN.tolist()), "with a unit"),
    "dictionary": ({"x": 1.0}, "a dict .dtype object"),
    "generator": ((row for row in PLAIN), "a generator .dtype object"),
    "too few axes": (PLAIN[0], r"expected shape \(N, 3\), got \(3,\)"),
    "too many axes": (PLAIN[None], r"expected shape \(N, 3\), got \(1, 4, 3\)"),
    "transposed": (PLAIN.T, r"expected shape \(N, 3\), got \(3, 4\); the vector axis is the last: pass x.T"),
    "wrong width": (PLAIN[:, :2], r"got \(4, 2\)$"),
    "NaN": (np.where(PLAIN == 1.5, np.nan, PLAIN), r"expected finite numbers, but position\[2, 1\] is nan"),
    "infinity": (np.where(PLAIN == -2.5, -np.inf, PLAIN), r"but position\[1, 0\] is -inf"),
    "overflow": ([[1e308 * 10, 0, 0]], r"position\[0, 0\] is inf"),
}
if np.dtype(np.longdouble).itemsize > 8:
    REFUSED["long double"] = (PLAIN.astype(np.longdouble), "at most float64")


@pytest.mark.parametrize("case", REFUSED)
def test_everything_else_is_refused_by_name(case: str) -> None:
    value, message = REFUSED[case]
    with pytest.raises(InvalidInput, match=message) as caught:
        float_array("position", value, ("N", 3))
    assert caught.value.argument == "position"
    assert str(caught.value).startswith("position: expected ")


def test_integers_of_python_have_no_largest() -> None:
    """The masses of the Sun and the Earth in kilograms are numbers; they are rounded as float() rounds them."""
    for value in ([2 * 10**30, 6 * 10**24], (2**53 + 1, -(2**53) - 1), [2**63, 0.5], np.array([10**30]), [2**64 - 1]):
        expected = [float(each) for each in value]
        assert float_array("mass", value, ("N",)).tolist() == expected
    assert float_array("mass", [[10**30], [1]], ("B", "N")).tolist() == [[1e30], [1.0]]
    assert number("mass", 2**70 + 1) == 2.0**70


def test_named_lengths_must_agree() -> None:
    sizes: Sizes = {}
    float_array("mass", [1.0, 2.0], ("N",), sizes)
    float_array("position", [[0.0] * 3] * 2, ("N", 3), sizes)
    with pytest.raises(InvalidInput, match=r"velocity: expected shape \(N, 3\) with N = 2 as in mass, got \(3, 3\)$"):
        float_array("velocity", [[0.0] * 3] * 3, ("N", 3), sizes)
    assert sizes == {"N": (2, "mass")}
    with pytest.raises(InvalidInput, match=r"expected shape \(M, M\), got \(2, 3\)"):
        float_array("tensor", np.zeros((2, 3)), ("M", "M"), sizes)
    assert sizes == {"N": (2, "mass")}
    empty: Sizes = {}
    float_array("mass", [], ("N",), empty)
    with pytest.raises(InvalidInput, match="N = 0 as in mass"):
        float_array("position", [[0.0] * 3], ("N", 3), empty)


def test_one_axis_of_any_length() -> None:
    with pytest.raises(InvalidInput, match=r"^t: expected an array with one axis, got shape \(1, 1\)$"):
        float_array("t", [[1.0]], (None,))


def test_a_plain_array_is_not_copied() -> None:
    assert float_array("x", PLAIN, (None, 3)) is PLAIN


@pytest.mark.parametrize(
    "value", [1, 1.0, np.float32(1), np.int8(1), np.array(1.0), np.float64(1.0), np.array(1, ">i4")]
)
def test_numbers(value: object) -> None:
    result = number("dt", value)
    assert type(result) is float
    assert result == 1.0


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (float("nan"), "dt is nan"),
        (np.float32("inf"), "dt is inf"),
        (True, "dtype bool"),
        (np.True_, "dtype bool"),
        ("1", "dtype str"),
        (1j, "dtype complex"),
        (None, "NoneType"),
        ([1.0], r"one real number, got an array of shape \(1,\)"),
        (10**400, "range of float64"),
    ],
)
def test_what_is_no_number_is_refused(value: object, message: str) -> None:
    with pytest.raises(InvalidInput, match=message) as caught:
        number("dt", value)
    assert caught.value.argument == "dt"
