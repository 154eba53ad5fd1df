"""Every example in a docstring runs and gives what it says."""

import ast
import doctest
import importlib
import inspect
import itertools
import pkgutil
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
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
    # A reader has what an example imports, and nothing else; what the core wrote of forces leaves out NumPy.
    names = {"np": np} if name == "visviva.forces" else {}
    failed, tried = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE, globs=names)
    assert failed == 0
    assert tried > 0 or name.rsplit(".", maxsplit=1)[-1] not in PUBLIC


def documented() -> dict[str, Any]:
    """Every public class, function and method by its name, each once; what was made from a registry has one class.

    What a class has of a base that nobody is shown is told under the first class that has it.
    """
    rooms = {where: getattr(visviva, where) if where else visviva for where in ("", *visviva._ROOMS)}
    public = {id(getattr(room, name)) for room in rooms.values() for name in room.__all__}
    found: dict[str, Any] = {}
    seen: set[int] = set()
    for where, room in rooms.items():
        for name in room.__all__:
            thing = getattr(room, name)
            if id(thing) in seen or not (inspect.isclass(thing) or inspect.isroutine(thing)):
                continue
            seen.add(id(thing))
            found[f"{where}.{name}".lstrip(".")] = thing
            for base in thing.__mro__ if inspect.isclass(thing) else ():
                if base is not thing and (id(base) in public or not base.__module__.startswith("visviva")):
                    continue
                for attribute, value in vars(base).items():
                    plain = value if isinstance(value, property) else getattr(value, "__func__", value)
                    path = f"{where}.{name}.{attribute}".lstrip(".")
                    hidden = attribute.startswith("_") and attribute != "__call__"
                    if hidden or id(plain) in seen or path in found:
                        continue
                    if inspect.isfunction(plain) or isinstance(plain, property):
                        seen.add(id(plain))
                        found[path] = plain
    return found


DOCUMENTED = documented()
#: They refuse, whatever they are given.
NO_EXAMPLE = {f"CompiledTorque.{name}" for name in ("rotated", "rescaled")}
#: They do what they say with whatever they are given: turn, put together, look up.
REFUSE_NOTHING = {
    *NO_EXAMPLE, "AppliedTorque.rotated", "AttachedSpring.rotated", "RigidBodies.rotated", "WorkPrecision.joined",
    "forces.Force.rotated", "generalized.Expression.arctan2", "OdeResult.get",
}  # fmt: skip
#: How units are said; a few units in the last place are none, nor is a field of that name.
UNITS = re.compile(
    r"(?<!few )\b[Uu]nits\b(?!`)|[Dd]imension|\bradians\b|\b[Ii]n (degrees|days|seconds)\b|\beV\b|µm|Å|\bBytes\b"
)
#: Modules of formulas and methods, by how their names begin: what they have is published somewhere.
FORMULAS = (
    "_audit", "_custom_potential", "_drag_throw", "_event_table", "_field_problems", "_frames", "_from_elements",
    "_relative_equilibria", "_rigid_frames", "advice", "audit", "body_turning", "collision_table", "collisions",
    "comparison", "conservation", "datasets", "drag", "expression_force", "forces", "generalized", "initial_value",
    "invariants", "orbits", "potentials", "problems", "rigid", "scattering", "systems", "units",
)  # fmt: skip
#: They hold, name, read or convert; or each has its own source, as methods and problems have.
NO_SOURCE = {
    "coordinate", "forces.Force", "Option", "Point", "Scene.with_state", "WorkPrecision", "Drift",
    "generalized.GeneralizedEnsemble", "generalized.GeneralizedEnsembleTrajectory", "generalized.GeneralizedEventTable",
    "generalized.GeneralizedPlan", "generalized.GeneralizedStats", "potentials.Potential",
    "potentials.potential_by_name",
    "rigid.from_scipy", "rigid.load_mesh", "rigid.methods", "rigid.to_scipy",
    "scattering.Bins", "scattering.Bombardment", "scattering.CrossSection", "scattering.DeflectionStatus",
    "scattering.Fraction", "scattering.Ion", "scattering.Spectrum", "scattering.Spread",
}  # fmt: skip


@pytest.mark.parametrize("name", DOCUMENTED)
def test_every_public_name_is_documented(name: str) -> None:
    """With an example, and functions with all of their arguments and what they refuse."""
    thing = DOCUMENTED[name]
    told = inspect.getdoc(thing) or ""
    assert told
    if isinstance(thing, property):
        return
    assert ">>>" in told or name in NO_EXAMPLE
    assert "+SKIP" not in told
    if inspect.isclass(thing):
        return
    arguments = [each for each in inspect.signature(thing).parameters if each not in ("self", "cls")]
    if not arguments or name in NO_EXAMPLE:
        return
    for argument in arguments:
        assert re.search(rf"(?m)^(\*{{0,2}}\w+, )*\*{{0,2}}{argument}\b", told), argument
    assert "Parameters\n---" in told
    assert "Raises\n---" in told or name in REFUSE_NOTHING


ROUTINES = [name for name, thing in DOCUMENTED.items() if inspect.isroutine(thing) and name not in NO_EXAMPLE]


@pytest.mark.parametrize("name", ROUTINES)
def test_what_is_returned_is_documented(name: str) -> None:
    """Under Returns, or Yields of a generator; a function that returns nothing has neither."""
    thing = DOCUMENTED[name]
    told = sections(inspect.getdoc(thing) or "")
    generates = inspect.isgeneratorfunction(inspect.unwrap(thing))
    if inspect.signature(thing).return_annotation in ("None", "NoReturn"):
        assert not {"Returns", "Yields"} & {*told}
    else:
        assert told.get("Yields" if generates else "Returns", "").strip()


