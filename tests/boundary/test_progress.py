"""What ``progress=`` may be and what it shows."""

import sys

import pytest

from visviva import _core
from visviva._progress import _scaled, callback
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


@pytest.mark.parametrize(
    ("rate", "shown"),
    [(0.5, "0.5"), (12.0, "12"), (999.0, "999"), (1234.0, "1.23 k"), (2.5e9, "2.5 G"), (4e13, "4e+04 G")],
)
def test_rates_have_their_prefix(rate: float, shown: str) -> None:
    assert _scaled(rate) == shown
