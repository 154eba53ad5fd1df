"""Pictures of runs, still and moving: what is shown is what was computed, and nothing else.

Bounds: half of the longest interval between times, and the rounding of these.
"""

import itertools
import json
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import visviva as vv

OUT = vv.datasets.solar_system().scene.run(np.linspace(0.0, 8e4, 301))
EIGHT = vv.problems.figure_eight().scene.run(np.linspace(0.0, 6.0, 61))


def test_the_bodies_that_were_asked_for_are_drawn() -> None:
    figure = OUT.plot(bodies=["Jupiter", "Saturn"], plane="xz")
    lines = figure.axes[0].lines
    assert len(lines) == 4  # a way and a place for each
    jupiter = OUT.scene.particles.names.index("Jupiter")
    drawn = np.array(lines[0].get_data())
    assert (drawn == OUT.position[:, jupiter][:, [0, 2]].T).all()
    assert [figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()] == ["x", "z"]


def test_three_dimensions_and_axes_of_ones_own() -> None:
    from matplotlib.figure import Figure

    figure = OUT.plot(plane="xyz")
    assert figure.axes[0].name == "3d"
    assert figure.axes[0].get_zlabel() == "z"
    own = Figure()
    flat, solid = own.add_subplot(1, 2, 1), own.add_subplot(1, 2, 2, projection="3d")
    assert EIGHT.plot(ax=flat) is own
    assert len(own.axes) == 2
    assert len(flat.lines) == 6
    assert EIGHT.plot(ax=solid, plane="xyz") is own
    assert len(solid.lines) == 6
    for wrong in ({"ax": solid}, {"ax": flat, "plane": "xyz"}):
        with pytest.raises(vv.InvalidInput, match=r"^ax: "):
            EIGHT.plot(**wrong)


def test_round_off_is_called_so_and_a_change_is_not() -> None:
    exact = vv.problems.kepler(e=0.5).scene.run(np.linspace(0.0, 20.0, 101))
    coarse = vv.problems.kepler(e=0.5).scene.run(np.linspace(0.0, 20.0, 101), method="leapfrog", dt=0.05)
    said = [[text.get_text() for text in out.plot().axes[1].texts] for out in (exact, coarse)]
    assert said == [["round-off"], []]


def test_colors_are_told_apart_and_lines_when_colors_are_used_up() -> None:
    lines = OUT.plot().axes[0].lines[::2]
    looks = [(line.get_color(), line.get_linestyle()) for line in lines]
    assert len(set(looks)) == len(OUT.scene.particles) > len({color for color, _ in looks})


@pytest.mark.parametrize("plane", ["xy", "xyz"])
def test_frames_are_outputs_of_the_run(plane: Any) -> None:
    moving = EIGHT.animate(plane=plane, trail=0.25, frames=1000)
    figure = moving._fig  # type: ignore[attr-defined]
    outputs = list(moving.new_frame_seq())
    assert outputs == list(range(61))
    moving._draw_frame(40)  # type: ignore[attr-defined]
    first, *_, last = figure.axes[0].lines
    shown = np.array(first.get_data_3d() if plane == "xyz" else first.get_data())
    # A quarter of the run is fifteen intervals of it.
    assert (shown == EIGHT.position[25:41, 0, : len(plane)].T).all()
    mark = np.array(last.get_data_3d() if plane == "xyz" else last.get_data())
    assert (mark[:, 0] == EIGHT.position[40, 2, : len(plane)]).all()


def test_frames_are_even_in_time() -> None:
    t = np.concatenate([np.linspace(0.0, 1.0, 1000), np.linspace(1.1, 10.0, 90)])
    out = vv.problems.kepler().scene.run(t)
    times = t[list(out.animate(frames=51).new_frame_seq())]
    assert len(times) == 51
    assert np.abs(times - np.linspace(0.0, 10.0, 51)).max() <= 0.05 + 1e-13
    back = vv.problems.kepler().scene.run(-t)
    assert (np.abs(-back.t[list(back.animate(frames=51).new_frame_seq())] - times) <= 0.1).all()
    assert list(vv.problems.kepler().scene.run([1.0]).animate().new_frame_seq()) == [0]


