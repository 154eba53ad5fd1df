"""Write the names that ``visviva.typing`` spells out, from what the core has registered.

python tools/write_names.py            # after a method or a column was added, with the package built
python tools/write_names.py --check    # says by its exit code whether that was done
"""

import re
import sys
from pathlib import Path

import visviva as vv

FILE = Path(__file__).parent.parent / "python" / "visviva" / "typing.py"
BEGIN, END = (f"# written by tools/write_names.py: {word}\n" for word in ("begin", "end"))


def columns() -> list[str]:
    """The columns that can be recorded, from the words with which the core refuses another."""
    try:
        vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 1.0])).plan(1.0, record="?")  # type: ignore[arg-type]
    except vv.InvalidInput as error:
        return re.findall(r"\b[a-z_]+\b", error.message.removeprefix("expected one of").partition(", got")[0])
    raise AssertionError("the core took '?' for a column")


def solvers() -> list[str]:
    """The methods of ``solve_ivp``, SciPy's names and ours, likewise."""
    try:
        vv.solve_ivp(lambda _, y: -y, (0.0, 1.0), [1.0], "?")  # type: ignore[arg-type]
    except vv.InvalidInput as error:
        return re.findall(r"\w+", error.message.removeprefix("expected one of").partition(", got")[0])
    raise AssertionError("the core took '?' for a method")


def literal(name: str, words: list[str], told: str) -> str:
    """A type alias as ruff would lay it out, and what it is."""
    quoted = [f'"{word}"' for word in words]
    line = f"{name}: TypeAlias = Literal[{', '.join(quoted)}]\n"
    if len(line) <= 121:
        return f'{line}"""{told}"""\n'
    inner = f"    {', '.join(quoted)}\n"
    if len(inner) > 121:
        inner = "".join(f"    {word},\n" for word in quoted)
    return f'{name}: TypeAlias = Literal[\n{inner}]\n"""{told}"""\n'


def main() -> int:
    """Write the file, or compare it."""
    text = FILE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    steppers = {method.name for method in (*vv.methods(), *vv.rigid.methods())}
    names = literal("MethodName", ["auto", *sorted(steppers)], "Methods of scenes; which takes a scene, its plan says.")
    names += literal("SolverName", sorted(solvers()), "Methods of `visviva.solve_ivp`: SciPy's names and those here.")
    names += literal("ColumnName", sorted(columns()), "What the run of a scene can record at its times.")
    wanted = before + BEGIN + names + END + after
    if "--check" in sys.argv:
        return int(text != wanted)
    FILE.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
