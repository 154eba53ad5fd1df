"""Scenes in which bodies turn, from a dozen small numbers: a recipe of points, some of whose bodies have a shape.

The first bodies of the plain recipe become rigid ones, of any shape (spheres, symmetric, plates, rods, needles), free
or held at a point, and loads act on them beside the forces that act on points. Everything else (methods, ensembles,
outputs, units, events) is the plain recipe's, so that its laws can be asked of these scenes, too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import METHODS, NEED_MASS, RIGID_METHODS
from hypothesis import strategies as st
from recipe import Recipe, _events, _scene, _some, _span

import visviva as vv

if TYPE_CHECKING:
    from numpy.typing import NDArray

SHAPES = ("any", "sphere", "symmetric", "plate", "rod", "needle", "tilted")
LOADS = ("spring to a place", "spring to a body", "spring to a particle", "torque", "torque in the body")
LOOKING = ("damper", "drag")  # at velocities, which kicks do not take
COLUMNS = (
    *("position", "velocity", "orientation", "angular_velocity", "energy", "momentum", "angular_momentum"),
    *("center_of_mass", "kinetic_energy", "potential_energy"),
)
OWN = ("position", "velocity", "orientation", "angular_velocity", "mass")


@dataclass(frozen=True)
class RigidRecipe(Recipe):
    """See the head of this file; every default is the plainest choice."""

    bodies: int = 1
    forces: tuple[tuple[str, int], ...] = ()
    columns: tuple[str, ...] = ("position", "velocity", "orientation", "angular_velocity")
    rigid: int = 1  # how many of the bodies have a shape
    held: int = 0  # how many of these turn about a point
    shape: str = "any"
    loads: tuple[tuple[str, int], ...] = (("torque", 0),)
    spin: float = 1.0

    @property
    def every_column(self) -> tuple[str, ...]:
        return COLUMNS

    def scene(self) -> vv.Scene:
        plain = _scene(replace(self, collisions=""))
        few = min(self.rigid, len(plain.particles))
        bodies, points = _bodies(self, plain.particles[:few]), plain.particles[few:]
        parts = [points] if len(points) else []
        loads = [_load(name, seed, few, len(points), tame=self.tame) for name, seed in self.loads]
        return vv.Scene(*parts, bodies, *plain.forces, *(load for load in loads if load is not None))

    def begun_at(self, scene: vv.Scene, t0: float) -> vv.Scene:
        return scene._like(scene.particles, scene.forces, t0)

    def copies(self, scene: vv.Scene) -> vv.EnsembleScene:
        rng = np.random.default_rng(self.seed + 2)
        rigid = scene.rigid_bodies
        assert rigid is not None
        given: dict[str, NDArray[np.float64]] = {}
        for name in self.own:
            if name not in OWN:
                continue
            value = getattr(rigid if name in ("orientation", "angular_velocity") else scene.particles, name)
            if name == "velocity" and rigid.pivoted.any():
                continue  # those of held bodies follow from their spins
            noise = rng.uniform(-1.0, 1.0, (self.members, *value.shape)) / 64.0
            if name == "position" and self.offset:
                noise *= 10.0**-self.offset
            given[name] = value * (1.0 + noise)
            if name == "orientation":
                given[name] = value + noise
                given[name] /= np.linalg.norm(given[name], axis=-1, keepdims=True)
        if not given:
            given["position"] = np.repeat(scene.particles.position[None], self.members, axis=0)
        return scene.ensemble(**given)

    def span(self, scene: vv.Scene) -> float:
        points = vv.Scene(scene.particles, *scene.forces)
        assert scene.rigid_bodies is not None
        fastest = float(np.abs(scene.rigid_bodies.angular_velocity).max(initial=0.0))
        return min(_span(points, tame=self.tame), 1.0 / max(fastest, 1.0))


def _moments(shape: str, rng: np.random.Generator, *, tame: bool) -> NDArray[np.float64]:
    """Sums of three numbers, two by two: of a body of about the size 0.3. A torque spins up what is very thin in less
    than any step."""
    a, b, c = rng.uniform(0.02, 0.1, 3)
    if shape == "sphere":
        a = b = c
    elif shape == "symmetric":
        a = b
    elif shape == "plate":
        c = 0.0
    elif shape == "rod":
        a, b = c, 0.0
        return np.array([0.0, a, a])
    elif shape == "needle":
        thin = 1.0 / 51.0 if tame else 5e-7
        a = b = thin * c
        return np.array([a + b, c + a, c + b])
    return np.array([b + c, c + a, a + b])


def _bodies(recipe: RigidRecipe, at: vv.Particles) -> vv.RigidBodies:
    rng = np.random.default_rng(recipe.seed + 11)
    count = len(at)
    mass = np.where(at.mass > 0.0, at.mass, 1.0)
    turns = rng.normal(size=(2, count, 4))
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    moments = np.array([_moments(recipe.shape, rng, tame=recipe.tame) for _ in range(count)]) * mass[:, None]
    spin = recipe.spin * rng.uniform(-1.0, 1.0, (count, 3))
    if recipe.shape == "rod":
        spin[:, 0] = 0.0
    pivot = np.full((count, 3), np.nan)
    pivot[: recipe.held] = rng.uniform(-0.4, 0.4, (min(recipe.held, count), 3))
    shape: dict[str, Any] = {"moments": moments}
    if recipe.shape == "tilted":
        shape = {
            "inertia": [vv.rigid.rotate_tensor(np.diag(m), turn) for m, turn in zip(moments, turns[1], strict=True)]
        }
    return vv.RigidBodies(
        mass,
        position=at.position,
        velocity=np.where(np.isnan(pivot), at.velocity, 0.0),
        orientation=turns[0],
        angular_velocity=spin,
        pivot=pivot if recipe.held else None,
        **shape,
    )


def _load(name: str, seed: int, rigid: int, points: int, *, tame: bool) -> Any:
    """What acts on one of the bodies, or on all; None for a spring to what is not there."""
    rng = np.random.default_rng(seed)
    size = 1.0 if tame else float(10.0 ** rng.uniform(-3.0, 3.0))
    body, point = int(rng.integers(rigid)), rng.uniform(-0.4, 0.4, 3)
    one = [None, body][int(rng.integers(2))]
    # Shorter than the ends of a tame scene can come to each other.
    spring = {"point": point, "stiffness": size * rng.uniform(0.2, 2.0), "length": rng.choice([0.0, 0.25])}
    if name == "spring to a body":
        other = {"to": (body + 1) % rigid, "to_point": rng.uniform(-0.4, 0.4, 3)}
        return vv.AttachedSpring(body, **spring, **other) if rigid > 1 else None
    if name == "spring to a particle":
        return vv.AttachedSpring(body, **spring, particle=int(rng.integers(points))) if points else None
    if name in ("spring to a place", "damper"):
        damping = size * rng.uniform(0.1, 0.5) if name == "damper" else 0.0
        return vv.AttachedSpring(body, **spring, damping=damping, anchor=rng.uniform(-1.0, 1.0, 3) + 9.0)
    if name == "drag":
        return vv.RotationalDrag(size * rng.uniform(0.01, 0.1), body=one)
    frame = "body" if name == "torque in the body" else "space"
    return vv.AppliedTorque(size * rng.uniform(-0.1, 0.1, 3), body=one, frame=frame)


@st.composite
def rigid_recipes(draw: st.DrawFn, forces: list[str]) -> RigidRecipe:
    """Anything at all, by any method that takes bodies that turn, and now and then by one that does not."""
    rigid = draw(_some((3, st.just(1)), (2, st.integers(2, 3)), (1, st.integers(4, 10))))
    bodies = rigid + draw(_some((1, st.just(0)), (1, st.integers(1, 3))))
    names = [name for name in forces if draw(st.booleans()) or name not in NEED_MASS]
    kinds = st.sampled_from(LOADS if draw(st.integers(0, 3)) else LOADS + LOOKING)
    known = _some(
        (6, st.sampled_from(sorted(RIGID_METHODS))), (1, st.just("auto")), (1, st.sampled_from(sorted(METHODS)))
    )
    powers = st.integers(-60, 60)
    return RigidRecipe(
        method=draw(known),
        bodies=bodies,
        rigid=rigid,
        held=draw(_some((2, st.just(0)), (1, st.integers(1, rigid)))),
        shape=draw(st.sampled_from(SHAPES)),
        loads=tuple(draw(st.lists(st.tuples(kinds, st.integers(0, 99)), max_size=3))),
        spin=draw(st.sampled_from([0.0, 1.0, 1.0, 10.0])),
        massless=draw(_some((2, st.just(0)), (1, st.integers(0, bodies - rigid)))),
        forces=tuple(draw(st.lists(st.tuples(st.sampled_from(names), st.integers(0, 99)), max_size=2))),
        seed=draw(st.integers(0, 2**16)),
        tame=draw(_some((3, st.just(True)), (1, st.just(False)))),
        drifting=draw(st.booleans()),
        offset=draw(_some((3, st.just(0)), (1, st.integers(1, 6)))),
        units=draw(_some((3, st.just((0, 0, 0))), (1, st.tuples(powers, powers, powers)))),
        members=draw(_some((4, st.just(0)), (4, st.integers(1, 12)), (1, st.integers(33, 40)))),
        own=tuple(draw(st.lists(st.sampled_from(OWN), unique=True, min_size=1))),
        steps=draw(st.integers(1, 24)),
        ragged=draw(st.booleans()),
        transformation=draw(_some((9, st.just("")), (1, st.just("distance")))),
        decades=draw(st.integers(5, 11)),
        outputs=draw(st.integers(0, 5)),
        columns=tuple(draw(st.lists(st.sampled_from(COLUMNS), unique=True, min_size=1))),
        # The energy is a precise sum at some twenty places of every step: seconds, of ten copies.
        events=tuple(one for one in draw(_some((3, st.just(())), (1, _events()))) if one[0] != "energy"),
        terminal=draw(_some((2, st.just(0)), (1, st.integers(1, 2)))),
        collisions=draw(_some((12, st.just("")), (1, st.sampled_from(["bounce", "merge", "stop"])))),
        t0=draw(_some((2, st.just(0.0)), (1, st.floats(-100.0, 100.0)))),
        backward=draw(_some((2, st.just(False)), (1, st.just(True)))),
    )