@pytest.mark.parametrize(("name", "start"), [("eight.gif", b"GIF8"), ("eight.html", b"\n<link")])
def test_files_are_written(tmp_path: Path, name: str, start: bytes) -> None:
    EIGHT.animate(tmp_path / name, frames=5)
    assert (tmp_path / name).read_bytes().startswith(start)
    if name.endswith("gif"):
        from PIL import Image

        with Image.open(tmp_path / name) as image:
            assert image.n_frames == 5  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("wrong", "argument"),
    [
        ({"path": "a.avi"}, "path"),
        ({"path": "no/such/folder/a.gif"}, "path"),
        ({"path": 3}, "path"),
        ({"bodies": [7]}, "bodies"),
        ({"bodies": []}, "bodies"),
        ({"plane": "yx"}, "plane"),
        ({"trail": 1.5}, "trail"),
        ({"trail": float("nan")}, "trail"),
        ({"frames": 0}, "frames"),
        ({"fps": 0}, "fps"),
    ],
)
def test_what_cannot_be_shown_is_refused_by_name(wrong: dict[str, Any], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as refused:
        EIGHT.animate(**wrong)
    assert refused.value.argument.startswith(argument)


def test_a_writer_that_is_missing_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.animation import writers

    monkeypatch.setattr(type(writers), "is_available", lambda self, name: False)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(vv.InvalidInput, match="ffmpeg is not installed"):
        EIGHT.animate(tmp_path / "a.mp4")
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", package_with(RuntimeError("No ffmpeg exe could be found")))
    with pytest.raises(vv.MissingPackage, match=r"no ffmpeg for this system.*give a \.gif or \.html"):
        EIGHT.animate(tmp_path / "a.mp4")
    assert not list(tmp_path.iterdir())


def package_with(found: str | Exception) -> Any:
    """What imageio-ffmpeg is to us."""

    def get_ffmpeg_exe() -> str:
        if isinstance(found, Exception):
            raise found
        return found

    package = ModuleType("imageio_ffmpeg")
    package.get_ffmpeg_exe = get_ffmpeg_exe  # type: ignore[attr-defined]
    return package


#: Takes frames as ffmpeg does, and keeps them and what it was told.
RECORDER = """#!{python}
import json, pathlib, sys
if "-version" not in sys.argv:
    pathlib.Path(sys.argv[-1]).write_bytes(sys.stdin.buffer.read())
    pathlib.Path(sys.argv[-1] + ".json").write_text(json.dumps(sys.argv[1:]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a script is no program there")
@pytest.mark.parametrize("brought", [False, True], ids=["of the system", "of the package"])
def test_ffmpeg_is_given_every_frame(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, brought: bool) -> None:
    programs = tmp_path / "bin"
    programs.mkdir()
    recorder = programs / ("ffmpeg-of-a-package" if brought else "ffmpeg")
    recorder.write_text(RECORDER.format(python=sys.executable), encoding="utf-8")
    recorder.chmod(0o755)
    monkeypatch.setenv("PATH", str(programs))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", package_with(str(recorder)) if brought else None)
    film = tmp_path / "eight.mp4"
    EIGHT.animate(film, frames=7, fps=30)
    told = json.loads((tmp_path / "eight.mp4.json").read_text(encoding="utf-8"))
    width, height = map(int, told[told.index("-s") + 1].split("x"))
    assert width % 2 == height % 2 == 0  # which H.264 needs
    frames = np.frombuffer(film.read_bytes(), dtype=np.uint8).reshape(7, height, width, 4)
    assert all((one != other).any() for one, other in itertools.pairwise(frames))
    assert float(told[told.index("-framerate") + 1] if "-framerate" in told else told[told.index("-r") + 1]) == 30.0


def test_a_film_has_its_frames(tmp_path: Path) -> None:
    """Where ffmpeg is: the film is read back."""
    package = pytest.importorskip("imageio_ffmpeg")
    EIGHT.animate(tmp_path / "eight.mp4", frames=15, fps=5)
    frames, seconds = package.count_frames_and_secs(str(tmp_path / "eight.mp4"))
    assert frames == 15
    assert seconds == pytest.approx(3.0, abs=0.21)


def test_nothing_to_show(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(vv.InvalidInput, match=r"^animate: expected a trajectory with bodies"):
        vv.Scene(vv.Particles([], np.zeros((0, 3)))).run([0.0, 1.0]).animate()