def sections(told: str) -> dict[str, str]:
    """What a docstring says under each of its headings; under "" what comes before the first."""
    first, *parts = re.split(r"(?m)^(\w[\w ]*)\n-{3,}$\n", told)
    return {"": first, **dict(zip(parts[::2], parts[1::2], strict=True))}


def types(thing: Any) -> str:
    """The types of what a function takes and gives, of a property gives; of a class what its docstring has."""
    if inspect.isclass(thing):
        told = sections(inspect.getdoc(thing) or "")
        return " ".join(re.findall(r"(?m)^\S.* : (.*)$", told.get("Parameters", "") + told.get("Attributes", "")))
    return str(inspect.get_annotations(getattr(thing, "fget", thing)))


@pytest.mark.parametrize("name", DOCUMENTED)
def test_arrays_have_shapes(name: str) -> None:
    """Each entry of an array says its shape, or all do at once; where numbers broadcast, what comes of them says it."""
    told = sections(inspect.getdoc(DOCUMENTED[name]) or "")
    for heading in ("Parameters", "Attributes", "Returns", "Yields"):
        for entry in re.findall(r"(?m)^\S.*(?:\n .*)*", told.get(heading, "")):
            first = entry.partition("\n")[0]
            if "array" in first and (" : " in first or heading in ("Returns", "Yields")):
                told_elsewhere = told[""] + (told.get("Returns", "") if heading == "Parameters" else "")
                assert re.search("(?i)shape|broadcast", entry + told_elsewhere), entry
    # So does whatever else is about arrays: what gives a result that has some, an example that prints one.
    said = "".join(text for heading, text in told.items() if heading not in ("Raises", "Examples"))
    printed = re.sub(r"(?m)^(>>>|\.\.\.).*", "", told.get("Examples", ""))
    if re.search("(?i)array", types(DOCUMENTED[name]) + said + printed) and name not in NO_EXAMPLE:
        assert re.search("(?i)shape|broadcast", said)


@pytest.mark.parametrize("name", DOCUMENTED)
def test_quantities_have_units(name: str) -> None:
    """In words: those of the scene or of the caller, a dimension, radians, eV, or that there is none."""
    if re.search("float|(?i:array)", types(DOCUMENTED[name])):
        told = sections(inspect.getdoc(DOCUMENTED[name]) or "")
        assert any(UNITS.search(text) for heading, text in told.items() if heading != "Examples")


@pytest.mark.parametrize("name", [name for name, thing in DOCUMENTED.items() if isinstance(thing, property)])
def test_properties_have_examples(name: str) -> None:
    """Their own, or a line in that of their class."""
    owner, _, attribute = name.rpartition(".")
    examples = re.findall(r"(?m)^(?:>>>|\.\.\.) .*", inspect.getdoc(DOCUMENTED[owner]) or "")
    assert ">>>" in (inspect.getdoc(DOCUMENTED[name]) or "") or re.search(rf"\.{attribute}\b", "\n".join(examples))


@pytest.mark.parametrize("name", [name for name, thing in DOCUMENTED.items() if not isinstance(thing, property)])
def test_formulas_have_sources(name: str) -> None:
    """In the docstring; of a method that of its class is enough."""
    thing, owner = DOCUMENTED[name], DOCUMENTED.get(name.rpartition(".")[0])
    if (
        not thing.__module__.removeprefix("visviva.").startswith(FORMULAS)
        or {name, name.rpartition(".")[0]} & NO_SOURCE
    ):
        return
    told = (inspect.getdoc(thing) or "") + (inspect.getdoc(owner) or "" if inspect.isclass(owner) else "")
    assert re.search(r"(?m)^References\n---|\(\d{4}\)|\d(rd|nd) ed\.|§", told)


def sentences(module: ModuleType) -> dict[str, str]:
    """What a module says of its data: the string after each assignment, which is what the reference shows."""
    body = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8")).body
    found = {}
    for line, after in itertools.pairwise(body):
        if isinstance(line, ast.Assign | ast.AnnAssign) and isinstance(after, ast.Expr):
            name = line.targets[0] if isinstance(line, ast.Assign) else line.target
            found[ast.unparse(name)] = str(ast.literal_eval(after.value))
    return found


DATA = [
    (room, name)
    for room in (visviva.typing, visviva.units)
    for name in room.__all__
    if not inspect.isclass(getattr(room, name))
]


@pytest.mark.parametrize(("room", "name"), DATA, ids=[name for _, name in DATA])
def test_data_have_sentences(room: ModuleType, name: str) -> None:
    """Each of its own; constants their unit and source, systems of units their source."""
    told = sentences(room)[name]
    if room is visviva.typing:
        assert list(sentences(room).values()).count(told) == 1
    else:
        assert re.search(r" Source: .*\d.*\.$", told)
    if isinstance(getattr(room, name), float):
        assert re.match(r"In (m|s|kg|C|J|F|m³|au\^1\.5|J s)[/, :(]", told)


def test_as_many_names_as_there_are() -> None:
    assert len(DOCUMENTED) > 600
    assert {*NO_EXAMPLE, *REFUSE_NOTHING, *NO_SOURCE} <= {*DOCUMENTED}
