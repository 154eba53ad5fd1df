"""``docs/architecture.md`` names files that exist, and leaves out no file or folder of the package and the core."""

import re
from pathlib import Path, PurePosixPath

import pytest

TOP = Path(__file__).parents[2]
PAGE = (TOP / "docs" / "architecture.md").read_text(encoding="utf-8")
QUOTED = sorted(set(re.findall(r"`([\w./-]+)`", PAGE)))
#: What is named as a file or a folder; `final`, `auto` and `visviva.load` are not.
NAMED = [name for name in QUOTED if name.endswith("/") or re.search(r"\.(rs|py|pyi|npz|json|toml|md)$", name)]
FOLDERS = ("benches", "docs", "python", "rust", "tests", "tools")


def everything() -> list[PurePosixPath]:
    """All files and folders of the source tree, from its top; what is built is none of it."""
    paths = [path for folder in FOLDERS for path in [TOP / folder, *(TOP / folder).rglob("*")]]
    return [
        PurePosixPath(path.relative_to(TOP).as_posix())
        for path in paths
        if not {"__pycache__", "target"} & {*path.relative_to(TOP).parts}
    ]


TREE = everything()


def exists(name: str) -> bool:
    """Whether the last parts of some path are ``name``, which a page may shorten."""
    parts = PurePosixPath(name).parts
    return any(path.parts[-len(parts) :] == parts for path in TREE)


@pytest.mark.parametrize("name", NAMED)
def test_what_the_page_names_exists(name: str) -> None:
    assert exists(name), f"docs/architecture.md names {name}, which is nowhere"


def test_the_names_are_found() -> None:
    """Were no name read, nothing would be checked; a file that is not there must be noticed."""
    assert len(NAMED) > 150
    assert not exists("visviva/no_such_file.py")


def test_the_page_leaves_out_no_file_of_the_package() -> None:
    package = TOP / "python" / "visviva"
    files = {path.name for path in package.glob("*.py")}
    folders = {f"{path.parent.name}/" for path in package.glob("*/__init__.py")}
    missing = (files | folders) - set(NAMED)
    assert not missing, f"docs/architecture.md does not name {sorted(missing)}"


def test_the_page_leaves_out_no_part_of_the_core() -> None:
    core = TOP / "rust" / "core" / "src"
    rooms = {path.stem for path in core.iterdir()} - {"lib"}
    named = {part.removesuffix(".rs") for name in NAMED for part in PurePosixPath(name).parts}
    assert not rooms - named, f"docs/architecture.md does not name {sorted(rooms - named)}"


def test_the_page_lists_every_folder_of_tests() -> None:
    folders = {f"tests/{path.name}" for path in (TOP / "tests").iterdir() if any(path.glob("test_*.py"))}
    assert folders <= set(QUOTED), sorted(folders - set(QUOTED))
