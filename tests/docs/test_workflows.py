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


#: First versions that do not need Node 20, which runners had until September 2026.
NODE_24 = {"checkout": 5, "setup-python": 6, "upload-artifact": 6}
#: Labels of machines that are no more (announcements of actions/runner-images); the last ended on 2 November 2026.
RETIRED = r"(ubuntu-(18|20)\.04|macos-1[0-4]|windows-201\d)(?!\d)"


@pytest.mark.parametrize("file", WORKFLOWS, ids=[file.stem for file in WORKFLOWS])
def test_actions_and_machines_are_still_there(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    for action, major in re.findall(r"uses: actions/([\w-]+)@v(\d+)", text):
        assert int(major) >= NODE_24[action], action
    assert re.search(RETIRED, text) is None
    # What is checked out is read, and no token stays in its folder.
    assert text.count("persist-credentials: false") == text.count("uses: actions/checkout@")


def test_there_is_a_wheel_for_each_platform() -> None:
    text = (ROOT / ".github" / "workflows" / "wheels.yml").read_text(encoding="utf-8")
    for what in ("ubuntu-24.04-arm", "macos-", "windows-", "manylinux_2_28", "3.14t", "vendored_sdist"):
        assert what in text
