"""Ensembles over the numbers of what acts on rigid bodies: kept, told of, and refused."""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from copies_elsewhere import assert_same, assert_same_elsewhere
from loads_of_copies import (
    ANCHORED,
    CASES,
    DRAG,
    PAIR,
    TO_BODY,
    TORQUE,
    with_method,
)

import visviva as vv

TIMES = [0.1, 0.515]


@pytest.mark.parametrize("name", ["several", "damping in some", "torque on a top"])
@pytest.mark.parametrize("how", [{}, {"dt": 0.01}], ids=["auto", "equal steps"])
def test_elsewhere(tmp_path: Path, how: dict[str, Any], name: str) -> None:
    """Saved, pickled, cut, sent to executors, streamed and run on: the same copies."""
    scene, parameters = CASES[name]
    how = with_method(how, scene)
    copies = scene.ensemble(parameters=parameters)
    out, _, others = assert_same_elsewhere(copies, TIMES, how, tmp_path)
    assert out.final.body_forces == copies.body_forces
    for other in others:
        assert other.ensemble.body_forces == copies.body_forces
    for copy in (0, 4, 10):
        assert out[copy].final.body_forces == copies.body_forces[copy]
    if how:  # From a node on it is one long run, to the bit, whoever kept the half of it.
        half, whole = copies.run(t=0.5, **how), copies.run(t=[0.5, 1.0], **how)
        half.save(tmp_path / "half.npz")
        loaded = vv.load(tmp_path / "half.npz")
        assert isinstance(loaded, vv.EnsembleTrajectory)
        for begun in (half, loaded, pickle.loads(pickle.dumps(half))):
            assert_same(begun.final.run(t=[0.5, 1.0], **how), whole)
            assert_same(begun.final[5:8].run(t=[0.5, 1.0], **how), whole[5:8])
            assert_same(begun.final[6].run(t=[0.5, 1.0], **how), whole[6])
    assert str(copies.plan(t=1.0, **how).cost()) != ""


def test_files_of_copies_under_the_same_forces_are_as_before(tmp_path: Path) -> None:
    """They have no key that other versions do not know."""
    vv.Scene(PAIR, ANCHORED).ensemble(angular_velocity=np.ones((2, 2, 3))).run(t=0.1).save(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as file:
        header = json.loads(file["header"].tobytes())
    assert sorted(header["rigid"]) == ["forces", "names"]
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    assert loaded.ensemble.body_forces == (vv.Scene(PAIR, ANCHORED).body_forces,) * 2


def test_a_file_has_what_acts_on_copies_once_of_all_that_share_it(tmp_path: Path) -> None:
    """Two torques by turns are two sets, whoever made the forces of a copy; one in all copies is that of the scene."""

    def kept(torques: list[list[float]], first: int = 0) -> Any:
        copies = vv.Scene(PAIR, TORQUE, DRAG).ensemble(parameters={TORQUE: {"torque": torques}})[first:]
        copies.run(t=0.1).save(tmp_path / "run.npz")
        with np.load(tmp_path / "run.npz") as file:
            return json.loads(file["header"].tobytes())["rigid"]

    one, other = [0.1, 0.0, 0.0], [0.0, 0.2, 0.0]
    for first in (0, 1):
        header = kept([one, other, one, other, one], first)
        sets, of_copy = header["own_forces"]
        assert of_copy == [0, 1, 0, 1, 0][: 5 - first]
        assert [loads[0]["torque"] for loads in sets] == ([one, other] if first == 0 else [other, one])
        assert header["forces"] == sets[0]
    same = kept([other] * 3)
    assert "own_forces" not in same
    assert same["forces"][0]["torque"] == other


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        ("kinds", "the file has copies on whose rigid bodies other kinds of forces act"),
        ("number", "the file has forces on rigid bodies of 10 copies, of 11"),
        ("place", "index out of range"),
        ("names", "expected a keyword of AttachedSpring"),
    ],
)
def test_damaged_files(tmp_path: Path, damage: str, message: str) -> None:
    scene, parameters = CASES["damping in some"]
    path = tmp_path / "run.npz"
    scene.ensemble(parameters=parameters).run(t=0.1).save(path)
    with np.load(path) as file:
        arrays = dict(file)
    header = json.loads(arrays["header"].tobytes())
    sets, of_copy = header["rigid"]["own_forces"]
    if damage == "kinds":
        sets[1] = [{"kind": "rotational_drag", "coefficient": 1.0, "body": None}]
    elif damage == "number":
        of_copy.pop()
    elif damage == "place":
        of_copy[0] = len(sets)
    else:
        sets[1][0]["length of it"] = 1.0
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, **arrays)
    with pytest.raises(vv.InvalidInput, match="path: .*" + message):
        vv.load(path)


