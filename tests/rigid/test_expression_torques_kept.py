"""Torques as formulas that are kept: as values, in pickles and files; and what is refused by name."""

import copy
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import visviva as vv


def motor(t: Any, q: Any, w: Any, power: Any, drag: Any) -> tuple[Any, ...]:
    return 0.0, 0.0, power * np.cos(t) - drag * w[2] * abs(q[3])


MOTOR = vv.ExpressionTorque(motor, frame="body", parameters={"power": 0.5, "drag": 0.1})
TORQUES = [
    MOTOR,
    vv.ExpressionTorque(lambda t, q, w: (q[0], t, w[1] ** 3), body="top"),
    MOTOR.rotated(np.diag([-1.0, -1.0, 1.0])).rescaled(length=10.0, mass=2.0, time=0.5),
]
WHEEL = vv.RigidBody(1.0, [0.5, 0.6, 0.9], angular_velocity=[0.1, 0.2, 0.3], name="top")
BODIES, PARTICLES = (("brick", "top"), 2), (("sun", "moon"), 2)


@pytest.mark.parametrize("torque", TORQUES, ids=repr)
def test_formulas_are_values(torque: vv.ExpressionTorque) -> None:
    for same in (pickle.loads(pickle.dumps(torque)), copy.copy(torque), copy.deepcopy(torque), replace(torque)):
        assert same == torque
        assert hash(same) == hash(torque)
        assert repr(same) == repr(torque)
    with pytest.raises(vv.FrozenAttribute):
        torque.body = 0  # type: ignore[misc]
    scenes = [vv.Scene(WHEEL, each) for each in (torque, pickle.loads(pickle.dumps(torque)), replace(torque, time=2.0))]
    assert scenes[0] == scenes[1]
    assert hash(scenes[0]) == hash(scenes[1])
    assert scenes[0] != scenes[2]
    known = torque._resolved(BODIES, PARTICLES)
    assert known._core_arguments()["body"] == (None if torque.body is None else 1)
    back = torque.rescaled(length=4.0, mass=2.0, time=8.0)
    assert back != torque
    assert back.rescaled(length=1 / 4, mass=1 / 2, time=1 / 8) == torque
    assert torque.rotated(np.eye(3)) == torque
    assert torque.shifted(np.ones(3), np.ones(3)) == torque


def test_the_same_formula_is_the_same_torque() -> None:
    again = vv.ExpressionTorque(motor, frame="body", parameters={"drag": 0.1, "power": 0.5})
    assert vv.ExpressionTorque(motor, frame="body", parameters={"power": 0.5, "drag": 0.1}) == MOTOR
    # Parameters stand in the order in which they were given.
    assert dict(again.parameters) == dict(MOTOR.parameters)
    changed = replace(MOTOR, parameters={"drag": 0.2, "power": 0.5})
    assert changed.parameters == (("power", 0.5), ("drag", 0.2))
    assert changed.function == MOTOR.function


def test_formulas_are_read_as_they_were_written() -> None:
    assert (
        repr(MOTOR)
        == "ExpressionTorque((0, 0, power*cos(t) - drag*wz*sqrt(qw*qw)), body=None, frame='body', power=0.5, drag=0.1)"
    )
    assert repr(TORQUES[1]) == "ExpressionTorque((qx, t, wy**3), body='top', frame='space')"
    assert repr(TORQUES[2]).endswith("axes=(0.0, 0.0, 1.0, 0.0), length=10.0, mass=2.0, time=0.5)")
    assert len(repr(vv.ExpressionTorque(lambda t, q, w: [sum(np.sin(k * t) for k in range(99))] * 3))) < 120
    assert "drag*wz" in repr(vv.Scene(WHEEL, MOTOR))


@pytest.mark.parametrize("torque", TORQUES, ids=repr)
def test_runs_and_ensembles_are_saved(torque: vv.ExpressionTorque, tmp_path: Path) -> None:
    scene = vv.Scene(WHEEL, torque, vv.RotationalDrag(0.1))
    out = scene.run(t=[0.5, 1.0])
    out.save(tmp_path / "run.npz")
    there = vv.load(tmp_path / "run.npz")
    assert there.scene == out.scene
    assert there.scene.body_forces == scene.body_forces
    np.testing.assert_array_equal(there.orientation, out.orientation)
    further, there_further = out.final.run(t=2.0), there.final.run(t=2.0)
    np.testing.assert_array_equal(there_further.orientation, further.orientation)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(scene)).run(t=[0.5, 1.0]).orientation, out.orientation)


def test_copies_with_parameters_of_their_own_are_saved(tmp_path: Path) -> None:
    copies = vv.Scene(WHEEL, MOTOR).ensemble(
        parameters={"ExpressionTorque": {"power": [0.5, 1.0, 0.5], "drag": [0, 1, 2]}}
    )
    assert [load.parameters for (load,) in copies.body_forces] == [
        (("power", 0.5), ("drag", 0.0)),
        (("power", 1.0), ("drag", 1.0)),
        (("power", 0.5), ("drag", 2.0)),
    ]
    out = copies.run(t=[0.5, 1.0])
    out.save(tmp_path / "run.npz")
    there = vv.load(tmp_path / "run.npz")
    for number in range(3):
        assert there[number].scene.body_forces == copies.body_forces[number]
        alone = vv.Scene(WHEEL, copies.body_forces[number][0]).run(t=[0.5, 1.0])
        np.testing.assert_array_equal(there[number].orientation, alone.orientation)
    again = pickle.loads(pickle.dumps(copies))
    assert again.body_forces == copies.body_forces
    np.testing.assert_array_equal(again.run(t=[0.5, 1.0]).orientation, out.orientation)


