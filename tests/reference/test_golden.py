"""Every case of `golden.json` is taken by a test of this folder, or waits in `LATER` for the room it belongs to."""

import re
from pathlib import Path

from golden_cases import CASES

LATER = {
    "impulse of a force given in time": ["G2.2-impulse"],
    "forces given by hand": ["G3.11-weak-third-law", "G3.17-work"],
    "drag": ["G4.24", "G4.27", "G4.29", "G4.28x", "G4.18x", "G4.19"],
    "oscillators": ["G4.35", "G4.4", "GI-verlet", "GI-rk4", "GI-euler", "G6.16"],
    "coefficients as Python sees them": ["GI-yoshida4"],
    "magnetic fields": ["GI-boris", "G5.20"],
    "generalized coordinates": ["G3.20", "G5.", "G6.3-", "G6.29"],
    "other central forces": ["G7.17", "G7.14"],
    "continuous bodies": ["G8.4-"],
    "collisions": ["G8.23", "G8.24"],
    "scattering by any potential": ["G8.41", "G8.39-inverse-square", "G8.39-square-well"],
    "rigid bodies": ["G9."],
}


def test_every_case_is_taken_or_waits_for_its_room() -> None:
    sources = Path(__file__).parent.glob("test_golden_*.py")
    taken = {case for source in sources for case in re.findall(r'^@golden\("(.+)"\)', source.read_text(), re.M)}
    waiting = tuple(prefix for prefixes in LATER.values() for prefix in prefixes)
    for identifier in CASES:
        assert (identifier in taken) != identifier.startswith(waiting), identifier
    for prefix in waiting:
        assert any(identifier.startswith(prefix) for identifier in CASES), prefix
    assert taken <= CASES.keys()
