"""Packages that only a part of visviva uses: imported where that part is used, or told how to get them."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

from visviva.errors import MissingPackage

__all__ = ["needed"]


def needed(module: str, argument: str, extra: str | None = None, instead: str = "") -> Any:
    """A module of another package.

    Parameters
    ----------
    module : str
        Of the package, by its full name.
    argument : str
        What was called or given that needs it.
    extra : str, optional
        With which of visviva's extras the package comes; by default that of its name.
    instead : str, optional
        What does without it.

    Raises
    ------
    visviva.MissingPackage
        If it is not installed.
    """
    found = sys.modules.get(module)
    if found is not None:
        return found
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        cure = f"pip install 'visviva[{extra or package}]'" + (f", or {instead}" if instead else "")
        raise MissingPackage(argument, f"the package {package} is not installed: {cure}") from error
