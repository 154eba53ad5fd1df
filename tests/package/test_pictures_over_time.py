"""Pictures of elements, of solutions of any equation and of modes: what is drawn is what they have.

Bounds: what is drawn is the number itself, in degrees: some roundings.
"""

from typing import Any

import numpy as np
import pytest

import visviva as vv

pytest.importorskip("matplotlib")
from matplotlib.figure import Figure

T = np.linspace(0.0, 2e4, 301)
OUT = vv.datasets.outer_solar_system().scene.run(t=T, method="dop853")
TWO = OUT.elements(["Jupiter", "Saturn"], about="Sun")
KEPLER = vv.problems.kepler(e=0.5).scene


def column(line: Any) -> np.ndarray:
    return np.asarray(line.get_ydata(), dtype=float)


def test_elements_of_each_body_in_three_panels() -> None:
    figure = TWO.plot()
    drawn = (TWO.semi_major_axis, TWO.eccentricity, np.degrees(TWO.inclination))
    for axes, values in zip(figure.axes, drawn, strict=True):
        assert [line.get_label() for line in axes.lines] == ["Jupiter", "Saturn"]
        for line, expected in zip(axes.lines, values.T, strict=True):
            assert (np.asarray(line.get_xdata()) == T).all()
            assert column(line) == pytest.approx(expected, rel=1e-14, abs=0)
    assert figure.axes[-1].get_legend() is not None


def test_angles_break_where_they_go_round() -> None:
    axes = TWO.plot("true_anomaly").axes[0]
    assert axes.get_ylabel() == "true anomaly [degrees]"
    jupiter = column(axes.lines[0])
    there = np.isfinite(jupiter)
    assert jupiter[there] == pytest.approx(np.degrees(TWO.true_anomaly[:, 0])[there], rel=1e-14, abs=0)
    # In 20 000 days Jupiter, of 4333, is at 180° four or five times.
    assert np.count_nonzero(~there) in (4, 5)
    assert np.nanmax(np.abs(np.diff(jupiter))) < 180.0


def test_what_stays_is_drawn_as_what_stays() -> None:
    """Elements of two bodies alone change by rounding, which is no signal."""
    alone = KEPLER.run(t=np.linspace(0.0, 30.0, 200)).elements(1, about=0)
    assert 0.0 < np.ptp(alone.semi_major_axis) < 1e-12
    for axes in alone.plot().axes:
        low, high = axes.get_ylim()
        values = column(axes.lines[0])
        assert np.ptp(values) < 1e-9 * (high - low)
        assert low < values.min() <= values.max() < high


def test_elements_without_a_time_are_no_picture() -> None:
    own = Figure().add_subplot()
    assert TWO.plot("eccentricity", ax=own) is own.figure
    copies = KEPLER.ensemble(velocity=np.tile(KEPLER.particles.velocity, (3, 1, 1))).run(t=[0.0, 1.0])
    for wrong, argument, words in (
        (lambda: TWO.plot(ax=own), "ax", "takes one panel"),
        (lambda: TWO.plot("excentricity"), "element", "did you mean 'eccentricity'"),
        (lambda: TWO.plot("angular_momentum"), "element", "expected one of"),
        (lambda: TWO.plot("inclination", ax=3), "ax", "axes of matplotlib"),  # type: ignore[arg-type]
        (vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0]).plot, "plot", "single orbits"),
        (copies.elements(1, about=0).plot, "plot", "3 copies"),
    ):
        with pytest.raises(vv.InvalidInput, match=words) as caught:
            wrong()
        assert caught.value.argument == argument


def test_a_solution_is_drawn_between_its_times_if_it_is_known_there() -> None:
    def turning(t: float, y: np.ndarray) -> list[float]:
        return [y[1], -y[0]]

    found = vv.solve_ivp(turning, (0.0, 12.0), [1.0, 0.0], rtol=1e-10, atol=1e-12, dense_output=True)
    axes = found.plot()
    first, second = axes.lines
    t = np.asarray(first.get_xdata(), dtype=float)
    assert len(t) > 1000 > len(found.t)
    # Some steps of a tolerance of 1e-10, and what is between them; measured 1.3e-10.
    assert column(first) == pytest.approx(np.cos(t), abs=5e-10)
    assert column(second) == pytest.approx(-np.sin(t), abs=5e-10)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["y[0]", "y[1]"]
    own = Figure().add_subplot()
    nodes = vv.solve_ivp(turning, (0.0, 12.0), [1.0, 0.0])
    assert nodes.plot(ax=own) is own
    for line, component in zip(own.lines, nodes.y, strict=True):
        assert (np.asarray(line.get_xdata()) == nodes.t).all()
        assert (column(line) == component).all()
        assert line.get_marker() == "."


def test_modes_are_named_by_their_frequencies() -> None:
    small = vv.systems.coupled_oscillators().normal_modes()
    axes = small.plot()
    lines = axes.lines[:2]
    assert [line.get_label() for line in lines] == ["ω = 1", "ω = 1.095"]
    for line, mode in zip(lines, small.modes, strict=True):  # type: ignore[arg-type]
        assert np.asarray(line.get_xdata()).tolist() == [1, 2]
        assert (column(line) == mode).all()
    upside_down = vv.systems.pendulum(g=4.0, l=1.0).linearize(at=[np.pi]).plot()
    assert upside_down.lines[0].get_label() == "grows at 2"
    turning = vv.systems.foucault(Omega=0.1).linearize(at=[0.0, 0.0])
    with pytest.raises(vv.InvalidInput, match=r"^plot: expected modes"):
        turning.plot()
