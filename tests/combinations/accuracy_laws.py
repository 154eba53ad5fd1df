"""Laws of accuracy: forces follow from the energy, methods agree, invariants hold. They are asked of tame recipes.

Their bounds are no tuned numbers: a method runs at three steps (or two tolerances), the errors that follow by
Richardson's argument must fall as its order says, and so must those of a second method with which it has to agree.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import METHODS, ROUGH
from law_book import EPSILON, law
from recipe import MAX_STEPS, Case, Recipe, Refused
from running import execute

import visviva as vv
from visviva.invariants import kept_by_forces

if TYPE_CHECKING:
    from numpy.typing import NDArray


def _states(case: Case, **how: object) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    arguments = {**how, "record": ("position", "velocity")}
    result, ended = execute(case.start, case.t[-1:], arguments)
    if ended:
        if ended.startswith("refused"):
            raise Refused(ended)
        raise AssertionError(f"a tame scene ended with {ended} ({arguments})")
    if not case.alone and result.status.any():
        raise AssertionError(f"a tame scene ended with status {result.status} ({arguments})")
    position, velocity = result.position, result.velocity
    return (position[-1], velocity[-1]) if case.alone else (position[:, -1], velocity[:, -1])


def _sizes(case: Case) -> tuple[float, float]:
    """What a rounding is judged against: the largest coordinate, and the largest velocity, on the way."""
    scenes = case.members()
    span = abs(case.t[-1] - scenes[0].t0)
    try:
        acceleration = max(float(np.abs(scene.acceleration()).max(initial=0.0)) for scene in scenes)
    except vv.InvalidInput as error:
        raise Refused(f"refused {error.argument}") from error
    position = max(float(np.abs(scene.particles.position).max(initial=0.0)) for scene in scenes)
    velocity = max(float(np.abs(scene.particles.velocity).max(initial=0.0)) for scene in scenes)
    # A point that a force names is subtracted from positions, and rounds as they do.
    fixed = [getattr(force, name, (0.0,)) for force in scenes[0].forces for name in ("center", "origin", "point")]
    position = max(position, *(float(np.abs(point).max()) for point in fixed), 0.0)
    length = max(position, velocity * span, acceleration * span * span)
    return length, max(velocity, acceleration * span, length / span if span > 0.0 else 0.0)


def _solution(case: Case, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float]:
    """The state at the end by a method, and bounds of its errors in position and velocity.

    A method of order p leaves (at a step h) an error C hᵖ, so at h/2 it is the difference of both over 2ᵖ - 1. Twice
    that is taken, and at least the difference itself, which leaves room for terms that are not asymptotic yet. It may
    not be anything: from h/2 to h/4 it must fall by at least half of 2ᵖ, or be round-off, as soon as the steps resolve
    the scene.
    """
    length, speed = _sizes(case)
    # A run of some tens of steps, whose compensated sums round once a step at worst, and forces that see coordinates
    # rounded where they are.
    floor_x, floor_v = 128 * EPSILON * length, 128 * EPSILON * speed
    method = METHODS.get(name)
    if method is None or method.adaptive:
        # A step of order p goes with the tolerance to the power 1/p: low orders need many for the tighter one.
        steps_needed = int(10.0 * 1e11 ** (1.0 / (method.order if method else 8)))
        rest: dict[str, Any] = {"method": name, "max_steps": max(MAX_STEPS, steps_needed)}
        coarse, fine = (_states(case, **rest, rtol=tolerance) for tolerance in (1e-8, 1e-11))
        change_x, change_v = _change(coarse, fine)
        # Of short spans: some tens of tolerances, were every step to err by the whole of it in one direction.
        limit = 100 * 1e-8
        assert change_x <= limit * length + floor_x, f"{name}: {change_x} from rtol 1e-8 to 1e-11, of {length}"
        assert change_v <= limit * speed + floor_v, f"{name}: {change_v} from rtol 1e-8 to 1e-11, of {speed}"
        # Of a few steps the looser tolerance may be as close by chance: what the tighter one asks of a step is allowed.
        change_x, change_v = max(change_x, 1e-11 * length), max(change_v, 1e-11 * speed)
        return fine[0], fine[1], change_x + floor_x, change_v + floor_v
    return _halved(case, name, method.order, (floor_x, floor_v))


def _halved(
    case: Case, name: str, order: int, floors: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64], float, float]:
    """As `_solution`, of a method with fixed steps: shorter ones are tried where the first do not resolve the scene."""
    span = abs(case.t[-1] - case.members()[0].t0)
    fall = 2.0 ** min(order, 6) / 2.0
    for counts in ((16, 32, 64), (64, 128, 256), (256, 512, 1024)):
        first, second, third = (_states(case, method=name, dt=span / count) for count in counts)
        early, late = _change(first, second), _change(second, third)
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


def _change(first: Any, second: Any) -> tuple[float, float]:
    return tuple(float(np.abs(a - b).max(initial=0.0)) for a, b in zip(first, second, strict=True))  # type: ignore[return-value]


def _tame(recipe: Recipe) -> Case:
    """The same scene at a span and a method of this law's choosing."""
    # What is fixed in space fixes the origin: 1e8 away the given positions have digits to 1e-8 alone.
    if any(type(getattr(force, "potential", None)).__name__ in ROUGH for force in recipe.case().members()[0].forces):
        raise Refused("a higher derivative of the potential jumps, where no method has its order")
    fixed = any(name.startswith("CentralField") for name, _ in recipe.forces)
    offset = min(recipe.offset, 3) if fixed else recipe.offset
    # Run backward this drag makes a body infinitely fast in a finite time.
    forward = any(name == "QuadraticDrag" for name, _ in recipe.forces)
    how: dict[str, Any] = {"ragged": False, "outputs": 0, "steps": 16, "decades": 9, "offset": offset}
    return replace(recipe, tame=True, backward=recipe.backward and not forward, **how).case()


