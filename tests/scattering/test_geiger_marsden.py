"""The experiment of 1913, simulated: both metals within the errors of the counts, and the command that shows it.

Bounds: a sum of six squares in another order.
"""

import numpy as np
import pytest

from visviva.cli import main
from visviva.geiger_marsden import compare_metal


@pytest.mark.parametrize("metal", ["silver", "gold"])
def test_table_two(metal):
    found = compare_metal(metal, events=150_000)
    assert 0.2 < found.reduced_chi2 < 2.0
    assert 0.2 < found.reduced_chi2_law < 2.0
    assert found.angle.tolist() == [15.0, 22.5, 30.0, 37.5, 45.0, 60.0, 75.0, 105.0, 120.0, 135.0, 150.0]
    # Plural scattering adds a few percent to the law near the plane of the foil; the errors are 1 to 4 %.
    off = (found.simulated / found.law - 1.0) / (found.simulated_error / found.law)
    assert np.abs(off).max() < 6.0
    assert np.abs(found.simulated / found.law - 1.0).max() < 0.12


def test_the_scale_leaves_least():
    found = compare_metal("gold", events=50_000)
    fitted = found.angle >= 45.0
    said, error = found.simulated[fitted], np.hypot(0.05, found.simulated_error[fitted] / found.simulated[fitted])

    def left(scale):
        return np.sum(((found.counted[fitted] / said / scale - 1.0) / error) ** 2) / 6

    assert left(found.scale) == pytest.approx(found.reduced_chi2, rel=1e-12, abs=0)
    assert left(found.scale) < min(left(found.scale * 1.001), left(found.scale / 1.001))


def test_the_command(tmp_path, capsys):
    assert main(["geiger-marsden", "--events", "30000", "--output", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "silver" in told
    assert "gold" in told
    assert told.count("χ² per degree of freedom") == 2
    pytest.importorskip("matplotlib")
    assert (tmp_path / "geiger_marsden.png").stat().st_size > 10_000
    with pytest.raises(SystemExit):
        main(["geiger-marsden", "--thickness", "-1", "--output", str(tmp_path)])
    assert "thickness: expected a positive finite number" in capsys.readouterr().err
