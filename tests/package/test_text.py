"""What is printed and drawn is what a reader needs."""

import numpy as np
import pytest

import visviva as vv


def test_nouns_agree_with_their_numbers() -> None:
    one = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]]))
    assert repr(one.particles) == "Particles(1 body)"
    assert repr(one.run(t=[1.0])) == "Trajectory(1 time, 1 body, t = 1 … 1, OK)"
    assert repr(one.run(t=1.0)) == "Trajectory(2 times, 1 body, t = 0 … 1, OK)"
    single = one.ensemble(position=np.zeros((1, 1, 3)))
    assert repr(single).startswith("EnsembleScene(1 copy of Scene(")
    assert repr(single.run(t=1.0)) == "EnsembleTrajectory(1 copy, 2 times, 0 failed)"


def test_a_conservation_table_says_whom_it_does_not_judge() -> None:
    scene = vv.problems.kepler(e=0.5, mass_ratio=0.0).scene
    assert str(scene.run(t=1.0).conservation()).endswith("1 massless body not judged: no share in any row")
    assert "massless" not in str(vv.problems.kepler(e=0.5).scene.run(t=1.0).conservation())


def test_elements_print_as_a_table() -> None:
    lines = str(vv.orbits.elements(1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])).splitlines()
    assert [line.split()[0] for line in lines] == list(vv.orbits.Elements.__slots__)
    assert lines[6].split() == ["eccentricity", "0.44"]
    assert lines[1].split(maxsplit=1)[1] == "[0 0 1.2]"
    stacked = str(vv.orbits.conic([1.0, 2.0], 1.0, [1.0, 0.0, 0.0], [0.0, 1.2, 0.0])).splitlines()
    assert stacked[0].split(maxsplit=1) == ["mass", "[1 2]"]


@pytest.mark.parametrize(
    ("velocity", "plane"),
    [([1, 2, 0], "xy"), ([3, 0, 1], "xz"), ([0, 1, 3], "yz"), ([0, 0, 0], "xy"), ([1, 1, 1], "xy"), ([0, 0, 1], "xz")],
)
def test_a_plot_shows_the_plane_of_the_motion(velocity: list[float], plane: str) -> None:
    pytest.importorskip("matplotlib")
    out = vv.Scene(vv.Particles([1.0], [[0.0, 0.0, 0.0]], [velocity])).run(t=[0.0, 1.0])
    axes = out.plot().axes[0]
    assert axes.get_xlabel() + axes.get_ylabel() == plane
    shown = ["xyz".index(axis) for axis in plane]
    np.testing.assert_array_equal(axes.lines[0].get_xydata(), out.position[:, 0, shown])
