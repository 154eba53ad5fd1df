"""Laws of motion that hold in every frame: displaced, boosted and turned scenes, motion reversed, legs of a run.

They are asked of tame recipes at rest about the origin, so that what is far away or fast is so by the law's own doing.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import METHODS
from law_book import EPSILON, law
from recipe import Case, Recipe, Refused
from solutions import change, rough, sizes, solution, states, tame

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import NDArray

STEPS = 32
TOLERANCE = 1e-10


def _here(recipe: Recipe) -> Case:
    return tame(replace(recipe, members=0, offset=0, drifting=False))


def _units(recipe: Recipe) -> tuple[float, float]:
    """Of length and time, in which the scene is what it is without any: another frame has a size that is one to it."""
    here, plain = (_here(each) for each in (recipe, replace(recipe, units=(0, 0, 0))))
    sizes_of = [float(np.abs(_scene(case).particles.position).max(initial=0.0)) for case in (here, plain)]
    return (sizes_of[0] / sizes_of[1] if sizes_of[1] > 0.0 else 1.0), _span(here) / _span(plain)


def _how(case: Case, name: str) -> dict[str, Any]:
    """Steps that are as long here as there, or a tolerance that low orders reach, too."""
    method = METHODS.get(name)
    if method is None or method.adaptive:
        order = method.order if method else 8
        return {"method": name, "rtol": max(TOLERANCE, 10.0 ** (-2.0 * order)), "max_steps": 20_000}
    return {"method": name, "dt": abs(case.t[-1] - case.start.t0) / STEPS}  # type: ignore[union-attr]


def _rounding(case: Case, far: float = 0.0, fast: float = 0.0) -> tuple[float, float]:
    """Of some tens of compensated steps, with forces that see rounded coordinates: `far` and `fast` are the largest
    coordinate and velocity by which another frame adds to them."""
    length, speed = sizes(case)
    return 128 * EPSILON * (length + far), 128 * EPSILON * (speed + fast + far / _span(case))


def _again(case: Case, how: dict[str, Any], here: Any) -> tuple[float, float]:
    """How far the same steps, rounded otherwise, may lead elsewhere: one at the brink of refusal may be refused, which
    costs about the error of the whole. No size of the scene enters, lest a tolerance grow with what is far away.
    """
    if "dt" in how:
        return 0.0, 0.0
    error_x, error_v = change(here, states(case, **how | {"rtol": max(how["rtol"] / 100.0, 2.5e-14)}))
    bodies, span = _scene(case).particles, _span(case)
    speed = float(np.abs(bodies.velocity).max() + np.abs(_scene(case).acceleration()).max() * span)
    return 4.0 * (error_x + how["rtol"] * speed * span), 4.0 * (error_v + how["rtol"] * speed)


def _sum(*bounds: tuple[float, float]) -> tuple[float, float]:
    return sum(bound[0] for bound in bounds), sum(bound[1] for bound in bounds)


def _tolerated(case: Case, how: dict[str, Any]) -> tuple[float, float]:
    """As far as the tolerance lets steps that are others lead elsewhere: by as much in each of some tens of them."""
    length, speed = sizes(case)
    share = 100.0 * how.get("rtol", 0.0)
    return share * length, share * speed


def _grown(case: Case, how: dict[str, Any], far: float) -> tuple[float, float]:
    """Where 32 roundings of every coordinate at the start may lead, near approaches making more of them: as starts that
    are 2^-30 of themselves elsewhere do, in proportion."""
    scene, signs = _scene(case), np.random.default_rng(len(how))
    bodies, off = scene.particles, 2.0**-30
    x = bodies.position + off * (np.abs(bodies.position) + far) * signs.choice([-1.0, 1.0], bodies.position.shape)
    elsewhere = _changed(case, scene.with_state(x, bodies.velocity, scene.t0))
    error_x, error_v = change(states(case, **how), states(elsewhere, **how))
    return 32 * EPSILON / off * error_x, 32 * EPSILON / off * error_v


def _alike(
    what: str, first: Any, second: Any, allowed: tuple[float, float], run: tuple[Case, dict[str, Any]], far: float = 0.0
) -> None:
    """Two states of one run within what is allowed; if that is passed, also with what the motion makes of rounding."""
    apart = change(first, second)
    if apart[0] <= allowed[0] and apart[1] <= allowed[1]:
        return
    allowed = _sum(allowed, _grown(*run, far))
    for name, found, bound in zip(("positions", "velocities"), apart, allowed, strict=True):
        assert found <= bound, f"{what}: {name} {found:.1e} apart, {bound:.1e} allowed"


def _changed(case: Case, scene: vv.Scene) -> Case:
    return replace(case, start=scene)


def _scene(case: Case) -> vv.Scene:
    assert isinstance(case.start, vv.Scene)
    return case.start


@law
def a_scene_moves_alike_in_another_frame(recipe: Recipe) -> None:
    """Galilei: displaced, and at a uniform velocity where no force has a place or a medium at rest."""
    case = _here(recipe)
    scene, rng = _scene(case), np.random.default_rng(recipe.seed + 4)
    origin = 10.0 ** (recipe.offset % 7) * rng.uniform(-1.0, 1.0, 3)
    velocity = 4.0 * rng.uniform(-1.0, 1.0, 3)
    length, time = _units(recipe)
    origin, velocity = origin * length, velocity * (length / time)
    if recipe.planar:
        origin[2] = velocity[2] = 0.0
    if any(force._at_rest for force in scene.forces):
        velocity = np.zeros(3)
    other = scene.in_frame(velocity=velocity, origin=origin)
    how = _how(case, recipe.method)
    here, (x, v) = states(case, **how), states(_changed(case, other), **how)
    back = x + (origin + velocity * case.t[-1]), v + velocity
    far = float(np.abs(origin).max() + np.abs(velocity * case.t[-1]).max())
    allowed = _sum(_again(case, how, here), _rounding(case, far, float(np.abs(velocity).max())))
    _alike(f"{recipe.method} in another frame", here, back, allowed, (case, how), far)


def _orthogonal(seed: int, *, planar: bool) -> NDArray[np.float64]:
    """Any rotation, or one with a mirror; about z if the motion is to stay in its plane."""
    rng = np.random.default_rng(seed)
    matrix = np.eye(3)
    count = 2 if planar else 3
    matrix[:count, :count] = np.linalg.qr(rng.normal(size=(count, count)))[0]
    # Of so many dimensions all of these are rotations, or all mirrors.
    matrix[0] *= rng.choice([-1.0, 1.0])
    return matrix


@law
def a_turned_scene_moves_alike(recipe: Recipe) -> None:
    """In any direction, and in any mirror, the forces being turned with the bodies."""
    case = _here(recipe)
    matrix = _orthogonal(recipe.seed + 5, planar=recipe.planar)
    how = _how(case, recipe.method)
    turned = _changed(case, _scene(case).rotated(matrix))
    here, there = (states(each, **how) for each in (case, turned))
    x, v = (part @ matrix.T for part in here)
    # The matrix itself is rounded. Across a jump a step errs by where it begins: there by another error than here.
    allowed = _sum(_again(case, how, here), _rounding(case))
    if rough(case):
        allowed = _sum(allowed, _again(turned, how, there))
    _alike(f"{recipe.method}, turned", (x, v), there, allowed, (case, how))


@law
def what_is_reversed_retraces_its_path(recipe: Recipe) -> None:
    """A reversible method undoes its steps; the others err on the way there and on the way back."""
    case = _here(recipe)
    method = METHODS.get(recipe.method)
    try:
        _scene(case).reversed()
    except vv.InvalidInput as error:
        raise Refused("a force that has no reverse") from error
    if method is None or not method.reversible:
        _, _, error_x, error_v = solution(case, recipe.method)
        how = _how(case, recipe.method) | ({} if method is None or method.adaptive else {"dt": _span(case) / 1024})
        allowed = _sum((4.0 * error_x, 4.0 * error_v), _tolerated(case, how), _rounding(case))
    else:
        how = _how(case, recipe.method)
        allowed = _rounding(case)
    scene = _scene(case)
    x, v = states(case, **how)
    turned = scene.with_state(x, v, case.t[-1]).reversed()
    there = (2.0 * case.t[-1] - scene.t0,)
    y, w = states(Case(turned, there), **how)
    bodies = scene.particles
    if method is None or not method.reversible:
        # The error of the way there grows on the way back as much as whatever is off at the turn.
        signs = np.random.default_rng(recipe.seed).choice([-1.0, 1.0], (2, *x.shape))
        off = turned.with_state(x + error_x * signs[0], turned.particles.velocity + error_v * signs[1], case.t[-1])
        allowed = _sum(allowed, change((y, w), states(Case(off, there), **how)))
    _alike(
        f"{recipe.method}, there and back",
        (bodies.position, bodies.velocity),
        (y, -w),
        allowed,
        (Case(turned, there), how),
    )


def _span(case: Case) -> float:
    return abs(case.t[-1] - case.members()[0].t0)


@law
def backward_in_time_is_forward_reversed(recipe: Recipe) -> None:
    """To the bit: rounding is symmetric about zero."""
    case = _here(replace(recipe, t0=0.0))
    scene = _scene(case)
    try:
        mirrored = scene.reversed()
    except vv.InvalidInput as error:
        raise Refused("a force that has no reverse") from error
    how = _how(case, recipe.method)
    x, v = states(case, **how)
    y, w = states(Case(mirrored, (-case.t[-1],)), **how)
    assert np.array_equal(x, y), f"other positions, {np.abs(x - y).max():.1e} apart"
    assert np.array_equal(v, -w), f"other velocities, {np.abs(v + w).max():.1e} apart"


@law
def two_legs_make_one_run(recipe: Recipe) -> None:
    """The state at the end of one leg is all that the next one needs: the flow is a semigroup.

    From a scene that remembers nothing of the first leg; that a run goes on to the bit is asked by another law.
    """
    case = _here(recipe)
    scene, how = _scene(case), _how(case, recipe.method)
    node = 1 + recipe.seed % (STEPS - 1)
    middle = scene.t0 + (case.t[-1] - scene.t0) * node / STEPS
    whole = states(case, **how)
    x, v = states(Case(scene, (middle,)), **how)
    legs = states(Case(scene.with_state(x, v, middle), case.t), **how)
    allowed = _sum(_tolerated(case, how), _rounding(case))
    if recipe.method == "stormer13":
        # A multistep method starts anew with another one.
        _, _, error_x, error_v = solution(case, recipe.method)
        allowed = _sum(allowed, (2.0 * error_x, 2.0 * error_v))
    _alike(f"{recipe.method} in two legs", whole, legs, allowed, (case, how))
