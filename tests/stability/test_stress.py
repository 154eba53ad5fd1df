"""The short form of ``visviva stress``: no wrong number that is told as a right one, for any method."""

import pytest

import visviva as vv
from visviva.cli import main


@pytest.mark.parametrize("method", [method.name for method in vv.methods()])
def test_no_method_fails_under_abuse(method: str) -> None:
    report = vv.stress.run([method])
    assert not report.failures, str(report)
    # What is asked is not refused altogether.
    assert sum(verdict.word == "ok" for verdict in report.verdicts) >= 3


def test_a_failure_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stress", "--methods", "leapfrog"]) == 0
    assert "0 failed" in capsys.readouterr().out
    assert main(["stress", "--methods", "leapfrogs"]) == 1
    assert "leapfrogs" in capsys.readouterr().err
