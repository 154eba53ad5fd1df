"""Every example in a docstring runs and gives what it says."""

import doctest
import importlib
import inspect
import pkgutil
import re
from typing import Any

import pytest

import visviva

MODULES = [
    "visviva",
    *(m.name for m in pkgutil.walk_packages(visviva.__path__, "visviva.") if "__main__" not in m.name),
]
PUBLIC = {
    "forces",
    "particles",
    "plan",
    "potentials",
    "problems",
    "scene",
    "trajectory",
    "ensemble",
    "io",
    "integrators",
}


@pytest.mark.parametrize("name", MODULES)
def test_examples(name: str) -> None:
    module = importlib.import_module(name)
    failed, tried = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert failed == 0
    assert tried > 0 or name.rsplit(".", maxsplit=1)[-1] not in PUBLIC


def documented() -> dict[str, Any]:
    """Every public class, function and method by its name, each once; what was made from a registry has one class."""
    found: dict[str, Any] = {}
    seen: set[int] = set()
    for where in ("", *visviva._ROOMS):
        room = getattr(visviva, where) if where else visviva
        for name in room.__all__:
            thing = getattr(room, name)
            if id(thing) in seen or not (inspect.isclass(thing) or inspect.isroutine(thing)):
                continue
            seen.add(id(thing))
            found[f"{where}.{name}".lstrip(".")] = thing
            for attribute, value in vars(thing).items() if inspect.isclass(thing) else ():
                plain = getattr(value, "__func__", value)
                if not attribute.startswith("_") and (inspect.isfunction(plain) or isinstance(value, property)):
                    found[f"{where}.{name}.{attribute}".lstrip(".")] = value if isinstance(value, property) else plain
    return found


DOCUMENTED = documented()
#: They refuse, whatever they are given.
NO_EXAMPLE = {f"CompiledTorque.{name}" for name in ("rotated", "rescaled")}
#: They do what they say with whatever they are given: turn, put together, look up.
REFUSE_NOTHING = {
    *NO_EXAMPLE, "AppliedTorque.rotated", "AttachedSpring.rotated", "RigidBodies.rotated", "WorkPrecision.joined",
    "forces.Force.rotated", "generalized.Expression.arctan2", "OdeResult.get",
}  # fmt: skip


@pytest.mark.parametrize("name", DOCUMENTED)
def test_every_public_name_is_documented(name: str) -> None:
    """With an example, and functions with all of their arguments, what they return and what they refuse."""
    thing = DOCUMENTED[name]
    told = inspect.getdoc(thing) or ""
    assert told
    if isinstance(thing, property):
        return
    assert ">>>" in told or name in NO_EXAMPLE
    if inspect.isclass(thing):
        return
    arguments = [each for each in inspect.signature(thing).parameters if each not in ("self", "cls")]
    if not arguments or name in NO_EXAMPLE:
        return
    for argument in arguments:
        assert re.search(rf"(?m)^(\*{{0,2}}\w+, )*\*{{0,2}}{argument}\b", told), argument
    assert "Parameters\n---" in told
    assert "Raises\n---" in told or name in REFUSE_NOTHING
    if not inspect.isclass(DOCUMENTED.get(name.rpartition(".")[0])):
        assert re.search(r"(Returns|Yields)\n---", told)


def test_as_many_names_as_there_are() -> None:
    assert len(DOCUMENTED) > 500
    assert {*NO_EXAMPLE, *REFUSE_NOTHING} <= {*DOCUMENTED}
