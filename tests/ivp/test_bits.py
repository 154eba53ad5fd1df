"""`vv.solve_ivp` gives the same bits on every SIMD tier, however many equations there are."""

import json
import os
import subprocess
import sys
from hashlib import sha256

import numpy as np
import pytest

import visviva as vv
from visviva import _core

TIERS: list[str] = _core.info()["simd_available"]
# Neither kicks and drifts nor series are of equations of the first order.
METHODS = [m for m in vv.methods() if m.coefficients and not (m.symplectic or "stormer" in m.name)]


def digests() -> dict[str, str]:
    """Digests of nodes, states and dense output of a ring of numbers, of 1 to 9 equations."""
    found = {}
    for method in METHODS:
        how = {"rtol": 1e-7, "atol": 1e-9} if method.adaptive else {"dt": 1 / 16}
        for numbers in range(1, 10):

            def rate(t: float, y: np.ndarray) -> np.ndarray:
                return np.roll(y, 1) * (1.0 - y * y) - 0.25 * t * y

            out = vv.solve_ivp(rate, (0.0, 6.0), np.linspace(0.3, 1.1, numbers), method.name, dense_output=True, **how)
            assert out.sol is not None
            parts = (out.t, np.ascontiguousarray(out.y), np.ascontiguousarray(out.sol(np.linspace(0.0, 6.0, 50))))
            found[f"{method.name} {numbers}"] = sha256(b"".join(part.tobytes() for part in parts)).hexdigest()
    return found


@pytest.mark.parametrize("tier", [tier for tier in TIERS if tier != _core.info()["simd"]])
def test_every_tier_gives_the_same_bits(tier: str) -> None:
    environment = {**os.environ, "VISVIVA_SIMD": tier}
    done = subprocess.run([sys.executable, __file__], env=environment, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == digests()


if __name__ == "__main__":
    print(json.dumps(digests()))
