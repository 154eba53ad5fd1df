"""Pictures of ensembles: what is drawn is what the copies have, and of copies that ended nothing."""

from typing import Any

import numpy as np
import pytest

import visviva as vv

KEPLER = vv.problems.kepler(e=0.5).scene
SLOWER = KEPLER.particles.velocity * np.linspace(0.9, 1.0, 9)[:, None, None]
OUT = KEPLER.ensemble(velocity=SLOWER).run(t=np.linspace(0.0, 10.0, 51))
SWINGS = vv.systems.double_pendulum().ensemble(position=np.linspace([0.1, 0.2], [1.0, 2.0], 100))
SWUNG = SWINGS.run(t=np.linspace(0.0, 5.0, 41))


def lines(axes: Any) -> np.ndarray:
    return np.array([line.get_ydata() for line in axes.lines])


def test_every_copy_is_a_line() -> None:
    figure = OUT.plot("velocity", body=1)
    assert [axes.get_ylabel() for axes in figure.axes] == ["velocity, x", "velocity, y", "velocity, z"]
    for at, axes in enumerate(figure.axes):
        assert (lines(axes) == OUT.velocity[:, :, 1, at]).all()
    one = OUT.plot("angular_momentum", component="z", kind="lines")
    assert (lines(one.axes[0]) == OUT.angular_momentum[..., 2]).all()
    assert (lines(SWUNG.plot("momentum", coordinate="theta2", kind="lines").axes[0]) == SWUNG.momentum[..., 1]).all()


def test_bands_hold_half_and_nine_tenths_of_the_copies() -> None:
    figure = SWUNG.plot()  # of more than sixty copies
    assert [axes.get_ylabel() for axes in figure.axes] == ["theta1", "theta2"]
    for at, axes in enumerate(figure.axes):
        assert (lines(axes)[0] == np.median(SWUNG.position[..., at], axis=0)).all()
        for band, part in zip(axes.collections, (0.9, 0.5), strict=True):
            edge = band.get_paths()[0].vertices  # type: ignore[union-attr]
            for output, t in enumerate(SWUNG.t):
                ends = np.sort(np.asarray(edge)[np.asarray(edge)[:, 0] == t, 1])
                inside = (ends[0] <= SWUNG.position[:, output, at]) & (SWUNG.position[:, output, at] <= ends[-1])
                assert abs(inside.mean() - part) <= 0.011 or np.ptp(ends) == 0.0


def test_energies_are_changes_and_rounding_is_called_so() -> None:
    said = [[text.get_text() for text in run.plot("energy").axes[0].texts] for run in (OUT, _coarse())]
    assert said == [["round-off"], []]
    drawn = lines(_coarse().plot("energy").axes[0])
    assert (drawn[:, 0] == 0.0).all()
    energy = _coarse().energy
    assert (energy[:, 0] < 0.0).all()  # so that a rise is drawn as one
    np.testing.assert_allclose(drawn[:, -1], 1.0 - energy[:, -1] / energy[:, 0], rtol=0, atol=1e-15)
    # Of an energy of 0 no relative change is told.
    rest = vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), vv.Harmonic(1.0)).ensemble(position=np.array([[[0, 0, 0]]]))
    assert rest.run(t=[0.0, 1.0]).plot("energy").axes[0].get_ylabel() == "E − E₀"


def test_noise_is_drawn_as_points_of_however_many_copies() -> None:
    many = KEPLER.ensemble(velocity=KEPLER.particles.velocity * np.linspace(0.8, 1.0, 100)[:, None, None])
    swing = vv.systems.pendulum().ensemble(position=np.linspace(0.1, 2.0, 90)[:, None])
    for run in (many.run(t=np.linspace(0.0, 10.0, 51)), swing.run(t=np.linspace(0.0, 20.0, 51))):
        axes = run.plot("energy").axes[0]
        assert [text.get_text() for text in axes.texts] == ["round-off"]
        assert len(axes.lines) == len(run.energy)
        assert {(line.get_linestyle(), line.get_marker()) for line in axes.lines} == {("None", ".")}
        # No change of any copy is above the band, which is that of its largest terms.
        assert np.abs(lines(axes)).max() < axes.patches[0].get_height() / 2.0  # type: ignore[attr-defined]


def _coarse() -> vv.EnsembleTrajectory:
    return KEPLER.ensemble(velocity=SLOWER).run(t=np.linspace(0.0, 10.0, 51), method="leapfrog", dt=0.02)


def test_copies_that_ended_are_counted_and_not_in_bands() -> None:
    drop = vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), vv.UniformField([0, 0, -1.0]))
    heights = np.zeros((10, 1, 3))
    heights[:, 0, 2] = np.arange(1, 11)
    ground = vv.events.plane([0, 0, 0], [0, 0, 1], direction=-1, terminal=True)
    out = drop.ensemble(position=heights).run(t=np.linspace(0.0, 3.0, 31), events=[ground])
    figure = out.plot(component="z", kind="bands")
    fallen = int((heights[:, 0, 2] < 4.5).sum())
    assert figure.axes[0].get_title("left") == f"10 copies, of which {fallen} ended before"
    last = out.position[:, -1, 0, 2]
    assert lines(figure.axes[0])[0][-1] == np.nanmedian(last)
    down = drop.ensemble(position=heights[:2]).run(t=np.linspace(0.0, 3.0, 31), events=[ground])
    assert down.plot(component="z", kind="bands").axes[0].lines[0].get_xdata()[-1] < 2.1  # type: ignore[index]


@pytest.mark.parametrize(
    ("wrong", "argument"),
    [
        ({"column": "positions"}, "column"),
        ({"column": 3}, "column"),
        ({"column": "position"}, "body"),
        ({"column": "position", "body": 2}, "body"),
        ({"column": "energy", "body": 1}, "body"),
        ({"column": "energy", "component": "x"}, "component"),
        ({"column": "momentum", "component": "w"}, "component"),
        ({"column": "energy", "kind": "band"}, "kind"),
        ({"column": "orientation", "body": 0}, "column"),
    ],
)
def test_what_is_no_picture_is_refused_by_name(wrong: dict[str, Any], argument: str) -> None:
    with pytest.raises(vv.InvalidInput, match=rf"^{argument}: "):
        OUT.plot(**wrong)


def test_axes_of_ones_own_take_one_panel() -> None:
    from matplotlib.figure import Figure

    own = Figure().add_subplot()
    assert SWUNG.plot("energy", ax=own) is own.figure
    assert OUT.plot("position", body=0, component="y", ax=own) is own.figure
    with pytest.raises(vv.InvalidInput, match=r"^ax: one pair of axes"):
        OUT.plot("position", body=0, ax=own)
    for wrong, argument in (({"column": "reactions"}, "column"), ({"coordinate": "theta"}, "coordinate")):
        with pytest.raises(vv.InvalidInput, match=f"^{argument}: "):
            SWUNG.plot(**wrong)  # type: ignore[arg-type]
    with pytest.raises(vv.InvalidInput, match=r"^coordinate: "):
        SWUNG.plot("energy", coordinate="theta1")
