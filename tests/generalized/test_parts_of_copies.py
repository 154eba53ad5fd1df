"""A part of an ensemble in generalized coordinates, or of its run, has the bits of each copy in whatever it tells."""

import functools
import pickle
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
from visviva.generalized import GeneralizedEnsemble, GeneralizedEnsembleTrajectory, GeneralizedTrajectory

COPIES = 7
TIMES = np.linspace(0.0, 3.0, 7)


def double_pendulums() -> GeneralizedEnsemble:
    rng = np.random.default_rng(5)
    names = list(vv.systems.double_pendulum().parameters)[:2]
    return vv.systems.double_pendulum().ensemble(
        position=rng.uniform(-2.0, 2.0, (COPIES, 2)),
        velocity=rng.normal(size=(COPIES, 2)),
        parameters={name: rng.uniform(0.5, 2.0, COPIES) for name in names},
    )


def stars() -> GeneralizedEnsemble:
    """Of a Hamiltonian: momenta in place of velocities."""
    return vv.systems.henon_heiles().ensemble(momentum=np.random.default_rng(6).uniform(0.1, 0.4, (COPIES, 2)))


def beads() -> GeneralizedEnsemble:
    """On circles of radii of their own: with constraints and reactions."""
    bead = vv.Lagrangian(
        lambda q, v, t, a: (v[0] ** 2 + v[1] ** 2) / 2 - q[1],
        ["x", "y"],
        parameters={"a": 1.0},
        constraints=[lambda q, v, t, a: q[0] ** 2 + q[1] ** 2 - a**2],
        position=[1.0, 0.0],
    )
    radii = np.linspace(0.5, 2.0, COPIES)
    return bead.ensemble(position=np.stack([radii, 0.0 * radii], axis=1), parameters={"a": radii})


def falling() -> GeneralizedEnsemble:
    """Towards a center that some reach: the potential −1/(2x²) draws what rests at x there in x², 0.06 to 25 here."""
    fall = vv.Lagrangian(lambda q, v, t: v[0] ** 2 / 2 + 1 / (2 * q[0] ** 2), ["x"], position=[1.0])
    return fall.ensemble(position=np.array([0.5, 4.0, 1.0, 3.0, 1.2, 5.0, 0.25])[:, None])


MADE = {"pendulums": double_pendulums, "stars": stars, "beads": beads, "falling": falling}
HOW: dict[str, tuple[str, dict[str, Any]]] = {
    "finished": ("pendulums", {}),
    "with events": ("pendulums", {"events": [vv.events.coordinate("theta1"), vv.events.coordinate("theta2", 0.3)]}),
    "stopped": ("stars", {"events": [vv.events.coordinate("x", 0.1, terminal=1), "y"]}),
    "in equal steps": ("stars", {"method": "leapfrog", "dt": 0.01}),
    "with reactions": ("beads", {"events": ["x"]}),
    "failed": ("falling", {"events": [vv.events.coordinate("x", 0.3)]}),
}


@functools.cache
def copies_of(kind: str) -> GeneralizedEnsemble:
    return MADE[kind]()


@functools.cache
def run_of(name: str) -> GeneralizedEnsembleTrajectory:
    kind, how = HOW[name]
    return copies_of(kind).run(t=TIMES, **how)


def same_system(found: Any, expected: Any) -> None:
    """Equal in all that a system has, to the bit, with the equations of the same model."""
    assert type(found) is type(expected)
    assert found.parameters == expected.parameters
    assert found.t0 == expected.t0
    second = "momentum" if isinstance(found, vv.Hamiltonian) else "velocity"
    for name in ("position", second):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))


def same_ensemble(found: Any, expected: list[Any]) -> None:
    assert len(found) == len(expected)
    for copy, each in enumerate(expected):
        same_system(found[copy], each)


def is_told(run: Any, name: str) -> bool:
    try:
        getattr(run, name)
    except vv.InvalidInput:
        return False
    return True


def is_part(part: GeneralizedEnsembleTrajectory, alone: list[GeneralizedTrajectory]) -> None:
    """Whatever a run of copies tells is what these tell alone."""
    assert len(part) == len(alone)
    names = ("position", "velocity", "momentum", "energy", "reactions")
    for name in names:
        assert {is_told(own, name) for own in alone} == {is_told(part, name)}
        if is_told(part, name):
            same_rows(getattr(part, name), [getattr(own, name) for own in alone])
            nothing_can_be_written(getattr(part, name))
    coordinates = part.ensemble.system.coordinates
    for coordinate in coordinates:
        same_rows(part[coordinate], [own[coordinate] for own in alone])
    nothing_can_be_written(part.t, part.status, part.steps, part.evaluations)
    for name in ("status", "steps", "evaluations"):
        assert getattr(part, name).tolist() == [getattr(own, name) for own in alone]
    assert part.stats.steps == sum(own.steps for own in alone)
    assert part.stats.evaluations == sum(own.evaluations for own in alone)
    assert part.stats.longest_step == max(own.longest_step for own in alone)
    assert part.stats.method == alone[0].stats.method
    same_ensemble(part.ensemble, [own.system for own in alone])
    if any(part.status):
        with pytest.raises(vv.InvalidInput, match="failed, were stopped or interrupted"):
            _ = part.final
    else:
        same_ensemble(part.final, [own.final for own in alone])
    if is_told(alone[0], "events"):
        columns = ("which", "t", "position", "velocity", "momentum")
        same_tables(part.events, [own.events for own in alone], columns)
        assert part.events.definitions == alone[0].events.definitions
    kept = part.conservation()
    for copy, own in enumerate(alone):
        changes = own.conservation()
        for name, each in kept.items():
            np.testing.assert_array_equal(each[copy], changes.get(name, np.nan))


