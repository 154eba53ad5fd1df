"""Massless bodies feel the massive ones and nothing else: no bit of one depends on the others, nor of a massive one."""

from functools import cache
from typing import Any

import numpy as np
import pytest

import visviva as vv

OUTER = vv.problems.outer_solar_system().scene
SPAN = 20_000.0
MASSIVE = len(OUTER.particles.mass)
CLOUD = 1000
ADAPTIVE = [method.name for method in vv.methods() if method.adaptive]
FIXED = [method.name for method in vv.methods() if not method.adaptive]
GRAVITY = OUTER.forces[0]


@cache
def cloud() -> tuple[np.ndarray, np.ndarray]:
    """Orbits about the Sun between the planets, inclined and not quite circular."""
    random = np.random.default_rng(11)
    sun = OUTER.particles
    radius, angle = random.uniform(2.5, 40.0, CLOUD), random.uniform(0.0, 2.0 * np.pi, CLOUD)
    speed = np.sqrt(GRAVITY.G * sun.mass[0] / radius) * random.uniform(0.9, 1.1, CLOUD)
    tilt = random.uniform(-0.2, 0.2, CLOUD)
    x = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), tilt], axis=1)
    v = speed[:, None] * np.stack([-np.sin(angle), np.cos(angle), tilt], axis=1)
    return x + sun.position[0], v + sun.velocity[0]


def beside_planets(which: "list[int] | range", *forces: Any) -> vv.Scene:
    x, v = cloud()
    planets = OUTER.particles
    which = list(which)
    bodies = vv.Particles(
        np.concatenate([planets.mass, np.zeros(len(which))]),
        np.concatenate([planets.position, x[which]]),
        np.concatenate([planets.velocity, v[which]]),
    )
    return vv.Scene(bodies, *(forces or (GRAVITY,)))


def same(a: Any, i: int, b: Any, j: int) -> bool:
    return np.array_equal(a.position[:, i], b.position[:, j]) and np.array_equal(a.velocity[:, i], b.velocity[:, j])


TIMES = np.linspace(0.0, SPAN, 8)


