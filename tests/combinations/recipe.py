"""A scene, a method and what is asked, from a dozen small numbers that print as one line.

`Recipe` is what Hypothesis draws, what a failing search prints, and what an ``@example`` holds. `Recipe.case` makes of
it what is run. A *tame* recipe keeps its bodies apart for the whole span by construction (they start on a jittered grid
of spacing 2 and cannot move by more than 0.3), so that every method resolves it and two of them can be compared; any
other may hold collisions, bodies at rest at the origin, wild parameters and absurd units, and only laws that hold for
those, too, are asked of it.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import EVENTS, FORCES, METHODS, NEED_MASS, RIGID_METHODS, declared, event, force
from hypothesis import strategies as st

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import NDArray

COLUMNS = ("position", "velocity", "energy", "momentum", "angular_momentum", "center_of_mass")
OWN = ("position", "velocity", "mass", "radius", "parameters", "numbers")
MAX_STEPS = 1500


class Refused(Exception):
    """There is nothing to be judged."""


@dataclass(frozen=True)
class Recipe:
    """See the head of this file; every default is the plainest choice."""

    method: str = "auto"
    bodies: int = 2
    massless: int = 0
    crowd: int = 0  # further massless bodies
    forces: tuple[tuple[str, int], ...] = (("Gravity", 0),)
    seed: int = 0
    tame: bool = True
    planar: bool = False
    at_origin: bool = False  # the last body rests at the origin
    drifting: bool = False  # the whole moves
    offset: int = 0  # decades; 0 is none
    units: tuple[int, int, int] = (0, 0, 0)  # powers of two of length, mass and time
    members: int = 0  # 0: a scene alone
    own: tuple[str, ...] = ("position",)  # what the members have of their own
    own_massless: bool = False  # members differ in which bodies are massless
    wild_member: bool = False  # one member is far larger than the others
    steps: int = 12  # of a fixed-step method, in the span
    ragged: bool = False  # the end is not a node
    transformation: str = ""  # what a time transformation watches, of a method that has them
    decades: int = 9  # the tolerance of an adaptive method, 10^-decades
    outputs: int = 0
    columns: tuple[str, ...] = ("position", "velocity")
    events: tuple[tuple[str, int], ...] = ()
    terminal: int = 0  # the zero of the first of them with which the run ends; 0: none
    collisions: str = ""  # what spheres do that touch; none are without
    restitution: float = 1.0
    t0: float = 0.0
    backward: bool = False

    def case(self) -> Case:
        """What is to be run."""
        try:
            return _case(self)
        except vv.InvalidInput as error:
            # A part that makes no sense here, such as a spring between a body and itself.
            raise Refused(f"refused {error.argument}") from error

    @property
    def every_column(self) -> tuple[str, ...]:
        """All that may be recorded of it."""
        return COLUMNS

    def scene(self) -> vv.Scene:
        """Where it begins, in its own units and at the time 0."""
        return _scene(self)

    def begun_at(self, scene: vv.Scene, t0: float) -> vv.Scene:
        """The same at another time."""
        return vv.Scene(scene.particles, *scene.forces, t0=t0)

    def copies(self, scene: vv.Scene) -> vv.EnsembleScene:
        """Those that differ as the recipe says."""
        return _ensemble(self, scene)

    def span(self, scene: vv.Scene) -> float:
        """How long it is followed."""
        return _span(scene, tame=self.tame)


@dataclass(frozen=True)
class Case:
    """A scene or an ensemble, and the arguments of its run."""

    start: vv.Scene | vv.EnsembleScene
    t: tuple[float, ...]
    how: dict[str, Any] = field(default_factory=dict)

    @property
    def alone(self) -> bool:
        return isinstance(self.start, vv.Scene)

    def members(self) -> list[vv.Scene]:
        return [self.start] if isinstance(self.start, vv.Scene) else list(self.start)


def _grid(count: int, rng: np.random.Generator, *, planar: bool) -> NDArray[np.float64]:
    side = 7 if planar else 4
    axis = np.arange(side) - side // 2
    points = np.stack(np.meshgrid(axis, axis, [0] if planar else axis, indexing="ij"), axis=-1).reshape(-1, 3)
    chosen = points[rng.permutation(len(points))[np.arange(count) % len(points)]]
    # A crowd of massless bodies shares the places; they do not feel each other.
    return 2.0 * chosen + rng.uniform(-0.3, 0.3, (count, 3))


def _scene(recipe: Recipe) -> vv.Scene:
    rng = np.random.default_rng(recipe.seed)
    count = recipe.bodies + recipe.crowd
    mass = rng.uniform(0.5, 1.5, count)
    # A force may need every mass: then massless bodies are refused, which is a case, too.
    mass[count - min(recipe.massless + recipe.crowd, count) :] = 0.0
    if recipe.tame:
        position = _grid(count, rng, planar=recipe.planar)
        velocity = rng.uniform(-0.3, 0.3, (count, 3))
        mass[: recipe.bodies] /= recipe.bodies
    else:
        position, velocity = rng.uniform(-1.0, 1.0, (2, count, 3))
        velocity *= rng.choice([0.0, 0.3, 3.0])
        mass *= 10.0 ** rng.integers(-3, 2, count)
    if recipe.planar:
        position[:, 2] = velocity[:, 2] = 0.0
    if recipe.at_origin:
        position[-1] = velocity[-1] = 0.0
    if recipe.drifting:
        velocity = velocity + np.array([0.25, -0.125, 0.0])
    forces = [force(name, seed, count, tame=recipe.tame) for name, seed in recipe.forces]
    return vv.Scene(vv.Particles(mass, position, velocity, radius=_radii(recipe, position)), *forces)


def _radii(recipe: Recipe, position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Spheres that almost reach their neighbors, and points; those of some members overlap, which is refused."""
    count = len(position)
    if not recipe.collisions or count < 2:
        return np.zeros(count)
    rng = np.random.default_rng(recipe.seed + 7)
    apart = np.linalg.norm(position[:, None] - position, axis=-1)
    np.fill_diagonal(apart, np.inf)
    radius: NDArray[np.float64] = 0.47 * apart.min(axis=1) * rng.uniform(0.2, 1.0, count) * rng.choice([0, 1, 1], count)
    return radius


