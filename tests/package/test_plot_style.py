"""How all pictures look: one style, also for figures of one's own, and nothing that lies on something else."""

from collections.abc import Callable
from io import BytesIO
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest

import visviva as vv

mpl = pytest.importorskip("matplotlib")
from matplotlib.figure import Figure  # noqa: E402

T = np.linspace(0.0, 30.0, 401)
FREE = vv.rigid.free_rotation([1.0, 2.0, 2.5], [0.3, 0.9, -0.5], T)
TOP = vv.rigid.HeavyTop(A=5.0, C=1.0, mass=1.0, g=20.0, R=1.0).solve(T, theta=0.3, psi_dot=50.0, phi_dot=0.2)
BEATS = vv.systems.coupled_oscillators(position=[1.0, 0.0]).run(t=np.linspace(0.0, 80.0, 801))
PLANETS = vv.problems.outer_solar_system().scene.run(t=np.linspace(0.0, 6e4, 401), method="leapfrog", dt=50.0)
HELIX = vv.Scene(
    vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, -1.0, 0.5]]), vv.UniformMagneticField([0.0, 0.0, 1.0], charge=[1.0])
).run(t=np.linspace(0.0, 400.0, 1201))

SWING = vv.systems.pendulum(position=[1.0])
ROSETTE = (
    vv.Scene(vv.Particles([1.0], [[1.0, 0, 0]], [[0, 0.5, 0]]), vv.CentralField(vv.potentials.Plummer(-1.0, 0.5)))
    .run(t=100.0, events=[vv.events.plane([0, 0, 0], [1, 0, 0]), vv.events.plane([0, 0, 0], [0, 1, 0], direction=1)])
    .events
)


def ellipse(size: float) -> vv.Trajectory:
    """A flat one, of such a size."""
    bodies = vv.Particles([1.0], [[0.1 * size, 0.0, 0.0]], [[0.0, size, 0.0]])
    return vv.Scene(bodies, vv.Harmonic(k=4.0)).run(t=np.linspace(0.0, 10.0, 201))


Picture = Callable[[Any], Any]
FLAT: dict[str, Picture] = {
    "coordinates": lambda ax: BEATS.plot(ax=ax),
    "orbits": lambda ax: PLANETS.plot(ax=ax),
    "angular velocity": lambda ax: FREE.plot("components", ax=ax),
    "effective potential": lambda ax: TOP.plot("effective_potential", ax=ax),
    "potential of a system": lambda ax: SWING.plot_effective_potential((-7.0, 7.0), ax=ax),
    "paths in phase space": lambda ax: PLANETS.plot_phase(ax=ax),
    "section": lambda ax: ROSETTE.plot(ax=ax),
    "tally": lambda ax: vv.scattering.monte_carlo(
        vv.potentials.Coulomb(1.0), beam_energy=1.0, masses=(1.0, 4.0), b_max=3.0, n_events=2000, seed=1, bins=20
    )["cm_angle"].plot(ax=ax),
}
SOLID: dict[str, Picture] = {
    "polhode": lambda ax: FREE.plot("polhode", ax=ax),
    "whole polhode": lambda ax: vv.rigid.polhode([1.0, 2.0, 2.5], [0.3, 0.9, -0.5]).plot(ax=ax),
    "axes": lambda ax: FREE.plot("axes", ax=ax),
    "nutation": lambda ax: TOP.plot("nutation", ax=ax),
    "orbits": lambda ax: PLANETS.plot(plane="xyz", ax=ax),
    "small orbits": lambda ax: ellipse(0.1).plot(plane="xyz", ax=ax),
}


def figure_of(drawn: Any) -> Any:
    return drawn if isinstance(drawn, Figure) else drawn.figure


def subplot(**kind: Any) -> Any:
    """Axes of three inches in a figure that the caller has made, with what matplotlib does by itself."""
    return Figure(figsize=(6.0, 3.0)).add_subplot(1, 2, 1, **kind)


def test_the_style_is_the_one_of_the_pictures_and_is_not_forced_on_anybody() -> None:
    import matplotlib.pyplot as plt

    before = dict(plt.rcParams)
    with plt.style.context(vv.plot_style()):
        figure, own = plt.subplots()
    assert dict(plt.rcParams) == before
    theirs = BEATS.plot()
    for at in range(9):
        mine, house = own.plot([0.0, 1.0])[0], theirs.plot([0.0, 1.0])[0]
        if at:
            # Two lines were drawn in theirs before.
            assert mine.get_color() == vv.plot_style()["axes.prop_cycle"].by_key()["color"][at]
        assert house.get_color() in vv.plot_style()["axes.prop_cycle"].by_key()["color"]
    looks = {(line.get_color(), line.get_linestyle()) for line in own.lines}
    assert len(looks) == 9
    for axes in (own, theirs):
        assert not axes.spines["top"].get_visible()
        assert not axes.spines["right"].get_visible()
    plt.close(figure)