def test_copies_differ_in_parameters_alone() -> None:
    scene = vv.Scene(WHEEL, MOTOR)
    for name, given, words in (
        ("body", [0, 0], "got 'body': bodies, axes and functions are the same in all copies"),
        ("function", [motor, motor], "got 'function': bodies, axes and functions are the same"),
        ("powr", [1.0, 2.0], r"expected numbers of ExpressionTorque \(power, drag\), got 'powr'; did you mean 'power'"),
        ("power", [1.0, np.nan], r"ExpressionTorque of copy 1: parameters\['power'\]: "),
        ("power", [[1.0, 2.0], [1.0, 2.0]], "ExpressionTorque of copy 0: parameters"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            scene.ensemble(parameters={MOTOR: {name: given}})


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: vv.ExpressionTorque(None), r"function: expected a function f\(t, .*, got NoneType; .*AppliedTorque"),  # type: ignore[arg-type]
        (lambda: vv.ExpressionTorque([0, 0, 1.0]), "function: expected a function .*, got list; a constant torque is"),
        (lambda: vv.ExpressionTorque("0, 0, t"), "function: expected a function .*, got str"),
        (lambda: vv.ExpressionTorque([3, 0, 0, 0, 77, 0.0, 0]), "function: these are no expressions as visviva writes"),
        (lambda: vv.ExpressionTorque([3, 0, 0, 0, np.nan, 0.0, 0]), "function: these are no expressions"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: t), "function: expected three components of the function"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (t, t)), "function: expected three components of the function"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: q), "function: expected three components of the function"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (t, q, t)), "function: expected one number of the function"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (t, "a", t)), "function: expected one number of the function"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (t, np.inf, t)), "function: expected finite numbers"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (np.sinc(t), 0, 0)), "function: "),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (np.sign(t), 0, 0)), r"function: .*tanh"),
        (lambda: vv.ExpressionTorque(lambda t, q, w: (t if t > 1 else 0, 0, 0)), "function: "),
        (lambda: vv.ExpressionTorque(lambda q, w: (0, 0, 0)), "function: the function is called with"),
        (lambda: vv.ExpressionTorque(lambda q, w, t: (0, 0, 0)), r"in this order, got f\(q, w, t, …\)"),
        (
            lambda: vv.ExpressionTorque(lambda t, q, w=1.0: (0, 0, w)),
            "parameters after these three, got w=1.0 among them",
        ),
        (lambda: vv.ExpressionTorque(lambda t, q, w, k: (0, 0, k)), "parameters: expected a value of 'k'"),
        (
            lambda: vv.ExpressionTorque(lambda t, q, w, k: (0, 0, k), parameters={"k": 1.0, "c": 2.0}),
            "function: the function is called with",
        ),
        (lambda: vv.ExpressionTorque(lambda t, q, w, k: (0, 0, k), parameters={"k": np.nan}), r"parameters\['k'\]: "),
        (lambda: vv.ExpressionTorque(lambda t, q, w, k: (0, 0, k), parameters={"k": "a"}), r"parameters\['k'\]: "),
        (lambda: vv.ExpressionTorque(motor, parameters=7), "parameters: expected values by parameter, .* got int"),  # type: ignore[arg-type]
        (lambda: vv.ExpressionTorque(motor, parameters=(1, 2)), "parameters: expected values by parameter"),  # type: ignore[arg-type]
        (
            lambda: vv.ExpressionTorque(lambda t, q, w, **own: (0, 0, 0), parameters={"t": 1.0}),
            "parameters: expected names",
        ),
        (lambda: replace(MOTOR, parameters={"power": 1.0}), r"parameters: expected values of \['power', 'drag'\]"),
        (
            lambda: replace(MOTOR, parameters={"power": 1.0, "drg": 1.0}),
            r"parameters: expected values of \['power', 'drag'\]",
        ),
        (lambda: replace(MOTOR, frame="Body "), "frame: expected 'space' or 'body'.*did you mean 'body'"),
        (lambda: replace(MOTOR, body=-1), "body: expected a whole number from 0"),
        (lambda: replace(MOTOR, axes=[0, 0, 0, 2.0]), "axes: expected a quaternion of length 1"),
        (lambda: replace(MOTOR, axes=[0, 0, 1.0]), r"axes: expected shape \(4,\)"),
        (lambda: replace(MOTOR, length=0.0), "length: expected a positive"),
        (
            lambda: replace(MOTOR, length=1e200),
            "length: expected units in which what an ExpressionTorque gives is a number",
        ),
        (lambda: MOTOR.rescaled(mass=-2.0), "mass: expected a positive"),
        (lambda: MOTOR.rescaled(length=1e-200), "length: expected units in which"),
        (lambda: MOTOR.rotated(np.ones((3, 3))), "rotation: expected an orthogonal matrix"),
    ],
)
def test_what_is_no_formula_of_a_torque_is_refused_by_name(make: Any, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words):
        make()


def test_a_torque_needs_a_body() -> None:
    with pytest.raises(vv.InvalidInput, match="forces: expected rigid bodies in the scene for ExpressionTorque"):
        vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), MOTOR)
    with pytest.raises(vv.InvalidInput, match="body: expected one of the bodies brick, top, got 'tup'; did you mean"):
        replace(MOTOR, body="tup")._resolved(BODIES, PARTICLES)
    with pytest.raises(vv.InvalidInput, match="body: expected the index of a body outside a scene, got 'top'"):
        TORQUES[1]._core_arguments()
    with pytest.raises(vv.InvalidInput, match=r"torque: expected three numbers, got a function; .*ExpressionTorque"):
        vv.AppliedTorque(lambda t: [0, 0, t])  # type: ignore[arg-type]