def _span(scene: vv.Scene, *, tame: bool) -> float:
    """So short that no body moves by more than 0.3 (tame), or about a crossing time."""
    speed = float(np.abs(scene.particles.velocity).max(initial=0.0)) * 2.0
    try:
        acceleration = float(np.abs(scene.acceleration()).max(initial=0.0)) * 2.0
    except vv.InvalidInput:
        acceleration = 1.0
    if not np.isfinite(acceleration):
        acceleration = 1.0
    span = min(1.0 / max(speed, 0.05), 1.0 / max(acceleration, 0.01) ** 0.5)
    return (0.25 if tame else 1.0) * span


@lru_cache(maxsize=8)  # every law asks for it again
def _case(recipe: Recipe) -> Case:
    scene = recipe.scene()
    # A step that is a power of two and a start that is a multiple of it: every node is exact.
    step = 2.0 ** np.floor(np.log2(recipe.span(scene) / recipe.steps))
    t0 = recipe.t0 if recipe.t0 == 0.0 else np.round(recipe.t0 / step) * step
    if recipe.offset:
        away = 10.0**recipe.offset * np.array([1.0, -2.0, 0.0 if recipe.planar else 0.5])
        scene = scene.shifted(position=away)
    scene = recipe.begun_at(scene, float(t0))
    power = recipe.units[1] + 2 * (recipe.units[0] - recipe.units[2])
    # An energy in the new units must be a number, and no square on the way to it beyond float64.
    if any(recipe.units) and abs(power) < 800:
        length, mass, time = (2.0**power for power in recipe.units)
        try:
            scene = scene.rescaled(length=length, mass=mass, time=time)
            step *= time
        except vv.InvalidInput:
            pass  # potentials that cannot be scaled, or numbers beyond float64
    start: vv.Scene | vv.EnsembleScene = scene
    if recipe.members:
        start = recipe.copies(scene)
    sign = -1.0 if recipe.backward else 1.0
    end = (recipe.steps - 0.4 if recipe.ragged else recipe.steps) * step
    rng = np.random.default_rng(recipe.seed + 1)
    # Half of the outputs fall on nodes.
    places = [
        step * int(rng.integers(0, recipe.steps)) if i % 2 else float(rng.random()) * end for i in range(recipe.outputs)
    ]
    times = sorted({min(place, end) for place in places} | {end})
    method = METHODS.get(recipe.method) or RIGID_METHODS.get(recipe.method)
    how: dict[str, Any] = {"method": recipe.method, "record": recipe.columns}
    if method is None or method.adaptive:
        how |= {"rtol": 10.0**-recipe.decades, "max_steps": MAX_STEPS}
    else:
        how["dt"] = step
        if recipe.transformation and method.time_transformation:
            how |= {"time_transformation": recipe.transformation, "max_steps": MAX_STEPS}
    # Points alone are refused.
    spheres = scene.particles.radius.any()
    if recipe.collisions and spheres:
        how["collisions"] = recipe.collisions
    if recipe.collisions == "bounce" and spheres:
        how["restitution"] = recipe.restitution
    if recipe.events:
        looked_for = [event(name, seed, scene, sign * end) for name, seed in recipe.events]
        how["events"] = (replace(looked_for[0], terminal=recipe.terminal), *looked_for[1:])
    return Case(start, tuple(scene.t0 + sign * time for time in times), how)


