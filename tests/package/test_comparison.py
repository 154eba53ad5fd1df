"""Work against precision: every point is a run that says what it says, and the best is the best.

Bounds: a closed form, to some roundings of numbers of size 1.
"""

from time import perf_counter

import numpy as np
import pytest

import visviva as vv

KEPLER = vv.problems.kepler(e=0.6)


def test_each_point_is_that_run() -> None:
    found = vv.work_precision(
        KEPLER, ["dop853", next(m for m in vv.methods() if m.name == "rk4")], seconds=0.02, repeats=1
    )
    assert found.series == ("dop853", "rk4")
    for point in found.points[::5]:
        how = {"rtol": point.setting} if point.series == "dop853" else {"dt": point.setting}
        out = KEPLER.scene.run(KEPLER.t_end, method=point.series, **how)
        assert KEPLER.error(out) == point.position_error
        energy = KEPLER.scene.invariants().energy
        assert abs(out.final.invariants().energy - energy) / abs(energy) == point.energy_error
        assert 0.0 < point.seconds < 1.0


def test_the_slopes_are_the_orders() -> None:
    """Twice the steps, 2ᵖ less error, between 1e-3 and 1e-9: what the picture shows at a glance."""
    problem = vv.problems.figure_eight()
    found = vv.work_precision(problem, ["rk4", "leapfrog", "kahan_li8"], seconds=0.05, repeats=1)
    for name, order in (("rk4", 4), ("leapfrog", 2), ("kahan_li8", 8)):
        own = [(p.setting, p.position_error) for p in found.points if p.series == name]
        own = [(dt, error) for dt, error in own if 1e-9 < error < 1e-3]
        dt, error = np.log(np.array(own).T)
        assert abs(np.polyfit(dt, error, 1)[0] - order) < 0.5 + 0.1 * order, name


def test_all_methods_that_the_forces_allow_by_default() -> None:
    charge = vv.work_precision(vv.problems.crossed_fields(), seconds=0.002, repeats=1)
    assert {"boris", "dop853"} <= set(charge.series)
    assert "leapfrog" not in charge.series
    assert all(np.isfinite(point.energy_error) for point in charge.points)
    driven = vv.work_precision(vv.problems.driven_oscillator(), seconds=0.002, repeats=1)
    assert all(np.isnan(point.energy_error) for point in driven.points)
    closed = vv.work_precision(KEPLER, ["auto"], repeats=1)
    assert closed.points[0].position_error < 1e-14


def test_the_envelope_is_beaten_by_none() -> None:
    found = vv.work_precision(KEPLER, seconds=0.01, repeats=1)
    front = found.envelope()
    for point in found.points:
        assert any(p.seconds <= point.seconds and p.position_error <= point.position_error for p in front)
    for mark in (1e-3, 1e-6, 1e-9):
        best = found.best(mark)
        assert best in front
        own = found.best(mark, "rk4")
        assert own is None or (own.series == "rk4" and best is not None and own.seconds >= best.seconds)
    assert found.best(1e-30) is None


def test_a_method_that_gets_nowhere_is_given_up_in_time() -> None:
    """Euler's spirals out of an eccentric ellipse, whatever its steps: it is taken no further than the time allows."""
    begun = perf_counter()
    found = vv.work_precision(vv.problems.kepler(e=0.9, periods=10), ["euler"], seconds=0.01, repeats=1)
    assert found.best(1e-2) is None
    assert perf_counter() - begun < 5.0


def test_it_prints_and_plots_with_a_peer() -> None:
    found = vv.work_precision(KEPLER, ["dop853"], seconds=0.005, repeats=1)
    joined = found.joined([vv.Point("peer", 1e-9, 2.0, 1e-7, float("nan"))])
    text = str(joined)
    assert text.startswith("kepler")
    assert "to 1e-09" in text
    assert "peer" in text
    assert "—" in text
    pytest.importorskip("matplotlib")
    axes = joined.plot(peers=["peer"])
    labels = [item.get_text() for item in axes.get_legend().get_texts()]
    assert labels == ["best of all", "dop853", "peer"]
    assert axes.xaxis_inverted()


@pytest.mark.parametrize(
    ("how", "argument"),
    [
        ({"problem": KEPLER.scene}, "problem"),
        ({"methods": ["rk5"]}, "method"),
        ({"methods": ["boris", "dop853"], "problem": vv.problems.driven_oscillator()}, "method"),
        ({"seconds": 0.0}, "seconds"),
        ({"repeats": 0}, "repeats"),
        ({"metods": ["rk4"]}, "metods"),
    ],
)
def test_what_makes_no_sense_is_refused(how: dict[str, object], argument: str) -> None:
    with pytest.raises(vv.InvalidInput) as caught:
        vv.work_precision(**({"problem": KEPLER} | how))  # type: ignore[arg-type]
    assert caught.value.argument == argument
