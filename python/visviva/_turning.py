"""Rigid bodies among the parts of a scene: as points with mass, as the core is told of them, and in files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._rigid_arguments import refuse_on_rods
from visviva.errors import InvalidInput
from visviva.particles import Particles
from visviva.rigid._orientation import rotate, rotate_back
from visviva.rigid_bodies import RigidBodies
from visviva.rigid_forces import AppliedTorque, RotationalDrag
from visviva.rigid_springs import AttachedSpring

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva import _core
    from visviva._body_force import BodyForce
    from visviva.scene import Scene

__all__ = [
    "centers_of_turned",
    "described",
    "held_centers",
    "joined_bodies",
    "kept_by_bodies",
    "loads_of_copies_from_file",
    "no_bodies",
    "rigid_for_file",
    "rigid_from_file",
    "spin_scale",
    "with_centers",
]


def joined_bodies(parts: Sequence[RigidBodies]) -> RigidBodies:
    """The rigid bodies of several parts of a scene, in their order."""
    if len(parts) == 1:
        return parts[0]

    def all_of(name: str, missing: Any) -> Any:
        arrays = [getattr(part, name) for part in parts]
        if all(array is None for array in arrays):
            return None
        return np.concatenate([missing(part) if a is None else a for part, a in zip(parts, arrays, strict=True)])

    by_moments = all(part.inertia is None for part in parts)
    names: list[str] = []
    for part in parts:
        names.extend(part.names or (f"body {len(names) + place}" for place in range(len(part))))
    return RigidBodies(
        all_of("mass", None),
        moments=all_of("moments", None) if by_moments else None,
        inertia=None if by_moments else all_of("inertia", lambda part: np.apply_along_axis(np.diag, -1, part.moments)),
        pivot=all_of("pivot", lambda part: np.full((len(part), 3), np.nan)),
        names=names if any(part.names for part in parts) else None,
        **{name: all_of(name, None) for name in ("position", "velocity", "orientation", "angular_velocity")},
    )


def described(rigid: RigidBodies, loads: Sequence[BodyForce]) -> _core._Rigid:
    """What the core is told of one copy, an axis over copies leading."""
    refuse_on_rods(rigid, loads)
    return {
        "moments": rigid.principal_moments[None],
        "axes": rigid.axes[None],
        "center": rigid.center[None],
        "pivoted": rigid.pivoted.tolist(),
        "orientation": rigid.orientation[None],
        "angular_velocity": rigid.angular_velocity[None],
        "loads": [load._core_arguments() for load in loads],
        "own_loads": None,
    }


def with_centers(found: Sequence[Particles], bodies: RigidBodies, names: Sequence[str] | None = None) -> Particles:
    """The particles, if there are some, and after them the centers of mass of rigid bodies."""
    count = len(found[0]) if found else 0
    if not names and (bodies.names or (found and found[0].names)):
        first = found[0].names if found and found[0].names else [f"particle {place}" for place in range(count)]
        names = (*first, *(bodies.names or [f"body {place}" for place in range(len(bodies))]))
    own = {name: getattr(bodies, name) for name in ("mass", "position", "velocity")}
    arrays = {name: np.concatenate([*(getattr(part, name) for part in found), array]) for name, array in own.items()}
    radius = np.concatenate([*(part.radius for part in found), np.zeros(len(bodies))])
    return Particles(**arrays, names=names or None, radius=radius)


def centers_of_turned(
    rigid: RigidBodies | None, points: Particles, turning: dict[str, ArrayLike], *, given: frozenset[str]
) -> Particles:
    """The points of a scene whose rigid bodies are turned: held ones stay, and what moves with a spin has that of now.

    What is in `given`, positions or velocities, is as it is.
    """
    if rigid is None:
        raise no_bodies(next(iter(turning)))
    turned = rigid._changed(**turning)
    own: dict[str, NDArray[np.float64]] = {}
    if "position" not in given:
        own["position"] = held_centers(rigid, turned.orientation, points.position[-len(rigid) :])
    if "velocity" not in given:
        own["velocity"] = turned.velocity
    return points._changed(**{n: np.concatenate([getattr(points, n)[: -len(rigid)], a]) for n, a in own.items()})


def held_centers(rigid: RigidBodies, turns: NDArray[np.float64], centers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Centers (…, K, 3) of bodies turned so (…, K, 4), those with a fixed point where that stays in space."""
    if rigid.pivot is None:
        return centers
    # A body whose orientation is its own stays where it is, to the bit.
    same = (turns == rigid.orientation).all(axis=-1)
    moved = rigid.pivoted & ~same
    arms = rotate(turns, np.broadcast_to(np.nan_to_num(rigid.pivot), centers.shape))
    return np.where(moved[..., None], rigid.fixed_point - arms, centers)


