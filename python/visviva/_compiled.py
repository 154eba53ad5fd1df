"""Compiled functions: which they are, where they are, and whether they take data.

That of a right-hand side is ``void f(double t, const double *y, double *rate)``, with a ``void *data`` at the end or
without.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np

from visviva._arrays import float_array
from visviva.errors import InvalidInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["Compiled", "compiled", "sampler"]

_SIGNATURE = "void f(double t, const double *y, double *rate), with void *data at the end or without"
_FUNCTION: Any = type(ctypes.CFUNCTYPE(None)()).__mro__[1]  # ctypes names it with an underscore
_POINTER = ctypes.POINTER(ctypes.c_double)
_PLAIN = "void(double,double*,double*)"
# Made once: a union of types takes longer to make than to ask.
_WHOLE = int | np.integer
_WITH_DATA = ("void(double,double*,double*,void*)", "void(double,double*,double*,double*)")


class Compiled:
    """A compiled function, its data, and what keeps both alive.

    Attributes
    ----------
    where : tuple
        The address of the function and of its data; None for a function that takes none.
    """

    def __init__(self, address: int | None, data: int | None, *keep: object) -> None:
        if not _can_be_called(address):
            raise InvalidInput("fun", f"expected the address of {_SIGNATURE}, got {address}; pass the function itself")
        self.where = (address, data)
        self._keep = keep


def compiled(fun: Any, args: object) -> Compiled | None:
    """Give the compiled function that this is, or None for a function of Python.

    An address, a ``@cfunc`` of numba, a function of ctypes, or a ``scipy.LowLevelCallable``; `args` are its data as an
    array of float64.

    Raises
    ------
    InvalidInput
        For a compiled function of another signature, and for data that it does not take.
    """
    if isinstance(fun, _WHOLE) and not isinstance(fun, bool):
        data = _numbers(args)
        return Compiled(int(fun), None if data is None else data.ctypes.data, data)
    if isinstance(fun, _FUNCTION):
        return _with(fun, ctypes.cast(fun, ctypes.c_void_p).value, _takes_data(_of_ctypes(fun)), args)
    if isinstance(fun, tuple) and type(fun).__name__ == "LowLevelCallable":
        return _low_level(fun, args)
    if isinstance(getattr(fun, "address", None), int) and hasattr(fun, "native_name"):  # numba's CFunc
        return _with(fun, fun.address, _takes_data(_of_numba(fun)), args)
    return None


def is_compiled(function: object) -> bool:
    """Whether it is a compiled function of whatever signature, and no address of one."""
    return isinstance(function, _FUNCTION) or hasattr(function, "native_name")


def function_of_distance(function: Any) -> Callable[[float], float] | None:
    """Give the compiled function ``double f(double r)`` that this is, or None for a function of Python.

    Raises
    ------
    InvalidInput
        For a compiled function of another signature.
    """
    address = _address(function, "double(double)", "double f(double r)")
    if address is None:
        return None
    compiled = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(address)
    vars(compiled)["kept"] = function  # alive as long as what is called
    return compiled


def torque_address(function: Any) -> int:
    """Give the address of a compiled function of the time, a quaternion and an angular velocity that writes a torque.

    Raises
    ------
    InvalidInput
        For anything else.
    """
    expected = "void f(double t, const double *orientation, const double *angular_velocity, double *torque)"
    address = _address(function, "void(double,double*,double*,double*)", expected)
    if address is None:
        cure = "; compile it with numba.cfunc, or wrap it in a ctypes.CFUNCTYPE; of a formula take vv.ExpressionTorque"
        advice = cure if callable(function) else ""
        raise InvalidInput("function", f"expected a compiled {expected}, got {type(function).__name__}{advice}")
    return address


def _address(function: Any, expected: str, described: str) -> int | None:
    """Where a compiled function of the expected signature is; None of anything else than a compiled function."""
    address, signature = None, expected
    if isinstance(function, int | np.integer) and not isinstance(function, bool):
        address = int(function)
    elif isinstance(function, _FUNCTION):
        address, signature = ctypes.cast(function, ctypes.c_void_p).value, _of_ctypes(function, expected)
    elif isinstance(function, tuple) and type(function).__name__ == "LowLevelCallable":
        address, _, signature = _capsule(function, "function", described)
    elif isinstance(getattr(function, "address", None), int) and hasattr(function, "native_name"):  # numba's CFunc
        address, signature = function.address, _of_numba(function)
    else:
        return None
    if signature != expected:
        raise InvalidInput("function", f"expected a compiled function {described}, got {signature}")
    if not _can_be_called(address):
        raise InvalidInput("function", f"expected the address of {described}, got {address}; pass the function itself")
    return address


def _can_be_called(address: int | None) -> TypeGuard[int]:
    """Whether there may be code at an address: a slip as 0 or 3 would end the process.

    No system maps the first 64 KiB.
    """
    return address is not None and 1 << 16 <= address < 1 << 8 * ctypes.sizeof(ctypes.c_void_p)


def sampler(function: Any, of: str) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Give what samples a function of ``of``, compiled or of Python, at an array.

    Raises
    ------
    InvalidInput
        For what is no function; when it is called, for results that are no real numbers of the shape of the array.
    """
    compiled = function_of_distance(function)
    if compiled is None and not callable(function):
        raise InvalidInput(
            "function", f"expected a function of {of}, or a compiled double f(double), got {type(function).__name__}"
        )

    def sample(places: NDArray[np.float64]) -> NDArray[np.float64]:
        if compiled is not None:
            return np.array([compiled(place) for place in places.tolist()])
        shape = places.shape
        values = np.asarray(function(places))
        if values.shape != shape:
            raise InvalidInput(
                "function",
                f"expected one value for each {of}, shape {shape}, got shape {values.shape}; write it for arrays, "
                "or wrap it in numpy.vectorize",
            )
        if values.dtype.kind not in "fiu":
            raise InvalidInput("function", f"expected real numbers, got an array of {values.dtype.name}")
        return values.astype(np.float64)

    return sample


