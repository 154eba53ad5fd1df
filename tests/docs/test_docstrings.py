"""Every example in a docstring runs and gives what it says."""

import doctest
import importlib
import pkgutil

import pytest

import visviva

MODULES = [
    "visviva",
    *(m.name for m in pkgutil.walk_packages(visviva.__path__, "visviva.") if "__main__" not in m.name),
]
PUBLIC = {
    "forces",
    "particles",
    "plan",
    "potentials",
    "problems",
    "scene",
    "trajectory",
    "ensemble",
    "io",
    "integrators",
}


@pytest.mark.parametrize("name", MODULES)
def test_examples(name: str) -> None:
    module = importlib.import_module(name)
    failed, tried = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert failed == 0
    assert tried > 0 or name.rsplit(".", maxsplit=1)[-1] not in PUBLIC


@pytest.mark.parametrize("name", [name for name in visviva.__all__ if name not in visviva._ROOMS])
def test_every_public_name_is_documented(name: str) -> None:
    documented = getattr(visviva, name)
    assert (documented.__doc__ or "").strip()
    for attribute, value in vars(documented).items() if isinstance(documented, type) else ():
        if not attribute.startswith("_") and (callable(value) or isinstance(value, property)):
            assert (value.__doc__ or "").strip(), f"{name}.{attribute}"
