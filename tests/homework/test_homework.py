"""Forty tasks of a mechanics course: short scripts, each with ten digits that another way of reckoning found."""

import re
import statistics
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from answers import ANSWERS

PAGE = (Path(__file__).parents[2] / "docs" / "homework.md").read_text(encoding="utf-8")
IMPORTS, *_ = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
TASKS = re.findall(r"^### (\d+\. [^\n]+)\n.*?```python\n(.*?)```", PAGE, flags=re.DOTALL | re.MULTILINE)


def lines(script: str) -> int:
    return sum(bool(line.strip()) for line in script.splitlines())


def test_forty_short_scripts() -> None:
    assert len(TASKS) == len(ANSWERS) == 40
    assert [int(title.split(".")[0]) for title, _ in TASKS] == list(range(1, 41))
    lengths = [lines(script) for _, script in TASKS]
    assert statistics.median(lengths) <= 8
    assert max(lengths) <= 8


@pytest.mark.parametrize(("task", "answer"), [*zip(TASKS, ANSWERS, strict=True)], ids=[title for title, _ in TASKS])
def test_ten_digits(task: tuple[str, str], answer: Any) -> None:
    names: dict[str, Any] = {}
    exec(compile(IMPORTS + task[1], task[0], "exec"), names)
    with mpmath.workdps(30):
        expected = np.array(answer(), dtype=float)
    found = np.asarray(names["answer"], dtype=float)
    assert found.size == expected.size
    # Ten digits of the largest number: of components that vanish there are no digits.
    np.testing.assert_allclose(np.ravel(found), np.ravel(expected), rtol=5e-11, atol=5e-11 * np.abs(expected).max())
