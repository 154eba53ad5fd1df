"""The one gate: nothing that computes gets to Python by another way, and the stub says what the module has."""

import inspect
import re
from pathlib import Path

import pytest

from visviva import _core

BINDING = Path(__file__).parents[2] / "rust" / "py" / "src"
STUB = Path(__file__).parents[2] / "python" / "visviva" / "_core.pyi"

# These hand out declarations, a copy, a word or a number of a few operations and compute nothing that takes time.
PLAIN = {
    "acts_between",
    "check_foil",
    "check_load",
    "check_potential",
    "columns",
    "dimensions",
    "drag_crossover_speed",
    "drag_quadratic",
    "drag_reynolds_number",
    "drag_stokes",
    "drag_throw",
    "force_of_remaining",
    "forces",
    "info",
    "methods",
    "nearest",
    "polhode",
    "potentials",
    "rutherford_half_distance",
    "screening_length",
    "principal_axes",
    "solid_tensor",
    "tensor_about",
    "tensor_rotated",
    "top_least_spin",
    "top_nutation",
    "top_sleeping_threshold",
    "top_steady_precession",
    "_echo",
}


def pyfunctions() -> dict[str, str]:
    """Source of every function of the binding that Python can call, by name."""
    found = {}
    for file in sorted(BINDING.rglob("*.rs")):
        for part in file.read_text(encoding="utf-8").split("#[pyfunction]")[1:]:
            # rustfmt closes a function with the first brace that begins a line.
            body = part[: part.index("\n}\n")]
            match = re.search(r"fn (\w+)", body)
            assert match
            found[match[1]] = body
    return found


def test_the_binding_is_read_whole() -> None:
    made = {name: getattr(_core, name) for name in dir(_core) if name[:2] != "__"}
    # A class holds what the core has made, and has no function that computes.
    assert set(pyfunctions()) == {name for name, one in made.items() if callable(one) and not isinstance(one, type)}


@pytest.mark.parametrize("name", sorted(set(pyfunctions()) - PLAIN))
def test_whatever_computes_goes_through_the_gate(name: str) -> None:
    assert re.search(r"\bcompute(_attached)?\(", pyfunctions()[name])


@pytest.mark.parametrize("path", sorted(BINDING.rglob("*.rs")), ids=lambda path: path.name)
def test_only_the_gate_touches_the_gil(path: Path) -> None:
    source = path.read_text(encoding="utf-8")
    if path.name != "gate.rs":
        assert not re.search(r"\bdetach\(|attach\(|check_signals\(", source)


def parameters(function: object) -> list[tuple[str, object, bool]]:
    """Name, kind and presence of a default of each parameter."""
    signature = inspect.signature(function)  # type: ignore[arg-type]
    return [(part.name, part.kind, part.default is part.empty) for part in signature.parameters.values()]


def test_the_stub_says_what_the_module_has() -> None:
    source = "from __future__ import annotations\n" + STUB.read_text(encoding="utf-8")
    stub: dict[str, object] = {"__name__": "stub"}
    exec(compile(source, STUB, "exec"), stub)
    own = {name: value for name, value in stub.items() if inspect.isfunction(value) and value.__module__ == "stub"}
    functions = {name: parameters(value) for name, value in own.items()}
    public = [name for name in pyfunctions() if name[0] != "_"]
    assert functions == {name: parameters(getattr(_core, name)) for name in public}
