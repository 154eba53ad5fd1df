"""Forces on rigid bodies as values: names, other frames and units, compiled functions, and what is refused."""

import copy
import ctypes
import pickle
from dataclasses import replace

import numpy as np
import pytest

import visviva as vv

NUMBERS = ctypes.POINTER(ctypes.c_double)
PROTOTYPE = ctypes.CFUNCTYPE(None, ctypes.c_double, NUMBERS, NUMBERS, NUMBERS)


@PROTOTYPE
def motor(t, orientation, angular_velocity, torque):
    torque[0], torque[1], torque[2] = 0.0, 0.0, 1.0


FORCES = [
    vv.AppliedTorque([0.0, 1.0, 2.0]),
    vv.AppliedTorque([0.0, 1.0, 2.0], body="top", frame="body"),
    vv.RotationalDrag(0.25, body=1),
    vv.AttachedSpring("top", [0, 0, 1], 4.0, anchor=[1.0, 2.0, 3.0]),
    vv.AttachedSpring("top", [0, 0, 1], 4.0, length=1.0, damping=0.5, to="brick", to_point=[0, 1, 0]),
    vv.AttachedSpring(1, [0, 0, 1], 4.0, particle="moon"),
]
BODIES, PARTICLES = (("brick", "top"), 2), (("sun", "moon"), 2)


@pytest.mark.parametrize("force", FORCES, ids=repr)
def test_forces_on_bodies_are_values(force) -> None:
    for same in (pickle.loads(pickle.dumps(force)), copy.copy(force), replace(force), eval(repr(force), vars(vv) | {})):
        assert same == force
        assert hash(same) == hash(force)
    with pytest.raises(vv.FrozenAttribute):
        force.body = 0
    known = force._resolved(BODIES, PARTICLES)
    arguments = known._core_arguments()
    assert arguments["kind"] == type(force).kind
    assert not any(isinstance(value, str) for name, value in arguments.items() if name not in ("kind", "frame"))
    assert arguments["body"] == (None if force.body is None else 1)
    back = force.rescaled(length=4.0, mass=2.0, time=8.0)
    assert back != force
    assert back.rescaled(length=1 / 4, mass=1 / 2, time=1 / 8) == force
    assert force.rotated(np.eye(3)) == force
    assert force.shifted(np.zeros(3), np.zeros(3)) == force


