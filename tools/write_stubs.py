"""Write what follows from the core's registry and has to stand in a file for editors and type checkers.

The stubs of `visviva.forces` and `visviva.potentials`, and the forces among the names of `visviva/__init__.py`:

    python tools/write_stubs.py          writes them
    python tools/write_stubs.py --check  says what is not up to date, and fails
"""

import re
import sys
from pathlib import Path
from typing import Any

from visviva import _core

PACKAGE = Path(__file__).parents[1] / "python" / "visviva"
WRITTEN = "# Written by tools/write_stubs.py from the core's registry.\n"
FIELD = {
    "number": "float",
    "numbers": "float | NDArray[np.float64]",
    "indices": "int | str | tuple[int | str, ...] | NDArray[np.int64]",
    "vector": "tuple[float, float, float]",
    "axial_vector": "tuple[float, float, float]",
    "direction": "tuple[float, float, float]",
    "point": "tuple[float, float, float]",
    "potential": "Potential",
    "choice": "str",
    "table": "NDArray[np.float64]",
}
ARGUMENT = FIELD | dict.fromkeys(
    ("numbers", "indices", "vector", "axial_vector", "direction", "point", "table"), "ArrayLike"
)

# What a class has beside what is declared.
FURTHER = {
    "ScreenedCoulomb": """    @classmethod
    def between(
        cls,
        Z1: float,
        Z2: float,
        screening: ScreeningName = "zbl",
        e2: float = 14.399645478,
        bohr_radius: float = 0.529177210544,
    ) -> Self: ...
"""
}

FORCES = """from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from visviva._declared import Declared
from visviva.potentials import Potential

__all__ = [{names}]

class Force(Declared):
    kind: ClassVar[str]
    def __init_subclass__(cls, **arguments: Any) -> None: ...
    def shifted(self, position: NDArray[np.float64], velocity: NDArray[np.float64]) -> Self: ...
    def _resolved(self, names: tuple[str, ...], count: int) -> Self: ...
    def rotated(self, rotation: NDArray[np.float64]) -> Self: ...
    def reversed(self) -> Self: ...
    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self: ...
{classes}
def force_from_core(description: dict[str, Any]) -> Force: ...
"""

POTENTIALS = """from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self, overload

import numpy as np
import sympy
from numpy.typing import ArrayLike, NDArray

from visviva._declared import Declared
from visviva.generalized import Expression
from visviva.typing import CompiledFunction, ParameterValues, ScreeningName

__all__ = [{names}]

class Potential(Declared):
    name: ClassVar[str]
    @property
    def parameters(self) -> tuple[object, ...]: ...
    def rescaled(self, *, length: float = 1.0, mass: float = 1.0, time: float = 1.0) -> Self: ...
    def value(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def force(self, r: ArrayLike) -> NDArray[np.float64]: ...
    def curvature(self, r: ArrayLike) -> NDArray[np.float64]: ...
{classes}
@overload
def Custom(
    function: Callable[..., ArrayLike] | CompiledFunction,
    r_min: float,
    r_max: float,
    *,
    tolerance: float | None = ...,
) -> PiecewisePolynomial: ...
@overload
def Custom(
    function: sympy.Expr | Callable[..., ArrayLike | Expression],
    r_min: None = ...,
    r_max: None = ...,
    *,
    tolerance: None = ...,
    parameters: ParameterValues | None = ...,
) -> Expressed: ...
def potential_by_name(name: str, parameters: Sequence[object]) -> Potential: ...
def potential_from_core(description: dict[str, Any]) -> Potential: ...
"""


def class_stub(entry: dict[str, Any], base: str) -> str:
    """One class: its fields as they are kept, its arguments as they may be given."""
    fields, arguments = [], []
    for parameter in entry["parameters"]:
        name, kind, default = parameter["name"], parameter["kind"], parameter["default"]
        choices = ", ".join(f'"{word}"' for word in parameter["choices"])
        words = f"Literal[{choices}]" if choices else None
        # Optional bodies are None for all of them.
        none = " | None" if default is not None and kind == "indices" else ""
        fields.append(f"    {name}: {words or FIELD[kind]}{none}\n")
        if default is not None and kind == "choice":
            default = f'"{parameter["choices"][int(default)]}"'
        if none:
            given = " = None"
        else:
            given = "" if default is None else f" = {(default,) * 3 if FIELD[kind].startswith('tuple') else default}"
        arguments.append(f"{name}: {words or ARGUMENT[kind]}{none}{given}")
    return (
        "\n@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)\n"
        f"class {entry['class_name']}({base}):\n"
        + "".join(fields)
        + signature(["self", *arguments])
        + FURTHER.get(entry["class_name"], "")
    )