def _ensemble(recipe: Recipe, scene: vv.Scene) -> vv.EnsembleScene:
    rng = np.random.default_rng(recipe.seed + 2)
    count, bodies = recipe.members, len(scene.particles)
    given: dict[str, NDArray[np.float64]] = {}
    parameters = _parameters(scene, count, recipe.own) if {"parameters", "numbers"} & set(recipe.own) else None
    for name in recipe.own or ("position",):
        if name in ("parameters", "numbers"):
            continue
        value = getattr(scene.particles, name)
        noise = rng.uniform(-1.0, 1.0, (count, *value.shape)) / 64.0
        if name == "position" and recipe.offset:
            # Relative to the offset that would move them by far more than their size.
            noise *= 10.0**-recipe.offset
        given[name] = value * (1.0 + noise)
    if "mass" in given and recipe.own_massless:
        given["mass"] = np.where(rng.random((count, bodies)) < 0.3, 0.0, given["mass"])
    if "position" in given and recipe.wild_member and not recipe.tame:
        given["position"][count // 2] *= 2.0 ** int(rng.integers(5, 300))
    if not given and not parameters:
        given["position"] = np.repeat(scene.particles.position[None], count, axis=0)
    return scene.ensemble(**given, **({"parameters": parameters} if parameters else {}))


def _parameters(scene: vv.Scene, count: int, own: tuple[str, ...]) -> dict[int, dict[str, list[Any]]]:
    """Of the forces: numbers and vectors, of three kinds among the members; numbers of bodies and links, and those of
    potentials, each member's."""
    kinds = {"number", "vector", "axial_vector", "point"} if "parameters" in own else set()
    factors = 1.0 + (np.arange(count) % 3) / 64.0
    each = 1.0 + np.arange(count) / 64.0
    found: dict[int, dict[str, list[Any]]] = {}
    for place, term in enumerate(scene.forces):
        values = {}
        for parameter in declared(type(term)):
            value = getattr(term, parameter["name"])
            if parameter["kind"] in kinds:
                values[parameter["name"]] = np.multiply.outer(factors, np.array(value)).tolist()
            elif parameter["kind"] == "numbers" and "numbers" in own:
                values[parameter["name"]] = np.multiply.outer(each, np.array(value)).tolist()
            elif parameter["kind"] == "potential" and "numbers" in own:
                values[parameter["name"]] = [_with_strength(value, factor) for factor in each.tolist()]
        if values:
            found[place] = values
    return found


def _with_strength(potential: Any, factor: float) -> Any:
    """It with the first of its parameters times a factor, if that is a number."""
    name = inspect.signature(type(potential)).parameters
    first = next(iter(name))
    value = getattr(potential, first)
    return potential if not isinstance(value, float) else replace(potential, **{first: value * factor})


def _some(*weighted: tuple[int, st.SearchStrategy[Any]]) -> st.SearchStrategy[Any]:
    """One of these, by weights: `one_of` takes a strategy that it is given several times for one."""
    places = [place for place, (weight, _) in enumerate(weighted) for _ in range(weight)]
    return st.sampled_from(places).flatmap(lambda place: weighted[place][1])


def _events() -> st.SearchStrategy[Any]:
    return st.lists(st.tuples(st.sampled_from(EVENTS), st.integers(0, 99)), min_size=1, max_size=3).map(tuple)


@st.composite
def recipes(draw: st.DrawFn, *, tame: bool | None = None) -> Recipe:
    """Anything at all, or what is tame."""
    mild = draw(st.booleans()) if tame is None else tame
    bodies = draw(_some((3, st.integers(1, 4)), (2, st.integers(5, 12)), (1, st.integers(13, 40))))
    members = draw(_some((3, st.just(0)), (2, st.integers(1, 12)), (1, st.integers(13, 40))))
    if members * bodies > 240:
        members = max(1, 240 // bodies)
    collisions = draw(_some((3, st.just("")), (1, st.sampled_from(["bounce", "merge", "stop"]))))
    powers = st.integers(-60, 60) if mild else st.integers(-330, 330)
    names = sorted(FORCES)
    # By weights: a list of up to three is empty in half of the scenes.
    count = draw(_some((1, st.just(0)), (4, st.just(1)), (4, st.just(2)), (2, st.just(3))))
    forces = draw(st.tuples(*[st.tuples(st.sampled_from(names), st.integers(0, 99))] * count))
    # What acts by its force refuses bodies without mass, which is to be seen, but not in half of all scenes.
    few = 10 if any(name in NEED_MASS for name, _ in forces) else 1
    with_crowd = members == 0 and bodies < 8
    crowd = draw(_some((12 * few, st.just(0)), (1, st.sampled_from([70, 130, 210])))) if with_crowd else 0
    events = draw(_some((3, st.just(())), (1, _events())))
    # The energy of N bodies is a precise sum over N² pairs, at some twenty places of every step.
    events = tuple(event for event in events if event[0] != "energy" or bodies <= 8)
    return Recipe(
        method=draw(st.sampled_from(["auto", *METHODS])),
        bodies=bodies,
        massless=draw(_some((2 * few, st.just(0)), (1, st.integers(0, bodies)))),
        crowd=crowd,
        forces=forces,
        seed=draw(st.integers(0, 2**16)),
        tame=mild,
        planar=draw(_some((3, st.just(False)), (1, st.just(True)))),
        at_origin=draw(_some((3, st.just(False)), (1, st.just(True)))),
        drifting=draw(st.booleans()),
        offset=draw(_some((3, st.just(0)), (1, st.integers(1, 9)))),
        units=draw(_some((3, st.just((0, 0, 0))), (1, st.tuples(powers, powers, powers)))),
        members=members,
        own=tuple(draw(st.lists(st.sampled_from(OWN), unique=True, min_size=1))),
        own_massless=draw(_some((3 * few, st.just(False)), (1, st.just(True)))),
        wild_member=draw(_some((5, st.just(False)), (1, st.just(True)))),
        steps=draw(st.integers(1, 40)),
        ragged=draw(st.booleans()),
        transformation=draw(_some((2, st.just("")), (1, st.sampled_from(["distance", "potential_energy"])))),
        decades=draw(st.integers(5, 12)),
        outputs=draw(st.integers(0, 6)),
        columns=tuple(draw(st.lists(st.sampled_from(COLUMNS), unique=True, min_size=1))),
        events=events,
        collisions=collisions,
        restitution=draw(st.sampled_from([1.0, 1.0, 0.5, 0.0])),
        terminal=draw(_some((2, st.just(0)), (1, st.integers(1, 2)))),
        t0=draw(_some((2, st.just(0.0)), (1, st.floats(-100.0, 100.0)))),
        backward=draw(_some((2, st.just(False)), (1, st.just(True)))),
    )
