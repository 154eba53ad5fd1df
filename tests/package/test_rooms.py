"""The rooms of the Rust core know those below them and none above: read from the ``crate::`` paths in its sources.

``docs/architecture.md`` describes the order; here it is enforced. A new room gets a line in `FLOOR`; a path that leads
upwards fails by name. `STANDING` lists what led upwards when this was written: it may only shrink, and a line that is
no longer needed fails, too.
"""

import re
from pathlib import Path

SOURCES = Path(__file__).parents[2] / "rust" / "core" / "src"

# numerics ← expressions ← ode, potentials ← narrow ← forces ← nbody, rigid, generalized ← central ← scattering
# ← closed_forms, conservation ← scene.
# Rooms of one floor do not know each other.
FLOORS = (
    ("error",),
    ("words",),
    ("numerics",),
    ("memory", "parallel", "units"),
    ("expressions",),
    ("ode", "potentials"),
    ("narrow",),
    ("forces",),
    ("nbody", "rigid", "generalized"),
    ("central",),
    ("scattering",),
    ("closed_forms", "conservation"),
    ("registry",),
    ("scene",),
)
FLOOR = {room: height for height, rooms in enumerate(FLOORS) for room in rooms}
STANDING: dict[tuple[str, str], str] = {
    ("error", "words"): "the text of an error is written by words, which makes errors",
}


def room_of(path: Path) -> str:
    return path.relative_to(SOURCES).parts[0].removesuffix(".rs")


def code_of(path: Path) -> str:
    """Without comments, and without the tests at the end."""
    text = path.read_text(encoding="utf-8")
    text = re.split(r"#\[cfg\(test\)\]\s*(?:pub(?:\([a-z]+\))? )?mod \w+ \{", text)[0]
    return re.sub(r"//[^\n]*", "", text)


def is_for_tests(path: Path) -> bool:
    """Whether a file belongs to a module that is compiled for tests alone."""
    for folder in [path, *path.parents]:
        if folder == SOURCES:
            return False
        name = folder.name.removesuffix(".rs")
        parents = [folder.parent / "mod.rs", folder.parent.with_suffix(".rs"), folder.parent / "lib.rs"]
        declared = rf"#\[cfg\(test\)\]\s*(?:pub(?:\([a-z]+\))? )?mod {re.escape(name)};"
        if any(parent.exists() and re.search(declared, parent.read_text(encoding="utf-8")) for parent in parents):
            return True
    return False


def first_names(code: str) -> set[str]:
    """What follows ``crate::``, also each name of a group in braces."""
    found = set(re.findall(r"\bcrate::(\w+)", code))
    for start in re.finditer(r"\bcrate::\{", code):
        depth, name = 1, ""
        for character in code[start.end() :]:
            depth += {"{": 1, "}": -1}.get(character, 0)
            if depth == 0 or (depth == 1 and character == ","):
                found |= set(re.findall(r"^\s*(\w+)", name))
                name = ""
                if depth == 0:
                    break
            else:
                name += character
    return found


FILES = [path for path in sorted(SOURCES.rglob("*.rs")) if path.name != "lib.rs" and not is_for_tests(path)]
ROOMS = {path.relative_to(SOURCES).parts[0].removesuffix(".rs") for path in FILES}


def home(name: str) -> str:
    """The room of a name at the top of the crate: a room, a macro, or something that ``lib.rs`` hands on."""
    if name in ROOMS:
        return name
    for path in FILES:
        if re.search(rf"macro_rules! {name}\b", code_of(path)):
            return room_of(path)
    handed_on = re.search(rf"pub use (\w+)::[^;]*\b{name}\b", (SOURCES / "lib.rs").read_text(encoding="utf-8"))
    assert handed_on, f"crate::{name} is in no room"
    return handed_on[1]


def edges() -> dict[tuple[str, str], list[str]]:
    """(room, room it knows) and the files that say so."""
    found: dict[tuple[str, str], list[str]] = {}
    homes: dict[str, str] = {}
    for path in FILES:
        for name in first_names(code_of(path)):
            if name not in homes:
                homes[name] = home(name)
            if homes[name] != room_of(path):
                found.setdefault((room_of(path), homes[name]), []).append(str(path.relative_to(SOURCES)))
    return found


def test_every_room_has_its_place() -> None:
    assert FLOOR.keys() >= ROOMS


def test_a_room_knows_the_rooms_below_it_and_none_above() -> None:
    upwards = {(a, b): files for (a, b), files in edges().items() if FLOOR[b] >= FLOOR[a]}
    new = {edge: sorted(files) for edge, files in upwards.items() if edge not in STANDING}
    assert not new, f"a room knows one that is not below it: {new}"
    gone = STANDING.keys() - upwards.keys()
    assert not gone, f"no longer so, take them out of STANDING: {gone}"


def test_the_edges_are_found() -> None:
    """Were no path read, nothing would be enforced."""
    found = edges()
    assert ("forces", "numerics") in found
    assert ("scene", "error") in found
    assert first_names("use crate::{Error, words::{a, b}, numerics::c::{self, d}}; crate::tiered!") == {
        "Error",
        "words",
        "numerics",
        "tiered",
    }