def test_names_of_bodies_are_looked_up_in_the_scene() -> None:
    known = FORCES[4]._resolved(BODIES, PARTICLES)
    assert (known.body, known.to) == (1, 0)
    assert FORCES[5]._resolved(BODIES, PARTICLES).particle == 1
    for force, words in (
        (
            vv.RotationalDrag(1.0, body="tup"),
            "body: expected one of the bodies brick, top, got 'tup'; did you mean 'top'",
        ),
        (
            vv.RotationalDrag(1.0, body=2),
            "body: expected one of the 2 rigid bodies of the scene, counted from 0, got 2",
        ),
        (vv.AttachedSpring(0, [0, 0, 0], 1.0, particle=2), "particle: expected one of the 2 particles"),
        (vv.AttachedSpring("top", [0, 0, 0], 1.0, to=1), "to: expected another rigid body"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            force._resolved(BODIES, PARTICLES)
    with pytest.raises(vv.InvalidInput, match="particle: expected particles in the scene, which has none"):
        FORCES[5]._resolved(BODIES, ((), 0))
    for force in FORCES:
        with pytest.raises(
            vv.InvalidInput, match=f"forces: expected rigid bodies in the scene for {type(force).__name__}"
        ):
            vv.Scene(vv.Particles([1.0], [[0, 0, 0]]), force)
    with pytest.raises(vv.InvalidInput, match="body: expected the index of a body outside a scene, got 'top'"):
        FORCES[1]._core_arguments()


def test_forces_on_bodies_in_other_frames() -> None:
    mirror = np.diag([1.0, -1.0, 1.0])
    assert vv.AppliedTorque([1, 2, 3]).rotated(mirror).torque == (-1.0, 2.0, -3.0)
    assert vv.AppliedTorque([1, 2, 3], frame="body").rotated(mirror).torque == (1.0, 2.0, 3.0)
    spring = vv.AttachedSpring(0, [1, 2, 3], 1.0, anchor=[4, 5, 6])
    assert spring.rotated(mirror).anchor == (4.0, -5.0, 6.0)
    assert spring.rotated(mirror).point == (-1.0, -2.0, -3.0)
    assert spring.shifted(np.ones(3), np.zeros(3)).anchor == (5.0, 6.0, 7.0)
    assert spring.reversed() == spring
    assert vv.AppliedTorque([1, 2, 3]).reversed().torque == (1.0, 2.0, 3.0)
    for refused, words in (
        (lambda: spring.shifted(np.zeros(3), np.ones(3)), "velocity: AttachedSpring has a fixed anchor"),
        (lambda: replace(spring, damping=0.1).reversed(), "AttachedSpring cannot be reversed"),
        (lambda: vv.RotationalDrag(1.0).reversed(), "RotationalDrag cannot be reversed"),
        (lambda: vv.CompiledTorque(motor).reversed(), "CompiledTorque cannot be reversed"),
        (lambda: vv.CompiledTorque(motor).rotated(mirror), "CompiledTorque cannot be rotated"),
        (lambda: vv.CompiledTorque(motor).rescaled(mass=2.0), "CompiledTorque cannot be rescaled"),
        (lambda: vv.RotationalDrag(1.0).rescaled(mass=-2.0), "mass: expected a positive"),
        (lambda: vv.RotationalDrag(1.0).rescaled(length=1e200), "coefficient: expected units"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            refused()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: vv.AppliedTorque([1, 2]), r"torque: expected shape \(3,\)"),
        (lambda: vv.AppliedTorque([1, 2, np.nan]), "torque"),
        (
            lambda: vv.AppliedTorque([1, 2, 3], frame="Space "),
            "frame: expected 'space' or 'body'.*did you mean 'space'",
        ),
        (lambda: vv.AppliedTorque([1, 2, 3], body=-1), "body: expected a whole number from 0"),
        (lambda: vv.AppliedTorque([1, 2, 3], body=0.0), r"body: expected a whole number, got 0.0; pass int\(0.0\)"),
        (lambda: vv.RotationalDrag(-1.0), "coefficient: expected a number of at least 0"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0), "to: expected one of to, particle and anchor, got none"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0, to=1, anchor=[0, 0, 0]), "got to and anchor"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0, to=0), "to: expected another rigid body, got 0 at both ends"),
        (lambda: vv.AttachedSpring(None, [0, 0, 0], 1.0, to=0), "body: expected the index"),  # type: ignore[arg-type]
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0, particle=1, to_point=[0, 0, 1]), "to_point: expected none"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], -1.0, to=1), "stiffness"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0, length=-1.0, to=1), "length"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0, damping=-1.0, to=1), "damping"),
        (lambda: vv.AttachedSpring(0, [0, 0, 0], 1.0, anchor=[0, 0, np.inf]), "anchor"),
    ],
)
def test_what_is_no_force_on_a_body_is_refused_by_name(make, words: str) -> None:
    with pytest.raises(vv.InvalidInput, match=words):
        make()


def test_compiled_torques_are_what_they_say() -> None:
    numba = pytest.importorskip("numba")
    double = numba.types.CPointer(numba.float64)

    @numba.cfunc(numba.void(numba.float64, double, double, double))
    def compiled(t, orientation, angular_velocity, torque):
        torque[0] = t

    @numba.cfunc(numba.void(numba.float64, double, double))
    def short(t, y, rate):
        rate[0] = t

    torque = vv.CompiledTorque(compiled, body="top")
    assert torque._resolved(BODIES, PARTICLES)._core_arguments() == {
        "kind": "compiled_torque",
        "address": compiled.address,
        "body": 1,
    }
    address = ctypes.cast(motor, ctypes.c_void_p).value
    assert vv.CompiledTorque(motor).address == vv.CompiledTorque(address).address == address
    assert copy.deepcopy(torque) == torque == vv.CompiledTorque(compiled, body="top")
    with pytest.raises(vv.InvalidInput, match="cannot be pickled"):
        pickle.dumps(torque)
    for wrong, words in (
        (short, r"got void\(double,double\*,double\*\)"),
        (lambda *_: None, "got function; compile it with numba.cfunc"),
        (0, "expected the address"),
        (-8, "expected the address"),
        (None, "got NoneType"),
        (True, "got bool"),
        (ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(lambda x: x), r"got double\(double\)"),
    ):
        with pytest.raises(vv.InvalidInput, match=words):
            vv.CompiledTorque(wrong)


def test_no_class_is_derived_from_forces_on_bodies() -> None:
    with pytest.raises(vv.InvalidInput, match="CompiledTorque"):
        type("Mine", (vv.RotationalDrag,), {"__module__": "mine"})
