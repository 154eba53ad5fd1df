"""`visviva toutatis`, `visviva dzhanibekov`, and the data they show.

Bounds: the last digit that the other code prints; angles of some degrees by an arc cosine, which amplifies roundings
by one over their sine; a date in days, to its rounding.
"""

from pathlib import Path

import numpy as np
import pytest

import visviva as vv
from visviva.cli import main

# What the free rotation of Principia, which is another code, leaves of the same seventeen attitudes: the relative
# difference of |ω|, the angle of ω, and those of the axes of the smallest, the middle and the largest moment.
PRINCIPIA = (
    (0.011, 4.5, 7.9, 5.4, 5.9),
    (0.076, 0.5, 6.6, 7.7, 4.7),
    (0.005, 5.0, 13, 15, 9.4),
    (0.064, 1.1, 9.4, 4.3, 8.4),
    (0.032, 0.8, 2.0, 0.6, 2.1),
    (0.028, 24, 5.7, 15, 15),
    (0.0001, 2.7, 3.0, 2.6, 2.6),
    (0.028, 3.4, 3.4, 3.4, 1.1),
    (0.0009, 0.8, 3.1, 1.4, 3.4),
    (0.022, 1.0, 2.8, 1.6, 2.7),
    (0.025, 2.2, 2.0, 3.2, 2.6),
    (0.013, 3.4, 2.5, 5.3, 5.3),
    (0.119, 22, 4.1, 3.8, 4.5),
    (0.026, 4.9, 3.2, 8.2, 8.0),
    (0.052, 2.6, 7.3, 5.8, 8.0),
    (0.045, 2.1, 0.8, 1.1, 1.2),
    (0.036, 2.1, 5.6, 6.3, 4.1),
)


def test_the_periods_of_toutatis() -> None:
    """Reference values to 15 digits, by quadrature in 40 digits from the published state."""
    data = vv.datasets.toutatis()
    path = vv.rigid.polhode(data.moments, data.angular_velocity)
    assert path.kind == "about_smallest"
    assert path.period == pytest.approx(5.36853031352291, rel=3e-15, abs=0)
    assert 2 * np.pi / path.precession_rate == pytest.approx(7.41165226793735, rel=3e-15, abs=0)


def test_the_angular_momentum_is_that_of_another_source() -> None:
    """Zhao et al. (2015), from images of Chang'e-2 twenty years later: ecliptic longitude 180.2°, latitude −54.75°."""
    along = vv.datasets.toutatis().motion([0.0, 30.0]).angular_momentum
    unit = along / np.linalg.norm(along, axis=-1)[:, None]
    longitude, latitude = np.radians([180.2, -54.75])
    other = [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    assert np.degrees(np.arccos(unit @ other)).max() < 1.5


def test_residuals_are_those_of_another_code() -> None:
    """To one unit of the last digit that it gives."""
    data = vv.datasets.toutatis()
    found, expected = data.compare(), np.array(PRINCIPIA)
    assert len(data.radar.date) == len(expected) == 17
    out, seen = data.motion(data.radar.t), data.radar.orientation
    axes = vv.rigid.matrix(out.orientation) * vv.rigid.matrix(seen)
    angles = np.degrees(np.arccos(axes.sum(axis=1)))[:, [2, 0, 1]]
    assert np.abs(found.spin_ratio - 1) == pytest.approx(expected[:, 0], abs=1e-3)
    for at, values in enumerate((found.spin_direction, *angles.T), start=1):
        step = np.where(expected[:, at] >= 13, 1.0, 0.1)
        assert np.all(np.abs(values - expected[:, at]) <= step)
    assert found.long_axis == pytest.approx(angles[:, 0], abs=2e-11)
    # The rotation between two attitudes turns no axis further than itself, and one of three at least half as far.
    assert np.all(angles.max(axis=1) <= found.attitude * (1 + 1e-9))
    assert np.all(angles.max(axis=1) >= 0.5 * found.attitude)


def test_radar_data_is_read_only_and_in_order() -> None:
    data = vv.datasets.toutatis()
    assert np.all(np.diff(data.radar.t) > 0.5)
    assert data.radar.t[0] == pytest.approx(23 + 3 / 24 + 50 / 1440 + 13 / 86400, rel=1e-14, abs=0)
    for array in (data.moments, data.angular_velocity, data.euler_angles, data.radar.t, data.radar.euler_angles):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_toutatis_prints_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["toutatis", "--output", str(tmp_path), "--days", "30"]) == 0
    shown = capsys.readouterr().out
    for word in ("Takahashi", "5.368530313522", "7.411652267937", "1992-12-09T17:49", "1992-12-18T07:09", "left out"):
        assert word in shown
    assert (tmp_path / "toutatis.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_dzhanibekov_prints_and_draws(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["dzhanibekov", "--output", str(tmp_path), "--flips", "3"]) == 0
    shown = capsys.readouterr().out
    # The reference of the case, 118.110887046385744, to the digits of a binary64 number.
    assert "118.110887046386" in shown
    rows = [line.split() for line in shown.splitlines() if line[:4].strip().isdigit()]
    assert len(rows) == 3
    for at, row in enumerate(rows):
        exact = 118.110887046385744 * (at + 0.5) / 2
        assert float(row[1]) == pytest.approx(exact, rel=1e-14, abs=0)
        # The closed form by its states: 4 ε of the time, by the rate at which the component goes through zero.
        assert abs(float(row[2])) <= 1e-14 * exact
        # A tolerance of 1e-12, amplified near the separatrix.
        assert abs(float(row[3])) <= 1e-8
    assert (tmp_path / "dzhanibekov.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_without_matplotlib_there_are_tables(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("visviva.tumbling.find_spec", lambda name: None)
    for command in ("toutatis", "dzhanibekov"):
        assert main([command, "--output", str(tmp_path)]) == 0
        assert "matplotlib is not installed" in capsys.readouterr().out
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "words",
    [
        (["toutatis", "--days", "1e9"], "days: expected"),
    ],
)
def test_refusals(words: tuple[list[str], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given, expected = words
    assert main([*given, "--output", str(tmp_path)]) == 1
    assert expected in capsys.readouterr().err


@pytest.mark.parametrize("given", [["toutatis", "--days", "0"], ["dzhanibekov", "--flips", "0"]])
def test_nothing_to_run_is_refused_by_the_option(given: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(given)
    assert f"argument {given[1]}: expected a positive finite number, got 0" in capsys.readouterr().err