@pytest.mark.parametrize("name", sorted(HOW))
@given(data=st.data())
@settings(max_examples=10, suppress_health_check=[HealthCheck.too_slow])
def test_a_part_of_a_run_is_the_run_of_these_copies(name: str, data: st.DataObject) -> None:
    whole = run_of(name)
    index, numbers = data.draw(choices(COPIES))
    part = whole[index]
    assert isinstance(part, GeneralizedEnsembleTrajectory)
    is_part(part, [whole[copy] for copy in numbers])
    same_exports(part, whole, numbers)
    is_part(part[::-1], [whole[copy] for copy in reversed(numbers)])
    is_part(pickle.loads(pickle.dumps(part)), [whole[copy] for copy in numbers])


def test_there_is_of_everything_that_is_asked_for() -> None:
    """The runs above end in all ways, some copies in one and some in another, with events here and not there."""
    endings = {name: {each.name for each in map(vv.Status, run_of(name).status)} for name in HOW}
    assert "STOPPED" in endings["stopped"]
    assert "OK" in endings["failed"]
    assert len(endings["failed"]) > 1
    assert all(ended == {"OK"} for name, ended in endings.items() if name not in ("stopped", "failed"))
    for name in ("with events", "failed"):
        assert len(set(run_of(name).events.member.tolist())) > 1
    assert len(set(run_of("failed").events.member.tolist())) < COPIES
    assert np.isnan(run_of("failed").position).any()


@pytest.mark.parametrize("kind", sorted(MADE))
@given(data=st.data())
@settings(max_examples=10)
def test_a_part_of_an_ensemble_is_the_ensemble_of_these_copies(kind: str, data: st.DataObject) -> None:
    whole = copies_of(kind)
    index, numbers = data.draw(choices(COPIES))
    part = whole[index]
    assert isinstance(part, GeneralizedEnsemble)
    assert part.system is whole.system
    for same in (part, pickle.loads(pickle.dumps(part)), part[::-1][::-1]):
        same_ensemble(same, [whole[copy] for copy in numbers])


@pytest.mark.parametrize("name", ["with events", "in equal steps", "failed"])
def test_a_part_runs_is_kept_and_goes_on(name: str, tmp_path: Path) -> None:
    whole, how = run_of(name), HOW[name][1]
    numbers = [5, 0, 3, 0]
    part, alone = whole[numbers], [whole[copy] for copy in numbers]
    is_part(part.ensemble.run(t=TIMES, **how), alone)
    part.save(tmp_path / "part.npz")
    loaded = vv.load(tmp_path / "part.npz")
    assert isinstance(loaded, GeneralizedEnsembleTrajectory)
    is_part(loaded, alone)
    is_part(loaded[[2, 0]], [alone[2], alone[0]])
    well = part.status == vv.Status.OK
    on = [own.final.run(t=[4.0, 5.0], **how) for own, ended in zip(alone, well, strict=True) if ended]
    for end in (part[well].final, loaded[well].final):
        is_part(end.run(t=[4.0, 5.0], **how), on)


def test_pictures_and_files_of_a_part_are_of_these_copies(tmp_path: Path) -> None:
    read = pytest.importorskip("pandas").read_parquet
    whole, numbers = run_of("failed"), [5, 6, 1]
    part = whole[numbers]
    part.to_parquet(tmp_path / "part.parquet")
    whole.to_parquet(tmp_path / "whole.parquet")
    rows, there = read(tmp_path / "part.parquet"), read(tmp_path / "whole.parquet").groupby("copy")
    for copy, own in rows.groupby("copy"):
        expected = there.get_group(numbers[copy]).drop(columns="copy").reset_index(drop=True)
        assert own.drop(columns="copy").reset_index(drop=True).equals(expected)
    lines = part.plot("velocity").axes[0].lines
    for line, copy in zip(lines, numbers, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), whole.velocity[copy, :, 0])


def test_parts_of_what_was_interrupted_tell_who_was() -> None:
    def stop_on_the_way(done: float, total: float) -> None:
        if done >= 0.3 * total:
            raise KeyboardInterrupt

    many = vv.systems.double_pendulum().ensemble(position=np.linspace(0.5, 1.0, 400).reshape(200, 2))
    with pytest.raises(vv.Interrupted) as stopped:
        many.run(t=np.linspace(0.0, 300.0, 5), threads=1, progress=stop_on_the_way)
    whole: Any = stopped.value.trajectory
    late = whole.status == vv.Status.INTERRUPTED
    assert late.any()
    assert not late.all()
    assert len(whole[~late].final) == (~late).sum()
    mixed = [int(np.flatnonzero(late)[-1]), int(np.flatnonzero(~late)[0]), int(np.flatnonzero(late)[0])]
    is_part(whole[mixed], [whole[copy] for copy in mixed])
    assert repr(whole[mixed]).endswith("(3 copies, 5 times, 1 finished, 0 failed, 2 interrupted)")


def test_other_indices_are_refused_by_name() -> None:
    copies = vv.systems.pendulum().ensemble(position=[[0.1], [0.2], [0.3], [0.4]])
    refuses_what_is_no_choice(copies)
    refuses_what_is_no_choice(copies.run(t=1.0), names=True)
