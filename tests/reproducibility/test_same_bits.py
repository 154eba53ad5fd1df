"""The same bits on every SIMD tier, for any threads, alone or in an ensemble, whatever is output.

The cases are those of ``benches/python/same_bits.py``, which runs more of them.
"""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

import visviva as vv
from visviva import _core

TIERS: list[str] = _core.info()["simd_available"]
SCRIPT = Path(__file__).parents[2] / "benches" / "python" / "same_bits.py"


@pytest.fixture(scope="module")
def same_bits() -> ModuleType:
    spec = importlib.util.spec_from_file_location("same_bits", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def portable(same_bits: ModuleType) -> dict[str, str]:
    return dict(same_bits.digests_of_tier("portable", quick=True))


def test_ways_agree_on_the_portable_tier(portable: dict[str, str]) -> None:
    """Threads, ensembles and outputs: a disagreement raises while the digests are made."""
    assert len(portable) > 30
    # Boris's method without a magnetic field is leapfrog_dkd, and methods of high order may agree to the last bit.
    alike = {method.name for method in vv.methods() if method.order > 5} | {"boris"}
    others = [digest for name, digest in portable.items() if name.rpartition(", ")[2] not in alike]
    assert len(set(others)) == len(others) > 100


@pytest.mark.parametrize("tier", [tier for tier in TIERS if tier != "portable"])
def test_tiers_agree(same_bits: ModuleType, portable: dict[str, str], tier: str) -> None:
    assert same_bits.digests_of_tier(tier, quick=True) == portable
