"""Every argument of every rigid call refuses what it cannot be, by its own name.

The one idea: an argument is of a kind, and a kind has its wrong values. The table below gives each public call good
arguments and the kinds of all of them; a call or an argument that the table does not know fails here.
"""

import ctypes
import inspect
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import visviva as vv

NAN, INF = float("nan"), float("inf")
NO_NUMBER = ["one", "", b"1", 1j, {}, object(), [1.0, 2.0]]
NO_ARRAY = ["abc", object(), [["a"]], [[1.0], [1.0, 2.0]], [1j, 1j, 1j, 1j], {"a": 1.0}]
UNIT_TENSOR = np.eye(3)

# What an argument of a kind must not be. Shapes too long, too short, and of the wrong rank stand with the numbers.
WRONG: dict[str, list[Any]] = {
    "positive": [NAN, INF, -INF, -1.0, 0.0, -0.0, None, *NO_NUMBER],
    "not negative": [NAN, INF, -INF, -1.0, None, *NO_NUMBER],
    "number": [NAN, INF, -INF, None, *NO_NUMBER],
    "vector": [NAN, [NAN, 0.0, 0.0], [0.0, INF, 0.0], [1.0, 2.0], [1.0, 2.0, 3.0, 4.0], None, *NO_ARRAY],
    "numbers": [NAN, [0.0, NAN], [0.0, -INF], None, *NO_ARRAY],
    "masses": [[1.0, NAN], [1.0, -1.0], [INF, 1.0], [[1.0, 1.0]], None, *NO_ARRAY],
    "masses of a body": [[1.0, NAN], [1.0, -1.0], [0.0, 0.0], [INF, 1.0], [[1.0, 1.0]], None, *NO_ARRAY],
    "point of each": [[[NAN] * 3] * 2, [[0.0, 0.0]] * 2, [0.0, 0.0, 0.0], [[0.0, 0.0, 0.0]] * 3, None, *NO_ARRAY],
    # A row of NaN is a free body.
    "pivot of each": [[[NAN, 0.0, 0.0]] * 2, [[0.0, 0.0]] * 2, [0.0, 0.0, 0.0], [[0.0, 0.0, 0.0]] * 3, *NO_ARRAY],
    "corners": [[[NAN] * 3] * 4, [[0.0, 0.0]] * 4, [[0.0, 0.0, 0.0]] * 3, [[0.0, 0.0, 0.0]] * 5, None, *NO_ARRAY],
    "vertices": [[[NAN] * 3] * 4, [[0.0, 0.0]] * 4, [0.0, 0.0, 0.0], None, *NO_ARRAY],
    "faces": [[[0, 1]], [[0, 1, 4]], [[-1, 1, 2]], [[0, 0, 1]], [[0.5, 1.0, 2.0]], [0, 1, 2], None, *NO_ARRAY],
    "quaternion": [[0.0] * 4, [0.0, 0.0, 0.0, 1.1], [NAN, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 1.0, None, *NO_ARRAY],
    "axes": ["here", 1.0, np.zeros(3)],
    "moments": [
        [1.0, 2.0, 3.1],
        [0.0, 0.0, 0.0],
        [-1.0, 1.0, 1.0],
        [NAN, 1.0, 1.0],
        [INF, INF, 1.0],
        [1.0, 1.0],
        [1.0] * 4,
        None,
        *NO_ARRAY,
    ],
    "two equal moments": [[1.0, 2.0, 2.5], [1.0, 1.0, 1.0], [1.0, 1.0, 2.1], [1.0, 1.0], None, *NO_ARRAY],
    "turning": [[0.0, 0.0, 0.0], [NAN, 0.0, 1.0], [1.0, 2.0], None, *NO_ARRAY],
    "inertia": [
        np.diag([1.0, 2.0, 3.1]),
        np.diag([-1.0, 1.0, 1.0]),
        UNIT_TENSOR + np.eye(3, k=1),
        np.full((3, 3), NAN),
        np.eye(2),
        [1.0, 1.0, 1.0],
        None,
        *NO_ARRAY,
    ],
    "tensor": [
        UNIT_TENSOR + np.eye(3, k=1),
        np.full((3, 3), NAN),
        np.full((3, 3), INF),
        np.eye(2),
        1.0,
        None,
        *NO_ARRAY,
    ],
    "rotation matrix": [
        -UNIT_TENSOR,
        2.0 * UNIT_TENSOR,
        UNIT_TENSOR + 0.01,
        np.full((3, 3), NAN),
        np.eye(2),
        [1.0, 0.0, 0.0],
        None,
        *NO_ARRAY,
    ],
    "convention": ["ZZX", "ZX", "ZXZX", "abc", "zXZ", "", 3, None, ["Z", "X", "Z"]],
    "frame": ["bodies", "", 1, None, ["body"]],
    "switch": ["yes", 2, None, [True]],
    "not zero": [NAN, INF, -INF, 0.0, None, *NO_NUMBER],
    "polar angles": [NAN, INF, -0.1, 3.2, [0.5, -0.1], None, *NO_ARRAY],
    "polar angle": [NAN, INF, -0.1, 3.2, None, *NO_NUMBER],
    "upright angle": [NAN, INF, None, *NO_NUMBER],
    "body": [7, -3, 0.5, "nobody", [0], object()],
    "particle": [7, -3, 0.5, "nobody", [0], object()],
    "function": [1.5, "name", lambda t: t, object(), None],
    "rotation": [1.0, "x", None, [0.0, 0.0, 0.0, 1.0]],
    "bodies": [[], (), None, 1.0, [1.0], "ab", [None]],
    "part": [NAN, INF, -0.1, 1.1, None, *NO_NUMBER],
    "count": [0, -1, 1.5, NAN, None, *NO_NUMBER],
    "path": [None, 1.5, ["a"]],
    "name": [1, 2.5, ["a"], "", object()],
    "values by name": [1.5, "name", [1.0], {}, {"t": 1.0}, {2: 1.0}, object(), None],
    "names": ["ab", ["a"], ["a", "a"], ["a", 1], 3, ["a", ""]],
}


def optional(kind: str) -> tuple[str, ...]:
    return (kind, "or none")


BODY = {"mass": 2.0, "moments": [1.0, 2.0, 2.5]}
TWO = {"mass": [2.0, 1.0], "moments": [[1.0, 2.0, 2.5]] * 2}
TOP = vv.rigid.HeavyTop(1.0, 0.5, 1.0, 9.81, 0.3)
SOLID = vv.rigid.box(1.0, 1.0, 2.0, 3.0)
POLHODE = vv.rigid.polhode([1.0, 2.0, 3.0], [0.1, 1.0, 0.2])
FREE = vv.rigid.free_rotation([1.0, 2.0, 2.5], [0.1, 1.0, 0.1], [0.0, 1.0])
TETRAHEDRON = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
LENGTHS = {"a": (1.0, "positive"), "b": (2.0, "positive"), "c": (3.0, "positive")}
MASS, RADIUS, HEIGHT = (1.0, "positive"), (1.0, "positive"), (2.0, "positive")
SHELL = (False, "switch")
ROTATION = {"moments": ([1.0, 2.0, 2.5], "moments"), "angular_velocity": ([0.1, 1.0, 0.1], "vector")}
UNIT = ([0.0, 0.0, 0.6, 0.8], "quaternion")
VECTOR = ([1.0, 2.0, 3.0], "vector")
CONVENTION, FRAME = ("ZXZ", "convention"), ("body", "frame")
START = {
    "theta": (0.5, "polar angle"),
    "psi_dot": (20.0, "number"),
    "theta_dot": (0.0, "number"),
    "phi_dot": (0.0, "number"),
}

COMPILED = ctypes.CFUNCTYPE(None, ctypes.c_double, *3 * [ctypes.POINTER(ctypes.c_double)])(lambda *_: None)

Argument = tuple[Any, "str | tuple[str, ...]"]

# Every public call: a good value and the kind of each of its arguments.
CALLS: dict[str, tuple[Callable[..., Any], dict[str, Argument]]] = {
    "HeavyTop": (
        vv.rigid.HeavyTop,
        {"A": MASS, "C": (0.5, "positive"), "mass": MASS, "g": MASS, "R": MASS},
    ),
    "HeavyTop.weak_torque_precession": (TOP.weak_torque_precession, {"spin": (30.0, "not zero")}),
    "HeavyTop.momenta": (
        TOP.momenta,
        {"theta": (0.5, "polar angle"), "psi_dot": (20.0, "number"), "phi_dot": (0.0, "number")},
    ),
    "HeavyTop.effective_potential": (
        TOP.effective_potential,
        {"theta": ([0.5, 1.0], "polar angles"), "p_phi": (1.0, "number"), "p_psi": (2.0, "number")},
    ),
    "HeavyTop.least_spin": (TOP.least_spin, {"theta": (0.5, "polar angle")}),
    "HeavyTop.nutation": (TOP.nutation, START),
    "HeavyTop.nutation_range": (TOP.nutation_range, START),
    "HeavyTop.nutation_frequency": (
        TOP.nutation_frequency,
        {"theta": (0.5, "polar angle"), "spin": (30.0, "number")},
    ),
    "HeavyTop.steady_precession": (
        TOP.steady_precession,
        {"theta": (0.5, "polar angle"), "spin": (30.0, "number")},
    ),
    "HeavyTop.solve": (
        TOP.solve,
        {"t": ([0.0, 1.0], "numbers"), **START, "phi": (0.0, "number"), "psi": (0.0, "number")},
    ),
    "TopMotion.plot": (
        TOP.solve([0.0, 0.1], theta=0.5, psi_dot=20.0).plot,
        {"kind": ("theta", "frame"), "ax": (None, optional("axes"))},
    ),
    "FreeRotation.plot": (FREE.plot, {"kind": ("axes", "frame"), "ax": (None, optional("axes"))}),
    "Polhode.plot": (POLHODE.plot, {"ax": (None, optional("axes"))}),
    "FreeRotation.animate": (
        FREE.animate,
        {
            "path": (None, optional("path")),
            "plane": ("xy", optional("frame")),
            "trail": (0.5, "part"),
            "frames": (2, "count"),
            "fps": (25, "count"),
        },
    ),
    "MassProperties": (
        vv.rigid.MassProperties,
        {"mass": MASS, "center": ([0.0, 0.0, 0.0], "vector"), "tensor": (UNIT_TENSOR, "tensor")},
    ),
    "MassProperties.about": (SOLID.about, {"point": VECTOR}),
    "MassProperties.moved": (SOLID.moved, {"offset": VECTOR}),
    "MassProperties.rotated": (SOLID.rotated, {"quaternion": UNIT}),
    "MassProperties.principal_axes": (SOLID.principal_axes, {}),
    "angular_velocity_from_euler": (
        vv.rigid.angular_velocity_from_euler,
        {"angles": VECTOR, "rates": VECTOR, "frame": FRAME, "convention": CONVENTION},
    ),
    "euler_rates": (
        vv.rigid.euler_rates,
        {"angles": VECTOR, "angular_velocity": VECTOR, "frame": FRAME, "convention": CONVENTION},
    ),
    "euler_angles": (vv.rigid.euler_angles, {"quaternion": UNIT, "convention": CONVENTION}),
    "quaternion_from_euler": (vv.rigid.quaternion_from_euler, {"angles": VECTOR, "convention": CONVENTION}),
    "box": (vv.rigid.box, {"mass": MASS, **LENGTHS, "shell": SHELL}),
    "ellipsoid": (vv.rigid.ellipsoid, {"mass": MASS, **LENGTHS, "shell": SHELL}),
    "plate": (vv.rigid.plate, {"mass": MASS, "a": RADIUS, "b": RADIUS}),
    "rod": (vv.rigid.rod, {"mass": MASS, "length": HEIGHT}),
    "disc": (vv.rigid.disc, {"mass": MASS, "radius": RADIUS, "inner_radius": (0.5, "not negative")}),
    "sphere": (vv.rigid.sphere, {"mass": MASS, "radius": RADIUS, "inner_radius": (0.5, "not negative")}),
    "hemisphere": (vv.rigid.hemisphere, {"mass": MASS, "radius": RADIUS, "shell": SHELL}),
    "capsule": (vv.rigid.capsule, {"mass": MASS, "radius": RADIUS, "height": (2.0, "not negative"), "shell": SHELL}),
    "cone": (vv.rigid.cone, {"mass": MASS, "radius": RADIUS, "height": HEIGHT, "shell": SHELL}),
    "cylinder": (
        vv.rigid.cylinder,
        {"mass": MASS, "radius": RADIUS, "height": HEIGHT, "inner_radius": (0.5, "not negative"), "shell": SHELL},
    ),
    "torus": (
        vv.rigid.torus,
        {"mass": MASS, "major_radius": (2.0, "positive"), "minor_radius": (0.5, "positive"), "shell": SHELL},
    ),
    "tetrahedron": (vv.rigid.tetrahedron, {"mass": MASS, "vertices": (TETRAHEDRON, "corners"), "shell": SHELL}),
    "mesh": (
        vv.rigid.mesh,
        {
            "vertices": (TETRAHEDRON, "vertices"),
            "faces": ([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "faces"),
            "mass": (1.0, optional("positive")),
            "density": (None, optional("positive")),
        },
    ),
    "load_mesh": (vv.rigid.load_mesh, {"path": (None, "path")}),
    "composite": (vv.rigid.composite, {"bodies": ([SOLID, SOLID], "bodies")}),
    "particles": (
        vv.rigid.particles,
        {"mass": ([1.0, 2.0], "masses of a body"), "position": ([[0.0, 0.0, 1.0]] * 2, "point of each")},
    ),
    "inertia_tensor": (
        vv.rigid.inertia_tensor,
        {"mass": ([1.0, 2.0], "masses"), "position": ([[0.0, 0.0, 1.0]] * 2, "point of each")},
    ),
    "parallel_axis": (vv.rigid.parallel_axis, {"tensor": (UNIT_TENSOR, "tensor"), "mass": MASS, "offset": VECTOR}),
    "principal_axes": (vv.rigid.principal_axes, {"tensor": (UNIT_TENSOR, "inertia")}),
    "rotate_tensor": (vv.rigid.rotate_tensor, {"tensor": (UNIT_TENSOR, "tensor"), "quaternion": UNIT}),
    "free_rotation": (
        vv.rigid.free_rotation,
        {**ROTATION, "t": ([0.0, 1.0], "numbers"), "orientation": (UNIT[0], optional("quaternion"))},
    ),
    "flip_time": (vv.rigid.flip_time, ROTATION),
    "period": (vv.rigid.period, ROTATION),
    "polhode": (vv.rigid.polhode, ROTATION),
    "precession_rate": (vv.rigid.precession_rate, ROTATION),
    "from_scipy": (vv.rigid.from_scipy, {"rotation": (None, "rotation")}),
    "to_scipy": (vv.rigid.to_scipy, {"quaternion": UNIT}),
    "matrix": (vv.rigid.matrix, {"quaternion": UNIT}),
    "rotation_vector": (vv.rigid.rotation_vector, {"quaternion": UNIT}),
    "quaternion_from_matrix": (vv.rigid.quaternion_from_matrix, {"matrix": (UNIT_TENSOR, "rotation matrix")}),
    "quaternion_from_rotation_vector": (vv.rigid.quaternion_from_rotation_vector, {"rotation_vector": VECTOR}),
    "quaternion_product": (vv.rigid.quaternion_product, {"a": UNIT, "b": UNIT}),
    "slerp": (
        vv.rigid.slerp,
        {"start": UNIT, "end": ([0.0, 0.0, 0.0, 1.0], "quaternion"), "fraction": ([0.0, 0.5], "numbers")},
    ),
    "cone_angles": (
        vv.rigid.cone_angles,
        {"moments": ([2.0, 2.0, 3.0], "two equal moments"), "angular_velocity": ([0.1, 0.0, 1.0], "turning")},
    ),
    "rotate": (vv.rigid.rotate, {"quaternion": UNIT, "vector": VECTOR}),
    "rotate_back": (vv.rigid.rotate_back, {"quaternion": UNIT, "vector": VECTOR}),
    "screw_axis": (vv.rigid.screw_axis, {"velocity": VECTOR, "angular_velocity": VECTOR, "about": VECTOR}),
    "velocity_at": (
        vv.rigid.velocity_at,
        {"point": VECTOR, "velocity": VECTOR, "angular_velocity": VECTOR, "about": VECTOR},
    ),
    "methods": (vv.rigid.methods, {}),
    "RigidBody": (
        vv.RigidBody,
        {
            "mass": MASS,
            "moments": ([1.0, 2.0, 2.5], optional("moments")),
            "inertia": (None, optional("inertia")),
            "position": VECTOR,
            "velocity": VECTOR,
            "orientation": UNIT,
            "angular_velocity": VECTOR,
            "pivot": (None, optional("vector")),
            "name": (None, optional("name")),
        },
    ),
    "RigidBodies": (
        vv.RigidBodies,
        {
            "mass": (TWO["mass"], "masses of a body"),
            "moments": (TWO["moments"], optional("moments")),
            "inertia": (None, optional("inertia")),
            "position": (None, optional("point of each")),
            "velocity": (None, optional("point of each")),
            "orientation": (None, optional("quaternion")),
            "angular_velocity": (None, optional("point of each")),
            "pivot": (None, optional("pivot of each")),
            "names": (None, optional("names")),
        },
    ),
}

# Forces are made without a scene: which body they mean is asked when they meet one.
FORCES: dict[str, tuple[Callable[..., Any], dict[str, Argument]]] = {
    "AppliedTorque": (
        vv.AppliedTorque,
        {"torque": VECTOR, "body": (0, optional("body")), "frame": ("space", "frame")},
    ),
    "RotationalDrag": (vv.RotationalDrag, {"coefficient": (1.0, "not negative"), "body": (0, optional("body"))}),
    "CompiledTorque": (vv.CompiledTorque, {"function": (COMPILED, "function"), "body": (0, optional("body"))}),
    "ExpressionTorque": (
        vv.ExpressionTorque,
        {
            "function": (lambda t, q, w, k: (0, 0, k * t), "function"),
            "body": (0, optional("body")),
            "frame": ("space", "frame"),
            "parameters": ({"k": 2.0}, "values by name"),
            "axes": ([0.0, 0.0, 0.0, 1.0], "quaternion"),
            "length": (1.0, "positive"),
            "mass": (1.0, "positive"),
            "time": (1.0, "positive"),
        },
    ),
    "AttachedSpring": (
        vv.AttachedSpring,
        {
            "body": (0, "body"),
            "point": VECTOR,
            "stiffness": (1.0, "not negative"),
            "length": (0.5, "not negative"),
            "damping": (0.1, "not negative"),
            "to": (1, optional("body")),
            "to_point": VECTOR,
            "particle": (None, optional("particle")),
            "anchor": (None, optional("vector")),
        },
    ),
}

# What results are made of, and what the forces on bodies have in common; nobody makes them by hand.
RESULTS = {
    "BodyForce",
    "ConeAngles",
    "FreeRotation",
    "Nutation",
    "Polhode",
    "PrincipalAxes",
    "ScrewAxis",
    "SteadyPrecession",
    "TopMomenta",
    "TopMotion",
}


def cases() -> Iterator[Any]:
    for name, (_, arguments) in (CALLS | FORCES).items():
        for argument, (_, kinds) in arguments.items():
            kind, none = (kinds, False) if isinstance(kinds, str) else (kinds[0], True)
            for number, value in enumerate(WRONG[kind]):
                if not (none and value is None):
                    yield pytest.param(name, argument, value, id=f"{name}-{argument}-{number}")


def test_the_table_is_whole() -> None:
    for name in vv.rigid.__all__:
        part = getattr(vv.rigid, name)
        if isinstance(part, type) and part is not vv.rigid.BodyForce:  # its methods are asked of the forces
            methods = {f"{name}.{m}" for m, f in vars(part).items() if not m.startswith("_") and callable(f)}
            assert methods <= CALLS.keys(), methods - CALLS.keys()
        if name not in RESULTS:
            assert name in CALLS, name
    for name, (call, arguments) in (CALLS | FORCES).items():
        assert set(inspect.signature(call).parameters) == set(arguments), name


@pytest.mark.parametrize("name", [name for name in CALLS if name not in ("load_mesh", "from_scipy")])
def test_good_arguments_are_taken(name: str) -> None:
    call, arguments = CALLS[name]
    call(**{argument: value for argument, (value, _) in arguments.items()})


@pytest.mark.parametrize(("name", "argument", "value"), list(cases()))
def test_a_wrong_value_is_refused_by_its_name(name: str, argument: str, value: Any) -> None:
    call, arguments = (CALLS | FORCES)[name]
    good = {other: given for other, (given, _) in arguments.items()}
    if argument == "inertia":
        good["moments"] = None
    if argument == "density":
        good["mass"] = None
    if argument in ("particle", "anchor"):
        good |= {"to": None, "to_point": [0.0, 0.0, 0.0]}
    with pytest.raises(vv.InvalidInput) as refused:
        made = call(**good | {argument: value})
        if name in FORCES:  # a number or a name of a body is looked up in the scene
            bodies = vv.RigidBodies(**TWO)
            particles = vv.Particles([1.0], [[9.0, 9.0, 9.0]], [[0.0, 0.0, 0.0]])
            vv.Scene(particles, bodies, made).plan(t=[0.0, 1.0])
    assert refused.value.argument == argument, str(refused.value)