def _with(fun: object, address: int | None, takes_data: bool, args: object) -> Compiled:
    data = _numbers(args)
    if data is not None and not takes_data:
        raise InvalidInput(
            "args", "expected none for a compiled function without data; add void *data to its arguments"
        )
    pointer = (0 if data is None else data.ctypes.data) if takes_data else None
    return Compiled(address, pointer, fun, data)


def _numbers(args: object) -> np.ndarray[Any, np.dtype[np.float64]] | None:
    return None if args is None else float_array("args", args, (None,))


def _takes_data(signature: str) -> bool:
    if signature == _PLAIN:
        return False
    if signature in _WITH_DATA:
        return True
    raise InvalidInput("fun", f"expected a compiled function {_SIGNATURE}, got {signature}")


def _of_ctypes(fun: Any, expected: str = _PLAIN) -> str:
    """Its signature; one that declares none is taken for what is expected."""
    if fun.argtypes is None:
        return expected
    names = {ctypes.c_double: "double", _POINTER: "double*", ctypes.c_void_p: "void*"}
    result = "void" if fun.restype is None else names.get(fun.restype, fun.restype.__name__)
    return f"{result}({','.join(names.get(kind, kind.__name__) for kind in fun.argtypes)})"


def _of_numba(fun: Any) -> str:
    signature = fun._sig
    names = {"float64": "double", "float64*": "double*", "void*": "void*", "none": "void"}
    kinds = [names.get(kind.name, kind.name) for kind in (signature.return_type, *signature.args)]
    return f"{kinds[0]}({','.join(kinds[1:])})"


def _low_level(fun: Any, args: object) -> Compiled:
    address, context, signature = _capsule(fun, "fun", _SIGNATURE)
    if context is None:
        return _with(fun, address, _takes_data(signature), args)
    if args is not None:
        raise InvalidInput("args", "expected none beside the user_data of the LowLevelCallable; give one of them")
    return Compiled(address, context if _takes_data(signature) else None, fun)


def _capsule(fun: Any, argument: str, expected: str) -> tuple[int | None, int | None, str]:
    """Take the pointers out of the capsule that SciPy keeps in the tuple; a C string there is the signature."""
    api = ctypes.pythonapi
    kinds: dict[str, tuple[type, list[type]]] = {
        "PyCapsule_GetName": (ctypes.c_char_p, [ctypes.py_object]),
        "PyCapsule_GetContext": (ctypes.c_void_p, [ctypes.py_object]),
        "PyCapsule_GetPointer": (ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]),
    }

    def ask(name: str, *arguments: object) -> Any:
        prototype: Callable[..., Any] = ctypes.PYFUNCTYPE(kinds[name][0], *kinds[name][1])((name, api))
        return prototype(*arguments)

    capsule = tuple.__getitem__(fun, 0)
    name = ask("PyCapsule_GetName", capsule)
    if name is None:
        raise InvalidInput(argument, f"expected a LowLevelCallable of {expected}, got one without a signature")
    signature = name.decode().replace("const ", "").replace(" ", "")
    return ask("PyCapsule_GetPointer", capsule, name), ask("PyCapsule_GetContext", capsule), signature
