"""Every Python block of every page of the site runs, top to bottom, as a reader would type it."""

import inspect
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import visviva as vv

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


@pytest.mark.parametrize("name", ["CHANGELOG", "CONTRIBUTING", "SECURITY"])
def test_pages_of_the_repository_are_on_the_site(name: str) -> None:
    """As they are; their links lead to pages, which alone are moved to where they are on the site."""
    page = (DOCS / f"{name.lower()}.md").read_text(encoding="utf-8")
    assert page == f"```{{include}} ../{name}.md\n:relative-docs: docs/\n```\n"
    told = (DOCS.parent / f"{name}.md").read_text(encoding="utf-8")
    for target in re.findall(r"\]\((?!https?:)([^)#]+)\)", told):
        assert re.fullmatch(r"docs/.*\.md", target), target


def test_every_extra_is_told_where_one_installs() -> None:
    """But for those of whoever works on the package."""
    project = tomllib.loads((DOCS.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    told = re.findall(r"(?m)^\| `(\w+)` \| \S", (DOCS / "ten-minutes.md").read_text(encoding="utf-8"))
    assert told == [name for name in project["optional-dependencies"] if name not in ("test", "bench", "docs")]


def test_every_error_and_status_is_on_the_page_of_errors() -> None:
    text = (DOCS / "errors.md").read_text(encoding="utf-8")
    assert all(f"\n| `{name}`" in text for name in vv.errors.__all__ if name != "Error")
    rows = re.findall(r"(?m)^\| `([A-Z_]+)` \| (\d) \| \S.* \|$", text)
    codes = [(each.name, str(each.value)) for each in vv.Status]
    assert rows == codes + [(each.name, str(each.value)) for each in vv.scattering.DeflectionStatus]
    documented = re.findall(r"(?m)^([A-Z_]+) : (\d)\n    \S", inspect.getdoc(vv.Status) or "")
    assert documented == codes


def test_tolerances_that_are_told_are_those_of_the_signatures() -> None:
    text = (DOCS / "which-method.md").read_text(encoding="utf-8")
    told = dict(re.findall(r"(?m)^\| (.*`.*`.*?) \| (1e-\d+)", text))
    usual = f"{inspect.signature(vv.Lagrangian.run).parameters['rtol'].default:.0e}"
    assert {usual} == {rtol for where, rtol in told.items() if "of a Lagrangian" in where}
    assert f"if not given {usual}." in " ".join((inspect.getdoc(vv.Lagrangian.run) or "").split())
    # Those of scenes and of solve_ivp by what they do: the default is None.
    scene = vv.problems.figure_eight().scene
    for where, how in (("named", {"method": "dop853"}), ("by `auto`", {})):
        (rtol,) = {rtol for row, rtol in told.items() if where in row}
        left_out, given = (scene.run(t=1.0, **how, **tolerance) for tolerance in ({}, {"rtol": float(rtol)}))
        np.testing.assert_array_equal(left_out.position, given.position)
        assert rtol in " ".join((inspect.getdoc(vv.Scene.run) or "").split())
    told = {rtol: where for where, rtol in told.items()}
    span, start = (0.0, 10.0), [1.0]
    left_out, given = (vv.solve_ivp(lambda _, y: -y, span, start, **how) for how in ({}, {"rtol": 1e-3, "atol": 1e-6}))
    assert "solve_ivp" in told["1e-3"]
    assert (left_out.y == given.y).all()
