"""What ``progress=`` may be and what it shows."""

import sys

import pytest

from visviva import _core
from visviva._progress import callback
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


def test_true_is_a_bar(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    with callback(True) as report:
        _core._busy(0.3, 1, report)
    shown = capsys.readouterr()
    assert "10/10" in shown.err
    assert shown.out == ""


def test_true_is_a_line_without_tqdm(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with callback(True) as report:
        _core._busy(0.3, 1, report)
    shown = capsys.readouterr()
    assert shown.err.startswith("\rvisviva: ")
    assert shown.err.endswith("\rvisviva: 100 %\n")
    assert shown.out == ""