def test_its_colors_are_told_apart_by_whoever_sees_two_of_three() -> None:
    """Without the red or the green cones (Machado, Oliveira & Fernandes 2009, severity 1): 0.1 of RGB at least."""
    from matplotlib.colors import to_rgb

    colors = np.array([to_rgb(color) for color in dict.fromkeys(vv.plot_style()["axes.prop_cycle"].by_key()["color"])])
    seen = {
        "all": np.eye(3),
        "no red": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        "no green": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    }
    assert len(colors) == 7
    for matrix in seen.values():
        for one, other in combinations(colors @ np.asarray(matrix).T, 2):
            assert np.linalg.norm(one - other) > 0.1


@pytest.mark.parametrize("name", FLAT)
def test_no_legend_lies_on_what_is_drawn(name: str) -> None:
    for given in (None, subplot()):
        drawn = FLAT[name](given)
        axes = drawn.axes[0] if isinstance(drawn, Figure) else drawn
        figure = figure_of(drawn)
        figure.savefig(BytesIO())  # which lays it out
        box = axes.get_legend().get_window_extent()
        for line in axes.lines:
            assert not line.get_path().transformed(line.get_transform()).intersects_bbox(box, filled=False), line
        for area in axes.collections:
            for path in area.get_paths():
                assert not path.transformed(area.get_transform()).intersects_bbox(box, filled=False)


def test_a_legend_that_has_no_room_is_left_to_the_caller() -> None:
    places = np.random.default_rng(1).normal(size=(24, 3))
    names = [f"a star of the name {at}" for at in range(24)]
    scene = vv.Scene(vv.Particles(np.ones(24), places, names=names))
    axes = subplot()
    scene.run(t=np.linspace(0.0, 1.0, 20)).plot(ax=axes)
    assert axes.get_legend() is None
    assert [line.get_label() for line in axes.lines[::2]] == names


def test_what_is_drawn_after_a_legend_has_made_room_is_seen() -> None:
    axes = subplot()
    BEATS.plot(ax=axes)
    raised = axes.get_ylim()[1]
    axes.plot([0.0, 80.0], [0.0, 50.0])
    assert axes.get_ylim()[1] > 50.0 > raised > 1.0


FOIL = vv.scattering.Foil("carbon", 0.02).run("alpha", beam_energy=3e3, n_events=500, seed=1)
ATOM = vv.potentials.LennardJones(epsilon=1.0, sigma=1.0)
ALONG: dict[str, Picture] = {
    "cross section": lambda ax: vv.scattering.deflect(
        ATOM, energy=2.0, impact_parameter=np.linspace(0.0, 3.0, 50)
    ).plot("cross_section", ax=ax),
    "elements": lambda ax: PLANETS.elements("Saturn", about="Sun").plot("eccentricity", ax=ax),
    "depth": lambda ax: FOIL["stopped_depth"].plot(ax=ax),
}


@pytest.mark.parametrize("name", ALONG)
def test_numbers_along_x_do_not_lie_on_each_other(name: str) -> None:
    axes = Figure(figsize=(3.0, 3.0), layout="constrained").add_subplot()
    figure = figure_of(ALONG[name](axes))
    figure.savefig(BytesIO())
    low, high = axes.get_xlim()
    shown = [tick.label1 for tick in axes.xaxis.get_major_ticks() if low <= tick.get_loc() <= high]
    boxes = [label.get_window_extent() for label in shown]
    assert len(boxes) >= 3
    for one, next_one in pairwise(boxes):
        assert one.x1 < next_one.x0


