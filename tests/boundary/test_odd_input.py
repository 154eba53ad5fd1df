"""Input that is odd but has a meaning: no bodies, no span of time, steps longer than it, scales of every size."""

import contextlib
import errno
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv
from visviva import _core

NOBODY = vv.Particles(mass=[], position=np.empty((0, 3)), velocity=np.empty((0, 3)))
EMPTY = [vv.Scene(NOBODY), vv.Scene(NOBODY, vv.Gravity(1.0)), vv.Scene(NOBODY, vv.UniformField([0, 0, -1]))]
HOW = [{}, {"method": "dop853"}, {"method": "leapfrog", "dt": 0.1}]
FIGURE_EIGHT = vv.problems.figure_eight().scene
COLUMNS = ("position", "velocity", "energy", "momentum", "angular_momentum", "center_of_mass")


@pytest.mark.parametrize("scene", EMPTY, ids=repr)
@pytest.mark.parametrize("how", HOW, ids=str)
def test_no_bodies_move_nowhere(scene: vv.Scene, how: dict[str, Any], tmp_path: Path) -> None:
    out = scene.run([0.0, 1.0, 2.0], record=COLUMNS, **how)
    assert out.position.shape == out.velocity.shape == (3, 0, 3)
    assert not out.energy.any()
    assert not out.momentum.any()
    assert out.final.t0 == 2.0
    assert out.final.particles == NOBODY
    assert scene.acceleration().shape == (0, 3)
    assert scene.plan(1.0, **how).particles == 0
    out.save(tmp_path / "empty.npz")
    for again in (vv.load(tmp_path / "empty.npz"), pickle.loads(pickle.dumps(out))):
        assert again.position.shape == (3, 0, 3)
    copies = scene.ensemble(position=np.empty((2, 0, 3))).run(1.0, **how)
    assert copies.position.shape == (2, 2, 0, 3)
    assert copies[1].final.particles == NOBODY


@pytest.mark.parametrize("scene", EMPTY, ids=repr)
def test_what_needs_a_body_says_so(scene: vv.Scene) -> None:
    for refused, argument in (
        (scene.run(1.0).conservation, "mass"),
        (scene.invariants, "mass"),
        (scene.center_of_mass_frame, "mass"),
        (scene.run(1.0).plot, "plot"),
        (lambda: scene.ensemble(position=np.empty((0, 0, 3))), "position"),
    ):
        with pytest.raises(vv.InvalidInput) as caught:
            refused()
        assert caught.value.argument == argument


@pytest.mark.parametrize("shape", [(0, 0), (0, 2)])
def test_the_core_itself_refuses_no_copies(shape: tuple[int, int]) -> None:
    request: dict[str, Any] = EMPTY[1]._keywords | {"mass": np.zeros(shape)}
    request |= {name: np.zeros((*shape, 3)) for name in ("position", "velocity")}
    request |= {
        "times": np.ones(1),
        "end_only": True,
        "method": "auto",
        "rtol": 1e-9,
        "rtol_given": True,
        "record": list(COLUMNS),
        "events": [],
    }
    request |= dict.fromkeys(
        ("dt", "time_transformation", "atol", "max_step", "max_steps", "collisions", "restitution")
    )
    for call in (_core.plan, lambda asked: _core.run(asked, threads=None, progress=None, ensemble=True)):
        with pytest.raises(vv.InvalidInput, match="mass: expected at least one copy"):
            call(request)


def test_a_run_that_recorded_no_row_is_not_plotted() -> None:
    pair = vv.Scene(vv.Particles([1, 1], [[0, 0, 0], [1e-3, 0, 0]]), vv.Gravity(1.0))
    with pytest.raises(vv.CloseEncounter) as caught:
        pair.run([5.0, 6.0], method="dop853")
    with pytest.raises(
        vv.InvalidInput, match="plot: expected a trajectory with bodies and times, got 2 bodies and 0 t"
    ):
        caught.value.trajectory.plot()


def test_the_sign_of_a_step_agrees_with_the_direction_or_is_plus() -> None:
    there = [FIGURE_EIGHT.run(-1.0, method="leapfrog", dt=dt).position for dt in (0.1, -0.1)]
    assert np.array_equal(*there)
    # Where time does not pass, no sign is against it.
    for dt in (0.1, -0.1):
        out = FIGURE_EIGHT.run([0.0, 0.0], method="leapfrog", dt=dt)
        assert (out.position == FIGURE_EIGHT.particles.position).all()
        assert out.stats.steps == 0


@pytest.mark.parametrize("how", HOW, ids=str)
@pytest.mark.parametrize(
    "t",
    [[0.0, 0.0], [1, 1, 1], (0, 1), range(2), np.arange(2, dtype=np.uint8), [1.0, np.nextafter(1.0, 2.0)], [5e-324]],
    ids=repr,
)
def test_times_of_every_kind(t: Any, how: dict[str, Any]) -> None:
    # All of a run that is shorter than its step is part of one step, and that is said.
    short = 0.0 < t[-1] < how.get("dt", 0.0)
    with pytest.warns(vv.AccuracyWarning, match="longer than the run") if short else contextlib.nullcontext():
        out = FIGURE_EIGHT.run(t, **how)
    assert (out.t == np.asarray(t)).all()
    assert np.isfinite(out.position).all()
    assert all((out.position[i] == out.position[0]).all() for i in range(len(t)) if t[i] == t[0])


@pytest.mark.parametrize("end", [1, np.float32(1), np.float16(1), np.int8(1), np.array(1), np.array(1.0)], ids=repr)
def test_an_end_time_of_every_kind(end: Any) -> None:
    assert (FIGURE_EIGHT.run(end).position == FIGURE_EIGHT.run(1.0).position).all()


def test_columns_named_twice_are_recorded_once() -> None:
    assert FIGURE_EIGHT.run(1.0, record=["energy", "energy"]).recorded == ("energy",)
    assert FIGURE_EIGHT.run(1.0, record=()).recorded == ()


def test_tallies_of_any_iterable() -> None:
    beam: dict[str, Any] = {"beam_energy": 1.0, "masses": (1.0, 4.0), "b_max": 1.0, "n_events": 10, "seed": 1}
    names = ["lab_angle", "energy"]
    for tally in (names, tuple(names), iter(names), {"lab_angle": 1, "energy": 2}.keys(), (n for n in names)):
        assert set(vv.scattering.monte_carlo(vv.potentials.Coulomb(1.0), tally=tally, **beam)) == set(names)


def test_a_folder_is_no_file_to_save_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = FIGURE_EIGHT.run(1.0)
    monkeypatch.chdir(tmp_path)
    for path in (tmp_path, ""):
        with pytest.raises(IsADirectoryError, match="expected a file") as caught:
            out.save(path)
        assert caught.value.errno == errno.EISDIR
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("scale", [2.0**-332, 2.0**332])
def test_the_conservation_table_is_the_same_in_units_of_any_size(scale: float) -> None:
    how: dict[str, Any] = {"t": np.linspace(0.0, 2.0, 5), "method": "leapfrog", "dt": 0.01}
    here = FIGURE_EIGHT.run(**how).conservation()
    there = FIGURE_EIGHT.rescaled(length=scale).run(**how).conservation()
    for row, other in zip(here.rows, there.rows, strict=True):
        assert (row.max, row.end, row.rms) == (other.max, other.end, other.rms)
    assert here.angular_momentum.max > 0.0


def test_extreme_units_that_make_a_moderate_constant() -> None:
    for scale in (1e-150, 1e150):
        assert FIGURE_EIGHT.rescaled(length=scale, mass=scale, time=scale).forces == (vv.Gravity(1.0),)
