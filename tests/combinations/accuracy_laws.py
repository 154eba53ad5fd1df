"""Laws of accuracy: forces follow from the energy, methods agree, invariants hold. They are asked of tame recipes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from drawing import METHODS
from law_book import EPSILON, law
from recipe import Recipe, Refused
from running import execute
from solutions import change, sizes, solution, states, tame

import visviva as vv
from visviva.invariants import kept_by_forces


@law
def two_methods_agree(recipe: Recipe) -> None:
    """Within the sum of the bounds of both."""
    case = tame(recipe)
    other = sorted(METHODS)[recipe.seed % len(METHODS)]
    if other == recipe.method:
        other = "auto"
    x, v, error_x, error_v = solution(case, recipe.method)
    y, w, other_x, other_v = solution(case, other)
    apart_x, apart_v = change((x, v), (y, w))
    assert apart_x <= error_x + other_x, (
        f"{recipe.method} and {other}: {apart_x:.1e} apart, bounds {error_x:.1e} + {other_x:.1e}"
    )
    assert apart_v <= error_v + other_v, (
        f"{recipe.method} and {other}: {apart_v:.1e} apart, bounds {error_v:.1e} + {other_v:.1e}"
    )


@law
def steps_in_another_time_lead_to_the_same_motion(recipe: Recipe) -> None:
    """Within what a step of half the length changes, and the bound of the other."""
    case = tame(recipe)
    span = abs(case.t[-1] - case.members()[0].t0)
    how = {"method": "kahan_li8", "time_transformation": recipe.transformation or "distance"}
    try:
        coarse, fine = (states(case, **how, dt=span / steps) for steps in (32, 64))
    except AssertionError:
        # About a strong source the transformed time is long: a step of it may have no end.
        coarse, fine = (states(case, **how, dt=span / steps) for steps in (1024, 2048))
    x, v, error_x, error_v = solution(case, "auto")
    length, speed = sizes(case)
    bounds = (error_x + 128 * EPSILON * length, error_v + 128 * EPSILON * speed)
    for found, halved, bound in zip(change(fine, (x, v)), change(coarse, fine), bounds, strict=True):
        # Of some steps of the other each may err by the whole of its tolerance.
        assert found <= halved + 4 * bound, f"{found:.1e} apart, bounds {halved:.1e} + {4 * bound:.1e}"


@law
def declared_invariants_hold(recipe: Recipe) -> None:
    """As far as the error of the state lets them: |δE| ≤ Σ m (|v| δv + |a| δx), and so on; momentum to round-off."""
    case = tame(replace(recipe, members=0))
    _, _, error_x, error_v = solution(case, recipe.method)
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
    length, speed = sizes(case)
    acceleration = np.abs(scene.acceleration()).max(initial=0.0) + np.abs(end.acceleration()).max(initial=0.0)
    total = float(mass.sum())
    scales = {
        # The mass first: squares of small velocities may be beneath float64.
        "energy": (total * speed * error_v + total * float(acceleration) * error_x) * 3,
        "momentum": total * 128 * EPSILON * speed,
        "angular momentum": (total * length * error_v + total * speed * error_x) * 3,
        "center of mass": 128 * EPSILON * length,
    }
    for row in table.rows:
        allowed = scales[row.name]
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
