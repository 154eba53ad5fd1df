"""Pictures of what was measured beside theory: both where the numbers are, and below what is left of them.

Bounds: what is drawn is the number itself, in other units: some roundings.
"""

from typing import Any

import numpy as np
import pytest
from drawn import columns, named, nothing_is_clipped

import visviva as vv
from visviva.geiger_marsden import compare_metal

pytest.importorskip("matplotlib")
from matplotlib.figure import Figure

SILVER, GOLD = vv.datasets.geiger_marsden_1913().compare()
TOUTATIS = vv.datasets.toutatis().compare()


def test_counts_of_1913_beside_the_law() -> None:
    upper, lower = GOLD.plot().figure.axes
    drawn = named(upper)
    degrees, law = columns(drawn["gold: Rutherford's law"])
    assert law * np.sin(np.radians(degrees) / 2.0) ** 4 == pytest.approx(GOLD.scale, rel=1e-14, abs=0)
    points, _, (bars,) = drawn["gold: counted in 1913"]
    angle, counted = columns(points)
    assert angle.tolist() == GOLD.angle.tolist()
    assert counted == pytest.approx(vv.datasets.geiger_marsden_1913().gold, rel=1e-14, abs=0)
    # Bars of 5 %, and in the panel below the ratio, with the same within a band as wide.
    ends = np.array([np.asarray(each)[:, 1] for each in bars.get_segments()])
    assert ends / counted[:, None] == pytest.approx(np.tile([0.95, 1.05], (11, 1)), rel=1e-6, abs=0)
    assert columns(lower.lines[0])[1] == pytest.approx(GOLD.ratio, rel=1e-6, abs=0)
    [band] = lower.patches
    assert (band.get_y(), band.get_height()) == pytest.approx((0.95, 0.1))
    assert upper.get_shared_x_axes().joined(upper, lower)
    assert lower.get_xlabel() == "angle from the beam φ [degrees]"
    assert upper.get_yscale() == "log"


def test_both_metals_in_one_picture_have_one_band() -> None:
    upper, lower = Figure().subplots(2)
    for metal in (SILVER, GOLD):
        assert metal.plot(ax=upper, residuals=lower) is upper
    assert len(named(upper)) == 4
    assert len(lower.patches) == 1
    colors = [named(upper)[f"{metal}: Rutherford's law"].get_color() for metal in ("silver", "gold")]
    assert colors[0] != colors[1]
    alone = Figure().add_subplot()
    SILVER.plot(ax=alone)
    assert alone.get_xlabel() == "angle from the beam φ [degrees]"
    with pytest.raises(vv.InvalidInput, match=r"^residuals: expected ax="):
        SILVER.plot(residuals=alone)


def test_the_simulation_is_drawn_with_them() -> None:
    found = compare_metal("silver", events=20_000)
    upper, lower = found.plot().figure.axes
    label = next(name for name in named(upper) if name.startswith("silver: simulated"))
    _, simulated = columns(named(upper)[label][0])
    assert simulated == pytest.approx(found.simulated * found.scale, rel=1e-14, abs=0)
    ratios = [columns(line)[1] for line in lower.lines if len(line.get_xdata()) == 11]
    # In whose units ever: what was counted over what the law says, and what was simulated.
    assert ratios[0] == pytest.approx(found.counted / (found.law * found.scale), rel=1e-6, abs=0)
    assert ratios[1] == pytest.approx(found.simulated / found.law, rel=1e-6, abs=0)


def test_toutatis_beside_what_radar_saw() -> None:
    assert TOUTATIS.spin_state.radar.date == TOUTATIS.date
    upper, lower = TOUTATIS.plot().figure.axes
    drawn = named(upper)
    radar = TOUTATIS.spin_state.radar
    for at, letter in enumerate("xyz"):
        t, seen = columns(drawn[f"ω{letter}: radar"])
        assert (t == radar.t).all()
        assert seen == pytest.approx(np.degrees(radar.angular_velocity[:, at]), rel=1e-14, abs=0)
        fine, computed = columns(drawn[f"ω{letter}: free rotation"])
        there = TOUTATIS.spin_state.motion(fine).angular_velocity[:, at]
        assert computed == pytest.approx(np.degrees(there), rel=1e-14, abs=0)
    left = {name: columns(line)[1] for name, line in named(lower).items()}
    assert (left["attitude"] == TOUTATIS.attitude).all()
    assert (left["long axis"] == TOUTATIS.long_axis).all()
    assert (left["direction of ω"] == TOUTATIS.spin_direction).all()
    assert lower.get_ylim()[0] == 0.0
    assert upper.get_shared_x_axes().joined(upper, lower)


@pytest.mark.parametrize("found", [GOLD, TOUTATIS], ids=["1913", "Toutatis"])
def test_nothing_is_clipped_and_legends_lie_on_no_line(found: Any) -> None:
    figure = found.plot().figure
    nothing_is_clipped(figure)
    for axes in figure.axes:
        legend = axes.get_legend()
        for line in axes.lines if legend else ():
            path = line.get_path().transformed(line.get_transform())
            assert not path.intersects_bbox(legend.get_window_extent(), filled=False)
