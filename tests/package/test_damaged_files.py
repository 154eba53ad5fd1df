"""Damaged files are refused when they are loaded, whatever is wrong with them, and nothing fails later."""

import os
import threading
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kept_files import parts, refused, written

import visviva as vv
from visviva import _core

SCENE = vv.Scene(
    vv.Particles([1.0, 0.5], [[0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 1.2, 0]]),
    vv.Gravity(G=1.1, softening=0.01),
    vv.CentralField(vv.potentials.Yukawa(k=0.1, length=3.0), center=[0.0, 0.0, 5.0]),
    t0=1.5,
)
DEFAULTS = {
    parameter["name"]
    for force in _core.forces()
    for parameter in force["parameters"]
    if parameter["default"] is not None
}
COPIES = SCENE.ensemble(velocity=SCENE.particles.velocity * np.array([1.0, 0.9])[:, None, None])
RECORD = ("position", "velocity", "energy", "momentum")
GOLDEN = Path(__file__).parent.parent / "reference" / "trajectory_v1.npz"


@pytest.fixture(params=["one", "ensemble"])
def good(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    path = tmp_path / "run.npz"
    (SCENE if request.param == "one" else COPIES).run([1.5, 1.75, 2.0], method="dop853", record=RECORD).save(path)
    return path


def use(out: vv.Trajectory | vv.EnsembleTrajectory) -> None:
    """Everything that a result can be asked for."""
    for name in ("t", *RECORD, "angular_momentum", "center_of_mass", "status", "stats", "plan", "final", "recorded"):
        getattr(out, name)
    assert str(out.plan)
    assert repr(out)
    if isinstance(out, vv.EnsembleTrajectory):
        assert out.per_trajectory
        for each in out:
            use(each)
    else:
        assert out.conservation()
        assert out.final.run(out.final.t0 + 0.1)


def refused_or_whole(path: Path) -> bool:
    """Whether the file is refused, as it should be; if it loads, then nothing fails later."""
    return refused(path, use)


def test_what_is_written_again_loads(good: Path) -> None:
    assert not refused_or_whole(written(good, *parts(good)))


def test_the_file_of_version_1_is_whole_and_has_its_plan() -> None:
    out = vv.load(GOLDEN)
    use(out)
    assert (out.plan.method, out.plan.evaluations_per_step, out.plan.pairs_per_evaluation) == ("dop853", 12, 1)
    assert out.plan.rows[1] == ("method", "dop853", "order 8, steps chosen by the error estimate")
    assert out.plan.skipped[0] == ("event location", "no events are asked for")
    assert str(out.plan).startswith("solution                    integration")


def test_a_truncated_file_is_refused(good: Path) -> None:
    whole = good.read_bytes()
    for length in range(0, len(whole), 101):
        good.write_bytes(whole[:length])
        assert refused_or_whole(good), length


@pytest.mark.parametrize("compressed", [False, True])
def test_a_flipped_byte_is_refused_or_harmless(good: Path, compressed: bool) -> None:
    if compressed:
        with np.load(good) as file:
            np.savez_compressed(good, **dict(file))
        assert not refused_or_whole(good)
    whole = bytearray(good.read_bytes())
    generator = np.random.default_rng(1)
    refused = 0
    for place in generator.choice(len(whole), 400, replace=False):
        kept, whole[place] = whole[place], whole[place] ^ (1 << int(generator.integers(8)))
        good.write_bytes(whole)
        refused += refused_or_whole(good)
        whole[place] = kept
    # Contents carry a checksum; what is left are times and attributes in the directory, which nobody reads.
    assert refused > 200


def test_every_missing_array_is_refused(good: Path) -> None:
    header, arrays = parts(good)
    for name in arrays:
        written(good, header, {other: array for other, array in arrays.items() if other != name})
        if name.startswith("columns/"):  # not every column need be recorded
            assert name.removeprefix("columns/") not in vv.load(good).recorded
        else:
            assert refused_or_whole(good), name


@pytest.mark.parametrize(
    "damage",
    [
        lambda array: array[None],
        lambda array: array[..., :0],
        lambda array: array.ravel()[0],
        lambda array: array.astype("f4"),
        lambda array: array.astype(array.dtype.newbyteorder()) if array.dtype.itemsize > 1 else array.astype("f8"),
        lambda array: array.astype(complex),
        lambda array: array.astype(str),
        lambda array: np.concatenate([array, array]),
        lambda array: np.zeros(array.shape, "f8,f8"),
    ],
)
def test_every_array_of_another_shape_or_type_is_refused(good: Path, damage: Callable[[Any], Any]) -> None:
    header, arrays = parts(good)
    for name, array in arrays.items():
        assert refused_or_whole(written(good, header, arrays | {name: damage(array)})), name


@pytest.mark.parametrize(
    "more",
    [
        {"evil/x": np.zeros(3)},
        {"stray": np.zeros(3)},
        {"columns": np.zeros(3)},
        {"columns/": np.zeros(3)},
        {"columns/new": np.zeros(3)},
        {"final/new": np.zeros(7)},
        {"status": np.array([9], np.int8)},
        {"mass": np.array([[1.0, -1.0]])},
        {"mass": np.array([[1.0, np.nan]])},
        {"position": np.full((1, 2, 3), np.inf)},
    ],
    ids=str,
)
def test_arrays_that_cannot_be_are_refused(good: Path, more: dict[str, np.ndarray]) -> None:
    header, arrays = parts(good)
    assert refused_or_whole(written(good, header, arrays | more))


def test_every_missing_key_is_refused(good: Path) -> None:
    header, arrays = parts(good)
    for where in ((), ("stats",), ("plan",), ("forces", 0), ("forces", 1)):
        inner: Any = header
        for key in where:
            inner = inner[key]
        for key in list(inner):
            # Nobody reads this one; and a parameter with a default may be newer than the file.
            if key == "written_by" or (where[:1] == ("forces",) and key in DEFAULTS):
                continue
            kept = inner.pop(key)
            assert refused_or_whole(written(good, header, arrays)), (where, key)
            inner[key] = kept


WRONG = [None, "x", 3, -1.5, [], {}, [3], [[1, 2, 3]], {"x": 1}, True, 10**400]


def test_every_value_of_another_kind_is_refused(good: Path) -> None:
    header, arrays = parts(good)
    for where in ((), ("stats",), ("plan",), ("forces", 0), ("forces", 1)):
        inner: Any = header
        for key in where:
            inner = inner[key]
        for key, kept in list(inner.items()):
            for wrong in WRONG:
                inner[key] = wrong
                if not refused_or_whole(written(good, header, arrays)):
                    # What loads is a number for a number, a text for a text, none of a list.
                    like = (int, float) if isinstance(kept, int | float) and kept is not True else type(kept)
                    assert key == "written_by" or isinstance(wrong, like), (where, key, wrong)
            inner[key] = kept


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"null",
        b"[]",
        b"3",
        b'"visviva run"',
        b"{}",
        b"\xff\xfe",
        b"[" * 100_000,
        b'{"format": "visviva run", "version": Infinity}',
        b'{"format": "visviva run", "version": NaN}',
        b'{"format": "visviva run", "version": true}',
        b'{"format": "visviva run", "version": "1"}',
        b'{"format": 1, "version": 1}',
    ],
    ids=lambda text: text[:30].decode(errors="replace"),
)
def test_headers_that_are_none_are_refused(good: Path, text: bytes) -> None:
    _, arrays = parts(good)
    assert refused_or_whole(written(good, text, arrays))


