"""The motion of a tame recipe by a method, and bounds of its errors that are no tuned numbers.

A method runs at three steps (or two tolerances); the errors that follow by Richardson's argument must fall as its order
says, and so must those of a second method with which it has to agree.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import FORCES, METHODS, ROUGH, ROUGH_FORCES, declared
from law_book import EPSILON
from recipe import MAX_STEPS, Case, Recipe, Refused
from running import execute

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import NDArray


def states(case: Case, **how: object) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    arguments = {**how, "record": ("position", "velocity")}
    result, ended = execute(case.start, case.t[-1:], arguments)
    if ended:
        if ended.startswith("refused"):
            raise Refused(ended)
        _check_series(case)
        _check_tables(case, arguments)
        raise AssertionError(f"a tame scene ended with {ended} ({arguments})")
    if not case.alone and result.status.any():
        _check_series(case)
        _check_tables(case, arguments)
        raise AssertionError(f"a tame scene ended with status {result.status} ({arguments})")
    position, velocity = result.position, result.velocity
    return (position[-1], velocity[-1]) if case.alone else (position[:, -1], velocity[:, -1])


def _check_series(case: Case) -> None:
    """Refuse what no series holds for: post-Newtonian terms near the speed of light, a flattening inside its body.

    They are no small corrections there, and may lead into a center.
    """
    for scene in case.members():
        if any(isinstance(force, vv.PostNewtonian) for force in scene.forces):
            raise Refused("a series in v/c that does not converge")
        for force in (each for each in scene.forces if isinstance(each, vv.Oblate)):
            places = scene.particles.position
            for source, radius in zip(force.body, np.broadcast_to(force.radius, np.shape(force.body)), strict=True):
                others = np.delete(places, source, axis=0)
                if (np.linalg.norm(others - places[source], axis=1) < radius).any():
                    raise Refused("a series in R/r that does not converge")


def _check_tables(case: Case, arguments: dict[str, Any]) -> None:
    """Refuse motions that leave a table of a force, as of a drag of bodies that fall into each other."""
    for scene in case.members():
        try:
            scene.run(list(case.t[-1:]), **arguments)
        except vv.ConvergenceError as error:
            if "a force of the scene is not known" in str(error):
                raise Refused("a force beyond the end of its table") from error


def _pull(scene: vv.Scene, end: float) -> float:
    """The largest acceleration at the start, and where the bodies are then in the middle of the span and at its end."""
    x, v = scene.particles.position, scene.particles.velocity
    times = (scene.t0, 0.5 * (scene.t0 + end), end)
    return max(float(np.abs(scene.with_state(x, v, t).acceleration()).max(initial=0.0)) for t in times)


def sizes(case: Case) -> tuple[float, float]:
    """What a rounding is judged against: the largest coordinate, and the largest velocity, on the way."""
    scenes = case.members()
    span = abs(case.t[-1] - scenes[0].t0)
    try:
        # A body at rest where a force begins, or vanishes, is pulled later, or by what is beside it.
        acceleration = max(_pull(scene, case.t[-1]) for scene in scenes)
    except vv.InvalidInput as error:
        raise Refused(f"refused {error.argument}") from error
    position = max(float(np.abs(scene.particles.position).max(initial=0.0)) for scene in scenes)
    velocity = max(float(np.abs(scene.particles.velocity).max(initial=0.0)) for scene in scenes)
    # A point that a force names is subtracted from positions, and rounds as they do.
    fixed = [getattr(force, name, (0.0,)) for force in scenes[0].forces for name in ("center", "origin", "point")]
    position = max(position, *(float(np.abs(point).max()) for point in fixed), 0.0)
    length = max(position, velocity * span, acceleration * span * span)
    return length, max(velocity, acceleration * span, length / span if span > 0.0 else 0.0)


def solution(case: Case, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float]:
    """The state at the end by a method, and bounds of its errors in position and velocity.

    A method of order p leaves (at a step h) an error C hᵖ, so at h/2 it is the difference of both over 2ᵖ - 1. Twice
    that is taken, and at least the difference itself, which leaves room for terms that are not asymptotic yet. It may
    not be anything: from h/2 to h/4 it must fall by at least half of 2ᵖ, or be round-off, as soon as the steps resolve
    the scene.
    """
    length, speed = sizes(case)
    # A run of some tens of steps, whose compensated sums round once a step at worst, and forces that see coordinates
    # rounded where they are.
    floor_x, floor_v = 128 * EPSILON * length, 128 * EPSILON * speed
    method = METHODS.get(name)
    if method is None or method.adaptive:
        # A step of order p goes with the tolerance to the power 1/p: low orders need many for the tighter one.
        steps_needed = int(10.0 * 1e11 ** (1.0 / (method.order if method else 8)))
        rest: dict[str, Any] = {"method": name, "max_steps": max(MAX_STEPS, steps_needed)}
        coarse, fine = (states(case, **rest, rtol=tolerance) for tolerance in (1e-8, 1e-11))
        change_x, change_v = change(coarse, fine)
        if rough(case):
            # A step that meets a jump errs by where it falls: two tolerances may be alike by chance, three hardly.
            between = change(states(case, **rest, rtol=1e-9), fine)
            change_x, change_v = max(change_x, between[0]), max(change_v, between[1])
        # Of short spans: some tens of tolerances, were every step to err by the whole of it in one direction.
        limit = 100 * 1e-8
        assert change_x <= limit * length + floor_x, f"{name}: {change_x} from rtol 1e-8 to 1e-11, of {length}"
        assert change_v <= limit * speed + floor_v, f"{name}: {change_v} from rtol 1e-8 to 1e-11, of {speed}"
        # Of a few steps the looser tolerance may be as close by chance: what the tighter one asks of a step is allowed.
        change_x, change_v = max(change_x, 1e-11 * length), max(change_v, 1e-11 * speed)
        return fine[0], fine[1], change_x + floor_x, change_v + floor_v
    return halved(case, name, method.order, (floor_x, floor_v))


def halved(
    case: Case, name: str, order: int, floors: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float]:
    """As `solution`, of a method with fixed steps: shorter ones are tried where the first do not resolve the scene."""
    if rough(case):
        raise Refused("a higher derivative jumps or is not finite, where no method has its order")
    span = abs(case.t[-1] - case.members()[0].t0)
    fall = 2.0 ** min(order, 6) / 2.0
    for counts in ((16, 32, 64), (64, 128, 256), (256, 512, 1024)):
        first, second, third = (states(case, method=name, dt=span / count) for count in counts)
        early, late = change(first, second), change(second, third)
        slow = [
            f"{name} of order {order}: halving the step changes {what} by {before:.1e}, then by {after:.1e} "
            f"(round-off {floor:.1e})"
            for what, before, after, floor in zip(("positions", "velocities"), early, late, floors, strict=True)
            if after > before / fall + floor
        ]
        # What all move with is not what the forces do to them.
        own = float(np.abs(third[1] - third[1].mean(axis=-2, keepdims=True)).max(initial=0.0))
        resolved = late[1] <= 0.01 * own + floors[1] or third[1].shape[-2] == 1
        if resolved and not slow:
            break
    else:
        # An encounter that steps of this length pass or miss by chance has no order.
        if not resolved:
            raise Refused("fixed steps do not resolve it")
        raise AssertionError(slow[0])
    room = max(1.0, 2.0 / (2.0**order - 1.0))
    return third[0], third[1], room * late[0] + floors[0], room * late[1] + floors[1]


def rough(case: Case) -> bool:
    """Whether a higher derivative of a potential, or of a drag, jumps or is not finite."""
    forces = case.members()[0].forces
    potentials = {type(getattr(force, "potential", None)).__name__ for force in forces}
    return bool(potentials & ROUGH or {type(force).__name__ for force in forces} & ROUGH_FORCES)


def change(first: Any, second: Any) -> tuple[float, float]:
    return tuple(float(np.abs(a - b).max(initial=0.0)) for a, b in zip(first, second, strict=True))  # type: ignore[return-value]


def loses_energy(recipe: Recipe) -> bool:
    """Whether a force takes energy: run backward it may make a body infinitely fast in a finite time."""
    drawn = [FORCES[name.partition("/")[0]] for name, _ in recipe.forces]
    return any(force._at_rest == "medium" or force is vv.Damper for force in drawn)


def tame(recipe: Recipe) -> Case:
    """The same scene at a span and a method of this law's choosing."""
    drawn = [FORCES[name.partition("/")[0]] for name, _ in recipe.forces]
    # What is fixed in space fixes the origin: 1e8 away the given positions have digits to 1e-8 alone.
    fixed = any(parameter["kind"] == "point" for force in drawn for parameter in declared(force))
    offset = min(recipe.offset, 3) if fixed else recipe.offset
    how: dict[str, Any] = {"collisions": "", "ragged": False, "outputs": 0, "steps": 16, "decades": 9, "offset": offset}
    return replace(recipe, tame=True, backward=recipe.backward and not loses_energy(recipe), **how).case()
