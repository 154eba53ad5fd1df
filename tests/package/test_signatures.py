"""The types of the public API: none is `Any`, and every class of ours that something gives has a public name."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import types
from dataclasses import fields, is_dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_overloads

import pytest

import visviva as vv
from visviva import request

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(vv.__file__).parent
ROOMS = [vv, *(getattr(vv, room) for room in vv._ROOMS)]
FOUND = ["visviva", *(found.name for found in pkgutil.walk_packages(vv.__path__, "visviva."))]
MODULES = [name for name in FOUND if not name.endswith(("_core", "__main__"))]

#: Python's own ways, whose types Python says.
OF_PYTHON = {
    "__init_subclass__", "__reduce__", "__setstate__", "__getattr__", "__array_ufunc__", "__dataclass_fields__",
}  # fmt: skip
#: What is `Any`, and why.
ANY = {
    "coordinate: return": "one coordinate or a tuple of them, by how many names the text holds",
    **dict.fromkeys(
        [
            "Trajectory.__init__: result", "EnsembleTrajectory.__init__: result",
            "generalized.GeneralizedTrajectory.__init__: result", "generalized.GeneralizedTrajectory.__init__: asked",
            "generalized.GeneralizedEnsembleTrajectory.__init__: result",
            "generalized.GeneralizedEnsembleTrajectory.__init__: asked",
        ],
        "a run makes it of what the core gave; nobody else does",
    ),
}  # fmt: skip


@cache
def tree(module: str) -> ast.Module:
    return ast.parse(Path(importlib.import_module(module).__file__ or "").read_text(encoding="utf-8"))


def statements(module: str) -> Iterator[ast.stmt]:
    """At the top of a module, and of what it imports for type checkers."""
    for statement in tree(module).body:
        yield from [*statement.body, *statement.orelse] if isinstance(statement, ast.If) else [statement]


def names_in(annotation: object) -> set[str]:
    """The names of an annotation, as it is written."""
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__forward_arg__", None)
    if text is None:
        return {"Any"} if annotation is Any else {getattr(annotation, "__name__", "")}
    found = [*ast.walk(ast.parse(text.strip(), mode="eval"))]
    inner = {name for each in found if isinstance(each, ast.Constant) and isinstance(each.value, str)
             for name in (names_in(each.value) if each.value.replace(".", "").isidentifier() else ())}  # fmt: skip
    return inner | {each.id for each in found if isinstance(each, ast.Name)}


@cache
def opaque() -> frozenset[str]:
    """`Any`, and the names of types that are made of it."""
    written: dict[str, set[str]] = {}
    for module in MODULES:
        for each in statements(module):
            if isinstance(each, ast.AnnAssign) and ast.unparse(each.annotation) == "TypeAlias" and each.value:
                value = each.value.value if isinstance(each.value, ast.Constant) else ast.unparse(each.value)
                written[ast.unparse(each.target)] = names_in(str(value))
    found = {"Any"}
    while more := {name for name, parts in written.items() if parts & found} - found:
        found |= more
    return frozenset(found)


def annotated() -> Iterator[tuple[str, str, object]]:
    """Label, module, and annotation of all that is public: arguments, what is given, attributes."""
    seen: set[int] = set()
    for room in ROOMS:
        for name in room.__all__:
            thing, where = getattr(room, name), f"{room.__name__}.{name}".removeprefix("visviva.")
            if id(thing) in seen or not (inspect.isclass(thing) or inspect.isroutine(thing)):
                continue
            seen.add(id(thing))
            if not inspect.isclass(thing):
                yield from of_function(where, thing)
                continue
            for kind in thing.__mro__:
                # What is made from the registry has its types in a stub, and words for people here.
                if kind.__module__.startswith("visviva") and "_parameters" not in vars(kind):
                    yield from of_class(where, kind)


def requests_of(function: types.FunctionType) -> list[type]:
    """The requests whose fields are its arguments (see `visviva.request.asked_by`)."""
    written = inspect.get_annotations(inspect.unwrap(function)).values()
    return [kind for name in written if is_dataclass(kind := getattr(request, str(name), None)) and kind is not None]


def of_class(where: str, kind: type) -> Iterator[tuple[str, str, object]]:
    for name, annotation in inspect.get_annotations(kind).items():
        if not name.startswith("_"):
            yield f"{where}.{name}: attribute", kind.__module__, annotation
    for name, value in vars(kind).items():
        if name in OF_PYTHON or (name.startswith("_") and not name.startswith("__")):
            continue
        plain = value.fget if isinstance(value, property) else value
        plain = value.func if isinstance(value, cached_property) else getattr(plain, "__func__", plain)
        if isinstance(plain, types.FunctionType):
            yield from of_function(f"{where}.{name}", plain)
            # Who takes what a request has is written as taking the request.
            for asked in requests_of(plain):
                yield from ((f"{where}.{name}: {each.name}", asked.__module__, each.type) for each in fields(asked))


def of_function(where: str, function: Any) -> Iterator[tuple[str, str, object]]:
    plain = inspect.unwrap(function)
    for each in (plain, *get_overloads(plain)):
        for name, annotation in inspect.get_annotations(each).items():
            if name not in ("self", "cls"):
                yield f"{where}: {name}", plain.__module__, annotation


ALL = list(annotated())


def test_nothing_public_is_any() -> None:
    found = {label for label, _, annotation in ALL if names_in(annotation) & opaque()}
    assert found - set(ANY) == set()
    assert set(ANY) - found == set(), "take these out of ANY"


def test_what_a_type_checker_reads_of_registered_classes_has_no_any() -> None:
    for stub in ("forces.pyi", "potentials.pyi"):
        for each in ast.walk(ast.parse((ROOT / stub).read_text(encoding="utf-8"))):
            if isinstance(each, ast.FunctionDef) and each.name not in OF_PYTHON and "from_core" not in each.name:
                given = [ast.unparse(a.annotation) for a in [*each.args.args, *each.args.kwonlyargs] if a.annotation]
                for annotation in (*given, ast.unparse(each.returns) if each.returns else "None"):
                    assert not names_in(annotation) & opaque(), (stub, each.name, annotation)


def test_public_names_of_values_have_types() -> None:
    data = {name for room in ROOMS for name in room.__all__}
    for module in MODULES:
        for each in statements(module):
            if isinstance(each, ast.AnnAssign) and ast.unparse(each.target) in data:
                assert "Any" not in names_in(ast.unparse(each.annotation)), ast.unparse(each)


@cache
def homes(module: str) -> dict[str, str]:
    """Where the names of a module that are ours come from."""
    found: dict[str, str] = {}
    for each in statements(module):
        if isinstance(each, ast.ImportFrom) and (each.module or "").startswith("visviva"):
            found |= {alias.asname or alias.name: f"{each.module}.{alias.name}" for alias in each.names}
        elif isinstance(each, ast.ClassDef):
            found[each.name] = f"{module}.{each.name}"
    return found


PUBLIC = {id(getattr(room, name)) for room in ROOMS for name in room.__all__}


@pytest.mark.parametrize("module", sorted({module for _, module, _ in ALL}))
def test_every_class_that_something_gives_has_a_public_name(module: str) -> None:
    for label, of, annotation in ALL:
        if of != module or not label.endswith((": return", ": attribute")):
            continue
        for name in names_in(annotation) & set(homes(module)):
            where, _, own = homes(module)[name].rpartition(".")
            kind = getattr(importlib.import_module(where), own, None)
            assert not isinstance(kind, type) or id(kind) in PUBLIC, (label, name)


def test_the_walk_finds_what_there_is() -> None:
    labels = {label for label, _, _ in ALL}
    known = {"Scene.run: t", "Trajectory.events: return", "load: return", "orbits.Elements.eccentricity: attribute"}
    assert known <= labels
    assert len(ALL) > 2000
    assert names_in("dict[str, Any] | None") & opaque()
