"""Pictures of one run against time: what is drawn are its columns, and motions along a line are seen as motions."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

pytest.importorskip("matplotlib")
from matplotlib.figure import Figure

T = np.linspace(0.0, 10.0, 101)
THREE = vv.problems.figure_eight().scene.run(t=T)
PAIR = vv.Particles([1.0, 2.0], [[1.0, 0.0, 0.0], [2.5, 0.0, 0.0]], names=["a", "b"])
LINE = vv.Scene(PAIR, vv.Harmonic(k=2.0)).run(t=T)


def lines(axes: Any) -> np.ndarray:
    """Of each line of the axes its numbers; every one of them against the times."""
    assert all((np.asarray(line.get_xdata()) == T).all() for line in axes.lines)
    return np.array([line.get_ydata() for line in axes.lines], dtype=float)


@pytest.mark.parametrize("column", ["position", "velocity"])
def test_a_panel_for_each_component_and_a_line_for_each_body(column: Any) -> None:
    panels = THREE.plot(column).axes
    assert [axes.get_ylabel() for axes in panels] == [f"{column}, {letter}" for letter in "xyz"]
    for at, axes in enumerate(panels):
        assert (lines(axes) == getattr(THREE, column)[..., at].T).all()


def test_bodies_and_components_are_chosen_and_axes_are_given() -> None:
    own = Figure().add_subplot()
    assert LINE.plot("velocity", bodies=["b"], component="x", ax=own) is own.figure
    assert (lines(own) == LINE.velocity[:, 1, 0]).all()
    assert own.lines[0].get_label() == "b"
    named = LINE.plot("position", component="x").axes[0].get_legend()
    assert [text.get_text() for text in named.get_texts()] == ["a", "b"]


def test_columns_of_the_whole_scene_are_drawn() -> None:
    momentum = THREE.plot("angular_momentum", component="z").axes[0]
    assert momentum.get_ylabel() == "angular momentum, z"
    assert (lines(momentum)[0] == THREE.angular_momentum[:, 2]).all()
    kinetic = THREE.plot("kinetic_energy").axes
    assert len(kinetic) == 1
    assert (lines(kinetic[0])[0] == THREE.kinetic_energy).all()
    # As beside the orbits.
    energy, beside = THREE.plot("energy").axes[0], THREE.plot().axes[1]
    assert energy.get_ylabel() == beside.get_ylabel() == "(E − E₀) / |E₀|"
    assert (np.asarray(energy.lines[0].get_ydata()) == np.asarray(beside.lines[0].get_ydata())).all()


def test_rigid_bodies_have_columns_too() -> None:
    bodies = vv.RigidBodies([1.0], moments=[[1.0, 2.0, 2.5]], angular_velocity=[[0.3, 0.9, -0.5]])
    out = vv.Scene(bodies).run(t=T)
    panels = out.plot("orientation", bodies=0).axes
    assert [axes.get_ylabel()[-1] for axes in panels] == list("xyzw")
    assert (lines(panels[3])[0] == out.orientation[:, 0, 3]).all()


@pytest.mark.parametrize(
    ("how", "argument"),
    [
        ({"column": "positon"}, "column"),
        ({"column": "orientation"}, "column"),
        ({"column": "energy", "component": "x"}, "component"),
        ({"column": "position", "component": "w"}, "component"),
        ({"column": "energy", "bodies": [0]}, "bodies"),
        ({"column": "position", "bodies": []}, "bodies"),
        ({"column": "position", "plane": "xy"}, "plane"),
        ({"component": "x"}, "component"),
        ({"column": "position", "ax": Figure().add_subplot()}, "ax"),
        ({"column": "energy", "ax": 3}, "ax"),
    ],
)
def test_what_is_no_such_picture_is_refused(how: dict[str, Any], argument: str) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^{argument}: "):
        THREE.plot(**how)


def test_a_column_of_one_number_says_that_it_has_no_components() -> None:
    with pytest.raises(vv.InvalidInput, match="energy is one number and has no components, got 'x'"):
        THREE.plot("kinetic_energy", component="x")


@pytest.mark.parametrize("direction", range(3))
@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_a_motion_along_a_line_is_drawn_against_time(direction: int, size: float) -> None:
    """Wherever the line is."""
    place, rate, beside = np.zeros((3, 1, 3))
    place[0, direction], rate[0, direction] = size, 0.3 * size
    beside[0, direction - 1] = 5.0 * size
    out = vv.Scene(vv.Particles([1.0], place + beside, rate), vv.Harmonic(k=4.0, center=beside[0])).run(t=T)
    places, energy = out.plot().axes
    assert places.get_ylabel() == f"position, {'xyz'[direction]}"
    assert (lines(places) == out.position[:, 0, direction]).all()
    assert energy.get_title() == "energy"


def test_where_it_is_asked_for_or_is_no_line_orbits_are_drawn() -> None:
    own = Figure().add_subplot()
    LINE.plot(ax=own)
    few = vv.Scene(PAIR, vv.Harmonic(k=2.0)).run(t=[0.0, 1.0])
    still = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]])).run(t=T)
    aside = vv.Scene(vv.Particles([1.0], [[1.0, 0.0, 0.0]], [[0.0, 1e-9, 0.0]]), vv.Harmonic(k=2.0)).run(t=T)
    for axes in (own, *(figure.axes[0] for figure in (LINE.plot(plane="xy"), few.plot(), still.plot(), aside.plot()))):
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("x", "y")
        assert axes.get_title() == "orbits"


@pytest.mark.parametrize("column", ["momentum", "angular_momentum", "center_of_mass"])
def test_what_stays_but_for_rounding_is_drawn_as_what_stays(column: Any) -> None:
    """Sums of many terms: theirs are the roundings, which would fill panels of their own and look like a signal."""
    scene = vv.datasets.outer_solar_system().scene
    speed = scene.particles.velocity
    out, copies = scene.run(t=400.0 * T), scene.ensemble(velocity=np.stack([speed, speed])).run(t=400.0 * T)
    stays = column != "center_of_mass"
    for run, values in ((out, getattr(out, column)), (copies, getattr(copies, column)[0])):
        for at, axes in enumerate(run.plot(column).axes):
            low, high = axes.get_ylim()
            moved = np.ptp(values[:, at])
            assert (moved < 1e-6 * (high - low)) == stays
            # And the scale has numbers on it.
            assert sum(low <= tick <= high for tick in axes.get_yticks()) >= 3


def test_columns_of_rigid_bodies_alone() -> None:
    out = vv.Scene(vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0])).run(t=T)
    for axes in out.plot("angular_momentum").axes:
        low, high = axes.get_ylim()
        assert high - low >= 0.01 * np.linalg.norm(out.angular_momentum[0])


def test_bodies_that_only_turn_are_seen_to_turn() -> None:
    """Their orbits would be dots in an empty panel."""
    bodies = [
        vv.RigidBody(1.0, [1.0, 2.0, 2.5], angular_velocity=[0.1, 1.0, 0.0], name=name, position=[at, 0.0, 0.0])
        for name, at in (("a", 0.0), ("b", 3.0))
    ]
    out = vv.Scene(*bodies).run(t=T)
    axes = out.plot().axes[0]
    assert axes.get_title() == "angular velocity"
    assert [line.get_label() for line in axes.lines] == [f"{name}, ω{letter}" for name in "ab" for letter in "xyz"]
    assert (lines(axes) == out.angular_velocity.transpose(1, 2, 0).reshape(6, -1)).all()
    assert axes.get_legend() is not None
    # Asked for a plane, or of bodies that move, it is orbits.
    assert out.plot(plane="xy").axes[0].get_title() == "orbits"
    assert THREE.plot().axes[0].get_title() == "orbits"
