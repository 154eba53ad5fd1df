"""Runs in which bodies merge: which bodies there are at which times, with which masses.

The one idea: between two mergers the bodies that are left are a scene like any, and whatever is told of states is told
of those of one such era after another. A run without mergers is one era.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from visviva import _core

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from visviva.forces import Force
    from visviva.particles import Particles
    from visviva.scene import Scene
    from visviva.trajectory import Trajectory

__all__ = ["by_era", "eras", "has_mergers", "hosts", "parts_and_masses", "remaining"]


def hosts(bodies: Particles) -> NDArray[np.int64] | None:
    """The body of which each is a part, as mergers leave them; None if all are by themselves.

    A part has no mass and no radius, is in the place of a sphere, and moves with it.
    """
    nothing = (bodies.mass == 0.0) & (bodies.radius == 0.0)
    if not (nothing.any() and bodies.radius.any()):
        return None
    states = np.hstack([bodies.position, bodies.velocity]) + 0.0
    spheres = {states[body].tobytes(): body for body in np.flatnonzero(bodies.radius).tolist()}
    found = np.arange(len(bodies))
    for body in np.flatnonzero(nothing).tolist():
        found[body] = spheres.get(states[body].tobytes(), body)
    return found if (found != np.arange(len(bodies))).any() else None


def remaining(scene: Scene, parts: NDArray[np.int64], mass: NDArray[np.float64] | None = None) -> Scene:
    """The bodies that are parts of no others, and the forces on them; with these masses of all, if not their own."""
    from visviva.particles import Particles

    p, there = scene.particles, np.unique(parts)
    particles = Particles((p.mass if mass is None else mass)[there], p.position[there], p.velocity[there])
    forces = (_of_remaining(force, parts) for force in scene.forces)
    return scene._like(particles, [force for force in forces if force is not None], scene.t0)


def _of_remaining(force: Force, parts: NDArray[np.int64]) -> Force | None:
    described = force._to_core()
    changed = _core.force_of_remaining(described, parts)
    if changed is None or changed is described:
        return None if changed is None else force
    return type(force)._from_core(changed)


def has_mergers(run: Any) -> bool:
    """Whether bodies of a run have merged."""
    return bool((run._result.get("collisions", {"survivor": np.zeros(0)})["survivor"] >= 0).any())


def eras(run: Trajectory, scene: Scene | None = None) -> Iterator[tuple[slice, Scene, list[int] | None]]:
    """Rows, the scene of the bodies that are there, and which of those of the run they are; None for all of them.

    Another scene than that of the run is one of the same bodies under other forces.
    """
    scene = scene or run.scene
    bodies = scene.particles
    parts = hosts(bodies) if run._result.get("collisions") else None
    if parts is None and not has_mergers(run):
        yield slice(0, len(run.t)), scene, None
        return
    table = run._result["collisions"]
    mass, host = bodies.mass.copy(), np.arange(len(bodies)) if parts is None else parts
    # A row at the time of a merger is of before.
    ends = [*np.searchsorted(run.t, table["t"], side="right").tolist(), len(run.t)]
    start = 0
    for line, end in enumerate(ends):
        if end > start:
            yield slice(start, end), remaining(scene, host, mass), np.unique(host).tolist()
            start = end
        if line < len(table["t"]) and table["survivor"][line] >= 0:
            first, second = int(table["first"][line]), int(table["second"][line])
            survivor = int(table["survivor"][line])
            gone = first + second - survivor
            mass[survivor] += mass[gone]
            mass[gone] = 0.0
            host[host == gone] = survivor


def parts_and_masses(run: Any) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Which bodies are parts of others in each row, and the masses there; (T, N), of an ensemble (B, T, N)."""
    from visviva.trajectory import Trajectory

    if isinstance(run, Trajectory):
        return _of_rows(run, len(run.t))
    members = [_of_rows(run[member], len(run.t)) for member in range(len(run))]
    return np.stack([parts for parts, _ in members]), np.stack([mass for _, mass in members])


def _of_rows(run: Trajectory, count: int) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Of so many rows; those that a failed copy does not have are as the scene."""
    mass = np.tile(run.scene.particles.mass, (count, 1))
    parts = np.zeros(mass.shape, dtype=bool)
    for rows, scene, there in eras(run):
        if there is not None:
            parts[rows], mass[rows] = True, 0.0
            for body, own in zip(there, scene.particles.mass, strict=True):
                parts[rows, body], mass[rows, body] = False, own
    return parts, mass


def by_era(
    run: Trajectory,
    tell: Callable[[Scene, NDArray[np.float64], Any], dict[str, NDArray[np.float64]]],
    *,
    velocity: bool = True,
) -> dict[str, NDArray[np.float64]]:
    """What `tell` says of the states of each era, put together."""
    results = []
    for rows, scene, remaining in eras(run):
        position, moving = run.position[rows], run.velocity[rows] if velocity else None
        if remaining is not None:
            position = np.ascontiguousarray(position[:, remaining])
            moving = None if moving is None else np.ascontiguousarray(moving[:, remaining])
        results.append(tell(scene, position, moving))
    return (
        results[0]
        if len(results) == 1
        else {name: np.concatenate([each[name] for each in results]) for name in results[0]}
    )
