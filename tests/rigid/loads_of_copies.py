"""Scenes whose copies differ in what acts on their rigid bodies, with the values of each copy."""

from typing import Any

import numpy as np

import visviva as vv

COPIES = 11

PAIR = vv.RigidBodies(
    [1.0, 2.0],
    [[1.0, 2.0, 2.5], [1.0, 1.0, 1.5]],
    position=[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
    angular_velocity=[[0.1, 2.0, 0.0], [0.3, 0.5, 0.0]],
    names=["brick", "wheel"],
)
POINTS = vv.Particles(
    [0.5, 0.1], [[0.0, 3.0, 0.0], [1.0, -3.0, 0.0]], [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0]], names=["near", "far"]
)
TOP = vv.RigidBody(1.0, [0.25, 0.25, 0.5], pivot=[0.1, 0.0, -1.0], angular_velocity=[0.2, 0.1, 3.0], name="top")
WEIGHT = vv.UniformField([0.0, 0.0, -1.0])

TORQUE = vv.AppliedTorque([0.1, 0.2, -0.3])
IN_BODY = vv.AppliedTorque([0.1, 0.2, 0.3], body="brick", frame="body")
DRAG = vv.RotationalDrag(0.3)
ANCHORED = vv.AttachedSpring("brick", [0.2, 0, 0.5], stiffness=2.0, length=0.5, damping=0.1, anchor=[0, 0.5, 2.0])
TO_BODY = vv.AttachedSpring("brick", [0.2, 0, 0.5], stiffness=2.0, length=1.0, to="wheel", to_point=[0.1, 0.3, 0])
TO_POINT = vv.AttachedSpring("wheel", [0, 0.3, 0], stiffness=2.0, length=1.0, particle="near")


def numbers(rng: np.random.Generator, *, zeros: bool = False) -> np.ndarray:
    """Of every copy one, some of them 0."""
    found = rng.uniform(0.1, 2.0, COPIES)
    return np.where(np.arange(COPIES) % 3 == 1, 0.0, found) if zeros else found


def vectors(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform(-0.5, 0.5, (COPIES, 3))


RNG = np.random.default_rng(57)
CASES: dict[str, tuple[vv.Scene, dict[Any, dict[str, Any]]]] = {
    "torque": (vv.Scene(PAIR, TORQUE), {"AppliedTorque": {"torque": vectors(RNG)}}),
    "torque along a body": (vv.Scene(PAIR, IN_BODY), {IN_BODY: {"torque": vectors(RNG)}}),
    "torque on a top": (vv.Scene(TOP, WEIGHT, TORQUE), {TORQUE: {"torque": vectors(RNG)}}),
    "drag": (vv.Scene(PAIR, DRAG), {DRAG: {"coefficient": numbers(RNG)}}),
    "drag in some": (vv.Scene(PAIR, DRAG), {DRAG: {"coefficient": numbers(RNG, zeros=True)}}),
    "anchored spring": (
        vv.Scene(PAIR, ANCHORED),
        {
            ANCHORED: {
                "point": vectors(RNG),
                "stiffness": numbers(RNG),
                "length": numbers(RNG),
                "damping": numbers(RNG),
                "anchor": vectors(RNG) + np.array([0.0, 0.0, 3.0]),
            }
        },
    ),
    "damping in some": (vv.Scene(PAIR, ANCHORED), {ANCHORED: {"damping": numbers(RNG, zeros=True)}}),
    "stiffness in some": (vv.Scene(PAIR, TO_POINT, POINTS), {TO_POINT: {"stiffness": numbers(RNG, zeros=True)}}),
    "lengths of some": (vv.Scene(PAIR, TO_BODY), {TO_BODY: {"length": numbers(RNG, zeros=True)}}),
    "spring to a body": (
        vv.Scene(PAIR, TO_BODY),
        {TO_BODY: {"point": vectors(RNG), "to_point": vectors(RNG), "stiffness": numbers(RNG)}},
    ),
    "spring to a point": (
        vv.Scene(POINTS, PAIR, TO_POINT),
        {TO_POINT: {"point": vectors(RNG), "stiffness": numbers(RNG), "length": numbers(RNG)}},
    ),
    "several": (
        vv.Scene(POINTS, PAIR, vv.Gravity(0.3), vv.LinearDrag(2.0), IN_BODY, DRAG, TORQUE, ANCHORED, TO_BODY),
        {
            DRAG: {"coefficient": numbers(RNG, zeros=True)},
            "Gravity": {"G": numbers(RNG)},
            TORQUE: {"torque": vectors(RNG)},
            1: {"tau": numbers(RNG)},
            ANCHORED: {"damping": numbers(RNG, zeros=True), "stiffness": numbers(RNG)},
        },
    ),
}


def made_by_hand(scene: vv.Scene, parameters: dict[Any, dict[str, Any]], copy: int) -> vv.Scene:
    """The scene with the values of one copy, put together anew."""
    assert scene.rigid_bodies is not None
    parts: list[Any] = []
    given = {which: {name: each[copy] for name, each in named.items()} for which, named in parameters.items()}
    for place, force in enumerate(scene.forces):
        own = given.get(place, given.get(type(force).__name__, {}))
        parts.append(type(force)(**{**force._values(), **own}))
    for load in scene.body_forces:
        own = given.get(type(load).__name__, {})
        for which, named in given.items():
            if isinstance(which, type(load)) and vv.Scene(*bodies_of(scene), which).body_forces[0] == load:
                own = named
        parts.append(type(load)(**{**load._values(), **own}))
    return vv.Scene(*bodies_of(scene), *parts)


def bodies_of(scene: vv.Scene) -> list[Any]:
    free = len(scene.particles) - len(scene.rigid_bodies or ())
    return [*([scene.particles[:free]] if free else []), scene.rigid_bodies]


def with_method(how: dict[str, Any], scene: vv.Scene) -> dict[str, Any]:
    """Equal steps are of order eight, or, where something looks at velocities, of rk4."""
    dissipates = any(isinstance(load, vv.RotationalDrag) or getattr(load, "damping", 0.0) for load in scene.body_forces)
    return how | {"method": "rk4" if dissipates else "kahan_li8"} if "dt" in how else how