def test_a_shape_larger_than_the_file_asks_for_no_memory(good: Path) -> None:
    with zipfile.ZipFile(good) as archive:
        members = {info.filename: archive.read(info) for info in archive.infolist()}
    before = members["t.npy"]
    members["t.npy"] = before.replace(b"(3,), }" + b" " * 17, b"(3000000000000000,), }  ")
    assert len(members["t.npy"]) == len(before)
    assert members["t.npy"] != before
    with zipfile.ZipFile(good, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    with pytest.raises(vv.InvalidInput, match="'t' to fill its place"):
        vv.load(good)


def test_status_codes_are_kept(tmp_path: Path) -> None:
    pair = vv.Scene(vv.Particles([1.0, 1.0], [[-1, 0, 0], [1, 0, 0]]), vv.Gravity(1.0))
    with pytest.raises(vv.CloseEncounter) as met:
        pair.run([1.0, 5.0], method="dop853")
    with pytest.raises(vv.ConvergenceError) as many:
        pair.run([1.0, 5.0], method="leapfrog", dt=1e-3, max_steps=100)

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(vv.Interrupted) as stopped:
        pair.run([0.0, 1e6], method="leapfrog", dt=1e-3, progress=stop)
    for caught, status in (
        (met, vv.Status.CLOSE_ENCOUNTER),
        (many, vv.Status.TOO_MANY_STEPS),
        (stopped, vv.Status.INTERRUPTED),
    ):
        out = caught.value.trajectory
        assert out.status is status
        out.save(tmp_path / "run.npz")
        again = vv.load(tmp_path / "run.npz")
        assert again.status is status
        assert again.final == out.final


def test_threads_that_save_to_one_path_do_not_meet(tmp_path: Path) -> None:
    path, failed = tmp_path / "run.npz", []
    runs = [SCENE.run(1.5 + 0.1 * number) for number in range(1, 5)]

    def save(out: vv.Trajectory) -> None:
        try:
            for _ in range(15):
                out.save(path)
        except Exception as error:
            failed.append(error)

    threads = [threading.Thread(target=save, args=[out]) for out in runs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.npz"]
    assert vv.load(path).final in [out.final for out in runs]


@pytest.mark.skipif(os.name != "posix", reason="links need no rights on POSIX")
def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    real, link = tmp_path / "data" / "run.npz", tmp_path / "latest.npz"
    for _ in range(2):  # at first it leads nowhere
        link.unlink(missing_ok=True)
        link.symlink_to(Path("data") / "run.npz")
        SCENE.run(2.0).save(link)
        assert link.is_symlink()
        assert vv.load(real).final == vv.load(link).final
    assert [entry.name for entry in real.parent.iterdir()] == ["run.npz"]