@pytest.mark.parametrize("others", [1, 63, 64, 65, CLOUD - 1])
def test_a_massless_body_has_the_bits_it_has_alone(others: int) -> None:
    """Outputs lie between steps; the evaluations of the massive bodies are those of one run."""
    alone = {index: beside_planets([index]).run(t=TIMES, method="dop853") for index in (0, 1, others // 2, others)}
    planets = OUTER.run(t=TIMES, method="dop853")
    for threads in (1, 2, 3):
        every = beside_planets(range(others + 1)).run(t=TIMES, method="dop853", threads=threads)
        for index, one in alone.items():
            assert same(every, MASSIVE + index, one, MASSIVE), f"body {index} on {threads} threads"
        assert np.array_equal(every.position[:, :MASSIVE], planets.position)
        assert np.array_equal(every.velocity[:, :MASSIVE], planets.velocity)
        if threads == 1:
            stats = every.stats
        assert (every.stats.steps, every.stats.evaluations) == (stats.steps, stats.evaluations)


@pytest.mark.parametrize("method", [name for name in ADAPTIVE if name != "dop853"])
@pytest.mark.parametrize("span", [2000.0, -2000.0])
def test_every_adaptive_method_keeps_them_apart(method: str, span: float) -> None:
    times = np.linspace(0.0, span, 5)
    every = beside_planets(range(70)).run(t=times, method=method, rtol=1e-6, threads=2)
    for index in (0, 37, 69):
        assert same(every, MASSIVE + index, beside_planets([index]).run(t=times, method=method, rtol=1e-6), MASSIVE)
    assert np.array_equal(every.position[:, :MASSIVE], OUTER.run(t=times, method=method, rtol=1e-6).position)


@pytest.mark.parametrize("method", FIXED)
@pytest.mark.parametrize("massive", [2, 6])
@pytest.mark.filterwarnings("ignore::visviva.AccuracyWarning")  # Euler's method, whose bits are as good as any
def test_every_fixed_step_keeps_them_apart(method: str, massive: int) -> None:
    def run(which: "list[int] | range", threads: int = 1) -> Any:
        scene = beside_planets(which)
        keep = [*range(massive), *range(MASSIVE, MASSIVE + len(which))]
        bodies = scene.particles
        scene = vv.Scene(vv.Particles(bodies.mass[keep], bodies.position[keep], bodies.velocity[keep]), GRAVITY)
        return scene.run(t=[1000.0, 2005.0], method=method, dt=20.0, threads=threads)

    every = run(range(130), threads=2)
    for index in (0, 64, 129):
        assert same(every, massive + index, run([index]), massive)


def test_members_have_the_bits_they_have_alone() -> None:
    """Three massive bodies and up to five massless ones share lanes with those of other members; more do not."""
    for count in (1, 5, 20):
        scene = beside_planets(range(count))
        keep = [0, 1, 2, *range(MASSIVE, MASSIVE + count)]
        bodies = scene.particles
        scene = vv.Scene(vv.Particles(bodies.mass[keep], bodies.position[keep], bodies.velocity[keep]), GRAVITY)
        random = np.random.default_rng(count)
        members = scene.ensemble(position=scene.particles.position + 1e-3 * random.normal(size=(11, len(keep), 3)))
        for threads in (1, 3):
            together = members.run(t=[0.0, 3000.0, 5000.0], method="dop853", threads=threads)
            for index, member in enumerate(members):
                alone = member.run(t=[0.0, 3000.0, 5000.0], method="dop853")
                assert np.array_equal(together.position[index], alone.position)
                assert np.array_equal(together.velocity[index], alone.velocity)


def test_members_differ_in_what_is_massless() -> None:
    scene = beside_planets(range(2))
    mass = np.tile(scene.particles.mass, (3, 1))
    mass[1, 3:] = 0.0
    mass[2, 4] = 0.0
    members = scene.ensemble(mass=mass)
    together = members.run(t=3000.0, method="dop853", threads=2)
    for index, member in enumerate(members):
        assert np.array_equal(together.position[index], member.run(t=3000.0, method="dop853").position)


@pytest.mark.parametrize("planets", [6, 12])
def test_a_follower_agrees_with_a_body_of_tiny_mass(planets: int) -> None:
    """One that is integrated together with the massive ones, whose own pull is nothing, to a tolerance far below."""
    scene = beside_planets(range(20))
    bodies = scene.particles
    mass = bodies.mass.copy()
    mass[MASSIVE:planets] = 1e-9 * mass[0]  # of twelve, so that the massive ones are more than eight
    masses = np.where(mass > 0.0, mass, 1e-40)
    for rtol, bound in ((1e-9, 2e-7), (1e-12, 2e-10)):
        # Errors grow with time along the orbit: up to 14 turns of 2π radians, each some ten steps of up to rtol.
        run = {"t": np.linspace(0.0, SPAN, 7), "method": "dop853"}
        out = vv.Scene(vv.Particles(mass, bodies.position, bodies.velocity), GRAVITY).run(rtol=rtol, **run)
        joint = vv.Scene(vv.Particles(masses, bodies.position, bodies.velocity), GRAVITY).run(rtol=1e-13, **run)
        place = joint.position[:, 1:]
        apart = np.linalg.norm(out.position[:, 1:] - place, axis=2) / np.linalg.norm(place, axis=2)
        assert apart.max() < bound, (rtol, apart.max(axis=0))


def test_uniform_field_and_two_gravities_and_a_softening_act_on_followers() -> None:
    field = vv.UniformField([0.0, 1e-7, -2e-7])
    forces = (vv.Gravity(0.75 * GRAVITY.G), field, vv.Gravity(0.25 * GRAVITY.G, softening=0.1))
    scene = beside_planets(range(9), *forces)
    out = scene.run(t=[1500.0, 3000.0], method="dop853")
    bodies = scene.particles
    masses = np.where(bodies.mass > 0.0, bodies.mass, 1e-40)
    joint = vv.Scene(vv.Particles(masses, bodies.position, bodies.velocity), *forces)
    joint = joint.run(t=[1500.0, 3000.0], method="dop853", rtol=1e-12)
    assert np.abs(out.position - joint.position).max() < 1e-6  # AU; rtol 1e-9 over one or two turns
    alone = beside_planets([4], *forces).run(t=[1500.0, 3000.0], method="dop853")
    assert same(out, MASSIVE + 4, alone, MASSIVE)


@pytest.mark.parametrize("threads", [1, 2])
def test_a_close_encounter_of_one_is_its_own(threads: int) -> None:
    """A fall from rest onto the star; the others, on circles, have the bits that they have without it."""
    count, falling = 300, 150
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    radius = np.linspace(0.5, 3.0, count)
    x = radius[:, None] * np.stack([np.cos(angle), np.sin(angle), 0.1 * np.cos(angle)], axis=1)
    v = radius[:, None] ** -0.5 * np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1)
    x[falling], v[falling] = [1.0, 0.0, 0.0], 0.0
    star = ([1.0, 1e-3], [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.45, 0.0]])

    def run(which: Any, times: Any, threads: int = 1) -> Any:
        parts = [np.zeros(len(which)), x[which], v[which]]
        bodies = vv.Particles(*(np.concatenate([a, b]) for a, b in zip(star, parts, strict=True)))
        return vv.Scene(bodies, vv.Gravity(1.0)).run(t=times, method="dop853", threads=threads)

    with pytest.raises(vv.CloseEncounter) as caught:
        run(np.arange(count), np.linspace(0.0, 3.0, 61), threads)
    error = caught.value
    assert error.bodies == (0, 2 + falling)
    # The fall from rest at distance 1 onto mass 1 takes π/√8; the planet pulls a little.
    assert error.time == pytest.approx(np.pi / np.sqrt(8.0), abs=1e-4)
    kept = error.trajectory
    assert kept.t[-1] <= error.time == kept.final.t0
    others = run(np.array([0, 149, 151, 299]), np.linspace(0.0, 3.0, 61))
    for place, index in enumerate((0, 149, 151, 299)):
        assert np.array_equal(kept.position[:, 2 + index], others.position[: len(kept.t), 2 + place])


