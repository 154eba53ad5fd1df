"""What the tests of central motion share: how near two numbers are."""

from typing import Any

import numpy as np


def close(found: Any, expected: Any, rel: float = 1e-13) -> None:
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    assert np.all(np.abs(found - expected) <= rel * np.abs(expected)), (found, expected)
