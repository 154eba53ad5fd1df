"""`visviva pendulum`: a pendulum against elliptic functions, and double pendulums that part."""

import re
from pathlib import Path

import pytest

from visviva.cli import main


def test_pendulum_prints_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pendulum", "--output", str(tmp_path), "--members", "16"]) == 0
    printed = capsys.readouterr().out
    periods = [float(number) for number in re.findall(r"(\d+\.\d{15}) s", printed)]
    # By quadrature and by the mean of Gauss, next to the separatrix: 1/(1 − k²) = 500 times round-off.
    assert len(periods) == 2
    assert abs(periods[0] / periods[1] - 1.0) < 1e-13
    error = re.search(r"largest error of the angle (\S+) rad, of the energy (\S+)", printed)
    assert error is not None
    # The conditioning of ten swings at k = 0.999 is some 10⁴.
    assert float(error[1]) < 2e-11
    assert float(error[2]) < 2e-14
    assert (tmp_path / "pendulum.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
