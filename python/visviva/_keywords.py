"""Refuse calls that cannot be: keywords that are not taken, arguments that are missing, attributes that are frozen.

Every public function and class carries `known_keywords`; a test walks through all of them. The names are compared
before the call, so nothing has run when a keyword is refused, and a call without a mistake costs about 0.3 µs more.
Whether arguments are missing or too many Python finds itself; only then is it put in words.
"""

from __future__ import annotations

from functools import wraps
from inspect import Parameter, signature
from types import FunctionType
from typing import TYPE_CHECKING, Any, NoReturn, ParamSpec, TypeVar, overload

from visviva import _core
from visviva._elsewhere import MISSING, OF_KEYWORDS, SYMBOLS
from visviva._text import article
from visviva.errors import FrozenAttribute, InvalidInput, UnknownKeyword, WrongArguments

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

__all__ = [
    "JOINING",
    "check_call",
    "did_you_mean",
    "frozen",
    "known_keywords",
    "one_of",
    "refuse_subclass",
    "takes",
    "unknown_name",
]

# How bodies of two Particles become those of one.
JOINING = (
    "join their arrays: vv.Particles(np.concatenate([a.mass, b.mass]), np.concatenate([a.position, b.position]), "
    "np.concatenate([a.velocity, b.velocity])), and names and radius likewise, where bodies have some"
)

_P = ParamSpec("_P")
_R = TypeVar("_R")
_T = TypeVar("_T")
_PLACED = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
_NAMED = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)