def no_bodies(name: str) -> InvalidInput:
    return InvalidInput(name, "expected None: the scene has no rigid bodies")


def kept_by_bodies(rigid: _core._Rigid, kept: dict[str, bool]) -> dict[str, bool]:
    """What of the invariants is left where points of the rigid bodies of a copy are held, and forces act on them."""
    springs = [load for load in rigid["loads"] if load["kind"] == AttachedSpring.kind]
    others = len(springs) < len(rigid["loads"])
    held = any(rigid["pivoted"]) or any(spring["anchor"] is not None for spring in springs)
    lossless = not others and not any(spring["damping"] for spring in springs)
    turns = kept["angular_momentum"] and not held and not others
    return {
        "energy": kept["energy"] and lossless,
        "momentum": kept["momentum"] and not held,
        "angular_momentum": turns,
        "spin": kept["spin"] and not held and not others,
    }


def spin_scale(scene: Scene) -> float:
    """The sum of the sizes of angular momenta about centers, or about points that are held."""
    rigid = scene.rigid_bodies
    if rigid is None:
        return 0.0
    spin = rotate_back(rigid.axes, rigid.angular_velocity)
    return float(np.linalg.norm(rigid.principal_moments * spin, axis=-1).sum())


def rigid_for_file(scene: Scene, told: _core._Rigid | None) -> tuple[dict[str, Any], dict[str, NDArray[np.float64]]]:
    """What a file keeps of rigid bodies and of what the core was told of them: for its header, and arrays by name.

    Raises
    ------
    InvalidInput
        For a torque that is a compiled function.
    """
    rigid = scene.rigid_bodies
    if rigid is None or told is None:
        return {}, {}
    if any("address" in load for load in told["loads"]):
        raise InvalidInput("run", "a CompiledTorque is at its address in this process only: such a run cannot be saved")
    own = {name: getattr(rigid, name) for name in ("moments", "inertia", "pivot")}
    header: dict[str, Any] = {"forces": told["loads"], "names": rigid.names}
    if told["own_loads"] is not None:
        header["own_forces"] = told["own_loads"]
    return {"rigid": header}, {f"rigid/{n}": a for n, a in own.items() if a is not None}


def rigid_from_file(
    header: dict[str, Any], arrays: dict[str, NDArray[np.float64]], points: Particles
) -> tuple[list[Any], list[BodyForce]]:
    """The particles and the rigid bodies, and the forces on these, of a file whose points are all of them."""
    if "rigid" not in header:
        return [points], []
    turning = {name: arrays[f"rigid/{name}"][0] for name in ("orientation", "angular_velocity")}
    own: dict[str, Any] = {name: arrays.get(f"rigid/{name}") for name in ("moments", "inertia", "pivot")}
    # Where copies have their own, masses and states are those of the first, and so is what belongs to them.
    of_copies = {
        name: arrays[f"rigid/own_{name}"][0] for name in ("moments", "inertia") if f"rigid/own_{name}" in arrays
    }
    if of_copies:
        own |= {"moments": None, "inertia": None} | of_copies
    count = len(turning["orientation"])
    centers = {name: getattr(points, name)[-count:] for name in ("mass", "position", "velocity")}
    names = header["rigid"]["names"] or points.names[len(points) - count :] or None
    bodies = RigidBodies(**centers, **own, **turning, names=names)
    free = len(points) - count
    return [*([points[:free]] if free else []), bodies], [*_loads_from_file(header["rigid"]["forces"])]


def loads_of_copies_from_file(header: dict[str, Any]) -> tuple[tuple[BodyForce, ...], ...] | None:
    """The forces on rigid bodies of each copy of a file; None where they are the same in all."""
    own = header.get("rigid", {}).get("own_forces")
    if own is None:
        return None
    sets = [_loads_from_file(descriptions) for descriptions in own[0]]
    return tuple(sets[which] for which in own[1])


def _loads_from_file(descriptions: list[dict[str, Any]]) -> tuple[BodyForce, ...]:
    from visviva.expression_torque import ExpressionTorque

    known = (AppliedTorque, RotationalDrag, AttachedSpring, ExpressionTorque)
    kinds: dict[str, Any] = {kind.kind: kind for kind in known}
    return tuple(
        kinds[each["kind"]](**{name: value for name, value in each.items() if name != "kind"}) for each in descriptions
    )