def test_progress_stays_within_its_total() -> None:
    calls: list[tuple[int, int]] = []
    beside_planets(range(700)).run(
        t=5000.0, method="dop853", threads=2, progress=lambda done, total: calls.append((done, total))
    )
    assert calls
    assert calls[-1][0] == calls[-1][1]
    assert all(done <= total for done, total in calls)
    assert calls[-1][1] == 701 * 1000


def test_columns_are_those_of_the_massive_bodies() -> None:
    columns = ("energy", "angular_momentum")
    out = beside_planets(range(100)).run(t=TIMES, method="dop853", record=columns, threads=2)
    planets = OUTER.run(t=TIMES, method="dop853", record=columns)
    assert np.array_equal(out.energy, planets.energy)
    assert np.array_equal(out.angular_momentum, planets.angular_momentum)


# A spring has no Taylor series.
@pytest.mark.parametrize("method", [method for method in ADAPTIVE if method != "taylor"])
@pytest.mark.parametrize("field", [(), (vv.UniformField((0.0, 0.0, 1e-9)),), (vv.LinearDrag(1e6),)], ids=repr)
def test_springs_between_the_massive_couple_no_massless_body(method: str, field: tuple[Any, ...]) -> None:
    """A spring needs masses at its ends. Beside one, massless bodies were integrated in groups, by common steps."""
    forces = (GRAVITY, vv.Spring(4, 5, k=1e-12, length=1.0), *field)
    how = {"t": [500.0, 2000.0], "method": method, "rtol": 1e-7}
    massive = vv.Scene(OUTER.particles, *forces).run(**how)
    for threads in (1, 3):
        every = beside_planets(range(130), *forces).run(threads=threads, **how)
        assert np.array_equal(every.position[:, :MASSIVE], massive.position)
        for index in (0, 64, 129):
            alone = beside_planets([index], *forces).run(**how)
            assert same(every, MASSIVE + index, alone, MASSIVE), f"body {index} on {threads} threads"
