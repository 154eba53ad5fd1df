"""Saved runs: everything comes back, whole files only, every earlier version loads."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from kept_files import parts, the_old_file_stays, written

import visviva as vv
from visviva import io

GOLDEN = Path(__file__).parent.parent / "reference" / "trajectory_v1.npz"


def scene() -> vv.Scene:
    return vv.Scene(
        vv.Particles([1.0, 0.5], [[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 1.2, 0]]),
        vv.Gravity(G=1.1, softening=0.01),
        vv.UniformField([0.1, 0.0, -0.2]),
        vv.CentralField(vv.potentials.Yukawa(k=0.1, length=3.0), center=[0.0, 0.0, 5.0]),
        t0=1.5,
    )


def test_a_trajectory_comes_back_whole(tmp_path: Path) -> None:
    out = scene().run(t=[1.5, 1.75, 2.0], record=("position", "velocity", "energy"))
    out.save(tmp_path / "run.npz")
    again = vv.load(tmp_path / "run.npz")
    assert isinstance(again, vv.Trajectory)
    assert again.scene == out.scene
    assert again.final == out.final
    assert (again.stats, again.plan, again.status) == (out.stats, out.plan, out.status)
    assert again.recorded == out.recorded
    for name in ("t", "position", "velocity", "energy", "angular_momentum"):
        assert np.array_equal(getattr(again, name), getattr(out, name))
    assert again.conservation() == out.conservation()


def test_an_ensemble_comes_back_whole(tmp_path: Path) -> None:
    start = scene()
    out = start.ensemble(velocity=start.particles.velocity * np.array([1.0, 0.9, 0.8])[:, None, None]).run(t=2.0)
    out.save(tmp_path / "ensemble.npz")
    again = vv.load(tmp_path / "ensemble.npz")
    assert isinstance(again, vv.EnsembleTrajectory)
    assert np.array_equal(again.position, out.position)
    assert np.array_equal(again.status, out.status)
    assert again.stats == out.stats
    assert again[2].final == out[2].final
    assert all(np.array_equal(again.per_trajectory[name], value) for name, value in out.per_trajectory.items())


def test_the_path_is_used_as_given(tmp_path: Path) -> None:
    out = scene().run(t=2.0)
    out.save(str(tmp_path / "no_ending"))
    assert [path.name for path in tmp_path.iterdir()] == ["no_ending"]
    assert isinstance(vv.load(tmp_path / "no_ending"), vv.Trajectory)


def test_a_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    the_old_file_stays(tmp_path / "run.npz", scene().run(t=2.0), scene().run(t=3.0), monkeypatch)


def rewrite(path: Path, **changes: object) -> Path:
    """The same file with another header."""
    header, arrays = parts(path)
    return written(path, header | changes, arrays)


def test_other_files_are_refused_by_name(tmp_path: Path) -> None:
    good = tmp_path / "run.npz"
    scene().run(t=2.0).save(good)
    text, plain, cut, pickled = (tmp_path / name for name in ("text", "plain.npz", "cut.npz", "pickled.npz"))
    text.write_text("not an archive")
    np.savez(plain, x=np.zeros(3))
    cut.write_bytes(good.read_bytes()[:300])
    np.savez(pickled, header=np.array([{"format": "visviva run"}], dtype=object))
    for path in (text, plain, cut, pickled):
        with pytest.raises(vv.InvalidInput, match=path.name) as caught:
            vv.load(path)
        assert caught.value.argument == "path"
    with pytest.raises(vv.InvalidInput, match="newer"):
        vv.load(rewrite(good, version=io.VERSION + 1))
    with pytest.raises(vv.InvalidInput, match="something else"):
        vv.load(rewrite(good, format="something else"))
    with pytest.raises(vv.InvalidInput, match="'magnet'"):
        vv.load(rewrite(good, format=io.FORMAT, version=1, forces=[{"kind": "magnet"}]))
    with pytest.raises(FileNotFoundError):
        vv.load(tmp_path / "missing.npz")


def test_the_file_of_version_1_loads() -> None:
    """Written once by version 0.1.0 and never again: this file must load in every later version."""
    out = vv.load(GOLDEN)
    assert isinstance(out, vv.Trajectory)
    assert out.scene == scene()
    assert out.status is vv.Status.OK
    assert out.position.shape == (5, 2, 3)
    assert out.energy.shape == (5,)
    assert out.stats.method == "dop853"
    assert out.final.t0 == 3.5
    # The numbers in the file are those of a run today, to the tolerance 1e-12 of both.
    today = scene().run(t=out.t, method="dop853", rtol=1e-12)
    assert np.allclose(today.position, out.position, rtol=0, atol=1e-10)


def height(t: float, position: np.ndarray, velocity: np.ndarray) -> float:
    return float(position[1, 2])


@pytest.mark.parametrize("members", [0, 3])
def test_events_come_back_with_what_was_looked_for(tmp_path: Path, members: int) -> None:
    looked_for = [
        vv.events.apsis(1, 0, direction=1),
        vv.events.apsis(1, [0.5, 0.0, 1e-3]),
        vv.events.distance(0, 1, below=0.9, terminal=7),
        vv.events.plane([0.0, 0.25, 0.0], [0.0, 1.0, 3.0], body=1, direction=-1),
        vv.events.energy(-0.1),
        height,
    ]
    start = scene()
    run = start.ensemble(position=np.repeat(start.particles.position[None], members, axis=0)) if members else start
    out = run.run(t=4.0, events=looked_for)
    assert len(out.events) > 0
    assert out.events.definitions[:5] == tuple(looked_for[:5])
    assert dict(out.events.definitions[5].parameters) == {"name": "height"}
    out.save(tmp_path / "run.npz")
    for again in (vv.load(tmp_path / "run.npz"), pickle.loads(pickle.dumps(out))):
        assert again.events.definitions == out.events.definitions
        for name in ("which", "t", "position", "velocity", "member"):
            assert np.array_equal(getattr(again.events, name), getattr(out.events, name), equal_nan=True)
        one = again[1] if isinstance(again, vv.EnsembleTrajectory) else again
        assert one.events.definitions == out.events.definitions
        # They may be looked for again.
        assert len(one.final.run(t=9.0, events=one.events.definitions[:5]).events) > 0
        with pytest.raises(vv.InvalidInput, match=r"events: of the function 'height' a run keeps its name alone"):
            one.final.run(t=9.0, events=one.events.definitions)


def test_a_file_without_definitions_loads(tmp_path: Path) -> None:
    """As files were written before definitions were kept."""
    scene().run(t=4.0, events=[vv.events.apsis(1, 0)]).save(tmp_path / "run.npz")
    header, arrays = parts(tmp_path / "run.npz")
    del header["events"]
    old = vv.load(written(tmp_path / "old.npz", header, arrays))
    assert len(old.events) > 0
    assert old.events.definitions == ()


@pytest.mark.parametrize(
    "damage",
    [
        {"events": 3},
        {"events": [1]},
        {"events": []},
        {"events": [{"kind": "comet"}]},
        {"events": [{"kind": "apsis"}]},
        {"events": [{"kind": "energy", "value": "x", "direction": 0, "last": None}]},
    ],
)
def test_damaged_definitions_are_refused_when_loaded(tmp_path: Path, damage: dict[str, object]) -> None:
    scene().run(t=4.0, events=[vv.events.apsis(1, 0)]).save(tmp_path / "run.npz")
    with pytest.raises(vv.InvalidInput, match="path: "):
        vv.load(rewrite(tmp_path / "run.npz", **damage))