def signature(arguments: list[str]) -> str:
    """The line of ``__init__``, broken as the formatter breaks it."""
    line = f"    def __init__({', '.join(arguments)}) -> None: ...\n"
    if len(line) <= 121:
        return line
    line = f"        {', '.join(arguments)}\n"
    if len(line) > 121:
        line = "".join(f"        {argument},\n" for argument in arguments)
    return f"    def __init__(\n{line}    ) -> None: ...\n"


def stub(template: str, entries: list[dict[str, Any]], base: str, others: list[str]) -> str:
    """The stub of a module of declared classes."""
    names = sorted([base, *others, *(entry["class_name"] for entry in entries)])
    classes = "".join(class_stub(entry, base) for entry in entries)
    listed = ", ".join(f'"{name}"' for name in names)
    if len(listed) > 120 - len("__all__ = []"):
        listed = "\n" + "".join(f'    "{name}",\n' for name in names)
    text = template.format(names=listed, classes=classes)
    imports, _, rest = text.partition("\n__all__")
    for used, line in (
        ("Sequence", "from collections.abc import Sequence\n"),
        ("ArrayLike", "ArrayLike, "),
        ("Any", "Any, "),
    ):
        if not re.search(rf"\b{used}\b", rest):
            imports = imports.replace(line, "")
    if "Literal[" in rest:
        imports = imports.replace("import Any, ClassVar, Self", "import Any, ClassVar, Literal, Self")
    return WRITTEN + imports + "\n__all__" + rest


def package(text: str, forces: list[str]) -> str:
    """`visviva/__init__.py` with these forces among its names, and no other ones."""
    old = re.findall(r'"(\w+)": "forces",', text)
    for name in set(old) - set(forces):
        text = text.replace(f'    "{name}": "forces",\n', "").replace(f'    "{name}",\n', "")
    homes = sorted({*re.findall(r'^    "(\w+": "\w+)",$', text, re.M), *(f'{name}": "forces' for name in forces)})
    text = re.sub(
        r"(_HOME = \{\n).*?(\n\})", lambda m: m[1] + "\n".join(f'    "{h}",' for h in homes) + m[2], text, flags=re.S
    )
    block = re.search(r"(__all__ = \[\n)(.*?)(\n\])", text, re.S)
    assert block is not None
    names = sorted({*re.findall(r'"(\w+)"', block[2]), *forces})
    text = text[: block.start(2)] + "\n".join(f'    "{name}",' for name in names) + text[block.end(2) :]
    line = "    from visviva.forces import " + ", ".join(sorted(forces))
    if len(line) > 120:
        line = "    from visviva.forces import (\n" + "".join(f"        {name},\n" for name in sorted(forces)) + "    )"
    return re.sub(r"    from visviva\.forces import (\([^)]*\)|[^\n]*)", lambda _: line, text)


def main() -> int:
    """Write the files, or with ``--check`` compare them."""
    forces, potentials = _core.forces(), _core.potentials()
    init = PACKAGE / "__init__.py"
    files = {
        PACKAGE / "forces.pyi": stub(FORCES, forces, "Force", []),
        PACKAGE / "potentials.pyi": stub(POTENTIALS, potentials, "Potential", ["Custom", "potential_by_name"]),
        init: package(init.read_text(), [entry["class_name"] for entry in forces]),
    }
    stale = [path for path, text in files.items() if not path.exists() or path.read_text() != text]
    if "--check" in sys.argv[1:]:
        for path in stale:
            print(f"{path.relative_to(PACKAGE.parents[1])} is not what the registry says: python tools/write_stubs.py")
        return 1 if stale else 0
    for path in stale:
        path.write_text(files[path])
    return 0


if __name__ == "__main__":
    sys.exit(main())