def test_what_is_conserved_is_asked_of_each_copy() -> None:
    copies = vv.Scene(PAIR, ANCHORED).ensemble(
        parameters={ANCHORED: {"damping": [0.0, 0.1, 0.0], "stiffness": [1, 2, 3]}}
    )
    out = copies.run(t=[0.0, 1.0, 3.0])
    kept = out.conservation()
    assert kept.energy.conserved.tolist() == [True, False, True]
    # Errors of the tolerance of steps; damping takes percents.
    assert kept.energy.max[[0, 2]].max() < 1e-11
    assert kept.energy.max[1] > 1e-3
    for copy, scene in enumerate(copies):
        assert_same(out[copy], scene.run(t=[0.0, 1.0, 3.0]))  # Energies that were not recorded are of its own springs.
        assert out.energy[copy, 0] == scene.invariants().energy
    assert len({*out.energy[:, 0]}) == 3


ONE = vv.Scene(PAIR, ANCHORED)
TWICE = vv.Scene(PAIR, DRAG, DRAG, vv.AppliedTorque([0, 0, 1], body=0), TORQUE, TO_BODY)


@pytest.mark.parametrize(
    ("scene", "parameters", "message"),
    [
        (
            ONE,
            {"AttachedSpring": {"body": [0, 1]}},
            "got 'body': bodies, axes and functions are the same in all copies",
        ),
        (ONE, {ANCHORED: {"to": [0, 1]}}, "got 'to': bodies, .* run a scene for each"),
        (ONE, {ANCHORED: {"particle": [0, 1]}}, "got 'particle': bodies, .* run a scene for each"),
        (TWICE, {TORQUE: {"frame": ["body", "space"]}}, "got 'frame': bodies, axes"),
        (
            TWICE,
            {TO_BODY: {"anchor": np.ones((2, 3))}},
            "got 'anchor': it is None in the scene, and is so in all copies",
        ),
        (
            ONE,
            {ANCHORED: {"to_point": np.ones((2, 3))}},
            "AttachedSpring of copy 0: to_point: expected none with anchor",
        ),
        (ONE, {ANCHORED: {"stifness": [1.0, 2.0]}}, "got 'stifness'; did you mean 'stiffness'"),
        (ONE, {ANCHORED: {"stiffness": [1.0, -2.0]}}, "AttachedSpring of copy 1: stiffness: .* at least 0, got -2.0"),
        (ONE, {ANCHORED: {"length": [1.0, np.inf]}}, "AttachedSpring of copy 1: length: expected finite"),
        (ONE, {ANCHORED: {"damping": [[1.0], [2.0]]}}, "AttachedSpring of copy 0: damping: expected one real number"),
        (ONE, {ANCHORED: {"point": [[1, 0, 0], [0, np.nan, 0]]}}, "AttachedSpring of copy 1: point: expected finite"),
        (ONE, {ANCHORED: {"point": np.ones((2, 2))}}, r"copy 0: point: expected shape \(3,\), got \(2,\)"),
        (ONE, {ANCHORED: {"point": [1.0, 2.0, 3.0]}}, r"copy 0: point: expected shape \(3,\), got \(\)"),
        (ONE, {ANCHORED: {"stiffness": 3.0}}, "expected values of 'stiffness' with a leading axis over the copies"),
        (ONE, {ANCHORED: {}}, "expected a dictionary {name: values}"),
        (ONE, {ANCHORED: {"stiffness": [1, 2], "length": [1, 2, 3]}}, "values of 'length' for 2 copies like stiffness"),
        (ONE, {"stiffness": [1.0, 2.0]}, "it is a parameter: {'AttachedSpring': {'stiffness': values}}"),
        (ONE, {"AtachedSpring": {"stiffness": [1.0]}}, "none like that; did you mean 'AttachedSpring'"),
        (ONE, {DRAG: {"coefficient": [1.0]}}, "a force on rigid bodies of the scene .* it has none like that"),
        (ONE, {vv.RotationalDrag(1.0, body="top"): {"coefficient": [1.0]}}, "RotationalDrag.*: body: .*'top'"),
        (ONE, {0: {"stiffness": [1.0]}}, "the place of a force, below 0, got 0; give a force on rigid bodies itself"),
        (TWICE, {"AppliedTorque": {"torque": np.ones((2, 3))}}, "several like that: give the one itself"),
        (TWICE, {DRAG: {"coefficient": [1.0, 2.0]}}, "several like that: make one of them"),
        (vv.problems.kepler(e=0.5).scene, {DRAG: {"coefficient": [1.0]}}, "expected rigid bodies in the scene"),
        (vv.problems.kepler(e=0.5).scene, {"RotationalDrag": {"coefficient": [1.0]}}, "it has none like that"),
    ],
)
def test_refused(scene: vv.Scene, parameters: dict[Any, Any], message: str) -> None:
    with pytest.raises(vv.InvalidInput, match=message) as refused:
        scene.ensemble(parameters=parameters)
    assert refused.value.argument == "parameters"


