"""The command line, as a person meets it."""

import argparse
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

import visviva as vv
from visviva.cli import _parser, main


def test_methods_lists_every_method(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["methods"]) == 0
    shown = capsys.readouterr().out
    for method in vv.methods():
        assert method.name in shown
        assert method.summary in shown


def test_info(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info"]) == 0
    shown = capsys.readouterr().out
    for word in ("version: ", "simd", "fused multiply add: ", "threads: ", "profile: "):
        assert word in shown


def test_info_says_what_it_costs_to_do_without_fused_multiply_add() -> None:
    environment = {**os.environ, "VISVIVA_SIMD": "portable"}
    command = [sys.executable, "-m", "visviva", "info"]
    shown = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
    slow = platform.machine().lower() in ("x86_64", "amd64")
    assert ("ten times" in shown) == slow


def test_demo_makes_tables_and_pictures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo", "--output", str(tmp_path), "--days", "20000", "--events", "2e5"]) == 0
    shown = capsys.readouterr().out
    for word in ("Neptune", "angular momentum", "quadruple-precision", "χ²", "gold, 1913"):
        assert word in shown
    pictures = {path.name: path.read_bytes()[:8] for path in tmp_path.glob("*.png")}
    assert pictures == dict.fromkeys(("outer_solar_system.png", "rutherford.png"), b"\x89PNG\r\n\x1a\n")
    assert isinstance(vv.load(tmp_path / "outer_solar_system.npz"), vv.Trajectory)


@pytest.mark.parametrize(
    "given",
    [
        ["--events", "inf"],
        ["--days", "nan"],
        ["--days", "soon"],
        ["--days", "-5"],
        ["--days", "0"],
        ["--events", "0.5"],
        ["--events", "1.5"],
    ],
)
def test_a_number_that_is_none_is_refused(given: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["demo", *given])
    assert f"argument {given[0]}: " in capsys.readouterr().err


def test_demo_with_too_few_events_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo", "--output", str(tmp_path), "--days", "2000", "--events", "10"]) == 0
    shown = capsys.readouterr().out
    assert "too few events for a comparison with 1913" in shown
    assert "nan" not in shown.split("Rutherford")[1]


def test_a_refusal_is_one_line_and_a_code(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo", "--output", str(tmp_path), "--threads", "0"]) == 1
    error = capsys.readouterr().err.strip()
    assert error.startswith("visviva: threads: ")
    assert "\n" not in error


def test_the_module_runs() -> None:
    done = subprocess.run([sys.executable, "-m", "visviva", "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == f"visviva {vv.__version__}"


def test_import_is_light() -> None:
    """`import visviva` loads nothing of its own until it is used."""
    code = "import sys, visviva; print(sorted(name for name in sys.modules if name.startswith('visviva.')))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_pyplot_is_never_touched() -> None:
    code = (
        "import sys, visviva as vv; vv.problems.figure_eight().scene.run(t=[0.0, 1.0]).plot(); "
        "print('matplotlib.pyplot' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_a_plot_has_every_body_and_the_energy() -> None:
    figure = vv.problems.figure_eight().scene.run(t=[0.0, 0.5, 1.0]).plot()
    orbits, energy = figure.axes
    assert len(orbits.lines) == 2 * 3
    assert energy.lines[0].get_xdata().tolist() == [0.0, 0.5, 1.0]
    alone = vv.problems.figure_eight().scene.run(t=[0.0, 0.5, 1.0], record=("position",)).plot()
    assert len(alone.axes) == 1


def test_what_nobody_says_is_of_the_kind_that_is_said() -> None:
    """`visviva demo` as the README has it, without options, once stopped at a default that was no whole number."""
    (commands,) = (action for action in _parser()._actions if isinstance(action, argparse._SubParsersAction))
    looked_at = 0
    for name, parser in commands.choices.items():
        for action in parser._actions:
            if action.type is not None and action.default is not None:
                assert isinstance(action.default, type(action.type(str(action.default)))), (name, action.dest)
                looked_at += 1
    assert looked_at >= 10
