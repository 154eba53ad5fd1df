"""The site: `sphinx-build -W -b html docs docs/_build/html`, with `pip install '.[docs]'`.

Pages are Markdown; the reference is made here from what each room calls public, so that no name is listed by hand.
"""

import inspect
import re
from pathlib import Path
from typing import Any

import matplotlib

import visviva

project = "visviva"
author = "The visviva developers"
version = release = visviva.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc"]
exclude_patterns = ["_build", "gallery/README.md"]
html_theme = "alabaster"
html_theme_options = {"description": "Classical mechanics at native speed", "page_width": "68rem"}
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False
autodoc_typehints = "none"
# Links into the sources, which are no pages, are checked by tests/docs/test_readme.py.
suppress_warnings = ["myst.xref_missing", "ref.python"]

REFERENCE = Path(__file__).parent / "_reference"


def is_shown(base: type) -> bool:
    """Whether a base has a place of its own: on these pages, or elsewhere."""
    rooms = (visviva, *(getattr(visviva, name) for name in visviva._ROOMS))
    return not base.__module__.startswith("visviva") or any(base.__name__ in room.__all__ for room in rooms)


def entries(module: object, where: str, names: list[str]) -> list[str]:
    """The directives of a room's public names."""
    lines: list[str] = []
    for name in names:
        documented = getattr(module, name)
        if inspect.isclass(documented):
            # What a class has of a base that nobody is shown is told with it.
            others = ", ".join(base.__name__ for base in documented.__mro__[1:] if is_shown(base))
            lines += [f".. autoclass:: {where}.{name}", "   :members:", f"   :inherited-members: {others}", ""]
        elif inspect.isroutine(documented):
            lines += [f".. autofunction:: {where}.{name}", ""]
        else:
            # Numbers, names of types, the time: what stands beside them tells of them.
            lines += [f".. autodata:: {where}.{name}", ""]
    return lines


def methods() -> list[str]:
    """A table of all integrators, of points and of rigid bodies, as the core has registered them."""
    lines = [
        "What the core has registered: `vv.methods()` and `vv.rigid.methods()` give the same with all coefficients.",
        "",
        ".. list-table::",
        "   :header-rows: 1",
        "",
        "   * - method",
        "     - order",
        "     - what it is",
        "     - source",
    ]
    points = visviva.methods()
    turning = [method for method in visviva.rigid.methods() if method.name not in {each.name for each in points}]
    for method in (*points, *turning):
        lines += [
            f"   * - ``{method.name}``",
            f"     - {method.order}",
            f"     - {method.summary}",
            f"     - {method.reference}",
        ]
    return lines


def write_reference() -> None:
    """One page for the package and one for each of its rooms."""
    REFERENCE.mkdir(exist_ok=True)
    rooms = [name for name in visviva.__all__ if inspect.ismodule(getattr(visviva, name))]
    pages = {"visviva": entries(visviva, "visviva", [name for name in visviva.__all__ if name not in rooms])}
    for room in rooms:
        module = getattr(visviva, room)
        # What the package itself names is on its own page.
        own = [name for name in module.__all__ if name not in visviva.__all__]
        pages[room] = [f".. automodule:: visviva.{room}", "", *entries(module, f"visviva.{room}", own)]
    pages["methods"] = methods()
    for room, lines in pages.items():
        title = {"visviva": "visviva", "methods": "Methods"}.get(room, f"visviva.{room}")
        text = "\n".join([title, "=" * len(title), "", *lines]).rstrip() + "\n"
        page = REFERENCE / f"{room}.rst"
        if not page.exists() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")


def keep_bars(app: Any, what: str, name: str, of: Any, options: Any, lines: list[str]) -> None:  # noqa: ARG001
    """Write |v| in docstrings as the absolute value it is; reStructuredText would look for a substitution."""
    example = False
    for place, line in enumerate(lines):
        example = line.lstrip().startswith(">>>") or (example and bool(line.strip()))
        if not example and "|" in line:
            parts = re.split(r"(``.*?``)", line)
            lines[place] = "".join(p if p.startswith("``") else re.sub(r"(?<!\\)\|", r"\\|", p) for p in parts)


def setup(app: Any) -> None:
    """Called by Sphinx; 400 is before numpydoc."""
    app.connect("autodoc-process-docstring", keep_bars, priority=400)


GALLERY = Path(__file__).parent / "_gallery"


def write_gallery() -> None:
    """One page of all the scripts in docs/gallery, each with its picture, which is made here."""
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    GALLERY.mkdir(exist_ok=True)
    text = ["# Gallery", "", "Each picture is made by the script below it.", ""]
    for script in sorted((Path(__file__).parent / "gallery").glob("*.py")):
        source = script.read_text(encoding="utf-8")
        plt.close("all")
        exec(compile(source, str(script), "exec"), {})
        plt.gcf().savefig(GALLERY / f"{script.stem}.png", dpi=90)
        told, _, code = source.partition("\n")
        told = told.strip('"')
        text += [f"## {script.stem.replace('_', ' ').capitalize()}", "", told, ""]
        text += [f"![{told}]({script.stem}.png)", "", "```python", code.strip(), "```", ""]
    plt.close("all")
    (GALLERY / "index.md").write_text("\n".join(text), encoding="utf-8")


write_reference()
write_gallery()
