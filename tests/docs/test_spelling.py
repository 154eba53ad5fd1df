"""Spelling is American in everything a user reads: the package, its pages and its examples."""

import re
from pathlib import Path

import pytest

TOP = Path(__file__).parents[2]
PLACES = (
    ("python/visviva", "*.py"),
    ("python/visviva", "*.pyi"),
    ("docs", "*.md"),
    ("docs", "*.py"),
    (".", "README.md"),
)
FILES = sorted(
    path
    for folder, pattern in PLACES
    for path in ((TOP / folder).glob(pattern) if folder == "." else (TOP / folder).rglob(pattern))
    if not {"_build", "_reference", "_gallery"} & {*path.parts}
)
#: Beginnings of words that American English spells otherwise.
BRITISH = re.compile(
    r"(?i)\w*(centre|centring|colour|behaviour|neighbour|favour|honour|metre\b|metres\b|labelled|labelling|modelled|"
    r"travelled|cancelled|fibre|grey|normalis|organis|initialis|discretis|linearis|minimis|maximis|recognis|analyse\b)\w*"
)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(TOP).as_posix())
def test_american_spelling(path: Path) -> None:
    found = sorted({word[0] for word in BRITISH.finditer(path.read_text(encoding="utf-8"))})
    assert not found, f"{path.relative_to(TOP)} has {found}"


def test_british_words_are_found() -> None:
    """The pattern must know the words; the files must be there."""
    assert BRITISH.search("barycentres")
    assert BRITISH.search("a kilometre")
    assert not BRITISH.search("parameters")
    assert len(FILES) > 250
