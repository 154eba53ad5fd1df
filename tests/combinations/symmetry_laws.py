"""Laws of symmetry: what a mirror, other units, or massless bodies more or less leave as it is, to the bit."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from law_book import law
from recipe import Case, Recipe, Refused
from running import execute

import visviva as vv
from visviva import _core
from visviva._own_forces import Acting

if TYPE_CHECKING:
    from collections.abc import Callable


def _without_events(how: dict[str, Any]) -> dict[str, Any]:
    """Those name bodies and places, which would have to be changed with the scene."""
    return {name: value for name, value in how.items() if name != "events"}


def _transformed(case: Case, change: Callable[[vv.Scene], vv.Scene], *, time: float = 1.0) -> Case:
    try:
        scenes = [change(scene) for scene in case.members()]
    except vv.InvalidInput as error:
        raise Refused(error.argument) from error
    start: Any = scenes[0]
    if not case.alone:
        names = ("mass", "position", "velocity", "radius")
        stacked = {name: np.stack([getattr(scene.particles, name) for scene in scenes]) for name in names}
        acting = Acting(tuple(scene.forces for scene in scenes), tuple(scene.body_forces for scene in scenes))
        start = vv.EnsembleScene._of(scenes[0], acting, **stacked)
    how = case.how | ({"dt": case.how["dt"] * time} if "dt" in case.how else {})
    return Case(start, tuple(t * time for t in case.t), how)


def _both(here: Case, there: Case, fastest: float = np.inf) -> tuple[Any, Any]:
    """The runs of two cases, which end alike; refused where they come to be faster than that.

    A run whose forces take squares ends where those of its speeds do.
    """
    (first, ended), (second, other) = (
        execute(case.start, case.t, {**_without_events(case.how), "record": ("position", "velocity")})
        for case in (here, there)
    )
    if first is None:
        raise Refused(ended)
    speed = max(np.nanmax(np.abs(run.velocity), initial=0.0) for run in (first, second))
    if speed > (fastest if np.array_equal(first.status, second.status) else math.sqrt(fastest)):
        raise Refused("a motion that ends in infinity ends beyond float64 in some units sooner")
    assert ended == other, f"{ended!r} here, {other!r} there"
    assert np.array_equal(first.status, second.status)
    return first, second


@law
def a_mirror_image_has_the_mirrored_bits(recipe: Recipe) -> None:
    """Rounding is symmetric about zero; forces are turned with the bodies."""
    signs = np.where(np.random.default_rng(recipe.seed).random(3) < 0.5, -1.0, 1.0)
    case = recipe.case()
    here, there = _both(case, _transformed(case, lambda scene: scene.rotated(np.diag(signs))))
    for name in ("position", "velocity"):
        mine, other = getattr(here, name) * signs, getattr(there, name)
        assert np.array_equal(mine, other, equal_nan=True), f"other {name} in the mirror"


def _broken(described: Any, powers: list[int]) -> bool:
    """Whether other units are no power of two for a parameter of a force or its potential."""
    inner = getattr(described, "potential", None)
    exponents = np.array(_core.dimensions(described._to_core()))
    units = exponents.reshape(-1, 3) @ powers
    return bool(np.any(units != np.round(units))) or (inner is not None and _broken(inner, powers))


@law
def units_of_powers_of_two_change_no_bit(recipe: Recipe) -> None:
    powers = [int(power) for power in np.random.default_rng(recipe.seed).integers(-40, 41, 3)]
    length, mass, time = (2.0**power for power in powers)
    # A tolerance is absolute in part only by default, which is in units of the scene's own.
    case = replace(recipe, units=(0, 0, 0)).case()
    if any(_broken(force, powers) for force in case.members()[0].forces):
        raise Refused("a parameter of a dimension that is no whole power, as k of k/r^2.5, is rounded")
    in_others = _transformed(case, lambda scene: scene.rescaled(length=length, mass=mass, time=time), time=time)
    here, there = _both(case, in_others, fastest=2.0**800)
    span = abs(case.t[-1] - case.members()[0].t0) or 1.0
    for name, scale, moves in (("position", length, 1.0), ("velocity", length / time, 1.0 / span)):
        mine, other = getattr(here, name), getattr(there, name) / scale
        # What is less than that beside the whole may vanish in the units of one integration and not of the other.
        least = 2.0**-800 * np.nanmax(np.abs(here.position), initial=0.0) * moves
        vanished = (np.abs(mine) <= least) & (np.abs(other) <= least)
        assert np.array_equal(mine[~vanished], other[~vanished], equal_nan=True), f"other {name} in units of {powers}"


@law
def massless_bodies_do_not_touch_the_massive(recipe: Recipe) -> None:
    """Without them the massive bodies have the same bits, wherever the others are."""
    # With collisions all bodies are on the same steps.
    case = replace(recipe, members=0, collisions="").case()
    (scene,) = case.members()
    bodies = scene.particles
    massive = bodies.mass > 0.0
    how = {**_without_events(case.how), "record": ("position", "velocity")}
    if massive.all() or not massive.any() or recipe.method == "auto":
        raise Refused("no massless bodies, or other bodies may have a closed form")
    result, ended = execute(scene, case.t, how)
    alone = vv.Scene(
        vv.Particles(bodies.mass[massive], bodies.position[massive], bodies.velocity[massive]),
        *scene.forces,
        t0=scene.t0,
    )
    few, few_ended = execute(alone, case.t, how)
    if result is None or few is None:
        raise Refused(ended or few_ended)
    rows = min(len(result.t), len(few.t))
    for name in ("position", "velocity"):
        same = getattr(result, name)[:rows, massive].tobytes() == getattr(few, name)[:rows].tobytes()
        assert same, f"other {name} of the massive bodies"
