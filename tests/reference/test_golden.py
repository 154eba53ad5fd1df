"""Every case of `golden.json` is taken by a test of this folder, or waits in `LATER` for the room it belongs to."""

import re
from pathlib import Path

from golden_cases import CASES

LATER = {
    "scattering by any potential": ["G8.41", "G8.39-square-well"],
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
