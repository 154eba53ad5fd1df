"""Every Python block of every page of the site runs, top to bottom, as a reader would type it."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(
    page
    for page in DOCS.rglob("*.md")
    if not {"_build", "_gallery"} & set(page.parts) and "```python" in page.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(DOCS)) for page in PAGES])
def test_the_code_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    text = page.read_text(encoding="utf-8")
    for block in re.finditer(r"```python\n(.*?)```", text, flags=re.DOTALL):
        before = "\n" * text.count("\n", 0, block.start(1))  # so that a failure names the line of the page
        exec(compile(before + block[1], str(page), "exec"), names)


def test_every_page_is_on_the_site() -> None:
    """Pages stand in the table of contents, which the builder would otherwise say as an error."""
    contents = (DOCS / "index.md").read_text(encoding="utf-8")
    for page in DOCS.rglob("*.md"):
        place = page.relative_to(DOCS)
        if place.parts[0] not in ("_build", "_gallery", "how-to", "gallery") and place.name != "index.md":
            assert f"\n{place.with_suffix('')}\n" in contents, place
