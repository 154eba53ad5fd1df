"""A part of an ensemble, or of its run, is that of these copies: it has the bits of each, whatever is asked of it."""

import dataclasses
import functools
import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from chosen_copies import (
    choices,
    nothing_can_be_written,
    refuses_what_is_no_choice,
    same_exports,
    same_rows,
    same_tables,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import visviva as vv

COPIES = 7
TIMES = np.linspace(0.0, 3.0, 7)
EVENTS = [vv.events.plane([0, 0, 0], [0, 1, 0], body=1), vv.events.distance(0, 1, below=0.3, terminal=2)]
TURNING = ("position", "velocity", "orientation", "angular_velocity")
COLUMNS = ("position", "velocity", "energy", "momentum", "angular_momentum", "center_of_mass", "virial")


def disks() -> vv.EnsembleScene:
    """A star and three planetesimals with radii, masses, pulls and drags of their own, of which one falls from rest."""
    rng = np.random.default_rng(7)
    position = np.array([[0, 0, 0], [1.0, 0, 0], [1.3, 0.4, 0], [-1.0, 0.2, 0]])
    velocity = np.array([[0, 0, 0], [0, 1.0, 0], [-0.9, 0.2, 0], [0, -1.0, 0]])
    bodies = vv.Particles(
        [1.0, 1e-3, 2e-3, 1e-3], position, velocity, radius=[0.15, 0.09, 0.12, 0.09], names=list("abcd")
    )
    scene = vv.Scene(bodies, vv.Gravity(1.0), vv.LinearDrag(tau=30.0))
    starts = velocity + 0.4 * rng.normal(size=(COPIES, 4, 3)) * (np.arange(4) > 0)[:, None]
    starts[4] = 0.0
    return scene.ensemble(
        velocity=starts,
        mass=np.tile(bodies.mass, (COPIES, 1)) * rng.uniform(0.5, 2.0, (COPIES, 4)),
        radius=np.tile(bodies.radius, (COPIES, 1)) * rng.uniform(0.5, 1.5, (COPIES, 4)),
        parameters={"Gravity": {"G": rng.uniform(0.8, 1.2, COPIES)}, "LinearDrag": {"tau": [30.0, 40.0] * 3 + [30.0]}},
    )


def turning() -> vv.EnsembleScene:
    """Two rigid bodies on a spring, with moments, spins and strengths of their own, beside a point."""
    rng = np.random.default_rng(3)
    pair = vv.RigidBodies(
        [1.0, 2.0],
        [[1.0, 2.0, 2.5], [1.0, 1.0, 1.5]],
        position=[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
        angular_velocity=[[0.1, 2.0, 0.0], [0.3, 0.5, 0.0]],
    )
    spring = vv.AttachedSpring(0, [0.0, 0.0, 0.0], stiffness=2.0, anchor=[0.0, 0.0, 1.0])
    scene = vv.Scene(vv.Particles([0.5], [[0.0, 3.0, 0.0]]), pair, vv.Gravity(0.3), spring)
    second, turned = rng.uniform(0.02, 0.3, (COPIES, 2, 3)), rng.normal(size=(COPIES, 2, 4))
    return scene.ensemble(
        moments=second.sum(axis=-1, keepdims=True) - second,
        orientation=turned / np.linalg.norm(turned, axis=-1, keepdims=True),
        angular_velocity=rng.normal(size=(COPIES, 2, 3)),
        parameters={spring: {"stiffness": rng.uniform(1.0, 3.0, COPIES)}},
    )


MADE = {"disks": disks, "turning": turning}
HOW: dict[str, tuple[str, dict[str, Any]]] = {
    "that merge": ("disks", {"method": "dop853", "collisions": "merge", "events": EVENTS[:1], "record": COLUMNS[:3]}),
    "that bounce": ("disks", {"method": "rk4", "dt": 0.01, "collisions": "bounce", "record": COLUMNS}),
    "that stop": ("disks", {"method": "taylor", "collisions": "stop", "events": EVENTS}),
    "that fail": ("disks", {"method": "dop853", "events": EVENTS, "max_steps": 60}),
    "that turn": ("turning", {"record": (*TURNING, "energy")}),
    "that turn in steps": ("turning", {"method": "kahan_li8", "dt": 0.01}),
    "that turn by another method": (
        "turning",
        {"method": "rk4", "dt": 0.05, "record": TURNING},
    ),
}


@functools.cache
def copies_of(kind: str) -> vv.EnsembleScene:
    return MADE[kind]()


@functools.cache
def run_of(name: str) -> vv.EnsembleTrajectory:
    kind, how = HOW[name]
    return copies_of(kind).run(t=TIMES, **how)


def is_told(run: Any, name: str) -> bool:
    try:
        getattr(run, name)
    except vv.InvalidInput:
        return False
    return True


def is_part(part: vv.EnsembleTrajectory, alone: list[vv.Trajectory]) -> None:
    """Whatever a run of copies tells is what these tell alone."""
    told = 0
    assert len(part) == len(alone)
    names = [name for name in dir(type(part)) if not name.startswith("_") and not callable(getattr(type(part), name))]
    for name in set(names) - {"t", "ensemble", "status", "stats", "plan", "per_trajectory", "final", "recorded"}:
        known = is_told(part, name)
        assert {is_told(own, name) for own in alone} == {known}, name
        if known and name == "events":
            same_tables(part.events, [own.events for own in alone], ("which", "t", "position", "velocity"))
        elif known and name == "collisions":
            columns = ("t", "first", "second", "survivor", "position")
            same_tables(part.collisions, [own.collisions for own in alone], columns)
        elif known:
            same_rows(getattr(part, name), [getattr(own, name) for own in alone])
            nothing_can_be_written(getattr(part, name))
            told += 1
    assert told >= 5
    nothing_can_be_written(part.status, part.t, *part.per_trajectory.values())
    assert part.status.tolist() == [int(own.status) for own in alone]
    assert part.recorded == alone[0].recorded
    assert part.stats.method == alone[0].stats.method
    for name, each in part.per_trajectory.items():
        assert each.tolist() == [getattr(own.stats, name) for own in alone]
        assert getattr(part.stats, name) == each.sum()
    assert list(part.ensemble) == [own.scene for own in alone]
    if any(part.status):
        with pytest.raises(vv.InvalidInput, match="failed, were stopped or interrupted"):
            _ = part.final
    else:
        assert list(part.final) == [own.final for own in alone]
    kept = part.conservation()
    for own, each in zip(kept, alone, strict=True):
        if len(each.t) and np.isfinite(each.position[0]).all():
            np.testing.assert_equal(dataclasses.asdict(own), dataclasses.asdict(each.conservation()))


@pytest.mark.parametrize("name", sorted(HOW))
@given(data=st.data())
@settings(max_examples=10, suppress_health_check=[HealthCheck.too_slow])
def test_a_part_of_a_run_is_the_run_of_these_copies(name: str, data: st.DataObject) -> None:
    whole = run_of(name)
    index, numbers = data.draw(choices(COPIES))
    part = whole[index]
    assert isinstance(part, vv.EnsembleTrajectory)
    is_part(part, [whole[copy] for copy in numbers])
    same_exports(part, whole, numbers)
    # A part of a part, and what pickles, are the same again.
    is_part(part[::-1], [whole[copy] for copy in reversed(numbers)])
    is_part(pickle.loads(pickle.dumps(part)), [whole[copy] for copy in numbers])


def test_there_is_of_everything_that_is_asked_for() -> None:
    """The runs above have contacts, events, failures and terminal events, in some copies and not in others."""
    status = {name: set(run_of(name).status.tolist()) for name in HOW}
    assert status["that fail"] == {int(vv.Status.OK), int(vv.Status.TOO_MANY_STEPS)}
    assert status["that stop"] == {int(vv.Status.OK), int(vv.Status.STOPPED)}
    for name in ("that merge", "that bounce", "that stop"):
        assert 1 < len(set(run_of(name).collisions.member.tolist())) < COPIES
    assert len(set(run_of("that merge").events.member.tolist())) > 1


@pytest.mark.parametrize("kind", sorted(MADE))
@given(data=st.data())
@settings(max_examples=12)
def test_a_part_of_an_ensemble_is_the_ensemble_of_these_copies(kind: str, data: st.DataObject) -> None:
    whole = copies_of(kind)
    index, numbers = data.draw(choices(COPIES))
    part = whole[index]
    assert isinstance(part, vv.EnsembleScene)
    for same in (part, pickle.loads(pickle.dumps(part)), part[::-1][::-1]):
        assert list(same) == [whole[copy] for copy in numbers]
        assert same.forces == tuple(whole.forces[copy] for copy in numbers)
        assert same.body_forces == tuple(whole.body_forces[copy] for copy in numbers)
        for name in ("mass", "radius", "position", "velocity"):
            np.testing.assert_array_equal(getattr(same, name), getattr(whole, name)[numbers])
            nothing_can_be_written(getattr(same, name))
            assert not np.shares_memory(getattr(same, name), getattr(whole, name))


@pytest.mark.parametrize(
    ("name", "index"), [("that turn in steps", [3, 0, 3]), ("that merge", [4, 6, 0]), ("that fail", None)]
)
def test_a_part_runs_is_kept_and_goes_on(name: str, index: list[int] | None, tmp_path: Path) -> None:
    whole, how = run_of(name), HOW[name][1]
    well = whole.status == vv.Status.OK
    part, alone = whole[well if index is None else index], [whole[copy] for copy in index or np.flatnonzero(well)]
    assert len(part) > 1
    is_part(part.ensemble.run(t=TIMES, **how), alone)
    part.save(tmp_path / "part.npz")
    loaded = vv.load(tmp_path / "part.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    is_part(loaded, alone)
    ends = [part.final, loaded.final, *([] if whole.status.any() else [whole.final[index or well]])]
    for end in ends:
        is_part(end.run(t=[4.0, 5.0], **how), [own.final.run(t=[4.0, 5.0], **how) for own in alone])


def test_tables_and_pictures_of_a_part_are_of_these_copies(tmp_path: Path) -> None:
    read = pytest.importorskip("pandas").read_parquet
    whole = run_of("that bounce")
    numbers = [5, 1, 0]
    part = whole[numbers]
    part.to_parquet(tmp_path / "part.parquet")
    whole.to_parquet(tmp_path / "whole.parquet")
    rows, there = read(tmp_path / "part.parquet"), read(tmp_path / "whole.parquet").groupby("copy")
    for copy, own in rows.groupby("copy"):
        expected = there.get_group(numbers[copy]).drop(columns="copy").reset_index(drop=True)
        assert own.drop(columns="copy").reset_index(drop=True).equals(expected)
    lines = part.plot("velocity", body="b", component="y").axes[0].lines
    for line, copy in zip(lines, numbers, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), whole.velocity[copy, :, 1, 1])
    np.testing.assert_array_equal(part["c"].position, whole["c"].position[numbers])
    kept, some = part.conservation(), whole.conservation()[numbers]
    assert str(kept) == str(some)
    nothing_can_be_written(some.status, kept.status, some.energy.max)
    assert whole.conservation()[np.arange(COPIES) == 5].energy.max[0] == kept[0].energy.max
    ellipse = whole.elements("b", about="a").semi_major_axis
    np.testing.assert_array_equal(part.elements("b", about="a").semi_major_axis, ellipse[numbers])


def test_parts_of_what_was_interrupted_tell_who_was() -> None:
    scene = vv.problems.kepler(e=0.5).scene
    velocity = scene.particles.velocity * np.linspace(0.9, 1.0, 200)[:, None, None]

    def stop_on_the_way(done: float, total: float) -> None:
        if done >= 0.3 * total:
            raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted) as stopped:
        scene.ensemble(velocity=velocity).run(
            t=np.linspace(0.0, 1000.0, 5), method="dop853", threads=1, progress=stop_on_the_way
        )
    whole: Any = stopped.value.trajectory
    late = whole.status == vv.Status.INTERRUPTED
    assert late.any()
    assert not late.all()
    assert len(whole[~late].final) == (~late).sum()
    mixed = [int(np.flatnonzero(late)[-1]), int(np.flatnonzero(~late)[0]), int(np.flatnonzero(late)[0])]
    is_part(whole[mixed], [whole[copy] for copy in mixed])
    assert "of which 2 were interrupted" in str(whole[mixed].conservation())


def test_other_indices_are_refused_by_name() -> None:
    scene = vv.problems.kepler(e=0.5).scene
    copies = scene.ensemble(velocity=scene.particles.velocity * np.linspace(0.9, 1.0, 4)[:, None, None])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        refuses_what_is_no_choice(copies)
        run = copies.run(t=1.0)
        refuses_what_is_no_choice(run, names=True)
        refuses_what_is_no_choice(run.conservation(), names=True)