def test_copies_of_other_numbers_are_refused() -> None:
    with pytest.raises(vv.InvalidInput, match="parameters: expected 3 copies like position, got 2"):
        ONE.ensemble(position=np.zeros((3, 2, 3)), parameters={ANCHORED: {"stiffness": [1.0, 2.0]}})


def test_refused_by_the_method() -> None:
    """Where one copy has damping, what takes none is refused for all, as alone; where none has any it is taken."""
    for damping, refused in (([0.0, 0.1], True), ([0.0, 0.0], False)):
        copies = ONE.ensemble(parameters={ANCHORED: {"damping": damping}})
        if refused:
            with pytest.raises(vv.InvalidInput, match=r"method: .*AttachedSpring looks at velocities"):
                copies.run(t=1.0, method="leapfrog", dt=0.01)
        else:
            assert not copies.run(t=1.0, method="leapfrog", dt=0.01).status.any()


def test_rods() -> None:
    """What would turn one about itself is refused in each copy, by the forces and by the moments that it has."""
    driven = vv.AppliedTorque([1.0, 0.0, 0.0], frame="body")
    rod = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 0.0]), driven)
    across, along = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    out = rod.ensemble(parameters={driven: {"torque": across}}).run(t=1.0)
    # ω = τt/I of four steps, each of them a rounding or two; what it is not turned about stays 0.
    assert out.angular_velocity[:, -1, 0] == pytest.approx(np.array(across), rel=1e-14, abs=0.0)
    with pytest.raises(vv.InvalidInput, match="of copy 1: torque: expected a torque across the axis of body 0, a rod"):
        rod.ensemble(parameters={driven: {"torque": along}})
    with pytest.raises(vv.InvalidInput, match="torque: expected a torque across the axis of body 0 of copy 0, a rod"):
        rod.ensemble(parameters={driven: {"torque": across}}, moments=[[[0.0, 1.0, 1.0]], [[1.0, 1.0, 0.0]]])


def test_rods_along_other_axes_than_that_of_the_scene(tmp_path: Path) -> None:
    """Torques and spins across the axis of one are along that of another: whatever is made of the copies stands."""
    driven = vv.AppliedTorque([1.0, 0.0, 0.0], frame="body")
    copies = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 0.0]), driven).ensemble(
        parameters={driven: {"torque": [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]}},
        moments=[[[0.0, 1.0, 1.0]], [[1.0, 1.0, 0.0]]],
    )
    out = copies.run(t=1.0)
    # As above: τt/I, to some roundings.
    assert out.angular_velocity[:, -1, 0] == pytest.approx(np.array([[0, 0, 1.0], [0, 1.0, 0]]), rel=1e-14, abs=0.0)
    out.save(tmp_path / "run.npz")
    loaded = vv.load(tmp_path / "run.npz")
    assert isinstance(loaded, vv.EnsembleTrajectory)
    for other in (out, loaded, pickle.loads(pickle.dumps(out))):
        assert list(other.ensemble[:1]) == [copies[0]]
        # Linear in time, as above, over twice the steps.
        spin = other.final.run(t=2.0).angular_velocity[:, -1, 0]
        assert spin == pytest.approx(np.array([[0, 0, 2.0], [0, 2.0, 0]]), rel=1e-14, abs=0.0)


def test_the_end_of_copies_that_turn_as_a_rod_of_the_scene_does_not() -> None:
    """It was refused, as a spin of the scene's own body."""
    rod = vv.Scene(vv.RigidBody(1.0, [1.0, 1.0, 0.0]))
    copies = rod.ensemble(moments=np.ones((2, 1, 3)), angular_velocity=[[[0, 0, 1.0]], [[0, 0, 2.0]]])
    final = copies.run(t=1.0).final
    assert [each.rigid_bodies.angular_velocity[0, 2] for each in final if each.rigid_bodies] == [1.0, 2.0]