@overload
def known_keywords(target: type[_T]) -> type[_T]: ...
@overload
def known_keywords(target: Callable[_P, _R]) -> Callable[_P, _R]: ...
def known_keywords(target: type[_T] | Callable[_P, _R]) -> type[_T] | Callable[_P, _R]:
    """Make a function, or the constructor and the public methods of a class, refuse wrong calls in words.

    Signature, documentation and types stay what they are. On a dataclass it stands above ``@dataclass``; a frozen one
    is made to refuse assignments in words, too (see `frozen`).

    Raises
    ------
    UnknownKeyword
        By what is decorated, when it is called with a keyword that it does not take.
    WrongArguments
        When an argument is missing or given twice, or there are too many.

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
        return _checked(target, target.__qualname__, 0)
    for attribute, value in list(vars(target).items()):
        if isinstance(value, FunctionType) and (attribute == "__init__" or not attribute.startswith("_")):
            called = target.__name__ if attribute == "__init__" else attribute
            setattr(target, attribute, _checked(value, called, 1))
        elif attribute == "__new__" and isinstance(value, staticmethod):  # of a NamedTuple
            setattr(target, attribute, staticmethod(_checked(value.__func__, target.__name__, 1)))
        elif isinstance(value, classmethod) and not attribute.startswith("_"):
            made = _checked(value.__func__, attribute, 1)
            setattr(target, attribute, classmethod(made))
    settings = vars(target).get("__dataclass_params__")
    return target if settings is None or not settings.frozen else frozen(target)


def frozen(target: type[_T]) -> type[_T]:
    """Make assignments to attributes of a class a `FrozenAttribute`, which says how to get a changed one.

    The class itself sets its attributes with ``object.__setattr__``, as a frozen dataclass does.

    Examples
    --------
    >>> from visviva._keywords import frozen
    >>> @frozen
    ... class Stone:
    ...     pass
    >>> Stone().weight = 3.0
    Traceback (most recent call last):
      ...
    visviva.errors.FrozenAttribute: weight: a Stone is frozen; make a new one instead
    """
    settings = vars(target).get("__dataclass_params__")

    def refused(self: object, name: str, _: object = None) -> NoReturn:
        known = _names(type(self).__init__)[1:] if settings is not None else ()
        word = type(self).__name__
        if name in known:
            advice = f"make a changed one with dataclasses.replace({word.lower()}, {name}=…)"
        else:
            advice = "make a new one instead" + did_you_mean(name, known)
        raise FrozenAttribute(name, f"{article(word)} is frozen; {advice}")

    for name in ("__setattr__", "__delattr__"):
        setattr(target, name, refused)
    return target


def refuse_subclass(made: type, advice: str) -> None:
    """Refuse a class that somebody derives from one whose kinds are the core's.

    Called by ``__init_subclass__``.

    Raises
    ------
    InvalidInput
        Unless the class is visviva's own.
    """
    if str(vars(made).get("__module__")).partition(".")[0] != "visviva":
        base = made.__bases__[0].__name__
        raise InvalidInput(
            base, f"expected no class derived from it, got {made.__name__}: the core knows its own only; {advice}"
        )


def did_you_mean(word: str, names: Iterable[str]) -> str:
    """The end of a message: the nearest of the names, if one is near at all.

    Capitals do not count, and ``-``, ``_`` and a space are the same. The core judges it, as it does of names that come
    to it.

    Examples
    --------
    >>> from visviva._keywords import did_you_mean
    >>> did_you_mean("Max Step", ["dt", "max_step"])
    "; did you mean 'max_step'?"
    """
    # Of names that differ in capitals alone the first is taken: toutatis is a function, Toutatis its class.
    ordered = sorted(names, key=lambda name: name[:1].isupper() != word[:1].isupper())
    # A name out of half a surrogate pair is a str of Python, but no text to anybody else.
    near = _core.nearest(word.encode(errors="replace").decode(), ordered)
    return f"; did you mean '{near}'?" if near else ""


def unknown_name(module: str, names: Iterable[str]) -> Callable[[str], NoReturn]:
    """The ``__getattr__`` of a room: a name that is not there is refused with where it is, or with the nearest one."""

    def refused(name: str) -> NoReturn:
        near = "" if name.startswith("_") else _near(module, name, tuple(names))
        raise AttributeError(f"module {module!r} has no attribute {name!r}{near}")

    return refused


def _near(room: str, name: str, names: tuple[str, ...]) -> str:
    import visviva
    from visviva._names_elsewhere import ANSWERS, IN_ROOMS, answer, plain

    # Coulomb is a force, too, which nobody looks for among cross sections.
    if room in ("visviva.scattering", "visviva.orbits") and name in visviva.potentials.__all__:
        return f"; it is visviva.potentials.{name}"
    told = answer(name, IN_ROOMS.get(room.removeprefix("visviva."), {}))
    if told or any(plain(name) == plain(each) for each in names):
        return f"; {told}" if told else did_you_mean(name, names)
    told = f"it is visviva.{name}" if name in visviva.__all__ else answer(name, ANSWERS)
    return f"; {told}" if told else did_you_mean(name, names)


def _names(function: Callable[..., object]) -> tuple[str, ...]:
    return tuple(name for name, parameter in signature(function).parameters.items() if parameter.kind in _NAMED)


def _checked(function: Callable[_P, _R], called: str, bound: int) -> Callable[_P, _R]:
    """`bound` is 1 where the first argument is the object or class itself."""
    names = _names(function)[bound:]
    are_known = frozenset(names).issuperset

    @wraps(function)
    def checked(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        if not are_known(kwargs):
            raise _unknown(function, called, names, next(name for name in kwargs if name not in names))
        try:
            return function(*args, **kwargs)
        except TypeError:
            wrong = _wrong(function, called, bound, args, kwargs)
            if wrong is None:
                raise
        raise wrong

    return checked


def _wrong(
    function: Callable[..., object], called: str, bound: int, args: tuple[object, ...], kwargs: dict[str, object]
) -> WrongArguments | None:
    """What is wrong with a call that does not fit the signature; None of one that does."""
    parameters = list(signature(function).parameters.values())[bound:]
    takes = f"{called} ({', '.join(_names(function)[bound:])})"
    placed = [parameter.name for parameter in parameters if parameter.kind in _PLACED]
    given, came = placed[: len(args) - bound], len(args) - bound
    if came > len(placed) and all(parameter.kind is not Parameter.VAR_POSITIONAL for parameter in parameters):
        most = f"at most {len(placed)} without a name" if placed else "none without a name"
        return WrongArguments(called, f"expected arguments as {takes} has them, {most}, got {came}")
    for name in given:
        if name in kwargs:
            return WrongArguments(name, f"expected once in a call of {takes}, got it by place and by name")
    for parameter in parameters:
        name = parameter.name
        if parameter.kind in _NAMED and parameter.default is Parameter.empty and name not in {*given, *kwargs}:
            advice = MISSING.get((called, name))
            return WrongArguments(
                name, f"expected with every call of {takes}, got none{f'; give it {advice}' if advice else ''}"
            )
    return None


def _unknown(function: Callable[..., object], called: str, names: tuple[str, ...], came: str) -> UnknownKeyword:
    expected = f"a keyword of {called} ({', '.join(names)})" if names else f"no keyword, {called} takes none"
    by_name = OF_KEYWORDS.get(("run" if called == "plan" else called, came))
    called_here = next((f"give it as {name}" for name in SYMBOLS.get(came, ()) if name in names), by_name)
    elsewhere = OF_KEYWORDS.get((function.__qualname__, came), called_here)
    advice = did_you_mean(came, names) if elsewhere is None else f"; {elsewhere}"
    return UnknownKeyword(came, f"expected {expected}, got {came!r}{advice}")


def one_of(argument: str, given: object, known: Iterable[str]) -> str:
    """Check a word out of several.

    Raises
    ------
    InvalidInput
        For anything else, with the nearest of them.

    Examples
    --------
    >>> from visviva._keywords import one_of
    >>> one_of("frame", "spce", ("body", "space"))
    Traceback (most recent call last):
      ...
    visviva.errors.InvalidInput: frame: expected one of body, space, got 'spce'; did you mean 'space'?
    """
    words = tuple(known)
    if not isinstance(given, str) or given not in words:
        near = did_you_mean(given, words) if isinstance(given, str) else ""
        raise InvalidInput(argument, f"expected one of {', '.join(words)}, got {given!r}{near}")
    return given


def check_call(
    argument: str, function: Callable[..., Any], places: Iterable[str], keywords: Iterable[str] = ()
) -> None:
    """Refuse a function that does not take what it will be called with."""
    places, keywords = tuple(places), tuple(keywords)
    try:
        signature(function).bind(*places, **dict.fromkeys(keywords))
    except TypeError as error:
        called = ", ".join([*places, *(f"{name}=" for name in keywords)])
        taken = ", ".join([*places, *keywords])
        raise InvalidInput(
            argument, f"the function is called with ({called}): {error}; define it as f({taken})"
        ) from None
    except ValueError:  # one that does not tell what it takes
        pass


def takes(function: Callable[..., Any], places: Iterable[str], keywords: Iterable[str] = ()) -> bool:
    """Whether a function can be called with these; one that does not tell what it takes may be."""
    try:
        check_call("function", function, places, keywords)
    except InvalidInput:
        return False
    return True
