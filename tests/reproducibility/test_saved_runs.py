"""A run that is written while it goes on, and picked up after whatever broke it, has the bits of an unbroken one."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv

TIMES = np.array([0.0, 0.35, 1.0, 1.01, 2.5, 2.6, 4.0, 4.2])


def spheres() -> vv.Scene:
    return vv.Scene(vv.Particles([1.0, 2.0], [[-2.0, 0, 0], [2.0, 0.1, 0]], [[1.0, 0, 0], [-1.0, 0, 0]], radius=0.5))


def rigid() -> vv.Scene:
    body = vv.RigidBodies([1.0], moments=[[1.0, 2.0, 3.0]], angular_velocity=[[0.1, 1.0, 0.1]], names=["handle"])
    return vv.Scene(body, vv.UniformField([0.0, 0.0, -1.0]))


def pivoted() -> vv.Scene:
    """A brick that hangs from a point: torques turn it, in equal steps that the scene chooses."""
    body = vv.RigidBody(2.0, moments=[1.0, 1.2, 1.5], pivot=[0.0, 0.2, 0.0], angular_velocity=[0.1, 3.0, 0.1])
    return vv.Scene(body, vv.UniformField([0.0, 0.0, -9.81]))


def figure() -> vv.Scene:
    return vv.problems.figure_eight().scene


CASES: dict[str, tuple[Callable[[], vv.Scene], dict[str, Any]]] = {
    "leapfrog": (figure, {"method": "leapfrog", "dt": 0.01}),
    "a multistep method": (figure, {"method": "stormer13", "dt": 0.01, "record": ["position", "velocity", "energy"]}),
    "adaptive": (figure, {}),
    "adaptive, with tolerances of each": (figure, {"method": "dop853", "atol": {"position": [1e-9, 1e-8, 1e-9]}}),
    "events": (figure, {"method": "kahan_li8", "dt": 0.01, "events": [vv.events.apsis(0, 1)]}),
    "an expression": (
        figure,
        {"method": "kahan_li8", "dt": 0.01, "events": [vv.events.expression(lambda t, x, v: x[0, 0] - x[1, 0] ** 3)]},
    ),
    "the third event ends it": (
        figure,
        {"method": "kahan_li8", "dt": 0.01, "events": [vv.events.plane([0, 0, 0], [0, 1.0, 0], terminal=3)]},
    ),
    "collisions": (spheres, {"method": "leapfrog", "dt": 0.01, "collisions": "bounce"}),
    "merged": (spheres, {"method": "leapfrog", "dt": 0.01, "collisions": "merge"}),
    "rigid": (rigid, {"method": "leapfrog", "dt": 0.01}),
    "rigid, in steps chosen by the scene": (pivoted, {}),
    "rigid, by series": (pivoted, {"method": "taylor"}),
    "closed form": (lambda: vv.problems.kepler(e=0.5).scene, {}),
}
FIXED = [name for name, (_, how) in CASES.items() if "dt" in how and "collisions" not in how]


def same(first: Any, second: Any, name: str = "result") -> None:
    """Every number but what it cost in time; the plan is told once more."""
    if isinstance(first, dict):
        assert first.keys() - {"dt_beyond", "energy_error"} == second.keys() - {"dt_beyond", "energy_error"}, name
        for key in first.keys() - {"seconds", "threads", "plan", "dt_beyond", "energy_error"}:
            same(first[key], second[key], f"{name}/{key}")
    else:
        assert np.array_equal(first, second, equal_nan=np.asarray(first).dtype.kind == "f"), name


@pytest.mark.parametrize("name", FIXED)
def test_fixed_steps_have_the_bits_of_one_piece(name: str, tmp_path: Path) -> None:
    made, how = CASES[name]
    whole = made().run(t=TIMES, **how)
    saved = made().run(t=TIMES, **how, save_every=0.3, save_to=tmp_path / "run")
    same(whole.t, saved.t)
    for column in whole.recorded:
        same(getattr(whole, column), getattr(saved, column), column)
    assert saved.final == whole.final
    assert saved.status == whole.status
    if "events" in how:
        same(whole.events.t, saved.events.t)
        assert saved.events.definitions == whole.events.definitions
    if whole.status == vv.Status.OK:
        assert saved.stats.steps == whole.stats.steps
        more = {key: how[key] for key in ("method", "dt")}
        same(whole.final.run(t=6.2, **more).position, saved.final.run(t=6.2, **more).position)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("left", [0, 1, 4, 9])
def test_whatever_is_lost_it_is_picked_up_to_the_bit(name: str, left: int, tmp_path: Path) -> None:
    made, how = CASES[name]
    whole = made().run(t=TIMES, **how, save_every=0.3, save_to=tmp_path / "run")
    files = sorted((tmp_path / "run").glob("part-*.npz"))
    for file in files[left:]:
        file.unlink()
    again = vv.resume(tmp_path / "run")
    same(whole._result, again._result)
    assert again.scene == whole.scene
    assert again.final == whole.final
    assert again.plan == whole.plan
    assert sorted((tmp_path / "run").glob("part-*.npz")) == files
    same(whole._result, vv.resume(tmp_path / "run")._result)  # it is whole: nothing is run


@pytest.mark.parametrize("damage", [b"", b"\0" * 4096, b"no file of NumPy", None])
@pytest.mark.parametrize("number", [2, 4])
def test_a_part_that_is_not_whole_is_run_again(damage: bytes | None, number: int, tmp_path: Path) -> None:
    """As a power cut leaves files, or cut short (None); those after it are as they were."""
    whole = figure().run(t=1.5, method="kahan_li8", dt=0.01, save_every=0.3, save_to=tmp_path / "run")
    file = tmp_path / "run" / f"part-{number:06}.npz"
    good = file.read_bytes()
    file.write_bytes(good[: len(good) // 2] if damage is None else damage)
    same(whole._result, vv.resume(tmp_path / "run")._result)
    again = vv.load(file)
    file.write_bytes(good)
    assert again.final == vv.load(file).final


@pytest.mark.parametrize("name", ["collisions", "merged"])
def test_collisions_are_those_of_one_piece(name: str, tmp_path: Path) -> None:
    """Steps begin anew after each, so bits differ; the motion between is straight, and leapfrog exact but rounding."""
    made, how = CASES[name]
    whole = made().run(t=TIMES, **how)
    saved = made().run(t=TIMES, **how, save_every=0.3, save_to=tmp_path / "run")
    np.testing.assert_allclose(saved.position, whole.position, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(saved.collisions.t, whole.collisions.t, rtol=1e-13)
    # Masses change on the way: each row has those of its time.
    np.testing.assert_allclose(saved.angular_momentum, whole.angular_momentum, rtol=1e-13, atol=1e-13)
    assert (saved.final.particles.mass == whole.final.particles.mass).all()
    assert saved.collisions.survivor.tolist() == whole.collisions.survivor.tolist()


@pytest.mark.parametrize("name", ["leapfrog", "adaptive"])
def test_backwards_and_from_any_time(name: str, tmp_path: Path) -> None:
    made, how = CASES[name]
    scene = made()
    scene = vv.Scene(scene.particles, *scene.forces, t0=7.3)
    saved = scene.run(t=5.0, **how, save_every=0.4, save_to=tmp_path / "run")
    (tmp_path / "run" / "part-000003.npz").unlink()
    same(saved._result, vv.resume(tmp_path / "run")._result)
    assert saved.t.tolist() == [7.3, 5.0]
    if "dt" in how:
        same(scene.run(t=5.0, **how).position, saved.position)
    # Near the best that the motion allows, in either case: parts cost no digits.
    best = scene.run(t=5.0, rtol=1e-13).position[-1]
    assert np.abs(saved.position[-1] - best).max() < 1e-3


def test_a_run_that_goes_on_with_another_is_cut_at_its_nodes(tmp_path: Path) -> None:
    how: dict[str, Any] = {"method": "stormer13", "dt": 0.01}
    first = figure().run(t=0.7, **how).final
    saved = first.run(t=3.0, **how, save_every=0.5, save_to=tmp_path / "run")
    same(figure().run(t=3.0, **how).position[-1], saved.position[-1])
    (tmp_path / "run" / "part-000002.npz").unlink()
    same(saved._result, vv.resume(tmp_path / "run")._result)
    same(figure().run(t=5.0, **how).position[-1], saved.final.run(t=5.0, **how).position[-1])


@pytest.mark.parametrize("steps", [25, 30, 59])
def test_the_most_steps_are_those_of_the_whole(steps: int, tmp_path: Path) -> None:
    how: dict[str, Any] = {"t": 6.0, "method": "leapfrog", "dt": 0.1, "max_steps": steps}
    with pytest.raises(vv.ConvergenceError) as whole:
        figure().run(**how)
    for attempt in (lambda: figure().run(**how, save_every=1.0, save_to=tmp_path / "run"),
                    lambda: vv.resume(tmp_path / "run")):  # fmt: skip
        with pytest.raises(vv.ConvergenceError) as parts:
            attempt()
        assert parts.value.trajectory.final == whole.value.trajectory.final
        assert parts.value.trajectory.status == whole.value.trajectory.status


PROGRAM = """
import sys, visviva as vv
vv.problems.figure_eight().scene.run(
    t=[0.0, 100.0, 400.0], method="kahan_li8", dt=1e-3, save_every=2.0, save_to=sys.argv[1])
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no POSIX signals on this system")
def test_a_killed_process_is_picked_up_to_the_bit(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with subprocess.Popen([sys.executable, "-c", PROGRAM, str(folder)]) as process:
        deadline = time.monotonic() + 60.0
        while len(list(folder.glob("part-*.npz"))) < 7 and time.monotonic() < deadline:
            time.sleep(0.002)
        os.kill(process.pid, signal.SIGKILL)
    done = len(list(folder.glob("part-*.npz")))
    assert 7 <= done < 200
    out = vv.resume(folder)
    whole = figure().run(t=[0.0, 100.0, 400.0], method="kahan_li8", dt=1e-3)
    same(whole.position, out.position)
    same(whole.velocity, out.velocity)
    assert out.final == whole.final
    assert out.stats.steps == whole.stats.steps


def test_ctrl_c_leaves_what_was_done(tmp_path: Path) -> None:
    def stop(done: int, total: int) -> None:
        if done > 0.5 * total:
            raise KeyboardInterrupt

    how: dict[str, Any] = {"t": 20.0, "method": "kahan_li8", "dt": 1e-3}
    with pytest.raises(vv.Interrupted) as stopped:
        figure().run(**how, save_every=1.0, save_to=tmp_path / "run", progress=stop)
    assert stopped.value.trajectory.final.t0 > 5.0
    same(figure().run(**how).position, vv.resume(tmp_path / "run").position)


def test_what_makes_no_sense_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    scene = figure()
    how: dict[str, Any] = {"t": 5.0, "save_to": folder}
    for wrong, message in (
        ({"save_every": 0.0}, "save_every: expected"),
        ({"save_every": "often"}, "save_every: expected"),
        ({}, r"save_every: expected the time of the scene.*or out\.save\(path\)"),
        ({"save_every": 1e-9}, "save_every: expected at most 100000 parts.*give a longer time"),
        ({"save_every": 1.0, "save_to": 3}, "save_to: expected the path of a folder, got int"),
        ({"save_every": 1.0, "save_to": None}, 'save_to: expected the folder.*as save_to="run"'),
        (
            {"save_every": 1.0, "save_to": folder / "a" / "b"},
            "save_to: expected a folder in one that exists.*make that",
        ),
        ({"save_every": 1.0, "events": [lambda t, x, v: x[0, 0]]}, "save_every: a function of your own.*; use"),
        (
            {"save_every": 1.0, "method": "leapfrog", "dt": 0.1, "time_transformation": "distance"},
            "save_every: steps under a time transformation.*leave save_every or time_transformation out",
        ),
        ({"save_every": 1.0, "method": "leapfrogg"}, "method"),
        ({"save_every": 1.0, "threads": 0}, "threads: expected a whole number from 1"),
        ({"save_every": 1.0, "progress": "yes"}, "progress: expected"),
        ({"save_every": 1.0, "max_steps": 0}, "max_steps: expected at least 1"),
    ):
        with pytest.raises(vv.InvalidInput, match=message):
            scene.run(**{**how, **wrong})
        assert not folder.exists()
    with pytest.raises(vv.InvalidInput, match=r"save_every: an ensemble is not written.*run_to_parquet"):
        scene.ensemble(mass=np.ones((3, 3))).run(t=1.0, save_every=0.5, save_to=folder)
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(vv.InvalidInput, match=r"save_to: expected a folder, got the file.*name another"):
        scene.run(t=1.0, save_every=0.5, save_to=file)
    scene.run(t=1.0, save_every=0.5, save_to=folder)
    told = r"save_to: there is a run in .*; visviva\.resume continues it, or name another"
    with pytest.raises(vv.InvalidInput, match=told):
        scene.run(t=1.0, save_every=0.5, save_to=folder)


def test_what_is_no_such_run_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        vv.resume(tmp_path / "nowhere")
    with pytest.raises(vv.InvalidInput, match=r"path: expected a run that was saved as it went.*that save_to named"):
        vv.resume(tmp_path)
    folder = tmp_path / "run"
    figure().run(t=2.0, method="leapfrog", dt=0.01, save_every=0.5, save_to=folder)
    for name, text in (
        ("request.json", b"{}"),
        ("request.json", b"[]"),
        ("request.json", (folder / "request.json").read_bytes().replace(b'"leapfrog"', b"7")),
        ("request.json", (folder / "request.json").read_bytes().replace(b'"version": 1', b'"version": 99')),
        ("request.json", (folder / "request.json").read_bytes().replace(b'"rtol"', b'"rtoll"')),
        ("part-000001.npz", (folder / "part-000002.npz").read_bytes()),
    ):
        other = tmp_path / "other"
        shutil.rmtree(other, ignore_errors=True)
        shutil.copytree(folder, other)
        (other / name).write_bytes(text)
        with pytest.raises(vv.InvalidInput):
            vv.resume(other)
    (folder / "start.npz").unlink()
    with pytest.raises(vv.InvalidInput, match=r"^path: expected start.npz, .* put it back or run anew$"):
        vv.resume(folder)


def test_a_run_that_is_written_is_warned_of_once(tmp_path: Path) -> None:
    slender = vv.RigidBody(1.0, [1.0, 1.0, 1e-11], angular_velocity=[0.1, 0.2, 0.0])
    scene = vv.Scene(slender, vv.AppliedTorque([0.01, 0.0, 0.0], frame="body"))
    with pytest.warns(vv.AccuracyWarning, match="largest moment") as told:
        scene.run(t=0.01, method="verner98", save_every=0.005, save_to=tmp_path / "run")
    assert len(told) == 1
