"""What the workflow files call is there, and what they fetch has a version."""

import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


@pytest.mark.parametrize("file", WORKFLOWS, ids=[file.stem for file in WORKFLOWS])
def test_actions_have_versions_and_commands_exist(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    used = re.findall(r"uses: (\S+)", text)
    assert used
    for action in used:
        assert re.fullmatch(r"actions/[\w-]+@v\d+\.\d+\.\d+", action), action
    called = re.findall(r"run: ((?:tools|\.ci)/\S+)", text)
    assert called
    for command in called:
        assert os.access(ROOT / command, os.X_OK), command
    assert "permissions: { contents: read }" in text


def test_there_is_a_wheel_for_each_platform() -> None:
    text = (ROOT / ".github" / "workflows" / "wheels.yml").read_text(encoding="utf-8")
    for what in ("ubuntu-24.04-arm", "macos-", "windows-", "manylinux_2_28", "3.14t", "vendored_sdist"):
        assert what in text
