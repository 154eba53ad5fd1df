"""The cases of `golden.json`, 40-digit results of the catalogue, and how a test takes one.

Inputs are the binary64 numbers nearest to the printed decimals. Comparisons are relative to 1e-13, the accuracy the
file promises, unless the line says why not.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

CASES: dict[str, dict[str, Any]] = {
    case["id"]: case for case in json.loads(Path(__file__).with_name("golden.json").read_text())
}
Check = Callable[[dict[str, Any], dict[str, Any]], None]


class Golden:
    """The checks of one module, by case."""

    def __init__(self) -> None:
        self.checks: dict[str, Check] = {}

    def __call__(self, identifier: str) -> Callable[[Check], Check]:
        """Decorates the check of a case, a function of its inputs and its outputs."""

        def register(check: Check) -> Check:
            self.checks[identifier] = check
            return check

        return register

    def run(self, identifier: str) -> None:
        self.checks[identifier](CASES[identifier]["inputs"], CASES[identifier]["outputs"])


def close(value: Any, expected: Any, rel: float = 1e-13, scale: float = 0.0) -> None:
    """Equal to `rel` of the expected size, or of `scale` where the expected number is a cancellation."""
    value, expected = np.asarray(value, dtype=float), np.asarray(expected, dtype=float)
    assert value.shape == expected.shape
    assert np.all(np.abs(value - expected) <= rel * np.maximum(np.abs(expected), scale)), (value, expected)
