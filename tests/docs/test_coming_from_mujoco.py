"""The examples of MuJoCo and their translations come to the same answers, to the digits that the page names.

`mujoco_answers.json` has what MuJoCo 4.0.0 answered to its side of the page; where it is installed it is asked again.
"""

import json
import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PAGE = Path(__file__).parents[2] / "docs" / "coming-from-mujoco.md"
PAIRS = re.findall(
    r"\n## ([^\n]*)\n[^#]*?```py\n(.*?)```\n\n```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL
)
ANSWERS = json.loads((Path(__file__).parent / "mujoco_answers.json").read_text(encoding="utf-8"))
# As the page says: what Runge and Kutta's steps of MuJoCo leave, which is far more than is left here.
DIGITS = {"A free body": 1e-11, "A pendulum on a hinge": 1e-10, "A heavy top": 1e-8}


def agree(title: str, mine: Any, theirs: Any) -> None:
    mine, theirs = np.asarray(mine, dtype=float), np.asarray(theirs, dtype=float)
    assert mine.shape == theirs.shape
    assert np.abs(mine - theirs).max() <= DIGITS[title] * np.abs(theirs).max()


def test_there_are_three_examples() -> None:
    assert [title for title, _, _ in PAIRS] == list(ANSWERS) == list(DIGITS)


def test_the_translations_come_to_their_answers() -> None:
    names: dict[str, Any] = {}
    for title, _, code in PAIRS:
        exec(compile(code, str(PAGE), "exec"), names)
        agree(title, names["answer"], ANSWERS[title])


@pytest.mark.skipif(find_spec("mujoco") is None, reason="MuJoCo is not installed")
@pytest.mark.parametrize(("title", "code"), [pair[:2] for pair in PAIRS])
def test_they_still_answer_so(title: str, code: str) -> None:
    names: dict[str, Any] = {}
    exec(compile(code, str(PAGE), "exec"), names)
    agree(title, names["answer"], ANSWERS[title])
