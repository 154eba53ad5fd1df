"""Results do not change by accident: the bits of forty scenes, as they were recorded.

A scene that fails here has other bits than before. If that was not meant, it is a defect. If it was (a defect put
right, a better method), record the new bits with the reason::

    python tests/reproducibility/test_recorded_bits.py "name of the scene" "why it changed"

which changes one line of ``recorded_bits.json``. ``--check`` lists every scene that differs.
"""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from recorded_scenes import MAY_CHANGE, SCENES, digests

FILE = Path(__file__).with_name("recorded_bits.json")
RECORDED = json.loads(FILE.read_text()) if FILE.exists() else {}


def differences(name: str) -> list[str]:
    now, before = digests(name), RECORDED[name]["bits"]
    return sorted(column for column in now.keys() | before.keys() if now.get(column) != before.get(column))


@pytest.mark.parametrize("name", SCENES)
def test_the_bits_are_those_recorded(name: str) -> None:
    note = f"; expected when a defect is put right: {MAY_CHANGE[name]}" if name in MAY_CHANGE else ""
    assert not differences(name), f"other bits than recorded (see the head of this file){note}"


def test_every_recorded_scene_is_still_run() -> None:
    assert RECORDED.keys() == SCENES.keys()
    assert len(SCENES) == 40


def record(names: list[str], reason: str) -> None:
    """Writes one line for each scene."""
    for name in names:
        RECORDED[name] = {"because": reason, "bits": digests(name)}
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(RECORDED[name])}" for name in SCENES)
    FILE.write_text(f"{{\n{lines}\n}}\n")


if __name__ == "__main__":
    if sys.argv[1:] == ["--check"]:
        for name in SCENES:
            if changed := differences(name):
                print(f"{name}: {', '.join(changed)}{'  [' + MAY_CHANGE[name] + ']' if name in MAY_CHANGE else ''}")
    elif sys.argv[1:2] == ["--first"]:
        record(list(SCENES), sys.argv[2])
    elif len(sys.argv) == 3 and sys.argv[1] in SCENES and sys.argv[2].strip():
        record([sys.argv[1]], sys.argv[2])
    else:
        sys.exit(__doc__)
