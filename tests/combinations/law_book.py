"""Where laws are listed: `stated_laws` has all of them, the other files of laws write them down."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from recipe import Recipe

Law = Callable[[Recipe], None]
EPSILON = float(np.finfo(float).eps)
LAWS: dict[str, Law] = {}


def law(function: Law) -> Law:
    """Lists a law: a function of a recipe that raises `AssertionError`, or `Refused` if there is nothing to judge."""
    LAWS[function.__name__] = function
    return function
