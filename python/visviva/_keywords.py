"""Refuse a keyword that a function does not take, by name and with the nearest one that it does take.

Every public function and class carries `known_keywords`; a test walks through all of them. The names are compared
before the call, so nothing has run when a keyword is refused, and a call without a mistake costs about 0.3 µs more.
"""

from __future__ import annotations

from functools import wraps
from inspect import Parameter, signature
from types import FunctionType
from typing import TYPE_CHECKING, ParamSpec, TypeVar, overload

from visviva import _core
from visviva.errors import UnknownKeyword

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

__all__ = ["did_you_mean", "known_keywords"]

_P = ParamSpec("_P")
_R = TypeVar("_R")
_T = TypeVar("_T")
_NAMED = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)


@overload
def known_keywords(target: type[_T]) -> type[_T]: ...
@overload
def known_keywords(target: Callable[_P, _R]) -> Callable[_P, _R]: ...
def known_keywords(target: type[_T] | Callable[_P, _R]) -> type[_T] | Callable[_P, _R]:
    """Make a function, or the constructor and the public methods of a class, refuse unknown keywords.

    Signature, documentation and types stay what they are. On a dataclass it stands above ``@dataclass``.

    Raises
    ------
    UnknownKeyword
        By what is decorated, when it is called with a keyword that it does not take.

    Examples
    --------
    >>> from visviva._keywords import known_keywords
    >>> @known_keywords
    ... def work(force, distance):
    ...     return force * distance
    >>> work(force=2.0, distnace=3.0)
    Traceback (most recent call last):
      ...
    visviva.errors.UnknownKeyword: distnace: expected a keyword of work (force, distance), got 'distnace'; did you \
mean 'distance'?
    """
    if not isinstance(target, type):
        return _checked(target, target.__qualname__, _names(target))
    for attribute, value in list(vars(target).items()):
        if isinstance(value, FunctionType) and (attribute == "__init__" or not attribute.startswith("_")):
            called = target.__name__ if attribute == "__init__" else attribute
            setattr(target, attribute, _checked(value, called, _names(value)[1:]))
    return target


def did_you_mean(word: str, names: Iterable[str]) -> str:
    """The end of a message: the nearest of the names, if one is near at all.

    Capitals do not count, and ``-``, ``_`` and a space are the same. The core judges, as it does of the names that
    come to it.

    Examples
    --------
    >>> from visviva._keywords import did_you_mean
    >>> did_you_mean("Max Step", ["dt", "max_step"])
    "; did you mean 'max_step'?"
    """
    # A name out of half a surrogate pair is a str of Python, but no text to anybody else.
    near = _core.nearest(word.encode(errors="replace").decode(), list(names))
    return f"; did you mean '{near}'?" if near else ""


def _names(function: Callable[..., object]) -> tuple[str, ...]:
    return tuple(name for name, parameter in signature(function).parameters.items() if parameter.kind in _NAMED)


def _checked(function: Callable[_P, _R], called: str, names: tuple[str, ...]) -> Callable[_P, _R]:
    are_known = frozenset(names).issuperset

    @wraps(function)
    def checked(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        if not are_known(kwargs):
            raise _unknown(called, names, next(name for name in kwargs if name not in names))
        return function(*args, **kwargs)

    return checked


def _unknown(called: str, names: tuple[str, ...], came: str) -> UnknownKeyword:
    expected = f"a keyword of {called} ({', '.join(names)})" if names else f"no keyword, {called} takes none"
    return UnknownKeyword(came, f"expected {expected}, got {came!r}{did_you_mean(came, names)}")
