"""Trajectories to 25 digits, from expressions and from functions: every digit that their conditioning allows.

Bounds: a few times the worst error that was seen of all systems, in EPSILON of the largest number; of fixed orders
what their error is at the step that they choose.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from by_symbols import BY_FUNCTIONS, BY_SYMBOLS, Make

EPSILON = 2.0**-52
KEPT = json.loads((Path(__file__).parent / "reference.json").read_text(encoding="utf-8"))["trajectories"]


def errors(name: str, makers: dict[str, Make], method: str, rtol: float) -> list[float]:
    """Errors at the kept times, per conditioning."""
    kept = KEPT[name]
    make = next(makers[system] for system in makers if name.startswith(system))
    start = [float(number) for number in kept["y0"]]
    n = len(start) // 2
    out = make(position=start[:n], velocity=start[n:]).run(t=kept["t"], method=method, rtol=rtol)
    second = out.velocity if out.system._second_name == "velocity" else out.momentum
    states = np.concatenate([out.position, second], axis=1)
    wanted = np.array(kept["y"], dtype=float)
    return list(np.abs(states - wanted).max(axis=1) / kept["conditioning"])


# A random walk of the rounding of every step: 2700 of them, at most, measure 16 ε.
@pytest.mark.parametrize("makers", [BY_SYMBOLS, BY_FUNCTIONS], ids=["symbols", "functions"])
@pytest.mark.parametrize("name", KEPT)
def test_gauss16_has_every_digit(name: str, makers: dict[str, Any]) -> None:
    assert max(errors(name, makers, "gauss16", 1e-12)) <= 64 * EPSILON


# Explicit methods at a tolerance below their own rounding: 210 ε measured, of ten times as many steps.
@pytest.mark.parametrize(("method", "rtol"), [("dop853", 1e-15), ("verner98", 1e-14), ("taylor", 1e-15)])
@pytest.mark.parametrize("name", KEPT)
def test_explicit_methods_have_all_but_two(name: str, method: str, rtol: float) -> None:
    assert max(errors(name, BY_FUNCTIONS, method, rtol)) <= 800 * EPSILON


# Errors of all steps add up, up to 3000 of them within the memory of a motion.
@pytest.mark.parametrize(
    ("method", "rtol"),
    [
        ("dop853", 1e-10),
        ("taylor", 1e-10),
        ("tsitouras54", 1e-10),
        ("dormand_prince54", 1e-10),
        ("bogacki_shampine32", 1e-6),
    ],
)
@pytest.mark.parametrize("name", [name for name in KEPT if name != "henon_heiles_decimal"])
def test_a_tolerance_is_kept(name: str, method: str, rtol: float) -> None:
    first = errors(name, BY_FUNCTIONS, method, rtol)[0]
    assert EPSILON < first <= 3000 * rtol


# Their steps are chosen by a polynomial of low degree, and stop shrinking at δ = 1e-5.
@pytest.mark.parametrize("method", ["gauss8", "gauss4"])
@pytest.mark.parametrize("name", ["double_pendulum_moderate", "spherical_pendulum", "bead_on_hoop", "chain_10"])
def test_shorter_gauss_methods_do_less(name: str, method: str) -> None:
    assert max(errors(name, BY_FUNCTIONS, method, 1e-15)) <= {"gauss8": 1e-10, "gauss4": 1e-6}[method]
