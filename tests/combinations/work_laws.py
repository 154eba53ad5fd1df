"""Laws of force and work: action and reaction, work along paths and along motions, closed forms against integration."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from drawing import FORCES, METHODS, force
from law_book import EPSILON, law
from recipe import Case, Recipe, Refused
from running import execute
from solutions import change, sizes, solution, tame

import visviva as vv
from visviva import _core
from visviva.invariants import kept_by_forces

if TYPE_CHECKING:
    from numpy.typing import NDArray


def _forces(scene: vv.Scene) -> NDArray[np.float64]:
    try:
        return scene.particles.mass[:, None] * scene.acceleration()
    except vv.InvalidInput as error:
        raise Refused(f"refused {error.argument}") from error


def _alone(recipe: Recipe, **changes: Any) -> vv.Scene:
    """The scene at its start, in its own units."""
    case = replace(recipe, members=0, crowd=0, units=(0, 0, 0), **changes).case()
    assert isinstance(case.start, vv.Scene)
    return case.start


@law
def action_is_reaction(recipe: Recipe) -> None:
    """Of two bodies by `vv.audit`, weakly where the momentum is declared to stay, strongly where the spin is, too; and
    of all bodies no net force and no net torque.

    Forces that move bodies each for itself are left out: they have no reaction in the scene.
    """
    drawn = [force(name, seed, 2, tame=recipe.tame) for name, seed in recipe.forces]
    pair = _alone(recipe, bodies=2, massless=0, forces=())
    kept = [(one, kept_by_forces(vv.Scene(pair.particles, one), np.zeros(3))) for one in _acting(drawn, pair)]
    between_bodies = [(one, keeps) for one, keeps in kept if keeps["momentum"]]
    if not between_bodies:
        raise Refused("no force between bodies")
    for one, keeps in between_bodies:
        given = _forces(vv.Scene(pair.particles, one, t0=pair.t0))
        if not np.isfinite(given).all():
            raise Refused("beyond float64")
        between = np.zeros((2, 2, 3))
        between[0, 1], between[1, 0] = given
        # Accelerations are rounded, and times a mass again; a force is a sum of terms that may be larger than it.
        size = float(np.abs(given).max())
        terms = [np.abs(_forces(vv.Scene(pair.particles, part, t0=pair.t0))).max() for part in _parts(one)]
        larger = max(1.0, float(sum(terms)) / size) if size else 1.0
        found = vv.audit.third_law(pair.particles.position, between, rtol=64 * EPSILON * larger)
        assert found.weak, f"{one!r}: {given[0]} and {given[1]} are not opposite"
        assert found.strong or not keeps["spin"], f"{one!r}: {given[0]} is not along the line between the bodies"
    scene = _alone(recipe)
    whole = [one for one in scene.forces if kept_by_forces(vv.Scene(scene.particles, one), np.zeros(3))["momentum"]]
    inner = vv.Scene(scene.particles, *whole, t0=scene.t0)
    given = _forces(inner)
    bodies, keeps_all = scene.particles, kept_by_forces(inner, np.zeros(3))
    size, arms = np.abs(given).sum(), np.abs(bodies.position).max(initial=0.0)
    if not np.isfinite(size * arms):
        raise Refused("beyond float64")
    # What acts on a body is itself a sum, of terms that may be larger than it.
    terms = sum(float(np.abs(_forces(vv.Scene(bodies, one, t0=scene.t0))).sum()) for one in whole)
    allowed = 64 * EPSILON * max(size, terms) * len(bodies)
    assert np.abs(given.sum(axis=0)).max() <= allowed, f"a net force {given.sum(axis=0)} of {size:.1e}"
    if keeps_all["spin"]:
        torque = np.cross(bodies.position, given).sum(axis=0)
        assert np.abs(torque).max() <= 4 * allowed * arms, f"a net torque {torque} of {size * arms:.1e}"


def _parts(one: Any) -> list[Any]:
    """A force by listed bodies, body for body, or pair for pair: what it is the sum of."""
    lists = {parameter.name: np.atleast_1d(getattr(one, parameter.name)) for parameter in one._parameters}
    ends = [lists[parameter.name] for parameter in one._parameters if parameter.kind == "indices"]
    several = max((len(end) for end in ends), default=1)
    own = [parameter.name for parameter in one._parameters if parameter.kind in ("indices", "numbers")]
    if not ends or several == 1:
        return [one]
    return [
        replace(one, **{name: lists[name][[place if len(lists[name]) > 1 else 0]] for name in own})
        for place in range(several)
    ]


def _acting(drawn: list[Any], pair: vv.Scene) -> list[Any]:
    """Those that refuse no body of this pair, and do something to one."""
    acting = []
    for one in drawn:
        with contextlib.suppress(vv.InvalidInput):
            if vv.Scene(pair.particles, one).acceleration().any():
                acting.append(one)
    return acting


@law
def work_along_a_path_is_the_potential_energy_lost(recipe: Recipe) -> None:
    """The field that one body feels, the others being held: its work by `vv.audit`, by way of a corner."""
    scene = _alone(recipe, offset=0, tame=True, backward=False)
    bodies = scene.particles
    if not bodies.mass.any():
        raise Refused("no mass, no energy")
    if not kept_by_forces(scene, np.zeros(3))["energy"]:
        raise Refused("these forces keep no energy")
    body = int(np.flatnonzero(bodies.mass)[recipe.seed % np.count_nonzero(bodies.mass)])
    still = np.zeros_like(bodies.velocity)

    def at(place: NDArray[np.float64]) -> vv.Scene:
        x = bodies.position.copy()
        x[body] = place
        return scene.with_state(x, still)

    forces = scene._keywords["forces"]

    def field(places: NDArray[np.float64]) -> NDArray[np.float64]:
        # At thousands of places: to make a scene at each would take most of a search.
        given = np.empty_like(places)
        for place, into in zip(places, given, strict=True):
            x = bodies.position.copy()
            x[body] = place
            into[:] = _core.acceleration(mass=bodies.mass, forces=forces, position=x, velocity=still, t0=scene.t0)[body]
        return bodies.mass[body] * given

    corners = bodies.position[body] + np.random.default_rng(recipe.seed + 6).uniform(-0.2, 0.2, (3, 3))
    if recipe.planar:
        corners[:, 2] = 0.0
    try:
        energies = [at(corner).invariants().potential_energy for corner in corners[::2]]
        # The largest force on the way, about.
        size = float(np.abs([_forces(at(corner))[body] for corner in corners]).max())
        work = vv.audit.work(field, corners, rtol=1e-9)
    except vv.InvalidInput as error:
        raise Refused(error.argument) from error
    # Energies are sums over all the bodies, a rounding of which is more than the tolerance of a small work.
    allowed = 1e-8 * size + 64 * EPSILON * max(map(abs, energies)) * len(bodies)
    lost = energies[0] - energies[1]
    assert abs(work - lost) <= allowed, f"work {work:.9e}, {lost:.9e} lost, {allowed:.1e} allowed"


NODES = 64
# Boole's rule of order 6, of four intervals.
BOOLE = np.array([14.0, 64.0, 24.0, 64.0, 14.0]) / 45.0


def _by_boole(powers: NDArray[np.float64], span: float) -> float:
    """∫ dt over that span of values at equal distances."""
    fours = powers[:-1].reshape(-1, 4) @ BOOLE[:4] + powers[4::4] * BOOLE[4]
    return span / (len(powers) - 1) * float(fours.sum())


@law
def the_work_of_the_forces_is_the_kinetic_energy_gained(recipe: Recipe) -> None:
    """∫ Σ F·v dt over a run, whatever the forces: drag, drives and magnetic fields, which do none.

    As far as the error of the states lets it, which is measured.
    """
    case = tame(replace(recipe, members=0, offset=0, backward=False))
    scene = case.members()[0]
    mass = scene.particles.mass
    if not mass.any():
        raise Refused("no mass, no energy")
    _, _, error_x, error_v = solution(case, recipe.method)
    span = case.t[-1] - scene.t0
    method = METHODS.get(recipe.method)
    times = tuple(scene.t0 + span * node / NODES for node in range(1, NODES + 1))
    how: dict[str, Any] = {"dt": span / NODES} if method and not method.adaptive else {"rtol": 1e-11}
    out, _ = execute(scene, times, {"method": recipe.method, **how, "record": ("position", "velocity")})
    x = np.concatenate([scene.particles.position[None], out.position[-NODES:]])
    v = np.concatenate([scene.particles.velocity[None], out.velocity[-NODES:]])
    t = (scene.t0, *times)
    rng = np.random.default_rng(recipe.seed)

    def power(place: NDArray[np.float64], speed: NDArray[np.float64], now: float) -> float:
        return float((_forces(scene.with_state(place, speed, now)) * speed).sum())

    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        powers = np.array([power(*state) for state in zip(x, v, t, strict=True)])
    pushed = float(np.abs(_forces(scene.with_state(x[-1], v[-1], t[-1]))).max(initial=0.0))
    if (
        not np.isfinite(powers).all()
        or 0.0 < pushed * float(np.abs(v[-1]).max(initial=0.0)) < 1e-290
        or (pushed > 0.0 and not powers.any())
    ):
        raise Refused("beyond float64")
    work, coarse = (_by_boole(powers[::every], span) for every in (1, 2))
    kinetic = 0.5 * (mass[:, None] * v**2).sum(axis=(1, 2))
    # What the errors of a state make of the power, about, seen at some of the states.
    off = 0.0
    for node in range(0, NODES + 1, NODES // 4):
        signs = rng.choice([-1.0, 1.0], (2, *x[node].shape))
        moved = power(x[node] + error_x * signs[0], v[node] + error_v * signs[1], t[node])
        off = max(off, abs(moved - powers[node]))
    momentum = float((mass[:, None] * np.abs(v)).sum(axis=(1, 2)).max())
    most = span * float(np.abs(powers).max())
    size = most + float(kinetic.max())
    # One node that stands out is a fiftieth of the largest power over the span, for one rule and not for the other.
    if abs(work - coarse) > max(1e-2 * most, 1e-10 * size):
        raise Refused("powers that are felt at single nodes only, of which the rule tells nothing")
    # Powers are smooth on the scale of the span; the rule then errs by 1e-12 of them, and of those that change faster
    # by less than an eighth of what twice the interval does.
    allowed = 4 * (span * off + momentum * error_v) + 1e-10 * size + abs(work - coarse) / 8.0
    gained = float(kinetic[-1] - kinetic[0])
    if not np.isfinite([work, gained, allowed]).all():
        raise Refused("beyond float64")
    assert abs(work - gained) <= allowed, f"work {work:.9e}, {gained:.9e} gained, {allowed:.1e} allowed"


# Forces that have a closed form together, by how many bodies; what is not a force's own is told by `_on_a_line`.
FAMILIES: list[tuple[int, tuple[str, ...]]] = [
    (3, ()),
    (3, ("UniformField",)),
    (3, ("UniformField", "UniformElectricField")),
    (2, ("Gravity",)),
    (2, ("Coulomb",)),
    (1, ("CentralField",)),
    (3, ("LinearDrag",)),
    (3, ("LinearDrag", "UniformField")),
    (3, ("UniformMagneticField",)),
    (3, ("UniformMagneticField", "UniformElectricField")),
    (3, ("UniformMagneticField", "UniformField")),
    (3, ("RotatingFrame",)),
    (3, ("Harmonic",)),
    (3, ("Harmonic", "LinearDrag")),
    (3, ("Harmonic", "LinearDrag", "DrivenForce")),
    (3, ("DrivenForce", "UniformField")),
    (3, ("QuadraticDrag",)),
    (3, ("QuadraticDrag", "LinearDrag")),
    (3, ("QuadraticDrag", "UniformField")),
    (3, ("Harmonic", "UniformMagneticField")),
    (3, ("Harmonic", "RotatingFrame", "LinearDrag")),
]


def closed_form_case(recipe: Recipe) -> Case:
    """A recipe of the family that its seed says."""
    bodies, names = FAMILIES[recipe.seed % len(FAMILIES)]
    seeds = [recipe.seed // len(FAMILIES) % 100 + place for place in range(len(names))]
    if names == ("CentralField",):
        # One with a closed form: that of a potential k/r.
        drawn = (seed for seed in range(400) if isinstance(_of("CentralField", seed).potential, vv.potentials.Coulomb))
        seeds = [next(drawn)]
    forces = tuple(zip(names, seeds, strict=True))
    case = tame(
        replace(recipe, method="auto", bodies=bodies, massless=0, crowd=0, forces=forces, members=0, planar=False)
    )
    scene = case.start
    assert isinstance(scene, vv.Scene)
    if names == ("Gravity",) and recipe.seed % 2:
        # One that has mass, and others that move about it.
        bodies_ = scene.particles
        start = vv.Scene(
            vv.Particles([bodies_.mass[0], 0.0], bodies_.position, bodies_.velocity), *scene.forces, t0=scene.t0
        )
        return replace(case, start=start)
    if names == ("QuadraticDrag", "UniformField"):
        return replace(case, start=_on_a_line(scene))
    return case


def _of(name: str, seed: int) -> Any:
    return force(name, seed, 1, tame=True)


def _on_a_line(scene: vv.Scene) -> vv.Scene:
    """Velocities along the field, up and down."""
    field = np.array(next(one.g for one in scene.forces if isinstance(one, FORCES["UniformField"])))
    x, v = scene.particles.position, scene.particles.velocity
    # As fast as they are, whatever the units of the field.
    size = np.abs(field).max()
    return scene.with_state(x, v[:, :1] * (field / size if size > 0.0 else field))


@law
def a_closed_form_is_what_integration_gives(recipe: Recipe) -> None:
    case = closed_form_case(recipe)
    scene = case.start
    assert isinstance(scene, vv.Scene)
    t = (*(scene.t0 + (case.t[-1] - scene.t0) * share for share in (0.25, 0.7)), case.t[-1])
    names = {"record": ("position", "velocity")}
    closed, ended = execute(scene, t, {"method": "auto", **names})
    if closed is None:
        raise Refused(ended)
    if not closed.plan.closed_form:
        raise Refused("no closed form")
    assert closed.stats.evaluations == 0
    stepped, ended = execute(scene, t, {"method": "dop853", "rtol": 1e-12, **names})
    assert not ended
    length, speed = sizes(case)
    # A few steps of the tolerance, and their rounding.
    for name, size in (("position", length), ("velocity", speed)):
        apart = change((getattr(closed, name),), (getattr(stepped, name),))[0]
        allowed = (1e-11 + 128 * EPSILON) * size
        assert apart <= allowed, f"{closed.plan.solution}: {name} {apart:.1e} apart, {allowed:.1e} allowed"
