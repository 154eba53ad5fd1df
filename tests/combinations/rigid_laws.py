"""Laws asked of scenes in which bodies turn: those of bits that are asked of points, and those of mechanics.

What is compared are positions, velocities, directions of the bodies' axes (matrices, which have no sign to choose) and
angular velocities.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import METHODS, RIGID_METHODS
from law_book import EPSILON, LAWS
from recipe import Case, Refused
from rigid_recipe import COLUMNS, LOOKING, RigidRecipe
from running import execute

import visviva as vv
from visviva.invariants import kept_by_forces

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

# Those that look at nothing but requests and what came of them.
OF_BITS = (
    "refusals_are_made_by_the_plan_and_by_the_run",
    "the_plan_says_what_ran",
    "what_is_ok_is_finite",
    "a_member_is_as_if_alone",
    "threads_change_no_bit",
    "tiers_change_no_bit",
    "recorded_columns_change_no_bit",
    "other_outputs_change_no_bit",
    "saved_and_loaded_nothing_changes",
    "a_run_goes_on_with_the_bits_of_the_whole",
    "final_is_the_last_state",
    "progress_ends_at_its_total",
)
RIGID_LAWS: dict[str, Callable[[Any], None]] = {}


def law(function: Callable[[RigidRecipe], None]) -> Callable[[RigidRecipe], None]:
    """Lists it."""
    RIGID_LAWS[function.__name__] = function
    return function


import stated_laws  # noqa: E402, F401 — which lists those of points

RIGID_LAWS |= {name: LAWS[name] for name in OF_BITS}

State = dict[str, "NDArray[np.float64]"]
NAMES = ("position", "velocity", "axes", "angular_velocity")


def _tame(recipe: RigidRecipe, **changes: Any) -> tuple[RigidRecipe, vv.Scene, Case]:
    plain = replace(recipe, tame=True, members=0, units=(0, 0, 0), offset=0, events=(), collisions="", **changes)
    case = replace(plain, transformation="").case()
    assert isinstance(case.start, vv.Scene)
    return plain, case.start, case


def _fine(scene: vv.Scene, case: Case, steps: int, method: str) -> dict[str, Any]:
    return {"method": method, "dt": abs(case.t[-1] - scene.t0) / steps}


def _state(scene: vv.Scene, t: float, how: dict[str, Any]) -> State:
    result, ended = execute(scene, (t,), {**how, "record": COLUMNS})
    if result is None:
        raise Refused(ended)
    assert not ended, f"a tame scene ended with {ended}"
    assert result.status == 0, f"a tame scene ended with {result.status}"
    return {
        "position": result.position[-1],
        "velocity": result.velocity[-1],
        "axes": vv.rigid.matrix(result.orientation[-1]),
        "angular_velocity": result.angular_velocity[-1],
    }


def _apart(first: State, second: State) -> dict[str, float]:
    return {name: float(np.abs(first[name] - second[name]).max(initial=0.0)) for name in NAMES}


def _judge(what: str, apart: dict[str, float], allowed: dict[str, float]) -> None:
    for name in NAMES:
        assert apart[name] <= allowed[name], f"{what}: {name} {apart[name]:.1e} apart, {allowed[name]:.1e} allowed"


def _steepest(scene: vv.Scene) -> float:
    """How much a turn by ε may change an angular velocity: small moments make torques large."""
    rigid = scene.rigid_bodies
    assert rigid is not None
    moments = rigid.principal_moments
    ratio = moments.max(axis=1) / np.where(moments > 0.0, moments, np.inf).min(axis=1)
    return float(ratio.max())


def _rounding(scene: vv.Scene, state: State, steps: int) -> dict[str, float]:
    """Some ε of each step, of the largest numbers there are."""
    start = scene.particles
    span = 1.0 + float(np.abs(state["angular_velocity"]).max(initial=0.0))
    length = 1.0 + float(max(np.abs(start.position).max(), np.abs(state["position"]).max()))
    speed = span + float(max(np.abs(start.velocity).max(), np.abs(state["velocity"]).max()))
    each = 16 * EPSILON * steps * _steepest(scene)
    return {
        "position": each * length,
        "velocity": each * speed * length,
        "axes": each * span,
        "angular_velocity": each * span**2,
    }


def _sum(*bounds: dict[str, float]) -> dict[str, float]:
    return {name: sum(bound[name] for bound in bounds) for name in NAMES}


def _method_of(recipe: RigidRecipe) -> str:
    if recipe.method not in RIGID_METHODS or RIGID_METHODS[recipe.method].order < 2:
        raise Refused("another method")
    return recipe.method


@law
def two_methods_agree_on_attitudes(recipe: RigidRecipe) -> None:
    """Each within what halving its step changes; a coarser look at the same motion is another motion only by that."""
    method = _method_of(recipe)
    recipe, scene, case = _tame(recipe)
    end = case.t[-1]
    looking = any(name in LOOKING for name, _ in recipe.loads)
    other = "rk4" if looking or method == "kahan_li6" else "kahan_li6"
    coarse, fine = (_state(scene, end, _fine(scene, case, steps, method)) for steps in (64, 128))
    rough, sharp = (_state(scene, end, _fine(scene, case, steps, other)) for steps in (64, 128))
    if max(*_apart(coarse, fine).values(), *_apart(rough, sharp).values()) > 0.01:
        raise Refused("a needle is spun up in less than a step")
    allowed = _sum(_apart(coarse, fine), _apart(rough, sharp), _rounding(scene, fine, 128))
    _judge(f"{method} and {other}", _apart(fine, sharp), {name: 2.0 * bound for name, bound in allowed.items()})


@law
def chosen_steps_lead_to_the_same_attitudes(recipe: RigidRecipe) -> None:
    recipe, scene, case = _tame(recipe)
    end, rtol = case.t[-1], 1e-9
    looking = any(name in LOOKING for name, _ in recipe.loads)
    chosen = _state(scene, end, {"method": "auto", "rtol": rtol})
    rough, sharp = (_state(scene, end, _fine(scene, case, n, "rk4" if looking else "kahan_li6")) for n in (256, 512))
    loose = dict.fromkeys(NAMES, 100.0 * rtol)
    size = 1.0 + float(np.abs(sharp["angular_velocity"]).max())
    loose["angular_velocity"] *= size
    _judge("steps of its own", _apart(chosen, sharp), _sum(loose, _apart(rough, sharp), _rounding(scene, sharp, 512)))


@law
def what_forces_keep_is_kept(recipe: RigidRecipe) -> None:
    """What the table of a run calls conserved stays, to what halving the steps changes."""
    method = _method_of(recipe)
    recipe, scene, case = _tame(recipe)
    kept = kept_by_forces(scene, np.zeros(3))
    rows = []
    for steps in (64, 128):
        record = ("energy", "momentum", "angular_momentum", "kinetic_energy")
        result, ended = execute(scene, case.t[-1:], {**_fine(scene, case, steps, method), "record": record})
        if result is None:
            raise Refused(ended)
        first, _ = execute(scene, (scene.t0, case.t[-1]), {**_fine(scene, case, steps, method), "record": record})
        rows.append({name: getattr(first, name) for name in record})
    state = _state(scene, case.t[-1], _fine(scene, case, 128, method))
    size = 1.0 + float(np.abs(rows[1]["kinetic_energy"]).max() + np.abs(rows[1]["energy"]).max())
    rounding = sum(_rounding(scene, state, 128).values()) * size
    for name in ("energy", "momentum", "angular_momentum"):
        if not kept[name]:
            continue
        drift, coarse = (float(np.abs(row[name][-1] - row[name][0]).max()) for row in rows[::-1])
        # Of a method of order 2 the error of the coarse steps is 4 times that of the fine ones.
        change = float(np.abs(rows[1][name][-1] - rows[0][name][-1]).max())
        assert drift <= 2.0 * change + rounding, f"{name} changes by {drift:.1e}, at twice the step by {coarse:.1e}"


def _orthogonal(seed: int) -> NDArray[np.float64]:
    """A turn of space, or one with a mirror."""
    rng = np.random.default_rng(seed)
    matrix: NDArray[np.float64] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    matrix[0] *= rng.choice([-1.0, 1.0])
    return matrix


@law
def a_turned_scene_turns_alike(recipe: RigidRecipe) -> None:
    """In any direction and in any mirror: spins are axial, and a mirrored body has its axes turned round."""
    method = _method_of(recipe)
    recipe, scene, case = _tame(recipe)
    matrix = _orthogonal(recipe.seed + 5)
    how = _fine(scene, case, 32, method)
    try:
        turned = scene.rotated(matrix)
    except vv.InvalidInput as error:
        raise Refused(error.argument) from error
    here, there = _state(scene, case.t[-1], how), _state(turned, case.t[-1], how)
    sign = np.sign(np.linalg.det(matrix))
    expected = {
        "position": here["position"] @ matrix.T,
        "velocity": here["velocity"] @ matrix.T,
        "axes": sign * matrix @ here["axes"],
        "angular_velocity": here["angular_velocity"],
    }
    _judge(f"{method}, turned", _apart(expected, there), _rounding(scene, here, 64))


@law
def a_scene_turns_alike_in_another_frame(recipe: RigidRecipe) -> None:
    """Galilei, where nothing is at rest."""
    method = _method_of(recipe)
    recipe, scene, case = _tame(recipe)
    rng = np.random.default_rng(recipe.seed + 4)
    origin, velocity = rng.uniform(-4.0, 4.0, (2, 3))
    try:
        other = scene.in_frame(velocity=velocity, origin=origin)
    except vv.InvalidInput:
        velocity = np.zeros(3)
        try:
            other = scene.in_frame(velocity=velocity, origin=origin)
        except vv.InvalidInput as error:
            raise Refused(error.argument) from error
    how = _fine(scene, case, 32, method)
    here, there = _state(scene, case.t[-1], how), _state(other, case.t[-1], how)
    shift = origin + velocity * (case.t[-1] - (scene.t0 if other.t0 == 0.0 and scene.t0 else 0.0))
    back = there | {"position": there["position"] + shift, "velocity": there["velocity"] + velocity}
    far = 1.0 + float(np.abs(shift).max())
    allowed = {name: bound * far for name, bound in _rounding(scene, here, 64).items()}
    _judge(f"{method} in another frame", _apart(here, back), allowed)


@law
def what_turned_turns_back(recipe: RigidRecipe) -> None:
    """A reversible method undoes its steps: as many back as there."""
    method = _method_of(recipe)
    if not RIGID_METHODS[method].reversible:
        raise Refused("a method that tells the future from the past")
    recipe, scene, case = _tame(recipe)
    try:
        scene.reversed()
    except vv.InvalidInput as error:
        raise Refused("a force that has no reverse") from error
    how = _fine(scene, case, 32, method)
    end = _state(scene, case.t[-1], how)
    result, _ = execute(scene, case.t[-1:], {**how, "record": COLUMNS})
    back = result.final.reversed()
    again = _state(back, 2.0 * case.t[-1] - scene.t0, how)
    rigid = scene.rigid_bodies
    assert rigid is not None
    start = {
        "position": scene.particles.position,
        "velocity": -scene.particles.velocity,
        "axes": vv.rigid.matrix(rigid.orientation),
        "angular_velocity": -rigid.angular_velocity,
    }
    _judge(f"{method}, there and back", _apart(start, again), _rounding(scene, end, 128))


@law
def spheres_move_as_points(recipe: RigidRecipe) -> None:
    """Where nothing turns them bodies have the bits of points in their places; loads and fixed points apart."""
    recipe = replace(recipe, shape="sphere", loads=(), held=0, collisions="", members=0)
    case = recipe.case()
    assert isinstance(case.start, vv.Scene)
    points = vv.Scene(case.start.particles, *case.start.forces, t0=case.start.t0)
    how = case.how | {"record": ("position", "velocity")}
    if recipe.method not in {"auto", *METHODS}:
        raise Refused("a method of rigid bodies alone")
    here, ended = execute(case.start, case.t, how)
    there, other = execute(points, case.t, how)
    assert ended == other, f"{ended!r} of spheres, {other!r} of points"
    if here is None:
        raise Refused(ended)
    for name in ("position", "velocity"):
        assert np.array_equal(getattr(here, name), getattr(there, name), equal_nan=True), f"other {name} than points"


@law
def rates_of_what_is_told_are_differences_of_a_run(recipe: RigidRecipe) -> None:
    """The torque that `invariants` tells is the rate of angular momentum, the accelerations those of velocities; NaN
    and refusals stand for what is not known."""
    recipe, scene, case = _tame(recipe)
    step = (case.t[-1] - scene.t0) / 64.0
    try:
        told = scene.invariants()
    except vv.InvalidInput as error:
        raise Refused(error.argument) from error
    looking = any(name in LOOKING for name, _ in recipe.loads)
    how = {"method": "rk4" if looking else "kahan_li8", "record": ("velocity", "angular_momentum", "momentum")}
    found = []
    for size in (step, step / 2.0):
        ends = []
        for sign in (1.0, -1.0):
            result, ended = execute(scene, (scene.t0 + sign * size,), {**how, "dt": abs(size) / 4.0})
            if result is None:
                raise Refused(ended)
            ends.append(result)
        found.append(
            {name: (getattr(ends[0], name)[-1] - getattr(ends[1], name)[-1]) / (2.0 * size) for name in how["record"]}
        )
    # Twice extrapolated the difference has an error of the fourth power of a step that is small; and roundings.
    rates = {name: (4.0 * found[1][name] - found[0][name]) / 3.0 for name in found[0]}
    errors = {name: float(np.abs(found[1][name] - found[0][name]).max()) for name in found[0]}
    scale = 1.0 + float(np.abs(scene.particles.position).max()) * (1.0 + float(np.abs(scene.particles.velocity).max()))
    rounding = 1e4 * EPSILON * _steepest(scene) * scale / abs(step)
    if np.isfinite(told.torque).all():
        apart = float(np.abs(told.torque - rates["angular_momentum"]).max())
        assert apart <= errors["angular_momentum"] + rounding, f"a torque {apart:.1e} from the rate"
    if not scene._turns_freely:
        return  # and accelerations are refused
    given = scene.acceleration()
    apart = float(np.abs(given - rates["velocity"]).max())
    assert apart <= errors["velocity"] + rounding, f"accelerations {apart:.1e} from the rates"
