"""Every script of the gallery runs and makes one picture whose labels are all on it."""

from pathlib import Path

import matplotlib as mpl
import pytest
from drawn import nothing_is_clipped

import visviva as vv

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import to_hex

SCRIPTS = sorted((Path(__file__).parents[2] / "docs" / "gallery").glob("*.py"))
HOUSE = set(vv.plot_style()["axes.prop_cycle"].by_key()["color"])


def test_there_are_twenty_and_each_says_what_it_shows() -> None:
    assert len(SCRIPTS) >= 20
    for script in SCRIPTS:
        lines = script.read_text(encoding="utf-8").splitlines()
        assert len(lines) <= 40, script.name
        assert lines[0].startswith('"""'), script.name
        assert lines[0].endswith('."""'), script.name


@pytest.mark.parametrize("script", SCRIPTS, ids=[script.stem for script in SCRIPTS])
def test_makes_one_picture(script: Path) -> None:
    plt.close("all")
    exec(compile(script.read_text(encoding="utf-8"), str(script), "exec"), {})
    (number,) = plt.get_fignums()
    figure = plt.figure(number)
    nothing_is_clipped(figure)
    for axes in figure.axes:
        assert axes.get_title()
        assert axes.get_xlabel()
        assert axes.get_ylabel()
        assert any(len(line.get_xdata()) > 1 for line in axes.lines)
        # In the colors of the package, and in shades of gray what only helps the eye.
        for line in axes.lines:
            color = to_hex(line.get_color())
            assert color.upper() in HOUSE or color[1:3] == color[3:5] == color[5:7], color
        assert not axes.spines["top"].get_visible()
    plt.close("all")