@pytest.mark.parametrize("name", SOLID)
@pytest.mark.parametrize("own", [False, True])
def test_numbers_along_three_axes_do_not_lie_on_each_other(name: str, own: bool) -> None:
    axes = subplot(projection="3d") if own else None
    figure = figure_of(SOLID[name](axes))
    figure.savefig(BytesIO())
    axes = figure.axes[0]
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        low, high = sorted(axis.get_view_interval())
        shown = [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        boxes = [label.get_window_extent() for label in shown if label.get_text()]
        for one, next_one in pairwise(boxes):
            # Of the boxes of slanted rows corners may touch.
            both = one.intersection(one, next_one)
            assert both is None or both.width * both.height < 0.15 * one.width * one.height, axis.axis_name
        name_of = axis.label.get_window_extent()
        assert figure.bbox.x0 <= name_of.x0
        assert name_of.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= name_of.y0
        # Long names are slanted: their middle is on no number.
        middle = (0.5 * (name_of.x0 + name_of.x1), 0.5 * (name_of.y0 + name_of.y1))
        assert not any(box.padded(2).contains(*middle) for box in boxes), axis.axis_name


def test_numbers_of_the_third_axis_lie_between_its_line_and_its_name() -> None:
    wide = vv.rigid.free_rotation([1e-9, 2e-9, 2.5e-9], [0.3, 0.9, -0.5], T)
    for figure in (HELIX.plot(plane="xyz"), ellipse(0.1).plot(plane="xyz"), wide.plot("polhode")):
        figure.savefig(BytesIO())
        axis = figure.axes[0].zaxis
        name, line = axis.label.get_window_extent(), axis.line.get_window_extent()
        low, high = sorted(axis.get_view_interval())
        shown = [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        for box in [label.get_window_extent() for label in shown]:
            # The first stroke of a minus sign may not be lost on the line.
            assert line.x0 < box.x0
            assert not name.overlaps(box)
        # Within the figure, and not on what is beside it.
        beside = figure.axes[1].get_tightbbox().x0 if len(figure.axes) > 1 else figure.bbox.x1
        assert name.x1 < beside


@pytest.mark.parametrize("size", [10.0**power for power in range(-12, 13, 3)] + [0.1, 0.3])
def test_the_size_of_what_moves_is_no_matter(size: float) -> None:
    """Of three dimensions: as many numbers, and as much of the box."""
    for axes in (
        ellipse(size).plot(plane="xyz").axes[0],
        ellipse(size).animate(plane="xyz")._fig.axes[0],  # type: ignore[attr-defined]
    ):
        for letter in "xyz":
            assert 2 <= len(getattr(axes, f"get_{letter}ticks")()) <= 7
        low, high = axes.get_ylim()
        assert 1.0 * size < high - low < 1.2 * size


@pytest.mark.parametrize("inertia", [1e-12, 1.0, 1e12])
def test_of_bodies_that_turn_the_moments_are_no_matter(inertia: float) -> None:
    turning = vv.rigid.free_rotation(inertia * np.array([1.0, 2.0, 2.5]), [0.3, 0.9, -0.5], T)
    axes = turning.plot("polhode").axes[0]
    for letter in "xyz":
        assert 2 <= len(getattr(axes, f"get_{letter}ticks")()) <= 7


def test_a_second_run_in_the_same_box_is_shown_too() -> None:
    axes = subplot(projection="3d")
    ellipse(1.0).plot(plane="xyz", ax=axes)
    ellipse(3.0).plot(plane="xyz", ax=axes)
    low, high = axes.get_ylim()
    assert high - low > 3.0


def test_pictures_are_asked_for_in_one_way() -> None:
    """What has one panel takes axes by `ax`, None for a new figure; what has several makes their figure."""
    import inspect

    rooms = [vv, *(getattr(vv, name) for name in vv.__all__ if inspect.ismodule(getattr(vv, name)))]
    public = {getattr(room, name) for room in rooms for name in room.__all__}
    drawn = {each for each in public if inspect.isclass(each) and hasattr(each, "plot")}
    several = {vv.scattering.MonteCarlo, vv.scattering.FoilResult}
    assert several <= drawn
    for each in drawn - several:
        asked = inspect.signature(each.plot).parameters["ax"]
        assert asked.kind is asked.KEYWORD_ONLY, each
        assert asked.default is None, each
    # What is shown in courses and compared with measurements.
    expected = {
        *(vv.Trajectory, vv.EnsembleTrajectory, vv.BodyTurning, vv.WorkPrecision, vv.OdeResult, vv.orbits.Elements),
        *(vv.orbits.CentralOrbit, vv.rigid.FreeRotation, vv.rigid.TopMotion, vv.scattering.Deflection),
        *(vv.scattering.Tally, vv.scattering.JointTally, vv.scattering.FoilTally, vv.datasets.RutherfordComparison),
        *(vv.datasets.ToutatisComparison, vv.generalized.PoincareSection, vv.generalized.Linearization),
        *(vv.generalized.GeneralizedTrajectory, vv.generalized.GeneralizedEnsembleTrajectory),
    }
    assert expected <= drawn


def test_work_precision_takes_axes_as_all_pictures_do() -> None:
    points = tuple(vv.Point(name, 0.1 / k, 1e-3 * k, 1e-3 / k**4, 1e-3) for name in ("rk4", "heun") for k in (1, 2, 4))
    found = vv.WorkPrecision("test", points)
    axes = subplot()
    assert found.plot(ax=axes) is axes
    assert [line.get_label() for line in axes.lines] == ["best of all", "rk4", "heun"]
    with pytest.raises(vv.UnknownKeyword):
        found.plot(axes=axes)  # type: ignore[call-arg]
    for wrong in (Figure().subplots(1, 2), [axes, axes], 3):
        with pytest.raises(vv.InvalidInput, match=r"^ax: expected axes of matplotlib"):
            found.plot(ax=wrong)  # type: ignore[arg-type]


def test_an_orbit_that_is_not_bound_is_drawn_where_it_turns() -> None:
    orbit = vv.orbits.central_orbit(
        vv.potentials.Coulomb(1.0), position=[1.0, 0.0, 0.0], velocity=[0.1, 1.1, 0.0]
    )  # fmt: skip
    line = orbit.plot().axes[0].lines[0]
    distance = np.hypot(np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float))
    drawn = distance[np.isfinite(distance)]
    assert 6.0 < drawn.max() <= 8.0
    assert len(drawn) > 200
    # A point of the drawn line is within half its spacing of the turn, where r is flat; measured 2.8e-7.
    assert drawn.min() == pytest.approx(orbit.turning_points[0], rel=1e-6, abs=0)