@law
def two_methods_agree(recipe: Recipe) -> None:
    """Within the sum of the bounds of both."""
    case = _tame(recipe)
    other = sorted(METHODS)[recipe.seed % len(METHODS)]
    if other == recipe.method:
        other = "auto"
    x, v, error_x, error_v = _solution(case, recipe.method)
    y, w, other_x, other_v = _solution(case, other)
    apart_x, apart_v = _change((x, v), (y, w))
    assert apart_x <= error_x + other_x, (
        f"{recipe.method} and {other}: {apart_x:.1e} apart, bounds {error_x:.1e} + {other_x:.1e}"
    )
    assert apart_v <= error_v + other_v, (
        f"{recipe.method} and {other}: {apart_v:.1e} apart, bounds {error_v:.1e} + {other_v:.1e}"
    )


@law
def declared_invariants_hold(recipe: Recipe) -> None:
    """As far as the error of the state lets them: |δE| ≤ Σ m (|v| δv + |a| δx), and so on; momentum to round-off."""
    case = _tame(replace(recipe, members=0))
    _, _, error_x, error_v = _solution(case, recipe.method)
    scene = case.members()[0]
    if not scene.particles.mass.any():
        raise Refused("nothing to conserve")
    method = METHODS.get(recipe.method)
    span = abs(case.t[-1] - scene.t0)
    steps: dict[str, Any] = {"rtol": 1e-11} if method is None or method.adaptive else {"dt": span / 64}
    result, _ = execute(scene, case.t[-1:], {"method": recipe.method, **steps})
    table = result.conservation()
    end = result.final
    mass = scene.particles.mass[:, None]
    length, speed = _sizes(case)
    acceleration = np.abs(scene.acceleration()).max(initial=0.0) + np.abs(end.acceleration()).max(initial=0.0)
    total = float(mass.sum())
    scales = {
        "energy": total * (speed * error_v + float(acceleration) * error_x) * 3,
        "momentum": total * 128 * EPSILON * speed,
        "angular momentum": total * (length * error_v + speed * error_x) * 3,
        "center of mass": 128 * EPSILON * length,
    }
    for row in table.rows:
        allowed = scales[row.name.replace("centre", "center")]
        if row.conserved:
            assert row.max * row.scale <= allowed, f"{row.name}: {row.max * row.scale:.1e}, {allowed:.1e} allowed"


@law
def forces_add(recipe: Recipe) -> None:
    """The acceleration is the sum of those of each force alone."""
    case = replace(recipe, members=0, offset=0).case()
    (scene,) = case.members()
    try:
        together = scene.acceleration()
        apart = [vv.Scene(scene.particles, force, t0=scene.t0).acceleration() for force in scene.forces]
    except vv.InvalidInput as error:
        raise Refused(error.argument) from error
    total = sum(apart, np.zeros_like(together))
    size = sum((np.abs(one) for one in apart), np.zeros_like(together)).max(initial=0.0)
    if not np.isfinite(size):
        raise Refused("beyond float64")
    # One rounding for each force that is added, two for each of another kernel.
    assert np.abs(together - total).max(initial=0.0) <= 8 * EPSILON * size * max(1, len(apart))


@law
def forces_follow_from_the_energy(recipe: Recipe) -> None:
    """m a · d = -dV/ds along any direction d, wherever the forces declare that they keep the energy.

    For bodies at rest: what only turns velocities does no work and has no potential.
    """
    case = replace(recipe, members=0, offset=0, units=(0, 0, 0), tame=True, crowd=0).case()
    (scene,) = case.members()
    bodies = scene.particles
    if not kept_by_forces(scene, np.zeros(3))["energy"]:
        raise Refused("these forces keep no energy")
    scene = scene.with_state(bodies.position, np.zeros_like(bodies.velocity))
    rng = np.random.default_rng(recipe.seed)
    direction = rng.uniform(-1.0, 1.0, bodies.position.shape)
    # The difference errs by h² (of scenes with a scale of 2) and by roundings over h: least about here.
    h = 2.0**-16

    def energy(s: float) -> float:
        moved = vv.Scene(vv.Particles(bodies.mass, bodies.position + s * direction), *scene.forces)
        return moved.invariants().energy

    try:
        work = float((bodies.mass[:, None] * scene.acceleration() * direction).sum())
        if not bodies.mass.any():
            raise Refused("no mass, no energy")
        energies = [energy(s) for s in (-2 * h, -h, h, 2 * h)]
    except vv.InvalidInput as error:
        raise Refused(error.argument) from error
    slope = (8 * (energies[2] - energies[1]) - (energies[3] - energies[0])) / (12 * h)
    size = float((bodies.mass[:, None] * np.abs(scene.acceleration() * direction)).sum())
    allowed = 1e-10 * size + 16 * EPSILON * max(map(abs, energies)) * len(bodies) / h
    assert abs(work + slope) <= allowed, f"work {work:.9e}, -dV {-slope:.9e}, {allowed:.1e} allowed"
