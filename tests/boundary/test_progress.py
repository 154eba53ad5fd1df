"""What ``progress=`` may be and what it shows."""

import re
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import visviva as vv
from visviva import _core
from visviva._progress import TIME, _scaled, callback
from visviva.errors import InvalidInput


def test_false_is_nothing() -> None:
    with callback(False) as report:
        assert report is None


def test_a_callable_is_itself() -> None:
    def progress(done: int, total: int) -> None: ...

    with callback(progress) as report:
        assert report is progress


@pytest.mark.parametrize("wrong", [None, 1, 0, "yes", [print]])
def test_anything_else_is_refused(wrong: object) -> None:
    with pytest.raises(InvalidInput, match=r"^progress: expected True, False or a callable"), callback(wrong):  # type: ignore[arg-type]
        pass


@pytest.mark.parametrize(("unit", "shown"), [("", "100 %"), ("events", "events/s"), ("events", "10.0/10.0")])
def test_true_is_a_bar(unit: str, shown: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    with callback(True, unit) as report:
        _core._busy(0.3, 1, report)
    written = capsys.readouterr()
    assert shown in written.err
    # Steps of runs are of many kinds: their rate says nothing.
    assert ("/s" in written.err) is bool(unit)
    assert written.out == ""


@pytest.mark.parametrize("unit", ["", "events"])
def test_true_is_a_line_without_tqdm(
    unit: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with callback(True, unit) as report:
        _core._busy(0.3, 1, report)
    written = capsys.readouterr()
    lines = written.err.split("\r")
    assert all(line.startswith("visviva: ") for line in lines[1:])
    assert lines[-1].startswith("visviva: 100 %")
    assert "left" not in lines[-1]
    assert lines[-1].endswith("\n")
    assert any("s left" in line for line in lines[:-1])
    assert all(("events/s" in line) is bool(unit) for line in lines[1:])
    assert written.out == ""


SHARES = [
    ("copies", (0.0, 50.0), ("copies/s", "50")),
    (TIME, (3.0, 10.5), ("t = 10.5 of 10.5", "a second")),
    (TIME, (3.0, -4.5), ("t = -4.5 of -4.5", "a second")),
]


@pytest.mark.parametrize("tqdm", [True, False])
@pytest.mark.parametrize(("unit", "of", "shown"), SHARES)
def test_a_share_is_that_of_what_people_know(
    unit: str,
    of: tuple[float, float],
    shown: tuple[str, ...],
    tqdm: bool,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with callback(True, unit, of) as report:
        _core._busy(0.3, 1, report)
    written = capsys.readouterr().err
    assert all(text in written.split("\r")[-1] for text in shown)
    assert re.search(r"\d left|\d s left|\d<\d", written)


def runs() -> dict[str, tuple[Callable[[], object], str]]:
    """Runs of each kind, and what they show when they end."""
    orbit, pendulum = vv.problems.kepler(e=0.5).scene, vv.systems.pendulum()
    third = vv.problems.figure_eight().scene
    copies = third.ensemble(velocity=third.particles.velocity[None] * np.array([1.0, 0.99, 0.98])[:, None, None])
    balls = vv.Particles([1.0, 1.0], [[-2.0, 0, 0], [2.0, 0, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5)
    bouncing = vv.Scene(balls, vv.Harmonic(1.0))
    many = pendulum.ensemble(position=[[0.1], [0.2], [0.3]])
    return {
        "steps": (lambda: third.run(t=1.0, method="leapfrog", dt=0.01, progress=True), "100/100 .*steps/s"),
        "time": (lambda: third.run(t=-2.5, method="dop853", progress=True), r"t = -2\.5 of -2\.5, .* a second"),
        "times of a closed form": (lambda: orbit.run(t=np.arange(40.0), progress=True), r"40\.0/40\.0 .*times/s"),
        "copies": (lambda: copies.run(t=1.0, progress=True), r"3\.00/3\.00 .*copies/s"),
        "copies by steps": (lambda: copies.run(t=1.0, method="rk4", dt=0.1, progress=True), r"3\.00/3\.00 .*copies/s"),
        "generalized copies": (lambda: many.run(t=1.0, progress=True), r"3\.00/3\.00 .*copies/s"),
        "one generalized": (lambda: pendulum.run(t=-1.5, progress=True), r"t = -1\.5 of -1\.5, .* a second"),
        "collisions": (lambda: bouncing.run(t=4.0, collisions="bounce", progress=True), r"100 %"),
    }


@pytest.mark.parametrize("method", ["gauss16", "taylor", "dop853"])
def test_one_run_in_generalized_coordinates_tells_the_time_on_its_way(method: vv.typing.GeneralizedMethodName) -> None:
    seen: list[float] = []
    vv.systems.double_pendulum().run(t=4e3, method=method, progress=lambda done, total: seen.append(done / total))
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    assert any(0.0 < share < 1.0 for share in seen)


@pytest.mark.parametrize("kind", runs())
def test_runs_say_what_they_have_done(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    run, shown = runs()[kind]
    run()
    assert re.search(shown, capsys.readouterr().err)


def test_a_saved_run_tells_the_time_that_is_reached(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    scene = vv.problems.figure_eight().scene
    scene.run(t=[0.5, 3.0], method="dop853", save_every=1.0, save_to=tmp_path / "run", progress=True)
    assert re.search(r"t = 3 of 3, .* a second", capsys.readouterr().err)


@pytest.mark.parametrize(
    ("rate", "shown"),
    [(0.5, "0.5"), (12.0, "12"), (999.0, "999"), (1234.0, "1.23 k"), (2.5e9, "2.5 G"), (4e13, "4e+04 G")],
)
def test_rates_have_their_prefix(rate: float, shown: str) -> None:
    assert _scaled(rate) == shown
