"""Panels of what counts leave beside theory: how many standard deviations, where, and in whose axes.

Bounds: what is drawn is the number itself, in other units: some roundings.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

pytest.importorskip("matplotlib")
BEAM: dict[str, Any] = {"beam_energy": 1.0, "masses": (1.0, 4.0), "b_max": 3.0, "seed": 1}
RUN = vv.scattering.monte_carlo(
    vv.potentials.Coulomb(1.0), **BEAM, n_events=20_000, bins=30, tally=["cm_angle", "lab_angle", "energy"]
)
TALLY = RUN["cm_angle"]


def marked(axes: Any) -> tuple[np.ndarray, np.ndarray]:
    [line] = [line for line in axes.lines if line.get_marker() == "."]
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata())


def test_what_is_left_is_in_standard_deviations_of_what_is_expected() -> None:
    upper, lower = TALLY.plot().figure.axes
    assert upper.get_shared_x_axes().joined(upper, lower)
    assert lower.get_position().y1 < upper.get_position().y0
    expected = TALLY.expected()
    there = expected >= 1.0
    x, left = marked(lower)
    assert x == pytest.approx(np.degrees(0.5 * (TALLY.edges[1:] + TALLY.edges[:-1]))[there], rel=1e-14, abs=0)
    sigma = np.sqrt(expected * (1.0 - expected / TALLY.n_events))[there]
    assert left * sigma == pytest.approx((TALLY.counts - expected)[there], rel=1e-14, abs=0)
    # Of a simulation that is right a third is outside of the band, which is one wide to each side, and none at 5.
    assert 0.1 < (np.abs(left) > 1.0).mean() < 0.6
    assert np.abs(left).max() < 5.0
    [band] = lower.patches
    assert (band.get_y(), band.get_height()) == (-1.0, 2.0)
    assert lower.get_ylim()[1] > np.abs(left).max()
    assert (upper.get_xlabel(), lower.get_ylabel()) == ("", "(n − theory) / σ")


def test_a_wrong_theory_is_seen_at_a_glance() -> None:
    """Counts of events twice as many as are said to have come: all are above by as much as they are."""
    from dataclasses import replace

    wrong = replace(TALLY, counts=2 * TALLY.counts)
    _, left = marked(wrong.plot().figure.axes[1])
    assert np.median(left) > 5.0


def test_in_axes_of_ones_own() -> None:
    from matplotlib.figure import Figure

    upper, lower = Figure().subplots(2)
    assert TALLY.plot(ax=upper) is upper
    assert not lower.has_data()
    assert upper.get_xlabel() == "angle in the center-of-mass frame [degrees]"
    upper, lower = Figure().subplots(2)
    assert TALLY.plot(ax=upper, residuals=lower) is upper
    assert len(marked(lower)[0]) == (TALLY.expected() >= 1.0).sum()
    assert lower.get_xlabel() == "angle in the center-of-mass frame [degrees]"


def test_of_weighted_events() -> None:
    few = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(1.0), **BEAM, n_events=20_000, bins=30, importance=vv.scattering.Strata([0.0, 0.5, 3.0])
    )["cm_angle"]  # fmt: skip
    there = few.variances() > 0.0
    _, left = marked(few.plot().figure.axes[1])
    assert left * np.sqrt(few.variances()[there]) == pytest.approx(
        (few.values() - few.expected())[there], rel=1e-6, abs=0
    )


def test_where_nothing_is_expected_there_is_no_panel() -> None:
    from matplotlib.figure import Figure

    spread = vv.scattering.monte_carlo(
        vv.potentials.Coulomb(1.0), **BEAM, n_events=1000, energy_spread=0.05, bins=10
    )["cm_angle"]  # fmt: skip
    assert len(spread.plot().figure.axes) == 1
    upper, lower = Figure().subplots(2)
    with pytest.raises(vv.InvalidInput, match=r"^residuals: expected a theory"):
        spread.plot(ax=upper, residuals=lower)
    assert not upper.has_data()
    with pytest.raises(vv.InvalidInput, match=r"^residuals: expected ax="):
        TALLY.plot(residuals=lower)
    with pytest.raises(vv.InvalidInput, match=r"^residuals: expected axes"):
        TALLY.plot(ax=upper, residuals=3)  # type: ignore[arg-type]


def test_each_tally_has_its_own_and_rows_are_of_three() -> None:
    names = ["cm_angle", "lab_angle", "recoil_angle", "energy", "recoil_energy"]
    run = vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), **BEAM, n_events=1000, bins=10, tally=names)
    figure = run.plot()
    assert len(figure.axes) == 10
    uppers, lowers = figure.axes[::2], figure.axes[1::2]
    assert all(marked(lower)[0].size for lower in lowers)
    rows = [axes.get_subplotspec().rowspan.start for axes in uppers]  # type: ignore[union-attr]
    assert rows == [0, 0, 0, 2, 2]


def test_a_foil_draws_each_tally_where_it_is_told() -> None:
    from matplotlib.figure import Figure

    out = vv.scattering.Foil("gold", 0.06).run("alpha", beam_energy=2e4, n_events=300, seed=1)
    own = Figure().add_subplot()
    tally = out["stopped_depth"]
    assert tally.plot(ax=own) is own
    [steps] = own.patches
    assert steps.get_data().values == pytest.approx(tally.fraction().value, rel=1e-14, abs=0)  # type: ignore[attr-defined]
    low, high = own.get_xlim()
    counted = np.flatnonzero(tally.counts)
    assert low <= tally.edges[counted[0]] < tally.edges[counted[-1] + 1] <= high
    # What lies far from all that was counted is not shown.
    fast = vv.scattering.Foil("gold", 0.4).run("alpha", beam_energy=7.687e6, n_events=300, seed=1)
    assert fast["transmitted_energy"].plot().get_xlim()[0] > 5e6
