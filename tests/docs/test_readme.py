"""The README's code runs, top to bottom, as a reader would type it."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import visviva as vv

ROOT = Path(__file__).parent.parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_code_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    assert len(blocks) >= 4
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)


def test_links_lead_somewhere() -> None:
    for page in (*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")):
        for target in re.findall(r"\]\((?!https?:)([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_the_house_is_as_described() -> None:
    """Every folder and file that the documentation names is there."""
    for page in (ROOT / "docs").rglob("*.md"):
        for path in re.findall(r"`((?:rust|python|tests|tools|docs|\.ci)/[\w./-]+)`", page.read_text(encoding="utf-8")):
            assert (ROOT / path).exists(), f"{page.name}: {path}"


def test_the_two_commands_are_on_the_first_screen() -> None:
    first = "\n".join(README.splitlines()[:25])
    for name in ("demo", "test"):
        assert f"<!-- command: {name} -->\n```sh\n" in first
    assert os.access(ROOT / ".ci" / "run", os.X_OK)


def test_the_first_screen_has_a_picture_that_a_script_makes(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    [picture] = re.findall(r"^!\[[^\]]+\]\(([^)]+)\)$", "\n".join(README.splitlines()[:12]), flags=re.MULTILINE)
    script = ROOT / "tools" / "readme_picture.py"
    assert f"{script.relative_to(ROOT)} {picture}`" in script.read_text(encoding="utf-8")
    subprocess.run([sys.executable, script, tmp_path / "made.png"], check=True)
    for file in (ROOT / picture, tmp_path / "made.png"):
        kept = file.read_bytes()
        assert kept.startswith(b"\x89PNG")
        assert 10_000 < len(kept) < 100_000
    # Of the same size, as it says in its header.
    assert (ROOT / picture).read_bytes()[16:24] == (tmp_path / "made.png").read_bytes()[16:24]


def test_no_figure_is_typed() -> None:
    """The table is what the benches wrote, and counts are those of the package."""
    subprocess.run([sys.executable, ROOT / "tools" / "readme_figures.py", "--check"], check=True)
    assert f"lists the {len(vv.methods())} integrators" in README


def test_pictures_of_work_against_precision_are_small_and_name_the_machine() -> None:
    folder = ROOT / "docs" / "work-precision"
    page = (folder / "index.md").read_text(encoding="utf-8")
    assert "Machine: " in page
    assert "| what | visviva | peer |" in page
    shown = re.findall(r"^!\[[^\]]+\]\(([^)]+)\)$", page, flags=re.MULTILINE)
    assert len(shown) >= 2
    assert sorted(shown) == sorted(file.name for file in folder.glob("*.png"))
    assert all((folder / name).stat().st_size < 100_000 for name in shown)
