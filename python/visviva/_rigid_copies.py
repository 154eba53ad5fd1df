"""Rigid bodies of ensemble members: how they turn, and what they are made of, with an axis over the copies.

The one idea: the bodies of all copies, one after another, are `RigidBodies` like any, which check them and find their
principal axes; so a copy has the numbers that it has alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva._arrays import float_array, read_only
from visviva._names import body_label
from visviva._own_loads import described_loads
from visviva._rigid_arguments import refuse_on_rods, unit_quaternions
from visviva._turning import held_centers, no_bodies
from visviva.errors import InvalidInput
from visviva.rigid._arguments import checked_rows
from visviva.rigid._orientation import rotate
from visviva.rigid_bodies import IS_ROUNDED, RigidBodies

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from visviva import _core
    from visviva._body_force import BodyForce
    from visviva.scene import Scene

__all__ = ["checked_inertia", "checked_turning", "core_rigid_of_copies", "inertia_of_one", "turning_of_copies"]


def checked_turning(
    scene: Scene, orientation: ArrayLike | None, angular_velocity: ArrayLike | None
) -> dict[str, NDArray[np.float64]]:
    """What is given of rigid bodies, checked: quaternions (B, K, 4) and angular velocities (B, K, 3)."""
    rigid, given = scene.rigid_bodies, {}
    for name, value in (("orientation", orientation), ("angular_velocity", angular_velocity)):
        if value is None:
            continue
        if rigid is None:
            raise no_bodies(name)
        width = 4 if name == "orientation" else 3
        given[name] = float_array(name, value, ("B", len(rigid), width))
    if rigid is not None and "orientation" in given:
        turns = checked_rows("orientation", given["orientation"], (4,))
        given["orientation"] = unit_quaternions(turns.reshape(-1, 4), ()).reshape(turns.shape)
    return given


def checked_inertia(
    scene: Scene, moments: ArrayLike | None, inertia: ArrayLike | None
) -> dict[str, NDArray[np.float64]]:
    """What is given of the moments of rigid bodies: of `moments` (B, K, 3) and `inertia` (B, K, 3, 3) one or neither.

    Raises
    ------
    InvalidInput
        For both, another shape, or a scene without rigid bodies.
    """
    given = {name: value for name, value in (("moments", moments), ("inertia", inertia)) if value is not None}
    if len(given) > 1:
        raise InvalidInput("moments", "expected moments or inertia of the rigid bodies, got both")
    if not given:
        return {}
    ((name, value),) = given.items()
    if scene.rigid_bodies is None:
        raise no_bodies(name)
    axes = (3,) if name == "moments" else (3, 3)
    return {name: read_only(float_array(name, value, ("B", len(scene.rigid_bodies), *axes)), value)}


def inertia_of_one(own: dict[str, Any]) -> dict[str, Any]:
    """What rigid bodies of one copy are made with, in place of what those of the scene are."""
    return {"moments": None, "inertia": None, **own} if own else {}


def _made_of_their_own(
    rigid: RigidBodies,
    own: dict[str, NDArray[np.float64]],
    masses: NDArray[np.float64],
    spins: NDArray[np.float64],
) -> RigidBodies:
    """The bodies of all copies, one after another, that have these moments or tensors."""
    copies, number = masses.shape
    if not masses.all():
        copy, body = np.argwhere(masses == 0.0)[0]
        raise InvalidInput(
            "mass",
            f"expected positive masses of rigid bodies, but that of {body_label(body, rigid.names)} of copy "
            f"{copy} is 0.0",
        )
    return RigidBodies(
        masses.ravel(),
        **{name: values.reshape(copies * number, *values.shape[2:]) for name, values in own.items()},
        angular_velocity=spins.reshape(-1, 3),
        pivot=None if rigid.pivot is None else np.tile(rigid.pivot, (copies, 1)),
        names=[f"{body_label(body, rigid.names)} of copy {copy}" for copy in range(copies) for body in range(number)],
    )


def _refuse_on_rods_of_copies(
    scene: Scene, rigid: RigidBodies, bodies: RigidBodies | None, loads: Sequence[tuple[BodyForce, ...]] | None
) -> None:
    """Refuse what would turn rods about their own axes, where copies have bodies or forces of their own."""
    number = len(rigid)
    if not scene.body_forces:
        return
    if bodies is not None:
        # Rods are few: what does not turn them is asked copy by copy.
        for copy in np.unique(np.flatnonzero((bodies.principal_moments == 0.0).any(axis=-1)) // number).tolist():
            refuse_on_rods(bodies[copy * number : (copy + 1) * number], loads[copy] if loads else scene.body_forces)
    elif loads and not rigid.principal_moments.all():
        for copy, own in enumerate(loads):
            if copy and own is loads[copy - 1]:
                continue
            try:
                refuse_on_rods(rigid, own)
            except InvalidInput as error:
                raise InvalidInput("parameters", f"of copy {copy}: {error}") from error


def _principal_of_copies(rigid: RigidBodies, bodies: RigidBodies) -> dict[str, NDArray[np.float64]]:
    """Principal moments, axes and centers as the core takes them, an axis over the copies leading."""
    number = len(rigid)
    found = {"moments": bodies.principal_moments, "axes": bodies.axes, "center": bodies.center}
    return {name: each.reshape(-1, number, each.shape[-1]) for name, each in found.items()}


def core_rigid_of_copies(
    scene: Scene,
    count: int,
    loads: Sequence[tuple[BodyForce, ...]] | None,
    turning: dict[str, NDArray[np.float64]],
    own: dict[str, NDArray[np.float64]],
    full: dict[str, NDArray[np.float64]],
    *,
    given: frozenset[str],
) -> _core._Rigid | None:
    """What the core is told of the rigid bodies of all copies, on which these forces act, or those of the scene.

    Held points stay, unless bodies are moved.
    """
    described = scene._keywords["rigid"]
    rigid = scene.rigid_bodies
    if described is None or rigid is None:
        return None
    masses = full["mass"][:, -len(rigid) :]
    if not own and (masses != rigid.mass).any():
        raise InvalidInput(
            "mass",
            "expected the masses of rigid bodies as they are, or moments=… (or inertia=…) beside them: the moments "
            "belong to the masses",
        )
    core_rigid: _core._Rigid = described.copy()
    if loads:
        core_rigid["loads"], core_rigid["own_loads"] = described_loads(loads)
    arrays: Any = core_rigid
    bodies = None
    if own:
        spins = np.broadcast_to(turning.get("angular_velocity", rigid.angular_velocity), (count, len(rigid), 3))
        bodies = _made_of_their_own(rigid, own, masses, spins)
        arrays |= _principal_of_copies(rigid, bodies)
    _refuse_on_rods_of_copies(scene, rigid, bodies, loads)
    for name in ("moments", "axes", "center", "orientation", "angular_velocity"):
        each = turning.get(name, arrays[name])
        arrays[name] = np.ascontiguousarray(np.broadcast_to(each, (count, *each.shape[1:])))
    if rigid.pivoted.any() and "orientation" in turning and "position" not in given:
        placed = full["position"].copy()
        placed[:, -len(rigid) :] = held_centers(rigid, core_rigid["orientation"], placed[:, -len(rigid) :])
        placed.setflags(write=False)
        full["position"] = placed
    if rigid.pivot is not None and (turning or "velocity" in given):
        arms = np.where(rigid.pivoted[:, None], -rigid.pivot, 0.0)
        follows = rotate(core_rigid["orientation"], np.cross(core_rigid["angular_velocity"], arms))
        size = 1e-9 * np.abs(follows).max(axis=-1)
        apart = np.abs(full["velocity"][:, -len(rigid) :] - follows).max(axis=-1)
        wrong = rigid.pivoted & (apart > size) & full["velocity"][:, -len(rigid) :].any(axis=-1)
        if "velocity" in given and wrong.any():
            copy, body = np.argwhere(wrong)[0]
            came = full["velocity"][copy, body - len(rigid)].tolist()
            raise InvalidInput(
                "velocity",
                f"expected 0 for bodies with fixed points, or what follows from their spins, "
                f"{follows[copy, body].tolist()}, but that of {body_label(body, rigid.names)} of copy {copy} is {came}",
            )
        moving = full["velocity"].copy()
        centers = moving[:, -len(rigid) :]
        # What a run gives stays as it is, which is that but for roundings.
        largest = np.abs(core_rigid["angular_velocity"]).max(axis=-1) * np.abs(arms).max(axis=-1)
        other = rigid.pivoted & ~(apart <= IS_ROUNDED * largest)
        centers[...] = np.where(other[..., None], follows, centers)
        moving.setflags(write=False)
        full["velocity"] = moving
    return core_rigid


def turning_of_copies(keywords: _core._Scene, chosen: int | slice | NDArray[np.intp]) -> dict[str, Any]:
    """Orientations and angular velocities of some copies; nothing without rigid bodies."""
    rigid = keywords["rigid"]
    if rigid is None:
        return {}
    return {"orientation": rigid["orientation"][chosen], "angular_velocity": rigid["angular_velocity"][chosen]}


def __dir__() -> list[str]:
    return list(__all__)
